//! The graph: sums are linear combinations, products are binary, and equal nodes are the same node.
//!
//! The one idea: a node is simplified when it is made and never again. Sums are kept sorted, so that like terms of
//! derivatives cancel at once; constants are pulled out of products; nothing is ever expanded.

use super::function::{Function, Parity};
use super::identity;
use super::walk::for_each_argument;
use crate::numerics::functions;
use rustc_hash::FxHashMap;

/// The number of a node; what it is made of has smaller numbers.
pub type Id = u32;

/// An operation on other nodes. Constants are kept as bits, so that nodes can be compared.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    /// A number.
    Constant(u64),
    /// A number of the state.
    Variable(u32),
    /// A parameter.
    Parameter(u32),
    /// The time.
    Time,
    /// c₀ + Σ cᵢ xᵢ, the xᵢ ascending and neither constants nor multiples.
    Sum(u64, Box<[(u64, Id)]>),
    /// A product, the smaller number first.
    Product(Id, Id),
    /// A quotient.
    Quotient(Id, Id),
    /// The angle of the point (x, y), y first, from the positive x-axis.
    Angle(Id, Id),
    /// A function.
    Call(Function, Id),
    /// A constant real power that products and roots do not make.
    Power(Id, u64),
}

/// What the value of a node may change with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dependence {
    /// Nothing.
    Constant,
    /// Parameters.
    Parameters,
    /// The time, and parameters.
    Time,
    /// The state, and all else.
    State,
}

/// Whole powers up to this are multiplied out, by squares: they are known below zero, too.
const WHOLE: f64 = 65_536.0;
/// The powers up to this that are a half more are multiplied out beside the root.
const MULTIPLIED: f64 = 64.0;

/// Expressions that share what they have in common.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    dependence: Vec<Dependence>,
    ids: FxHashMap<Node, Id>,
}

/// The number that these are the bits of; there is one zero.
pub fn number(bits: u64) -> f64 {
    f64::from_bits(bits)
}

/// The bits of a number, of one zero.
fn bits(value: f64) -> u64 {
    (value + 0.0).to_bits()
}

impl Graph {
    /// All nodes.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// One of them.
    pub fn node(&self, id: Id) -> &Node {
        &self.nodes[id as usize]
    }

    /// What a node may change with.
    pub fn dependence(&self, id: Id) -> Dependence {
        self.dependence[id as usize]
    }

    /// The node as it stands, which may be there already.
    pub(super) fn put(&mut self, node: Node) -> Id {
        if let Some(&id) = self.ids.get(&node) {
            return id;
        }
        let id = self.nodes.len() as Id;
        let dependence = match &node {
            Node::Constant(_) => Dependence::Constant,
            Node::Parameter(_) => Dependence::Parameters,
            Node::Time => Dependence::Time,
            Node::Variable(_) => Dependence::State,
            _ => {
                let mut most = Dependence::Constant;
                for_each_argument(&node, |argument| most = most.max(self.dependence(argument)));
                most
            }
        };
        self.nodes.push(node.clone());
        self.dependence.push(dependence);
        let _ = self.ids.insert(node, id);
        id
    }

    /// A number.
    pub fn constant(&mut self, value: f64) -> Id {
        self.put(Node::Constant(bits(value)))
    }

    /// A number of the state.
    pub fn variable(&mut self, index: u32) -> Id {
        self.put(Node::Variable(index))
    }

    /// A parameter.
    pub fn parameter(&mut self, index: u32) -> Id {
        self.put(Node::Parameter(index))
    }

    /// The time.
    pub fn time(&mut self) -> Id {
        self.put(Node::Time)
    }

    /// The number that a node is, if it is one.
    pub fn as_constant(&self, id: Id) -> Option<f64> {
        match self.node(id) {
            Node::Constant(value) => Some(number(*value)),
            _ => None,
        }
    }

    /// Whether a node is the number 0.
    pub fn is_zero(&self, id: Id) -> bool {
        self.as_constant(id) == Some(0.0)
    }

    /// A node as a multiple of another, which is none.
    fn multiple(&self, id: Id) -> (f64, Id) {
        match self.node(id) {
            Node::Sum(constant, terms) if number(*constant) == 0.0 && terms.len() == 1 => {
                (number(terms[0].0), terms[0].1)
            }
            _ => (1.0, id),
        }
    }

    /// `constant` + Σ coefficient · node.
    pub fn sum(&mut self, mut constant: f64, terms: &[(f64, Id)]) -> Id {
        let mut found: Vec<(Id, f64)> = Vec::with_capacity(terms.len());
        for &(coefficient, id) in terms {
            if coefficient == 0.0 {
                continue;
            }
            if let Some(value) = self.as_constant(id) {
                constant += coefficient * value;
                continue;
            }
            let (factor, id) = self.multiple(id);
            found.push((id, coefficient * factor));
        }
        found.sort_by_key(|&(id, _)| id);
        let mut like: Vec<(Id, f64)> = Vec::with_capacity(found.len());
        for (id, coefficient) in found {
            match like.last_mut() {
                Some(last) if last.0 == id => last.1 += coefficient,
                _ => like.push((id, coefficient)),
            }
        }
        like.retain(|&(_, coefficient)| coefficient != 0.0);
        if let Some(simpler) = identity::squares_of_sine_and_cosine(self, &like) {
            return self.sum(constant, &simpler);
        }
        match like.as_slice() {
            [] => return self.constant(constant),
            &[(id, 1.0)] if constant == 0.0 => return id,
            &[(id, -1.0)] if constant == 0.0 => {
                // −(sum) has its terms' signs changed.
                if let Node::Sum(inner, terms) = self.node(id) {
                    let negated: Vec<_> = terms.iter().map(|&(c, x)| (-number(c), x)).collect();
                    let inner = -number(*inner);
                    return self.sum(inner, &negated);
                }
            }
            _ => {}
        }
        let terms = like.iter().map(|&(id, coefficient)| (bits(coefficient), id)).collect();
        self.put(Node::Sum(bits(constant), terms))
    }

    /// a + b.
    pub fn add(&mut self, a: Id, b: Id) -> Id {
        self.sum(0.0, &[(1.0, a), (1.0, b)])
    }

    /// a − b.
    pub fn subtract(&mut self, a: Id, b: Id) -> Id {
        self.sum(0.0, &[(1.0, a), (-1.0, b)])
    }

    /// A multiple.
    pub fn scale(&mut self, factor: f64, a: Id) -> Id {
        self.sum(0.0, &[(factor, a)])
    }

    /// a · b.
    pub fn multiply(&mut self, a: Id, b: Id) -> Id {
        if let Some(value) = self.as_constant(a) {
            return self.scale(value, b);
        }
        if let Some(value) = self.as_constant(b) {
            return self.scale(value, a);
        }
        let ((factor_a, a), (factor_b, b)) = (self.multiple(a), self.multiple(b));
        let factor = factor_a * factor_b;
        for (one, other) in [(a, b), (b, a)] {
            // a · (1/d) = a/d
            if let Node::Quotient(numerator, denominator) = *self.node(other)
                && self.as_constant(numerator) == Some(1.0)
            {
                let quotient = self.divide(one, denominator);
                return self.scale(factor, quotient);
            }
        }
        // √s √s
        let root_of = match *self.node(a) {
            Node::Call(Function::Sqrt, of) if a == b => Some(of),
            _ => None,
        };
        let product = root_of.unwrap_or_else(|| self.put(Node::Product(a.min(b), a.max(b))));
        if factor == 1.0 { product } else { self.scale(factor, product) }
    }

    /// The product of several: what depends on least first, so that products of parameters are found once for all times.
    pub fn product(&mut self, factors: &[Id]) -> Id {
        let mut sorted = factors.to_vec();
        sorted.sort_by_key(|&id| self.dependence(id));
        let one = self.constant(1.0);
        sorted.into_iter().fold(one, |product, factor| self.multiply(product, factor))
    }

    /// a · b of vectors.
    pub fn dot(&mut self, a: [Id; 3], b: [Id; 3]) -> Id {
        let products: Vec<(f64, Id)> =
            a.into_iter().zip(b).map(|(a, b)| (1.0, self.multiply(a, b))).collect();
        self.sum(0.0, &products)
    }

    /// a / b.
    pub fn divide(&mut self, a: Id, b: Id) -> Id {
        if let Some(value) = self.as_constant(b)
            && value != 0.0
        {
            // A product with the reciprocal, where that is exact.
            let (factor, rest) = self.multiple(a);
            return match self.as_constant(a) {
                Some(a) => self.constant(a / value),
                None => self.scale(factor / value, rest),
            };
        }
        if self.is_zero(a) {
            return a;
        }
        let ((factor_a, a), (factor_b, b)) = (self.multiple(a), self.multiple(b));
        if a == b {
            return self.constant(factor_a / factor_b);
        }
        if let Some(root) = self.over_its_root(a, b) {
            return self.scale(factor_a / factor_b, root);
        }
        if let Some(value) = self.as_constant(a) {
            let one = self.constant(1.0);
            let reciprocal = self.put(Node::Quotient(one, b));
            return self.scale(value * factor_a / factor_b, reciprocal);
        }
        let quotient = self.put(Node::Quotient(a, b));
        self.scale(factor_a / factor_b, quotient)
    }

    /// s/√s and p·s/√s, which are 0 at s = 0 and not 0/0: the force of |x|³ is, and the power of what brakes by |v|³.
    fn over_its_root(&mut self, a: Id, b: Id) -> Option<Id> {
        let Node::Call(Function::Sqrt, of) = *self.node(b) else { return None };
        if a == of {
            return Some(b);
        }
        if self.are_opposite(a, of) {
            return Some(self.scale(-1.0, b));
        }
        let Node::Product(p, q) = *self.node(a) else { return None };
        if let Some(root) = self.over_its_root(p, b) {
            return Some(self.multiply(q, root));
        }
        let root = if p == q { None } else { self.over_its_root(q, b) };
        root.map(|root| self.multiply(p, root))
    }

    /// Whether two sums have the same terms with the other sign.
    fn are_opposite(&self, a: Id, b: Id) -> bool {
        let (Node::Sum(first, terms), Node::Sum(second, others)) = (self.node(a), self.node(b)) else {
            return false;
        };
        let opposite = |one: u64, other: u64| number(one) == -number(other);
        let both = terms.iter().zip(others);
        terms.len() == others.len()
            && opposite(*first, *second)
            && both.into_iter().all(|(one, other)| one.1 == other.1 && opposite(one.0, other.0))
    }

    /// The angle of the point (x, y) from the positive x-axis.
    pub fn angle(&mut self, y: Id, x: Id) -> Id {
        if let (Some(y), Some(x)) = (self.as_constant(y), self.as_constant(x)) {
            return self.constant(functions::atan2(y, x));
        }
        self.put(Node::Angle(y, x))
    }

    /// A function of a node.
    pub fn call(&mut self, function: Function, a: Id) -> Id {
        if let Some(value) = self.as_constant(a).and_then(|x| function.of_constant(x)) {
            return self.constant(value);
        }
        let leading = match self.node(a) {
            Node::Sum(constant, terms) if number(*constant) == 0.0 => number(terms[0].0),
            Node::Sum(constant, _) => number(*constant),
            _ => 1.0,
        };
        if leading < 0.0 && function.parity() != Parity::Neither {
            let negated = self.scale(-1.0, a);
            let value = self.put(Node::Call(function, negated));
            return if function.parity() == Parity::Odd { self.scale(-1.0, value) } else { value };
        }
        self.put(Node::Call(function, a))
    }

    /// A constant power: whole ones by multiplication, halves by roots.
    pub fn power(&mut self, a: Id, exponent: f64) -> Id {
        if exponent == 0.0 {
            return self.constant(1.0);
        }
        if exponent == 1.0 {
            return a;
        }
        if exponent < 0.0 && (2.0 * exponent).fract() == 0.0 {
            let (one, positive) = (self.constant(1.0), self.power(a, -exponent));
            return self.divide(one, positive);
        }
        if exponent == 0.5 {
            return self.call(Function::Sqrt, a);
        }
        if exponent.fract() == 0.0 && exponent <= WHOLE {
            return self.whole_power(a, exponent as u32);
        }
        if exponent.fract() == 0.5 && exponent <= MULTIPLIED {
            let (whole, root) = (self.whole_power(a, exponent as u32), self.call(Function::Sqrt, a));
            return self.multiply(whole, root);
        }
        self.put(Node::Power(a, bits(exponent)))
    }

    fn whole_power(&mut self, a: Id, mut exponent: u32) -> Id {
        let (mut square, mut product) = (a, self.constant(1.0));
        while exponent > 0 {
            if exponent & 1 == 1 {
                product = self.multiply(product, square);
            }
            exponent >>= 1;
            if exponent > 0 {
                square = self.multiply(square, square);
            }
        }
        product
    }

    /// x^y of any exponent, of positive x: e^(y ln x).
    pub fn general_power(&mut self, x: Id, y: Id) -> Id {
        if let Some(exponent) = self.as_constant(y) {
            return self.power(x, exponent);
        }
        let logarithm = self.call(Function::Ln, x);
        let product = self.multiply(y, logarithm);
        self.call(Function::Exp, product)
    }
}
