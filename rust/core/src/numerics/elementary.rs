//! Elementary functions with the same bits on every machine: exponential, arc tangent, sine, cosine.
//!
//! The one idea: a fixed sequence of correctly rounded `+ - * /` and exact exponent moves, written
//! once over [`Binary`] scalars, so `f64` and every SIMD tier agree bit for bit; no platform libm,
//! no fused multiply-add.
//! Method: argument reduction with a split constant (Cody & Waite, *Software Manual for the
//! Elementary Functions*, 1980), then a polynomial.

use super::double_double::DoubleDouble;
use super::lanes::Lanes;
use super::real::{Mask, Real};

#[cfg(target_arch = "x86_64")]
use super::lanes::{Avx2, Avx512};

/// Binary floating point whose exponent field can be reached.
pub trait Binary: Real {
    /// 2ⁿ for integers n from -1022 to 1023; anything else is a broken promise of the caller.
    fn power_of_two(self) -> Self;
    /// (m, n) with x = m·2ⁿ and 1 ≤ m < 2, for positive normal x.
    fn split_exponent(self) -> (Self, Self);
}

/// Added to an integer n, |n| < 2^51, leaves n in the low bits of the sum.
pub(super) const INTEGER_SHIFT: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52
/// As above with the exponent bias, for n > -1023.
pub(super) const BIASED_SHIFT: f64 = 4_503_599_627_370_496.0 + 1023.0; // 2^52 + bias
/// The bits of 2^52: `EXPONENT_SHIFT | e` is the number 2^52 + e.
pub(super) const EXPONENT_SHIFT: u64 = 0x4330_0000_0000_0000;
/// The bits of a significand.
pub(super) const SIGNIFICAND: u64 = 0x000f_ffff_ffff_ffff;
/// The bits of 1.0.
pub(super) const ONE: u64 = 0x3ff0_0000_0000_0000;

impl Binary for f64 {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        f64::from_bits((self + BIASED_SHIFT).to_bits() << 52)
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let bits = self.to_bits();
        let exponent = f64::from_bits(bits >> 52 | EXPONENT_SHIFT) - BIASED_SHIFT;
        (f64::from_bits(bits & SIGNIFICAND | ONE), exponent)
    }
}

impl Binary for Lanes {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        self.map(f64::power_of_two)
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        (self.map(|x| x.split_exponent().0), self.map(|x| x.split_exponent().1))
    }
}

/// Σ cᵢ xⁱ, even and odd powers in two chains (half the latency of Horner's rule).
#[inline(always)]
fn polynomial<S: Real, const N: usize>(x: S, coefficients: &[f64; N]) -> S {
    let square = x * x;
    let chain = |parity: usize| {
        let mut sum = S::zero();
        for index in (0..N).rev().filter(|index| index % 2 == parity) {
            sum = sum * square + S::splat(coefficients[index]);
        }
        sum
    };
    chain(0) + x * chain(1)
}

/// The nearest integer, for |x| < 2^51.
#[inline(always)]
fn nearest_integer<S: Real>(x: S) -> S {
    (x + S::splat(INTEGER_SHIFT)) - S::splat(INTEGER_SHIFT)
}

/// ln 2 to 42 bits, so that its product with an exponent is exact …
const LN2_HIGH: f64 = 0.693_147_180_559_890_3;
/// … and the rest.
const LN2_LOW: f64 = 5.497_923_018_708_371e-14;

/// 1/(k+2)!: the Taylor series of (eʳ - 1 - r)/r². The first term left out, r¹⁴/14!, is below
/// 5e-18 for |r| ≤ ln 2 / 2.
const EXPONENTIAL: [f64; 12] = [
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
    let value = S::one() + (r + (r * r * polynomial(r, &EXPONENTIAL) + rest));
    // In two steps, so that 2ⁿ itself need be neither subnormal nor infinite.
    let half = nearest_integer(n * S::splat(0.5));
    let scaled = value * half.power_of_two() * (n - half).power_of_two();
    // `max` and `min` lose a NaN: give it back.
    S::select(x.less_equal(x), scaled, x)
}

/// Scalars that have an exponential function.
pub trait Exponential: Real {
    /// eˣ within one unit in the last place wherever the result is normal (measured 0.89) and one
    /// subnormal spacing below; exactly 1 at 0; 0 below -745.14; infinite above 709.79; NaN of NaN.
    /// The bits are those of the `f64` version in every lane of every tier.
    fn exp(self) -> Self;
}

impl Exponential for f64 {
    #[inline(always)]
    fn exp(self) -> Self {
        exponential(self)
    }
}
impl Exponential for Lanes {
    #[inline(always)]
    fn exp(self) -> Self {
        exponential(self)
    }
}
#[cfg(target_arch = "x86_64")]
impl Exponential for Avx2 {
    #[inline(always)]
    fn exp(self) -> Self {
        exponential(self)
    }
}
#[cfg(target_arch = "x86_64")]
impl Exponential for Avx512 {
    #[inline(always)]
    fn exp(self) -> Self {
        exponential(self)
    }
}
impl Exponential for DoubleDouble {
    /// About 30 digits relative to (1 + |x|); for references.
    fn exp(self) -> Self {
        const LN2: DoubleDouble = DoubleDouble::new(core::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);
        if !(-746.0..=710.0).contains(&self.high()) {
            return Self::from(self.high().exp());
        }
        let n = (self.high() * core::f64::consts::LOG2_E).round();
        // eʸ - 1 of y = r/256 by Taylor (y¹²/12! < 1e-43), then (1 + e)² - 1 = 2e + e² eight times.
        let y = (self - LN2 * Self::from(n)).scale(1.0 / 256.0);
        let (mut term, mut sum) = (y, y);
        for k in 2..12 {
            term = term * y / Self::from(f64::from(k));
            sum += term;
        }
        for _ in 0..8 {
            sum = sum.scale(2.0) + sum * sum;
        }
        let half = (n * 0.5).round();
        (sum + Self::one()).scale(half.power_of_two()).scale((n - half).power_of_two())
    }
}

/// (atan t - t)/t³ as a polynomial in t², for |t| ≤ √2 - 1: interpolation at the Chebyshev nodes of
/// t² (mpmath, 50 digits); the relative error of atan t is 7e-18.
const ARC_TANGENT: [f64; 11] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_955_16,
    -0.142_857_142_846_656_82,
    0.111_111_110_151_870_18,
    -0.090_909_045_753_064_9,
    0.076_921_831_253_768_92,
    -0.066_645_105_255_089_36,
    0.058_581_409_048_663_28,
    -0.050_854_078_345_894_844,
    0.039_230_447_784_793_09,
    -0.019_175_404_711_104_935,
];
/// What `FRAC_PI_4` leaves of π/4; multiples of `FRAC_PI_4` up to 8 are exact.
const QUARTER_PI_LOW: f64 = 3.061_616_997_868_383e-17;

/// The angle of the vector (x, y), in (-π, π], for finite components below 8e307 in size.
///
/// Within two units in the last place, usually one; small angles keep their relative precision. 0 for the null vector;
/// the sign of a zero is not looked at.
#[inline(always)]
pub fn atan2<S: Real>(y: S, x: S) -> S {
    let (width, height) = (x.abs(), y.abs());
    let steep = width.less(height);
    let small = S::select(steep, width, height);
    let large = S::select(steep, height, width);
    // Turn by π/4 what is beyond π/8: |t| ≤ tan(π/8) then.
    let turned = (large * S::splat(core::f64::consts::SQRT_2 - 1.0)).less(small);
    let numerator = S::select(turned, small - large, small);
    let denominator = S::select(turned, small + large, large);
    let t = S::select(S::zero().less(denominator), numerator / denominator, S::zero());
    let square = t * t;
    let part = t + t * (square * polynomial(square, &ARC_TANGENT));
    // The angle is a number of quarters of π plus or minus the part.
    let quarters = S::select(turned, S::one(), S::zero());
    let reflect = |mask, pivot, (quarters, part): (S, S)| {
        (S::select(mask, S::splat(pivot) - quarters, quarters), S::select(mask, -part, part))
    };
    let (quarters, part) = reflect(steep, 2.0, (quarters, part));
    let (quarters, part) = reflect(x.less(S::zero()), 4.0, (quarters, part));
    let angle =
        quarters * S::splat(core::f64::consts::FRAC_PI_4) + (part + quarters * S::splat(QUARTER_PI_LOW));
    S::select(y.less(S::zero()), -angle, angle)
}

/// π/2 in three parts, the first two of 33 bits, so that their products with integers up to 2^20 are exact.
const HALF_PI: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];
/// 1/(2k+3)!, alternating: the Taylor series of (sin r - r)/r³.
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
/// 1/(2k+4)!, alternating: the Taylor series of (cos r - 1 + r²/2)/r⁴.
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

/// (sin x, cos x) for |x| ≤ 10⁶, within two units in the last place, usually one, also near the zeros.
#[inline(always)]
pub fn sin_cos<S: Real>(x: S) -> (S, S) {
    let n = nearest_integer(x * S::splat(core::f64::consts::FRAC_2_PI));
    let first = (x - n * S::splat(HALF_PI[0])) - n * S::splat(HALF_PI[1]);
    let low = n * S::splat(HALF_PI[2]);
    let r = first - low;
    let rest = (first - r) - low;
    let square = r * r;
    let sine = r + (square * r * polynomial(square, &SINE) + rest);
    let half = S::splat(0.5) * square;
    let head = S::one() - half;
    let cosine =
        head + (((S::one() - head) - half) + (square * square * polynomial(square, &COSINE) - r * rest));
    // Quarter turns: n mod 4 as -2, -1, 0, 1 or 2.
    let quarter = n - S::splat(4.0) * nearest_integer(n * S::splat(0.25));
    let odd = S::zero().less(quarter * (S::splat(2.0) - quarter.abs()) * quarter);
    let (sine, cosine) = (S::select(odd, cosine, sine), S::select(odd, sine, cosine));
    let half_turn = S::one().less(quarter.abs());
    let sine_negative = quarter.less(S::zero()).or(half_turn);
    let cosine_negative = S::zero().less(quarter);
    (S::select(sine_negative, -sine, sine), S::select(cosine_negative.or(half_turn), -cosine, cosine))
}

#[cfg(test)]
mod tests;
