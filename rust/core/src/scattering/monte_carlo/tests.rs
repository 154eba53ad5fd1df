use super::*;
use crate::numerics::philox::draw;
use crate::parallel::Control;
use proptest::prelude::*;

fn all(beam: &Beam, bins: usize) -> Vec<(Quantity, Edges)> {
    Quantity::ALL.iter().map(|(_, q)| (*q, beam.uniform_edges(*q, bins).unwrap())).collect()
}

fn run(beam: &Beam, tallies: &[(Quantity, Edges)], first: u64, count: u64, threads: usize) -> Vec<Counts> {
    let control = Control::new(count);
    monte_carlo(beam, tallies, 7, first, count, threads, &mut Ticker::quiet(&control)).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    /// Any threads, any split, any quantity: the counts are those of evaluating each event by itself.
    #[test]
    fn counts_are_those_of_single_events(
        log_ratio in -6.0..6.0f64,
        reach in 0.1..50.0f64,
        first in 0..(1_u64 << 40),
        count in 1..3000_u64,
        part in 0.0..1.0f64,
        repulsive: bool,
    ) {
        let k = if repulsive { 1.0 } else { -1.0 };
        let beam = Beam::new(k, 1.0, (2.0_f64.powf(log_ratio), 1.0), reach).unwrap();
        let tallies = all(&beam, 37);
        let whole = run(&beam, &tallies, first, count, 1);
        let middle = ((count as f64 * part) as u64).max(1);
        let left = run(&beam, &tallies, first, middle, 2);
        for (index, (quantity, edges)) in tallies.iter().enumerate() {
            let mut expected = vec![0; 37];
            for event in first..first + count {
                let x = beam.value(*quantity, draw(key(7), event) as f64 * UNIT);
                let edges = edges.values();
                let bin = edges.partition_point(|edge| *edge <= x).min(37);
                expected[bin - 1] += 1;
            }
            prop_assert_eq!(&whole[index].bins, &expected);
            prop_assert_eq!((whole[index].underflow, whole[index].overflow), (0, 0));
            if middle < count {
                let right = run(&beam, &tallies, first + middle, count - middle, 3);
                let sum: Vec<u64> = left[index].bins.iter().zip(&right[index].bins).map(|(a, b)| a + b).collect();
                prop_assert_eq!(sum, expected);
            }
        }
    }
}

#[test]
fn chunks_and_threads_do_not_matter() {
    let beam = Beam::new(1.0, 1.0, (4.0, 1.0), 3.0).unwrap();
    let tallies = all(&beam, 180);
    let one = run(&beam, &tallies, 12_345, 3_000_001, 1);
    for threads in [2, 3] {
        assert_eq!(run(&beam, &tallies, 12_345, 3_000_001, threads), one);
    }
    assert!(one.iter().all(|counts| counts.bins.iter().sum::<u64>() == 3_000_001));
}

/// P(ψ > ψ₀) = (κ cot(ψ₀/2)/b_max)²: with ψ₀ = 90° and b_max = 2κ a quarter of the events.
#[test]
fn a_quarter_is_scattered_backwards() {
    let beam = Beam::new(1.0, 0.5, (1.0, 1e300), 2.0).unwrap();
    let edges = Edges::new("bins", vec![0.0, FRAC_PI_2, PI]).unwrap();
    let n = 4_000_000_u64;
    let counts = run(&beam, &[(Quantity::CmAngle, edges)], 0, n, 2);
    let deviation = counts[0].bins[1] as f64 - 0.25 * n as f64;
    // Four standard deviations of a binomial count; the seed is fixed.
    assert!(deviation.abs() < 4.0 * (n as f64 * 0.25 * 0.75).sqrt(), "{deviation}");
}

#[test]
fn bad_beams_are_refused_by_name() {
    let name = |beam: Result<Beam>| match beam {
        Err(Error::InvalidInput { argument, .. }) => argument,
        other => panic!("{other:?}"),
    };
    assert_eq!(name(Beam::new(0.0, 1.0, (1.0, 1.0), 1.0)), "potential");
    assert_eq!(name(Beam::new(1.0, -1.0, (1.0, 1.0), 1.0)), "beam_energy");
    assert_eq!(name(Beam::new(1.0, 1.0, (1.0, 0.0), 1.0)), "masses");
    assert_eq!(name(Beam::new(1.0, 1.0, (1.0, 1.0), f64::NAN)), "b_max");
    assert_eq!(name(Beam::new(1.0, 1e-300, (1.0, 1.0), 1.0)), "b_max");
    assert_eq!(name(Beam::new(1.0, 1.0, (1e300, 1e-300), 1.0)), "b_max");
}
