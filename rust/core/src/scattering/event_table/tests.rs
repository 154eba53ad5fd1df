use super::*;
use crate::parallel::{Control, Ticker};
use crate::potentials::parameters::Value;
use crate::registry;
use crate::scattering::deflection::{Deflector, Status};

fn deflector(name: &str, numbers: &[f64]) -> Deflector {
    let values: Vec<Value> = numbers.iter().map(|x| Value::Number(*x)).collect();
    let potential = (registry::potential(name).unwrap().make)(&values).unwrap();
    Deflector::for_table(&potential, 1e-12).unwrap()
}

fn built(deflector: &Deflector, energy: f64, b_max: f64) -> EventTable {
    EventTable::build(deflector, energy, b_max, 1, &mut Ticker::quiet(&Control::new(0))).unwrap()
}

/// Repulsive and attractive, with a rainbow, whole turns, capture, an edge, an open center: small, right, and the same
/// when made again by other threads.
#[test]
fn tables_of_every_kind() {
    for (name, numbers, energy, b_max) in [
        ("yukawa", vec![1.0, 1.0], 0.7, 8.0),
        ("coulomb", vec![-1.0], 0.7, 8.0),
        ("lennard_jones", vec![1.0, 1.0], 2.0, 4.0),
        ("lennard_jones", vec![1.0, 1.0], 0.5, 4.0),
        ("hard_sphere", vec![1.0], 0.5, 1.3),
        ("square_well", vec![1.0, 1.0], 0.5, 1.3),
        ("power_law", vec![-1.0, 4.0], 0.5, 4.0),
        ("power_law", vec![1.0, 2.0], 0.5, 4.0),
        ("plummer", vec![1.0, 1.0], 0.5, 4.0),
    ] {
        let deflector = deflector(name, &numbers);
        let table = built(&deflector, energy, b_max);
        assert!(
            table.bytes() <= 65_536 && table.error() <= MOST_ERROR && table.unresolved() < 1e-6,
            "{name}: {table:?}"
        );
        assert_eq!(built(&deflector, energy, b_max), table, "{name}");
        let control = Control::new(0);
        let others = EventTable::build(&deflector, energy, b_max, 3, &mut Ticker::quiet(&control)).unwrap();
        assert_eq!(others.hash(), table.hash());
        let parts: Vec<f64> = (0..2000).map(|i| ((f64::from(i) + 0.377) / 2000.0).sqrt()).collect();
        let b: Vec<f64> = parts.iter().map(|part| part * b_max).collect();
        let found =
            deflector.deflect(&vec![energy; b.len()], &b, false, 1, &mut Ticker::quiet(&control)).unwrap();
        for (part, found) in parts.iter().zip(&found) {
            let angle = table.angle(*part);
            assert_eq!(angle.is_none(), found.status == Status::Captured, "{name} at {part}");
            let Some(angle) = angle else { continue };
            // Refined to 1e-9 of the largest angle of a piece, where it is tried; three times that between. An edge
            // that cuts a piece of 2^-26 is not among these points.
            let off = (angle - found.angle).abs();
            assert!(off <= 3e-8 * found.angle.abs() + 1e-9, "{name} at {part}: {angle} {}", found.angle);
        }
    }
}

#[test]
fn other_tables_have_other_hashes() {
    let deflector = deflector("yukawa", &[1.0, 1.0]);
    assert_ne!(built(&deflector, 0.7, 8.0).hash(), built(&deflector, 0.7000001, 8.0).hash());
    assert_ne!(built(&deflector, 0.7, 8.0).hash(), built(&deflector, 0.7, 8.000001).hash());
}
