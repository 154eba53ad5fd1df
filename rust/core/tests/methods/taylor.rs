//! Taylor series: coefficients against known motions, the order of a step, and the continuous extension in both bases.

use super::super::support::{Problem, adaptive, bodies, distance, three_bodies};
use super::{PROBLEMS, reference};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::ode::series::Jet;
use visviva_core::ode::system::System;
use visviva_core::parallel::{Control, Ticker};
use visviva_core::registry::METHODS;

/// Coefficients of a problem's state.
fn jet(make: super::Make, order: usize, unit: f64) -> Jet<DoubleDouble> {
    let Problem { state, mut dynamics, .. } = make();
    let control = Control::default();
    let mut jet = Jet::new(state.q().len(), order);
    jet.begin(&state, [0.0, 1.0].map(DoubleDouble::from).each_ref(), &DoubleDouble::from(unit));
    dynamics.expand(&mut jet, &mut Ticker::quiet(&control)).unwrap();
    jet
}

/// Two bodies on a circle, so that coordinates are sines and cosines of time.
fn circle() -> Problem<DoubleDouble> {
    bodies(&[0.5, 0.5], &[0.5, -0.5, 0.0, 0.0, 0.0, 0.0], &[0.0, 0.0, 0.5, -0.5, 0.0, 0.0], 0.0)
}

#[test]
fn a_circle_has_the_series_of_sine_and_cosine_to_thirty_digits() {
    for unit in [0.25, 1.0, 4.0] {
        let jet = jet(circle, 22, unit);
        let mut term = DoubleDouble::from(0.5);
        for n in 0..=23 {
            if n > 0 {
                term = term.scale(unit) / DoubleDouble::from(n as f64);
            }
            let sign = if n % 4 < 2 { 1.0 } else { -1.0 };
            let (x, y) = if n % 2 == 0 { (sign, 0.0) } else { (0.0, sign) };
            for (number, factor) in [(0, x), (1, -x), (2, y), (3, -y), (4, 0.0), (5, 0.0)] {
                let wrong = jet.position(n)[number] - term.scale(factor);
                // Of terms that cancel: the sums of products are of 2^n in all, in units of the last.
                let scale = unit.powi(n as i32);
                assert!(wrong.to_f64().abs() < 1e-30 * scale, "{n}, {number}: {:e}", wrong.to_f64());
            }
        }
    }
}

#[test]
fn a_series_leads_to_where_a_table_does() {
    for (name, make, _) in PROBLEMS {
        let h = 1.0 / 64.0;
        let exact = reference(make, h, 64);
        let jet = jet(make, 22, h);
        let sum = |blocks: &[DoubleDouble], number: usize| {
            blocks.chunks(jet.len).fold(DoubleDouble::from(0.0), |sum, block| sum + block[number])
        };
        for number in 0..jet.len {
            let apart = sum(&jet.q, number) - exact.q()[number];
            assert!(apart.to_f64().abs() < 1e-29, "{name}: {:e}", apart.to_f64());
            let apart = sum(&jet.v, number).scale(64.0) - exact.v()[number];
            assert!(apart.to_f64().abs() < 1e-28, "{name}: {:e}", apart.to_f64());
        }
    }
}

#[test]
fn the_extension_is_the_series_in_every_basis_and_ends_where_the_step_does() {
    let method = METHODS.iter().find(|method| method.name == "taylor").unwrap();
    let Problem { state, mut dynamics, .. } = three_bodies::<DoubleDouble>();
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    let (mut trial, mut clock, norm) = adaptive(method, &dynamics, dynamics.shape, &state, 1e-20, 1e3);
    trial.start(true, &mut dynamics, &state, &mut clock, &norm, &mut ticker).unwrap();
    let outcome = trial.attempt(true, &mut dynamics, &state, &mut clock, &norm, &mut ticker).unwrap();
    let len = state.q().len();
    let mut between = state.clone();
    let mut blocks = Vec::new();
    trial.extension(&state, outcome.h, &mut blocks);
    assert_eq!(blocks.len(), len * trial.terms());
    let nested = |terms: &mut dyn Iterator<Item = DoubleDouble>, theta: DoubleDouble| {
        let one = DoubleDouble::from(1.0);
        let all: Vec<_> = terms.collect();
        all.iter().enumerate().rev().fold(DoubleDouble::from(0.0), |sum, (index, &term)| {
            (term + sum) * if index % 2 == 0 { theta } else { one - theta }
        })
    };
    for theta in [0.0, 0.125, 0.3125, 0.5, 0.8125, 1.0].map(DoubleDouble::from) {
        trial.at(&outcome, &mut dynamics, &state, theta, &mut between, &mut ticker).unwrap();
        if theta.to_f64() == 1.0 {
            assert!(distance(&between, trial.next()) < 1e-30);
        }
        for number in 0..len {
            let (q, v) = (state.q()[number], state.v()[number]);
            let (at_q, at_v) = (
                between.q()[number] + between.q_compensation()[number],
                between.v()[number] + between.v_compensation()[number],
            );
            let by_blocks = q + nested(&mut blocks.chunks(len).map(|block| block[number]), theta);
            assert!((by_blocks - at_q).to_f64().abs() < 1e-29);
            let mut terms = Vec::new();
            trial.polynomial(number, outcome.h, &mut terms);
            let h = outcome.h;
            let of_q = nested(&mut terms.iter().map(|term| term[0]), theta);
            let of_v = nested(&mut terms.iter().map(|term| term[1]), theta);
            assert!((q + theta * h * v + h * h * of_q - at_q).to_f64().abs() < 1e-29);
            assert!((v + h * of_v - at_v).to_f64().abs() < 1e-28);
        }
    }
}
