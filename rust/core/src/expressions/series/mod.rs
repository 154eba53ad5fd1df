//! Expressions as Taylor series: what a [`Program`] computes from numbers, from coefficients, order by order.
//!
//! The one idea: the coefficient of order n of every operation is a sum of products of coefficients of lower orders and of its
//! arguments' coefficient of order n, so one walk over the operations for each order expands them all. A function is the
//! integral of its derivative, which is made of the same operations; a linear system is factored once for all orders.
//! R. E. Moore, *Interval Analysis* (1966), chapter 11; A. Griewank & A. Walther, *Evaluating Derivatives* (2008), chapter 13.

mod convolution;
mod expansion;
mod lowered;
mod motion;
mod numbers;
mod recurrence;
mod smooth;

use super::execute::Scalar;
use super::graph::{Dependence, Graph, Id, Node};
use super::program::{self, LinearSystem, Output};
use crate::error::Result;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::real::Real;
use crate::tiered;
use motion::Room;
pub use motion::{Beside, Coefficients, Equations, Seen};
use recurrence::Recurrences;
use std::sync::Arc;

/// Coefficients that there is room for.
pub(crate) const ORDERS: usize = 24;

/// A program as recurrences. Series begin at multiples of [`ORDERS`]; constants, which have no other coefficient, lie before
/// them.
#[derive(Clone, Debug)]
pub struct Series {
    variables: usize,
    parameters: usize,
    /// What is done once for each set of parameters.
    preamble: Recurrences,
    body: Recurrences,
    /// Where the state and the time are, and the results.
    inputs: Vec<usize>,
    outputs: Vec<usize>,
    /// What stands below roots and broken powers.
    radicands: Vec<usize>,
    /// Numbers in all, and room for factored matrices.
    numbers: usize,
    scratch: usize,
    /// 1/n of all orders n.
    inverses: [(f64, f64); ORDERS],
}

/// An order n, and 1/n with what that leaves out.
pub type Order = (usize, (f64, f64));

impl Series {
    /// A function among these expressions that leaps where it is as smooth from either side as if it went on: of a series,
    /// which tells of the one side, a step would go over that without a word.
    pub fn leaps(graph: &Graph, roots: &[Id]) -> Option<&'static str> {
        let varies = |id: Id| graph.dependence(id) > Dependence::Parameters;
        graph.reachable(roots).into_iter().filter(|&id| varies(id)).find_map(|id| match graph.node(id) {
            Node::Angle(..) => Some("atan2"),
            _ => None,
        })
    }

    /// Of these outputs, as functions of so many numbers of a state, the time, and so many parameters.
    ///
    /// # Errors
    /// A variable that is not there.
    pub fn new(
        graph: &Graph,
        inputs: (usize, usize),
        systems: &[LinearSystem],
        outputs: &[Output],
    ) -> Result<Self> {
        Ok(lowered::lowered(&program::write(graph, inputs, systems, outputs)?))
    }
}

/// What series hold: a number, or eight.
pub trait Coefficient: Real {
    /// The coefficients of order `order` of everything that a list of recurrences makes.
    fn expand(of: &Recurrences, order: Order, numbers: &mut [Self], scratch: &mut [Self]);

    /// All coefficients of a motion.
    fn motion(room: Room<'_, Self>, equations: &Equations<'_, Self>, into: Coefficients<'_, Self>);
}

impl Coefficient for f64 {
    fn expand(of: &Recurrences, order: Order, numbers: &mut [Self], scratch: &mut [Self]) {
        one(of, order, numbers, scratch);
    }

    fn motion(room: Room<'_, Self>, equations: &Equations<'_, Self>, into: Coefficients<'_, Self>) {
        motion::one(room, equations, into);
    }
}

impl Coefficient for Lanes {
    fn expand(of: &Recurrences, order: Order, numbers: &mut [Self], scratch: &mut [Self]) {
        lanes(of, order, numbers, scratch);
    }

    fn motion(room: Room<'_, Self>, equations: &Equations<'_, Self>, into: Coefficients<'_, Self>) {
        motion::lanes(room, equations, into);
    }
}

#[inline(always)]
fn lanes_body<V: Vector8 + Scalar>(
    of: &Recurrences,
    order: Order,
    numbers: &mut [Lanes],
    scratch: &mut [Lanes],
) {
    expansion::expand(of, order, V::view_mut(numbers), V::view_mut(scratch));
}

#[inline(always)]
#[expect(clippy::extra_unused_type_parameters, reason = "the tier gives its instructions, not its lanes")]
fn one_body<V: Vector8>(of: &Recurrences, order: Order, numbers: &mut [f64], scratch: &mut [f64]) {
    expansion::expand(of, order, numbers, scratch);
}

tiered! {
    fn lanes[][](of: &Recurrences, order: Order, numbers: &mut [Lanes], scratch: &mut [Lanes]) = lanes_body;
    fn one[][](of: &Recurrences, order: Order, numbers: &mut [f64], scratch: &mut [f64]) = one_body;
}

/// Series with their coefficients, whose preamble is done.
#[derive(Clone, Debug)]
pub struct Expansion<S> {
    of: Arc<Series>,
    numbers: Vec<S>,
    scratch: Vec<S>,
}

impl<S: Coefficient> Expansion<S> {
    /// For these parameters.
    pub fn new(of: Arc<Series>, parameters: &[S]) -> Self {
        let (numbers, scratch) = (vec![S::zero(); of.numbers], vec![S::zero(); of.scratch]);
        let mut expansion = Self { of, numbers, scratch };
        expansion.set_parameters(parameters);
        expansion
    }

    /// For other parameters from now on.
    pub fn set_parameters(&mut self, parameters: &[S]) {
        let Self { of, numbers, scratch } = self;
        numbers[..of.parameters].copy_from_slice(parameters);
        S::expand(&of.preamble, (0, of.inverses[0]), numbers, scratch);
    }

    /// Sets the coefficient of an order of a number of the state, or of the time, which comes after them.
    #[inline(always)]
    pub fn set(&mut self, index: usize, order: usize, value: S) {
        self.numbers[self.of.inputs[index] + order] = value;
    }

    /// Finds all coefficients of an order; those of lower orders were found before.
    #[inline]
    pub fn expand(&mut self, order: usize) {
        let of = (order, self.of.inverses[order]);
        S::expand(&self.of.body, of, &mut self.numbers, &mut self.scratch);
    }

    /// The coefficient of an order of a result.
    #[inline(always)]
    pub fn output(&self, index: usize, order: usize) -> S {
        let place = self.of.outputs[index];
        // Constants have no further coefficient.
        if order > 0 && place < self.of.inputs[0] { S::zero() } else { self.numbers[place + order] }
    }

    /// The index of the time among the inputs.
    #[inline(always)]
    pub fn time(&self) -> usize {
        self.of.variables
    }
}

#[cfg(test)]
mod tests;
