//! What every registered potential must satisfy.

use super::parameters::{Kind, Parameter, Sign};
use super::*;
use crate::registry::POTENTIALS;
use proptest::prelude::*;

/// A value for each parameter from seeds; none for a potential that takes what no seed can make.
fn parameters(declaration: &PotentialDeclaration, seeds: &[f64; 4]) -> Option<Vec<Value>> {
    if declaration.name == "tabulated" {
        return Some(table(seeds));
    }
    if declaration.name == "piecewise_polynomial" {
        return Some(fitted(seeds));
    }
    if declaration.name == "expressed" {
        return Some(formula(seeds));
    }
    let seeds = seeds.iter().cycle();
    let value = |(parameter, seed): (&Parameter, &f64)| match parameter.kind {
        Kind::Number(Sign::Any) => Some(Value::Number(*seed)),
        Kind::Number(_) => Some(Value::Number(seed.abs() + 0.3)),
        Kind::Choice(words) => {
            let at = (seed.abs() * 100.0) as usize % words.len();
            Some(Value::Word(words[at].to_owned()))
        }
        _ => None,
    };
    let values: Option<Vec<Value>> = declaration.parameters.iter().zip(seeds).map(value).collect();
    values.map(|values| consistent(declaration.name, values))
}

/// With exponents that go together.
fn consistent(name: &str, mut values: Vec<Value>) -> Vec<Value> {
    match name {
        "mie" => values[2] = Value::Number(values[2].number() + values[3].number()),
        // So smooth at contact that differences across it are derivatives.
        "soft_sphere" => values[2] = Value::Number(values[2].number() + 5.0),
        _ => {}
    }
    values
}

/// A smooth table from 0.6 to 3.2.
fn table(seeds: &[f64; 4]) -> Vec<Value> {
    let r: Vec<f64> = (0..200).map(|i| 0.6 + 0.013 * f64::from(i)).collect();
    let v = |r: &f64| seeds[0] / r + seeds[1] * Exponential::exp(-r * seeds[2].abs()) + seeds[3];
    vec![Value::Table(r.iter().copied().collect()), Value::Table(r.iter().map(v).collect())]
}

/// The same sum as nodes: r, the four parameters, a/r, c r, its exponential, that times b, and all of it.
fn formula(seeds: &[f64; 4]) -> Vec<Value> {
    let (variable, parameter, sum, product, quotient, exp) = (1.0, 2.0, 4.0, 5.0, 6.0, 12.0);
    let parameters = (0..4).map(|i| (parameter, f64::from(i), vec![]));
    let nodes = core::iter::once((variable, 0.0, vec![])).chain(parameters).chain([
        (quotient, 0.0, vec![1.0, 0.0]),
        (product, 0.0, vec![3.0, 0.0]),
        (exp, 0.0, vec![6.0]),
        (product, 0.0, vec![2.0, 7.0]),
        (sum, 0.0, vec![5.0, 8.0, 4.0]),
    ]);
    let rows = nodes.flat_map(|(operation, value, of): (f64, f64, Vec<f64>)| {
        [vec![operation, value, of.len() as f64], of].concat()
    });
    let table: Vec<f64> = [1.0, 9.0].into_iter().chain(rows).collect();
    // The last is nothing, as all of V is far away.
    let values = vec![seeds[0], seeds[1], -seeds[2].abs(), 0.0];
    vec![Value::Table(table.into()), Value::Table(values.into()), Value::Number(1.0), Value::Number(1.0)]
}

/// What is made of a smooth function from 0.6 to 3.2.
fn fitted(seeds: &[f64; 4]) -> Vec<Value> {
    let v = |r: &f64| seeds[0] / r + seeds[1] * Exponential::exp(-r * seeds[2].abs()) + seeds[3];
    let made =
        fit::fit(&mut |r: &[f64]| Ok(r.iter().map(v).collect()), [0.6, 3.2], 1e-12, fit::POTENTIAL).unwrap();
    vec![Value::Table(made.breaks.into()), Value::Table(made.coefficients.into()), Value::Number(made.error)]
}

/// Every potential of the registry that seeds can make and that has a force.
fn all(seeds: &[f64; 4]) -> Vec<Arc<dyn Potential>> {
    let make = |declaration: &&'static PotentialDeclaration| {
        parameters(declaration, seeds).map(|values| declaration.build(&values).unwrap())
    };
    POTENTIALS.iter().filter_map(make).filter(|potential| !potential.jumps()).collect()
}

/// Where numbers leave the range there is a limit, and never an undefined number: no force far away, and near zero what
/// the potential says, finite or not.
#[test]
fn the_ends_of_the_range_are_limits() {
    for seeds in [[1.25, 0.75, 1.5, 1.0], [-1.25, 2.0, 0.1, 1.9], [0.3, -1.0, 1.7, 0.05]] {
        for potential in all(&seeds).into_iter().filter(|potential| potential.domain().is_none()) {
            let near = [0.0, 5e-324, 1e-310, 1e-200, 1e-160, 1e-110, 1e-60];
            for column in potential.evaluate(&near) {
                assert!(column.iter().all(|x| !x.is_nan()), "{potential:?} near zero: {column:?}");
                assert!(
                    !potential.singular() || column[0].is_infinite(),
                    "{potential:?} at zero: {column:?}"
                );
            }
            let [value, force, curvature] = potential.evaluate(&[1e60, 1e160, 1e250, 1e300, f64::MAX]);
            for column in [value, force, curvature] {
                assert!(column.iter().all(|x| x.abs() < 1e-2), "{potential:?} far away: {column:?}");
            }
        }
    }
}

proptest! {
    /// Force and curvature are the derivatives of the value: five-point differences, whose own error is
    /// h⁴/30 of the fifth derivative plus rounding over h.
    #[test]
    fn force_and_curvature_are_derivatives(seeds in prop::array::uniform4(-2.0..2.0f64), r in 0.7..3.0f64) {
        for potential in all(&seeds) {
            let h = 1e-3 * r;
            let points: Vec<f64> = (-2..=2).map(|i| r + f64::from(i) * h).collect();
            let [value, force, curvature] = potential.evaluate(&points);
            let slope = |f: &[f64]| (f[0] - 8.0 * f[1] + 8.0 * f[3] - f[4]) / (12.0 * h);
            let size = value.iter().chain(&force).chain(&curvature).fold(1e-3f64, |m, x| m.max(x.abs()));
            prop_assert!((slope(&value) + force[2]).abs() < 2e-6 * size, "{potential:?}");
            prop_assert!((slope(&force) + curvature[2]).abs() < 2e-5 * size, "{potential:?}");
        }
    }

    /// Units by powers of two change no bit.
    #[test]
    fn scaling_is_exact(seeds in prop::array::uniform4(-2.0..2.0f64), r in 0.7..3.0f64, length in -30..30i32, energy in -30..30i32) {
        for potential in all(&seeds) {
            let scaled = potential.scaled(Units { length, mass: energy - 2 * length, time: 0 });
            let factor = |exponent: i32| 2.0f64.powi(exponent);
            let here = potential.evaluate(&[r]);
            let there = scaled.evaluate(&[r * factor(-length)]);
            prop_assert_eq!(here[0][0], there[0][0] * factor(energy));
            prop_assert_eq!(here[1][0], there[1][0] * factor(energy - length));
            prop_assert_eq!(here[2][0], there[2][0] * factor(energy - 2 * length));
        }
    }
}

/// V and its slopes from one evaluation have the bits of each by itself, in every lane.
#[test]
fn all_at_once_is_each_by_itself() {
    for seeds in [[1.25, 0.75, 1.5, 1.0], [-1.25, 2.0, 0.1, 1.9], [0.3, -1.0, 1.7, 0.05]] {
        for potential in all(&seeds) {
            let places: Vec<Lanes> = (0..5)
                .map(|row| Lanes([0, 1, 2, 3, 4, 5, 6, 7].map(|k| 0.61 + 0.06 * f64::from(8 * row + k))))
                .collect();
            let empty = vec![Lanes([0.0; 8]); places.len()];
            let (mut value, mut force, mut alone) = (empty.clone(), empty.clone(), empty.clone());
            let mut curvature = empty.clone();
            potential.all_rows(&places, &mut value, &mut force, &mut curvature);
            potential.value_rows(&places, &mut alone);
            assert_eq!(value, alone, "{potential:?}");
            potential.force_rows(&places, &mut alone);
            assert_eq!(force, alone, "{potential:?}");
            for (row, place) in places.iter().enumerate() {
                for lane in 0..8 {
                    let at = potential.at(place.0[lane]);
                    let [v, f, c] = [value[row], force[row], curvature[row]].map(|row| row.0[lane]);
                    assert_eq!([v, f, c].map(f64::to_bits), at.map(f64::to_bits), "{potential:?}");
                }
                let evaluated = potential.evaluate(&place.0);
                assert_eq!(evaluated[2], curvature[row].0.to_vec(), "{potential:?}");
            }
        }
    }
}

/// Precise sums see strengths near one, whatever the units of the scene: the values differ by the power of two alone.
#[test]
fn a_strength_of_any_size_is_brought_near_one() {
    let seeds = [1.25, 0.75, 1.5, 1.0];
    for declaration in POTENTIALS {
        let Some(values) = parameters(declaration, &seeds) else { continue };
        let potential = declaration.build(&values).unwrap();
        if potential.jumps() {
            continue;
        }
        assert!(potential.near_one(0).is_none(), "{potential:?} is near one already");
        let r = DoubleDouble::from(1.75);
        let (value, force) = potential.precise(r);
        for (length, energy) in [(0, -1000), (0, 900), (-310, 20), (150, -600)] {
            let units = Units { length, mass: energy - 2 * length, time: 0 };
            // An energy times length⁶ in such units may be no number.
            let fine = |value: &Value| !matches!(value, Value::Number(x) if !x.is_normal());
            if !declaration.scaled(&values, units).iter().all(fine) {
                continue;
            }
            let far = potential.scaled(units);
            let (near, unit) = far.near_one(-length).unwrap();
            let (near_value, near_force) = near.precise(r);
            let factor = 2.0f64.powi(unit + energy);
            assert_eq!(value.to_f64(), near_value.to_f64() * factor, "{far:?}");
            assert_eq!(force.to_f64(), near_force.to_f64() * factor, "{far:?}");
        }
    }
}

#[test]
fn bad_parameters_are_refused_by_name() {
    for declaration in POTENTIALS {
        let Some(good) = parameters(declaration, &[1.5; 4]) else { continue };
        assert!(declaration.build(&good[1..]).is_err());
        for (index, parameter) in declaration.parameters.iter().enumerate() {
            for bad in [f64::NAN, f64::INFINITY, -1.0] {
                let Kind::Number(sign) = parameter.kind else { continue };
                let mut values = good.clone();
                values[index] = Value::Number(bad);
                let outcome = declaration.build(&values);
                // Refusals of parameters that do not go together are those of the potential's own tests.
                if bad == -1.0 && sign == Sign::Any {
                    assert!(outcome.is_ok());
                } else {
                    assert!(outcome.unwrap_err().to_string().contains(parameter.name));
                }
            }
        }
    }
}

/// The strength of k/rⁿ has a dimension that depends on n; a fractional power of two is rounded, a whole one exact.
#[test]
fn a_dimension_may_depend_on_another_parameter() {
    static POWER: PotentialDeclaration = Declaration {
        parameters: &[
            Parameter::new("k", Kind::Number(Sign::Any), "strength")
                .depending(|values| [2.0 + values[1].number(), 1.0, -2.0]),
            Parameter::number("n", [0; 3], "power"),
        ],
        ..coulomb::DECLARATION
    };
    let units = Units { length: 3, mass: 1, time: 2 };
    for (n, exponent) in [(2.0, 12.0 + 1.0 - 4.0), (0.5, 7.5 + 1.0 - 4.0)] {
        let scaled = POWER.scaled(&[Value::Number(1.0), Value::Number(n)], units);
        let expected = 2.0f64.powf(-exponent);
        assert!((scaled[0].number() / expected - 1.0).abs() < 4e-16);
        assert_eq!(scaled[1].number(), n);
    }
}
