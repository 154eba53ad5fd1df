//! Double-double arithmetic: an unevaluated sum of two `f64`, about 31.9 decimal digits.
//!
//! Used for coefficients, references, and the few steps of a closed form where `f64` would lose
//! digits. No fused multiply-add, so the bits do not depend on the machine.
//! Source: Dekker, Numer. Math. 18 (1971) 224; Knuth, TAOCP vol. 2, 4.2.2; Hida, Li & Bailey,
//! *Library for double-double and quad-double arithmetic* (2007); Joldes, Muller & Popescu,
//! ACM TOMS 44 (2017) 15, algorithms 6 (addition), 12 (product), 17 (quotient).

use super::real::Real;
use core::cmp::Ordering;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// `high + low` with `|low| ≤ ulp(high)/2`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// `a + b` exactly, as (sum, error) (Knuth).
#[inline(always)]
pub fn two_sum<S: Real>(a: S, b: S) -> (S, S) {
    let sum = a + b;
    let b_part = sum - a;
    let error = (a - (sum - b_part)) + (b - b_part);
    (sum, error)
}

/// `a + b` exactly when `|a| ≥ |b|` (Dekker).
#[inline(always)]
pub(crate) fn quick_two_sum<S: Real>(a: S, b: S) -> (S, S) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// `a * b` exactly, as (product, error) (Dekker, Veltkamp splitting).
#[inline(always)]
pub fn two_product<S: Real>(a: S, b: S) -> (S, S) {
    let splitter = S::splat(134_217_729.0); // 2^27 + 1
    let product = a * b;
    let scaled_a = splitter * a;
    let a_high = scaled_a - (scaled_a - a);
    let a_low = a - a_high;
    let scaled_b = splitter * b;
    let b_high = scaled_b - (scaled_b - b);
    let b_low = b - b_high;
    let error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (product, error)
}

/// `a + b` of double-doubles, in every lane.
#[inline(always)]
pub fn sum<S: Real>(a: (S, S), b: (S, S)) -> (S, S) {
    let (high, error) = two_sum(a.0, b.0);
    let (low, low_error) = two_sum(a.1, b.1);
    let (high, error) = quick_two_sum(high, error + low);
    quick_two_sum(high, error + low_error)
}

/// `a * b` of double-doubles, in every lane.
#[inline(always)]
pub fn product<S: Real>(a: (S, S), b: (S, S)) -> (S, S) {
    let (high, error) = two_product(a.0, b.0);
    quick_two_sum(high, error + (a.0 * b.1 + a.1 * b.0))
}

impl DoubleDouble {
    /// π.
    pub const PI: Self = Self::new(core::f64::consts::PI, 1.224_646_799_147_353_2e-16);

    /// From two parts that do not overlap.
    pub const fn new(high: f64, low: f64) -> Self {
        Self { high, low }
    }
    /// The nearest `f64`.
    pub const fn high(self) -> f64 {
        self.high
    }
    /// The two parts, (high, low).
    pub const fn parts(self) -> (f64, f64) {
        (self.high, self.low)
    }
    /// What the nearest `f64` leaves out.
    pub const fn low(self) -> f64 {
        self.low
    }
    /// The nearest `f64`.
    pub const fn to_f64(self) -> f64 {
        self.high
    }
    /// `a * b` without rounding.
    #[inline]
    pub fn product(a: f64, b: f64) -> Self {
        let (high, low) = two_product(a, b);
        Self { high, low }
    }
    /// `a + b` without rounding.
    #[inline]
    pub fn sum(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, b);
        Self { high, low }
    }
    /// Multiplied by a power of two (exact).
    #[inline]
    pub fn scale(self, power_of_two: f64) -> Self {
        Self::new(self.high * power_of_two, self.low * power_of_two)
    }
    /// The nearest integer (ties away from zero in the high part), exact up to 2^106.
    #[inline]
    pub fn round(self) -> Self {
        let high = self.high.round();
        if high == self.high {
            let (high, low) = quick_two_sum(high, self.low.round());
            return Self { high, low };
        }
        // |high - self.high| = 1/2 is a tie that the low part decides.
        let high = if (high - self.high).abs() == 0.5 && (high - self.high) * self.low < 0.0 {
            high - (high - self.high).signum()
        } else {
            high
        };
        Self { high, low: 0.0 }
    }
    /// Whether both parts are finite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.high.is_finite() && self.low.is_finite()
    }
}

impl From<f64> for DoubleDouble {
    #[inline]
    fn from(value: f64) -> Self {
        Self::new(value, 0.0)
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let (high, low) = sum(self.parts(), other.parts());
        Self { high, low }
    }
}
impl Neg for DoubleDouble {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.high, -self.low)
    }
}
impl Sub for DoubleDouble {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + (-other)
    }
}
impl Mul for DoubleDouble {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let (high, low) = product(self.parts(), other.parts());
        Self { high, low }
    }
}
impl Div for DoubleDouble {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let remainder = self - other * Self::from(first);
        let second = remainder.high / other.high;
        let remainder = remainder - other * Self::from(second);
        let third = remainder.high / other.high;
        let (high, low) = quick_two_sum(first, second);
        Self { high, low } + Self::from(third)
    }
}
impl AddAssign for DoubleDouble {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for DoubleDouble {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
impl PartialOrd for DoubleDouble {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&other.low),
            ordering => ordering,
        }
    }
}

impl Real for DoubleDouble {
    type Mask = bool;

    #[inline]
    fn splat(value: f64) -> Self {
        Self::from(value)
    }
    #[inline]
    fn from_double_double(value: DoubleDouble) -> Self {
        value
    }
    #[inline]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        self * factor + term
    }
    #[inline]
    fn multiply_subtract_from(self, factor: Self, term: Self) -> Self {
        term - self * factor
    }
    #[inline]
    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::from(self.high.sqrt());
        }
        // One Newton step on an f64 square root: 53 digits become 106 (Karp & Markstein).
        let root = self.high.sqrt();
        let remainder = self - Self::product(root, root);
        let (high, low) = quick_two_sum(root, remainder.high / (2.0 * root));
        let refined = Self { high, low };
        let remainder = self - refined * refined;
        refined + Self::from(remainder.high / (2.0 * root))
    }
    #[inline]
    fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }
    #[inline]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline]
    fn less(self, other: Self) -> bool {
        self < other
    }
    #[inline]
    fn less_equal(self, other: Self) -> bool {
        self <= other
    }
    #[inline]
    fn select(mask: bool, if_true: Self, if_false: Self) -> Self {
        if mask { if_true } else { if_false }
    }
    #[inline]
    fn scaled_by(self, coefficient: DoubleDouble) -> (Self, Self) {
        (coefficient * self, Self::zero())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn square_root_of_two_squares_back() {
        let two = DoubleDouble::from(2.0);
        let residual = (two.sqrt() * two.sqrt() - two).to_f64();
        assert!(residual.abs() < 4e-32, "{residual:e}"); // 2 ulps of 2^-105
    }

    #[test]
    fn rounding_decides_ties_by_the_low_part() {
        assert_eq!(DoubleDouble::new(2.5, -1e-20).round().to_f64(), 2.0);
        assert_eq!(DoubleDouble::new(2.5, 1e-20).round().to_f64(), 3.0);
        assert_eq!(DoubleDouble::new(-2.5, 1e-20).round().to_f64(), -2.0);
    }

    proptest! {
        #[test]
        fn sums_and_products_carry_their_error(a in -1e8..1e8f64, b in -1e8..1e8f64) {
            let (product, error) = two_product(a, b);
            // The exact product of two 53-bit numbers needs 106 bits: the error is below half an ulp.
            prop_assert!(error.abs() <= product.abs() * f64::EPSILON);
            let quotient = DoubleDouble::product(a, b) / DoubleDouble::from(if b == 0.0 { 1.0 } else { b });
            if b != 0.0 {
                let relative = (quotient - DoubleDouble::from(a)).to_f64() / a.abs().max(1e-300);
                prop_assert!(relative.abs() < 1e-30); // a few units in the 106th bit
            }
        }
    }
}
