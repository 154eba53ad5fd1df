//! Elastic collisions.

use super::{Circle, HalfAngle};
use crate::numerics::angles::sin_cos;
use crate::numerics::power_of_two::{exponent, scale};
use crate::words::number;
use crate::{Error, Result};

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
    /// The velocities of the projectile, in units of u/(m₁+m₂): V is m₁ and its speed in the frame m₂.
    pub fn circle(self) -> Circle {
        let Self { projectile, target } = self;
        Circle { frame: projectile, own: target, slow: projectile - target, fast: projectile + target }
    }
    /// The velocities of the target, as fast in the frame as the frame itself.
    pub fn recoil_circle(self) -> Circle {
        Circle { frame: 1.0, own: 1.0, slow: 0.0, fast: 2.0 }
    }
    /// The laboratory angle of the projectile, in [0, π].
    ///
    /// From tan θ₁ = sin ψ/(m₁/m₂ + cos ψ) = 2 m₂ sc/((m₁+m₂) c² + (m₁-m₂) s²).
    pub fn lab_angle(self, half: HalfAngle) -> f64 {
        self.circle().lab_angle(half)
    }
    /// cot(ψ/2) at the greatest laboratory angle, if that is not head-on (m₁ > m₂).
    pub fn turning_point(self) -> Option<f64> {
        Some(self.asymmetry()).filter(|excess| *excess > 0.0).map(f64::sqrt)
    }
    /// The part of the beam energy that a target hit head-on takes: 4 m₁m₂/(m₁+m₂)².
    pub fn greatest_transfer(self) -> f64 {
        let sum = self.projectile + self.target;
        4.0 * (self.projectile / sum) * (self.target / sum)
    }
    /// The part of the beam energy that goes to the target: 4 m₁m₂/(m₁+m₂)² sin²(ψ/2).
    pub fn transferred(self, half: HalfAngle) -> f64 {
        let (square, complement) = half.squares();
        self.greatest_transfer() * (square / (square + complement))
    }
    /// The part of the beam energy that the projectile keeps head-on, ((m₁-m₂)/(m₁+m₂))².
    pub fn kept_head_on(self) -> f64 {
        self.asymmetry() * self.asymmetry()
    }
    /// The part of the beam energy that the projectile keeps, without subtracting from 1.
    pub fn kept(self, half: HalfAngle) -> f64 {
        let (square, complement) = half.squares();
        (self.kept_head_on() * square + complement) / (square + complement)
    }
    /// The centre-of-mass angles that lead to a laboratory angle in [0, π], each with the jacobian
    /// |dΩ/dΩ_lab|; the second exists for m₁ > m₂ only.
    ///
    /// ψ± = θ₁ ± asin(γ sin θ₁) (+ π for the second), γ = m₁/m₂; jacobian (γ cos θ₁ ± S)²/S with
    /// S = √(1 - γ² sin² θ₁). Both are infinite at the greatest angle; no branch beyond it.
    pub fn branches(self, lab_angle: f64) -> [Option<(f64, f64)>; 2] {
        self.circle().branches(lab_angle)
    }
    /// The jacobian |dΩ/dΩ_recoil| = 4 cos θ₂.
    pub fn recoil_jacobian(recoil_angle: f64) -> f64 {
        4.0 * sin_cos(recoil_angle).1
    }
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
