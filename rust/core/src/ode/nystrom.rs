//! What an explicit Runge–Kutta method becomes on `q'' = a(q, v)`: Nyström's form.
//!
//! The one idea: half of `y' = (v, a)` is known beforehand. The velocities of the stages put into the
//! coordinates, every coordinate is `q + h·c·v + h² Σ ā·a` with `ā = A·A`, exactly, so only accelerations
//! are kept and summed, and velocities of stages are formed for forces that ask for them and no others
//! (Hairer, Nørsett & Wanner, *Solving ODE I*, II.14, eq. 14.3).

use super::passes::errors::PairTerm;
use super::passes::stages::Term;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::Element;
use crate::numerics::real::Real;

/// Rows of coefficients, one for each stage that they weigh.
type Rows<'a> = [&'a [DoubleDouble]];

/// Products of coefficients that cancel leave about 1e-29; the least that is meant is above 1e-6.
const NOTHING: f64 = 1e-20;

/// A point of a step: `q + h·(fraction·v + h Σ position·a)`, `v + h Σ velocity·a`.
#[derive(Clone, Debug)]
pub struct Row<S> {
    /// Its time as a fraction of the step.
    pub fraction: S,
    /// What accelerations weigh in the coordinates.
    pub position: Vec<Term<S>>,
    /// What they weigh in the velocities.
    pub velocity: Vec<Term<S>>,
}

impl<S: Element> Row<S> {
    /// The point of a stage: `row` weighs the derivatives of the stages whose own rows are `a`.
    pub fn new(row: &[DoubleDouble], fraction: DoubleDouble, a: &Rows<'_>) -> Self {
        Self {
            fraction: S::from_double_double(fraction),
            position: terms(&nystrom_weights(row, a)),
            velocity: terms(row),
        }
    }

    /// The end of a step: the sums of the weights, 1 and 1/2, as exact as the scalar allows.
    ///
    /// Every weight rounded by itself would leave a sum of, for RK4, `1 - 2^-54`: each step would fall short
    /// by that share, and a long run would lag behind in proportion to time. The smallest weight, being the
    /// finest, takes up what the rounding of all of them leaves out.
    pub fn end(weights: &[DoubleDouble], a: &Rows<'_>) -> Self {
        let exact = |weights: &[DoubleDouble]| {
            let mut terms = terms(weights);
            let rest = weights.iter().fold(S::zero(), |rest, &weight| rest + S::unevaluated(weight).1);
            let size = |term: &Term<S>| weights[term.stage].to_f64().abs();
            if let Some(smallest) = terms.iter_mut().min_by(|a, b| size(a).total_cmp(&size(b))) {
                smallest.weight += rest;
            }
            terms
        };
        Self { fraction: S::one(), position: exact(&nystrom_weights(weights, a)), velocity: exact(weights) }
    }
}

/// The Nyström weights `ā = row·A`: those of the accelerations in `Σ row·k` when the `k` are velocities of stages with the
/// rows `a`, less what the velocity at the start is worth.
pub fn nystrom_weights(row: &[DoubleDouble], a: &Rows<'_>) -> Vec<DoubleDouble> {
    let mut product = vec![DoubleDouble::zero(); row.len()];
    for (weight, stage) in row.iter().zip(a) {
        for (sum, &coefficient) in product.iter_mut().zip(*stage) {
            *sum += *weight * coefficient;
        }
    }
    let meant = |x: &DoubleDouble| x.to_f64().abs() > NOTHING;
    product.into_iter().map(|x| if meant(&x) { x } else { DoubleDouble::zero() }).collect()
}

/// The terms of a row of coefficients that are not zero.
pub fn terms<S: Element>(row: &[DoubleDouble]) -> Vec<Term<S>> {
    let present = row.iter().enumerate().filter(|(_, weight)| weight.to_f64() != 0.0);
    present.map(|(stage, &weight)| Term { stage, weight: S::from_double_double(weight) }).collect()
}

/// The terms of two rows of coefficients that are not zero in both.
pub fn pair_terms<S: Element>(rows: [&[DoubleDouble]; 2]) -> Vec<PairTerm<S>> {
    let weights = |stage| rows.map(|row| row.get(stage).copied().unwrap_or(DoubleDouble::zero()));
    let present = (0..rows[0].len().max(rows[1].len())).map(|stage| (stage, weights(stage)));
    present
        .filter(|(_, weights)| weights.iter().any(|weight| weight.to_f64() != 0.0))
        .map(|(stage, weights)| PairTerm { stage, weights: weights.map(S::from_double_double) })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ode::{Embedded, Scheme};
    use crate::registry::METHODS;

    #[test]
    fn weights_of_a_step_sum_to_one_and_to_a_half() {
        for method in METHODS {
            let (Scheme::RungeKutta(tableau) | Scheme::Embedded(Embedded { tableau, .. })) = &method.scheme
            else {
                continue;
            };
            let end = Row::<f64>::end(tableau.b, tableau.a);
            let sum = |terms: &[Term<f64>]| {
                terms.iter().fold(DoubleDouble::zero(), |sum, term| sum + DoubleDouble::from(term.weight))
            };
            // What the rounding of all weights leaves out is in the smallest: to half its last place, which is less than
            // the half of that of 1, 2^-54, that a single rounded weight may leave.
            for (terms, exact) in [(&end.velocity, 1.0), (&end.position, 0.5)] {
                let smallest = terms.iter().map(|term| term.weight.abs()).fold(f64::INFINITY, f64::min);
                let slack = smallest * f64::EPSILON / 2.0;
                let missed = (sum(terms) - DoubleDouble::from(exact)).to_f64().abs();
                assert!(missed <= slack, "{}: {missed:e} for {slack:e}", method.name);
            }
        }
    }
}
