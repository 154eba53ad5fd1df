//! `s^(-3/2)`: the weight of an inverse-square pull, from the squared distance `s`; and its rough beginning.
//!
//! The one idea: no square root and no division, whose units are the bottleneck of every gravity kernel, but
//! a guess from the bits of `s` and two corrections. `y` is 1/√s to 17 bits, so y² and y³ are exact; what is
//! wrong with it, e = 1 - s·y², is then known to 1e-21 from one fused operation, and
//! `s^(-3/2) = y³·(1 - e)^(-3/2)`. The one rounding that counts is the last: the result is the nearest number,
//! but for one case in thousands (measured: within 0.501 units in the last place).
//!
//! Nothing but IEEE operations, fused ones included: the same bits on every machine. For `s` beyond
//! 1e±205, where the result leaves the range of numbers, it is 0, infinite or NaN.

use super::binary::Binary;
use super::double_double::DoubleDouble;
use super::lanes::Lanes;
#[cfg(target_arch = "x86_64")]
use super::lanes::{Avx2, Avx512};
use super::real::{Real, each};
use super::rough_power::{power_below, rough_power};

/// Cutting off the bits of `y` makes it smaller by up to 2^-16: half of that beforehand centres the error.
const CENTRE: f64 = 1.0 + 1.0 / 131_072.0;

/// The best cubic for (1 - e)^(-1/2) where the guess leaves e, from -0.0692 to 0.0676 (Remez; error 7.5e-7).
const INVERSE_ROOT: [f64; 4] = [
    0.999_999_253_625_072_6 * CENTRE,
    0.500_000_423_485_519 * CENTRE,
    0.376_279_010_074_042_7 * CENTRE,
    0.313_054_047_425_769_9 * CENTRE,
];

/// The first half of [`InverseCube::inverse_cubes`]: 1/√s, cut off after 17 bits.
#[inline(always)]
pub(crate) fn inverse_roots<S: Binary, const N: usize>(s: [S; N]) -> [S; N] {
    if S::APART && N > 1 {
        return each!(i < N => root_apart(s[i]));
    }
    let one = S::one();
    let [c0, c1, c2, c3] = INVERSE_ROOT;
    // Not `map`, which may be compiled without the tier's instructions.
    let (c0, c1, c2, c3) = (S::splat(c0), S::splat(c1), S::splat(c2), S::splat(c3));
    let guess = each!(i < N => s[i].inverse_root_guess());
    let product = each!(i < N => s[i] * guess[i]);
    let e = each!(i < N => product[i].multiply_subtract_from(guess[i], one));
    let cubic = each!(i < N => e[i].multiply_add(c3, c2));
    let cubic = each!(i < N => e[i].multiply_add(cubic[i], c1));
    let cubic = each!(i < N => e[i].multiply_add(cubic[i], c0));
    each!(i < N => (guess[i] * cubic[i]).leading_bits())
}

/// The second half: `s^(-3/2)` from `s` and its [`inverse_roots`] `y`, and exactly 0 from `s = y = 0`.
#[inline(always)]
pub(crate) fn inverse_cubes_from<S: Binary, const N: usize>(s: [S; N], y: [S; N]) -> [S; N] {
    if S::APART && N > 1 {
        return each!(i < N => cube_apart(s[i], y[i]));
    }
    let one = S::one();
    let square = each!(i < N => y[i] * y[i]);
    let e = each!(i < N => s[i].multiply_subtract_from(square[i], one));
    let cube = each!(i < N => square[i] * y[i]);
    // (1 - e)^(-3/2) - 1 = e(3/2 + e(15/8 + e·35/16)) to 2e-19, e being below 1.7e-5.
    let series = each!(i < N => e[i].multiply_add(S::splat(35.0 / 16.0), S::splat(15.0 / 8.0)));
    let part = each!(i < N => e[i] * cube[i]);
    let series = each!(i < N => e[i].multiply_add(series[i], S::splat(1.5)));
    each!(i < N => part[i].multiply_add(series[i], cube[i]))
}

#[inline(never)]
fn root_apart<S: Binary>(s: S) -> S {
    let [root] = inverse_roots([s]);
    root
}

#[inline(never)]
fn cube_apart<S: Binary>(s: S, y: S) -> S {
    let [cube] = inverse_cubes_from([s], [y]);
    cube
}

/// Scalars that have the power -3/2.
pub trait InverseCube: Real {
    /// `s^(-3/2)` of several positive `s`, faster together than one by one.
    fn inverse_cubes<const N: usize>(s: [Self; N]) -> [Self; N];
    /// `self^(-3/2)`, for positive `self`.
    #[inline(always)]
    fn inverse_cube(self) -> Self {
        let [cube] = Self::inverse_cubes([self]);
        cube
    }
    /// `1/√self` to 17 bits, for positive `self`, and something finite for 0: for deciding, not for results.
    fn rough_inverse_root(self) -> Self;
    /// `self^exponent` to four digits, for positive normal `self` and an exponent of at most 1/2 in size, and 0 of 0: for
    /// deciding.
    fn rough_power(self, exponent: f64) -> Self;
    /// The power of two that is at most the size of a number, or the least or greatest of a wide range.
    #[must_use]
    fn power_below(self) -> Self;
}

macro_rules! binary {
    ($($type:ty)+) => {$(
        impl InverseCube for $type {
            #[inline(always)]
            fn inverse_cubes<const N: usize>(s: [Self; N]) -> [Self; N] {
                inverse_cubes_from(s, inverse_roots(s))
            }
            #[inline(always)]
            fn rough_inverse_root(self) -> Self {
                let [root] = inverse_roots([self]);
                root
            }
            #[inline(always)]
            fn rough_power(self, exponent: f64) -> Self {
                rough_power(self, exponent)
            }
            #[inline(always)]
            fn power_below(self) -> Self {
                power_below(self)
            }
        }
    )+};
}
binary!(f64 Lanes);
#[cfg(target_arch = "x86_64")]
binary!(Avx2 Avx512);

impl InverseCube for DoubleDouble {
    fn inverse_cubes<const N: usize>(s: [Self; N]) -> [Self; N] {
        s.map(|s| Self::one() / (s * s.sqrt()))
    }
    fn rough_inverse_root(self) -> Self {
        Self::from(self.to_f64().rough_inverse_root())
    }
    fn rough_power(self, exponent: f64) -> Self {
        Self::from(self.to_f64().rough_power(exponent))
    }
    fn power_below(self) -> Self {
        Self::from(self.to_f64().power_below())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// In units in the last place of the result.
    fn error(s: f64) -> f64 {
        let exact = DoubleDouble::from(s).inverse_cube();
        let value = s.inverse_cube();
        let ulp = value.to_bits() + 1;
        ((DoubleDouble::from(value) - exact).to_f64() / (f64::from_bits(ulp) - value)).abs()
    }

    /// A sixteenth of a percent apart over two powers of four, on which everything but the exponent depends.
    #[test]
    fn is_the_nearest_number_all_but_always() {
        let mut largest = 0.0_f64;
        let mut s = 1.0;
        while s < 16.0 {
            largest = largest.max(error(s));
            s *= 1.000_017_3;
        }
        assert!(largest < 0.501, "{largest}");
    }

    #[test]
    fn powers_of_four_are_exact() {
        for k in -300..=300 {
            assert_eq!(2.0_f64.powi(2 * k).inverse_cube(), 2.0_f64.powi(-3 * k), "4^{k}");
        }
    }

    #[test]
    fn a_vanishing_distance_gives_no_number() {
        for s in [0.0, 5e-324, 1e-310, 1e-206, f64::NAN] {
            assert!(!s.inverse_cube().is_finite(), "{s}");
        }
        assert_eq!(1e300.inverse_cube(), 0.0);
        assert!(0.0.rough_inverse_root().is_finite());
    }

    proptest! {
        #[test]
        fn holds_over_the_exponents(mantissa in 1.0..2.0f64, exponent in -600..600i32) {
            let s = mantissa * 2.0_f64.powi(exponent);
            prop_assert!(error(s) < 0.501);
            prop_assert!((s.rough_inverse_root() * s.sqrt() - 1.0).abs() < 2e-5);
        }
    }
}
