//! What isotropic scattering does to a beam on the average: neutrons in a moderator.
//!
//! The one idea: with cos ψ uniform the energy that a target takes is uniform between 0 and q = 4m₁m₂/(m₁+m₂)².
//! Source: Reif, *Fundamentals of Statistical and Thermal Physics*, §12; Duderstadt & Hamilton, *Nuclear Reactor
//! Analysis* (1976), §2.I.

use super::kinematics::Collision;
use crate::numerics::elementary::ln;

/// Averages over one elastic collision, isotropic in the centre-of-mass frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moderation {
    /// The greatest part of the beam energy that a target takes, q.
    pub greatest_transfer: f64,
    /// The mean part, q/2.
    pub mean_transfer: f64,
    /// The least part that the projectile keeps, 1 - q.
    pub least_kept: f64,
    /// ⟨ln(E₀/E₁)⟩ = 1 + ((1-q)/q) ln(1-q).
    pub mean_logarithmic_decrement: f64,
    /// ⟨cos θ₁⟩ in the laboratory: 2m₁/3m₂, or 1 - (m₂/m₁)²/3 for m₁ > m₂.
    pub mean_cosine: f64,
}

impl Moderation {
    /// Of two masses.
    pub fn of(collision: Collision) -> Self {
        let (most, least) = (collision.greatest_transfer(), collision.kept_head_on());
        let circle = collision.circle();
        let mean_cosine = if circle.slow <= 0.0 {
            2.0 * (circle.frame / circle.own) / 3.0
        } else {
            let ratio = circle.own / circle.frame;
            1.0 - ratio * ratio / 3.0
        };
        Self {
            greatest_transfer: most,
            mean_transfer: 0.5 * most,
            least_kept: least,
            mean_logarithmic_decrement: decrement(most, least),
            mean_cosine,
        }
    }
}

fn decrement(most: f64, least: f64) -> f64 {
    if least == 0.0 {
        return 1.0;
    }
    if most > 0.5 {
        return 1.0 + least / most * ln(least);
    }
    // Σ qᵏ/(k(k+1)), where the form above cancels: from the smallest, of which 54 are below a rounding of the first.
    let terms = (1..=54).rev().map(f64::from);
    terms.fold(0.0, |rest, k| most * (1.0 / (k * (k + 1.0)) + rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn carbon_and_hydrogen() {
        let carbon = Moderation::of(Collision::new(1.0, 12.0).unwrap());
        // Catalogue G8.22.
        assert!((carbon.mean_logarithmic_decrement - 0.157_768_989_823_203_78).abs() < 1e-16);
        assert!((carbon.least_kept - 0.715_976_331_360_946_7).abs() < 2e-16);
        let hydrogen = Moderation::of(Collision::new(1.0, 1.0).unwrap());
        assert_eq!((hydrogen.mean_logarithmic_decrement, hydrogen.mean_transfer), (1.0, 0.5));
        // Both forms where they meet, and q/2 for a light target.
        assert!((decrement(0.5, 0.5) / (1.0 - 2.0_f64.ln()) - 1.0).abs() < 4e-16 * 3.0);
        assert!((decrement(1e-9, 1.0 - 1e-9) / (0.5e-9 + 1e-18 / 6.0) - 1.0).abs() < 4e-16);
    }
}
