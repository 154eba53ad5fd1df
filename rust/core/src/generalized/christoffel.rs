//! The right side of Lagrange's equations where L is quadratic in the velocities.
//!
//! The one idea: of L = q̇·M q̇/2 + b·q̇ + L₀ the velocities enter M q̈ = ∂L₀/∂qᵢ + (∂bⱼ/∂qᵢ − ∂bᵢ/∂qⱼ) q̇ⱼ − ∂bᵢ/∂t
//! − ∂Mᵢⱼ/∂t q̇ⱼ − Γᵢⱼₖ q̇ⱼ q̇ₖ only as often as they must: Γᵢⱼₖ = (∂Mᵢⱼ/∂qₖ + ∂Mᵢₖ/∂qⱼ − ∂Mⱼₖ/∂qᵢ)/2 loses on the graph what sweeps
//! through the momenta carry along twice with opposite signs, and with it rounding of what cancels.
//! H. Goldstein, *Classical Mechanics*, 3rd ed., § 7.5; R. Featherstone, *Rigid Body Dynamics Algorithms* (2008), § 3.

use crate::expressions::graph::Dependence;
use crate::expressions::{Graph, Id, Node};
use rustc_hash::FxHashMap;

/// With more coordinates there are more symbols than a sweep has operations.
const MOST: usize = 4;

/// ∂L/∂q − d/dt ∂L/∂q̇ without accelerations, if L is quadratic in the velocities.
pub(super) fn free(
    graph: &mut Graph,
    function: Id,
    momenta: &[Id],
    mass: &[Vec<Id>],
    (q, v): (&[Id], &[Id]),
) -> Option<Vec<Id>> {
    let n = q.len();
    let entries: Vec<Id> = (0..n).flat_map(|i| mass[i][..=i].iter().copied()).collect();
    let velocity = |node: &Node| matches!(node, Node::Variable(index) if *index as usize >= n);
    if n > MOST || graph.any(&entries, velocity) {
        return None;
    }
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let at_rest: FxHashMap<Id, Id> = v.iter().map(|&v| (v, zero)).collect();
    let roots: Vec<Id> = momenta.iter().copied().chain([function]).collect();
    let rest = graph.substitute(&roots, &at_rest);
    let (potential, linear) = (rest[n], &rest[..n]);

    let time = FxHashMap::from_iter([(graph.time(), one)]);
    let along: Vec<FxHashMap<Id, Id>> = q.iter().map(|&q| FxHashMap::from_iter([(q, one)])).collect();
    let of_linear: Vec<Vec<Id>> = along.iter().map(|along| graph.tangent(linear, along)).collect();
    let of_mass: Vec<Vec<Id>> = along.iter().map(|along| graph.tangent(&entries, along)).collect();
    let (linear_in_time, mass_in_time) = (graph.tangent(linear, &time), graph.tangent(&entries, &time));
    let entry = |i: usize, j: usize| if i < j { j * (j + 1) / 2 + i } else { i * (i + 1) / 2 + j };

    let mut free = graph.gradient(potential, q);
    for i in 0..n {
        let mut terms = vec![(1.0, free[i]), (-1.0, linear_in_time[i])];
        for j in 0..n {
            let turns = [(1.0, of_linear[i][j]), (-1.0, of_linear[j][i]), (-1.0, mass_in_time[entry(i, j)])];
            let turns = graph.sum(0.0, &turns);
            terms.push((1.0, graph.multiply(turns, v[j])));
            for k in 0..=j {
                let twice = [
                    (1.0, of_mass[k][entry(i, j)]),
                    (1.0, of_mass[j][entry(i, k)]),
                    (-1.0, of_mass[i][entry(j, k)]),
                ];
                let (twice, pair) = (graph.sum(0.0, &twice), graph.multiply(v[j], v[k]));
                terms.push((if j == k { -0.5 } else { -1.0 }, graph.multiply(twice, pair)));
            }
        }
        free[i] = graph.sum(0.0, &terms);
    }
    Some(free)
}

/// Operations on what changes, in all that these are made of.
pub(super) fn length(graph: &Graph, roots: &[Id]) -> usize {
    let leaf = |id: Id| matches!(graph.node(id), Node::Variable(_) | Node::Time);
    let varies = |id: Id| graph.dependence(id) > Dependence::Parameters && !leaf(id);
    graph.reachable(roots).into_iter().filter(|&id| varies(id)).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expressions::Machine;
    use crate::expressions::assembler::compile;
    use crate::expressions::function::Function;
    use crate::expressions::program::Output;
    use std::sync::Arc;

    /// What sweeps through the momenta give, and what this gives, of a function of two coordinates.
    fn both_ways(make: impl Fn(&mut Graph, [Id; 6]) -> Id) -> (Graph, Vec<Id>, Option<Vec<Id>>) {
        let mut graph = Graph::default();
        let [x, y, v, w] = [0, 1, 2, 3].map(|index| graph.variable(index));
        let (t, p, one) = (graph.time(), graph.parameter(0), graph.constant(1.0));
        let function = make(&mut graph, [x, y, v, w, t, p]);
        let slopes = graph.gradient(function, &[x, y, v, w]);
        let momenta = &slopes[2..];
        let mut mass = vec![vec![]; 2];
        for velocity in [v, w] {
            let column = graph.tangent(momenta, &FxHashMap::from_iter([(velocity, one)]));
            (0..2).for_each(|i| mass[i].push(column[i]));
        }
        let inertia = graph.tangent(momenta, &FxHashMap::from_iter([(x, v), (y, w), (t, one)]));
        let swept = (0..2).map(|i| graph.subtract(slopes[i], inertia[i])).collect();
        let found = free(&mut graph, function, momenta, &mass, (&[x, y], &[v, w]));
        (graph, swept, found)
    }

    /// L = (2 + sin y + t x) v²/2 + p cos(x − y) t v w + (1 + x²) w²/2 + (y t + sin x) v + x² y w − p x y² + t² x.
    fn everything(graph: &mut Graph, [x, y, v, w, t, p]: [Id; 6]) -> Id {
        let (sine, of_x) = (graph.call(Function::Sin, y), graph.call(Function::Sin, x));
        let (tx, difference) = (graph.multiply(t, x), graph.subtract(x, y));
        let (cosine, x2) = (graph.call(Function::Cos, difference), graph.multiply(x, x));
        let first = graph.sum(2.0, &[(1.0, sine), (1.0, tx)]);
        let second = graph.sum(1.0, &[(1.0, x2)]);
        let yt = graph.multiply(y, t);
        let linear = graph.add(yt, of_x);
        let terms = [
            (0.5, graph.product(&[first, v, v])),
            (1.0, graph.product(&[p, cosine, t, v, w])),
            (0.5, graph.product(&[second, w, w])),
            (1.0, graph.multiply(linear, v)),
            (1.0, graph.product(&[x2, y, w])),
            (-1.0, graph.product(&[p, x, y, y])),
            (1.0, graph.product(&[t, t, x])),
        ];
        graph.sum(0.0, &terms)
    }

    #[test]
    fn both_ways_lead_to_the_same_equations() {
        let (graph, swept, found) = both_ways(everything);
        let outputs: Vec<Output> = swept.into_iter().chain(found.unwrap()).map(Output::Node).collect();
        let mut machine = Machine::new(Arc::new(compile(&graph, (4, 1), &[], &outputs).unwrap()), &[0.7]);
        for (t, state) in
            [(0.3, [0.4, -1.2, 2.0, 0.8]), (-2.0, [1.9, 0.6, -0.5, 1.1]), (0.0, [0.0, 0.3, 1.0, 0.0])]
        {
            let mut out = [0.0; 4];
            machine.evaluate(t, &state, &mut out);
            // A dozen terms of the size of ten, each with a few roundings.
            for i in 0..2 {
                assert!((out[i] - out[2 + i]).abs() < 1e-14 * 10.0, "{out:?}");
            }
            assert!(out[..2].iter().any(|value| value.abs() > 0.1), "{out:?}");
        }
    }

    #[test]
    fn what_is_not_quadratic_is_left_alone() {
        let (_, _, found) = both_ways(|graph, [x, _, v, w, _, _]| {
            let (fourth, square) = (graph.power(v, 4.0), graph.multiply(w, w));
            let product = graph.multiply(x, fourth);
            graph.add(product, square)
        });
        assert!(found.is_none());
    }

    /// L = v²/2 + w²/2 + v w cos(x − y): of what either velocity brings, only the square of the other's is left.
    #[test]
    fn what_cancels_is_not_there() {
        let (graph, swept, found) = both_ways(|graph, [x, y, v, w, _, _]| {
            let difference = graph.subtract(x, y);
            let cosine = graph.call(Function::Cos, difference);
            let terms = [graph.multiply(v, v), graph.multiply(w, w), graph.product(&[v, w, cosine])];
            graph.sum(0.0, &[(0.5, terms[0]), (0.5, terms[1]), (1.0, terms[2])])
        });
        let found = found.unwrap();
        for (i, own) in [(0, 2), (1, 3)] {
            assert!(!graph.any(&found[i..=i], |node| *node == Node::Variable(own)));
        }
        assert!(length(&graph, &found) < length(&graph, &swept));
    }
}
