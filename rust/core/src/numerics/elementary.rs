//! Exponential, logarithm and cube root with the same bits on every machine; the exponential in every lane too.
//!
//! The one idea: a fixed sequence of correctly rounded `+ - * /` and exact exponent moves, written
//! once over [`Binary`] scalars, so `f64` and every SIMD tier agree bit for bit; no platform libm,
//! no fused multiply-add.
//! Method: argument reduction with a split constant (Cody & Waite, *Software Manual for the
//! Elementary Functions*, 1980), then a polynomial.

use super::binary::Binary;
use super::double_double::DoubleDouble;
use super::lanes::Lanes;
use super::power_of_two::{exponent, scale};
use super::real::{Real, each};
use super::stumpff::INVERSE_FACTORIALS;

#[cfg(target_arch = "x86_64")]
use super::lanes::{Avx2, Avx512};

/// Added to an integer n, |n| < 2^51, leaves n in the low bits of the sum.
pub(super) const INTEGER_SHIFT: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52

/// Σ cᵢ xⁱ, even and odd powers in two chains (half the latency of Horner's rule).
#[inline(always)]
pub(super) fn polynomial<S: Real, const N: usize>(x: S, coefficients: &[f64; N]) -> S {
    let square = x * x;
    // No closures, which may be compiled without the tier's instructions.
    let mut chains = [S::zero(); 2];
    let mut index = N;
    while index > 0 {
        index -= 1;
        chains[index % 2] = chains[index % 2] * square + S::splat(coefficients[index]);
    }
    chains[0] + x * chains[1]
}

/// The nearest integer, for |x| < 2^51.
#[inline(always)]
pub(super) fn nearest_integer<S: Real>(x: S) -> S {
    (x + S::splat(INTEGER_SHIFT)) - S::splat(INTEGER_SHIFT)
}

/// ln 2 to 42 bits, so that its product with an exponent is exact …
const LN2_HIGH: f64 = 0.693_147_180_559_890_3;
/// … and the rest.
const LN2_LOW: f64 = 5.497_923_018_708_371e-14;

/// 1/(k+2)!: the Taylor series of (eʳ - 1 - r)/r². The first term left out, r¹⁴/14!, is below
/// 5e-18 for |r| ≤ ln 2 / 2.
pub(super) const EXPONENTIAL: [f64; 12] = [
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// The exponential function; use [`Exponential::exp`].
#[inline(always)]
fn exponential<S: Binary>(x: S) -> S {
    // Beyond these the result is 0 or infinity, and the exponent fits two factors 2ⁿ.
    let clamped = x.max(S::splat(-746.0)).min(S::splat(710.0));
    let n = nearest_integer(clamped * S::splat(core::f64::consts::LOG2_E));
    // x - n·ln 2 in two parts: `high` is exact, `r + rest` carries the rounding of the second step.
    let high = clamped - n * S::splat(LN2_HIGH);
    let low = n * S::splat(LN2_LOW);
    let r = high - low;
    let rest = (high - r) - low;
    let value = S::one() + (r + (r * r * polynomial(r, &EXPONENTIAL) + (rest + rest * r)));
    // In two steps, so that 2ⁿ itself need be neither subnormal nor infinite.
    let half = nearest_integer(n * S::splat(0.5));
    let scaled = value * half.power_of_two() * (n - half).power_of_two();
    // `max` and `min` lose a NaN: give it back.
    S::select(x.less_equal(x), scaled, x)
}

/// (e⁻ˢ − 1 + s)/s² for |s| ≤ ln 2/2, through the zeros of Chebyshev's polynomial: what it makes of e⁻ˢ errs by less than
/// 1.7e-17.
const FALLING: [f64; 10] = [
    0.500_000_000_000_000_1,
    -0.166_666_666_666_666_69,
    0.041_666_666_666_624_13,
    -0.008_333_333_333_330_062,
    0.001_388_888_891_721_371_7,
    -0.000_198_412_698_630_536_18,
    2.480_152_129_595_437_6e-5,
    -2.755_726_845_999_706_4e-6,
    2.762_008_844_540_974_6e-7,
    -2.510_038_549_551_032e-8,
];
/// The rest of ln 2 after the nearest number.
const LN2_REST: f64 = 2.319_046_813_846_299_6e-17;
/// Up to here e⁻ˣ is a normal number.
const NORMAL: f64 = 708.0;

/// Several e⁻ˣ side by side, of x that are not negative; use [`Exponential::falling_exps`].
#[inline(always)]
fn falling<S: Binary, const N: usize>(x: [S; N]) -> [S; N] {
    let (shift, one) = (S::splat(INTEGER_SHIFT), S::one());
    let clamped = each!(i < N => x[i].min(S::splat(NORMAL)));
    let n =
        each!(i < N => clamped[i].multiply_subtract_from(S::splat(core::f64::consts::LOG2_E), shift) - shift);
    // s = x + n ln 2, n being negative: e⁻ˣ is 2ⁿ e⁻ˢ.
    let s = each!(i < N => n[i].multiply_add(S::splat(core::f64::consts::LN_2), clamped[i]));
    let s = each!(i < N => n[i].multiply_add(S::splat(LN2_REST), s[i]));
    let mut p = [S::splat(FALLING[9]); N];
    for k in (0..9).rev() {
        p = each!(i < N => p[i].multiply_add(s[i], S::splat(FALLING[k])));
    }
    let square = each!(i < N => s[i] * s[i]);
    let less = each!(i < N => square[i].multiply_subtract_from(p[i], s[i]));
    let value = each!(i < N => (one - less[i]) * n[i].power_of_two());
    each!(i < N => S::select(x[i].less_equal(S::splat(NORMAL)), value[i], S::zero()))
}

/// Scalars that have an exponential function.
pub trait Exponential: Real {
    /// eˣ within one unit in the last place wherever the result is normal (measured 0.89) and one
    /// subnormal spacing below; exactly 1 at 0; 0 below -745.14; infinite above 709.79; NaN of NaN.
    /// The bits are those of the `f64` version in every lane of every tier.
    fn exp(self) -> Self;
    /// Several e⁻ˣ, faster together than one by one: of 0 and above, within 1.1 units in the last place (measured 1.00); 0
    /// above 708, where it would be next to subnormal, and of NaN.
    fn falling_exps<const N: usize>(x: [Self; N]) -> [Self; N];
}

impl Exponential for f64 {
    #[inline(always)]
    fn exp(self) -> Self {
        exponential(self)
    }
    #[inline(always)]
    fn falling_exps<const N: usize>(x: [Self; N]) -> [Self; N] {
        falling(x)
    }
}
impl Exponential for Lanes {
    #[cfg_attr(all(target_arch = "x86_64", not(target_feature = "fma")), inline(never))]
    #[cfg_attr(not(all(target_arch = "x86_64", not(target_feature = "fma"))), inline(always))]
    fn exp(self) -> Self {
        exponential(self)
    }
    #[cfg_attr(all(target_arch = "x86_64", not(target_feature = "fma")), inline(never))]
    #[cfg_attr(not(all(target_arch = "x86_64", not(target_feature = "fma"))), inline(always))]
    fn falling_exps<const N: usize>(x: [Self; N]) -> [Self; N] {
        falling(x)
    }
}
#[cfg(target_arch = "x86_64")]
impl Exponential for Avx2 {
    #[inline(always)]
    fn exp(self) -> Self {
        exponential(self)
    }
    #[inline(always)]
    fn falling_exps<const N: usize>(x: [Self; N]) -> [Self; N] {
        falling(x)
    }
}
#[cfg(target_arch = "x86_64")]
impl Exponential for Avx512 {
    #[inline(always)]
    fn exp(self) -> Self {
        exponential(self)
    }
    #[inline(always)]
    fn falling_exps<const N: usize>(x: [Self; N]) -> [Self; N] {
        falling(x)
    }
}
impl Exponential for DoubleDouble {
    fn falling_exps<const N: usize>(x: [Self; N]) -> [Self; N] {
        x.map(|x| (-x).exp())
    }
    /// About 30 digits relative to (1 + |x|); for references.
    fn exp(self) -> Self {
        const LN2: DoubleDouble = DoubleDouble::new(core::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);
        if !(-746.0..=710.0).contains(&self.high()) {
            return Self::from(self.high().exp());
        }
        let n = (self.high() * core::f64::consts::LOG2_E).round();
        // eʸ - 1 of y = r/256 by Taylor (y¹²/12! < 1e-43), then (1 + e)² - 1 = 2e + e² eight times.
        let y = (self - LN2 * Self::from(n)).scale(1.0 / 256.0);
        let mut sum = Self::zero();
        for &coefficient in INVERSE_FACTORIALS[..10].iter().rev() {
            sum = sum * y + coefficient;
        }
        sum = y + y * (y * sum);
        for _ in 0..8 {
            sum = sum.scale(2.0) + sum * sum;
        }
        let half = (n * 0.5).round();
        (sum + Self::one()).scale(half.power_of_two()).scale((n - half).power_of_two())
    }
}

/// The natural logarithm; NaN below 0, −∞ at 0.
pub fn ln(x: f64) -> f64 {
    if x.is_nan() || x < 0.0 {
        return f64::NAN;
    }
    if x == 0.0 {
        return f64::NEG_INFINITY;
    }
    if x.is_infinite() {
        return x;
    }
    let mut k = exponent(x);
    let mut m = scale(x, -k);
    if m > core::f64::consts::SQRT_2 {
        m *= 0.5;
        k += 1;
    }
    // ln(1 + f) = 2 artanh(w), w = f/(2 + f), |w| ≤ 0.1716; written as f - (f²/2 - w(f²/2 + R)).
    let f = m - 1.0;
    let w = f / (2.0 + f);
    let w2 = w * w;
    let mut series = 2.0 / 23.0;
    for odd in [21.0, 19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0] {
        series = series * w2 + 2.0 / odd;
    }
    let half_square = 0.5 * f * f;
    let k = f64::from(k);
    k * LN2_HIGH - ((half_square - (w * (half_square + w2 * series) + k * LN2_LOW)) - f)
}

/// The cube root.
pub fn cbrt(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    let k = exponent(x).div_euclid(3);
    let m = scale(x.abs(), -3 * k); // 1 ≤ m < 8
    // A line, then Halley's iteration, which triples the digits: 7 % → 2e-4 → 1e-11 → below rounding.
    let mut root = 0.85 + 0.165 * m;
    for _ in 0..3 {
        let cube = root * root * root;
        root -= root * (cube - m) / (2.0 * cube + m);
    }
    scale(root, k).copysign(x)
}

#[cfg(test)]
mod tests;
