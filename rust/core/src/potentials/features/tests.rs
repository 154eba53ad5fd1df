use super::*;
use crate::potentials::parameters::Value;
use crate::registry::potential;
use std::sync::Arc;

fn made(name: &str, values: &[f64]) -> Arc<dyn Potential> {
    let values: Vec<Value> = values.iter().map(|x| Value::Number(*x)).collect();
    potential(name).unwrap().build(&values).unwrap()
}

#[test]
fn a_well_as_narrow_as_another_length_is_one() {
    let found = Features::of(made("morse", &[1.0, 1e4, 1.03]).as_ref());
    assert!(found.marks.contains(&1.03) && found.unresolved.is_empty());
    assert!(found.marks.iter().all(|r| (r - 1.03).abs() <= 0.0033));
    assert!(found.places.len() > found.marks.len());
    for (name, values) in
        [("morse", &[1.0, 2.0, 1.03][..]), ("lennard_jones", &[1.0, 1.0]), ("yukawa", &[1.0, 1.0])]
    {
        let found = Features::of(made(name, values).as_ref());
        assert!(found.marks.is_empty() && found.places.is_empty(), "{name}");
    }
}

#[test]
fn crowded_pieces_are_those_of_a_feature() {
    let even: Vec<f64> = (4..32).map(|k| 0.25 * f64::from(k)).collect();
    assert!(crowded(&even).is_empty());
    let mut about = even.clone();
    about.extend((0..8).map(|k| 3.0 + 0.001 * f64::from(k)));
    about.sort_by(f64::total_cmp);
    about.dedup();
    let marks = crowded(&about);
    assert!(marks.len() >= 8 && marks.iter().all(|r| (3.0..3.25).contains(r)), "{marks:?}");
    // What is narrow everywhere has no feature, but places are not far apart.
    let fine: Vec<f64> = (0..4000).map(|k| 1.0 + 0.001 * f64::from(k)).collect();
    assert!(crowded(&fine).len() < 200);
}

#[test]
fn series_that_end_small_tell_all() {
    let cell = Cell { from: 1.0, to: 1.125, depth: 3, tail: None };
    let of = |f: &dyn Fn(f64) -> f64| nodes(&cell).map(f);
    assert!(told(&of(&|r| r.powi(-6))).is_ok());
    // Of what falls by sixty e-folds the logarithm does.
    assert!(told(&of(&|r| (-500.0 * r).exp())).is_ok());
    assert!(told(&of(&|r| r.powi(-6) + (-((r - 1.05) / 0.003).powi(2)).exp())).is_err());
    assert!(told(&of(&|r| if r < 1.1 { f64::INFINITY } else { 1.0 })).is_err());
    // A part that the series of the whole has, and one that it has not.
    let part = Cell { to: 1.01, ..cell };
    let smooth = |r: f64| r.powi(-6);
    let values = nodes(&part).map(smooth);
    let series = told(&of(&smooth)).unwrap();
    assert!(series.agrees(&cell, &part, &values));
    assert!(!series.agrees(&cell, &part, &values.map(|v| v * (1.0 + 1e-8))));
}
