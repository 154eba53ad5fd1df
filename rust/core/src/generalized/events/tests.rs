//! Zeros of functions that oscillate, touch and leap, in steps of which the state is known.

use super::search::{INSIDE, Point, Search};
use super::{Called, Function, Interval, Working};
use crate::error::Result;
use crate::expressions::function::Function as Named;
use crate::expressions::{Graph, Id};
use crate::generalized::{Kind, Model, Source};
use proptest::prelude::*;
use std::sync::Arc;

/// A step in which a coordinate goes from 0 to 1 at the velocity that the span asks for.
struct Uniform {
    span: (f64, f64),
    state: [f64; 2],
}

impl Uniform {
    fn new(span: (f64, f64)) -> Self {
        Self { span, state: [1.0, 1.0 / (span.1 - span.0)] }
    }
}

impl Interval for Uniform {
    fn span(&self) -> (f64, f64) {
        self.span
    }
    fn end(&self) -> &[f64] {
        &self.state
    }
    fn at(&mut self, theta: f64) -> Result<&[f64]> {
        self.state[0] = theta;
        Ok(&self.state)
    }
}

/// The zeros of a function of the coordinate, and whether it is passed upwards.
fn zeros(function: &Function, span: (f64, f64)) -> Vec<(f64, bool)> {
    let mut working = Working::of(function, &[]);
    let mut step = Uniform::new(span);
    let end = Point::at(1.0, working.at(span.1, &step.state).unwrap(), span.0, span.1);
    step.state[0] = 0.0;
    let start = Point::at(0.0, working.at(span.0, &step.state).unwrap(), span.0, span.1);
    step.state[0] = INSIDE;
    let inside = step.state;
    Search::new(&mut working, &mut step).zeros([start, end], &inside).unwrap()
}

/// An expression of the coordinate q of a free body.
fn expression(of: impl Fn(&mut Graph, Id) -> Id) -> Function {
    let mut graph = Graph::default();
    let (q, v) = (graph.variable(0), graph.variable(1));
    let square = graph.multiply(v, v);
    let function = graph.sum(0.0, &[(0.5, square)]);
    let made = of(&mut graph, q);
    let source = Source {
        graph,
        kind: Kind::Lagrangian,
        coordinates: 1,
        parameters: 0,
        function,
        forces: vec![],
        dissipation: None,
        holonomic: vec![],
        nonholonomic: vec![],
    };
    let mut model = Model::new(source).unwrap();
    Function::of(&mut model, made).unwrap()
}

/// Σ aₖ sin(k ω q + k) and a constant.
fn waves(constant: f64, frequency: f64, terms: &[f64]) -> (Function, impl Fn(f64) -> f64) {
    let made = expression(|graph, q| {
        let waves = (1..).zip(terms).map(|(k, &a)| {
            let angle = graph.sum(f64::from(k), &[(f64::from(k) * frequency, q)]);
            (a, graph.call(Named::Sin, angle))
        });
        let waves: Vec<(f64, Id)> = waves.collect();
        graph.sum(constant, &waves)
    });
    let terms = terms.to_vec();
    let value = move |q: f64| {
        (1..).zip(&terms).map(|(k, &a)| a * (f64::from(k) * (frequency * q + 1.0)).sin()).sum::<f64>()
            + constant
    };
    (made, value)
}

proptest! {
    /// As many as a look at every fifty-thousandth of the step finds, each where the function changes its sign.
    #[test]
    fn no_zero_of_waves_is_missed(
        constant in -1.5..1.5f64, frequency in 0.1..120.0f64, terms in prop::collection::vec(-1.0..1.0f64, 1..4),
        backward in prop::bool::ANY,
    ) {
        let (function, value) = waves(constant, frequency, &terms);
        let found = zeros(&function, if backward { (3.0, -1.0) } else { (0.0, 0.5) });
        let samples: Vec<f64> = (0..=50_000).map(|i| value(f64::from(i) / 50_000.0)).collect();
        let seen: Vec<(usize, bool)> = samples.windows(2).enumerate()
            .filter(|(_, pair)| pair[0] * pair[1] < 0.0)
            .map(|(i, pair)| (i, pair[0] < 0.0))
            .collect();
        // What lies closer together than those looks, is found beside.
        prop_assert!(found.len() >= seen.len(), "{found:?} for {seen:?}");
        for (i, up) in seen {
            let (low, high) = (i as f64 / 50_000.0, (i + 1) as f64 / 50_000.0);
            let here = found.iter().filter(|(theta, _)| low - 1e-13 <= *theta && *theta <= high + 1e-13);
            prop_assert!(here.filter(|&&(_, way)| way == up).count() >= 1, "{low} of {found:?}");
        }
        for (theta, _) in found {
            let (before, after) = (value(theta - 1e-7), value(theta + 1e-7));
            let size: f64 = terms.iter().map(|a| a.abs()).sum::<f64>() + 1.0;
            prop_assert!(before * after <= 1e-9 * size || value(theta).abs() < 1e-12 * size);
        }
    }
}

#[test]
fn two_zeros_however_close_are_found_and_a_near_miss_is_none() {
    for top in [0.11, 0.458_7, 0.5, 0.89] {
        for depth in [1e-2, 1e-6, 1e-12] {
            let parabola = |sign: f64| {
                expression(move |graph, q| {
                    let off = graph.sum(-top, &[(1.0, q)]);
                    let square = graph.multiply(off, off);
                    graph.sum(-sign * depth, &[(1.0, square)])
                })
            };
            let found = zeros(&parabola(1.0), (0.0, 2.0));
            assert_eq!(found.iter().map(|zero| zero.1).collect::<Vec<_>>(), [false, true], "{top} {depth}");
            for ((theta, _), wanted) in found.iter().zip([top - depth.sqrt(), top + depth.sqrt()]) {
                // The value is known to a few units of round-off of 1, the slope is 2·√depth.
                assert!((theta - wanted).abs() < 1e-15 / depth.sqrt(), "{theta} {wanted}");
            }
            assert!(zeros(&parabola(-1.0), (0.0, 2.0)).is_empty());
        }
    }
}

#[test]
fn a_function_that_is_called_is_followed_down() {
    let called = |function: fn(f64) -> f64| {
        let call: Arc<Called> = Arc::new(move |_: f64, y: &[f64]| Ok(function(y[0])));
        zeros(&Function::Called(call), (0.0, 1.0))
    };
    let found = called(|q| (q - 0.3) * (q - 0.300_1));
    assert_eq!(found.len(), 2);
    assert!((found[0].0 - 0.3).abs() < 1e-14 && (found[1].0 - 0.300_1).abs() < 1e-14);
    // The jump of a switch is its event; that of what goes on beside it is none, and neither is what is no number.
    assert_eq!(called(|q| if q < 0.7 { -1.0 } else { 2.0 }).len(), 1);
    assert!(called(|q| if q < 0.7 { q - 1.0 } else { 2.0 * q }).is_empty());
    assert!(called(|_| f64::NAN).is_empty());
    assert!(called(|_| 0.0).is_empty());
    // A zero at the start was told of before; one at the end counts.
    assert!(called(|q| q).is_empty());
    assert_eq!(called(|q| q - 1.0), [(1.0, true)]);
}

#[test]
fn what_is_no_number_or_nothing_but_zero_ends() {
    for function in [
        expression(|graph, q| {
            let off = graph.sum(-2.0, &[(1.0, q)]);
            graph.call(Named::Sqrt, off)
        }),
        expression(|graph, q| graph.sum(0.0, &[(0.0, q)])),
    ] {
        assert!(zeros(&function, (0.0, 1.0)).is_empty());
    }
}
