//! Edges, the bin that a draw falls into, and steps that are found by a few looks.

use super::*;
use crate::parallel::Control;
use proptest::prelude::*;

/// The bins of a quantity.
struct Binned<'a, F>(&'a Edges, F);

impl<F: Fn(u64) -> f64> Stepping for Binned<'_, F> {
    type Values = f64;
    fn seen(&self, draw: u64) -> Seen<f64> {
        let values = (self.1)(draw);
        Seen { draw, slot: self.0.slot(values), values }
    }
    fn sides(&self, low: &Seen<f64>, high: &Seen<f64>) -> Option<[f64; 2]> {
        self.0.sides([low.slot, high.slot], [low.values, high.values])
    }
    fn apart(&self, [low, high]: [&Seen<f64>; 2], of: &Seen<f64>) -> f64 {
        self.0.apart([low.slot, high.slot], of.values)
    }
}

fn steps(edges: &Edges, turning: &[u64], value: impl Fn(u64) -> f64) -> Steps {
    Steps::new(turning, &Binned(edges, value), true, &mut Ticker::quiet(&Control::new(0))).unwrap()
}

fn slots_of(steps: &Steps, bins: usize, counters: &[u64]) -> Vec<u64> {
    let mut slots = vec![0; bins + 2];
    steps.collect(counters, &mut slots);
    slots
}

fn slot_of(steps: &Steps, bins: usize, draw: u64) -> usize {
    let mut counters = steps.counters();
    steps.count(&[Draw::of(draw << (64 - DRAW_BITS))], &mut counters);
    slots_of(steps, bins, &counters).iter().position(|count| *count == 1).unwrap()
}

#[test]
fn edges_belong_to_the_bin_above_and_the_last_to_the_last() {
    let edges = Edges::new("bins", vec![1.0, 2.0, 4.0]).unwrap();
    let slots = [0.9, 1.0, 1.9, 2.0, 3.9, 4.0, 4.1].map(|x| edges.slot(x));
    assert_eq!(slots, [0, 1, 1, 2, 2, 2, 3]);
}

#[test]
fn bad_edges_are_refused() {
    for edges in [vec![1.0], vec![1.0, 1.0], vec![2.0, 1.0], vec![0.0, f64::NAN], vec![0.0, f64::INFINITY]] {
        assert!(matches!(Edges::new("bins", edges), Err(Error::InvalidInput { .. })));
    }
    assert!(Edges::uniform(0, 0.0, 1.0).is_err());
}

/// 2^16 edges take a million evaluations; all of them were made before anybody looked at the flag.
#[test]
fn edges_notice_cancellation() {
    let control = Control::new(0);
    control.cancel();
    let edges = Edges::uniform(100, 0.0, 1.0).unwrap();
    let outcome = Steps::new(&[], &Binned(&edges, |draw| draw as f64), true, &mut Ticker::quiet(&control));
    assert!(matches!(outcome, Err(Error::Interrupted)));
}

/// Safe code can make no draw of more bits, and counters of another histogram are refused.
#[test]
fn nothing_is_counted_outside_the_counters() {
    let edges = Edges::uniform(2, 0.0, 1.0).unwrap();
    let steps = steps(&edges, &[], |draw| draw as f64 / DRAWS as f64);
    let mut counters = steps.counters();
    steps.count(&[Draw::of(u64::MAX), Draw::of(0)], &mut counters);
    assert_eq!((Draw::of(u64::MAX).number(), slots_of(&steps, 2, &counters)), (DRAWS - 1, vec![0, 1, 1, 0]));
    let short = std::panic::catch_unwind(|| steps.count(&[Draw::of(0)], &mut steps.counters()[1..]));
    assert!(short.is_err());
}

proptest! {
    /// A rising, a falling and a turning function: the bin is that of the value, exactly, at
    /// arbitrary draws and at every step's two sides.
    #[test]
    fn the_bin_is_that_of_the_value(
        mut edges in prop::collection::vec(0.01..0.99f64, 2..40),
        draws in prop::collection::vec(0..DRAWS, 50),
    ) {
        edges.sort_by(f64::total_cmp);
        edges.dedup();
        prop_assume!(edges.len() > 1);
        let edges = Edges::new("bins", edges).unwrap();
        let unit = |draw: u64| draw as f64 / DRAWS as f64;
        type Function = Box<dyn Fn(u64) -> f64>;
        let functions: [(&[u64], Function); 4] = [
            (&[], Box::new(move |draw| unit(draw).sqrt())),
            (&[], Box::new(move |draw| 1.0 - unit(draw) * unit(draw))),
            (&[DRAWS / 4], Box::new(move |draw| {
                if draw <= DRAWS / 4 { 3.9 * unit(draw) } else { 1.3 * (1.0 - unit(draw)) }
            })),
            // Up, down, up again, and a jump.
            (&[DRAWS / 4, DRAWS / 2, DRAWS / 4 * 3], Box::new(move |draw| {
                let part = unit(draw % (DRAWS / 2));
                let jump = if draw >= DRAWS / 4 * 3 { 0.2 } else { 0.0 };
                if part <= 0.25 { 3.2 * part - jump } else { 1.6 - 3.2 * part - jump }
            })),
        ];
        for (turning, value) in functions {
            let steps = steps(&edges, turning, &value);
            let sides = steps.lookup.starts[1..steps.pieces()].iter().flat_map(|start| [start - 1, *start]);
            for draw in draws.iter().copied().chain(sides).chain([0, DRAWS - 1]) {
                prop_assert_eq!(slot_of(&steps, edges.bins(), draw), edges.slot(value(draw)));
            }
        }
    }
}

/// A quantity that comes to an edge and stays there but for its last bit, as rounding has it.
#[test]
fn what_flickers_at_an_edge_is_counted_as_it_is() {
    let edges = Edges::new("bins", vec![0.0, 1.0, 2.0]).unwrap();
    let last = 1 << DRAW_BITS;
    let value = |draw: u64| match draw as f64 / last as f64 {
        part if part < 0.5 => part,
        // Below the edge in every other hundredth until 0.6, then on it.
        part if part < 0.6 && ((part * 100.0) as u64).is_multiple_of(2) => 1.0_f64.next_down(),
        _ => 1.0,
    };
    let steps = steps(&edges, &[], value);
    for part in 0..1000 {
        let draw = last / 1000 * part + 12_345;
        assert_eq!(slot_of(&steps, 2, draw), edges.slot(value(draw)), "{part}");
    }
}
