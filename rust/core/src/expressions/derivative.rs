//! Derivatives of expressions, on the graph.
//!
//! The one idea: what a node's value changes by is a sum over what it is made of. Swept from the end (reverse) it gives all
//! derivatives of one expression; from the beginning (forward) those of all expressions along one direction.

use super::function::Function;
use super::graph::{Graph, Id, Node, number};
use rustc_hash::FxHashMap;

impl Graph {
    /// What a node is made of, each with the derivative with respect to it; nodes that are kept are not taken apart.
    fn partials(&mut self, id: Id, kept: &dyn Fn(Id) -> bool) -> Vec<(Id, Id)> {
        match self.node(id).clone() {
            Node::Constant(_) | Node::Variable(_) | Node::Parameter(_) | Node::Time => vec![],
            Node::Sum(_, terms) => terms.iter().map(|&(c, x)| (x, self.constant(number(c)))).collect(),
            Node::Product(a, b) if a == b => vec![(a, self.scale(2.0, a))],
            Node::Product(a, b) => vec![(a, b), (b, a)],
            Node::Quotient(a, b) => {
                let one = self.constant(1.0);
                let mut partials = vec![(a, self.divide(one, b))];
                // Factor by factor of what it is divided by: of k/r⁶ it is −6 (k/r⁶)/r, where (k/r⁶)/r⁶ would leave the range.
                let mut factors = Vec::new();
                self.factors(b, 1.0, kept, &mut factors);
                for (factor, times) in factors {
                    self.of_denominator(id, factor, -times, kept, &mut partials);
                }
                partials
            }
            Node::Angle(y, x) => {
                let (y2, x2) = (self.multiply(y, y), self.multiply(x, x));
                let square = self.sum(0.0, &[(1.0, x2), (1.0, y2)]);
                let (along_y, along_x) = (self.divide(x, square), self.divide(y, square));
                vec![(y, along_y), (x, self.scale(-1.0, along_x))]
            }
            Node::Call(function, a) => vec![(a, self.slope(function, a, id))],
            Node::Power(a, exponent) => {
                let exponent = number(exponent);
                let lower = self.power(a, exponent - 1.0);
                vec![(a, self.scale(exponent, lower))]
            }
        }
    }

    /// What a product is made of, and how many times.
    fn factors(&self, id: Id, times: f64, kept: &dyn Fn(Id) -> bool, into: &mut Vec<(Id, f64)>) {
        match self.node(id) {
            Node::Product(a, b) if !kept(id) && a == b => self.factors(*a, 2.0 * times, kept, into),
            Node::Product(a, b) if !kept(id) => {
                self.factors(*a, times, kept, into);
                self.factors(*b, times, kept, into);
            }
            _ => match into.iter_mut().find(|(factor, _)| *factor == id) {
                Some((_, before)) => *before += times,
                None => into.push((id, times)),
            },
        }
    }

    /// What a quotient changes by with a factor of its denominator, f: by `times` itself times f′/f, which is a number
    /// where f′ and f have left the range, as e^u has first.
    fn of_denominator(
        &mut self,
        quotient: Id,
        factor: Id,
        times: f64,
        kept: &dyn Fn(Id) -> bool,
        partials: &mut Vec<(Id, Id)>,
    ) {
        match self.node(factor).clone() {
            Node::Call(Function::Exp, u) if !kept(factor) => partials.push((u, self.scale(times, quotient))),
            Node::Call(function @ (Function::Cosh | Function::Sinh), u) if !kept(factor) => {
                let tangent = self.call(Function::Tanh, u);
                let change = if function == Function::Cosh {
                    self.multiply(quotient, tangent)
                } else {
                    self.divide(quotient, tangent)
                };
                partials.push((u, self.scale(times, change)));
            }
            Node::Sum(constant, terms)
                if !kept(factor) && terms.iter().any(|(_, term)| self.is_exp(*term)) =>
            {
                for (coefficient, term) in &terms {
                    let own = times * number(*coefficient);
                    let (of, ratio) = match self.node(*term) {
                        Node::Call(Function::Exp, u) if !kept(*term) => {
                            let u = *u;
                            (u, self.share(u, number(constant), &terms))
                        }
                        _ => (*term, self.divide(quotient, factor)),
                    };
                    let change = if of == *term { ratio } else { self.multiply(quotient, ratio) };
                    partials.push((of, self.scale(own, change)));
                }
            }
            _ => {
                let ratio = self.divide(quotient, factor);
                partials.push((factor, self.scale(times, ratio)));
            }
        }
    }

    fn is_exp(&self, id: Id) -> bool {
        matches!(self.node(id), Node::Call(Function::Exp, _))
    }

    /// e^u over a sum, as 1 over the sum of its terms times e^(−u): neither end of the range leads out of it.
    fn share(&mut self, u: Id, constant: f64, terms: &[(u64, Id)]) -> Id {
        let negative = self.scale(-1.0, u);
        let decay = self.call(Function::Exp, negative);
        let mut all = vec![(constant, decay)];
        for (coefficient, term) in terms {
            let part = match *self.node(*term) {
                Node::Call(Function::Exp, other) => {
                    let difference = self.subtract(other, u);
                    self.call(Function::Exp, difference)
                }
                _ => self.multiply(*term, decay),
            };
            all.push((number(*coefficient), part));
        }
        let (one, below) = (self.constant(1.0), self.sum(0.0, &all));
        self.divide(one, below)
    }

    /// The derivative of a function at `a`, where its value is `value`.
    fn slope(&mut self, function: Function, a: Id, value: Id) -> Id {
        let one = self.constant(1.0);
        match function {
            Function::Sin => self.call(Function::Cos, a),
            Function::Cos => {
                let sine = self.call(Function::Sin, a);
                self.scale(-1.0, sine)
            }
            Function::Exp => value,
            Function::Ln => self.divide(one, a),
            Function::Sqrt => {
                let reciprocal = self.divide(one, value);
                self.scale(0.5, reciprocal)
            }
            Function::Tan => {
                let square = self.multiply(value, value);
                self.sum(1.0, &[(1.0, square)])
            }
            Function::Tanh => self.call(Function::SechSquared, a),
            Function::SechSquared => {
                let tangent = self.call(Function::Tanh, a);
                let product = self.multiply(tangent, value);
                self.scale(-2.0, product)
            }
            Function::Sinh => self.call(Function::Cosh, a),
            Function::Cosh => self.call(Function::Sinh, a),
            Function::Atan => self.reciprocal_of(1.0, 1.0, a, false),
            Function::Atanh => self.reciprocal_of(1.0, -1.0, a, false),
            Function::Asin => self.reciprocal_of(1.0, -1.0, a, true),
            Function::Acos => {
                let negative = self.reciprocal_of(1.0, -1.0, a, true);
                self.scale(-1.0, negative)
            }
            Function::Asinh => self.reciprocal_of(1.0, 1.0, a, true),
            Function::Acosh => self.reciprocal_of(-1.0, 1.0, a, true),
        }
    }

    /// 1/(constant + factor·a²), or that of the root.
    fn reciprocal_of(&mut self, constant: f64, factor: f64, a: Id, root: bool) -> Id {
        let square = self.multiply(a, a);
        let mut below = self.sum(constant, &[(factor, square)]);
        if root {
            below = self.call(Function::Sqrt, below);
        }
        let one = self.constant(1.0);
        self.divide(one, below)
    }

    /// The derivatives of an expression with respect to some of the nodes it is made of.
    pub fn gradient(&mut self, root: Id, variables: &[Id]) -> Vec<Id> {
        let order = self.reachable(&[root]);
        let mut active: FxHashMap<Id, Vec<(f64, Id)>> = variables.iter().map(|&id| (id, vec![])).collect();
        for &id in &order {
            let mut depends = false;
            super::walk::for_each_argument(self.node(id), |argument| {
                depends |= active.contains_key(&argument)
            });
            if depends {
                let _ = active.entry(id).or_default();
            }
        }
        let one = self.constant(1.0);
        if let Some(terms) = active.get_mut(&root) {
            terms.push((1.0, one));
        }
        for &id in order.iter().rev() {
            let Some(terms) = active.get(&id).filter(|terms| !terms.is_empty()).cloned() else { continue };
            let outer = self.sum(0.0, &terms);
            let _ = active.insert(id, vec![(1.0, outer)]);
            for (argument, slope) in self.partials(id, &|node| variables.contains(&node)) {
                if !active.contains_key(&argument) {
                    continue;
                }
                let term = match self.as_constant(slope) {
                    Some(value) => (value, outer),
                    None => (1.0, self.multiply(outer, slope)),
                };
                active.entry(argument).or_default().push(term);
            }
        }
        let found: Vec<_> = variables.iter().map(|id| active[id].clone()).collect();
        found.iter().map(|terms| self.sum(0.0, terms)).collect()
    }

    /// The derivatives of expressions along a direction: what some nodes change by.
    pub fn tangent(&mut self, roots: &[Id], direction: &FxHashMap<Id, Id>) -> Vec<Id> {
        let mut change: FxHashMap<Id, Id> = FxHashMap::default();
        for id in self.reachable(roots) {
            if let Some(&seed) = direction.get(&id) {
                let _ = change.insert(id, seed);
                continue;
            }
            let mut depends = false;
            super::walk::for_each_argument(self.node(id), |argument| {
                depends |= change.contains_key(&argument)
            });
            if !depends {
                continue;
            }
            let mut terms = Vec::new();
            for (argument, slope) in self.partials(id, &|node| direction.contains_key(&node)) {
                let Some(&inner) = change.get(&argument) else { continue };
                match self.as_constant(slope) {
                    Some(value) => terms.push((value, inner)),
                    None => terms.push((1.0, self.multiply(slope, inner))),
                }
            }
            let sum = self.sum(0.0, &terms);
            if !self.is_zero(sum) {
                let _ = change.insert(id, sum);
            }
        }
        let zero = self.constant(0.0);
        roots.iter().map(|root| change.get(root).copied().unwrap_or(zero)).collect()
    }
}
