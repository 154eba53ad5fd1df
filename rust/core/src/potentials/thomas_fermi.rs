//! The Thomas–Fermi function: φ″ = φ^(3/2)/√x, φ(0) = 1, φ(∞) = 0, to the precision of numbers.
//!
//! Near x = 0 it is a series in √x, so its pieces are polynomials in y = √x; beyond the last it is 144/x³ times a series
//! in x^−λ, λ = (√73 − 7)/2 (C. A. Coulson, N. H. March, Proc. Phys. Soc. A 63 (1950) 367).

use super::Analytic;
use super::thomas_fermi_table::{END, LAMBDA, PIECES, TAIL};
use crate::numerics::power::Power;
use crate::numerics::rows::Rows;

/// Columns of a piece: its middle, one over half its length, coefficients.
const COLUMNS: usize = 16;
const DEGREE: usize = COLUMNS - 3;

/// The function, ready to be looked up.
#[derive(Clone, Debug)]
pub(super) struct ThomasFermi {
    rows: Rows<COLUMNS>,
}

impl ThomasFermi {
    pub(super) fn new() -> Self {
        let starts = PIECES.iter().map(|piece| piece[0]).collect();
        let columns = |piece: &[f64; COLUMNS + 1]| core::array::from_fn(|column| piece[column + 1]);
        Self { rows: Rows::new(starts, PIECES.iter().map(columns).collect()) }
    }

    /// φ, −x φ′ and x² φ″.
    #[inline(always)]
    pub(super) fn all<S: Analytic>(&self, x: S) -> [S; 3] {
        let (near, far) = (self.near(x), far(x));
        let within = x.less_equal(S::splat(END * END));
        let mut all = near;
        for at in 0..3 {
            all[at] = S::select(within, near[at], far[at]);
        }
        all
    }

    #[inline(always)]
    fn near<S: Analytic>(&self, x: S) -> [S; 3] {
        let y = x.min(S::splat(END * END)).sqrt();
        let row = y.columns(&self.rows);
        let t = (y - row[0]) * row[1];
        let (mut value, mut slope, mut half_bend) = (S::zero(), S::zero(), S::zero());
        for k in (0..=DEGREE).rev() {
            half_bend = half_bend.multiply_add(t, slope);
            slope = slope.multiply_add(t, value);
            value = value.multiply_add(t, row[2 + k]);
        }
        // x d/dx = (y/2) d/dy and x² d²/dx² = (y²/4) d²/dy² − (y/4) d/dy.
        let per_y = row[1] * y;
        let slope = slope * per_y;
        let bend = (half_bend + half_bend) * per_y * per_y;
        [value, S::splat(-0.5) * slope, S::splat(0.25) * (bend - slope)]
    }
}

/// Beyond the pieces: with u = x^−λ, x³φ/144 = Σ cₖ uᵏ, and x d/dx = −λ u d/du.
#[inline(always)]
fn far<S: Analytic>(x: S) -> [S; 3] {
    let x = x.max(S::splat(END * END));
    let u = x.power(&Power::new(-LAMBDA));
    let mut sums = [S::zero(); 3];
    for (k, &c) in TAIL.iter().enumerate().rev() {
        // Each term falls as x^−(3 + λk).
        let fall = 3.0 + LAMBDA * k as f64;
        for (sum, factor) in sums.iter_mut().zip([1.0, fall, fall * (fall + 1.0)]) {
            *sum = sum.multiply_add(u, S::splat(c * factor));
        }
    }
    let inverse = S::one() / x;
    let front = S::splat(144.0) * inverse * inverse * inverse;
    for sum in &mut sums {
        *sum = *sum * front;
    }
    sums
}

#[cfg(test)]
mod tests;
