//! Polynomials in pieces over a range of distances, as V(r) with its exact derivatives; beyond the range, nothing.

use super::Analytic;
use crate::numerics::power_of_two::scale;
use crate::numerics::rows::Rows;

/// Of each piece its origin, what makes its variable of a distance, and up to this many coefficients.
const COLUMNS: usize = 2;

/// V(r) = Σ cₖ tᵏ with t = (r − origin)·inverse, `N` = 2 + number of coefficients.
#[derive(Clone, Debug)]
pub(crate) struct Piecewise<const N: usize> {
    rows: Rows<N>,
    first: f64,
    last: f64,
}

impl<const N: usize> Piecewise<N> {
    /// From the places where pieces begin, which ascend, the end of the last, and the pieces:
    /// origin, inverse of the unit of t, coefficients.
    pub(crate) fn new(starts: Vec<f64>, last: f64, rows: Vec<[f64; N]>) -> Self {
        let first = starts.first().copied().unwrap_or(last);
        Self { rows: Rows::new(starts, rows), first, last }
    }
    /// The same in units of length and of its values that are larger by these powers of two.
    pub(crate) fn scaled(&self, length: i32, value: i32) -> Self {
        let starts = self.rows.starts().iter().map(|start| scale(*start, -length)).collect();
        let of_row = |row: &[f64; N]| {
            let mut row = *row;
            (row[0], row[1]) = (scale(row[0], -length), scale(row[1], length));
            row[COLUMNS..].iter_mut().for_each(|coefficient| *coefficient = scale(*coefficient, -value));
            row
        };
        Self::new(starts, scale(self.last, -length), self.rows.rows().iter().map(of_row).collect())
    }
    /// The range.
    pub(crate) fn domain(&self) -> (f64, f64) {
        (self.first, self.last)
    }
    /// Where its pieces begin.
    pub(crate) fn starts(&self) -> &[f64] {
        self.rows.starts()
    }
    /// The derivative of that order with respect to r; NaN beyond the range.
    #[inline(always)]
    pub(crate) fn derivative<S: Analytic>(&self, r: S, order: usize) -> S {
        let row = r.columns(&self.rows);
        self.of_row(&row, r, order)
    }
    /// V(r) and its first two derivatives, of a row that is looked up once.
    #[inline(always)]
    pub(crate) fn derivatives<S: Analytic>(&self, r: S) -> [S; 3] {
        let row = r.columns(&self.rows);
        [self.of_row(&row, r, 0), self.of_row(&row, r, 1), self.of_row(&row, r, 2)]
    }
    #[inline(always)]
    fn of_row<S: Analytic>(&self, row: &[S; N], r: S, order: usize) -> S {
        let t = (r - row[0]) * row[1];
        let mut sum = S::zero();
        let mut k = N - COLUMNS;
        while k > order {
            k -= 1;
            let mut factor = 1.0;
            for below in 0..order {
                factor *= (k - below) as f64;
            }
            sum = sum.multiply_add(t, row[COLUMNS + k] * S::splat(factor));
        }
        for _ in 0..order {
            sum = sum * row[1];
        }
        let (after, before) = (S::splat(self.first).less_equal(r), r.less_equal(S::splat(self.last)));
        S::select(after, S::select(before, sum, S::splat(f64::NAN)), S::splat(f64::NAN))
    }
}
