//! Nodes of expressions as they come in and go out.
//!
//! A node is `(operation, arguments, value)`, its arguments numbers of nodes before it.

use visviva_core::expressions::graph::{Graph, Id, Node, number};
use visviva_core::expressions::nodes::join;
use visviva_core::{Error, Result};

/// A node.
pub(super) type NodeParts = (String, Vec<u32>, f64);

/// Adds nodes to a graph; their numbers in it.
pub(super) fn added(graph: &mut Graph, nodes: &[NodeParts]) -> Result<Vec<Id>> {
    let mut ids: Vec<Id> = Vec::with_capacity(nodes.len());
    for (operation, arguments, value) in nodes {
        let id = join(graph, &ids, operation, arguments, *value)?;
        ids.push(id);
    }
    Ok(ids)
}

pub(super) fn chosen(ids: &[Id], index: u32) -> Result<Id> {
    ids.get(index as usize).copied().ok_or_else(|| Error::Internal(format!("no node {index}")))
}

pub(super) fn all_chosen(ids: &[Id], indices: &[u32]) -> Result<Vec<Id>> {
    indices.iter().map(|&index| chosen(ids, index)).collect()
}

/// Nodes of a graph as they came in, and the places of the roots among them.
pub(super) fn shown(graph: &Graph, roots: &[Id]) -> (Vec<NodeParts>, Vec<u32>) {
    let mut places = std::collections::HashMap::new();
    let mut nodes: Vec<NodeParts> = Vec::new();
    let push = |nodes: &mut Vec<NodeParts>, operation: &str, arguments: Vec<u32>, value: f64| {
        nodes.push((operation.to_owned(), arguments, value));
        (nodes.len() - 1) as u32
    };
    for id in graph.reachable(roots) {
        let at = |id: &Id| places.get(id).copied().unwrap_or(0);
        let place = match graph.node(id) {
            Node::Constant(value) => push(&mut nodes, "constant", vec![], number(*value)),
            Node::Variable(index) => push(&mut nodes, "variable", vec![], f64::from(*index)),
            Node::Parameter(index) => push(&mut nodes, "parameter", vec![], f64::from(*index)),
            Node::Time => push(&mut nodes, "time", vec![], 0.0),
            Node::Sum(constant, terms) => {
                let mut arguments = Vec::new();
                if number(*constant) != 0.0 {
                    arguments.push(push(&mut nodes, "constant", vec![], number(*constant)));
                }
                for (coefficient, term) in terms {
                    let term = at(term);
                    if number(*coefficient) == 1.0 {
                        arguments.push(term);
                    } else {
                        let factor = push(&mut nodes, "constant", vec![], number(*coefficient));
                        arguments.push(push(&mut nodes, "product", vec![factor, term], 0.0));
                    }
                }
                push(&mut nodes, "sum", arguments, 0.0)
            }
            Node::Product(a, b) => push(&mut nodes, "product", vec![at(a), at(b)], 0.0),
            Node::Quotient(a, b) => push(&mut nodes, "quotient", vec![at(a), at(b)], 0.0),
            Node::Angle(y, x) => push(&mut nodes, "atan2", vec![at(y), at(x)], 0.0),
            Node::Call(function, a) => push(&mut nodes, function.name(), vec![at(a)], 0.0),
            Node::Power(a, exponent) => {
                let base = at(a);
                let exponent = push(&mut nodes, "constant", vec![], number(*exponent));
                push(&mut nodes, "power", vec![base, exponent], 0.0)
            }
        };
        let _ = places.insert(id, place);
    }
    let roots = roots.iter().map(|id| places.get(id).copied().unwrap_or(0)).collect();
    (nodes, roots)
}
