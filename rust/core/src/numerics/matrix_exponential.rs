//! exp(A t) of a vector, to the last digit, at any time.
//!
//! The one idea: time is counted in a unit u, short enough for the series of exp(A u), in binary; a time is then the product
//! of some of exp(A u), exp(2 A u), exp(4 A u), …, each the square of the one before, and a rest for the series. In
//! double-double what squaring doubles stays below a double's last digit for 2⁵⁰ units. No eigenvalues, so nothing is special where
//! they agree, vanish, or come in pairs.
//! Sources: C. Moler & C. Van Loan, SIAM Review 45 (2003) 3, methods 3 and 1; for balancing B. N. Parlett & C. Reinsch,
//! Numerische Mathematik 13 (1969) 293.

mod columns;
pub mod propagator;

use super::double_double::{DoubleDouble, two_sum};
use super::power_of_two::exponent;
use super::real::Real;
use columns::{Columns, Matrices};

/// Of the time in which nothing turns by more than half a radian, the unit is such a part: each halving is one more power for
/// each time, and about one term less of the series.
const PART: f64 = 1.0 / 8.0;
/// Terms of a series whose argument is at most a sixteenth: what is left out is below 2⁻¹⁰⁴ of the first.
const TERMS: usize = 16;
/// Sweeps of balancing; each halves the exponents that are left.
const SWEEPS: usize = 64;
/// The largest exponent of a number's unit.
const EXTREME: i32 = 400;
/// Units of time in the longest time: with more, no digit would be left.
const MOST_UNITS: f64 = 9.0e18;

/// A linear flow y′ = A y.
#[derive(Clone, Debug)]
pub struct MatrixExponential {
    n: usize,
    /// A u in balanced numbers.
    step: Columns,
    /// The units of the numbers, powers of two.
    units: Vec<f64>,
    /// 8 u, a power of two.
    unit_of_time: f64,
    /// exp(A u 2ᵏ).
    powers: Matrices,
    /// 1/k of the terms.
    inverses: Vec<DoubleDouble>,
}

impl MatrixExponential {
    /// Of a matrix of `n` rows, with numbers of like size in a time of about `longest`.
    pub fn new(matrix: Vec<DoubleDouble>, n: usize, longest: f64) -> Self {
        let inverses = (1..=TERMS).map(|k| DoubleDouble::one() / DoubleDouble::from(k as f64)).collect();
        let step = Columns::new(n, n);
        let mut new =
            Self { n, step, units: vec![], unit_of_time: 1.0, powers: Matrices::default(), inverses };
        new.take(matrix, longest);
        new
    }

    /// Takes another matrix, of as many rows, and keeps the room.
    fn take(&mut self, mut matrix: Vec<DoubleDouble>, longest: f64) {
        self.units = balanced(&mut matrix, self.n, longest);
        let mut norm = 0.0;
        for row in matrix.chunks_exact(self.n) {
            let sum = row.iter().fold(0.0, |sum, entry| sum + entry.to_f64().abs());
            norm = if sum > norm { sum } else { norm };
        }
        self.unit_of_time = if norm > 0.0 { power(-1 - ceiling(norm)) } else { power(ceiling(longest)) };
        for (index, entry) in matrix.into_iter().enumerate() {
            self.step.set(index / self.n, index % self.n, entry.scale(PART * self.unit_of_time));
        }
        self.powers.used = 0;
    }

    /// A time in which nothing turns by more than half a radian or grows by more than its half: a power of two.
    pub fn unit_of_time(&self) -> f64 {
        self.unit_of_time
    }

    /// exp(A t) y for t ≥ 0, the time as a sum of two; no numbers if it is so long that no digit would be left.
    pub fn apply(&mut self, t: (f64, f64), y: &[f64]) -> Vec<f64> {
        self.unrounded(t, y).iter().map(|value| value.to_f64()).collect()
    }

    /// The same in double-double.
    pub fn unrounded(&mut self, t: (f64, f64), y: &[f64]) -> Vec<DoubleDouble> {
        let Some((whole, rest)) = self.counted(t) else {
            return vec![DoubleDouble::from(f64::NAN); self.n];
        };
        let scaled: Vec<_> =
            y.iter().zip(&self.units).map(|(&y, unit)| DoubleDouble::from(y / unit)).collect();
        let mut value = self.step.series(rest, &Columns::of(&scaled, self.n), &self.inverses);
        for digit in (0..u64::BITS).filter(|digit| whole >> digit & 1 == 1) {
            value = self.power(digit).times(&value);
        }
        self.units.iter().enumerate().map(|(row, &unit)| value.get(row, 0).scale(unit)).collect()
    }

    /// Whole units of time and a rest; none if the time is so long that no digit would be left.
    fn counted(&self, (high, low): (f64, f64)) -> Option<(u64, DoubleDouble)> {
        let unit = PART * self.unit_of_time;
        let units = DoubleDouble::new(high / unit, low / unit);
        if units.to_f64() > MOST_UNITS || units.to_f64().is_nan() {
            return None;
        }
        let mut whole = units.high().floor();
        let mut rest = units - DoubleDouble::from(whole);
        if rest.to_f64() < 0.0 {
            whole -= 1.0;
            rest += DoubleDouble::from(1.0);
        }
        Some((whole as u64, rest))
    }

    /// exp(A u 2ᵏ).
    fn power(&mut self, k: u32) -> &Columns {
        let Self { n, step, powers, inverses, .. } = self;
        while powers.used <= k as usize {
            match powers.next(*n) {
                (next, [.., last]) => last.times_into(last, next),
                (next, []) => next.copy_from(&step.series(DoubleDouble::one(), &Columns::one(*n), inverses)),
            }
        }
        &powers.all[k as usize]
    }
}

/// Counts each number in a unit of its own, a power of two, in which rows and columns are of like size; those units. What
/// only drives, or is only driven, is given the size that matters in the time `longest`.
fn balanced(matrix: &mut [DoubleDouble], n: usize, longest: f64) -> Vec<f64> {
    let mut units = vec![0_i32; n];
    let slow = -ceiling(longest);
    for _ in 0..SWEEPS {
        let mut changed = false;
        for i in 0..n {
            let size = |at: fn(usize, usize, usize) -> usize| {
                (0..n).filter(|&j| j != i).fold(0.0, |sum, j| sum + matrix[at(i, j, n)].to_f64().abs())
            };
            let (row, column) = (size(|i, j, n| i * n + j), size(|i, j, n| j * n + i));
            // The unit of i multiplies its column and divides its row.
            let shift = match (row > 0.0, column > 0.0) {
                (true, true) => (ceiling(row) - ceiling(column)) / 2,
                (true, false) => ceiling(row) - slow,
                (false, true) => slow - ceiling(column),
                (false, false) => 0,
            };
            let shift = (units[i] + shift).clamp(-EXTREME, EXTREME) - units[i];
            if shift == 0 {
                continue;
            }
            (units[i], changed) = (units[i] + shift, true);
            for j in (0..n).filter(|&j| j != i) {
                matrix[i * n + j] = matrix[i * n + j].scale(power(-shift));
                matrix[j * n + i] = matrix[j * n + i].scale(power(shift));
            }
        }
        if !changed {
            break;
        }
    }
    units.into_iter().map(power).collect()
}

/// The exponent of the power of two next above a size.
fn ceiling(size: f64) -> i32 {
    exponent(size) + 1
}

/// A power of two.
fn power(exponent: i32) -> f64 {
    super::power_of_two::power_of_two(exponent.clamp(-1000, 1000))
}

/// `t − t0`, exactly.
pub fn elapsed(t: f64, t0: f64) -> (f64, f64) {
    two_sum(t, -t0)
}

#[cfg(test)]
mod tests;
