//! Which expressions may be too narrow for the steps of a method, and hide between the places where it looks.
//!
//! The one idea: exp and what is written with it may be nothing at two neighboring places and all that matters in between; what is
//! algebraic tells of itself from afar if it stands alone and falls slowly, but 1/(1 + u⁸) is nothing to either side, and the
//! two sides of a switch, u/√(u² + ε²), take each other away.
//! Polynomials of low degree, and waves that stand in space, are as long as they are seen to be.

use super::function::Function;
use super::graph::{Dependence, Graph, Id, Node};

/// Polynomials of places, velocities and times up to this degree have no narrow crests.
const STEEPEST: f64 = 4.0;

/// What falls with a lower power of places and times than this tells of itself from afar; a product of several that fall as this
/// does not.
const STEEP_FALL: f64 = 2.0;
/// The highest power that is told apart.
const HIGHEST: f64 = 64.0;

/// How something narrow depends on its argument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// By a function.
    Call(Function),
    /// By a power of its inverse.
    Divided(f64),
    /// As its absolute value, by its sign.
    Absolute,
}

/// Something narrow, and what decides where it is not nothing.
#[derive(Clone, Copy, Debug)]
pub struct Narrow {
    /// How it depends on that.
    pub kind: Kind,
    /// Its node.
    pub node: Id,
    /// Its argument.
    pub argument: Id,
}

/// What may be narrow among these expressions: functions like exp where their arguments change on the way; sin and cos where the
/// time changes them, as drives and running waves do, which may be faster than a step, and too weak for its errors; what falls
/// steeply; and absolute values, of which two may make a tent.
pub fn narrow(graph: &Graph, roots: &[Id]) -> Vec<Narrow> {
    let (growth, raised) = (growth(graph), raised(graph, roots));
    let may_be_narrow = |node: Id| {
        let (kind, argument) = match *graph.node(node) {
            Node::Call(Function::Sqrt, under) => match even_power(graph, under) {
                (base, 2.0) => (Kind::Absolute, base),
                _ => return None,
            },
            Node::Call(function, argument) => (Kind::Call(function), argument),
            Node::Quotient(_, below) => (Kind::Divided(raised[node as usize]), below),
            Node::Power(base, exponent) => {
                (Kind::Divided(-f64::from_bits(exponent) * raised[node as usize]), base)
            }
            _ => return None,
        };
        let changes = graph.dependence(argument);
        let may = match kind {
            Kind::Call(
                Function::Exp | Function::Tanh | Function::SechSquared | Function::Sinh | Function::Cosh,
            ) => changes > Dependence::Parameters,
            Kind::Call(Function::Sin | Function::Cos) => {
                changes >= Dependence::Time && hangs_on_time(graph, argument)
            }
            Kind::Call(_) => false,
            Kind::Absolute => changes > Dependence::Parameters,
            Kind::Divided(exponent) => {
                changes > Dependence::Parameters && exponent * growth[argument as usize] >= STEEP_FALL
            }
        };
        may.then_some(Narrow { kind, node, argument })
    };
    graph.reachable(roots).into_iter().filter_map(may_be_narrow).collect()
}

/// Whether the time is in an expression.
fn hangs_on_time(graph: &Graph, id: Id) -> bool {
    graph.any(&[id], |node| matches!(node, Node::Time))
}

/// x of x², x⁴ and so on, which may have a factor, and that power; of all else itself, and one.
pub fn even_power(graph: &Graph, mut id: Id) -> (Id, f64) {
    let mut power = 1.0;
    loop {
        let (base, more) = match graph.node(id) {
            Node::Sum(constant, terms) if f64::from_bits(*constant) == 0.0 && terms.len() == 1 => {
                (terms[0].1, 1.0)
            }
            Node::Product(a, b) if a == b => (*a, 2.0),
            Node::Power(a, exponent) if f64::from_bits(*exponent) % 2.0 == 0.0 => {
                (*a, f64::from_bits(*exponent))
            }
            _ => return (id, power),
        };
        (id, power) = (base, power * more);
    }
}

/// The power of places and times with which every node grows at most, far out.
fn growth(graph: &Graph) -> Vec<f64> {
    let mut powers: Vec<f64> = Vec::with_capacity(graph.nodes().len());
    for (index, node) in graph.nodes().iter().enumerate() {
        let of = |id: Id| powers[id as usize];
        let power = match node {
            _ if graph.dependence(index as Id) <= Dependence::Parameters => 0.0,
            Node::Constant(_) | Node::Parameter(_) => 0.0,
            Node::Variable(_) | Node::Time => 1.0,
            Node::Sum(_, terms) => terms.iter().map(|&(_, id)| of(id)).fold(0.0, f64::max),
            Node::Product(a, b) => of(*a) + of(*b),
            Node::Quotient(a, _) => of(*a),
            Node::Power(base, exponent) => of(*base) * f64::from_bits(*exponent).max(0.0),
            Node::Call(Function::Sqrt, argument) => 0.5 * of(*argument),
            Node::Call(..) | Node::Angle(..) => 0.0,
        };
        powers.push(power);
    }
    powers
}

/// To which power every node is raised at most, on the way to these expressions: (s/r)¹² falls as its quotient does not.
fn raised(graph: &Graph, roots: &[Id]) -> Vec<f64> {
    let mut powers = vec![1.0_f64; graph.nodes().len()];
    for id in graph.reachable(roots).into_iter().rev() {
        let own = powers[id as usize];
        let mut raise = |child: Id, to: f64| {
            let power = &mut powers[child as usize];
            *power = power.max(to.min(HIGHEST));
        };
        match graph.node(id) {
            Node::Sum(_, terms) => terms.iter().for_each(|&(_, term)| raise(term, own)),
            Node::Product(a, b) if a == b => raise(*a, 2.0 * own),
            Node::Product(a, b) | Node::Quotient(a, b) => {
                [*a, *b].into_iter().for_each(|part| raise(part, own))
            }
            Node::Power(base, exponent) => raise(*base, own * f64::from_bits(*exponent).abs()),
            Node::Call(Function::Sqrt, argument) => raise(*argument, 0.5 * own),
            _ => {}
        }
    }
    powers
}

/// Whether expressions have no roots and quotients: where the motion is smooth so are they, and the ends of a step, with the
/// slopes there, tell all of them.
pub fn is_smooth(graph: &Graph, expressions: &[Id]) -> Vec<bool> {
    let bends = |node: &Node| match *node {
        Node::Quotient(_, below) => graph.dependence(below) > Dependence::Parameters,
        Node::Power(base, exponent) => {
            let exponent = f64::from_bits(exponent);
            graph.dependence(base) > Dependence::Parameters && (exponent < 0.0 || exponent.fract() != 0.0)
        }
        Node::Call(function, _) => !matches!(function, Function::Sin | Function::Cos),
        Node::Angle(..) => true,
        _ => false,
    };
    expressions.iter().map(|&id| !graph.any(&[id], bends)).collect()
}

/// Whether there may be more in these expressions than a step sees: anything but polynomials of low degree, waves that stand in
/// space, and those of the time alone, which are looked for.
pub fn may_hide(graph: &Graph, roots: &[Id]) -> bool {
    is_steep(graph, roots, false)
}

/// Whether some of these expressions are of a higher degree than [`STEEPEST`], or no polynomials.
fn is_steep(graph: &Graph, roots: &[Id], waves_of_time: bool) -> bool {
    let degrees = degrees(graph, waves_of_time);
    graph.reachable(roots).into_iter().any(|id| degrees[id as usize] > STEEPEST)
}

/// The degree of every node in places, velocities and times; infinite of what is no polynomial of them and of their waves, or
/// of a wave that the time moves in space unless those count.
fn degrees(graph: &Graph, waves_of_time: bool) -> Vec<f64> {
    let changes = |id: Id| graph.dependence(id) > Dependence::Parameters;
    let mut degrees: Vec<f64> = Vec::with_capacity(graph.nodes().len());
    for node in graph.nodes() {
        let of = |id: Id| degrees[id as usize];
        let degree = match node {
            Node::Constant(_) | Node::Parameter(_) => 0.0,
            Node::Variable(_) | Node::Time => 1.0,
            Node::Sum(_, terms) => terms.iter().map(|&(_, id)| of(id)).fold(0.0, f64::max),
            Node::Product(a, b) => of(*a) + of(*b),
            Node::Quotient(a, b) if !changes(*b) => of(*a),
            Node::Call(Function::Sin | Function::Cos, argument)
                if waves_of_time
                    || !hangs_on_time(graph, *argument)
                    || graph.dependence(*argument) == Dependence::Time =>
            {
                of(*argument)
            }
            Node::Call(_, argument) | Node::Power(argument, _) if !changes(*argument) => 0.0,
            Node::Angle(a, b) if !changes(*a) && !changes(*b) => 0.0,
            Node::Quotient(..) | Node::Angle(..) | Node::Call(..) | Node::Power(..) => f64::INFINITY,
        };
        degrees.push(degree);
    }
    degrees
}

/// Whether a Taylor series tells all of these expressions, wherever it is made, and before steps are long: of polynomials of low
/// degree and of waves, whose coefficients grow until a fast one is seen, however weak.
pub fn is_entire(graph: &Graph, roots: &[Id]) -> bool {
    !is_steep(graph, roots, true)
}

/// Whether a series tells all of what the time enters in them: of sums, products, whole powers, sines and cosines. What is made
/// of exp may be nothing in all coefficients.
pub fn is_entire_in_time(graph: &Graph, roots: &[Id]) -> bool {
    graph.reachable(roots).into_iter().all(|id| match *graph.node(id) {
        Node::Constant(_) | Node::Parameter(_) | Node::Variable(_) | Node::Time => true,
        Node::Sum(..) | Node::Product(..) | Node::Call(Function::Sin | Function::Cos, _) => true,
        Node::Quotient(_, below) => !hangs_on_time(graph, below),
        Node::Power(base, exponent) => {
            let exponent = f64::from_bits(exponent);
            (exponent >= 0.0 && exponent.fract() == 0.0) || !hangs_on_time(graph, base)
        }
        Node::Call(_, argument) => !hangs_on_time(graph, argument),
        Node::Angle(y, x) => !hangs_on_time(graph, y) && !hangs_on_time(graph, x),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A graph of x, y and the time, and an expression in it.
    fn hides(make: impl Fn(&mut Graph, Id, Id) -> Id) -> bool {
        let mut graph = Graph::default();
        let (x, t) = (graph.variable(0), graph.time());
        let root = make(&mut graph, x, t);
        may_hide(&graph, &[root])
    }

    #[test]
    fn polynomials_and_standing_waves_do_not() {
        assert!(!hides(|graph, x, t| graph.product(&[x, x, t])));
        assert!(!hides(|graph, x, _| graph.power(x, 4.0)));
        assert!(!hides(|graph, x, _| graph.call(Function::Sin, x)));
        // Drives are looked for.
        assert!(!hides(|graph, _, t| graph.call(Function::Cos, t)));
        // What does not change is a number.
        assert!(!hides(|graph, x, _| {
            let parameter = graph.parameter(0);
            let number = graph.call(Function::Exp, parameter);
            graph.product(&[number, x])
        }));
    }

    #[test]
    fn what_may_be_nothing_beside_a_stage_does() {
        for function in [Function::Exp, Function::Tanh, Function::Sqrt, Function::Atan, Function::Ln] {
            assert!(hides(|graph, x, _| graph.call(function, x)));
        }
        // Running waves, corners and switches, steep powers.
        assert!(hides(|graph, x, t| {
            let phase = graph.sum(0.0, &[(1.0, x), (-1.0, t)]);
            graph.call(Function::Cos, phase)
        }));
        assert!(hides(|graph, x, _| {
            let square = graph.power(x, 2.0);
            graph.power(square, 0.5)
        }));
        assert!(hides(|graph, _, t| {
            let square = graph.power(t, 2.0);
            let sum = graph.sum(1e-12, &[(1.0, square)]);
            let root = graph.power(sum, -0.5);
            graph.product(&[t, root])
        }));
        assert!(hides(|graph, x, _| graph.power(x, 6.0)));
    }

    #[test]
    fn series_tell_all_of_polynomials_and_waves() {
        let mut graph = Graph::default();
        let (x, t) = (graph.variable(0), graph.time());
        let both = |graph: &Graph, id: Id| (is_entire(graph, &[id]), is_entire_in_time(graph, &[id]));
        let phase = graph.sum(0.0, &[(3.0, x), (-1e6, t)]);
        let wave = graph.call(Function::Cos, phase);
        let cube = graph.power(x, 3.0);
        let driven = graph.product(&[wave, cube]);
        assert_eq!(both(&graph, driven), (true, true));
        // In steep wells series choose their steps too late.
        let steep = graph.power(x, 11.0);
        assert_eq!(both(&graph, steep), (false, true));
        // Of places there may be anything beside such drives.
        let inverse = graph.power(x, -3.0);
        let far = graph.product(&[wave, inverse]);
        assert_eq!(both(&graph, far), (false, true));
        for hides in [graph.call(Function::Exp, t), graph.power(t, 0.5), graph.power(phase, -1.0)] {
            assert_eq!(both(&graph, hides), (false, false));
        }
    }

    #[test]
    fn what_is_not_asked_for_does_not_count() {
        let mut graph = Graph::default();
        let x = graph.variable(0);
        let _ = graph.call(Function::Exp, x);
        assert!(!may_hide(&graph, &[x]));
    }
}
