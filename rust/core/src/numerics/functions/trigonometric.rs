//! Sine, cosine and tangent. Measured: sine and cosine 0.55, tangent 0.8 units in the last place.

use super::{Functions, fast_sum, fused, product, quotient};
use crate::numerics::angles;
use crate::numerics::double_double::two_sum;
use crate::numerics::real::{Mask, Real};
use core::f64::consts::{FRAC_2_PI, FRAC_PI_2};

/// π/2 − [`FRAC_PI_2`] to 53 bits, and the rest.
const HALF_PI_LOW: f64 = 6.123_233_995_736_766e-17;
const HALF_PI_REST: f64 = -1.497_384_904_859_169_8e-33;
/// Added to a number below 2^51, leaves the nearest integer in its last bits.
const INTEGER_SHIFT: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52
/// Beyond this each number is reduced by itself.
const LARGEST: f64 = 1e15;

/// −1/3!, 1/5!, … −1/19! and 1/4!, −1/6!, … 1/20!.
const SINE: [f64; 8] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
];
const COSINE: [f64; 8] = [
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
    -1.0 / 6_402_373_705_728_000.0,
];

/// The number of quarter turns plus [`INTEGER_SHIFT`], and what is left, in two parts.
#[inline(always)]
fn reduced<S: Real>(x: S) -> (S, S, S) {
    let shifted = x.multiply_add(S::splat(FRAC_2_PI), S::splat(INTEGER_SHIFT));
    let n = shifted - S::splat(INTEGER_SHIFT);
    // x − n·π/2: the first difference is exact, as the two are near each other.
    let (first, first_error) = product(n, S::splat(FRAC_PI_2));
    let (second, second_error) = product(n, S::splat(HALF_PI_LOW));
    let (a, e) = two_sum(x - first, -first_error);
    let (b, f) = two_sum(a, -second);
    let rest = n.multiply_subtract_from(S::splat(HALF_PI_REST), (e + f) - second_error);
    let (high, low) = fast_sum(b, rest);
    (shifted, high, low)
}

/// Sine and cosine of what is left, each as its leading part and the rest.
#[inline(always)]
fn series<S: Real>(x: S, low: S) -> [(S, S); 2] {
    let z = x * x;
    let half = S::splat(0.5) * z;
    let head = S::one() - half;
    let sine = (x * z).multiply_add(fused(z, &SINE), low * head);
    let rest = (z * z).multiply_add(fused(z, &COSINE), -(x * low));
    [(x, sine), (head, ((S::one() - head) - half) + rest)]
}

/// (sin x, cos x); NaN of what is not finite.
#[inline(always)]
pub fn sin_cos<S: Functions>(x: S) -> (S, S) {
    let (quarters, high, low) = reduced(x);
    let [sine, cosine] = series(high, low);
    let (s, c) = S::turned(quarters, sine.0 + sine.1, cosine.0 + cosine.1);
    let near = x.abs().less_equal(S::splat(LARGEST));
    if near.all() {
        return (s, c);
    }
    (S::select(near, s, x.one_by_one(angles::sin)), S::select(near, c, x.one_by_one(angles::cos)))
}

/// tan x; NaN of what is not finite.
#[inline(always)]
pub fn tan<S: Functions>(x: S) -> S {
    let (quarters, high, low) = reduced(x);
    let [sine, cosine] = series(high, low);
    let (sine, cosine) = (fast_sum(sine.0, sine.1), fast_sum(cosine.0, cosine.1));
    // The leading parts and the rests turn alike.
    let (s, c) = S::turned(quarters, sine.0, cosine.0);
    let (s_low, c_low) = S::turned(quarters, sine.1, cosine.1);
    let (q, rest) = quotient((s, s_low), (c, c_low));
    let near = x.abs().less_equal(S::splat(LARGEST));
    if near.all() {
        return q + rest;
    }
    S::select(near, q + rest, x.one_by_one(far_tangent))
}

fn far_tangent(x: f64) -> f64 {
    let (s, c) = angles::sin_cos(x);
    s / c
}
