//! The order of each method, measured on nonlinear problems in double-double.

use super::support::{Problem, advance, distance};
use super::{Make, PROBLEMS, reference};
use visviva_core::integrators::Method;
use visviva_core::integrators::fixed::{Place, run};
use visviva_core::parallel::{Control, Ticker};
use visviva_core::registry::METHODS;

/// Steps per span at which a method of this order is in its asymptotic regime, far from 1e-30. Powers of
/// two, as the spans are dyadic: a step that is rounded to a double would end beside the reference.
fn steps_for(order: u32) -> usize {
    match order {
        0..=2 => 512,
        3..=4 => 256,
        _ => 128,
    }
}

#[test]
fn the_reference_is_known_by_two_methods() {
    for (name, make, t) in PROBLEMS {
        let first = reference(make, t, 2048);
        let other = METHODS.iter().find(|method| method.name == "kahan_li8").unwrap();
        let Problem { mut state, mut dynamics, .. } = make();
        advance(other, t / 4096.0, 4096, &mut state, &mut dynamics);
        let apart = distance(&first, &state);
        println!("{name}: two methods of order 8 agree to {apart:.1e}");
        assert!(apart < 1e-21, "{name}: {apart:e}");
    }
}

#[test]
fn measured_order_is_the_declared_order() {
    for (name, make, t) in PROBLEMS {
        let exact = reference(make, t, 2048);
        for method in METHODS {
            let steps = steps_for(method.order);
            let error = |steps: usize| {
                let Problem { mut state, mut dynamics, .. } = make();
                advance(method, t / steps as f64, steps, &mut state, &mut dynamics);
                distance(&state, &exact)
            };
            let (coarse, fine) = (error(steps), error(2 * steps));
            let order = (coarse / fine).log2();
            println!("{name}, {}: order {order:.3} (errors {coarse:.1e}, {fine:.1e})", method.name);
            assert!((order - f64::from(method.order)).abs() < 0.15, "{name}, {}: order {order}", method.name);
        }
    }
}

/// The error after `steps + 3/8` steps of about `t / steps`, the last part being a shadow sub-step.
fn error_between_nodes(method: &Method, make: Make, t: f64, steps: usize) -> f64 {
    let Problem { mut state, mut dynamics, .. } = make();
    let h = t / steps as f64;
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    let mut last = None;
    let places = [Place { node: steps as u64, past: Some(0.375 * h) }];
    let (taken, outcome) =
        run(method, h, u64::MAX, &mut state, &mut dynamics, places.into_iter(), &mut ticker, |_, state| {
            last = Some(state.clone());
            Ok(())
        });
    outcome.unwrap();
    assert_eq!(taken, steps as u64);
    distance(&last.unwrap(), &reference(make, t + 0.375 * h, 2048))
}

#[test]
fn states_between_nodes_have_the_declared_dense_order() {
    for (name, make, t) in PROBLEMS {
        for method in METHODS.iter().filter(|method| !method.adaptive()) {
            let steps = steps_for(method.dense_order);
            let error = |steps| error_between_nodes(method, make, t, steps);
            let order = (error(steps) / error(2 * steps)).log2();
            println!("{name}, {}: order between nodes {order:.3}", method.name);
            assert!((order - f64::from(method.dense_order)).abs() < 0.15, "{name}, {}: {order}", method.name);
        }
    }
}
