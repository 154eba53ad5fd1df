//! The cosine in every lane, of an argument with about twice the digits.
//!
//! The one idea: reduce by π/2 carried to 160 bits with error-free products and sums, then a Taylor series; correctly
//! rounded `+ - *` and fused operations in a written order, so every tier has the bits of `f64`. The argument is an
//! unevaluated sum, since that of a driven force is frequency times time, whose rounding alone would cost all digits
//! at 10^15 rad.

use super::double_double::{two_product, two_sum};
use super::real::{Mask, Real};
use core::f64::consts::{FRAC_2_PI, FRAC_PI_2};

/// π/2 − [`FRAC_PI_2`] to 53 bits, and the rest.
const HALF_PI_LOW: f64 = 6.123_233_995_736_766e-17;
const HALF_PI_REST: f64 = -1.497_384_904_859_169_8e-33;
/// Added to a number below 2^51, leaves the nearest integer after it is taken away again.
const INTEGER_SHIFT: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52
/// The largest argument: its multiple of π/2 is below 2^51.
pub const LARGEST: f64 = 3.5e15;

/// −1/3!, 1/5!, … −1/19! and 1/4!, −1/6!, … 1/20!, last first.
const SINE: [f64; 8] = [
    1.0 / 355_687_428_096_000.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 39_916_800.0,
    1.0 / 362_880.0,
    -1.0 / 5_040.0,
    1.0 / 120.0,
    -1.0 / 6.0,
];
const COSINE: [f64; 8] = [
    -1.0 / 6_402_373_705_728_000.0,
    1.0 / 20_922_789_888_000.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 479_001_600.0,
    -1.0 / 3_628_800.0,
    1.0 / 40_320.0,
    -1.0 / 720.0,
    1.0 / 24.0,
];

#[inline(always)]
fn nearest_integer<S: Real>(x: S) -> S {
    (x + S::splat(INTEGER_SHIFT)) - S::splat(INTEGER_SHIFT)
}

#[inline(always)]
fn series<S: Real>(z: S, coefficients: &[f64; 8]) -> S {
    let mut sum = S::splat(coefficients[0]);
    for index in 1..8 {
        sum = sum * z + S::splat(coefficients[index]);
    }
    sum
}

/// cos(high + low) to 1 unit in the last place, for |low| far below |high| ≤ 3.5e15; NaN beyond and of NaN.
#[inline(always)]
pub fn cosine<S: Real>(high: S, low: S) -> S {
    let n = nearest_integer(high * S::splat(FRAC_2_PI));
    // high − n·π/2: the first difference is exact, as the two are near each other.
    let (first, first_error) = two_product(n, S::splat(FRAC_PI_2));
    let (second, second_error) = two_product(n, S::splat(HALF_PI_LOW));
    let (x, e) = two_sum(high - first, -first_error);
    let (x, f) = two_sum(x, -second);
    let rest = ((e + f) - second_error) + (low - n * S::splat(HALF_PI_REST));
    let (x, low) = two_sum(x, rest);

    let z = x * x;
    let sine = x + (x * (z * series(z, &SINE)) + low * (S::one() - S::splat(0.5) * z));
    // What 1 − x²/2 rounds away is added back.
    let half = S::splat(0.5) * z;
    let head = S::one() - half;
    let cosine = head + (((S::one() - head) - half) + (z * z * series(z, &COSINE) - x * low));

    // The quarter, −2 … 2.
    let quarter = n - S::splat(4.0) * nearest_integer(n * S::splat(0.25));
    let size = quarter.abs();
    let odd = S::splat(0.5).less(size).and(size.less(S::splat(1.5)));
    let value = S::select(odd, sine, cosine);
    // cos(x + π/2) = −sin x, cos(x ± π) = −cos x, cos(x − π/2) = sin x.
    let changed = S::splat(0.5).less(quarter).or(S::splat(1.5).less(size));
    let value = S::select(changed, -value, value);
    S::select(high.abs().less_equal(S::splat(LARGEST)), value, S::splat(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::angles;
    use crate::numerics::lanes::{Lanes, Vector8};
    use crate::tiered;
    use proptest::prelude::*;

    #[inline(always)]
    fn lanes<V: Vector8>(high: Lanes, low: Lanes) -> Lanes {
        cosine(V::load(high), V::load(low)).store()
    }
    tiered! {
        fn tier[][](high: Lanes, low: Lanes) -> Lanes = lanes;
    }

    proptest! {
        /// Against the scalar cosine, itself within 0.77 ulp: 2 ulp of the larger of the two apart at most.
        #[test]
        fn it_is_the_cosine(x in -1e6..1e6f64) {
            let (here, there) = (cosine(x, 0.0), angles::cos(x));
            prop_assert!((here - there).abs() <= 2.0 * f64::EPSILON * there.abs(), "{x}: {here} {there}");
        }
        /// Whole turns added to the argument, whose product with 2π has its own low part, change the result by what the
        /// low part leaves out: 10^15 · 2^-106 rad.
        #[test]
        fn whole_turns_change_little(x in -3.0..3.0f64, turns in 1.0..1e14f64) {
            let turns = 4.0 * turns.round();
            let (first, error) = two_product(turns, FRAC_PI_2);
            let (high, rest) = two_sum(first, x);
            let low = rest + (error + (turns * HALF_PI_LOW));
            prop_assert!((cosine(high, low) - angles::cos(x)).abs() <= 3e-16, "{}", high);
        }
        #[test]
        fn every_lane_of_every_tier_has_the_bits_of_one_number(
            high in prop::array::uniform8(-1e15..1e15f64), low in prop::array::uniform8(-1e-3..1e-3f64)
        ) {
            let tiered = tier(Lanes(high), Lanes(low));
            for lane in 0..8 {
                prop_assert_eq!(tiered.0[lane].to_bits(), cosine(high[lane], low[lane]).to_bits());
            }
        }
    }

    #[test]
    fn known_values() {
        assert_eq!(cosine(0.0, 0.0), 1.0);
        // mpmath, 60 digits.
        assert!((cosine(1e15, 0.0) - -0.513_193_737_786_970_2).abs() <= 2e-16);
        assert!(
            cosine(1e16, 0.0).is_nan()
                && cosine(f64::INFINITY, 0.0).is_nan()
                && cosine(f64::NAN, 0.0).is_nan()
        );
    }
}
