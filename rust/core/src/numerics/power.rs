//! Powers of positive numbers with the same bits on every machine, in every lane, and in units of any power of two.
//!
//! The one idea: x = m·2ᵏ, so that whole powers are products of m, and others are 2 to the power of
//! exponent·(k + log₂ m), which is kept in two parts; the exponent of two is put on at the end. Nothing on the way
//! leaves the range, and what stands in front, (x·2^`from`)ⁿ·2^`to`, changes no bit of the significand.
//! Method: ln m = 2 artanh((m − 1)/(m + 1)), its leading terms in double-double.

use super::binary::Binary;
use super::double_double::{DoubleDouble, two_sum};
use super::elementary::{EXPONENTIAL, Exponential, nearest_integer, polynomial};
use super::lanes::Lanes;
use super::power_of_two;
use super::real::Real;

#[cfg(target_arch = "x86_64")]
use super::lanes::{Avx2, Avx512};

/// Whole exponents up to this are multiplied out: n + 1 units in the last place at most.
const WHOLE_MAX: f64 = 64.0;
/// Beyond 2^±FAR is nothing, whatever stands in front.
const FAR: f64 = 3000.0;
const LN2: [f64; 2] = [core::f64::consts::LN_2, 2.319_046_813_846_299_6e-17];
/// 2/ln 2.
const TWICE_LOG2_E: [f64; 2] = [2.885_390_081_777_926_8, 4.071_054_748_186_206_6e-17];
const THIRD: [f64; 2] = [1.0 / 3.0, 1.850_371_707_708_594e-17];
/// 1/(2k + 5): the rest of artanh s = s (1 + s²/3 + s⁴ Σ s²ᵏ/(2k + 5)). With |s| ≤ 0.1716 what is left out is below 2^-70.
const ARTANH: [f64; 11] = [
    1.0 / 5.0,
    1.0 / 7.0,
    1.0 / 9.0,
    1.0 / 11.0,
    1.0 / 13.0,
    1.0 / 15.0,
    1.0 / 17.0,
    1.0 / 19.0,
    1.0 / 21.0,
    1.0 / 23.0,
    1.0 / 25.0,
];

/// (x·2^`from`)^`exponent`·2^`to` as a function of x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    exponent: f64,
    from: f64,
    to: f64,
}

impl Power {
    /// x^exponent.
    pub fn new(exponent: f64) -> Self {
        Self { exponent, from: 0.0, to: 0.0 }
    }
    /// With those powers of two.
    pub fn scaled(self, from: i32, to: i32) -> Self {
        Self { from: self.from + f64::from(from), to: self.to + f64::from(to), ..self }
    }
    /// Whether no power of two stands in it.
    fn is_plain(&self) -> bool {
        self.from == 0.0 && self.to == 0.0
    }
    fn whole(&self) -> bool {
        self.exponent.abs() <= WHOLE_MAX && self.exponent == self.exponent.round()
    }
    /// What it is of 0; of infinity it is one over that.
    fn at_zero(&self) -> f64 {
        if self.exponent > 0.0 {
            0.0
        } else if self.exponent < 0.0 {
            f64::INFINITY
        } else {
            power_of_two::power_of_two(self.to as i32)
        }
    }
}

/// x^n by multiplication.
#[inline(always)]
fn multiplied<S: Real>(x: S, n: f64) -> S {
    let (mut rest, mut square, mut product) = (n.abs() as u32, x, S::one());
    while rest > 0 {
        if rest & 1 == 1 {
            product = product * square;
        }
        square = square * square;
        rest >>= 1;
    }
    if n < 0.0 { S::one() / product } else { product }
}

/// `value`·2ⁿ for integers n of any size.
#[inline(always)]
fn shifted<S: Binary>(value: S, n: S) -> S {
    let n = n.max(S::splat(-FAR)).min(S::splat(FAR));
    let third = nearest_integer(n * S::splat(1.0 / 3.0));
    let step = third.power_of_two();
    value * step * step * (n - third - third).power_of_two()
}

/// log₂ of (significand, exponent), in two parts.
#[inline(always)]
fn log2<S: Binary>(m: S, k: S) -> (S, S) {
    let large = S::splat(core::f64::consts::SQRT_2).less(m);
    let m = S::select(large, m * S::splat(0.5), m);
    let k = S::select(large, k + S::one(), k);
    // s = (m − 1)/(m + 1) in two parts; every difference here is exact.
    let f = m - S::one();
    let d = S::splat(2.0) + f;
    let d_low = f - (d - S::splat(2.0));
    let s = f / d;
    let s_low = (s.multiply_subtract_from(d, f) - s * d_low) / d;
    // s²/3 + … = s² (1/3 + s² rest).
    let w = s * s;
    let w_low = s.multiply_add(s, -w) + (s + s) * s_low;
    let rest = w * polynomial(w, &ARTANH);
    let t = S::splat(THIRD[0]) + rest;
    let t_low = (rest - (t - S::splat(THIRD[0]))) + S::splat(THIRD[1]);
    let p = w * t;
    let p_low = w.multiply_add(t, -p) + (w * t_low + w_low * t);
    let q = s * p;
    let q_low = s.multiply_add(p, -q) + (s * p_low + s_low * p);
    let half = s + q;
    let half_low = (q - (half - s)) + (q_low + s_low);
    let factor = S::splat(TWICE_LOG2_E[0]);
    let g = half * factor;
    let g_low = half.multiply_add(factor, -g) + (half * S::splat(TWICE_LOG2_E[1]) + half_low * factor);
    let high = k + g;
    (high, (g - (high - k)) + g_low)
}

#[inline(always)]
fn power<S: Binary>(x: S, power: &Power) -> S {
    let small = x.less(S::splat(f64::MIN_POSITIVE));
    let normal = S::select(small, x * S::splat(power_of_two::power_of_two(54)), x);
    let k = normal.binary_exponent() + S::select(small, S::splat(power.from - 54.0), S::splat(power.from));
    let m = normal.significand();
    let (n, to) = (S::splat(power.exponent), S::splat(power.to));
    let value = if power.whole() {
        shifted(multiplied(m, power.exponent), n * k + to)
    } else {
        let (log, log_low) = log2(m, k);
        let t = n * log;
        let t_low = n.multiply_add(log, -t) + n * log_low;
        let near = t.abs().less(S::splat(FAR));
        let t = t.max(S::splat(-FAR)).min(S::splat(FAR));
        let whole = nearest_integer(t);
        // 2^(t − whole) as e^(r + rest).
        let f = t - whole;
        let r = f * S::splat(LN2[0]);
        let rest = f.multiply_add(S::splat(LN2[0]), -r)
            + (f * S::splat(LN2[1]) + S::select(near, t_low, S::zero()) * S::splat(LN2[0]));
        let (r, rest) = two_sum(r, rest);
        let value = S::one() + (r + (r * r * polynomial(r, &EXPONENTIAL) + (rest + rest * r)));
        shifted(value, whole + to)
    };
    let at_zero = power.at_zero();
    let at_infinity = if at_zero == 0.0 {
        f64::INFINITY
    } else if at_zero > f64::MAX {
        0.0
    } else {
        at_zero
    };
    let value = S::select(x.less_equal(S::zero()), S::splat(at_zero), value);
    let value = S::select(S::splat(f64::MAX).less(x), S::splat(at_infinity), value);
    S::select(x.less_equal(x), value, x)
}

/// Scalars with powers of what is not negative.
pub trait Powers: Exponential {
    /// (self·2^from)^exponent·2^to: to 1.05 units in the last place, or |n| + 1 for whole exponents of up to 64,
    /// which are multiplied out; 0 and infinity where they belong, for every number from 0 to infinity.
    fn power(self, power: &Power) -> Self;
    /// The same of numbers from 0 to 1 and exponents of at least 0: where these are whole or half, by products and a root.
    #[inline(always)]
    fn part_power(self, by: &Power) -> Self {
        let whole = by.exponent.floor();
        if !by.is_plain() || whole > WHOLE_MAX {
            return self.power(by);
        }
        let product = multiplied(self, whole);
        if by.exponent == whole {
            product
        } else if by.exponent == whole + 0.5 {
            product * self.sqrt()
        } else {
            self.power(by)
        }
    }
}

impl Powers for f64 {
    #[inline(always)]
    fn power(self, by: &Power) -> Self {
        power(self, by)
    }
}
impl Powers for Lanes {
    #[cfg_attr(all(target_arch = "x86_64", not(target_feature = "fma")), inline(never))]
    #[cfg_attr(not(all(target_arch = "x86_64", not(target_feature = "fma"))), inline(always))]
    fn power(self, by: &Power) -> Self {
        power(self, by)
    }
}
#[cfg(target_arch = "x86_64")]
impl Powers for Avx2 {
    #[inline(always)]
    fn power(self, by: &Power) -> Self {
        power(self, by)
    }
}
#[cfg(target_arch = "x86_64")]
impl Powers for Avx512 {
    #[inline(always)]
    fn power(self, by: &Power) -> Self {
        power(self, by)
    }
}
impl Powers for DoubleDouble {
    /// To 30 digits relative to 1 + |exponent| (1 + |ln|).
    fn power(self, by: &Power) -> Self {
        if !(self.high() > 0.0 && self.high() < f64::INFINITY) {
            return Self::from(self.high().power(by));
        }
        // Next to one, where the logarithm is small, it must not be made of large ones.
        let k = power_of_two::exponent(self.high());
        let k = k + i32::from(power_of_two::scale(self.high(), -k) > core::f64::consts::SQRT_2);
        let m = Self::new(power_of_two::scale(self.high(), -k), power_of_two::scale(self.low(), -k));
        let k = f64::from(k) + by.from;
        let (value, to) = if by.whole() {
            (multiplied(m, by.exponent), by.exponent * k + by.to)
        } else {
            let exponent = (ln(m) / Self::new(LN2[0], LN2[1]) + Self::from(k)) * Self::from(by.exponent);
            let whole = exponent.high().clamp(-FAR, FAR).round();
            let rest = (exponent - Self::from(whole)) * Self::new(LN2[0], LN2[1]);
            (rest.exp(), whole + by.to)
        };
        let to = to.clamp(-FAR, FAR) as i32;
        Self::new(power_of_two::scale(value.high(), to), power_of_two::scale(value.low(), to))
    }
}

/// ln m: Newton's iteration on the exponential, from sixteen digits to more than thirty.
fn ln(m: DoubleDouble) -> DoubleDouble {
    let start = DoubleDouble::from(super::elementary::ln(m.high()));
    let rest = m * (-start).exp() - DoubleDouble::one();
    start + rest - rest * rest.scale(0.5)
}

#[cfg(test)]
mod tests;
