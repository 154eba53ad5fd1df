//! Eight at a time and each alone: the same counts to the last.

use super::super::profile::Profile;
use super::super::{Strata, follow};
use super::*;
use crate::numerics::philox::key;

use crate::parallel::{Control, Ticker};
use crate::potentials::parameters::Value;
use crate::registry;
use core::cell::Cell;

const EVENTS: Range<u64> = 3..60_000;

fn beam(name: &str, numbers: &[f64], masses: (f64, f64), profile: Profile) -> Beam {
    let numbers: Vec<Value> = numbers.iter().map(|x| Value::Number(*x)).collect();
    let potential = (registry::potential(name).unwrap().make)(&numbers).unwrap();
    let control = Control::new(0);
    Beam::new(&potential, 9.0, masses, 3.0, profile, 1, &mut Ticker::quiet(&control)).unwrap()
}

fn tallies(energy: f64) -> Vec<Tally> {
    let edges = |high: f64, bins: usize| Edges::uniform(bins, 0.0, high).unwrap();
    let small: Vec<f64> = (-30..=2).map(|k| f64::from(k).exp2()).collect();
    let mut axes: Vec<Vec<(Quantity, Edges)>> =
        Quantity::ALL.iter().map(|(_, quantity)| vec![(*quantity, edges(energy, 97))]).collect();
    axes.push(vec![(Quantity::LabAngle, Edges::new("bins", small).unwrap())]);
    axes.push(vec![(Quantity::CmAngle, Edges::uniform(20, 0.3, 2.0).unwrap())]);
    axes.push(vec![(Quantity::ImpactParameter, edges(3.0, 7)), (Quantity::LabAngle, edges(PI, 11))]);
    axes.push(vec![(Quantity::RecoilAngle, edges(PI, 13)), (Quantity::Energy, edges(energy, 9))]);
    axes.into_iter().map(|axes| Tally::new(axes).unwrap()).collect()
}

#[test]
fn counts_are_those_of_each_event_alone() {
    let gaussian = |sigma| Some(Spread::Gaussian(sigma));
    let uniform = |half| Some(Spread::Uniform(half));
    let profiles = [
        Profile { energy_spread: gaussian(0.02), ..Profile::default() },
        Profile { energy_spread: uniform(0.1), divergence: uniform(0.4), spot: None },
        Profile { divergence: gaussian(0.01), ..Profile::default() },
        Profile { energy_spread: gaussian(0.05), divergence: gaussian(0.2), spot: Some(1.0) },
    ];
    let targets: [(&str, &[f64]); 5] = [
        ("lennard_jones", &[1.0, 1.0]),
        ("yukawa", &[1.0, 1.0]),
        ("coulomb", &[0.7]),
        ("coulomb", &[-0.7]),
        ("power_law", &[-1.0, 4.0]),
    ];
    let tallies = tallies(9.0);
    for (name, numbers) in targets {
        for profile in profiles {
            // What is captured has no range of energies.
            if name == "power_law" && profile.energy_spread.is_some() {
                continue;
            }
            for masses in [(1.0, 4.0), (4.0, 1.0), (1.0, 1.0)] {
                let mut mixture = Mixture::of(beam(name, numbers, masses, profile));
                if profile.spot.is_none() {
                    mixture =
                        mixture.stratified(Strata::new(&[0.0, 0.4, 3.0], &[1.0, 2.0]).unwrap()).unwrap();
                }
                let Some(abreast) = Abreast::of(&mixture, &tallies) else {
                    assert_eq!(tier(), Tier::Portable);
                    return;
                };
                let nothing = || -> Vec<Vec<Vec<u64>>> {
                    tallies.iter().map(|tally| vec![vec![0; tally.slots() * mixture.histograms()]]).collect()
                };
                let (mut eight, mut alone, left) = (nothing(), nothing(), Cell::new(0));
                abreast.count(key(7), EVENTS, &mut eight, |event, counters| {
                    left.set(left.get() + 1);
                    follow(&mixture, &tallies, (7, event), counters);
                });
                EVENTS.for_each(|event| follow(&mixture, &tallies, (7, event), &mut alone));
                assert!(eight == alone, "{name} {numbers:?} {masses:?} {profile:?}");
                // Nearly all are found here: what is left beside an edge, or in the last place of a greatest energy, is little.
                assert!(left.get() < EVENTS.end / 100, "{name} {masses:?} {profile:?}: {}", left.get());
            }
        }
    }
}
