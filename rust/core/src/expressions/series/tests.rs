//! Series of functions along a straight line, summed far from where they begin, against the functions there.

use super::super::assembler::compile;
use super::super::function::Function;
use super::super::graph::{Graph, Id};
use super::super::machine::Machine;
use super::super::program::{LinearSystem, Output};
use super::{Coefficient, Expansion, Series};
use crate::numerics::lanes::{Lanes, WIDTH};
use std::sync::Arc;

/// Orders that are summed: with terms that fall by a third at least, what is left out is below 1e-11.
const HIGHEST: usize = 22;

/// The sum of the series of the outputs at the time one, of `x = x₀ + 0.1 t`, `y = y₀ − 0.07 t` and the time itself.
fn summed<S: Coefficient>(series: &Arc<Series>, start: [f64; 2], parameters: &[f64]) -> Vec<S> {
    let parameters: Vec<S> = parameters.iter().map(|&p| S::splat(p)).collect();
    let mut expansion = Expansion::<S>::new(series.clone(), &parameters);
    let mut sums = vec![S::zero(); series.outputs.len()];
    for order in 0..=HIGHEST {
        let line = [[start[0], 0.1], [start[1], -0.07], [0.3, 0.05]];
        for (index, coefficients) in line.iter().enumerate() {
            expansion.set(index, order, S::splat(coefficients.get(order).copied().unwrap_or(0.0)));
        }
        expansion.expand(order);
        for (index, sum) in sums.iter_mut().enumerate() {
            *sum += expansion.output(index, order);
        }
    }
    sums
}

/// Checks outputs that are made of x, y, the time and two parameters.
fn check(name: &str, make: impl Fn(&mut Graph, [Id; 5]) -> (Vec<LinearSystem>, Vec<Output>)) {
    let mut graph = Graph::default();
    let inputs = [graph.variable(0), graph.variable(1), graph.time(), graph.parameter(0), graph.parameter(1)];
    let (systems, outputs) = make(&mut graph, inputs);
    let series = Arc::new(Series::new(&graph, (2, 2), &systems, &outputs).unwrap());
    let code = Arc::new(compile(&graph, (2, 2), &systems, &outputs).unwrap());
    let (start, parameters) = ([0.4, 0.25], [0.7, 1.3]);
    let mut wanted = vec![0.0; outputs.len()];
    let there = [start[0] + 0.1, start[1] - 0.07];
    Machine::new(code, &parameters).evaluate(0.3 + 0.05, &there, &mut wanted);
    let found = summed::<f64>(&series, start, &parameters);
    let lanes = summed::<Lanes>(&series, start, &parameters);
    for ((wanted, found), lanes) in wanted.iter().zip(&found).zip(&lanes) {
        assert!((wanted - found).abs() <= 2e-14 * (1.0 + wanted.abs()), "{name}: {found} for {wanted}");
        assert_eq!(lanes.0.map(f64::to_bits), [found.to_bits(); WIDTH], "{name}");
    }
}

fn nodes(ids: &[Id]) -> (Vec<LinearSystem>, Vec<Output>) {
    (vec![], ids.iter().copied().map(Output::Node).collect())
}

#[test]
fn every_function_is_its_series() {
    for function in Function::ALL {
        check(function.name(), |graph, [x, y, t, p, _]| {
            // An area cosine begins at one.
            let from = if function == Function::Acosh { 1.5 } else { 0.0 };
            let inside = graph.sum(from, &[(0.5, x), (0.5, y), (0.25, t)]);
            let of_parameter = graph.sum(from, &[(0.5, p)]);
            let (varies, constant) = (graph.call(function, inside), graph.call(function, of_parameter));
            let product = graph.multiply(varies, constant);
            nodes(&[varies, product, constant])
        });
    }
}

#[test]
fn products_quotients_powers_and_angles_are_their_series() {
    check("arithmetic", |graph, [x, y, t, p, r]| {
        let mut made = Vec::new();
        for (a, b) in [(x, y), (x, x), (p, x), (x, p), (p, r), (t, x)] {
            let (below, moved) = (graph.sum(1.0, &[(1.0, b)]), graph.sum(0.2, &[(-1.0, a), (0.5, b)]));
            let product = graph.multiply(moved, below);
            made.push(product);
            made.push(graph.multiply(product, product));
            made.push(graph.divide(moved, below));
            let three = graph.constant(3.0);
            made.push(graph.divide(three, below));
            made.push(graph.power(below, 0.3));
            made.push(graph.power(below, -1.5));
            made.push(graph.power(moved, 4.0));
            made.push(graph.angle(moved, below));
            made.push(graph.angle(below, a));
            let further = graph.multiply(moved, moved);
            made.push(graph.sum(0.5, &[(2.0, product), (-0.5, further), (1.0, a), (-1.0, p)]));
        }
        nodes(&made)
    });
}

/// Products with c₀ + c x are those with x but for the outermost coefficients: some of these are squares then, some one, and
/// some nothing.
#[test]
fn products_that_are_alike_are_their_series() {
    check("alike", |graph, [x, y, t, p, _]| {
        let third = 1.0 / 3.0;
        let (of_x, of_y) = (graph.sum(0.5, &[(-third, x)]), graph.sum(-0.7, &[(2.0, y)]));
        let of_both = graph.sum(0.2, &[(3.0, of_y), (1.0, p)]);
        let of_time = graph.sum(1.0, &[(1.0, t)]);
        let mut made = Vec::new();
        let pairs =
            [(x, x), (y, y), (x, of_x), (of_x, of_x), (y, of_x), (of_y, of_x), (x, of_both), (t, of_time)];
        let products = pairs.map(|(a, b)| graph.multiply(a, b));
        let [xx, yy, xf, ff, yf, gf, xb, tt] = products;
        made.push(graph.sum(0.0, &[(-1.0, yy), (third, xx), (-2.0, xf)]));
        made.push(graph.sum(0.3, &[(1.0, yf), (-0.25, gf), (1.0, xb), (0.5, x)]));
        made.push(graph.sum(0.0, &[(third, xx), (1.0, xf), (2.0, tt)]));
        made.push(graph.sum(0.0, &[(1.0, ff), (1.0, xf), (-third * third, xx), (third, xx)]));
        nodes(&made)
    });
}

#[test]
fn solutions_of_linear_systems_are_their_series() {
    check("linear systems", |graph, [x, y, t, p, _]| {
        let (one, three) = (graph.constant(1.0), graph.constant(3.0));
        let diagonal = graph.sum(2.0, &[(1.0, x)]);
        let rows = vec![vec![diagonal, y, p], vec![y, three, t], vec![p, t, diagonal]];
        let system = LinearSystem { matrix: rows, right: vec![x, one, y], inner: 3 };
        let small = LinearSystem { matrix: vec![vec![three]], right: vec![p], inner: 1 };
        (vec![system, small], (0..4).map(Output::Unknown).collect())
    });
}
