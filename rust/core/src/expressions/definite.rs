//! Whether a series tells all of expressions with roots, quotients and logarithms.
//!
//! The one idea: these bend sharply, or end, only where what stands below them vanishes. A sum of squares and of something
//! positive does so nowhere, and one of the squares of all places at one point alone, which no motion goes through if the
//! expressions are infinite there. Then the coefficients tell where in the complex plane that happens, and how long steps may be.

use super::function::Function;
use super::graph::{Dependence, Graph, Id, Node, number};

/// Nothing grows with a higher power of the places, nor, with another, what is divided by: steep walls are seen too late.
const STEEPEST: f64 = 4.0;
const STEEPEST_FALL: f64 = 6.0;
/// What is divided by and grows so has a narrow crest.
const STEEP_FALL: f64 = 2.0;
/// With more of what may vanish the products of a series take longer than shorter steps.
const MOST: usize = 20;
/// Places among the numbers of a state.
const PLACES: u32 = 3;

/// What is known of the sign of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sign {
    /// Above zero everywhere.
    Positive,
    /// Not below zero, and zero only where all places of this set (a bit for each) are.
    NotNegative(u8),
    Unknown,
}

/// What is known of a node: its sign, the power of places with which it grows far out at most, and that with which it begins
/// where they all vanish.
#[derive(Clone, Copy, Debug)]
struct Known {
    sign: Sign,
    growth: f64,
    onset: f64,
}

/// Whether a series tells all of these expressions wherever it is made, whatever their parameters are: copies of a scene have
/// parameters of their own, and each is to have the method that it has alone.
pub fn is_definite(graph: &Graph, roots: &[Id]) -> bool {
    let known = known(graph);
    let of = |id: Id| known[id as usize];
    let nodes = graph.reachable(roots);
    let places_in = |ids: &[Id]| {
        let place = |id: &Id| match graph.node(*id) {
            Node::Variable(index) if *index < PLACES => 1 << index,
            _ => 0,
        };
        ids.iter().map(place).fold(0_u8, |all, place| all | place)
    };
    let places = places_in(&nodes);
    let mut below: Vec<Id> = Vec::new();
    let mut poles: Vec<Id> = Vec::new();
    for &id in &nodes {
        let base = match *graph.node(id) {
            Node::Quotient(_, base)
            | Node::Power(base, _)
            | Node::Call(Function::Sqrt | Function::Ln, base) => base,
            Node::Call(Function::Sin | Function::Cos, _) => continue,
            Node::Call(_, argument) if graph.dependence(argument) > Dependence::Parameters => return false,
            Node::Angle(..) => return false,
            _ => continue,
        };
        if graph.dependence(base) <= Dependence::Parameters {
            continue;
        }
        match of(base).sign {
            // What is narrow along one axis is a wall, with the same numbers along the others as if there were none.
            Sign::Positive if fall(graph.node(id), of(base).growth) < STEEP_FALL => {}
            Sign::Positive if places_in(&graph.reachable(&[base])).count_ones() > 1 => {}
            Sign::Positive => return false,
            Sign::NotNegative(set) if set == places && places.count_ones() > 1 => poles.push(base),
            Sign::NotNegative(_) | Sign::Unknown => return false,
        }
        below.push(base);
    }
    below.sort_unstable();
    below.dedup();
    // A component without a pole, or that is finite there, would lead through it.
    let has_pole = |root: Id| graph.reachable(&[root]).iter().any(|id| poles.contains(id));
    below.len() <= MOST
        && below.iter().all(|&base| of(base).growth <= STEEPEST_FALL)
        && roots
            .iter()
            .all(|&root| of(root).growth <= STEEPEST && (!has_pole(root) || of(root).onset <= -1.0))
}

/// With which power of the places a node falls that divides by what grows with another.
fn fall(node: &Node, growth: f64) -> f64 {
    match node {
        Node::Quotient(..) => growth,
        Node::Power(_, exponent) => -number(*exponent) * growth,
        _ => 0.0,
    }
}

fn known(graph: &Graph) -> Vec<Known> {
    let mut known: Vec<Known> = Vec::with_capacity(graph.nodes().len());
    for node in graph.nodes() {
        let of = |id: &Id| known[*id as usize];
        let next = match node {
            Node::Constant(value) => constant(number(*value)),
            Node::Parameter(_) => Known { sign: Sign::Unknown, growth: 0.0, onset: 0.0 },
            Node::Variable(index) if *index < PLACES => {
                Known { sign: Sign::Unknown, growth: 1.0, onset: 1.0 }
            }
            Node::Variable(_) | Node::Time => Known { sign: Sign::Unknown, growth: 1.0, onset: 0.0 },
            Node::Sum(value, terms) => {
                let first = (number(*value) != 0.0).then(|| constant(number(*value)));
                let terms = terms.iter().map(|(factor, term)| {
                    let term = of(term);
                    let sign = if number(*factor) > 0.0 { term.sign } else { Sign::Unknown };
                    Known { sign, ..term }
                });
                first.into_iter().chain(terms).reduce(plus).unwrap_or(constant(0.0))
            }
            Node::Product(a, b) => {
                let sign = if a == b { square(graph, *a, of(a).sign) } else { times(of(a).sign, of(b).sign) };
                Known { sign, growth: of(a).growth + of(b).growth, onset: of(a).onset + of(b).onset }
            }
            Node::Quotient(a, b) => Known {
                sign: if of(b).sign == Sign::Positive { of(a).sign } else { Sign::Unknown },
                growth: of(a).growth,
                onset: of(a).onset - of(b).onset,
            },
            Node::Power(base, exponent) => power(of(base), number(*exponent)),
            Node::Call(Function::Sqrt, argument) => power(of(argument), 0.5),
            Node::Call(Function::Sin, argument) => {
                Known { sign: Sign::Unknown, onset: of(argument).onset.max(0.0), ..of(argument) }
            }
            Node::Call(_, argument) => Known { sign: Sign::Unknown, onset: 0.0, ..of(argument) },
            Node::Angle(..) => Known { sign: Sign::Unknown, growth: 0.0, onset: 0.0 },
        };
        known.push(next);
    }
    known
}

fn constant(value: f64) -> Known {
    let sign = if value > 0.0 { Sign::Positive } else { Sign::Unknown };
    Known { sign, growth: 0.0, onset: 0.0 }
}

fn plus(a: Known, b: Known) -> Known {
    let sign = match (a.sign, b.sign) {
        (Sign::Unknown, _) | (_, Sign::Unknown) => Sign::Unknown,
        (Sign::NotNegative(a), Sign::NotNegative(b)) => Sign::NotNegative(a | b),
        _ => Sign::Positive,
    };
    Known { sign, growth: a.growth.max(b.growth), onset: a.onset.min(b.onset) }
}

fn times(a: Sign, b: Sign) -> Sign {
    match (a, b) {
        (Sign::Positive, other) | (other, Sign::Positive) => other,
        (Sign::NotNegative(a), Sign::NotNegative(b)) => Sign::NotNegative(a & b),
        _ => Sign::Unknown,
    }
}

/// Of the square of a node with that sign; that of a place, which may have a factor, tells where it vanishes.
fn square(graph: &Graph, mut of: Id, sign: Sign) -> Sign {
    if sign != Sign::Unknown {
        return sign;
    }
    if let Node::Sum(value, terms) = graph.node(of)
        && number(*value) == 0.0
        && let [(_, term)] = terms[..]
    {
        of = term;
    }
    match graph.node(of) {
        Node::Variable(index) if *index < PLACES => Sign::NotNegative(1 << index),
        _ => Sign::NotNegative(0),
    }
}

fn power(base: Known, exponent: f64) -> Known {
    let sign = if exponent > 0.0 || base.sign == Sign::Positive { base.sign } else { Sign::Unknown };
    Known { sign, growth: base.growth * exponent.max(0.0), onset: base.onset * exponent }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a potential of places: whether a series tells all of its slopes.
    fn is_told(make: impl Fn(&mut Graph, [Id; 3]) -> Id) -> bool {
        let mut graph = Graph::default();
        let places = [0, 1, 2].map(|index| graph.variable(index));
        let potential = make(&mut graph, places);
        let slopes = graph.gradient(potential, &places);
        is_definite(&graph, &slopes)
    }

    fn squares(graph: &mut Graph, places: &[Id], rest: f64) -> Id {
        let squares: Vec<_> = places.iter().map(|&x| (1.0, graph.power(x, 2.0))).collect();
        graph.sum(rest, &squares)
    }

    #[test]
    fn sums_of_squares_and_of_more_than_nothing_are() {
        // Plummer's sphere, a logarithmic halo, and the disk of Miyamoto and Nagai.
        assert!(is_told(|graph, places| {
            let square = squares(graph, &places, 0.01);
            graph.power(square, -0.5)
        }));
        assert!(is_told(|graph, places| {
            let square = squares(graph, &places, 0.01);
            graph.call(Function::Ln, square)
        }));
        let disk = |graph: &mut Graph, [x, y, z]: [Id; 3], thick: Id| {
            let (square, z) = (squares(graph, &[x, y], 0.0), graph.power(z, 2.0));
            let height = graph.sum(0.0, &[(1.0, z), (1.0, thick)]);
            let height = graph.call(Function::Sqrt, height);
            let height = graph.sum(0.5, &[(1.0, height)]);
            let height = graph.power(height, 2.0);
            let all = graph.sum(0.0, &[(1.0, square), (1.0, height)]);
            graph.power(all, -0.5)
        };
        assert!(is_told(|graph, places| {
            let thick = graph.constant(0.09);
            disk(graph, places, thick)
        }));
        // A parameter may be zero in some copy.
        assert!(!is_told(|graph, places| {
            let thick = graph.parameter(0);
            let thick = graph.power(thick, 2.0);
            disk(graph, places, thick)
        }));
    }

    #[test]
    fn poles_are_and_tips_are_not() {
        let of_distance = |exponent: f64| {
            is_told(|graph, places| {
                let square = squares(graph, &places, 0.0);
                graph.power(square, 0.5 * exponent)
            })
        };
        // Kepler's potential, and that of a dipole's square; cones and broken powers, through whose tips a motion goes.
        assert!(of_distance(-1.0) && of_distance(-3.0));
        assert!(!of_distance(1.0) && !of_distance(1.5) && !of_distance(0.5));
        // So steep a wall is seen too late.
        assert!(!of_distance(-12.0));
    }

    #[test]
    fn what_may_vanish_on_the_way_is_not() {
        // Absolute values, disks without thickness, a wall at a plane, roots of what may be of either sign.
        assert!(!is_told(|graph, [x, ..]| {
            let square = graph.power(x, 2.0);
            graph.power(square, 0.5)
        }));
        assert!(!is_told(|graph, [x, y, z]| {
            let (square, z) = (squares(graph, &[x, y], 0.0), graph.power(z, 2.0));
            let height = graph.call(Function::Sqrt, z);
            let height = graph.sum(0.5, &[(1.0, height)]);
            let height = graph.power(height, 2.0);
            let all = graph.sum(0.0, &[(1.0, square), (1.0, height)]);
            graph.power(all, -0.5)
        }));
        assert!(!is_told(|graph, [x, ..]| graph.power(x, -1.0)));
        assert!(!is_told(|graph, [x, ..]| {
            let square = squares(graph, &[x], 1e-6);
            graph.power(square, -1.0)
        }));
        assert!(!is_told(|graph, [x, y, _]| {
            let sum = graph.sum(1.0, &[(1.0, x), (1.0, y)]);
            graph.call(Function::Sqrt, sum)
        }));
        // Nor what hides between steps.
        assert!(!is_told(|graph, [x, ..]| graph.call(Function::Exp, x)));
    }
}
