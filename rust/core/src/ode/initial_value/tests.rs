//! Problems with known solutions, through every method that takes them.

use super::*;
use crate::ode::system::Needs;
use crate::parallel::Control;
use crate::registry::{METHODS, method, solver};
use core::f64::consts::PI;

fn request(method: &'static Method, span: (f64, f64), y0: &[f64], tolerance: f64) -> Request {
    let fixed = !method.adaptive();
    let tolerances = (!fixed).then(|| vec![tolerance]);
    Request {
        method,
        span,
        y0: y0.to_vec(),
        rtol: tolerances.clone(),
        atol: tolerances,
        first_step: None,
        max_step: None,
        dt: fixed.then_some(1.0 / 64.0),
        outputs: None,
        dense: true,
        conditions: vec![],
    }
}

fn solvers() -> impl Iterator<Item = &'static Method> {
    METHODS.iter().copied().filter(|method| method.serves(Form::FirstOrder(1), Needs::default()))
}

fn quietly<'a>(
    request: &'a Request,
    function: &mut impl Function,
    events: Option<&'a mut (dyn Events + 'a)>,
) -> Solution {
    let control = Control::default();
    solve(request, function, events, &mut Ticker::quiet(&control)).unwrap()
}

/// `y'' = -y` from (1, 0): (cos t, -sin t).
fn oscillator(_: f64, y: &[f64], rate: &mut [f64]) -> Result<()> {
    rate.copy_from_slice(&[y[1], -y[0]]);
    Ok(())
}

struct First;
impl Events for First {
    fn value(&mut self, _: usize, _: f64, y: &[f64]) -> Result<f64> {
        Ok(y[0])
    }
}

#[test]
fn an_oscillator_forwards_and_backwards_between_its_nodes_and_at_its_zeros() {
    for method in solvers() {
        for end in [7.0, -7.0] {
            let mut asked = request(method, (0.0, end), &[1.0, 0.0], 1e-8);
            asked.conditions = vec![Condition::default()];
            let solution = quietly(&asked, &mut oscillator, Some(&mut First));
            assert_eq!(solution.ending, Ending::Finished);
            assert_eq!((solution.t[0], solution.t[solution.t.len() - 1]), (0.0, end));
            // A tolerance of 1e-8 per step leaves some 1e-6 at low orders, where there are a thousand steps; a step of
            // 1/64 leaves h^p t, times 1/2 for Euler's method, 1/6 for those of order 2, 1/120 for rk4.
            let bound = match method.adaptive() {
                true => 2e-6,
                false => 7.0 * 64_f64.powi(-(method.order as i32)),
            };
            for (t, y) in solution.t.iter().zip(solution.y.chunks(2)) {
                assert!((y[0] - t.cos()).abs() < bound, "{}: {} at {t}", method.name, y[0]);
            }
            let times: Vec<f64> = (0..=200).map(|i| end * f64::from(i) / 200.0).collect();
            let states = solution.extension.as_ref().map(|extension| extension.view().at(&times));
            let states = states.unwrap().unwrap();
            for (t, y) in times.iter().zip(states.chunks(2)) {
                assert!((y[1] + t.sin()).abs() < bound, "{}: {} at {t}", method.name, y[1]);
            }
            let zeros = &solution.zeros[0];
            assert_eq!(zeros.t.len(), 2, "{}", method.name);
            for (zero, exact) in zeros.t.iter().zip([PI / 2.0, 3.0 * PI / 2.0]) {
                assert!((zero.abs() - exact).abs() < bound, "{}: {zero}", method.name);
            }
            // Located to round-off on the interpolant: y[0] itself is no more than a few units in the last place of 1.
            assert!(zeros.y.chunks(2).all(|y| y[0].abs() < 4e-15), "{}: {:?}", method.name, zeros.y);
        }
    }
}

#[test]
fn outputs_are_the_interpolant_and_do_not_steer() {
    for method in solvers() {
        let mut asked = request(method, (0.0, 5.0), &[1.0, 0.0], 1e-6);
        let nodes = quietly(&asked, &mut oscillator, None);
        let outputs = vec![0.0, 0.1, 2.5, 4.999, 5.0];
        asked.outputs = Some(outputs.clone());
        let table = quietly(&asked, &mut oscillator, None);
        assert_eq!(table.t, outputs);
        assert_eq!(table.evaluations, nodes.evaluations);
        let (a, b) = (nodes.y.len(), table.y.len());
        assert_eq!(nodes.y[a - 2..], table.y[b - 2..], "{}: the end is a node", method.name);
        let dense = nodes.extension.map(|extension| extension.view().at(&outputs).unwrap_or_default());
        for (dense, y) in dense.unwrap_or_default().iter().zip(&table.y) {
            assert!((dense - y).abs() < 1e-15, "{}", method.name);
        }
    }
}

#[test]
fn the_longest_step_is_kept_to_and_so_is_the_first() {
    for method in solvers().filter(|method| method.adaptive()) {
        for end in [9.0, -9.0] {
            // The slope changes, so that steps would grow and shrink freely.
            let mut asked = request(method, (0.0, end), &[1.0], 1e-3);
            (asked.max_step, asked.first_step) = (Some(0.3), Some(0.01));
            let solution = quietly(
                &asked,
                &mut |t, y, rate| {
                    rate[0] = y[0] * t.cos();
                    Ok(())
                },
                None,
            );
            let steps: Vec<f64> = solution.t.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
            let longest = steps.iter().copied().fold(0.0, |a: f64, b| if a > b { a } else { b });
            // The rounding of the difference of two times below 9.
            assert!(longest <= 0.3 + 4e-15 && longest > 0.29, "{}: {longest}", method.name);
            assert!((steps[0] - 0.01).abs() < 1e-15, "{}: {}", method.name, steps[0]);
        }
    }
}

#[test]
fn a_tolerance_of_each_number_means_what_it_says() {
    // Two numbers that do not know each other: one grows, one stays at 1e-3.
    let mut function = |t: f64, y: &[f64], rate: &mut [f64]| {
        rate.copy_from_slice(&[y[0], 1e-3 * (50.0 * t).cos()]);
        Ok(())
    };
    for method in solvers().filter(|method| method.adaptive()) {
        let mut evaluations = |atol: [f64; 2]| {
            let mut asked = request(method, (0.0, 2.0), &[1.0, 0.0], 1e-4);
            asked.atol = Some(atol.to_vec());
            quietly(&asked, &mut function, None).evaluations
        };
        let (loose, tight) = (evaluations([1e-4, 1e-1]), evaluations([1e-4, 1e-9]));
        assert!(tight > 2 * loose, "{}: {loose} and {tight}", method.name);
    }
}

#[test]
fn runs_that_cannot_go_on_say_so_and_keep_what_they_have() {
    for method in solvers() {
        // 1/(1 - t): nothing beyond t = 1.
        let asked = request(method, (0.0, 2.0), &[1.0], 1e-6);
        let solution = quietly(
            &asked,
            &mut |_, y, rate| {
                rate[0] = y[0] * y[0];
                Ok(())
            },
            None,
        );
        assert!(matches!(solution.ending, Ending::StepTooSmall | Ending::NotFinite), "{}", method.name);
        assert!(solution.y.iter().all(|y| y.is_finite()) && solution.t.len() > 3, "{}", method.name);
        // A function that is asked to stop.
        let mut calls = 0;
        let solution = quietly(
            &asked,
            &mut |_, _, rate| {
                calls += 1;
                rate[0] = 1.0;
                if calls > 60 { Err(Error::Interrupted) } else { Ok(()) }
            },
            None,
        );
        assert!(solution.ending == Ending::Interrupted || calls <= 60, "{}", method.name);
        assert!(!solution.t.is_empty());
    }
}

#[test]
fn the_function_is_never_asked_beyond_the_span_and_evaluations_are_counted() {
    for method in solvers() {
        for (t0, end) in [(0.1, 0.7), (1e9, 1e9 + 0.7), (0.3, -1.9)] {
            let (mut calls, mut seen) = (0, (f64::INFINITY, f64::NEG_INFINITY));
            let asked = request(method, (t0, end), &[1.0, 0.0], 1e-7);
            let solution = quietly(
                &asked,
                &mut |t, y, rate| {
                    calls += 1;
                    seen = (if t < seen.0 { t } else { seen.0 }, if t > seen.1 { t } else { seen.1 });
                    oscillator(t, y, rate)
                },
                None,
            );
            assert_eq!(solution.evaluations, calls);
            assert!(seen.0 >= if t0 < end { t0 } else { end } && seen.1 <= if t0 < end { end } else { t0 });
        }
    }
}

#[test]
fn names_that_cannot_be_are_refused_by_name() {
    let refused = |name: &str, change: fn(&mut Request)| {
        let mut asked = request(method("bogacki_shampine32").unwrap(), (0.0, 1.0), &[1.0], 1e-3);
        change(&mut asked);
        let control = Control::default();
        let outcome = solver(name).and_then(|method| {
            solve(&Request { method, ..asked }, &mut oscillator, None, &mut Ticker::quiet(&control))
        });
        match outcome {
            Err(Error::InvalidInput { argument, message }) => format!("{argument}: {message}"),
            other => panic!("{other:?}"),
        }
    };
    assert!(refused("Radau", |_| {}).starts_with("method: Radau is implicit"));
    assert!(refused("leapfrog", |_| {}).contains("RK23, RK45, DOP853"));
    assert!(refused("RK54", |_| {}).starts_with("method: "));
    assert!(refused("RK45", |asked| asked.dt = Some(0.1)).starts_with("dt: "));
    assert!(refused("rk4", |_| {}).starts_with("rtol: "));
    assert!(refused("RK45", |asked| asked.max_step = Some(-1.0)).starts_with("max_step: "));
    assert!(refused("RK45", |asked| asked.first_step = Some(2.0)).starts_with("first_step: "));
    assert!(refused("RK45", |asked| asked.outputs = Some(vec![0.5, 0.2])).starts_with("t_eval: "));
    assert!(refused("RK45", |asked| asked.y0 = vec![f64::NAN]).starts_with("y0: "));
    assert!(refused("RK45", |asked| asked.atol = Some(vec![1.0; 3])).starts_with("atol: "));
}
