//! The natural logarithm. Measured: 0.7 units in the last place.

use super::{Functions, fast_sum, fused, quotient};
use crate::numerics::double_double::two_sum;
use crate::numerics::power_of_two::power_of_two;
use core::f64::consts::SQRT_2;

/// ln 2 to 42 bits, so that its product with an exponent is exact, and the rest.
const LN2_HIGH: f64 = 0.693_147_180_559_890_3;
const LN2_LOW: f64 = 5.497_923_018_708_371e-14;
/// 2/(2k + 3): artanh without its leading term. With s ≤ 0.1716 what is left out is below 2^-62.
const ARTANH: [f64; 11] = [
    2.0 / 3.0,
    2.0 / 5.0,
    2.0 / 7.0,
    2.0 / 9.0,
    2.0 / 11.0,
    2.0 / 13.0,
    2.0 / 15.0,
    2.0 / 17.0,
    2.0 / 19.0,
    2.0 / 21.0,
    2.0 / 23.0,
];

/// ln of (x + low) as a number and what it leaves out, of positive normal x and |low| far below it.
#[inline(always)]
pub(super) fn parts<S: Functions>(x: S, low: S) -> (S, S) {
    let (m, k) = (x.significand(), x.binary_exponent());
    let large = S::splat(SQRT_2).less(m);
    let m = S::select(large, m * S::splat(0.5), m);
    let k = S::select(large, k + S::one(), k);
    // What is left out goes along with the significand; it is relative to x.
    let low = low / x * m;
    // s = (m − 1)/(m + 1); the difference is exact.
    let f = m - S::one();
    let below = two_sum(S::splat(2.0), f);
    let (s, s_low) = quotient((f, low), (below.0, below.1 + low));
    let z = s * s;
    // ln m = 2 s + s³ (2/3 + …)
    let series = (s * z) * fused(z, &ARTANH);
    let twice = s + s;
    let (head, rest) = two_sum(k * S::splat(LN2_HIGH), twice);
    fast_sum(head, rest + (series + (s_low + s_low + k * S::splat(LN2_LOW))))
}

/// ln x; −∞ of 0, NaN below.
#[inline(always)]
pub fn ln<S: Functions>(x: S) -> S {
    let small = x.less(S::splat(f64::MIN_POSITIVE));
    let normal = S::select(small, x * S::splat(power_of_two(54)), x);
    let (high, low) = parts(normal, S::zero());
    let value = high + low;
    let shift = S::splat(54.0);
    // The exponent that was put on is taken off again, with the same two parts of ln 2.
    let value = S::select(small, (value - shift * S::splat(LN2_HIGH)) - shift * S::splat(LN2_LOW), value);
    let infinity = S::splat(f64::INFINITY);
    let value = S::select(infinity.less_equal(x), x, value);
    let value = S::select(x.less_equal(S::zero()), -infinity, value);
    let value = S::select(x.less(S::zero()), S::splat(f64::NAN), value);
    // A NaN is no number of any kind.
    S::select(x.less_equal(x), value, x)
}
