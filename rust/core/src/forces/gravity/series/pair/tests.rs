use super::super::{EachPair, RingPairs};
use super::*;
use crate::forces::series::Series;
use crate::numerics::element::Shape;
use crate::ode::state::State;
use crate::parallel::{Control, Ticker};

const ORDER: usize = 22;

/// Two bodies of the masses 0.75 and 0.125, on their way past each other.
fn jet<S: Element>(bodies: impl Fn([f64; 2]) -> Vec<S>, components: usize) -> Jet<S> {
    let rows = |numbers: [[f64; 2]; 3]| numbers[..components].iter().flat_map(|&row| bodies(row)).collect();
    let q: Vec<S> = rows([[0.3, -1.1], [-0.2, 0.9], [0.05, 0.4]]);
    let v: Vec<S> = rows([[0.2, -0.5], [0.6, -0.1], [-0.3, 0.7]]);
    let mut jet = Jet::new(q.len(), ORDER);
    jet.begin(&State::new(&q, &v), [&S::zero(), &S::one()], &S::splat(0.25));
    jet
}

fn in_lanes(row: [f64; 2]) -> Vec<Lanes> {
    vec![Lanes([row[0], row[1], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])]
}

#[test]
fn between_bodies_is_as_from_body_to_body() {
    let control = Control::new(0);
    for (components, softening) in [(3, 0.0), (3, 0.25), (2, 0.125)] {
        let shape = Shape { rows: 1, components };
        let mut series = RingPairs::new(shape, &[0.75, 0.125], softening);
        let (mut whole, mut single) = (jet(in_lanes, components), jet(in_lanes, components));
        let mut a = vec![Lanes::zero(); components];
        series.expand(&mut whole, &mut a, &mut Ticker::quiet(&control)).unwrap();
        for n in 0..ORDER {
            series.coefficient(n, &single, &mut a, true, &mut Ticker::quiet(&control)).unwrap();
            single.raise(n, &a);
        }
        for n in 0..ORDER + 2 {
            let largest =
                single.position(n).iter().flat_map(|row| row.0).fold(0.0, |m: f64, x| m.max(x.abs()));
            for (one, other) in whole.position(n).iter().zip(single.position(n)) {
                for lane in 0..2 {
                    // Each order adds a few roundings of its sums.
                    let difference = (one.0[lane] - other.0[lane]).abs();
                    assert!(difference <= 1e-13 * largest, "order {n}: {difference:e} of {largest:e}");
                }
            }
        }
    }
}

#[test]
fn bodies_in_lanes_and_systems_in_lanes_have_the_same_bits() {
    let control = Control::new(0);
    for components in [2, 3] {
        let mut packed = jet(in_lanes, components);
        let mut beside = jet(|row| row.map(Lanes::splat).to_vec(), components);
        let mut a = vec![Lanes::zero(); 2 * components];
        let mut along = RingPairs::new(Shape { rows: 1, components }, &[0.75, 0.125], 0.125);
        along.expand(&mut packed, &mut a, &mut Ticker::quiet(&control)).unwrap();
        let strength = [0.75, 0.125].map(Lanes::splat).to_vec();
        let mut each = EachPair::new(Shape { rows: 2, components }, strength, 0.125);
        each.expand(&mut beside, &mut a, &mut Ticker::quiet(&control)).unwrap();
        for (row, both) in [(&packed.q, &beside.q), (&packed.v, &beside.v)]
            .iter()
            .flat_map(|(one, other)| one.iter().zip(other.as_chunks::<2>().0))
        {
            for body in 0..2 {
                assert_eq!(both[body].0.map(f64::to_bits), [row.0[body].to_bits(); 8]);
            }
        }
    }
}
