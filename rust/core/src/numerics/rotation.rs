//! Sine and cosine of an angle of any size, and the integrals of a rotation, in double-double beside a power of two.
//!
//! S₁ = sin θ/θ, C₁ = (1 − cos θ)/θ, C₂ = (1 − cos θ)/θ², S₂ = (θ − sin θ)/θ²: all smooth, and 1, 0, 1/2, 0 at θ = 0.
//! Small angles take Stumpff's series, so that nothing cancels; large ones are reduced by π/2 carried to 160 bits.
//! Errors: 1e-30 relative for |θ| ≤ 0.8; beyond, 1e-31 |θ| of the angle. From |θ| = 2^106 on nothing is left of the
//! phase: it is taken as zero.

use super::double_double::DoubleDouble;
use super::power_of_two::exponent;
use super::real::Real;
use super::scaled::Scaled;
use super::stumpff::UniversalFunctions;
use core::f64::consts::{FRAC_2_PI, FRAC_PI_2};

/// A rotation by θ.
#[derive(Clone, Copy, Debug)]
pub struct Rotation {
    /// cos θ.
    pub cosine: Scaled,
    /// sin θ.
    pub sine: Scaled,
    /// sin θ/θ.
    pub s1: Scaled,
    /// (1 − cos θ)/θ.
    pub c1: Scaled,
    /// (1 − cos θ)/θ².
    pub c2: Scaled,
    /// (θ − sin θ)/θ².
    pub s2: Scaled,
}

const TWO_OVER_PI: DoubleDouble = DoubleDouble::new(FRAC_2_PI, -3.935_735_335_036_497e-17);
const HALF_PI: DoubleDouble = DoubleDouble::new(FRAC_PI_2, 6.123_233_995_736_766e-17);
const HALF_PI_THIRD: f64 = -1.497_384_904_859_169_8e-33;
const SIXTH: DoubleDouble = DoubleDouble::new(1.0 / 6.0, 9.251_858_538_542_97e-18);

impl Rotation {
    /// By θ.
    pub fn new(theta: Scaled) -> Self {
        let one = Scaled::from(1.0);
        let high = theta.to_f64().abs();
        if high < 1e-18 {
            // What is left out is below θ² < 1e-36 of each.
            let (half, sixth) = (theta.times(0.5), theta.by(Scaled::new(SIXTH, 0)));
            return Self { cosine: one, sine: theta, s1: one, c1: half, c2: Scaled::from(0.5), s2: sixth };
        }
        if high <= 0.8 {
            let angle = theta.to_double_double();
            let UniversalFunctions { g0, g1, g2, g3 } =
                UniversalFunctions::<DoubleDouble>::new(DoubleDouble::one(), angle);
            let square = angle * angle;
            let parts = [g0, g1, g1 / angle, g2 / angle, g2 / square, g3 / square];
            let [cosine, sine, s1, c1, c2, s2] = parts.map(|part| Scaled::new(part, 0));
            return Self { cosine, sine, s1, c1, c2, s2 };
        }
        let (sine, cosine) = if high.is_finite() && exponent(high) < 106 {
            sin_cos(theta.to_double_double())
        } else {
            (DoubleDouble::default(), DoubleDouble::one())
        };
        let (sine, cosine) = (Scaled::new(sine, 0), Scaled::new(cosine, 0));
        let c1 = one.minus(cosine).over(theta);
        let s1 = sine.over(theta);
        let s2 = one.minus(s1).over(theta);
        Self { cosine, sine, s1, c1, c2: c1.over(theta), s2 }
    }
}

/// (sin θ, cos θ) for |θ| < 2^106.
fn sin_cos(theta: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let n = (theta * TWO_OVER_PI).round();
    let reduced = theta - n * HALF_PI - DoubleDouble::product(n.to_f64(), HALF_PI_THIRD);
    let UniversalFunctions { g0, g1, .. } =
        UniversalFunctions::<DoubleDouble>::new(DoubleDouble::one(), reduced);
    let quarter = (n.high().rem_euclid(4.0) + n.low().rem_euclid(4.0)).rem_euclid(4.0);
    match quarter as u8 {
        0 => (g1, g0),
        1 => (g0, -g1),
        2 => (-g1, -g0),
        _ => (-g0, g1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_and_reduction_meet_and_the_circle_closes() {
        for theta in [0.8, -0.8, 0.3, 1e-3] {
            let near = Rotation::new(Scaled::from(theta));
            let (sine, cosine) = sin_cos(DoubleDouble::from(theta));
            for (one, other) in [(near.sine, sine), (near.cosine, cosine)] {
                let apart = one.plus(Scaled::new(-other, 0)).to_f64();
                assert!(apart.abs() < 1e-31, "{theta}: {apart:e}"); // 2^-103
            }
        }
        for theta in [3.0, -700.5, 1e9, 12_345_678_901_234_567.0, 4e30] {
            let (sine, cosine) = sin_cos(DoubleDouble::from(theta));
            let excess = (sine * sine + cosine * cosine - DoubleDouble::one()).to_f64();
            assert!(excess.abs() < 2e-31, "{theta}: {excess:e}");
        }
        // 355/113 = π + 2.667641890624223e-7 (the 30 digits of π decide).
        let (sine, _) = sin_cos(DoubleDouble::from(355.0) / DoubleDouble::from(113.0));
        let past = 2.667_641_890_624_223e-7_f64;
        assert!((sine.to_f64() + (past - past.powi(3) / 6.0)).abs() < 1e-22);
        let far = Rotation::new(Scaled::from(1e300).times(1e300));
        assert_eq!([far.sine, far.cosine].map(Scaled::to_f64), [0.0, 1.0]);
    }
}
