use super::*;
use crate::numerics::philox::{draw, draw_of};
use crate::parallel::Control;
use crate::scattering::bins::Bins;
use crate::scattering::histogram::Edges;
use crate::scattering::kinematics::HalfAngle;
use core::f64::consts::{FRAC_PI_2, PI};
use proptest::prelude::*;

fn all(beam: &Beam, bins: usize) -> Vec<Tally> {
    let one = |q: Quantity| Tally::new(vec![(q, beam.edges(q, &Bins::Count(bins)).unwrap())]).unwrap();
    Quantity::ALL.iter().map(|(_, q)| one(*q)).collect()
}

fn run(beam: &Beam, tallies: &[Tally], first: u64, count: u64, threads: usize) -> Vec<Vec<u64>> {
    let control = Control::new(count);
    monte_carlo(&Mixture::of(beam.clone()), tallies, 7, first, count, threads, &mut Ticker::quiet(&control))
        .unwrap()
        .counts
}

/// What an event is that comes at that b²/b_max², in the first channel; nothing of a captured one.
fn seen(beam: &Beam, quantity: Quantity, share: f64) -> Option<f64> {
    let arrival = beam.straight(0, share);
    let half = if quantity == Quantity::ImpactParameter { None } else { beam.half_angle(&arrival) };
    beam.value_at(quantity, &arrival, half)
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
        let beam = Beam::coulomb(k, 1.0, (2.0_f64.powf(log_ratio), 1.0), reach).unwrap();
        let tallies = all(&beam, 37);
        let whole = run(&beam, &tallies, first, count, 1);
        let middle = ((count as f64 * part) as u64).max(1);
        let left = run(&beam, &tallies, first, middle, 2);
        for (index, tally) in tallies.iter().enumerate() {
            let (quantity, edges) = &tally.axes()[0];
            // Below, above and captured: none.
            let mut expected = vec![0; 37 + 3];
            for event in first..first + count {
                let x = seen(&beam, *quantity, draw(key(7), event).number() as f64 * beam::UNIT).unwrap();
                let edges = edges.values();
                let bin = edges.partition_point(|edge| *edge <= x).min(37);
                expected[bin] += 1;
            }
            prop_assert_eq!(&whole[index], &expected);
            if middle < count {
                let right = run(&beam, &tallies, first + middle, count - middle, 3);
                let sum: Vec<u64> = left[index].iter().zip(&right[index]).map(|(a, b)| a + b).collect();
                prop_assert_eq!(sum, expected);
            }
        }
    }
}

#[test]
fn chunks_and_threads_do_not_matter() {
    let beam = Beam::coulomb(1.0, 1.0, (4.0, 1.0), 3.0).unwrap();
    let tallies = all(&beam, 180);
    let one = run(&beam, &tallies, 12_345, 3_000_001, 1);
    for threads in [2, 3] {
        assert_eq!(run(&beam, &tallies, 12_345, 3_000_001, threads), one);
    }
    assert!(one.iter().all(|counts| counts.iter().sum::<u64>() == 3_000_001));
}

/// P(ψ > ψ₀) = (κ cot(ψ₀/2)/b_max)²: with ψ₀ = 90° and b_max = 2κ a quarter of the events.
#[test]
fn a_quarter_is_scattered_backwards() {
    let beam = Beam::coulomb(1.0, 0.5, (1.0, 1e300), 2.0).unwrap();
    let edges = Edges::new("bins", vec![0.0, FRAC_PI_2, PI]).unwrap();
    let n = 4_000_000_u64;
    let counts = run(&beam, &[Tally::new(vec![(Quantity::CmAngle, edges)]).unwrap()], 0, n, 2);
    let deviation = counts[0][2] as f64 - 0.25 * n as f64;
    // Four standard deviations of a binomial count; the seed is fixed.
    assert!(deviation.abs() < 4.0 * (n as f64 * 0.25 * 0.75).sqrt(), "{deviation}");
}

/// A run that is stopped gives a whole number of events without a gap, and what is left adds up to the whole.
#[test]
fn a_cancelled_run_keeps_what_it_counted() {
    let beam = Beam::coulomb(1.0, 1.0, (4.0, 1.0), 3.0).unwrap();
    let tallies = all(&beam, 50);
    for threads in 1..=3 {
        let control = Control::new(0);
        let mut monitor = |_: u64, _: u64| false; // called first after 50 ms
        let ticker = &mut Ticker::new(&control, &mut monitor);
        let kept =
            monte_carlo(&Mixture::of(beam.clone()), &tallies, 7, 11, 1 << 40, threads, ticker).unwrap();
        assert!(kept.events > 0 && kept.events < 1 << 40, "{}", kept.events);
        assert_eq!(kept.counts, run(&beam, &tallies, 11, kept.events, 2));
    }
    let control = Control::new(0);
    control.cancel();
    let nothing =
        monte_carlo(&Mixture::of(beam.clone()), &tallies, 7, 0, 1000, 2, &mut Ticker::quiet(&control));
    assert_eq!(nothing, Err(Error::Interrupted));
}

/// The last event there is has the index 2^63 - 1.
#[test]
fn the_last_events_are_counted() {
    let beam = Beam::coulomb(1.0, 1.0, (1.0, 1.0), 3.0).unwrap();
    let tallies = all(&beam, 5);
    let control = Control::new(0);
    let last = |n: u64| {
        monte_carlo(
            &Mixture::of(beam.clone()),
            &tallies,
            7,
            (1 << 63) - 10,
            n,
            1,
            &mut Ticker::quiet(&control),
        )
    };
    assert_eq!(last(10).unwrap().counts[0].iter().sum::<u64>(), 10);
    assert!(matches!(last(11), Err(Error::InvalidInput { argument, .. }) if argument == "first_event"));
}

/// Which bins know their whole cross section, at one beam of each kind: light on heavy, equal, and heavy on light
/// with the disc ending beyond and before the greatest angle.
#[test]
fn covered_values_and_reachable_bins() {
    let quarter = FRAC_PI_2 / 2.0;
    for (masses, b_max, lab) in [
        ((1.0, 1e200), 2.0, Some(2.0 * 0.25_f64.atan())),
        ((1.0, 1.0), 2.0, Some(0.5_f64.atan())),
        // κ = k/2E with E = m₂/(m₁ + m₂): cot(ψ/2) = 4/3 at b_max = 2, beyond 1/√3, the greatest angle's.
        ((2.0, 1.0), 2.0, None),
        ((2.0, 1.0), 0.5, None),
    ] {
        let beam = Beam::coulomb(1.0, 1.0, masses, b_max).unwrap();
        // b_max / κ, κ = 1/2E.
        let half: HalfAngle = beam.edge();
        assert!((half.cotangent() - b_max * 2.0 * masses.1 / (masses.0 + masses.1)).abs() < 1e-15);
        assert_eq!(beam.covered(Quantity::CmAngle), (half.cm_angle(), PI));
        assert_eq!(beam.smallest_angle(), half.cm_angle());
        let covered = beam.covered(Quantity::LabAngle).0;
        let expected = match lab {
            Some(_) if masses.1 > 1.0 => half.cm_angle(),
            Some(_) => 0.5 * half.cm_angle(),
            None if b_max > 1.0 => beam.collision.lab_angle(half),
            None => (0.5_f64).asin(), // m₂/m₁
        };
        assert!((covered - expected).abs() < 4e-16, "{covered} {expected}");
        assert_eq!(beam.two_branches(Quantity::LabAngle), masses.0 > masses.1);
        for (name, quantity) in Quantity::ALL {
            let (low, high) = beam.covered(quantity);
            let top = beam.limits(quantity).high.min(beam.b_max.max(PI));
            // Edges at the covered values, and inside what is beyond: whole bins, none, and one that is cut.
            let mut edges = vec![0.5 * low, low, 0.5 * (low + high), high, 0.5 * (high + top)];
            edges.sort_by(f64::total_cmp);
            edges.dedup();
            let parts = beam.reachable(quantity, &edges);
            for (pair, part) in edges.windows(2).zip(&parts) {
                // The energy of a projectile that a heavy target hardly slows: what is missing is less than a rounding.
                let forward = quantity == Quantity::Energy && high == beam.limits(quantity).high;
                let inside = pair[0] >= low && pair[1] <= high;
                if forward && pair[1] == high {
                    assert_eq!(*part, 1.0_f64.next_down());
                    continue;
                }
                assert_eq!(*part, f64::from(inside), "{name} {pair:?} of {low} to {high}");
            }
            let cut = beam.reachable(quantity, &[0.5 * low, top.min(high)])[0];
            assert!(low == 0.0 || (cut > 0.0 && cut < 1.0), "{name} {cut}");
        }
        assert!(beam.reachable(Quantity::CmAngle, &[0.0, quarter, PI])[0] < 1.0);
        // The forward direction is never whole, however wide the disc.
        let wide = Beam::coulomb(1.0, 1.0, masses, 1e100).unwrap();
        for (_, quantity) in Quantity::ALL.into_iter().filter(|(name, _)| *name != "impact_parameter") {
            let parts = wide.reachable(quantity, wide.edges(quantity, &Bins::Count(4)).unwrap().values());
            let forward = if matches!(quantity, Quantity::RecoilAngle | Quantity::Energy) { 3 } else { 0 };
            for (bin, part) in parts.into_iter().enumerate() {
                assert!((part == 1.0) == (bin != forward) && part > 0.999, "{quantity:?} {bin} {part}");
            }
        }
    }
}

#[test]
fn edges_out_of_range_are_refused_with_the_cure() {
    let beam = Beam::coulomb(1.0, 1.5, (1.0, 4.0), 3.0).unwrap();
    let text = |quantity: Quantity, edges: &[f64]| match beam.edges(quantity, &Bins::Edges(edges.to_vec())) {
        Err(error) => error.to_string(),
        Ok(_) => String::new(),
    };
    for quantity in [Quantity::CmAngle, Quantity::LabAngle, Quantity::RecoilAngle] {
        assert!(
            text(quantity, &[10.0, 45.0, 90.0]).contains("np.radians"),
            "{}",
            text(quantity, &[10.0, 45.0])
        );
        assert!(text(quantity, &[-0.1, 1.0]).contains("below 0"));
    }
    assert_eq!(text(Quantity::CmAngle, &[0.0, PI * (1.0 + 1e-15)]), "");
    assert!(text(Quantity::RecoilAngle, &[0.0, PI]).contains("π/2"));
    for quantity in [Quantity::Energy, Quantity::RecoilEnergy] {
        assert!(text(quantity, &[0.0, 1500.0]).contains("[0, beam_energy] = [0, 1.5]"));
        assert_eq!(text(quantity, &[0.0, 1.5]), "");
    }
    assert_eq!(text(Quantity::ImpactParameter, &[0.0, 3.0]), "");
    assert!(text(Quantity::ImpactParameter, &[0.0, 3.1]).contains("[0, b_max] = [0, 3.0]"));
}

#[test]
fn bad_beams_are_refused_by_name() {
    let name = |beam: Result<Beam>| match beam {
        Err(Error::InvalidInput { argument, .. }) => argument,
        other => panic!("{other:?}"),
    };
    assert_eq!(name(Beam::coulomb(0.0, 1.0, (1.0, 1.0), 1.0)), "potential");
    assert_eq!(name(Beam::coulomb(1.0, -1.0, (1.0, 1.0), 1.0)), "beam_energy");
    assert_eq!(name(Beam::coulomb(1.0, 1.0, (1.0, 0.0), 1.0)), "masses");
    assert_eq!(name(Beam::coulomb(1.0, 1.0, (1.0, 1.0), f64::NAN)), "b_max");
    assert_eq!(name(Beam::coulomb(1.0, 1e-300, (1.0, 1.0), 1.0)), "b_max");
    assert_eq!(name(Beam::coulomb(1.0, 1.0, (1e300, 1e-300), 1.0)), "masses");
    assert_eq!(name(Beam::coulomb(1.0, 1.0, (1e-300, 1e300), 1.0)), "masses");
    let light = Beam::coulomb(1.0, 1e-100, (1e-250, 1.0), 1e99).unwrap();
    assert!(matches!(
        light.edges(Quantity::RecoilEnergy, &Bins::Count(10)),
        Err(Error::InvalidInput { argument, .. }) if argument == "masses"
    ));
}

/// Two energies in parts 1 : 3. Each event is that of its own beam, draw 1 telling which, and a tally of two quantities
/// has the counts of each when the other is summed over.
#[test]
fn a_mixture_counts_every_event_in_its_own_beam() {
    let beams: Vec<Beam> =
        [1.0, 2.0].map(|energy| Beam::coulomb(1.0, energy, (3.0, 1.0), 3.0).unwrap()).into();
    let mixture = Mixture::new(beams.clone(), &[1.0, 3.0]).unwrap();
    let axis = |quantity: Quantity, bins| (quantity, mixture.edges(quantity, &Bins::Count(bins)).unwrap());
    let (angle, energy) = (axis(Quantity::LabAngle, 19), axis(Quantity::Energy, 7));
    let tallies = [vec![angle.clone()], vec![energy.clone()], vec![angle.clone(), energy.clone()]]
        .map(|axes| Tally::new(axes).unwrap());
    let count = |first, n, threads| {
        monte_carlo(&mixture, &tallies, 7, first, n, threads, &mut Ticker::quiet(&Control::new(0)))
            .unwrap()
            .counts
    };
    let whole = count(5, 20_001, 1);
    assert_eq!(whole, count(5, 20_001, 3));
    let listed = events(&mixture, 7, 5, 20_001, &mut Ticker::quiet(&Control::new(0))).unwrap();
    let mut expected: Vec<Vec<u64>> = tallies.iter().map(|tally| vec![0; tally.slots()]).collect();
    for (index, event) in listed.iter().enumerate() {
        let draw = |number| draw_of(key(7), 5 + index as u64, number).number() as f64 * beam::UNIT;
        assert_eq!(event.component, u64::from(draw(1) >= 0.25));
        let beam = &beams[event.component as usize];
        assert_eq!(Some(event.values[1]), seen(beam, Quantity::LabAngle, draw(0)));
        let (a, e) = (angle.1.slot(event.values[1]), energy.1.slot(event.values[3]));
        expected[0][a] += 1;
        expected[1][e] += 1;
        expected[2][a * 9 + e] += 1;
    }
    assert_eq!(whole, expected);
    assert!(
        Mixture::new(beams.clone(), &[1.0, 0.0]).is_err() && Mixture::new(beams, &[1.0, f64::NAN]).is_err()
    );
}

/// Two energies, two reactions and what they leave elastic. Each event is that of its line and its channel, draws 1 and 6
/// telling which, and parts of all draws are what is expected on the average.
#[test]
fn channels_count_every_event_in_their_own() {
    let channel = |probability, q_value, products| Channel {
        probability: Probability::constant(probability),
        q_value,
        products,
    };
    let channels = [channel(0.25, -0.3, None), channel(0.5, 0.4, Some((1.5, 2.5)))];
    let potential = (crate::registry::potential("coulomb").unwrap().make)(&[
        crate::potentials::parameters::Value::Number(1.0),
    ]);
    let mixture = |channels: &[Channel]| {
        let (control, profile) = (Control::new(0), Profile::default());
        let lines = (&[1.0, 2.0][..], &[1.0, 3.0][..]);
        let ticker = &mut Ticker::quiet(&control);
        Mixture::of_energies(
            potential.as_ref().unwrap(),
            lines,
            (3.0, 1.0),
            3.0,
            profile,
            channels,
            1,
            ticker,
        )
    };
    // The threshold of Q = -0.3 is 1.2: the lower line is closed.
    assert!(matches!(mixture(&channels), Err(Error::InvalidInput { argument, message })
        if argument == "channels" && message.contains("1.2")));
    let channels = [channel(0.25, -0.2, None), channels[1].clone()];
    let mixture = mixture(&channels).unwrap();
    let quantities = [Quantity::LabAngle, Quantity::RecoilAngle, Quantity::Energy, Quantity::RecoilEnergy];
    let tallies =
        quantities.map(|q| Tally::new(vec![(q, mixture.edges(q, &Bins::Count(31)).unwrap())]).unwrap());
    let control = Control::new(0);
    let count = |threads| {
        monte_carlo(&mixture, &tallies, 7, 5, 20_001, threads, &mut Ticker::quiet(&control)).unwrap().counts
    };
    let listed = events(&mixture, 7, 5, 20_001, &mut Ticker::quiet(&control)).unwrap();
    let mut expected = vec![vec![0; 31 + 3]; 4];
    for (index, event) in listed.iter().enumerate() {
        let draw = |number| draw_of(key(7), 5 + index as u64, number).number() as f64 * beam::UNIT;
        let channel = [1, 2, 0][usize::from(draw(6) >= 0.25) + usize::from(draw(6) >= 0.75)];
        assert_eq!((event.component, event.channel), (u64::from(draw(1) >= 0.25), channel));
        let q = [0.0, -0.2, 0.4][channel as usize];
        let kept = event.values[3] + event.values[4] - event.beam_energy - q;
        // Some seven roundings of each of two energies, as over the event table in Python.
        let size = event.values[3] + event.values[4] + event.beam_energy;
        assert!(kept.abs() < 8e-16 * size, "{kept:e} of {size}");
        for ((tally, quantity), slots) in tallies.iter().zip(quantities).zip(&mut expected) {
            let (position, _) = Quantity::ALL.iter().enumerate().find(|(_, (_, q))| *q == quantity).unwrap();
            slots[tally.axes()[0].1.slot(event.values[position])] += 1;
        }
    }
    assert_eq!((count(1), count(3)), (expected.clone(), expected.clone()));
    let parts = super::expected(&mixture, &tallies, 2, &mut Ticker::quiet(&control)).unwrap();
    for (parts, counts) in parts.iter().zip(&expected) {
        assert!((parts.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        for (part, count) in parts.iter().zip(counts) {
            // Five standard deviations of 20 001 events in any of 136 slots.
            assert!((part * 20_001.0 - *count as f64).abs() < 5.0 * (part * 20_001.0).sqrt() + 5.0);
        }
    }
}

/// Lennard-Jones with a rainbow, glories, whole turns and, at half the depth, orbiting: every event counted is in the bin
/// of its value, at each quantity; langevin's captured ones are counted apart.
#[test]
fn rainbows_turns_and_captured_ones_are_counted() {
    use crate::potentials::parameters::Value;
    let potential = |name, numbers: [f64; 2]| {
        (crate::registry::potential(name).unwrap().make)(&numbers.map(Value::Number)).unwrap()
    };
    let control = Control::new(0);
    let ticker = &mut Ticker::quiet(&control);
    for (potential, energy) in [
        (potential("lennard_jones", [1.0, 1.0]), 4.0),
        (potential("lennard_jones", [1.0, 1.0]), 1.0),
        (potential("power_law", [-1.0, 4.0]), 1.0),
    ] {
        let beam = Beam::new(&potential, energy, (1.0, 1.0), 3.0, Profile::default(), 1, ticker).unwrap();
        let counts = run(&beam, &all(&beam, 41), 0, 30_000, 2);
        for (tally, counts) in all(&beam, 41).iter().zip(&counts) {
            let (quantity, edges) = &tally.axes()[0];
            let mut expected = vec![0_u64; tally.slots()];
            for event in 0..30_000 {
                let share = draw_of(key(7), event, 0).number() as f64 * beam::UNIT;
                expected[seen(&beam, *quantity, share).map_or(43, |value| edges.slot(value))] += 1;
            }
            assert_eq!(counts, &expected, "{quantity:?}");
        }
        let captured = counts[0][43];
        // Langevin's cross section is 2π√(C/E) of π b_max²: E = 1/2.
        let part = if energy == 1.0 && counts[0][43] > 0 { 2.0 * 2.0_f64.sqrt() / 9.0 } else { 0.0 };
        assert!((captured as f64 / 30_000.0 - part).abs() < 0.012, "{captured}"); // four standard deviations
    }
}
