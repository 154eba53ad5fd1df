//! A double-double and a power of two beside it: sums and products that neither overflow nor vanish on their way.

use super::double_double::DoubleDouble;
use super::power_of_two::{exponent, power_of_two, scale};
use super::real::Real;

/// `value · 2^exponent`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scaled {
    value: DoubleDouble,
    exponent: i32,
}

/// Addends further apart than this do not see each other.
const OUT_OF_SIGHT: i32 = 400;

impl Scaled {
    /// Zero.
    pub const ZERO: Self = Self { value: DoubleDouble::new(0.0, 0.0), exponent: 0 };

    /// `value · 2^exponent`.
    #[inline]
    pub fn new(value: DoubleDouble, exponent: i32) -> Self {
        Self { value, exponent }
    }

    /// The value beside the power of two.
    #[inline]
    pub fn value(self) -> DoubleDouble {
        self.value
    }

    /// The exponent of the power of two.
    #[inline]
    pub fn exponent(self) -> i32 {
        self.exponent
    }

    /// Whether it is zero.
    #[inline]
    pub fn is_zero(self) -> bool {
        self.value.to_f64() == 0.0
    }

    /// The opposite.
    #[inline]
    pub fn negative(self) -> Self {
        Self { value: -self.value, exponent: self.exponent }
    }

    /// Brings the value near one.
    #[inline]
    fn normal(self) -> Self {
        let (high, low) = self.value.parts();
        if high == 0.0 || !high.is_finite() {
            return Self { value: DoubleDouble::from(high), exponent: 0 };
        }
        let shift = exponent(high);
        let value = DoubleDouble::new(scale(high, -shift), scale(low, -shift));
        Self { value, exponent: self.exponent + shift }
    }

    /// The sum.
    #[inline]
    pub fn plus(self, other: Self) -> Self {
        let (high, start) = (other.value.to_f64(), self.value.to_f64() == 0.0);
        if start && high != 0.0 && high.is_finite() && self.exponent == other.exponent {
            return other; // As the sum would be, without the wait for it.
        }
        let value = self.value + other.value;
        if self.exponent == other.exponent && value.is_finite() {
            return Self { value, exponent: self.exponent };
        }
        self.plus_apart(other)
    }

    /// The difference.
    #[inline]
    pub fn minus(self, other: Self) -> Self {
        self.plus(other.negative())
    }

    #[cold]
    fn plus_apart(self, other: Self) -> Self {
        let (a, b) = (self.normal(), other.normal());
        if a.value.to_f64() == 0.0 || !a.value.to_f64().is_finite() {
            // An infinity and its opposite are no number; an infinity and a number is that infinity.
            let value = a.value.to_f64() + b.value.to_f64();
            return if value.is_finite() { b } else { Self::from(value) };
        }
        if b.value.to_f64() == 0.0 || !b.value.to_f64().is_finite() {
            return if b.value.to_f64() == 0.0 { a } else { b };
        }
        let (large, small) = if a.exponent >= b.exponent { (a, b) } else { (b, a) };
        let apart = large.exponent - small.exponent;
        if apart > OUT_OF_SIGHT {
            return large;
        }
        Self { value: large.value + small.value.scale(power_of_two(-apart)), exponent: large.exponent }
    }

    /// The product with a number.
    #[inline]
    pub fn times(self, factor: f64) -> Self {
        self.by(Self::from(factor))
    }

    /// The product.
    #[inline]
    pub fn by(self, factor: Self) -> Self {
        let (a, b) = (self.normal(), factor.normal());
        let (x, y) = (a.value.to_f64(), b.value.to_f64());
        if !x.is_finite() || !y.is_finite() {
            return Self::from(x * y);
        }
        Self { value: a.value * b.value, exponent: a.exponent + b.exponent }
    }

    /// The quotient.
    #[inline]
    pub fn over(self, divisor: Self) -> Self {
        let (a, b) = (self.normal(), divisor.normal());
        Self { value: a.value / b.value, exponent: a.exponent - b.exponent }
    }

    /// The square root; NaN of what is below zero.
    #[inline]
    pub fn sqrt(self) -> Self {
        let Self { value, exponent } = self.normal();
        let odd = exponent.rem_euclid(2);
        Self { value: Real::sqrt(value.scale(power_of_two(odd))), exponent: (exponent - odd) / 2 }
    }

    /// The nearest number; infinite beyond the range.
    #[inline]
    pub fn to_f64(self) -> f64 {
        scale(self.value.to_f64(), self.exponent)
    }

    /// The value, where its range is that of numbers.
    #[inline]
    pub fn to_double_double(self) -> DoubleDouble {
        let (high, low) = self.value.parts();
        DoubleDouble::new(scale(high, self.exponent), scale(low, self.exponent))
    }
}

impl From<f64> for Scaled {
    #[inline]
    fn from(value: f64) -> Self {
        Self { value: DoubleDouble::from(value), exponent: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_lost_on_the_way() {
        let large = Scaled::from(1e300).times(1e300);
        assert_eq!(large.to_f64(), f64::INFINITY);
        assert_eq!(large.times(1e-300).over(Scaled::from(1e300)).to_f64(), 1.0);
        // A double-double keeps 106 bits: 2^-100 beside one.
        let sum = Scaled::new(DoubleDouble::from(1.0), 2000).plus(Scaled::new(DoubleDouble::from(1.0), 1900));
        let rest = sum.plus(Scaled::new(DoubleDouble::from(-1.0), 2000));
        assert_eq!(rest.times(power_of_two(-1000)).times(power_of_two(-900)).to_f64(), 1.0);
        assert_eq!(Scaled::from(3.0).plus(large).minus(large).to_f64(), 0.0);
    }

    #[test]
    fn roots_square_back_beyond_the_range() {
        for exponent in [-3001, -2000, 0, 1, 2999] {
            let x = Scaled::new(DoubleDouble::from(3.0), exponent);
            let rest = x.sqrt().by(x.sqrt()).minus(x).over(x).to_f64();
            assert!(rest.abs() < 2e-31, "{exponent}: {rest:e}"); // a few units in the 106th bit
        }
        assert_eq!(Scaled::ZERO.sqrt().to_f64(), 0.0);
    }

    #[test]
    fn infinities_stay_what_they_are() {
        let infinite = Scaled::new(DoubleDouble::from(f64::NEG_INFINITY), 3);
        assert_eq!(infinite.plus(Scaled::from(1.0)).to_f64(), f64::NEG_INFINITY);
        assert_eq!(Scaled::from(1.0).plus(infinite).to_f64(), f64::NEG_INFINITY);
        assert_eq!(infinite.plus(infinite).to_f64(), f64::NEG_INFINITY);
        assert_eq!(Scaled::ZERO.plus(Scaled::from(f64::INFINITY)).to_f64(), f64::INFINITY);
        assert_eq!(infinite.times(-2.0).to_f64(), f64::INFINITY);
    }
}
