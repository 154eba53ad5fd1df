//! Powers to four digits, for deciding and not for results: what a number is to the power of a small fraction.
//!
//! x = m·2ᵏ is 2 to the power of k + log₂ m, the logarithm and the power of two being polynomials. Nothing but IEEE
//! operations: the same bits on every machine, for a fifth of what repeated square roots cost.

use super::binary::Binary;
use super::elementary::nearest_integer;
use super::power_of_two::power_of_two;

/// log₂(1 + x) for x from 0 to 1 to 1.3e-5 (the best polynomial, by Lawson's algorithm).
const LOGARITHM: [f64; 6] =
    [1.253_828_05e-5, 1.441_684_565, -0.707_992_69, 0.413_630_192, -0.192_195_689, 0.044_873_622_4];
/// 2ˣ for |x| ≤ 1/2 to 2.7e-6 (likewise).
const POWER: [f64; 5] = [1.000_000_151, 0.693_121_036, 0.240_218_655, 0.055_922_026_9, 0.009_685_711_56];

/// `x^exponent` for positive normal x and an exponent of at most 1/2 in size, and 0 of 0.
#[inline(always)]
pub(super) fn rough_power<S: Binary>(x: S, exponent: f64) -> S {
    let beyond = x.significand() - S::one();
    let mut logarithm = S::splat(LOGARITHM[5]);
    for &coefficient in LOGARITHM[..5].iter().rev() {
        logarithm = logarithm.multiply_add(beyond, S::splat(coefficient));
    }
    let power = (x.binary_exponent() + logarithm) * S::splat(exponent);
    let whole = nearest_integer(power);
    let part = power - whole;
    let mut value = S::splat(POWER[4]);
    for &coefficient in POWER[..4].iter().rev() {
        value = value.multiply_add(part, S::splat(coefficient));
    }
    S::select(x.less_equal(S::zero()), S::zero(), value * whole.power_of_two())
}

/// The widest range of units of time, in exponents of two: their cubes still are numbers.
const WIDEST: i32 = 300;

/// The power of two that is at most the size of a number, or the least or greatest of a wide range.
#[inline(always)]
pub(super) fn power_below<S: Binary>(x: S) -> S {
    x.exponent_part().max(S::splat(power_of_two(-WIDEST))).min(S::splat(power_of_two(WIDEST)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_the_power_to_four_digits() {
        for inverse in [2.0, 6.0, 16.0, 44.0, -16.0] {
            let mut x = 1e-300;
            while x < 1e300 {
                let wrong = rough_power(x, 1.0 / inverse) / x.powf(1.0 / inverse) - 1.0;
                // ln 2 times the error of the logarithm, over two at most, and that of the power.
                assert!(wrong.abs() < 8e-6, "{x:e} to the power of 1/{inverse}: {wrong:e}");
                x *= 1.237;
            }
            assert_eq!(rough_power(0.0, 1.0 / inverse), 0.0);
        }
    }
}
