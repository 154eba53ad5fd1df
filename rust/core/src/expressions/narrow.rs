//! Which functions among expressions may be too narrow for the steps of a method, and hide between the places where it looks.
//!
//! The one idea: what is algebraic, and no steeper than an inverse square along a line, tells of itself from afar; exp and what is
//! written with it may be nothing at two neighboring places and all that matters in between.

use super::function::Function;
use super::graph::{Dependence, Graph, Id, Node};

/// Powers of places and times up to this tell of themselves from afar: those in the pull of a point, x (x² + y² + z²)^−3/2. A
/// hundred widths away a pulse that falls off by a higher power is less than what a step leaves out.
const STEEPEST: f64 = 4.0;

/// The calls of functions like exp among these expressions, with their arguments, where those change on the way; and those of
/// sin and cos where the time alone changes them, as drives do: they may be faster than a step, and too weak for its errors.
pub fn calls(graph: &Graph, roots: &[Id]) -> Vec<(Function, Id, Id)> {
    let may_be_narrow = |id: Id| {
        let Node::Call(function, argument) = *graph.node(id) else { return None };
        let changes = graph.dependence(argument);
        let may = match function {
            Function::Exp | Function::Tanh | Function::SechSquared | Function::Sinh | Function::Cosh => {
                changes > Dependence::Parameters
            }
            Function::Sin | Function::Cos => changes == Dependence::Time,
            _ => false,
        };
        may.then_some((function, id, argument))
    };
    graph.reachable(roots).into_iter().filter_map(may_be_narrow).collect()
}

/// Whether nothing in these expressions hides from a step: no functions like exp, no steep powers, and nothing that is smooth on
/// either side of where it bends at once, as |x| and atan2.
pub fn all_tell_from_afar(graph: &Graph, roots: &[Id]) -> bool {
    let changes = |id: Id| graph.dependence(id) > Dependence::Parameters;
    let is_square = |id: Id| matches!(graph.node(id), Node::Product(a, b) if a == b);
    let bends = |id: Id| match *graph.node(id) {
        Node::Angle(..) => changes(id),
        Node::Call(Function::Sqrt, argument) | Node::Power(argument, _) => {
            changes(argument) && is_square(argument)
        }
        _ => false,
    };
    let reached = graph.reachable(roots);
    calls(graph, roots).is_empty()
        && !reached.iter().copied().any(bends)
        && degrees(graph).iter().enumerate().all(|(id, &degree)| {
            // Every node is there before those that are made of it, and `reached` ascends.
            degree <= STEEPEST || reached.binary_search(&(id as Id)).is_err()
        })
}

/// The powers of places and times in every node, of quotients those above and below together.
fn degrees(graph: &Graph) -> Vec<f64> {
    let mut degrees: Vec<f64> = Vec::with_capacity(graph.nodes().len());
    for node in graph.nodes() {
        let of = |id: Id| degrees[id as usize];
        let degree = match node {
            Node::Constant(_) | Node::Parameter(_) => 0.0,
            Node::Variable(_) | Node::Time => 1.0,
            Node::Sum(_, terms) => terms.iter().map(|&(_, id)| of(id)).fold(0.0, f64::max),
            Node::Product(a, b) | Node::Quotient(a, b) | Node::Angle(a, b) => of(*a) + of(*b),
            Node::Call(Function::Sqrt, argument) => 0.5 * of(*argument),
            Node::Call(_, argument) => of(*argument),
            Node::Power(argument, power) => of(*argument) * f64::from_bits(*power).abs(),
        };
        degrees.push(degree);
    }
    degrees
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A graph of x, y and the time, and an expression in it.
    fn told(make: impl Fn(&mut Graph, Id, Id) -> Id) -> bool {
        let mut graph = Graph::default();
        let (x, t) = (graph.variable(0), graph.time());
        let root = make(&mut graph, x, t);
        all_tell_from_afar(&graph, &[root])
    }

    #[test]
    fn what_is_algebraic_and_gentle_tells_of_itself() {
        assert!(told(|graph, x, t| graph.product(&[x, t])));
        assert!(told(|graph, x, _| graph.call(Function::Sin, x)));
        assert!(told(|graph, x, _| {
            let square = graph.power(x, 2.0);
            let sum = graph.sum(1.0, &[(1.0, square)]);
            graph.power(sum, -1.5)
        }));
    }

    #[test]
    fn what_may_be_nothing_beside_a_stage_does_not() {
        for function in [Function::Exp, Function::Tanh, Function::SechSquared, Function::Cosh, Function::Sinh]
        {
            assert!(!told(|graph, x, _| graph.call(function, x)));
        }
        // Drives, corners and steep powers.
        assert!(!told(|graph, _, t| graph.call(Function::Cos, t)));
        assert!(!told(|graph, x, _| {
            let square = graph.power(x, 2.0);
            graph.power(square, 0.5)
        }));
        assert!(!told(|graph, x, _| graph.power(x, -6.0)));
    }

    #[test]
    fn what_is_not_asked_for_does_not_count() {
        let mut graph = Graph::default();
        let x = graph.variable(0);
        let _ = graph.call(Function::Exp, x);
        assert!(all_tell_from_afar(&graph, &[x]));
        // A function of parameters alone is a number.
        let parameter = graph.parameter(0);
        let number = graph.call(Function::Exp, parameter);
        let product = graph.product(&[number, x]);
        assert!(all_tell_from_afar(&graph, &[product]));
    }
}
