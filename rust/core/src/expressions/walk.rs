//! Walks over the graph: what an expression is made of, and the same with other nodes in the place of some.
//!
//! The one idea: what a node is made of has smaller numbers, so in ascending order all arguments come first.

use super::graph::{Graph, Id, Node, number};
use rustc_hash::FxHashMap;

impl Graph {
    /// The nodes that these are made of, and they themselves, ascending.
    pub fn reachable(&self, roots: &[Id]) -> Vec<Id> {
        let mut seen = vec![false; self.nodes().len()];
        let mut waiting = roots.to_vec();
        while let Some(id) = waiting.pop() {
            if !core::mem::replace(&mut seen[id as usize], true) {
                for_each_argument(self.node(id), |argument| waiting.push(argument));
            }
        }
        (0..self.nodes().len() as Id).filter(|&id| seen[id as usize]).collect()
    }

    /// Whether something that these are made of is such a node.
    pub fn any(&self, roots: &[Id], is: impl Fn(&Node) -> bool) -> bool {
        self.reachable(roots).iter().any(|&id| is(self.node(id)))
    }

    /// The same expressions with other nodes in the place of some.
    pub fn substitute(&mut self, roots: &[Id], replaced: &FxHashMap<Id, Id>) -> Vec<Id> {
        let mut new: FxHashMap<Id, Id> = replaced.clone();
        for id in self.reachable(roots) {
            if new.contains_key(&id) {
                continue;
            }
            let of = |argument: &Id| new.get(argument).copied().unwrap_or(*argument);
            let made = match self.node(id).clone() {
                Node::Sum(constant, terms) => {
                    let terms: Vec<_> = terms.iter().map(|(c, x)| (number(*c), of(x))).collect();
                    self.sum(number(constant), &terms)
                }
                Node::Product(a, b) => self.multiply(of(&a), of(&b)),
                Node::Quotient(a, b) => self.divide(of(&a), of(&b)),
                Node::Angle(y, x) => self.angle(of(&y), of(&x)),
                Node::Call(function, a) => self.call(function, of(&a)),
                Node::Power(a, exponent) => self.power(of(&a), number(exponent)),
                Node::Constant(_) | Node::Variable(_) | Node::Parameter(_) | Node::Time => id,
            };
            let _ = new.insert(id, made);
        }
        roots.iter().map(|root| new[root]).collect()
    }
}

/// What a node is made of, one after another; a square's factor comes twice.
pub(super) fn for_each_argument(node: &Node, mut each: impl FnMut(Id)) {
    match node {
        Node::Constant(_) | Node::Variable(_) | Node::Parameter(_) | Node::Time => {}
        Node::Sum(_, terms) => terms.iter().for_each(|&(_, id)| each(id)),
        Node::Product(a, b) | Node::Quotient(a, b) | Node::Angle(a, b) => {
            each(*a);
            each(*b);
        }
        Node::Call(_, a) | Node::Power(a, _) => each(*a),
    }
}
