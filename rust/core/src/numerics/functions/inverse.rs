//! Inverse functions. Measured: 0.8 units in the last place, angles of points 0.6; the hyperbolic ones 1.0.

use super::logarithm::parts;
use super::{Functions, fast_sum, fused, product, quotient};
use crate::numerics::double_double::two_sum;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

const HALF_PI_LOW: f64 = 6.123_233_995_736_766e-17;
/// tan π/8 and tan 3π/8, about: between them angles are counted from π/4.
const LOW_TANGENT: f64 = 0.414_213_562_373_095_05;
const HIGH_TANGENT: f64 = 2.414_213_562_373_095;
/// 2⁵⁰⁰, and what brings numbers beyond it back.
const HUGE: f64 = f64::from_bits((1023 + 500) << 52);
const SHRINK: f64 = f64::from_bits((1023 - 600) << 52);

/// (−1)^k/(2k + 1), k from 1: with a tangent below 0.4143 what is left out is below 2^-62.
const ATAN: [f64; 22] = [
    -1.0 / 3.0,
    1.0 / 5.0,
    -1.0 / 7.0,
    1.0 / 9.0,
    -1.0 / 11.0,
    1.0 / 13.0,
    -1.0 / 15.0,
    1.0 / 17.0,
    -1.0 / 19.0,
    1.0 / 21.0,
    -1.0 / 23.0,
    1.0 / 25.0,
    -1.0 / 27.0,
    1.0 / 29.0,
    -1.0 / 31.0,
    1.0 / 33.0,
    -1.0 / 35.0,
    1.0 / 37.0,
    -1.0 / 39.0,
    1.0 / 41.0,
    -1.0 / 43.0,
    1.0 / 45.0,
];
/// (2k)!/(4^k k!² (2k + 1)), k from 1.
const ASIN: [f64; 25] = [
    0.166_666_666_666_666_66,
    0.075,
    0.044_642_857_142_857_144,
    0.030_381_944_444_444_444,
    0.022_372_159_090_909_092,
    0.017_352_764_423_076_924,
    0.013_964_843_75,
    0.011_551_800_896_139_705,
    0.009_761_609_529_194_078,
    0.008_390_335_809_616_815,
    0.007_312_525_873_598_845_4,
    0.006_447_210_311_889_649,
    0.005_740_037_670_841_924,
    0.005_153_309_682_319_905,
    0.004_660_143_486_915_096,
    0.004_240_907_093_679_363,
    0.003_880_964_558_837_669,
    0.003_569_205_393_825_934_7,
    0.003_297_059_503_473_485,
    0.003_057_821_649_258_030_6,
    0.002_846_178_401_108_942,
    0.002_657_870_638_207_29,
    0.002_489_448_678_246_883_6,
    0.002_338_091_892_111_975,
    0.002_201_473_973_710_138_4,
];

/// atan x.
#[inline(always)]
pub fn atan<S: Functions>(x: S) -> S {
    let size = x.abs();
    let (one, zero) = (S::one(), S::zero());
    let (small, large) = (size.less(S::splat(LOW_TANGENT)), S::splat(HIGH_TANGENT).less(size));
    let (up, up_low) = two_sum(size, -one);
    let (down, down_low) = two_sum(size, one);
    let above = S::select(small, size, S::select(large, -one, up));
    let above_low = S::select(small, zero, S::select(large, zero, up_low));
    let below = S::select(small, one, S::select(large, size, down));
    let below_low = S::select(small, zero, S::select(large, zero, down_low));
    let (u, u_low) = quotient((above, above_low), (below, below_low));
    let base = S::select(small, zero, S::splat(FRAC_PI_4));
    let base = S::select(large, S::splat(FRAC_PI_2), base);
    let base_low = base * S::splat(HALF_PI_LOW / FRAC_PI_2);
    let value = turned_by((base, base_low), (u, u_low));
    let infinite = S::splat(f64::INFINITY).less_equal(size);
    let value = S::select(infinite, S::splat(FRAC_PI_2), value);
    let signed = S::select(x.less(zero), -value, value);
    let tiny = size.less(S::splat(1e-9));
    S::select(tiny, x, S::select(x.less_equal(x), signed, x))
}

/// base + atan u, of a small u.
#[inline(always)]
fn turned_by<S: Functions>((base, base_low): (S, S), (u, u_low): (S, S)) -> S {
    let z = u * u;
    let rest = (u * z).multiply_add(fused(z, &ATAN), u_low.multiply_subtract_from(z, u_low) + base_low);
    let (head, low) = two_sum(base, u);
    head + (low + rest)
}

/// The angle of the point (x, y) from the positive x-axis, −π … π; at ±0 over a negative x it is π. NaN at the origin and of
/// infinite numbers.
#[inline(always)]
pub fn atan2<S: Functions>(y: S, x: S) -> S {
    let (zero, one) = (S::zero(), S::one());
    let (height, width) = (y.abs(), x.abs());
    // Sums and what quotients leave out neither overflow nor underflow at a size of about one.
    let most = S::select(width.less(height), height, width);
    let scale = S::select(S::splat(HUGE).less(most), S::splat(SHRINK), one);
    let scale = S::select(most.less(S::splat(1.0 / HUGE)), S::splat(1.0 / SHRINK), scale);
    let (height, width) = (height * scale, width * scale);
    let small = height.less(S::splat(LOW_TANGENT) * width);
    let large = (S::splat(HIGH_TANGENT) * width).less(height);
    let (up, up_low) = two_sum(height, -width);
    let (down, down_low) = two_sum(height, width);
    let above = S::select(small, height, S::select(large, -width, up));
    let above_low = S::select(small, zero, S::select(large, zero, up_low));
    let below = S::select(small, width, S::select(large, height, down));
    let below_low = S::select(small, zero, S::select(large, zero, down_low));
    let (u, u_low) = quotient((above, above_low), (below, below_low));
    let eighths = S::select(small, zero, S::select(large, S::splat(2.0), one));
    let backward = x.less(zero);
    let eighths = S::select(backward, S::splat(4.0) - eighths, eighths);
    let (u, u_low) = (S::select(backward, -u, u), S::select(backward, -u_low, u_low));
    let base = eighths * S::splat(FRAC_PI_4);
    let base_low = eighths.multiply_add(S::splat(FRAC_PI_4), -base) + eighths * S::splat(0.5 * HALF_PI_LOW);
    let value = turned_by((base, base_low), (u, u_low));
    S::select(y.less(zero), -value, value)
}

/// asin of x + low in 0 … 1/2, as a number and what it leaves out.
#[inline(always)]
fn arcsine<S: Functions>(x: S, low: S) -> (S, S) {
    let z = x * x;
    // d asin = dx/√(1 − x²), about 1 + x²/2.
    let rest = (x * z).multiply_add(fused(z, &ASIN), (z * S::splat(0.5)).multiply_add(low, low));
    fast_sum(x, rest)
}

/// asin of √((1 − |x|)/2), as a number and what it leaves out: half the angle from the end.
#[inline(always)]
fn half_angle<S: Functions>(size: S) -> (S, S) {
    let w = (S::one() - size) * S::splat(0.5);
    let s = w.sqrt();
    let (square, error) = product(s, s);
    let low = ((w - square) - error) / (s + s).max(S::splat(f64::MIN_POSITIVE));
    arcsine(s, low)
}

/// asin x; NaN beyond ±1.
#[inline(always)]
pub fn asin<S: Functions>(x: S) -> S {
    let size = x.abs();
    let middle = size.less_equal(S::splat(0.5));
    let (near, near_low) = arcsine(size.min(S::splat(0.5)), S::zero());
    let (end, end_low) = half_angle(size);
    // π/2 − 2 asin √((1 − x)/2)
    let (head, rest) = fast_sum(S::splat(FRAC_PI_2), -(end + end));
    let far = head + (rest + (S::splat(HALF_PI_LOW) - (end_low + end_low)));
    let value = S::select(middle, near + near_low, far);
    let signed = S::select(x.less(S::zero()), -value, value);
    let tiny = size.less(S::splat(1e-9));
    outside(size, S::select(tiny, x, signed))
}

/// acos x; NaN beyond ±1.
#[inline(always)]
pub fn acos<S: Functions>(x: S) -> S {
    let size = x.abs();
    let negative = x.less(S::zero());
    let (near, near_low) = arcsine(size.min(S::splat(0.5)), S::zero());
    let (near, near_low) = (S::select(negative, -near, near), S::select(negative, -near_low, near_low));
    let (head, rest) = two_sum(S::splat(FRAC_PI_2), -near);
    let middle = head + (rest + (S::splat(HALF_PI_LOW) - near_low));
    let (end, end_low) = half_angle(size);
    let (end, end_low) = (end + end, end_low + end_low);
    let (head, rest) = fast_sum(S::splat(PI), -end);
    let back = head + (rest + (S::splat(2.0 * HALF_PI_LOW) - end_low));
    let far = S::select(negative, back, end + end_low);
    outside(size, S::select(size.less_equal(S::splat(0.5)), middle, far))
}

/// NaN where the argument's size is above 1 or none.
#[inline(always)]
fn outside<S: Functions>(size: S, value: S) -> S {
    S::select(size.less_equal(S::one()), value, S::splat(f64::NAN))
}

/// ln(1 + y + low) of y ≥ 0.
#[inline(always)]
fn logarithm_beside_one<S: Functions>(y: S, low: S) -> S {
    let (sum, error) = two_sum(S::one(), y);
    let (value, rest) = parts(sum, error + low);
    value + rest
}

/// asinh x.
#[inline(always)]
pub fn asinh<S: Functions>(x: S) -> S {
    let size = x.abs();
    let far = S::splat(1e8).less(size);
    let bounded = size.min(S::splat(1e8));
    // x + x²/(1 + √(1 + x²))
    let (square, square_low) = product(bounded, bounded);
    let (inside, inside_low) = two_sum(S::one(), square);
    let root = inside.sqrt();
    let root_low = (root.multiply_subtract_from(root, inside) + (inside_low + square_low)) / (root + root);
    let (below, below_low) = two_sum(S::one(), root);
    let (q, q_low) = quotient((square, square_low), (below, below_low + root_low));
    let (y, y_low) = two_sum(bounded, q);
    let near = logarithm_beside_one(y, y_low + q_low);
    let (log, log_low) = parts(size.max(S::one()), S::zero());
    let large = (log + S::splat(core::f64::consts::LN_2)) + log_low;
    let value = S::select(far, large, near);
    let signed = S::select(x.less(S::zero()), -value, value);
    let tiny = size.less(S::splat(1e-9));
    let infinite = S::splat(f64::INFINITY).less_equal(size);
    let plain = S::select(infinite, x, signed);
    S::select(tiny, x, S::select(x.less_equal(x), plain, x))
}

/// acosh x; NaN below 1.
#[inline(always)]
pub fn acosh<S: Functions>(x: S) -> S {
    let far = S::splat(1e8).less(x);
    let bounded = x.min(S::splat(1e8)).max(S::one());
    // t + √(2t + t²), t = x − 1
    let t = bounded - S::one();
    let (square, square_low) = product(t, t);
    let (inside, inside_low) = two_sum(t + t, square);
    let root = inside.sqrt();
    let root_low = (root.multiply_subtract_from(root, inside) + (inside_low + square_low))
        / (root + root).max(S::splat(f64::MIN_POSITIVE));
    let (y, y_low) = two_sum(root, t);
    let near = logarithm_beside_one(y, y_low + root_low);
    let (log, log_low) = parts(x.max(S::one()), S::zero());
    let large = (log + S::splat(core::f64::consts::LN_2)) + log_low;
    let value = S::select(far, large, near);
    let value = S::select(S::splat(f64::INFINITY).less_equal(x), x, value);
    S::select(S::one().less_equal(x), value, S::splat(f64::NAN))
}

/// atanh x; ±∞ at ±1, NaN beyond.
#[inline(always)]
pub fn atanh<S: Functions>(x: S) -> S {
    let size = x.abs();
    // ½ ln(1 + 2x/(1 − x))
    let bounded = size.min(S::splat(1.0 - f64::EPSILON / 2.0));
    let (below, below_low) = two_sum(S::one(), -bounded);
    let (y, y_low) = quotient((bounded + bounded, S::zero()), (below, below_low));
    let value = S::splat(0.5) * logarithm_beside_one(y, y_low);
    let value = S::select(S::one().less_equal(size), S::splat(f64::INFINITY), value);
    let signed = S::select(x.less(S::zero()), -value, value);
    let tiny = size.less(S::splat(1e-9));
    outside(size, S::select(tiny, x, signed))
}
