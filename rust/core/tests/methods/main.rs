//! Every method of the registry, held to what it declares about itself.
//!
//! Register a method and it is tested here; nothing below knows any method by name but the golden cases.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, missing_docs)]

mod support;

use support::{
    Problem, Stepper, advance, bodies, distance, exactly, harmonic, henon_heiles, momenta, three_bodies,
};
use visviva_core::forces::{Dynamics, Force};
use visviva_core::integrators::adaptive::{Adaptive, Clock, Reduce, Reference, Tolerance};
use visviva_core::integrators::fixed::{Place, place, run};
use visviva_core::integrators::state::State;
use visviva_core::integrators::{Embedded, Method, Scheme};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::numerics::element::Shape;
use visviva_core::numerics::real::Real;
use visviva_core::parallel::{Control, Ticker};
use visviva_core::registry::METHODS;

type Make = fn() -> Problem<DoubleDouble>;
const PROBLEMS: [(&str, Make, f64); 2] = [
    ("Hénon–Heiles", henon_heiles::<DoubleDouble>, 2.0),
    ("three bodies", three_bodies::<DoubleDouble>, 0.75),
];

/// The state at `t`, by the tableau of highest order with a step far below what the tests use.
fn reference(make: Make, t: f64, steps: usize) -> State<DoubleDouble> {
    let method = METHODS.iter().max_by_key(|method| (method.order, method.adaptive())).unwrap();
    let Problem { mut state, mut dynamics, .. } = make();
    advance(method, t / steps as f64, steps, &mut state, &mut dynamics);
    state
}

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

/// All lanes are one trajectory.
struct Alone;
impl Reduce<DoubleDouble> for Alone {
    fn largest(&self, value: DoubleDouble) -> DoubleDouble {
        value
    }
}
impl Reduce<f64> for Alone {
    fn largest(&self, value: f64) -> f64 {
        value
    }
}

fn still<S: Real>(rtol: f64) -> (Tolerance<S>, Reference<S>) {
    let rtol = S::splat(rtol);
    (
        Tolerance { rtol, atol_q: rtol, atol_v: rtol },
        Reference { position: [S::zero(); 3], velocity: [S::zero(); 3] },
    )
}

/// The error of the continuous extension at the fraction `theta` of one step of `h`, from the start.
fn dense_error(method: &Embedded, make: Make, h: f64, theta: f64) -> f64 {
    let Problem { state, mut dynamics, .. } = make();
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    let (tolerance, at) = still(1e6);
    let mut engine = Adaptive::new(method, &state, tolerance, at, f64::INFINITY);
    let mut clock = Clock::new(DoubleDouble::from(1e3));
    let mut state = state;
    engine.start(true, &state, &mut clock, &mut dynamics, &Alone, &mut ticker).unwrap();
    clock.h = DoubleDouble::from(h);
    let outcome = engine.step(true, &mut state, &mut clock, &mut dynamics, &Alone, &mut ticker).unwrap();
    assert!(outcome.accepted && !outcome.finished && !outcome.stuck);
    engine.prepare_dense(&state, outcome.h, &mut dynamics, &mut ticker).unwrap();
    let mut between = state.clone();
    engine.interpolate(&state, outcome.h, DoubleDouble::from(theta), &mut between);
    distance(&between, &reference(make, theta * h, 64))
}

#[test]
fn the_continuous_extension_has_its_declared_order() {
    for (name, make, _) in PROBLEMS {
        for method in METHODS {
            let Scheme::Embedded(embedded) = &method.scheme else { continue };
            for theta in [0.125, 0.3125, 0.5, 0.8125] {
                let (coarse, fine) = (
                    dense_error(embedded, make, 1.0 / 64.0, theta),
                    dense_error(embedded, make, 1.0 / 128.0, theta),
                );
                // One step from exact data: the local error, one power more than the order.
                let order = (coarse / fine).log2() - 1.0;
                println!("{name}, {} at θ = {theta}: dense order {order:.3}", method.name);
                assert!(order > f64::from(method.dense_order) - 0.15, "{name}, {}: {order}", method.name);
            }
            // At the ends it is the step itself.
            for theta in [0.0, 1.0] {
                let error = dense_error(embedded, make, 1.0 / 128.0, theta);
                assert!(error < 1e-17, "{name}, {} at θ = {theta}: {error:e}", method.name);
            }
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

#[test]
fn the_error_of_adaptive_methods_follows_the_tolerance() {
    for (name, make, t) in PROBLEMS {
        let exact = reference(make, t, 2048);
        for method in METHODS {
            let Scheme::Embedded(embedded) = &method.scheme else { continue };
            let mut before = f64::INFINITY;
            for exponent in [4, 6, 8, 10, 12, 14, 16] {
                let rtol = 10f64.powi(-exponent);
                let Problem { mut state, mut dynamics, .. } = make();
                let control = Control::default();
                let mut ticker = Ticker::quiet(&control);
                let (tolerance, at) = still(rtol);
                let mut engine = Adaptive::new(embedded, &state, tolerance, at, f64::INFINITY);
                let mut clock = Clock::new(DoubleDouble::from(t));
                engine.start(true, &state, &mut clock, &mut dynamics, &Alone, &mut ticker).unwrap();
                let (mut steps, mut finished) = (0, false);
                while !finished {
                    let outcome = engine
                        .step(true, &mut state, &mut clock, &mut dynamics, &Alone, &mut ticker)
                        .unwrap();
                    engine.commit(outcome.accepted, &mut state);
                    assert!(!outcome.stuck);
                    (finished, steps) = (outcome.finished, steps + 1);
                }
                let error = distance(&state, &exact);
                println!("{name}, {}: rtol {rtol:.0e}: error {error:.1e} in {steps} steps", method.name);
                assert!(error < 10.0 * rtol, "{name}, {}: rtol {rtol:e}, error {error:e}", method.name);
                assert!(error < before, "{name}, {}: no better at rtol {rtol:e}", method.name);
                before = error;
            }
        }
    }
}

/// `max |Mᵀ J M − J|` of one step of `h`, J weighted by the masses; M by central differences.
fn symplectic_defect(method: &Method, make: Make, h: f64) -> f64 {
    // The differences are wrong by ε² f''' ~ 1e-20 and by 1e-32 / ε = 1e-22.
    let epsilon = 1e-10;
    let n = make().mass.len();
    let moved = |index: usize, by: f64| {
        let Problem { mut state, mut dynamics, .. } = make();
        state.all_mut().0[index] += DoubleDouble::from(by);
        advance(method, h, 1, &mut state, &mut dynamics);
        let (y, rest) = state.all();
        y.iter().zip(rest).map(|(&y, &rest)| y + rest).collect::<Vec<_>>()
    };
    let columns: Vec<Vec<DoubleDouble>> = (0..2 * n)
        .map(|index| {
            let (plus, minus) = (moved(index, epsilon), moved(index, -epsilon));
            let two = DoubleDouble::from(2.0) * DoubleDouble::from(epsilon);
            plus.iter().zip(minus).map(|(&plus, minus)| (plus - minus) / two).collect()
        })
        .collect();
    let mass = make().mass;
    let mut worst = 0.0_f64;
    for i in 0..2 * n {
        for j in 0..2 * n {
            let mut form = DoubleDouble::default();
            for k in 0..n {
                let area = columns[i][k] * columns[j][n + k] - columns[i][n + k] * columns[j][k];
                form += DoubleDouble::from(mass[k]) * area;
            }
            let unit = if j == i + n {
                mass[i]
            } else if i == j + n {
                -mass[j]
            } else {
                0.0
            };
            worst = worst.max((form - DoubleDouble::from(unit)).to_f64().abs());
        }
    }
    worst
}

#[test]
fn symplectic_methods_keep_the_symplectic_form_and_the_others_do_not() {
    for (name, make, _) in PROBLEMS {
        for method in METHODS {
            let defect = symplectic_defect(method, make, 0.5);
            println!("{name}, {}: |MᵀJM − J| = {defect:.1e}", method.name);
            if method.symplectic {
                assert!(defect < 1e-17, "{name}, {}: {defect:e}", method.name);
            } else {
                assert!(defect > 1e-9, "{name}, {} is symplectic after all: {defect:e}", method.name);
            }
        }
    }
}

#[test]
fn reversible_methods_return_and_the_others_do_not() {
    for (name, make, _) in PROBLEMS {
        for method in METHODS {
            let Problem { mut state, mut dynamics, .. } = make();
            let start = state.clone();
            advance(method, 0.5, 4, &mut state, &mut dynamics);
            assert!(distance(&state, &start) > 0.1);
            advance(method, -0.5, 4, &mut state, &mut dynamics);
            let missed = distance(&state, &start);
            println!("{name}, {}: returns within {missed:.1e}", method.name);
            if method.reversible {
                assert!(missed < 1e-27, "{name}, {}: {missed:e}", method.name);
            } else {
                assert!(missed > 1e-9, "{name}, {} is reversible after all: {missed:e}", method.name);
            }
        }
    }
}

#[test]
fn reversible_methods_return_in_double_precision_too() {
    for method in METHODS.iter().filter(|method| method.reversible) {
        let Problem { mut state, mut dynamics, .. } = henon_heiles::<f64>();
        let start = exactly(&state);
        advance(method, 1.0 / 16.0, 1000, &mut state, &mut dynamics);
        advance(method, -1.0 / 16.0, 1000, &mut state, &mut dynamics);
        let missed = distance(&exactly(&state), &start);
        println!("{}: returns within {missed:.1e} after 2000 steps", method.name);
        assert!(missed < 1e-13, "{}: {missed:e}", method.name);
    }
}

/// Five unequal bodies in space, without symmetry, softened so that no close encounter magnifies the rounding.
fn five_bodies() -> Problem<f64> {
    let mass = [1.0, 0.7, 0.4, 0.01, 1e-6];
    let q = [0.0, 2.0, -3.0, 5.0, -6.5, 0.0, 0.5, 1.0, -4.0, 4.0, 0.0, -0.25, 0.5, 1.0, -1.0];
    let v = [0.1, 0.2, -0.3, 0.3, -0.2, -0.2, 0.6, -0.5, 0.4, -0.4, 0.0, 0.1, -0.1, 0.1, 0.2];
    bodies(&mass, &q, &v, 0.5)
}

/// Largest drift of `Σ m v` and of `Σ m x × v` over the steps, relative to `Σ m |v|` and `Σ m |x| |v|` (about 1).
fn drift(method: &Method, h: f64, steps: usize) -> [f64; 2] {
    let Problem { mut state, mut dynamics, mass } = five_bodies();
    let start = momenta(&exactly(&state), &mass);
    let mut worst = [0.0_f64; 2];
    for _ in 0..20 {
        advance(method, h, steps / 20, &mut state, &mut dynamics);
        for (index, (now, start)) in momenta(&exactly(&state), &mass).into_iter().zip(start).enumerate() {
            worst[index / 3] = worst[index / 3].max((now - start).to_f64().abs());
        }
    }
    worst
}

#[test]
fn momentum_is_kept_by_all_and_angular_momentum_by_the_symplectic() {
    for method in METHODS {
        let [linear, angular] = drift(method, 1.0 / 16.0, 4000);
        println!("{}: momentum {linear:.1e}, angular momentum {angular:.1e}", method.name);
        assert!(linear < 1e-15, "{}: {linear:e}", method.name);
        if method.symplectic {
            assert!(angular < 1e-14, "{}: {angular:e}", method.name);
        } else {
            assert!(drift(method, 0.25, 400)[1] > 1e-11, "{} keeps angular momentum after all", method.name);
        }
    }
}

/// How far 1e5 steps in `f64` end from the same steps in double-double: round-off alone.
///
/// The steps are small, so that what each loses of the state weighs more than what its force evaluations lose.
fn round_off(method: &Method, compensated: bool) -> f64 {
    let (h, steps) = (1.0 / 8192.0, 100_000);
    let Problem { mut state, mut dynamics, .. } = harmonic::<DoubleDouble>();
    advance(method, h, steps, &mut state, &mut dynamics);
    let exact = state;
    let Problem { mut state, mut dynamics, .. } = harmonic::<f64>();
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    let mut stepper = Stepper::new(method, h, &state);
    for _ in 0..steps {
        stepper.step(&mut state, &mut dynamics, &mut ticker);
        if !compensated {
            state.all_mut().1.fill(0.0);
        }
    }
    distance(&exactly(&state), &exact)
}

#[test]
fn round_off_of_a_hundred_thousand_steps_stays_small_and_compensation_does_it() {
    for method in METHODS {
        let (with, without) = (round_off(method, true), round_off(method, false));
        println!("{}: round-off {with:.1e}, without compensation {without:.1e}", method.name);
        assert!(with < 1e-15, "{}: {with:e}", method.name);
        assert!(without > 2e-15, "{}: {without:e} without compensation", method.name);
    }
}

fn golden(id: &str) -> serde_json::Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/reference/golden.json");
    let cases: Vec<serde_json::Value> =
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    cases.into_iter().find(|case| case["id"] == id).unwrap()
}

#[test]
fn golden_oscillators() {
    for (id, name) in [("GI-verlet-oscillator", "leapfrog"), ("GI-rk4-oscillator", "rk4")] {
        let case = golden(id);
        let number = |group: &str, name: &str| case[group][name].as_f64().unwrap();
        let method = METHODS.iter().find(|method| method.name == name).unwrap();
        let Problem { mut state, mut dynamics, .. } = harmonic::<f64>();
        advance(method, number("inputs", "h"), number("inputs", "n") as usize, &mut state, &mut dynamics);
        let (x, v) = (state.q()[0], state.v()[0]);
        assert!((x - number("outputs", "x_n")).abs() < 5e-16, "{id}: {x}"); // measured 3.4e-16
        assert!((v - number("outputs", "v_n")).abs() < 5e-16, "{id}: {v}");
        if let Some(ratio) = case["outputs"]["energy_ratio"].as_f64() {
            assert!((v * v + x * x - ratio).abs() < 1e-15);
        }
        if let Some(energy) = case["outputs"]["H_mod"].as_f64() {
            let h = number("inputs", "h");
            assert!((0.5 * v * v + 0.5 * (1.0 - h * h / 4.0) * x * x - energy).abs() < 5e-16);
        }
    }
}

#[test]
fn golden_yoshida_coefficients() {
    let case = golden("GI-yoshida4");
    let Scheme::Splitting(table) = &METHODS.iter().find(|method| method.name == "yoshida4").unwrap().scheme
    else {
        panic!("yoshida4 is a splitting")
    };
    for (drift, name) in table.drifts.iter().zip(["w1", "w0", "w1"]) {
        assert_eq!(drift.to_f64(), case["outputs"][name].as_f64().unwrap());
    }
}

#[test]
fn times_find_their_place_among_the_nodes() {
    let on = |node| Place { node, past: None };
    assert_eq!(place(0.0, 0.1, 0.0), on(0));
    // 0.3 is not 3·0.1, but cannot be told from it; nor is -0.3 with a step of -0.1.
    assert_eq!(place(0.3, 0.1, 0.3), on(3));
    assert_eq!(place(-0.3, -0.1, 0.3), on(3));
    assert_eq!(place(0.25, 0.1, 0.25), Place { node: 2, past: Some(0.25 - 2.0 * 0.1) });
    assert_eq!(place(0.28, 0.1, 0.28), Place { node: 2, past: Some(0.28 - 2.0 * 0.1) });
    assert_eq!(place(-0.28, -0.1, 0.28), Place { node: 2, past: Some(-0.28 + 2.0 * 0.1) });
    // Four units in the last place off is off; one is not.
    let off = 0.3 + 4.0 * (0.3_f64).next_up() - 4.0 * 0.3;
    assert!(place(off, 0.1, 0.3).past.is_some());
    assert_eq!(place(0.3_f64.next_up(), 0.1, 0.3), on(3));
    // Far from zero the time itself is coarser.
    assert_eq!(place(0.3 + 1e-10, 0.1, 1e6), on(3));
    // Beyond 2^51 steps.
    assert_eq!(place(3e15, 1.0, 3e15), on(3_000_000_000_000_000));
}

#[test]
fn a_run_stops_at_its_step_limit_and_records_nodes_to_the_bit() {
    for method in METHODS.iter().filter(|method| !method.adaptive()) {
        let control = Control::default();
        let mut ticker = Ticker::quiet(&control);
        let h = 1.0 / 32.0;
        let Problem { mut state, mut dynamics, .. } = three_bodies::<f64>();
        let mut seen = Vec::new();
        let places = [(0, None), (3, Some(0.01)), (3, Some(0.02)), (7, None), (12, None)]
            .map(|(node, past)| Place { node, past });
        let (taken, outcome) =
            run(method, h, 10, &mut state, &mut dynamics, places.into_iter(), &mut ticker, |index, state| {
                seen.push((index, state.clone()));
                Ok(())
            });
        outcome.unwrap();
        assert_eq!((taken, seen.len()), (10, 4), "{}", method.name);
        // Node 7 has the bits of seven plain steps, whatever was looked at on the way.
        let Problem { state: mut plain, mut dynamics, .. } = three_bodies::<f64>();
        advance(method, h, 7, &mut plain, &mut dynamics);
        assert_eq!(seen[3].1.all(), plain.all(), "{}", method.name);
        advance(method, h, 3, &mut plain, &mut dynamics);
        assert_eq!(state.all(), plain.all(), "{}", method.name);
    }
}

/// Notes the earliest and latest value of the first coordinate, which moves uniformly and so tells the time.
struct Watch(std::sync::Arc<std::sync::Mutex<(f64, f64)>>);
impl Force<f64> for Watch {
    fn apply(
        &mut self,
        q: &[f64],
        _: &[f64],
        a: &mut [f64],
        _: bool,
        _: &mut Ticker<'_>,
    ) -> visviva_core::Result<()> {
        let mut seen = self.0.lock().unwrap();
        *seen = (seen.0.min(q[0]), seen.1.max(q[0]));
        a.copy_from_slice(&[0.0, -q[1].powi(3)]);
        Ok(())
    }
}

#[test]
fn adaptive_methods_never_evaluate_beyond_the_span() {
    for method in METHODS {
        let Scheme::Embedded(embedded) = &method.scheme else { continue };
        for end in [0.01, 1.0, 7.3, -0.01, -7.3] {
            let seen = std::sync::Arc::new(std::sync::Mutex::new((0.0, 0.0)));
            let shape = Shape { rows: 1, components: 2 };
            let mut dynamics = Dynamics::new(shape, vec![Box::new(Watch(seen.clone()))]);
            let mut state = State::new(shape, &[0.0, 1.0], &[1.0, 0.5]);
            let control = Control::default();
            let mut ticker = Ticker::quiet(&control);
            let (tolerance, at) = still(1e-8);
            let mut engine = Adaptive::new(embedded, &state, tolerance, at, f64::INFINITY);
            let mut clock = Clock::new(end);
            engine.start(true, &state, &mut clock, &mut dynamics, &Alone, &mut ticker).unwrap();
            let mut finished = false;
            while !finished {
                let outcome =
                    engine.step(true, &mut state, &mut clock, &mut dynamics, &Alone, &mut ticker).unwrap();
                engine.prepare_dense(&state, outcome.h, &mut dynamics, &mut ticker).unwrap();
                engine.commit(outcome.accepted, &mut state);
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
