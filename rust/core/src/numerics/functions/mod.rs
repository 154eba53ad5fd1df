//! Elementary functions in every lane, as expressions call them.
//!
//! The one idea: each is a written sequence of correctly rounded and fused operations over [`Binary`] scalars, so a lane of any
//! tier has the bits of `f64`. What an argument or a quotient leaves out is carried along in a second number, so that errors
//! stay below a unit in the last place (each file says what was measured).

mod hyperbolic;
mod inverse;
mod logarithm;
pub mod precise;
mod trigonometric;

pub use hyperbolic::{sech_squared, sinh_cosh, tanh};
pub use inverse::{acos, acosh, asin, asinh, atan, atan2, atanh};
pub use logarithm::ln;
pub use trigonometric::{sin_cos, tan};

use super::binary::Binary;
use super::lanes::{Lanes, WIDTH};
use super::power::{Power, Powers};
use super::real::Real;

#[cfg(target_arch = "x86_64")]
use super::lanes::{Avx2, Avx512, Vector8};

/// What functions need of a scalar beside arithmetic.
pub trait Functions: Binary + Powers {
    /// Sine and cosine of an angle from those of what is left after `quarters` quarter turns, which is an integer plus
    /// 1.5·2⁵².
    #[must_use]
    fn turned(quarters: Self, sine: Self, cosine: Self) -> (Self, Self);
    /// Each number by itself, where few are.
    #[must_use]
    fn one_by_one(self, function: fn(f64) -> f64) -> Self;
}

/// Swaps and changes signs by the last two bits of the number of quarters.
#[inline(always)]
fn turned(quarters: f64, sine: f64, cosine: f64) -> (f64, f64) {
    let (n, s, c) = (quarters.to_bits(), sine.to_bits(), cosine.to_bits());
    let swapped = (s ^ c) & 0_u64.wrapping_sub(n & 1);
    let (sine_sign, cosine_sign) = ((n & 2) << 62, (n.wrapping_add(1) & 2) << 62);
    (f64::from_bits(s ^ swapped ^ sine_sign), f64::from_bits(c ^ swapped ^ cosine_sign))
}

impl Functions for f64 {
    #[inline(always)]
    fn turned(quarters: Self, sine: Self, cosine: Self) -> (Self, Self) {
        turned(quarters, sine, cosine)
    }
    #[inline(always)]
    fn one_by_one(self, function: fn(f64) -> f64) -> Self {
        function(self)
    }
}

impl Functions for Lanes {
    #[inline(always)]
    fn turned(quarters: Self, sine: Self, cosine: Self) -> (Self, Self) {
        let (mut s, mut c) = (sine, cosine);
        for lane in 0..WIDTH {
            (s.0[lane], c.0[lane]) = turned(quarters.0[lane], sine.0[lane], cosine.0[lane]);
        }
        (s, c)
    }
    #[inline(always)]
    fn one_by_one(self, function: fn(f64) -> f64) -> Self {
        self.map(function)
    }
}

#[cfg(target_arch = "x86_64")]
macro_rules! by_lanes {
    ($($type:ty)+) => {$(
        impl Functions for $type {
            #[inline(always)]
            fn turned(quarters: Self, sine: Self, cosine: Self) -> (Self, Self) {
                let (s, c) = Lanes::turned(quarters.store(), sine.store(), cosine.store());
                (Self::load(s), Self::load(c))
            }
            #[inline(always)]
            fn one_by_one(self, function: fn(f64) -> f64) -> Self {
                Self::load(self.store().map(function))
            }
        }
    )+};
}
#[cfg(target_arch = "x86_64")]
by_lanes!(Avx2 Avx512);

/// x to a constant power that is no whole number; NaN of negative x.
#[inline(always)]
pub fn power<S: Functions>(x: S, exponent: f64) -> S {
    let value = x.power(&Power::new(exponent));
    S::select(x.less(S::zero()), S::splat(f64::NAN), value)
}

/// Σ cᵢ zⁱ by fused operations, in two chains.
#[inline(always)]
fn fused<S: Real, const N: usize>(z: S, coefficients: &[f64; N]) -> S {
    let square = z * z;
    let mut chains = [S::zero(); 2];
    let mut index = N;
    while index > 0 {
        index -= 1;
        chains[index % 2] = chains[index % 2].multiply_add(square, S::splat(coefficients[index]));
    }
    z.multiply_add(chains[1], chains[0])
}

/// a · b exactly, as product and error.
#[inline(always)]
fn product<S: Real>(a: S, b: S) -> (S, S) {
    let product = a * b;
    (product, a.multiply_add(b, -product))
}

/// a + b of |a| ≥ |b| exactly, as sum and error.
#[inline(always)]
fn fast_sum<S: Real>(a: S, b: S) -> (S, S) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// (a + a′)/(b + b′) as a quotient and what it leaves out.
#[inline(always)]
fn quotient<S: Real>((a, a_low): (S, S), (b, b_low): (S, S)) -> (S, S) {
    let q = a / b;
    let rest = q.multiply_subtract_from(b, a) + q.multiply_subtract_from(b_low, a_low);
    (q, rest / b)
}

#[cfg(test)]
mod tests;
