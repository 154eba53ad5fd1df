//! The bits of a binary64 number, in every lane: what arithmetic alone cannot do, or not as fast.

use super::lanes::{Lanes, Vector8};
use super::real::Real;

/// Added to an integer n > -1023, leaves n and the bias of an exponent in the low bits of the sum.
pub(super) const BIASED_SHIFT: f64 = 4_503_599_627_370_496.0 + 1023.0; // 2^52 + bias

/// Minus half the bits of a number, from here, are the bits of about its inverse square root, to 3.5 %.
/// The line is the one with the smallest largest error (Lomont, *Fast inverse square root*, 2003).
pub(super) const INVERSE_ROOT_LINE: i64 = 0x5fe6_eb50_c7b5_37a9;

/// Keeps the sign, the exponent and the 17 leading bits of the significand, the hidden one included.
pub(super) const LEADING_BITS: i64 = !((1 << 36) - 1);

/// The bits of a number after its exponent, …
pub(super) const SIGNIFICAND_BITS: i64 = (1 << 52) - 1;
/// … those of the exponent of 1, …
pub(super) const EXPONENT_OF_ONE: i64 = 1023 << 52;
/// … and those of 2^52, the last bits of which count.
pub(super) const COUNTING: i64 = 1075 << 52;

/// Scalars whose bits are those of binary64.
pub trait Binary: Real {
    /// Whether each operation is a function of its own, as [where nothing is fast](super::lanes): then what is made of many
    /// is one, too, lest all of them be written into every kernel.
    const APART: bool = false;
    /// 2ⁿ for integers n from -1022 to 1023; anything else is a broken promise of the caller.
    fn power_of_two(self) -> Self;
    /// 1/√self to 3.5 %, for positive normal numbers.
    fn inverse_root_guess(self) -> Self;
    /// Cut off after 17 bits, so that its square and its cube are exact.
    fn leading_bits(self) -> Self;
    /// Without its significand: the power of two at most a positive number, 0 of what is below the normal ones, and infinite
    /// where there is no number.
    fn exponent_part(self) -> Self;
    /// The m of m·2ᵏ, 1 ≤ m < 2, for positive normal numbers.
    fn significand(self) -> Self;
    /// The k of m·2ᵏ, for positive normal numbers.
    fn binary_exponent(self) -> Self;
}

impl Binary for f64 {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        f64::from_bits((self + BIASED_SHIFT).to_bits() << 52)
    }
    #[inline(always)]
    fn inverse_root_guess(self) -> Self {
        f64::from_bits((INVERSE_ROOT_LINE as u64).wrapping_sub(self.to_bits() >> 1))
    }
    #[inline(always)]
    fn leading_bits(self) -> Self {
        f64::from_bits(self.to_bits() & LEADING_BITS as u64)
    }
    #[inline(always)]
    fn exponent_part(self) -> Self {
        f64::from_bits(self.to_bits() & f64::INFINITY.to_bits())
    }
    #[inline(always)]
    fn significand(self) -> Self {
        f64::from_bits(self.to_bits() & SIGNIFICAND_BITS as u64 | EXPONENT_OF_ONE as u64)
    }
    #[inline(always)]
    fn binary_exponent(self) -> Self {
        f64::from_bits(self.to_bits() >> 52 | COUNTING as u64) - BIASED_SHIFT
    }
}

impl Binary for Lanes {
    const APART: bool = <Self as Vector8>::APART;
    #[inline(always)]
    fn power_of_two(self) -> Self {
        self.map(f64::power_of_two)
    }
    #[inline(always)]
    fn inverse_root_guess(self) -> Self {
        self.map(f64::inverse_root_guess)
    }
    #[inline(always)]
    fn leading_bits(self) -> Self {
        self.map(f64::leading_bits)
    }
    #[inline(always)]
    fn exponent_part(self) -> Self {
        self.map(f64::exponent_part)
    }
    #[inline(always)]
    fn significand(self) -> Self {
        self.map(f64::significand)
    }
    #[inline(always)]
    fn binary_exponent(self) -> Self {
        self.map(f64::binary_exponent)
    }
}
