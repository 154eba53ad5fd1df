//! Half the scattering angle, as sine and cosine: what all of the kinematics is written in.

use crate::numerics::angles::{atan2, sin_cos};

/// Half the scattering angle ψ in [0, π], as its sine and cosine up to a common factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfAngle {
    pub(super) sine: f64,
    pub(super) cosine: f64,
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
    /// Of sin(ψ/2) and cos(ψ/2), neither negative, up to a common factor.
    pub fn from_sine_and_cosine(sine: f64, cosine: f64) -> Self {
        Self { sine, cosine }
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
    /// Of π - ψ: the other body's, measured from the beam.
    pub fn mirrored(self) -> Self {
        Self { sine: self.cosine, cosine: self.sine }
    }
    pub(super) fn squares(self) -> (f64, f64) {
        (self.sine * self.sine, self.cosine * self.cosine)
    }
}
