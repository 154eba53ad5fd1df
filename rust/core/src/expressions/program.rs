//! A program: the operations of some expressions in an order in which they can be done, each value written once.
//!
//! The one idea: what depends on nothing but parameters comes first, and is done once per run. Sums take in the products
//! that nobody else needs, so that they become chains of fused operations; which, is decided here, for every tier alike.

use super::function::Function;
use super::graph::{Dependence, Graph, Id, Node, number};
use super::walk::for_each_argument;
use crate::error::{Error, Result};
use rustc_hash::FxHashMap;

/// The number of a value.
pub(super) type Value = u32;

/// An operation, and where its result goes.
#[derive(Clone, Debug)]
pub(super) enum Operation {
    /// A number.
    Constant(Value, f64),
    /// c₀ + Σ c x + Σ c a b.
    Linear {
        to: Value,
        constant: f64,
        terms: Vec<(f64, Value)>,
        products: Vec<(f64, Value, Value)>,
    },
    Product(Value, Value, Value),
    Quotient(Value, Value, Value),
    /// The angle of a point, its y first.
    Angle(Value, Value, Value),
    /// A number over a value.
    Reciprocal(Value, f64, Value),
    /// Sine and cosine of a value.
    SineCosine {
        sine: Value,
        cosine: Value,
        of: Value,
    },
    Call(Function, Value, Value),
    Power(Value, Value, f64),
    /// Of a symmetric system of linear equations, its lower triangle row by row, and its right side.
    Solve {
        matrix: Vec<Value>,
        right: Vec<Value>,
        to: Vec<Value>,
        inner: usize,
    },
}

impl Operation {
    /// What it reads.
    pub(super) fn read(&self) -> Vec<Value> {
        match self {
            Self::Constant(..) => vec![],
            Self::Linear { terms, products, .. } => {
                let linear = terms.iter().map(|&(_, x)| x);
                linear.chain(products.iter().flat_map(|&(_, a, b)| [a, b])).collect()
            }
            Self::Product(_, a, b) | Self::Quotient(_, a, b) | Self::Angle(_, a, b) => vec![*a, *b],
            Self::Reciprocal(_, _, a)
            | Self::SineCosine { of: a, .. }
            | Self::Call(_, _, a)
            | Self::Power(_, a, _) => vec![*a],
            Self::Solve { matrix, right, .. } => matrix.iter().chain(right).copied().collect(),
        }
    }

    /// What it writes.
    pub(super) fn written(&self) -> Vec<Value> {
        match self {
            Self::Constant(to, _)
            | Self::Linear { to, .. }
            | Self::Product(to, ..)
            | Self::Quotient(to, ..)
            | Self::Angle(to, ..)
            | Self::Reciprocal(to, ..)
            | Self::Call(_, to, _)
            | Self::Power(to, ..) => vec![*to],
            Self::SineCosine { sine, cosine, .. } => vec![*sine, *cosine],
            Self::Solve { to, .. } => to.clone(),
        }
    }
}

/// A system of linear equations `matrix · x = right` with a symmetric matrix of expressions. It is solved without a search
/// for pivots where its first rows are positive definite, bordered by rows of full rank, and else with one.
#[derive(Clone, Debug, Default)]
pub struct LinearSystem {
    /// Its rows.
    pub matrix: Vec<Vec<Id>>,
    /// The right side.
    pub right: Vec<Id>,
    /// So many rows are those of the matrix that is bordered.
    pub inner: usize,
}

/// What rates and the linear equations that they hang on are made of.
pub fn roots(systems: &[LinearSystem], rates: &[Output]) -> Vec<Id> {
    let of_systems = systems.iter().flat_map(|system| system.matrix.iter().flatten().chain(&system.right));
    of_systems.copied().chain(rates.iter().filter_map(Output::node)).collect()
}

impl LinearSystem {
    /// The lower triangle, row by row, and the right side.
    fn nodes(&self) -> impl Iterator<Item = Id> {
        let rows = self.matrix.iter().enumerate();
        rows.flat_map(|(row, entries)| entries[..=row].iter().copied()).chain(self.right.iter().copied())
    }
}

/// What a program gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// An expression.
    Node(Id),
    /// An unknown of the linear systems, counted through them all.
    Unknown(u32),
}

impl Output {
    /// The expression, if it is one.
    pub fn node(&self) -> Option<Id> {
        match self {
            Self::Node(id) => Some(*id),
            Self::Unknown(_) => None,
        }
    }
}

/// Operations, those of parameters alone first.
#[derive(Clone, Debug)]
pub(super) struct Program {
    pub(super) variables: u32,
    pub(super) parameters: u32,
    pub(super) values: u32,
    pub(super) preamble: Vec<Operation>,
    pub(super) body: Vec<Operation>,
    pub(super) outputs: Vec<Value>,
}

/// What is at work while a program is made.
struct Writer<'a> {
    graph: &'a Graph,
    program: Program,
    uses: FxHashMap<Id, u32>,
    values: FxHashMap<Id, Value>,
    /// Sines and cosines that are found together.
    pairs: FxHashMap<Value, (Value, Value)>,
}

/// A program of a graph's expressions, of so many numbers of the state and parameters.
///
/// # Errors
/// A variable or a parameter that is not there.
pub(super) fn write(
    graph: &Graph,
    (variables, parameters): (usize, usize),
    systems: &[LinearSystem],
    outputs: &[Output],
) -> Result<Program> {
    let nodes = outputs.iter().filter_map(Output::node);
    let roots: Vec<Id> = systems.iter().flat_map(LinearSystem::nodes).chain(nodes).collect();
    let mut uses: FxHashMap<Id, u32> = FxHashMap::default();
    for id in graph.reachable(&roots) {
        for_each_argument(graph.node(id), |argument| *uses.entry(argument).or_default() += 1);
    }
    for &root in &roots {
        *uses.entry(root).or_default() += 1;
    }
    let inputs = variables + 1 + parameters;
    let program = Program {
        variables: variables as u32,
        parameters: parameters as u32,
        values: inputs as u32,
        preamble: vec![],
        body: vec![],
        outputs: vec![],
    };
    let mut writer =
        Writer { graph, program, uses, values: FxHashMap::default(), pairs: FxHashMap::default() };
    let mut solved = Vec::new();
    for system in systems {
        let mut values = system.nodes().map(|id| writer.value(id)).collect::<Result<Vec<_>>>()?;
        let right = values.split_off(values.len() - system.right.len());
        let to: Vec<Value> = right.iter().map(|_| writer.new_value()).collect();
        solved.extend(&to);
        writer.program.body.push(Operation::Solve { matrix: values, right, to, inner: system.inner });
    }
    for output in outputs {
        let value = match *output {
            Output::Node(id) => writer.value(id)?,
            Output::Unknown(index) => solved[index as usize],
        };
        writer.program.outputs.push(value);
    }
    Ok(writer.program)
}

impl Writer<'_> {
    fn new_value(&mut self) -> Value {
        self.program.values += 1;
        self.program.values - 1
    }

    /// An input, if the number is one of them.
    fn input(&self, what: &str, index: u32, count: u32, from: u32) -> Result<Value> {
        if index < count {
            return Ok(from + index);
        }
        Err(Error::Internal(format!("an expression has {what} {index} of {count}")))
    }

    /// The value of a node, found where it is not there yet. Nodes nest as deep as expressions do, so the way down is kept
    /// on a heap.
    fn value(&mut self, root: Id) -> Result<Value> {
        let mut waiting = vec![root];
        while let Some(&id) = waiting.last() {
            if self.values.contains_key(&id) {
                let _done = waiting.pop();
                continue;
            }
            let before = waiting.len();
            for argument in self.needed(id) {
                if !self.values.contains_key(&argument) {
                    waiting.push(argument);
                }
            }
            if waiting.len() > before {
                // The first is found first.
                waiting[before..].reverse();
                continue;
            }
            let value = self.written(id)?;
            let _ = self.values.insert(id, value);
        }
        Ok(self.values[&root])
    }

    /// The two factors of a term that its sum takes in.
    fn absorbed(&self, sum: Id, term: Id) -> Option<(Id, Id)> {
        let hoisted = self.graph.dependence(term) <= Dependence::Parameters;
        match *self.graph.node(term) {
            Node::Product(a, b)
                if self.uses[&term] == 1
                    && (!hoisted || self.graph.dependence(sum) <= Dependence::Parameters) =>
            {
                Some((a, b))
            }
            _ => None,
        }
    }

    /// What must be there before a node is written.
    fn needed(&self, id: Id) -> Vec<Id> {
        let mut needed = Vec::new();
        if let Node::Sum(_, terms) = self.graph.node(id) {
            for &(_, term) in terms {
                match self.absorbed(id, term) {
                    Some((a, b)) => needed.extend([a, b]),
                    None => needed.push(term),
                }
            }
        } else {
            for_each_argument(self.graph.node(id), |argument| needed.push(argument));
        }
        if let Node::Quotient(numerator, denominator) = *self.graph.node(id)
            && self.graph.as_constant(numerator).is_some()
        {
            needed = vec![denominator];
        }
        needed
    }

    /// Writes a node's operation; what it needs is there.
    fn written(&mut self, id: Id) -> Result<Value> {
        let Program { variables, parameters, .. } = self.program;
        let of = |id: &Id| self.values[id];
        let to = self.program.values;
        let operation = match self.graph.node(id) {
            Node::Variable(index) => return self.input("number", *index, variables, 0),
            Node::Time => return Ok(variables),
            Node::Parameter(index) => return self.input("parameter", *index, parameters, variables + 1),
            Node::Constant(value) => Operation::Constant(to, number(*value)),
            Node::Sum(constant, all) => {
                let (mut terms, mut products) = (vec![], vec![]);
                for &(c, term) in all {
                    match self.absorbed(id, term) {
                        Some((a, b)) => products.push((number(c), of(&a), of(&b))),
                        None => terms.push((number(c), of(&term))),
                    }
                }
                Operation::Linear { to, constant: number(*constant), terms, products }
            }
            Node::Product(a, b) => Operation::Product(to, of(a), of(b)),
            Node::Quotient(a, b) => match self.graph.as_constant(*a) {
                Some(value) => Operation::Reciprocal(to, value, of(b)),
                None => Operation::Quotient(to, of(a), of(b)),
            },
            Node::Angle(y, x) => Operation::Angle(to, of(y), of(x)),
            Node::Call(function @ (Function::Sin | Function::Cos), a) => {
                let of = of(a);
                let (sine, cosine) = match self.pairs.get(&of) {
                    Some(&pair) => pair,
                    None => {
                        let pair = (self.new_value(), self.new_value());
                        let _ = self.pairs.insert(of, pair);
                        self.push(id, Operation::SineCosine { sine: pair.0, cosine: pair.1, of });
                        pair
                    }
                };
                return Ok(if *function == Function::Sin { sine } else { cosine });
            }
            Node::Call(function, a) => Operation::Call(*function, to, of(a)),
            Node::Power(a, exponent) => Operation::Power(to, of(a), number(*exponent)),
        };
        self.program.values += 1;
        self.push(id, operation);
        Ok(to)
    }

    fn push(&mut self, id: Id, operation: Operation) {
        if self.graph.dependence(id) <= Dependence::Parameters {
            self.program.preamble.push(operation);
        } else {
            self.program.body.push(operation);
        }
    }
}
