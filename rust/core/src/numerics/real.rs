//! `Real`: the scalar over which every integrator is written once.
//!
//! The one idea: an algorithm is generic over the scalar *only*. `f64` is one trajectory,
//! [`Lanes`](super::lanes::Lanes) is eight, [`DoubleDouble`](super::double_double::DoubleDouble)
//! carries 31 digits for references and for checking coefficients.

use super::double_double::DoubleDouble;
use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// `[value of 0, value of 1, …]`, an array of `$count` numbers `S`: one operation for all of them before the next one
/// for any. In a kernel each result waits for the one before it, and there must be others to compute meanwhile,
/// nearer than a processor looks ahead. A macro and not a closure, as everywhere in what tiers compile.
macro_rules! each {
    ($i:ident < $count:ident => $value:expr) => {{
        let mut result = [S::zero(); $count];
        for $i in 0..$count {
            result[$i] = $value;
        }
        result
    }};
}
pub(crate) use each;

/// A truth value for each lane of a [`Real`].
pub trait Mask: Copy + Debug {
    /// The same truth value in every lane.
    fn splat(value: bool) -> Self;
    /// Whether every lane is true.
    fn all(self) -> bool;
    /// Whether some lane is true.
    fn any(self) -> bool;
    /// Lane-wise `self & other`.
    fn and(self, other: Self) -> Self;
    /// Lane-wise `self | other`.
    fn or(self, other: Self) -> Self;
    /// Lane-wise negation.
    fn not(self) -> Self;
}

impl Mask for bool {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        value
    }
    #[inline(always)]
    fn all(self) -> bool {
        self
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }
    #[inline(always)]
    fn not(self) -> Self {
        !self
    }
}

/// A real number, or several independent ones side by side.
///
/// Every operation is correctly rounded where IEEE 754 defines it (`+ - * / sqrt` and the fused ones) and
/// fused only where the source says so: one source gives the same bits on every instruction set. Without an
/// instruction for it a fused operation is a slow call.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// The result of a comparison.
    type Mask: Mask;

    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// A constant, as exactly as the scalar allows.
    fn from_double_double(value: DoubleDouble) -> Self;
    /// `self * factor + term`, rounded once.
    fn multiply_add(self, factor: Self, term: Self) -> Self;
    /// `term - self * factor`, rounded once.
    fn multiply_subtract_from(self, factor: Self, term: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// `a if a > b else b` (so a NaN in `self` gives `other`).
    fn max(self, other: Self) -> Self;
    /// `a if a < b else b` (so a NaN in `self` gives `other`).
    fn min(self, other: Self) -> Self;
    /// `self < other`.
    fn less(self, other: Self) -> Self::Mask;
    /// `self <= other`.
    fn less_equal(self, other: Self) -> Self::Mask;
    /// `if_true` where the mask holds, else `if_false`.
    fn select(mask: Self::Mask, if_true: Self, if_false: Self) -> Self;
    /// `coefficient * self` as an unevaluated sum (high, low), so that a coefficient that the
    /// scalar cannot represent does not bias a long integration.
    fn scaled_by(self, coefficient: DoubleDouble) -> (Self, Self);
    /// The coefficient itself as such a sum.
    #[inline(always)]
    fn unevaluated(coefficient: DoubleDouble) -> (Self, Self) {
        Self::one().scaled_by(coefficient)
    }

    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }
    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }
}

impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn from_double_double(value: DoubleDouble) -> Self {
        value.to_f64()
    }
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        f64::mul_add(self, factor, term)
    }
    #[inline(always)]
    fn multiply_subtract_from(self, factor: Self, term: Self) -> Self {
        f64::mul_add(-self, factor, term)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn select(mask: bool, if_true: Self, if_false: Self) -> Self {
        if mask { if_true } else { if_false }
    }
    #[inline]
    fn scaled_by(self, coefficient: DoubleDouble) -> (Self, Self) {
        let product = coefficient * DoubleDouble::from(self);
        (product.high(), product.low())
    }
}
