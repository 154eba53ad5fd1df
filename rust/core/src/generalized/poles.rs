//! Poles that a step has passed: walls as (a/x)¹², which turn back whatever comes, and which no stage of a long step feels.
//!
//! The one idea: what is divided by changes its sign only at a pole. So a step from one sign to the other has gone through
//! what cannot be gone through, unless the whole stays finite there, as sin x/x does.

use super::model::{Model, Source};
use crate::error::{Error, Result};
use crate::expressions::function::Function;
use crate::expressions::graph::{Dependence, number};
use crate::expressions::{Code, Graph, Id, Machine, Node};
use std::sync::Arc;

/// Times that a step is halved to find where a divisor vanishes in it.
const HALVINGS: usize = 60;
/// Parts of the step at which its sides are looked at, the nearest last: beside a pole all grows from one to the next.
const BESIDE: [f64; 2] = [1.0 / 1_048_576.0, 1.0 / 1_073_741_824.0];
/// By so much at least: by 2^(10 p) beside a pole of order p.
const GROWTH: f64 = 4.0;

/// What ends a run there.
const PASSED: &str = "a step went through a pole, where an expression divides by zero and nothing can pass; take a shorter dt or \
    max_step, or end the run before (an event)";

/// Code of the divisors of a system that may change their signs on the way, and of what has poles there.
#[derive(Clone, Debug)]
pub struct Divisors {
    divisors: Arc<Code>,
    divided: Arc<Code>,
}

impl Divisors {
    /// Of a model, if it has any.
    ///
    /// # Errors
    /// Expressions that are too large.
    pub(super) fn of(model: &Model) -> Result<Option<Self>> {
        let source = &model.source;
        let divided: Vec<Id> =
            core::iter::once(source.function).chain(source.forces.iter().copied()).collect();
        let found = found(source, &divided);
        if found.is_empty() {
            return Ok(None);
        }
        let divisors = Arc::new(model.function(&found)?);
        Ok(Some(Self { divisors, divided: Arc::new(model.function(&divided)?) }))
    }
}

/// The factors of all divisors that change with the state and may be negative.
fn found(source: &Source, divided: &[Id]) -> Vec<Id> {
    let graph = &source.graph;
    let mut pending: Vec<Id> = graph
        .reachable(divided)
        .into_iter()
        .filter_map(|id| match *graph.node(id) {
            Node::Quotient(_, divisor) => Some(divisor),
            Node::Power(base, power) if number(power) < 0.0 => Some(base),
            _ => None,
        })
        .collect();
    let mut factors = Vec::new();
    while let Some(id) = pending.pop() {
        match graph.node(id) {
            Node::Product(a, b) => pending.extend([*a, *b]),
            Node::Power(base, _) | Node::Call(Function::Sqrt, base) => pending.push(*base),
            Node::Sum(constant, terms) if number(*constant) == 0.0 && terms.len() == 1 => {
                pending.extend(terms.iter().map(|(_, term)| *term));
            }
            _ if graph.dependence(id) <= Dependence::Time || is_positive(graph, id) => {}
            _ => factors.push(id),
        }
    }
    factors.sort_unstable();
    factors.dedup();
    factors
}

/// Whether an expression is never below zero, as sums of squares are.
fn is_positive(graph: &Graph, id: Id) -> bool {
    match graph.node(id) {
        Node::Constant(bits) => number(*bits) >= 0.0,
        Node::Product(a, b) => a == b || (is_positive(graph, *a) && is_positive(graph, *b)),
        Node::Sum(constant, terms) => {
            let positive = |(factor, term): &(u64, Id)| number(*factor) >= 0.0 && is_positive(graph, *term);
            number(*constant) >= 0.0 && terms.iter().all(positive)
        }
        Node::Call(Function::Sqrt | Function::Exp | Function::Cosh, _) => true,
        _ => false,
    }
}

/// The divisors of a trajectory under watch.
#[derive(Clone, Debug)]
struct Watched {
    divisors: Machine<f64>,
    divided: Machine<f64>,
    /// At the last node: the time, the state, and the divisors.
    t: f64,
    y: Vec<f64>,
    values: Vec<f64>,
}

/// Poles on the way of a trajectory.
#[derive(Clone, Debug, Default)]
pub(super) struct Poles(Option<Box<Watched>>);

impl Poles {
    /// Of a trajectory with these parameters that starts there.
    pub(super) fn new(model: &Model, parameters: &[f64], t0: f64, y0: &[f64]) -> Self {
        Self(model.divisors.as_ref().map(|of| {
            let machine = |code: &Arc<Code>| Machine::new(code.clone(), parameters);
            let (mut divisors, divided) = (machine(&of.divisors), machine(&of.divided));
            let values = outputs(&mut divisors, t0, y0);
            Box::new(Watched { divisors, divided, t: t0, y: y0.to_vec(), values })
        }))
    }

    /// Whether there is nothing to look at.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_none()
    }

    /// Looks at the end of a step.
    ///
    /// # Errors
    /// [`Error::Convergence`] where a pole was passed.
    pub(super) fn look(&mut self, t: f64, y: &[f64]) -> Result<()> {
        let Some(watched) = &mut self.0 else { return Ok(()) };
        let values = outputs(&mut watched.divisors, t, y);
        let changed = watched.values.iter().zip(&values).position(|(before, value)| before * value < 0.0);
        if let Some(which) = changed
            && watched.passes(which, t, y)
        {
            return Err(Error::Convergence { message: PASSED.to_owned(), time: watched.t });
        }
        watched.t = t;
        watched.y.copy_from_slice(y);
        watched.values = values;
        Ok(())
    }
}

impl Watched {
    /// Whether what is divided has a pole where a divisor vanishes on the way from the last node to this one.
    fn passes(&mut self, which: usize, t: f64, y: &[f64]) -> bool {
        let (mut from, mut to) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (from + to);
            let (at, there) = self.between(middle, t, y);
            let value = outputs(&mut self.divisors, at, &there)[which];
            if value * self.values[which] > 0.0 {
                from = middle;
            } else {
                to = middle;
            }
        }
        let [far, near] = BESIDE.map(|part| {
            let sides = [from - part, to + part].map(|theta| {
                let (at, there) = self.between(theta, t, y);
                // What is no number beside a pole is too large for one.
                let size = |x: f64| if x.is_nan() { f64::INFINITY } else { x.abs() };
                outputs(&mut self.divided, at, &there).into_iter().map(size).fold(0.0, f64::max)
            });
            sides[0].max(sides[1])
        });
        near.is_infinite() || near > GROWTH * far
    }

    /// The time and the state at a part of the way from the last node to this one.
    fn between(&self, theta: f64, t: f64, y: &[f64]) -> (f64, Vec<f64>) {
        let there = self.y.iter().zip(y).map(|(from, to)| from + theta * (to - from));
        (self.t + theta * (t - self.t), there.collect())
    }
}

fn outputs(machine: &mut Machine<f64>, t: f64, y: &[f64]) -> Vec<f64> {
    machine.state().copy_from_slice(y);
    machine.run(t);
    (0..machine.code().outputs()).map(|i| machine.output(i)).collect()
}
