//! Expressions drawn at random: derivatives two ways, and words that are no programs.

use super::assembler::compile;
use super::code::{Code, Parts};
use super::function::Function;
use super::graph::{Graph, Id};
use super::machine::Machine;
use super::program::Output;
use crate::numerics::lanes::{Lanes, WIDTH};
use proptest::prelude::*;
use rustc_hash::FxHashMap;
use std::sync::Arc;

const VARIABLES: usize = 3;

/// An expression from a list of choices; functions are those that are defined everywhere.
fn drawn(graph: &mut Graph, choices: &[(u8, u8, u8)]) -> Id {
    let mut made: Vec<Id> = (0..VARIABLES as u32).map(|i| graph.variable(i)).collect();
    made.push(graph.parameter(0));
    made.push(graph.constant(0.75));
    for &(operation, a, b) in choices {
        let (a, b) = (made[usize::from(a) % made.len()], made[usize::from(b) % made.len()]);
        let id = match operation % 12 {
            0 => graph.add(a, b),
            1 => graph.subtract(a, b),
            2 | 3 => graph.multiply(a, b),
            4 => {
                let square = graph.multiply(b, b);
                let below = graph.sum(1.5, &[(1.0, square)]);
                graph.divide(a, below)
            }
            5 => graph.call(Function::Sin, a),
            6 => graph.call(Function::Cos, a),
            7 => graph.call(Function::Tanh, a),
            8 => graph.call(Function::Atan, a),
            11 => {
                let square = graph.multiply(b, b);
                let beside = graph.sum(1.5, &[(1.0, square)]);
                graph.angle(a, beside)
            }
            9 => {
                let square = graph.multiply(a, a);
                let inside = graph.sum(2.0, &[(1.0, square)]);
                graph.power(inside, 0.7)
            }
            _ => {
                let square = graph.multiply(a, a);
                let inside = graph.sum(1.0, &[(0.5, square)]);
                graph.call(Function::Sqrt, inside)
            }
        };
        made.push(id);
    }
    made.pop().unwrap_or(0)
}

fn values(graph: &Graph, roots: &[Id], state: &[f64], parameter: f64) -> Vec<f64> {
    let outputs: Vec<Output> = roots.iter().copied().map(Output::Node).collect();
    let code = Arc::new(compile(graph, (VARIABLES, 1), &[], &outputs).unwrap());
    let mut found = vec![0.0; roots.len()];
    Machine::new(code.clone(), &[parameter]).evaluate(0.0, state, &mut found);
    // Eight states at once have the bits of one.
    let mut lanes = vec![Lanes([0.0; WIDTH]); roots.len()];
    let state: Vec<Lanes> = state.iter().map(|&x| Lanes([x; WIDTH])).collect();
    Machine::new(code, &[Lanes([parameter; WIDTH])]).evaluate(Lanes([0.0; WIDTH]), &state, &mut lanes);
    for (one, eight) in found.iter().zip(&lanes) {
        assert!(eight.0.iter().all(|x| x.to_bits() == one.to_bits() || (x.is_nan() && one.is_nan())));
    }
    found
}

proptest! {
    #[test]
    fn both_sweeps_and_differences_agree(
        choices in prop::collection::vec(any::<(u8, u8, u8)>(), 1..24),
        state in prop::array::uniform3(-1.5..1.5f64),
        direction in prop::array::uniform3(-1.0..1.0f64),
    ) {
        let mut graph = Graph::default();
        let root = drawn(&mut graph, &choices);
        let variables: Vec<Id> = (0..VARIABLES as u32).map(|i| graph.variable(i)).collect();
        let gradient = graph.gradient(root, &variables);
        let seeds: FxHashMap<Id, Id> =
            variables.iter().zip(direction).map(|(&id, x)| (id, graph.constant(x))).collect();
        let tangent = graph.tangent(&[root], &seeds)[0];
        let mut roots = vec![root, tangent];
        roots.extend(&gradient);
        let found = values(&graph, &roots, &state, 1.25);
        let along: f64 = found[2..].iter().zip(direction).map(|(g, d)| g * d).sum();
        let size: f64 = found[2..].iter().map(|g| g.abs()).sum::<f64>() + found[0].abs();
        prop_assume!(size.is_finite() && size < 1e6);
        // Two orders of summation.
        prop_assert!((along - found[1]).abs() <= 1e-11 * (1.0 + size), "{along} {}", found[1]);
        let h = 1e-5;
        let moved = |sign: f64| {
            let state: Vec<f64> = state.iter().zip(direction).map(|(x, d)| x + sign * h * d).collect();
            values(&graph, &[root], &state, 1.25)[0]
        };
        let difference = (moved(1.0) - moved(-1.0)) / (2.0 * h);
        // The third derivative of what is drawn may be large; a wrong slope is wrong by its own size.
        prop_assume!((along - difference).abs() < 1e3);
        prop_assert!((along - difference).abs() <= 1e-3 * (1.0 + size), "{along} {difference}");
    }

    /// Whatever the words are, they are refused or run within their registers.
    #[test]
    fn no_words_run_unchecked(
        body in prop::collection::vec(prop_oneof![0..16u16, 30..50u16], 0..40),
        constants in prop::collection::vec(-2.0..2.0f64, 0..4),
        outputs in prop::collection::vec(0..12u16, 0..4),
    ) {
        let mut body = body;
        body.push(super::code::word::END);
        let parts = Parts {
            variables: 2,
            parameters: 1,
            registers: 10,
            constants,
            preamble: vec![super::code::word::END],
            body,
            outputs,
        };
        if let Ok(code) = Code::new(parts.clone()) {
            prop_assert_eq!(&code.parts(), &parts);
            let mut found = vec![0.0; code.outputs()];
            Machine::new(Arc::new(code), &[0.5]).evaluate(0.1, &[0.2, 0.3], &mut found);
        }
    }
}

#[test]
fn squares_of_sine_and_cosine_join_whatever_stands_with_them() {
    let mut graph = Graph::default();
    let (x, y, p) = (graph.variable(0), graph.variable(1), graph.parameter(0));
    let (s, c) = (graph.call(Function::Sin, x), graph.call(Function::Cos, x));
    let (ps, pc) = (graph.multiply(p, s), graph.multiply(p, c));
    let (a, b) = (graph.multiply(ps, ps), graph.multiply(pc, pc));
    let sum = graph.sum(0.0, &[(2.0, a), (2.0, b), (1.0, y)]);
    let square = graph.multiply(p, p);
    assert_eq!(sum, graph.sum(0.0, &[(2.0, square), (1.0, y)]));
}

#[test]
fn what_depends_on_parameters_alone_is_done_once() {
    let mut graph = Graph::default();
    let (x, p) = (graph.variable(0), graph.parameter(0));
    let root = graph.call(Function::Sqrt, p);
    let product = graph.multiply(root, x);
    let code = compile(&graph, (1, 1), &[], &[Output::Node(product)]).unwrap();
    assert_eq!(code.operations(), 1);
}
