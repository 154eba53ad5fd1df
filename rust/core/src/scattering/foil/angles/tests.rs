use super::*;
use crate::parallel::{Control, Ticker};
use crate::potentials::Potential;
use crate::potentials::parameters::Value;
use crate::registry;
use std::sync::Arc;

fn screened() -> Arc<dyn Potential> {
    let values = [Value::Number(2.0 * 79.0 * 14.4), Value::Number(0.12), Value::Word("zbl".into())];
    (registry::potential("screened_coulomb").unwrap().make)(&values).unwrap()
}

/// Against direct quadrature, where the table was not made: relative to the angle, down to what is far out.
#[test]
fn the_table_is_right_between_its_points() {
    let control = Control::new(0);
    let ticker = &mut Ticker::quiet(&control);
    let potential = screened();
    let deflector = Source::deflector(&potential).unwrap();
    let source = Source { deflector: &deflector, minimum: 1e-6, threads: 1 };
    let angles = Angles::build(&potential, &source, (7e3, 7.7e6), &|_, _| 1.0, ticker).unwrap();
    assert!(angles.error() < 4e-6 && angles.bytes() < 2_000_000, "{} {}", angles.error(), angles.bytes());
    let Angles::Table(table) = &angles else { panic!("no table") };
    for i in 0..60 {
        let energy = 7.1e3 * 1.123_f64.powi(i);
        let radii: Vec<f64> = (0..50).map(|j| 1e-6 * 1.31_f64.powi(j)).filter(|b| *b < 1.0).collect();
        let found = deflector.deflect(&vec![energy; radii.len()], &radii, false, 1, ticker).unwrap();
        for (b, found) in radii.iter().zip(&found) {
            let (sine, cosine) = table.half(energy, *b);
            let off = (2.0 * atan2(sine, cosine) - found.angle).abs();
            // Refined to 1e-6 of the largest angle of an interval, of which ψ falls to a tenth or so.
            assert!(off < 2e-5 * found.angle, "{energy} {b} {off} {}", found.angle);
        }
    }
}

/// Helium on silicon, as far out as it turns by a hundredth: a hundred times faster than cells without a series, of which there
/// were some, by the places where errors are looked for.
#[test]
fn what_is_smooth_has_series_in_every_cell() {
    let control = Control::new(0);
    let ticker = &mut Ticker::quiet(&control);
    let values = [Value::Number(28.0 * 14.4), Value::Number(0.156), Value::Word("zbl".into())];
    let potential = (registry::potential("screened_coulomb").unwrap().make)(&values).unwrap();
    let deflector = Source::deflector(&potential).unwrap();
    let source = Source { deflector: &deflector, minimum: 1e-2, threads: 1 };
    for lowest in [8.75, 12.25, 17.5, 26.0] {
        let radius = |from: f64, _: f64| {
            let ticker = &mut Ticker::quiet(&control);
            reach(&source, &[f64::max(from, lowest)], 1e-2, 1.53, ticker).unwrap()[0]
        };
        let angles = Angles::build(&potential, &source, (lowest, 8.75e3), &radius, ticker).unwrap();
        assert!(angles.error() < 4e-6 && angles.bytes() < 1_000_000, "{} {}", angles.error(), angles.bytes());
        let Angles::Table(table) = &angles else { panic!("no table") };
        let without = table.cells.iter().filter(|cell| cell.pieces.is_empty()).count();
        assert_eq!(without, 0, "from {lowest}");
    }
}
