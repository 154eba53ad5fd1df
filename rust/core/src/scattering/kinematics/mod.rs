//! Two-body kinematics: a projectile of mass m₁ on a target of mass m₂ at rest.
//!
//! The one idea: a collision is given by sine and cosine of half the scattering angle ψ of the
//! centre-of-mass frame, and what each body does in the laboratory by a circle of velocities ([`Circle`]).
//! Everything else is algebra that keeps relative precision at both ends, head-on and forward.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* (3rd ed.), §3.11; Landau & Lifshitz,
//! *Mechanics*, §17; Evans, *The Atomic Nucleus* (1955), ch. 12 (reactions).

mod circle;
mod elastic;
mod encounter;
mod half_angle;

pub use circle::Circle;
pub use elastic::Collision;
pub use encounter::{Encounter, Product, Reaction};
pub use half_angle::HalfAngle;

use crate::numerics::angles::sin_cos;

/// The solid angle between the cones of two angles from an axis, without subtracting cosines.
pub fn solid_angle(from: f64, to: f64) -> f64 {
    4.0 * core::f64::consts::PI * sin_cos(0.5 * (from + to)).0 * sin_cos(0.5 * (to - from)).0
}
