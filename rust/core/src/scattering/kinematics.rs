//! Elastic two-body kinematics: a projectile of mass m₁ on a target of mass m₂ at rest.
//!
//! The one idea: a collision is given by sine and cosine of half the scattering angle ψ of the
//! centre-of-mass frame. Everything else is algebra that keeps relative precision at both ends, head-on
//! and forward, and both branches of m₁ > m₂ come by themselves.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* (3rd ed.), §3.11; Landau & Lifshitz,
//! *Mechanics*, §17.

use crate::numerics::angles::{atan2, sin_cos};
use crate::numerics::power_of_two::{exponent, scale};
use crate::words::number;
use crate::{Error, Result};

/// Half the scattering angle ψ in [0, π], as its sine and cosine up to a common factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfAngle {
    sine: f64,
    cosine: f64,
}

impl HalfAngle {
    /// Of the scattering angle ψ.
    pub fn of(cm_angle: f64) -> Self {
        let (sine, cosine) = sin_cos(0.5 * cm_angle);
        Self { sine, cosine }
    }
    /// Of cot(ψ/2).
    pub fn from_cotangent(cotangent: f64) -> Self {
        Self { sine: 1.0, cosine: cotangent }
    }
    /// cot(ψ/2).
    pub fn cotangent(self) -> f64 {
        self.cosine / self.sine
    }
    /// The scattering angle ψ.
    pub fn cm_angle(self) -> f64 {
        2.0 * atan2(self.sine, self.cosine)
    }
    /// The laboratory angle of the target, (π - ψ)/2, in [0, π/2].
    pub fn recoil_angle(self) -> f64 {
        atan2(self.cosine, self.sine)
    }
    fn squares(self) -> (f64, f64) {
        (self.sine * self.sine, self.cosine * self.cosine)
    }
}

/// The masses of projectile and target, scaled by a power of two so that the larger is in [1, 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    projectile: f64,
    target: f64,
}

impl Collision {
    /// For positive finite masses.
    ///
    /// # Errors
    /// `InvalidInput` naming `masses`.
    pub fn new(projectile: f64, target: f64) -> Result<Self> {
        for (index, mass) in [projectile, target].into_iter().enumerate() {
            if !(mass > 0.0 && mass.is_finite()) {
                return Err(Error::invalid(
                    "masses",
                    format!("expected two positive finite masses, but masses[{index}] is {}", number(mass)),
                ));
            }
        }
        // By a power of two, which is exact: m₁ - m₂ keeps every digit.
        let unit = exponent(projectile.max(target));
        let scaled = Self { projectile: scale(projectile, -unit), target: scale(target, -unit) };
        if scaled.projectile.min(scaled.target) < f64::MIN_POSITIVE {
            return Err(Error::invalid(
                "masses",
                format!(
                    "expected masses within 307 decades of each other, got {} and {}; for a target that \
                     does not move 1e300 times the projectile's mass is as good as infinity",
                    number(projectile),
                    number(target)
                ),
            ));
        }
        Ok(scaled)
    }

    /// m₂/(m₁+m₂): the part of the beam energy that is energy of relative motion.
    pub fn relative_share(self) -> f64 {
        self.target / (self.projectile + self.target)
    }
    /// (m₁ - m₂)/(m₁ + m₂).
    fn asymmetry(self) -> f64 {
        (self.projectile - self.target) / (self.projectile + self.target)
    }
    /// The laboratory angle of the projectile, in [0, π].
    ///
    /// From tan θ₁ = sin ψ/(m₁/m₂ + cos ψ) = 2 m₂ sc/((m₁+m₂) c² + (m₁-m₂) s²).
    pub fn lab_angle(self, half: HalfAngle) -> f64 {
        if self.projectile == self.target {
            return atan2(half.sine, half.cosine); // ψ/2, where the general form is 0/0 head-on
        }
        let (square, complement) = half.squares();
        let sum = self.projectile + self.target;
        let forward = sum * complement + (self.projectile - self.target) * square;
        atan2(2.0 * self.target * (half.sine * half.cosine), forward)
    }
    /// cot(ψ/2) at the greatest laboratory angle, if that is not head-on (m₁ > m₂).
    pub fn turning_point(self) -> Option<f64> {
        Some(self.asymmetry()).filter(|excess| *excess > 0.0).map(f64::sqrt)
    }
    /// The part of the beam energy that goes to the target: 4 m₁m₂/(m₁+m₂)² sin²(ψ/2).
    pub fn transferred(self, half: HalfAngle) -> f64 {
        let (square, complement) = half.squares();
        let sum = self.projectile + self.target;
        4.0 * (self.projectile / sum) * (self.target / sum) * (square / (square + complement))
    }
    /// The part of the beam energy that the projectile keeps, without subtracting from 1.
    pub fn kept(self, half: HalfAngle) -> f64 {
        let (square, complement) = half.squares();
        let head_on = self.asymmetry() * self.asymmetry();
        (head_on * square + complement) / (square + complement)
    }
    /// The centre-of-mass angles that lead to a laboratory angle in [0, π], each with the jacobian
    /// |dΩ/dΩ_lab|; the second exists for m₁ > m₂ only.
    ///
    /// ψ± = θ₁ ± asin(γ sin θ₁) (+ π for the second), γ = m₁/m₂; jacobian (γ cos θ₁ ± S)²/S with
    /// S = √(1 - γ² sin² θ₁). Both are infinite at the greatest angle; no branch beyond it.
    pub fn branches(self, lab_angle: f64) -> [Option<(f64, f64)>; 2] {
        let (sine, cosine) = sin_cos(lab_angle);
        let ratio = self.projectile / self.target;
        let (reach, along) = (ratio * sine, ratio * cosine);
        if reach > 1.0 || (ratio > 1.0 && cosine < 0.0) {
            return [None, None];
        }
        // γ² - 1 = (γ - 1)(γ + 1) = (γ cos θ₁)² - S², from the exact difference of the masses.
        let (difference, sum) = ((self.projectile - self.target) / self.target, ratio + 1.0);
        // S by the form whose terms cancel least.
        let root = if ratio == 1.0 {
            cosine.abs()
        } else if along.abs() < 1.0 {
            (along * along - difference * sum).max(0.0).sqrt()
        } else {
            ((1.0 - reach) * (1.0 + reach)).sqrt()
        };
        let jacobian = |projected: f64| projected * projected / root;
        // The direction in the centre-of-mass frame has components (λ cos θ₁ - γ, λ sin θ₁), where
        // λ = γ cos θ₁ ± S is the laboratory speed in units of the frame's own.
        let angle = |speed: f64, along: f64| atan2(speed * sine, along);
        // λ₊λ₋ = γ² - 1: the one that would cancel comes from the other.
        let fast = if along < 0.0 { -difference * (sum / (root - along)) } else { along + root };
        let first = (fast >= 0.0 && !(ratio == 1.0 && cosine < 0.0))
            .then(|| (angle(fast, cosine * root - reach * sine), jacobian(fast)));
        let slow = difference * (sum / fast);
        let second = (ratio > 1.0).then(|| (angle(slow, -cosine * root - reach * sine), jacobian(slow)));
        [first, second]
    }
    /// The jacobian |dΩ/dΩ_recoil| = 4 cos θ₂.
    pub fn recoil_jacobian(recoil_angle: f64) -> f64 {
        4.0 * sin_cos(recoil_angle).1
    }
}

/// The solid angle between the cones of two angles from an axis, without subtracting cosines.
pub fn solid_angle(from: f64, to: f64) -> f64 {
    4.0 * core::f64::consts::PI * sin_cos(0.5 * (from + to)).0 * sin_cos(0.5 * (to - from)).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cotangent(log_t: f64) -> HalfAngle {
        HalfAngle::from_cotangent(2.0_f64.powf(log_t))
    }

    proptest! {
        #[test]
        fn energy_is_shared_between_the_two(m1 in 1e-12..1e12f64, m2 in 1e-12..1e12f64, log_t in -80.0..80.0f64) {
            let collision = Collision::new(m1, m2).unwrap();
            let t = cotangent(log_t);
            let sum = collision.kept(t) + collision.transferred(t);
            prop_assert!((sum - 1.0).abs() < 1.5e-15, "{sum}"); // seven roundings of numbers up to 1
        }
        #[test]
        fn momentum_is_conserved_across_the_beam(m1 in 0.01..100.0f64, m2 in 0.01..100.0f64, log_t in -20.0..20.0f64) {
            let collision = Collision::new(m1, m2).unwrap();
            let t = cotangent(log_t);
            let across = (m1 * collision.kept(t)).sqrt() * sin_cos(collision.lab_angle(t)).0;
            let recoil = (m2 * collision.transferred(t)).sqrt() * sin_cos(t.recoil_angle()).0;
            // The angle carries 2e-16 relative, π - angle only 4e-16 absolute: hence the second term.
            let scale = across.abs().max(recoil) + (m1 * collision.kept(t)).sqrt();
            prop_assert!((across - recoil).abs() < 2e-15 * scale, "{across} {recoil}");
        }
        #[test]
        fn the_branches_lead_back(m1 in 0.01..100.0f64, m2 in 0.01..100.0f64, log_t in -10.0..10.0f64) {
            let collision = Collision::new(m1, m2).unwrap();
            let t = cotangent(log_t);
            let cm = t.cm_angle();
            let branches = collision.branches(collision.lab_angle(t));
            let nearest = branches.iter().flatten().map(|b| (b.0 - cm).abs()).fold(9.0, f64::min);
            // Ill-conditioned as the square root at the greatest angle, hence the wide margin.
            prop_assert!(nearest < 1e-6, "{nearest:e}");
        }
        #[test]
        fn nothing_is_ever_not_a_number(log_ratio in -1000.0..1000.0f64, log_t in -490.0..490.0f64) {
            for (m1, m2) in [(2.0_f64.powf(log_ratio), 1.0), (1.0, 1.0), (3.0, 3.0)] {
                let collision = Collision::new(m1, m2).unwrap();
                for t in [HalfAngle::from_cotangent(0.0), cotangent(log_t), HalfAngle::of(0.0)] {
                    let values = [
                        collision.lab_angle(t), collision.transferred(t), collision.kept(t), t.cm_angle(), t.recoil_angle(),
                    ];
                    prop_assert!(values.iter().all(|value| (0.0..=core::f64::consts::PI).contains(value)), "{values:?}");
                }
            }
        }
    }

    #[test]
    fn head_on() {
        use core::f64::consts::{FRAC_PI_2, PI};
        let light = Collision::new(1.0, 4.0).unwrap();
        let half = HalfAngle::from_cotangent(0.0);
        assert_eq!((half.cm_angle(), half.recoil_angle(), light.lab_angle(half)), (PI, 0.0, PI));
        assert!((light.kept(half) - 0.36).abs() < 1e-16 && (light.transferred(half) - 0.64).abs() < 2e-16);
        let equal = Collision::new(2.0, 2.0).unwrap();
        assert_eq!((equal.lab_angle(half), equal.kept(half)), (FRAC_PI_2, 0.0));
        assert_eq!(Collision::new(4.0, 1.0).unwrap().lab_angle(half), 0.0);
    }

    /// Catalogue G8.46: angles and jacobians of both branches.
    #[test]
    fn golden_branches() {
        let check = |ratio: f64, angle: f64, expected: &[(f64, f64)]| {
            let found = Collision::new(ratio, 1.0).unwrap().branches(angle);
            assert_eq!(found.iter().flatten().count(), expected.len());
            for (found, expected) in found.iter().flatten().zip(expected) {
                // Measured 4e-16 relative; the cancellation in 1 - γ² sin² θ amplifies twice.
                assert!((found.0 / expected.0 - 1.0).abs() < 1e-15, "{found:?} {expected:?}");
                assert!((found.1 / expected.1 - 1.0).abs() < 3e-15, "{found:?} {expected:?}");
            }
        };
        check(0.4, 2.0, &[(2.372_257_213_391_215, 0.628_337_099_561_778_3)]);
        check(1.0, 0.6, &[(1.2, 3.301_342_459_638_713_2)]);
        check(
            2.5,
            0.3,
            &[
                (1.131_288_768_480_900_6, 13.914_724_678_985_554),
                (2.610_303_885_108_892_6, 4.361_359_787_729_494),
            ],
        );
    }
}
