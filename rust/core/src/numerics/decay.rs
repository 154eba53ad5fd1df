//! e⁻ᵘ and its integrals, for u of any size and sign, in double-double beside a power of two.
//!
//! φ₁(u) = (1 − e⁻ᵘ)/u and φ₂(u) = (1 − φ₁)/u = (u − 1 + e⁻ᵘ)/u²: both smooth, and 1 and 1/2 at u = 0. For |u| ≤ 1 the
//! Taylor series of φ₂ = Σ (−u)ᵏ/(k + 2)!, and the others from it without cancellation: φ₁ = 1 − u φ₂, e⁻ᵘ = 1 − u φ₁.
//! Relative errors: 1e-30 (|u| ≤ 1), 1e-30 (1 + |u|) beyond, as the exponent itself is known to 106 bits only.

use super::double_double::DoubleDouble;
use super::elementary::Exponential;
use super::real::Real;
use super::scaled::Scaled;
use super::stumpff::INVERSE_FACTORIALS;

/// The decay after u times.
#[derive(Clone, Copy, Debug)]
pub struct Decay {
    /// e⁻ᵘ.
    pub factor: Scaled,
    /// φ₁.
    pub first: Scaled,
    /// φ₂.
    pub second: Scaled,
}

/// Beyond this, e^±u is beyond the range whatever is multiplied by it (2^±1.4e6, against 2^±6000).
pub const FAR: f64 = 1e6;
const LN2: DoubleDouble = DoubleDouble::new(core::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);

impl Decay {
    /// After u times.
    pub fn new(u: Scaled) -> Self {
        let size = u.to_f64().abs();
        if size <= 1.0 {
            return Self::near(u.to_double_double());
        }
        let one = Scaled::from(1.0);
        let factor = exponential(u.negative());
        let first = one.minus(factor).over(u);
        Self { factor, first, second: one.minus(first).over(u) }
    }

    fn near(u: DoubleDouble) -> Self {
        let mut second = DoubleDouble::default();
        for &coefficient in INVERSE_FACTORIALS.iter().rev() {
            second = coefficient - u * second;
        }
        let first = DoubleDouble::one() - u * second;
        let factor = DoubleDouble::one() - u * first;
        Self { factor: Scaled::new(factor, 0), first: Scaled::new(first, 0), second: Scaled::new(second, 0) }
    }
}

/// eˣ, for every x.
pub fn exponential(x: Scaled) -> Scaled {
    let high = x.to_f64().clamp(-FAR, FAR);
    let n = (high * core::f64::consts::LOG2_E).round();
    if high.abs() == FAR {
        return Scaled::new(DoubleDouble::one(), n as i32);
    }
    let rest = x.to_double_double() - LN2 * DoubleDouble::from(n);
    Scaled::new(Exponential::exp(rest), n as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Across the border between series and exponential: relative differences.
    fn apart(a: Scaled, b: Scaled) -> f64 {
        a.minus(b).over(b).to_f64().abs()
    }

    #[test]
    fn series_and_exponential_meet() {
        for u in [1.0, -1.0, 0.75, -0.5] {
            let near = Decay::near(DoubleDouble::from(u));
            let factor = exponential(Scaled::from(-u));
            let first = Scaled::from(1.0).minus(factor).over(Scaled::from(u));
            // A few units in the 104th bit, times what the subtractions cancel: 2/|u|.
            assert!(apart(near.factor, factor) < 1e-29 && apart(near.first, first) < 1e-29, "{u}");
        }
    }

    #[test]
    fn the_ends_are_numbers() {
        let far = Decay::new(Scaled::from(1e300).times(1e300));
        assert_eq!((far.factor.to_f64(), far.first.times(1e300).times(1e300).to_f64()), (0.0, 1.0));
        let none = Decay::new(Scaled::from(1e-300).times(1e-300));
        assert_eq!([none.factor, none.first, none.second].map(Scaled::to_f64), [1.0, 1.0, 0.5]);
        assert_eq!(Decay::new(Scaled::from(-1e9)).factor.to_f64(), f64::INFINITY);
    }
}
