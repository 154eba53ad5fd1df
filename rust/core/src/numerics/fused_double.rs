//! Double-double arithmetic by fused operations, in every lane at once.
//!
//! The one idea: where [`DoubleDouble`](super::double_double::DoubleDouble) splits its factors to find what a product
//! leaves out, one fused operation tells. For sums over many bodies, where the time counts.
//! Source: Ogita, Rump & Oishi, SIAM J. Sci. Comput. 26 (2005) 1955; Joldes, Muller & Popescu, ACM TOMS 44 (2017) 15.

use super::double_double::two_sum;
use super::inverse_cube::InverseCube;
use super::real::Real;

/// `high + low` in every lane, the low part small beside the high one, if not always below half its last place: sums are
/// joined once, at the end.
#[derive(Clone, Copy, Debug)]
pub struct FusedDouble<S> {
    /// The nearest number.
    pub high: S,
    /// What it leaves out.
    pub low: S,
}

impl<S: Real> FusedDouble<S> {
    /// Zero.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { high: S::zero(), low: S::zero() }
    }

    /// `a * b` exactly.
    #[inline(always)]
    pub fn product(a: S, b: S) -> Self {
        let high = a * b;
        Self { high, low: a.multiply_add(b, -high) }
    }

    /// The difference. Of numbers that cancel, what the high parts leave out may be as large as their difference.
    #[inline(always)]
    pub fn minus(self, other: Self) -> Self {
        let (high, error) = two_sum(self.high, -other.high);
        Self { high, low: error + (self.low - other.low) }
    }

    /// The sum of two of one sign.
    #[inline(always)]
    pub fn plus(self, other: Self) -> Self {
        let (high, error) = two_sum(self.high, other.high);
        Self { high, low: error + (self.low + other.low) }
    }

    /// `x² + y² + z²`, also of differences whose low parts are not small.
    #[inline(always)]
    pub fn sum_of_squares([x, y, z]: [Self; 3]) -> Self {
        let [x, y, z] = [x.squared(), y.squared(), z.squared()];
        x.plus(y).plus(z)
    }

    /// The product.
    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        let Self { high, low } = Self::product(self.high, other.high);
        Self { high, low: self.high.multiply_add(other.low, self.low.multiply_add(other.high, low)) }
    }

    /// The square.
    #[inline(always)]
    pub fn squared(self) -> Self {
        let Self { high, low } = Self::product(self.high, self.high);
        let low = self.low.multiply_add(self.low, low);
        Self { high, low: (self.high + self.high).multiply_add(self.low, low) }
    }

    /// Adds a term to a running sum. What the sum leaves out is gathered beside it and only joined at the end.
    #[inline(always)]
    pub fn gather(&mut self, term: Self) {
        let (high, error) = two_sum(self.high, term.high);
        self.high = high;
        self.low += error + term.low;
    }
}

impl<S: InverseCube> FusedDouble<S> {
    /// `1/√self` by a series and a step of Halley's method: no square root, no division. For numbers from 1e-240 to
    /// 1e240; zero gives something finite.
    #[inline(always)]
    pub fn inverse_root(self) -> Self {
        let rough = self.high.rough_inverse_root();
        // The square of its 17 bits is exact, so the guess is off by no more than its rounding.
        let off = self.high.multiply_subtract_from(rough * rough, S::one());
        let series = off.multiply_add(S::splat(0.3125), S::splat(0.375));
        let series = off.multiply_add(series, S::splat(0.5));
        let guess = (rough * off).multiply_add(series, rough);
        let square = Self::product(guess, guess);
        // How far the guess is off: 1 - self·guess², which is small, so that its rounding is that of the 106th bit.
        let off = self.high.multiply_subtract_from(square.high, S::one());
        let off =
            self.low.multiply_subtract_from(square.high, self.high.multiply_subtract_from(square.low, off));
        let series = S::splat(0.375).multiply_add(off, S::splat(0.5));
        Self { high: guess, low: (guess * off) * series }
    }
}
