//! Which values nodes take while the state is anywhere in a box, and whether something narrow may hide there.
//!
//! The one idea: a function is only as narrow as its argument is fast. Where the argument of every function stays within the
//! length on which that function is like a polynomial, a few samples tell all of it; elsewhere the box has to be divided.
//! Bounds are those of ordinary arithmetic, rounded to nearest: they are for decisions that rounding may make either way.

use super::code::word;
use super::execute::Scalar;
use super::function::Function;
use super::graph::{Graph, Id, Node, number};
use crate::numerics::angles;
use core::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// Products of more factors than this are as narrow as powers.
const LOW_DEGREE: u32 = 32;
/// By so much a power or an exponential may grow where a few samples are to tell it.
const GROWTH: f64 = 4.0;
/// Beneath this exponent an exponential is zero.
const VANISHES: f64 = -745.2;
/// Above that it is infinite, as what is divided by it is zero.
const OVERFLOWS: f64 = 709.8;

/// All numbers between two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lowest.
    pub low: f64,
    /// The highest.
    pub high: f64,
}

/// Values of nodes over a box.
#[derive(Clone, Debug)]
pub struct Bounds {
    /// Where they are.
    pub values: Vec<Interval>,
    /// Nothing narrow hides in the box.
    pub is_plain: bool,
}

/// Nodes that are looked at.
#[derive(Clone, Debug)]
pub struct Intervals {
    graph: Arc<Graph>,
    roots: Vec<Id>,
    /// All that they are made of, arguments first.
    nodes: Arc<[Id]>,
    /// The degree of each, were functions as smooth as their arguments.
    degrees: Arc<[u32]>,
    found: Vec<Interval>,
}

impl Interval {
    /// Of all numbers.
    const ANY: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// Of one number.
    #[must_use]
    pub fn at(x: f64) -> Self {
        Self::between(x, x)
    }

    /// Between two numbers, whichever is the lower.
    #[must_use]
    pub fn between(a: f64, b: f64) -> Self {
        if a.is_nan() || b.is_nan() { Self::ANY } else { Self { low: a.min(b), high: a.max(b) } }
    }

    fn hull(values: &[f64]) -> Self {
        values.iter().skip(1).fold(Self::at(values[0]), |all, &x| {
            let x = Self::at(x);
            Self { low: all.low.min(x.low), high: all.high.max(x.high) }
        })
    }

    fn width(self) -> f64 {
        self.high - self.low
    }

    fn has_zero(self) -> bool {
        self.low <= 0.0 && self.high >= 0.0
    }

    /// The smallest and the greatest size of its numbers.
    fn sizes(self) -> (f64, f64) {
        let (a, b) = (self.low.abs(), self.high.abs());
        (if self.has_zero() { 0.0 } else { a.min(b) }, a.max(b))
    }

    /// The sizes differ by no more than such a factor.
    fn is_within(self, factor: f64) -> bool {
        let (least, greatest) = self.sizes();
        greatest <= factor * least
    }

    fn product(self, other: Self) -> Self {
        let of = [self.low, self.high].map(|a| [a * other.low, a * other.high]);
        Self::hull(&of.concat())
    }

    fn square(self) -> Self {
        let (least, greatest) = self.sizes();
        Self::between(least * least, greatest * greatest)
    }

    fn quotient(self, other: Self) -> Self {
        if other.has_zero() && other != Self::at(0.0) {
            return Self::ANY;
        }
        let of = [self.low, self.high].map(|a| [a / other.low, a / other.high]);
        Self::hull(&of.concat())
    }

    fn sum(self, factor: f64, other: Self) -> Self {
        let (a, b) = (factor * other.low, factor * other.high);
        Self::between(self.low + a.min(b), self.high + a.max(b))
    }

    /// The cosine, or another of its shape whose highest places are `top` away.
    fn wave(self, of: impl Fn(f64) -> f64, top: f64) -> Self {
        if !self.width().is_finite() || self.width() >= 2.0 * PI {
            return Self::between(-1.0, 1.0);
        }
        let mut values = Self::between(of(self.low), of(self.high));
        let halves = ((self.low - top) / PI).ceil();
        for extremum in [halves, halves + 1.0] {
            if top + extremum * PI <= self.high {
                let value = if extremum % 2.0 == 0.0 { 1.0 } else { -1.0 };
                values = Self { low: values.low.min(value), high: values.high.max(value) };
            }
        }
        values
    }
}

impl Intervals {
    /// Of these nodes.
    pub fn new(graph: Graph, roots: Vec<Id>) -> Self {
        let nodes = graph.reachable(&roots);
        let mut degrees = vec![0_u32; graph.nodes().len()];
        for &id in &nodes {
            let of = |id: &Id| degrees[*id as usize];
            degrees[id as usize] = match graph.node(id) {
                Node::Constant(_) | Node::Parameter(_) | Node::Time => 0,
                Node::Variable(_) => 1,
                Node::Sum(_, terms) => terms.iter().map(|(_, x)| of(x)).max().unwrap_or(0),
                Node::Product(a, b) => of(a).saturating_add(of(b)),
                Node::Quotient(a, b) | Node::Angle(a, b) => of(a).max(of(b)),
                Node::Call(_, a) | Node::Power(a, _) => of(a),
            };
        }
        let found = vec![Interval::ANY; graph.nodes().len()];
        Self { graph: Arc::new(graph), roots, nodes: nodes.into(), degrees: degrees.into(), found }
    }

    /// Where they are while time and state are in a box.
    pub fn over(&mut self, t: Interval, state: &[Interval], parameters: &[f64]) -> Bounds {
        let mut is_plain = true;
        for &id in &*self.nodes {
            let of = |id: Id| self.found[id as usize];
            let (value, plain) = match *self.graph.node(id) {
                Node::Constant(bits) => (Interval::at(number(bits)), true),
                Node::Variable(index) => (state[index as usize], true),
                Node::Parameter(index) => (Interval::at(parameters[index as usize]), true),
                Node::Time => (t, true),
                Node::Sum(constant, ref terms) => {
                    let zero = Interval::at(number(constant));
                    (terms.iter().fold(zero, |sum, &(factor, term)| sum.sum(number(factor), of(term))), true)
                }
                Node::Product(a, b) => {
                    let value = if a == b { of(a).square() } else { of(a).product(of(b)) };
                    let low = self.degrees[id as usize] <= LOW_DEGREE;
                    let nothing = value.sizes().1 < f64::MIN_POSITIVE;
                    (value, low || nothing || value.is_within(GROWTH.exp()))
                }
                Node::Quotient(a, b) => (of(a).quotient(of(b)), of(b).is_within(GROWTH)),
                Node::Angle(y, x) => angle(of(y), of(x)),
                Node::Call(function, a) => call(function, of(a)),
                Node::Power(a, exponent) => {
                    let (a, exponent) = (of(a), number(exponent));
                    let value = Interval::between(a.low.raised(exponent), a.high.raised(exponent));
                    (value, a.low > 0.0 && a.is_within(GROWTH))
                }
            };
            is_plain &= plain;
            self.found[id as usize] = value;
        }
        Bounds { values: self.roots.iter().map(|&root| self.found[root as usize]).collect(), is_plain }
    }
}

/// The angle of the points of a rectangle, and whether it is seen from far enough.
fn angle(y: Interval, x: Interval) -> (Interval, bool) {
    if x.low <= 0.0 && y.has_zero() {
        return (Interval::between(-PI, PI), false);
    }
    let corners = [(y.low, x.low), (y.low, x.high), (y.high, x.low), (y.high, x.high)];
    let distance = y.sizes().0.max(x.sizes().0);
    (Interval::hull(&corners.map(|(y, x)| y.angle(x))), y.width().max(x.width()) <= distance)
}

/// A function over an interval, and whether a few samples tell it there.
fn call(function: Function, x: Interval) -> (Interval, bool) {
    let of = |x: f64| x.called(word::CALL + function as u16);
    let ends = || Interval::between(of(x.low), of(x.high));
    let (least, greatest) = x.sizes();
    // Growing with the size of what they are taken of.
    let even = || Interval::between(of(least), of(greatest));
    let is_slow = |length: f64| x.width() <= length;
    match function {
        Function::Sin => (x.wave(angles::sin, FRAC_PI_2), is_slow(2.0)),
        Function::Cos => (x.wave(angles::cos, 0.0), is_slow(2.0)),
        Function::Tan => {
            let pole = ((x.low - FRAC_PI_2) / PI).ceil() * PI + FRAC_PI_2;
            let clear = pole > x.high;
            // Poles are as far as the interval is long.
            let distance = (pole - x.high).min(x.low - (pole - PI));
            (if clear { ends() } else { Interval::ANY }, clear && is_slow(distance))
        }
        Function::Exp => (ends(), is_slow(GROWTH) || x.high < VANISHES || x.low > OVERFLOWS),
        Function::Ln => (ends(), x.low > 0.0 && x.is_within(GROWTH)),
        Function::Sqrt => {
            (Interval::between(x.low.max(0.0).sqrt(), x.high.sqrt()), x.low > 0.0 && x.is_within(GROWTH))
        }
        Function::Sinh => (ends(), is_slow(GROWTH)),
        Function::Cosh => (even(), is_slow(GROWTH)),
        Function::Tanh => (ends(), is_slow(1.0) || least > 20.0),
        Function::SechSquared => (even(), is_slow(1.0) || least > -VANISHES),
        Function::Asin | Function::Acos | Function::Atanh => (ends(), is_slow(1.0 - greatest)),
        Function::Atan | Function::Asinh => (ends(), is_slow(least.max(1.0))),
        Function::Acosh => (ends(), x.low > 1.0 && x.high - 1.0 <= GROWTH * (x.low - 1.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// All functions, quotients, powers and angles of two numbers.
    fn graph() -> (Graph, Vec<Id>) {
        let mut graph = Graph::default();
        let (x, y) = (graph.variable(0), graph.variable(1));
        let mut roots: Vec<Id> = Function::ALL.into_iter().map(|function| graph.call(function, x)).collect();
        let quotient = graph.divide(x, y);
        let product = graph.multiply(x, y);
        let square = graph.multiply(x, x);
        let power = graph.power(x, 1.3);
        let high = graph.power(y, 60.0);
        let angle = graph.angle(y, x);
        let sum = graph.sum(0.7, &[(2.0, square), (-3.0, y), (0.5, quotient)]);
        roots.extend([quotient, product, square, power, high, angle, sum]);
        (graph, roots)
    }

    proptest! {
        #[test]
        fn values_are_in_their_bounds(x in -8.0..8.0_f64, y in -3.0..3.0_f64, width in 0.0..1.0_f64, part in 0.0..1.0_f64) {
            let (graph, roots) = graph();
            let mut intervals = Intervals::new(graph.clone(), roots.clone());
            let width = 4.0 * width * width;
            let of = |x: f64| Interval::between(x, x + width);
            let bounds = intervals.over(Interval::at(0.0), &[of(x), of(y)], &[]).values;
            let points = [x + part * width, y + (1.0 - part) * width].map(Interval::at);
            let values = intervals.over(Interval::at(0.0), &points, &[]).values;
            for (index, (bound, value)) in bounds.iter().zip(values).enumerate() {
                // What is no number there may be anything.
                if value != Interval::ANY && value.low.is_finite() {
                    let rounding = 1e-14 * value.low.abs().max(1e-300);
                    prop_assert!(bound.low <= value.low + rounding && value.high <= bound.high + rounding,
                        "{index} {bound:?} {value:?}");
                }
            }
        }
    }

    #[test]
    fn what_is_narrow_is_not_plain() {
        let mut graph = Graph::default();
        let x = graph.variable(0);
        let square = graph.multiply(x, x);
        let fast = graph.scale(-1e5, square);
        let bump = graph.call(Function::Exp, fast);
        let magnitude = graph.call(Function::Sqrt, square);
        let high = graph.power(x, 1000.0);
        let is_plain = |root: Id, low: f64, high: f64| {
            let mut of = Intervals::new(graph.clone(), vec![root]);
            of.over(Interval::at(0.0), &[Interval::between(low, high)], &[]).is_plain
        };
        // Where the bump is, beside it, and where it is too small to be a number.
        assert!(!is_plain(bump, -1.0, 1.0) && !is_plain(bump, 0.0, 0.01) && is_plain(bump, 0.0, 0.006));
        assert!(is_plain(bump, 0.1, 1.0) && is_plain(square, -1.0, 1.0));
        assert!(!is_plain(magnitude, -1.0, 1.0) && is_plain(magnitude, 0.6, 1.0));
        assert!(!is_plain(high, 0.0, 1.0) && is_plain(high, 0.997, 1.0));
    }
}
