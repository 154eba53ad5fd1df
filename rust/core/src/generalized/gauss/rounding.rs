//! How far rounding leads the polynomials of steps astray.
//!
//! The one idea: a polynomial through the stages of one step goes on far beyond them in the next, and there the rounding of each
//! rate counts as many times as the polynomial through 1 at it and 0 at the others has grown. Rates that are found together, as
//! by a solution of linear equations, are rounded by the largest of them; what one that hardly moves beside it is led astray by
//! no more than that, tells nothing of the motion.

use super::Table;
use crate::numerics::elementary::{self, Exponential};
use crate::numerics::lanes::WIDTH;
use crate::ode::system::Form;

/// By what rates are rounded, as a part of the largest.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Powers of a matrix after which its largest eigenvalue is all that is left, and over which its growth is the mean of: of pairs of
/// complex ones it goes up and down.
const SETTLED: u32 = 64;

/// What has less than this part of the largest rate hardly moves beside it.
pub(super) const HARDLY: f64 = 1e-3;

/// Of a method.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounding {
    /// In a first step, of which the last term of the polynomial is looked at.
    first: f64,
    /// In a step as long as the one before it.
    equal: f64,
    /// The error of a turn by 1, whose power 2s + 1 it goes with.
    error: f64,
    /// What an iteration leaves of a change of the stages of such a turn, of the first order.
    left: f64,
}

impl Rounding {
    /// Of a method.
    pub(super) fn of(table: &Table) -> Self {
        let first = table.leading(|k| 1.0_f64.copysign(table.weights.0[k]));
        Self { first, equal: amplified(table, 1.0), error: table.error_of_a_turn(), left: left(table) }
    }

    /// So much is left of a change of stages by an iteration at most, where the fastest turn that forces can make errs by no more
    /// than the tolerance in a step: beside noise nothing else tells how far a step resolves it.
    pub(super) fn resolving(&self, table: &Table, form: Form, tolerance: f64) -> f64 {
        let order = (2 * table.stages + 1) as f64;
        let turn = Exponential::exp(elementary::ln(tolerance / self.error) / order);
        let left = self.left * turn;
        if matches!(form, Form::SecondOrder(_)) { left * left } else { left }
    }

    /// So many times what rates are off a stage is led astray by that, at most, in a step of length `h` after so many kept ones,
    /// the last of length `last`.
    #[inline]
    pub(super) fn amplified(&self, table: &Table, kept: u64, (last, h): (f64, f64)) -> f64 {
        if kept == 0 {
            self.first
        } else if h == last {
            self.equal
        } else {
            amplified(table, h / last)
        }
    }
}

/// The spectral radius of the matrix of a method.
fn left(table: &Table) -> f64 {
    let mut x = [0.0; WIDTH];
    x[0] = 1.0;
    let mut growth = 1.0;
    for power in 0..2 * SETTLED {
        let mut next = [0.0; WIDTH];
        for (row, x) in table.a.iter().zip(&x).take(table.stages) {
            for (next, weight) in next.iter_mut().zip(&row.0).take(table.stages) {
                *next += weight * x;
            }
        }
        let norm = next.iter().map(|x| x * x).sum::<f64>().sqrt();
        x = next.map(|x| x / norm);
        growth *= if power < SETTLED { 1.0 } else { norm };
    }
    // The root of the order SETTLED.
    (0..SETTLED.ilog2()).fold(growth, |root, _| root.sqrt())
}

/// How many times a rounding counts at the last stage of a next step that is so many times as long.
#[inline]
fn amplified(table: &Table, ratio: f64) -> f64 {
    let nodes = &table.c.0[..table.stages];
    let x = 1.0 + nodes[table.stages - 1] * ratio;
    let product = nodes.iter().fold(1.0, |product, c| product * (x - c));
    let terms = nodes.iter().zip(&table.weights.0).map(|(c, weight)| (weight / (x - c)).abs());
    terms.fold(0.0, |sum, term| sum + term) * product
}
