//! Runs that choose their own steps: tolerance, continuous extension, and the span they keep to.

use super::super::support::{Problem, adaptive, distance};
use super::{Make, PROBLEMS, reference};
use std::sync::{Arc, Mutex};
use visviva_core::Result;
use visviva_core::forces::{Dynamics, Force, Phase};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::numerics::element::Shape;
use visviva_core::ode::Method;
use visviva_core::ode::state::State;
use visviva_core::parallel::{Control, Ticker};
use visviva_core::registry::METHODS;

/// The state at the fraction `theta` of one step of `h` from the start, by the continuous extension, and the ends of the
/// step itself.
fn dense(method: &'static Method, make: Make, h: f64, theta: f64) -> [State<DoubleDouble>; 3] {
    let Problem { state, mut dynamics, .. } = make();
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    let (mut trial, mut clock, norm) = adaptive(method, &dynamics, dynamics.shape, &state, 1e6, 1e3);
    trial.start(true, &mut dynamics, &state, &mut clock, &norm, &mut ticker).unwrap();
    clock.h = DoubleDouble::from(h);
    let outcome = trial.attempt(true, &mut dynamics, &state, &mut clock, &norm, &mut ticker).unwrap();
    assert!(outcome.accepted && !outcome.finished && !outcome.stuck);
    trial.dense(&outcome, &mut dynamics, &state, &mut ticker).unwrap();
    let mut between = state.clone();
    let theta = DoubleDouble::from(theta);
    trial.at(&outcome, &mut dynamics, &state, theta, &mut between, &mut ticker).unwrap();
    let next = trial.next().clone();
    [between, state, next]
}

/// The error of that state.
fn dense_error(method: &'static Method, make: Make, h: f64, theta: f64) -> f64 {
    distance(&dense(method, make, h, theta)[0], &reference(make, theta * h, 64))
}

#[test]
fn the_continuous_extension_has_its_declared_order() {
    for (name, make, _) in PROBLEMS {
        for method in METHODS {
            if !method.adaptive() || !method.has_table() {
                continue;
            }
            for theta in [0.125, 0.3125, 0.5, 0.8125] {
                let (coarse, fine) = (
                    dense_error(method, make, 1.0 / 64.0, theta),
                    dense_error(method, make, 1.0 / 128.0, theta),
                );
                // One step from exact data: the local error, one power more than the order.
                let order = (coarse / fine).log2() - 1.0;
                println!("{name}, {} at θ = {theta}: dense order {order:.3}", method.name);
                assert!(order > f64::from(method.dense_order) - 0.15, "{name}, {}: {order}", method.name);
            }
            // At the ends it is the step itself.
            for (end, theta) in [(1, 0.0), (2, 1.0)] {
                let states = dense(method, make, 1.0 / 128.0, theta);
                let apart = distance(&states[0], &states[end]);
                // Some roundings of double-double.
                assert!(apart < 1e-30, "{name}, {} at θ = {theta}: {apart:e}", method.name);
            }
        }
    }
}

/// Tolerances 10^-exponent for a method of this order. Its steps grow by 10^(1/order) with each power of ten, so that
/// two powers and a half for each order are 10^2.5 times as many; below 1e-16 the references end.
fn exponents_for(order: u32) -> impl Iterator<Item = i32> {
    (4..=(5 * order as i32 / 2).min(16)).step_by(2)
}

#[test]
fn the_error_of_adaptive_methods_follows_the_tolerance() {
    for (name, make, t) in PROBLEMS {
        let exact = reference(make, t, 2048);
        for method in METHODS {
            if !method.adaptive() {
                continue;
            }
            let (mut before, mut steps_before) = (f64::INFINITY, 0);
            for exponent in exponents_for(method.order) {
                let rtol = 10f64.powi(-exponent);
                let Problem { mut state, mut dynamics, .. } = make();
                let control = Control::default();
                let mut ticker = Ticker::quiet(&control);
                let (mut trial, mut clock, norm) =
                    adaptive(method, &dynamics, dynamics.shape, &state, rtol, t);
                trial.start(true, &mut dynamics, &state, &mut clock, &norm, &mut ticker).unwrap();
                let (mut steps, mut finished) = (0, false);
                while !finished {
                    let outcome =
                        trial.attempt(true, &mut dynamics, &state, &mut clock, &norm, &mut ticker).unwrap();
                    trial.keep(outcome.accepted, &mut state);
                    assert!(!outcome.stuck);
                    (finished, steps) = (outcome.finished, steps + 1);
                }
                let error = distance(&state, &exact);
                println!("{name}, {}: rtol {rtol:.0e}: error {error:.1e} in {steps} steps", method.name);
                assert!(error < 10.0 * rtol, "{name}, {}: rtol {rtol:e}, error {error:e}", method.name);
                // Of two steps the first was chosen without knowledge of the error, and may be much too short.
                let known = steps_before > 2;
                assert!(error < before || !known, "{name}, {}: no better at rtol {rtol:e}", method.name);
                (before, steps_before) = (error, steps);
            }
        }
    }
}

/// Notes the earliest and latest value of the first coordinate, which moves uniformly and so tells the time.
struct Watch(Arc<Mutex<(f64, f64)>>);
impl Force<f64> for Watch {
    fn apply(&mut self, phase: &Phase<'_, f64>, a: &mut [f64], _: bool, _: &mut Ticker<'_>) -> Result<()> {
        let q = phase.q;
        let mut seen = self.0.lock().unwrap();
        *seen = (seen.0.min(q[0]), seen.1.max(q[0]));
        a.copy_from_slice(&[0.0, -q[1].powi(3)]);
        Ok(())
    }
}

#[test]
fn adaptive_methods_never_evaluate_beyond_the_span() {
    for method in METHODS {
        // Series are of systems that have them, and evaluated at the nodes alone.
        if !method.adaptive() || !method.has_table() {
            continue;
        }
        for end in [0.01, 1.0, 7.3, -0.01, -7.3] {
            let seen = Arc::new(Mutex::new((0.0, 0.0)));
            let shape = Shape { rows: 1, components: 2 };
            let mut dynamics = Dynamics::new(shape, vec![Box::new(Watch(seen.clone()))]);
            let mut state = State::new(&[0.0, 1.0], &[1.0, 0.5]);
            let control = Control::default();
            let mut ticker = Ticker::quiet(&control);
            let (mut trial, mut clock, norm) = adaptive(method, &dynamics, dynamics.shape, &state, 1e-8, end);
            trial.start(true, &mut dynamics, &state, &mut clock, &norm, &mut ticker).unwrap();
            let mut finished = false;
            while !finished {
                let outcome =
                    trial.attempt(true, &mut dynamics, &state, &mut clock, &norm, &mut ticker).unwrap();
                trial.dense(&outcome, &mut dynamics, &state, &mut ticker).unwrap();
                trial.keep(outcome.accepted, &mut state);
                finished = outcome.finished;
            }
            assert_eq!(clock.elapsed, end);
            let (first, last) = *seen.lock().unwrap();
            // The clock itself is rounded, most in the sums of the continuous extension: measured 2.1e-15 of the end.
            let slack = 1e-14 * end.abs();
            assert!(
                first >= end.min(0.0) - slack && last <= end.max(0.0) + slack,
                "{}: {first} {last}",
                method.name
            );
            assert!((last - first - end.abs()).abs() <= slack, "{}: the end is evaluated", method.name);
        }
    }
}
