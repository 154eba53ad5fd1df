//! Elastic two-body kinematics: a projectile of mass m₁ on a target of mass m₂ at rest.
//!
//! The one idea: a collision is given by t = cot(ψ/2), ψ the scattering angle in the centre-of-mass
//! frame. Everything else is algebra in t that keeps relative precision at both ends, head-on (t → 0)
//! and forward (t → ∞), and both branches of m₁ > m₂ come by themselves.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* (3rd ed.), §3.11; Landau & Lifshitz,
//! *Mechanics*, §17.

use crate::numerics::elementary::{atan2, sin_cos};
use crate::{Error, Result};

/// The masses of projectile and target, scaled so that the larger is 1.
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
                    format!("expected two positive finite masses, but masses[{index}] is {mass}"),
                ));
            }
        }
        let larger = projectile.max(target);
        Ok(Self { projectile: projectile / larger, target: target / larger })
    }

    /// m₂/(m₁+m₂): the part of the beam energy that is energy of relative motion.
    pub fn relative_share(self) -> f64 {
        self.target / (self.projectile + self.target)
    }
    /// The laboratory angle of the projectile, in [0, π].
    ///
    /// From tan θ₁ = sin ψ/(m₁/m₂ + cos ψ) = 2 m₂ t/((m₁+m₂) t² + m₁ - m₂).
    pub fn lab_angle(self, t: f64) -> f64 {
        if self.projectile == self.target {
            return atan2(1.0, t); // ψ/2, where the general form is 0/0 head-on
        }
        let forward = (self.projectile + self.target) * (t * t) + (self.projectile - self.target);
        atan2(2.0 * self.target * t, forward)
    }
    /// The value of t at which the laboratory angle is greatest, if that is not head-on (m₁ > m₂).
    pub fn turning_point(self) -> Option<f64> {
        let excess = (self.projectile - self.target) / (self.projectile + self.target);
        (excess > 0.0).then(|| excess.sqrt())
    }
    /// The part of the beam energy that goes to the target: 4 m₁m₂/(m₁+m₂)² sin²(ψ/2).
    pub fn transferred(self, t: f64) -> f64 {
        let sum = self.projectile + self.target;
        4.0 * (self.projectile / sum) * (self.target / sum) / (1.0 + t * t)
    }
    /// The part of the beam energy that the projectile keeps, without subtracting from 1.
    pub fn kept(self, t: f64) -> f64 {
        let head_on = (self.projectile - self.target) / (self.projectile + self.target);
        (head_on * head_on + t * t) / (1.0 + t * t)
    }
    /// The centre-of-mass angles that lead to a laboratory angle in [0, π], each with the jacobian
    /// |dΩ/dΩ_lab|; the second exists for m₁ > m₂ only.
    ///
    /// ψ± = θ₁ ± asin(γ sin θ₁) (+ π for the second), γ = m₁/m₂; jacobian (γ cos θ₁ ± S)²/S with
    /// S = √(1 - γ² sin² θ₁). Both are infinite at the greatest angle; no branch beyond it.
    pub fn branches(self, lab_angle: f64) -> [Option<(f64, f64)>; 2] {
        let (sine, cosine) = sin_cos(lab_angle);
        let ratio = self.projectile / self.target;
        let reach = ratio * sine;
        if reach > 1.0 || (ratio > 1.0 && cosine < 0.0) {
            return [None, None];
        }
        let root = if ratio == 1.0 { cosine.abs() } else { ((1.0 - reach) * (1.0 + reach)).sqrt() };
        let jacobian = |projected: f64| projected * projected / root;
        // The direction in the centre-of-mass frame has components (λ cos θ₁ - γ, λ sin θ₁), where
        // λ = γ cos θ₁ ± S is the laboratory speed in units of the frame's own.
        let angle = |speed: f64, along: f64| atan2(speed * sine, along);
        let fast = ratio * cosine + root;
        let first = (fast >= 0.0 && !(ratio == 1.0 && cosine < 0.0))
            .then(|| (angle(fast, cosine * root - reach * sine), jacobian(fast)));
        let slow = ratio * cosine - root;
        let second = (ratio > 1.0).then(|| (angle(slow, -cosine * root - reach * sine), jacobian(slow)));
        [first, second]
    }
    /// The jacobian |dΩ/dΩ_recoil| = 4 cos θ₂.
    pub fn recoil_jacobian(recoil_angle: f64) -> f64 {
        4.0 * sin_cos(recoil_angle).1
    }
}

/// The centre-of-mass angle ψ in [0, π].
pub fn cm_angle(t: f64) -> f64 {
    2.0 * atan2(1.0, t)
}

/// The laboratory angle of the target, (π - ψ)/2, in [0, π/2].
pub fn recoil_angle(t: f64) -> f64 {
    atan2(t, 1.0)
}

/// t = cot(ψ/2) of a centre-of-mass angle in [0, π].
pub fn half_cotangent(cm_angle: f64) -> f64 {
    let (sine, cosine) = sin_cos(0.5 * cm_angle);
    cosine / sine
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn energy_is_shared_between_the_two(m1 in 1e-12..1e12f64, m2 in 1e-12..1e12f64, log_t in -80.0..80.0f64) {
            let collision = Collision::new(m1, m2).unwrap();
            let t = 2.0_f64.powf(log_t);
            let sum = collision.kept(t) + collision.transferred(t);
            prop_assert!((sum - 1.0).abs() < 1.5e-15, "{sum}"); // seven roundings of numbers up to 1
        }
        #[test]
        fn momentum_is_conserved_across_the_beam(m1 in 0.01..100.0f64, m2 in 0.01..100.0f64, log_t in -20.0..20.0f64) {
            let collision = Collision::new(m1, m2).unwrap();
            let t = 2.0_f64.powf(log_t);
            let across = (m1 * collision.kept(t)).sqrt() * sin_cos(collision.lab_angle(t)).0;
            let recoil = (m2 * collision.transferred(t)).sqrt() * sin_cos(recoil_angle(t)).0;
            // The angle carries 2e-16 relative, π - angle only 4e-16 absolute: hence the second term.
            let scale = across.abs().max(recoil) + (m1 * collision.kept(t)).sqrt();
            prop_assert!((across - recoil).abs() < 2e-15 * scale, "{across} {recoil}");
        }
        #[test]
        fn the_branches_lead_back(m1 in 0.01..100.0f64, m2 in 0.01..100.0f64, log_t in -10.0..10.0f64) {
            let collision = Collision::new(m1, m2).unwrap();
            let t = 2.0_f64.powf(log_t);
            let cm = cm_angle(t);
            let branches = collision.branches(collision.lab_angle(t));
            let nearest = branches.iter().flatten().map(|b| (b.0 - cm).abs()).fold(9.0, f64::min);
            // Ill-conditioned as the square root at the greatest angle, hence the wide margin.
            prop_assert!(nearest < 1e-6, "{nearest:e}");
        }
        #[test]
        fn nothing_is_ever_not_a_number(log_ratio in -1000.0..1000.0f64, log_t in -490.0..490.0f64) {
            for (m1, m2) in [(2.0_f64.powf(log_ratio), 1.0), (1.0, 1.0), (3.0, 3.0)] {
                let collision = Collision::new(m1, m2).unwrap();
                for t in [0.0, 2.0_f64.powf(log_t)] {
                    let values = [
                        collision.lab_angle(t), collision.transferred(t), collision.kept(t), cm_angle(t), recoil_angle(t),
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
        assert_eq!((cm_angle(0.0), recoil_angle(0.0), light.lab_angle(0.0)), (PI, 0.0, PI));
        assert!((light.kept(0.0) - 0.36).abs() < 1e-16 && (light.transferred(0.0) - 0.64).abs() < 2e-16);
        assert_eq!(Collision::new(2.0, 2.0).unwrap().lab_angle(0.0), FRAC_PI_2);
        assert_eq!(Collision::new(2.0, 2.0).unwrap().kept(0.0), 0.0);
        assert_eq!(Collision::new(4.0, 1.0).unwrap().lab_angle(0.0), 0.0);
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
