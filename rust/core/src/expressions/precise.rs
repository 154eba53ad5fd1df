//! Values of nodes to about thirty digits, as far as arithmetic makes them.
//!
//! The one idea: sums, products and quotients in double-double lose nothing that a difference of large numbers would need
//! later. What a function or a broken power gives is rounded once, as a program gives it.

use super::assembler::compile;
use super::graph::{Graph, Id, Node, number};
use super::program::Output;
use super::{Code, Machine};
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use std::collections::HashMap;
use std::sync::Arc;

/// Nodes that are functions of a state and of parameters.
#[derive(Clone, Debug)]
pub struct Precise {
    graph: Graph,
    roots: Vec<Id>,
    /// All that they are made of, arguments first.
    nodes: Vec<Id>,
    /// What no arithmetic makes, and the program that gives it.
    rounded: Vec<Id>,
    code: Arc<Code>,
}

impl Precise {
    /// Of nodes of so many numbers of a state and so many parameters.
    ///
    /// # Errors
    /// Expressions that are too large.
    pub fn new(graph: Graph, roots: Vec<Id>, inputs: (usize, usize)) -> Result<Self> {
        let mut nodes = graph.reachable(&roots);
        nodes.sort_unstable();
        let is_rounded =
            |id: &Id| matches!(graph.node(*id), Node::Call(..) | Node::Angle(..) | Node::Power(..));
        let rounded: Vec<Id> = nodes.iter().copied().filter(is_rounded).collect();
        let outputs: Vec<Output> = rounded.iter().copied().map(Output::Node).collect();
        let code = Arc::new(compile(&graph, inputs, &[], &outputs)?);
        Ok(Self { graph, roots, nodes, rounded, code })
    }

    /// Their values.
    pub fn at(&self, t: f64, state: &[f64], parameters: &[f64]) -> Vec<DoubleDouble> {
        let mut found = vec![0.0; self.rounded.len()];
        Machine::new(self.code.clone(), parameters).evaluate(t, state, &mut found);
        let mut values: HashMap<Id, DoubleDouble> =
            self.rounded.iter().copied().zip(found.into_iter().map(DoubleDouble::from)).collect();
        for &id in &self.nodes {
            let value = match self.graph.node(id) {
                Node::Constant(bits) => DoubleDouble::from(number(*bits)),
                Node::Variable(index) => DoubleDouble::from(state[*index as usize]),
                Node::Parameter(index) => DoubleDouble::from(parameters[*index as usize]),
                Node::Time => DoubleDouble::from(t),
                Node::Sum(constant, terms) => {
                    terms.iter().fold(DoubleDouble::from(number(*constant)), |sum, (factor, term)| {
                        sum + DoubleDouble::from(number(*factor)) * values[term]
                    })
                }
                Node::Product(a, b) => values[a] * values[b],
                Node::Quotient(a, b) => values[a] / values[b],
                Node::Call(..) | Node::Angle(..) | Node::Power(..) => continue,
            };
            let _: Option<DoubleDouble> = values.insert(id, value);
        }
        self.roots.iter().map(|root| values[root]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_soft_mode_beside_a_stiff_one_is_not_lost() -> Result<()> {
        // The force on x of A (x - y)²/2 + B (x + y)²/2: at (1, 0) A + B, at (0, 1) B - A, and B/A is beneath the rounding.
        let (a, b) = (1e8, 1e-9);
        let mut graph = Graph::default();
        let (x, y) = (graph.variable(0), graph.variable(1));
        let (stiff, soft) = (graph.parameter(0), graph.parameter(1));
        let difference = graph.subtract(x, y);
        let sum = graph.add(x, y);
        let (first, second) = (graph.multiply(stiff, difference), graph.multiply(soft, sum));
        let force = graph.add(first, second);
        let precise = Precise::new(graph, vec![force], (2, 2))?;
        let of = |state: [f64; 2]| precise.at(0.0, &state, &[a, b])[0];
        assert_eq!(of([1.0, 0.0]) + of([0.0, 1.0]), DoubleDouble::from(b) + DoubleDouble::from(b));
        Ok(())
    }
}
