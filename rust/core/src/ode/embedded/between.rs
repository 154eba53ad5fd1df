//! The continuous extension of an embedded method: what a run that looks between its steps needs, and no other.

use super::{Embedded, EmbeddedStep};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::Element;
use crate::numerics::real::Real;
use crate::ode::nystrom::{Row, nystrom_weights};
use crate::ode::passes::extension::Weigh;
use crate::ode::passes::stages::Term;
use crate::ode::runge_kutta::coupling;
use crate::ode::step_control::Controlled;
use crate::ode::system::Form;
use crate::ode::trial::Trial;

/// Weights of the derivatives in the coordinates and in the velocities; of a system of the first order, the first are none.
pub(super) type Weights<T> = [Vec<T>; 2];

/// The stages of the continuous extension and its weights.
pub(super) struct Between<S> {
    /// The stages that nothing else uses.
    pub(super) rows: Vec<Row<S>>,
    /// For every stage, its weights in the nested basis of [`Embedded::dense`].
    pub(super) weights: Weights<Vec<S>>,
    /// The weights of every stage in the coordinates, term after term of that basis.
    pub(super) of_terms: Vec<Vec<Term<S>>>,
}

impl Embedded {
    /// The rows of all stages; the derivative at the end is a stage of its own, whose row are the weights.
    pub(super) fn rows(&self) -> Vec<&'static [DoubleDouble]> {
        self.tableau.a.iter().chain([&self.tableau.b]).chain(self.dense_a).copied().collect()
    }

    /// How many terms the continuous extension has.
    pub(super) fn terms(&self) -> usize {
        self.dense.iter().map(|row| row.len()).max().unwrap_or(0)
    }
}

impl<S: Element> Between<S> {
    /// Of a method on equations of this form.
    pub(super) fn new(method: &Embedded, form: Form) -> Self {
        let all = method.rows();
        let a = coupling(form, &all);
        let zero = DoubleDouble::zero();
        let power = |index| -> Vec<DoubleDouble> {
            method.dense.iter().map(|row| row.get(index).copied().unwrap_or(zero)).collect()
        };
        let of_v: Vec<Vec<DoubleDouble>> = (0..method.terms()).map(power).collect();
        let of_q: Vec<Vec<DoubleDouble>> = of_v.iter().map(|row| nystrom_weights(row, a)).collect();
        let weights: Weights<Vec<S>> = [of_q, of_v].map(|rows| {
            let of_stage = |stage| rows.iter().map(|row| S::from_double_double(row[stage])).collect();
            (0..all.len()).map(of_stage).collect()
        });
        let of_term = |term: usize| {
            weights[0].iter().enumerate().map(move |(stage, row)| Term { stage, weight: row[term] })
        };
        let of_terms = (0..method.terms()).map(|term| of_term(term).collect()).collect();
        let rows = method.dense_a.iter().zip(method.dense_c).map(|(row, &c)| Row::new(row, c, a)).collect();
        Self { rows, weights, of_terms }
    }

    /// The weights at the fraction `theta` of the step.
    pub(super) fn weigh(&self, theta: S, into: &mut Row<S>) {
        into.fraction = theta;
        for (terms, basis) in [&mut into.position, &mut into.velocity].into_iter().zip(&self.weights) {
            if terms.len() != basis.len() {
                *terms = (0..basis.len()).map(|stage| Term { stage, weight: S::zero() }).collect();
            }
            S::pass(Weigh { terms, basis, theta: &theta });
        }
    }
}

impl<S: Controlled> EmbeddedStep<S> {
    /// As [`polynomial`](Trial::polynomial), of a coordinate and its velocity in a state of the first order.
    pub(super) fn polynomial_of_rates(&self, numbers: [usize; 2], h: S, into: &mut Vec<[S; 2]>) {
        let (len, [_, basis]) = (self.stages.len(), &self.between().weights);
        let rate = |stage: usize, number: usize| self.stages.k[stage * len + number];
        for term in 0..self.terms() {
            // What is left of the way when the velocity has had its part.
            let mut sums = [if term == 0 { -rate(0, numbers[0]) } else { S::zero() }, S::zero()];
            for (stage, weights) in basis.iter().enumerate() {
                for (sum, number) in sums.iter_mut().zip(numbers) {
                    *sum = weights[term].multiply_add(rate(stage, number), *sum);
                }
            }
            into.push([sums[0] / h, sums[1]]);
        }
    }
}
