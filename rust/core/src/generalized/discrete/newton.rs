//! Newton's method to round-off, with derivatives that are kept while they lead there fast.

use nalgebra::{DMatrix, DVector, Dyn, LU};

/// Corrections after which an equation is given up.
pub(super) const MOST_CORRECTIONS: u32 = 40;
/// What is left of an error, in units of what is looked for, when it is found.
const FOUND: f64 = f64::EPSILON / 16.0;
/// Corrections below this that no longer fall are round-off.
const ROUND_OFF: f64 = 1e-13;
/// Derivatives are found anew where a correction leaves more than this of the error.
const SLOW: f64 = 0.05;

/// What is to be done after a correction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// What was looked for is found.
    Found,
    /// The next correction may have the same derivatives.
    Again,
    /// The next correction needs derivatives from where it begins.
    Anew,
    /// It is no number.
    Lost,
}

/// The larger of two sizes; what is no number is.
pub(super) fn larger(most: f64, size: f64) -> f64 {
    if size <= most || most.is_nan() { most } else { size }
}

/// How corrections fall.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corrections {
    last: f64,
}

impl Corrections {
    pub(super) fn new() -> Self {
        Self { last: f64::INFINITY }
    }

    /// After a correction of this size, in units of what is looked for.
    pub(super) fn judge(&mut self, size: f64) -> Verdict {
        // Of the first nobody knows what it leaves.
        let left = if self.last.is_finite() && size < self.last { size / self.last } else { 1.0 };
        let stands = size >= 0.5 * self.last;
        self.last = size;
        if !size.is_finite() {
            Verdict::Lost
        } else if size * left <= FOUND || (stands && size < ROUND_OFF) {
            Verdict::Found
        } else if left > SLOW && left < 1.0 || stands {
            Verdict::Anew
        } else {
            Verdict::Again
        }
    }
}

/// A system of linear equations that is filled in, factored and solved with one right side after another.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    matrix: DMatrix<f64>,
    /// The first rows and the last columns that are left out.
    without: usize,
    factors: Option<LU<f64, Dyn, Dyn>>,
    right: DVector<f64>,
}

impl Linear {
    pub(super) fn new(all: usize, without: usize) -> Self {
        let (matrix, right) = (DMatrix::zeros(all, all), DVector::zeros(all - without));
        Self { matrix, without, factors: None, right }
    }

    /// How many unknowns there are.
    pub(super) fn len(&self) -> usize {
        self.right.len()
    }

    /// The matrix, all zeros, to be filled in.
    pub(super) fn clear(&mut self) -> &mut DMatrix<f64> {
        self.factors = None;
        self.matrix.fill(0.0);
        &mut self.matrix
    }

    /// Finds the unknowns; whether the matrix has an inverse.
    pub(super) fn solve(&mut self, right: &[f64]) -> bool {
        let (without, count) = (self.without, self.right.len());
        let kept = || self.matrix.view((without, 0), (count, count)).clone_owned();
        let factors = self.factors.get_or_insert_with(|| kept().lu());
        self.right.copy_from_slice(&right[without..]);
        factors.solve_mut(&mut self.right)
    }

    /// The unknowns that were found last.
    pub(super) fn found(&self) -> &[f64] {
        self.right.as_slice()
    }
}
