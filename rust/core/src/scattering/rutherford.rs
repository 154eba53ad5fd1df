//! Coulomb scattering in closed form: V(r) = k/r, attractive or repulsive.
//!
//! The one idea: b = κ cot(ψ/2) with κ = k/2E, E the energy of relative motion ½μu².
//! Source: Rutherford, Phil. Mag. 21 (1911) 669; Landau & Lifshitz, *Mechanics*, §19.

use super::kinematics::{Collision, HalfAngle};
use crate::numerics::angles::{atan2, sin_cos};
use crate::numerics::power_of_two::{exponent, scale};

/// κ = k/2E: half the distance of closest approach of a repulsive head-on collision, signed like k.
pub fn half_distance(k: f64, energy: f64) -> f64 {
    // Of order one, so that nothing leaves the range on the way.
    let (strong, fast) = (exponent(k), exponent(energy));
    scale(scale(k, -strong) / scale(energy, -fast), strong - fast - 1)
}

/// The deflection: positive for repulsion, negative for attraction, ±π head-on.
pub fn deflection(half_distance: f64, impact_parameter: f64) -> f64 {
    let angle = 2.0 * atan2(half_distance.abs(), impact_parameter);
    if half_distance < 0.0 { -angle } else { angle }
}

/// The impact parameter of a scattering angle ψ in (0, π].
pub fn impact_parameter(half_distance: f64, cm_angle: f64) -> f64 {
    half_distance.abs() * HalfAngle::of(cm_angle).cotangent()
}

/// The distance of closest approach κ + √(κ² + b²), without cancellation for attraction.
pub fn closest_approach(half_distance: f64, impact_parameter: f64) -> f64 {
    let unit = exponent(half_distance.abs().max(impact_parameter));
    let (kappa, b) = (scale(half_distance, -unit), scale(impact_parameter, -unit));
    let root = (kappa * kappa + b * b).sqrt();
    if half_distance < 0.0 { impact_parameter * (b / (root - kappa)) } else { scale(kappa + root, unit) }
}

/// dσ/dΩ = (κ/2)²/sin⁴(ψ/2) in the centre-of-mass frame.
pub fn cross_section(half_distance: f64, cm_angle: f64) -> f64 {
    let sine = sin_cos(0.5 * cm_angle).0;
    let root = (0.5 * half_distance / sine) / sine;
    root * root
}

/// dσ/dΩ of the projectile in the laboratory, both branches together; 0 where none leads.
pub fn lab_cross_section(half_distance: f64, collision: Collision, lab_angle: f64) -> f64 {
    let weighted = |(angle, jacobian): (f64, f64)| {
        // A jacobian of 0 (equal masses across the beam) meets a finite cross section.
        if jacobian == 0.0 { 0.0 } else { jacobian * cross_section(half_distance, angle) }
    };
    collision.branches(lab_angle).into_iter().flatten().map(weighted).sum()
}

/// dσ/dΩ of the target in the laboratory, κ²/cos³ θ₂.
pub fn recoil_cross_section(half_distance: f64, recoil_angle: f64) -> f64 {
    let cosine = sin_cos(recoil_angle).1;
    let root = half_distance / cosine;
    root * root / cosine
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, expected: f64, relative: f64) {
        assert!((value / expected - 1.0).abs() < relative, "{value} against {expected}");
    }

    /// Catalogue G8.49-rutherford, either sign; measured 3e-16.
    #[test]
    fn golden_rutherford() {
        let kappa = half_distance(0.7, 1.3);
        close(deflection(kappa, 0.9), 0.581_344_961_826_399_6, 1e-15);
        close(deflection(-kappa, 0.9), -0.581_344_961_826_399_6, 1e-15);
        close(closest_approach(kappa, 0.9), 1.208_637_607_134_662_5, 1e-15);
        close(closest_approach(-kappa, 0.9), 0.670_176_068_673_124_1, 1e-15);
        close(cross_section(kappa, deflection(kappa, 0.9)), 2.685_996_811_979_230_2, 2e-15);
        close(impact_parameter(kappa, deflection(kappa, 0.9)), 0.9, 1e-15);
        assert_eq!(deflection(kappa, 0.0), core::f64::consts::PI);
    }

    /// b²/(2|κ|) at small b, of which κ + √(κ² + b²) keeps no digit; and what is a number at the ends of the range.
    #[test]
    fn extremes_keep_their_digits() {
        close(closest_approach(-1.0, 1e-9), 5e-19, 1e-15);
        close(closest_approach(-1e100, 1e-20), 5e-141, 1e-15);
        close(closest_approach(3e200, 4e200), 8e200, 1e-15);
        close(closest_approach(-3e-200, 4e-200), 2e-200, 1e-15);
        close(half_distance(1e300, 1.5e308), 1e300 / 1.5e308 / 2.0, 1e-15);
        close(cross_section(1e-200, 1e-160), 4e240, 1e-14);
        // cos of the nearest number to π/2 is 6.1e-17.
        let cosine = 6.123_233_995_736_766e-17_f64;
        close(
            recoil_cross_section(1e-170, core::f64::consts::FRAC_PI_2),
            (1e-170 / cosine).powi(2) / cosine,
            1e-14,
        );
    }

    /// Catalogue G8.44-rutherford-equal-mass-lab: κ² cos θ₁/sin⁴ θ₁ and κ²/cos³ θ₂.
    #[test]
    fn golden_equal_masses() {
        let collision = Collision::new(1.0, 1.0).unwrap();
        close(lab_cross_section(0.5, collision, 0.6), 2.029_908_308_473_717_5, 2e-15);
        close(recoil_cross_section(0.5, 0.5), 0.369_892_949_904_503_2, 2e-15);
        assert_eq!(lab_cross_section(0.5, collision, 2.0), 0.0);
    }
}
