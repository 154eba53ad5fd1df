//! Tables of a range of energies against direct quadrature, where they were not tried, and what is refused.

use super::*;
use crate::parallel::Control;
use crate::potentials::parameters::Value;
use crate::registry;

fn deflector(name: &str, numbers: &[f64]) -> Deflector {
    let values: Vec<Value> = numbers.iter().map(|x| Value::Number(*x)).collect();
    let potential = (registry::potential(name).unwrap().make)(&values).unwrap();
    Deflector::for_table(&potential, 1e-12).unwrap()
}

fn built(deflector: &Deflector, range: [f64; 2], b_max: f64, threads: usize) -> Option<Energies> {
    Energies::build(deflector, range, b_max, threads, &mut Ticker::quiet(&Control::new(0))).unwrap()
}

/// Within what is certified, at energies and impact parameters on a grid of which none was tried; the same by any
/// number of threads, and small.
#[test]
fn between_the_tables_are_the_deflections() {
    for (name, numbers, range, b_max) in [
        ("yukawa", vec![1.0, 1.0], [0.6, 0.9], 5.0),
        ("lennard_jones", vec![1.0, 1.0], [2.0, 2.2], 3.0),
        ("plummer", vec![-1.0, 1.0], [0.5, 0.7], 4.0),
    ] {
        let deflector = deflector(name, &numbers);
        let energies = built(&deflector, range, b_max, 1).unwrap();
        assert_eq!(energies, built(&deflector, range, b_max, 3).unwrap(), "{name}");
        assert!(energies.tables().map(EventTable::bytes).sum::<usize>() <= MOST_BYTES);
        assert!(energies.error() <= MOST_ERROR);
        for i in 0..24 {
            let energy = range[0] + (range[1] - range[0]) * (f64::from(i) + 0.31) / 24.0;
            let parts: Vec<f64> = (0..60).map(|j| (f64::from(j) + 0.43) / 60.0).collect();
            let b: Vec<f64> = parts.iter().map(|part| part * b_max).collect();
            let direct = deflector
                .deflect(&vec![energy; b.len()], &b, false, 1, &mut Ticker::quiet(&Control::new(0)))
                .unwrap();
            for (part, direct) in parts.iter().zip(&direct) {
                let angle = energies.angle(energy, *part).unwrap();
                let off = ((0.5 * angle).sin().powi(2) - (0.5 * direct.angle).sin().powi(2)).abs();
                assert!(off <= MOST_ERROR, "{name} at {energy}, {part}: {off}");
            }
        }
    }
}

/// At the energy of a table the polynomial is that table, bit for bit, where its formula divides by zero.
#[test]
fn at_a_tables_energy_it_is_the_table() {
    let energies = built(&deflector("yukawa", &[1.0, 1.0]), [0.6, 0.9], 5.0, 1).unwrap();
    let (first, last) = (energies.tables.first().unwrap(), energies.tables.last().unwrap());
    for (energy, (_, _, table)) in [(0.6, first), (0.9, last)] {
        for part in [0.0, 0.1, 0.5, 0.99] {
            assert_eq!(energies.angle(energy, part), table.angle(part));
        }
    }
    assert_eq!((first.0, last.0), (1.0, 0.6 / 0.9));
}

/// Capture, and energies across which orbiting ceases: no tables.
#[test]
fn what_is_not_smooth_has_none() {
    for (name, numbers, range, b_max) in
        [("power_law", vec![-1.0, 4.0], [0.4, 0.6], 4.0), ("lennard_jones", vec![1.0, 1.0], [0.5, 1.2], 4.0)]
    {
        assert_eq!(built(&deflector(name, &numbers), range, b_max, 2), None, "{name}");
    }
}

/// Errors of 3, 5 and 9 tables, of which the rule of geometric convergence makes 4e-9 and 2e-2 for the last order.
#[test]
fn the_last_order_is_tried_where_there_is_hope() {
    assert!(!is_in_vain(&[1e-1, 1e-2]), "too soon to tell");
    assert!(!is_in_vain(&[1e-1, 4e-3, 4e-5]));
    assert!(is_in_vain(&[2e-1, 1e-1, 6e-2]));
    // What has grown is no hope of less.
    assert!(is_in_vain(&[1e-3, 1e-3, 1.0]));
}

/// Energies of an order are those of the order before and new ones between: each table is the one at its energy.
#[test]
fn tables_of_the_order_before_are_among_those_of_the_next() {
    let deflector = deflector("lennard_jones", &[1.0, 1.0]);
    let energies = built(&deflector, [2.0, 2.6], 3.0, 2).unwrap();
    assert!(energies.tables.len() > ORDERS[0], "{}", energies.tables.len());
    for (share, _, table) in &energies.tables {
        let energy = (2.0 / share).clamp(2.0, 2.6);
        let anew = EventTable::build(&deflector, energy, 3.0, 1, &mut Ticker::quiet(&Control::new(0)));
        // The energy is an ulp off, and series may be cut elsewhere: what they are refined to is 1e-7 of the angles.
        let off =
            |part: f64| (table.angle(part).unwrap() - anew.as_ref().unwrap().angle(part).unwrap()).abs();
        assert!([0.1, 0.4, 0.7].into_iter().all(|part| off(part) < 1e-7));
    }
}
