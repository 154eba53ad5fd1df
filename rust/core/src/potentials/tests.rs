//! What every registered potential must satisfy.

use super::*;
use crate::registry::POTENTIALS;
use proptest::prelude::*;

fn parameters(declaration: &Declaration, seeds: &[f64; 4]) -> Vec<f64> {
    declaration
        .parameters
        .iter()
        .zip(seeds)
        .map(|(parameter, seed)| if parameter.positive { seed.abs() + 0.3 } else { *seed })
        .collect()
}

proptest! {
    /// Force and curvature are the derivatives of the value: five-point differences, whose own error is
    /// h⁴/30 of the fifth derivative plus rounding over h.
    #[test]
    fn force_and_curvature_are_derivatives(seeds in prop::array::uniform4(-2.0..2.0f64), r in 0.7..3.0f64) {
        for declaration in POTENTIALS {
            let potential = declaration.build(&parameters(declaration, &seeds)).unwrap();
            let h = 1e-3 * r;
            let points: Vec<f64> = (-2..=2).map(|i| r + f64::from(i) * h).collect();
            let [value, force, curvature] = potential.evaluate(&points);
            let slope = |f: &[f64]| (f[0] - 8.0 * f[1] + 8.0 * f[3] - f[4]) / (12.0 * h);
            let size = value.iter().chain(&force).chain(&curvature).fold(1e-3f64, |m, x| m.max(x.abs()));
            prop_assert!((slope(&value) + force[2]).abs() < 2e-6 * size, "{declaration:?}");
            prop_assert!((slope(&force) + curvature[2]).abs() < 2e-5 * size, "{declaration:?}");
        }
    }

    /// Units by powers of two change no bit.
    #[test]
    fn scaling_is_exact(seeds in prop::array::uniform4(-2.0..2.0f64), r in 0.7..3.0f64, length in -30..30i32, energy in -30..30i32) {
        for declaration in POTENTIALS {
            let potential = declaration.build(&parameters(declaration, &seeds)).unwrap();
            let scaled = potential.scaled(length, energy);
            let factor = |exponent: i32| 2.0f64.powi(exponent);
            let here = potential.evaluate(&[r]);
            let there = scaled.evaluate(&[r * factor(-length)]);
            prop_assert_eq!(here[0][0], there[0][0] * factor(energy));
            prop_assert_eq!(here[1][0], there[1][0] * factor(energy - length));
            prop_assert_eq!(here[2][0], there[2][0] * factor(energy - 2 * length));
        }
    }
}

#[test]
fn bad_parameters_are_refused_by_name() {
    for declaration in POTENTIALS {
        let good = vec![1.5; declaration.parameters.len()];
        assert!(declaration.build(&good[1..]).is_err());
        for (index, parameter) in declaration.parameters.iter().enumerate() {
            for bad in [f64::NAN, f64::INFINITY, -1.0] {
                let mut values = good.clone();
                values[index] = bad;
                let outcome = declaration.build(&values);
                if bad == -1.0 && !parameter.positive {
                    assert!(outcome.is_ok());
                } else {
                    assert!(outcome.unwrap_err().to_string().contains(parameter.name));
                }
            }
        }
    }
}
