//! Circular orbits: what they need, and whether they last.

use super::landscape::Landscape;
use crate::numerics::power_of_two::scale;
use core::f64::consts::PI;

/// A circle, in the caller's units.
#[derive(Clone, Copy, Debug)]
pub struct Circle {
    /// Its radius.
    pub radius: f64,
    /// E = V + r V′/2.
    pub energy: f64,
    /// l = √(m r³ V′).
    pub angular_momentum: f64,
    /// ω = √(V′/mr).
    pub angular_velocity: f64,
    /// √((3V′/r + V″)/m), the frequency of a small radial oscillation; below zero the rate at which one grows.
    pub radial_rate: f64,
    /// The angle π ω/ω_r from pericenter to apocenter of an orbit nearby; NaN where there is none.
    pub apsidal_angle: f64,
}

impl Landscape {
    /// The circle of a radius; nothing where the force repels.
    pub fn circle(&self, radius: f64, mass: f64) -> Option<Circle> {
        let field = self.field();
        let (length, energy) = field.units();
        let r = field.take_length(radius);
        let [value, force, curvature] = field.at(r);
        let slope = -force;
        if slope < 0.0 || slope.is_nan() {
            return None;
        }
        let square = 3.0 * slope / r + curvature;
        let ratio = (square / (slope / r)).sqrt();
        Some(Circle {
            radius,
            energy: field.give_energy(value + 0.5 * r * slope),
            angular_momentum: scale(r * (r * slope * mass).sqrt(), length + energy / 2),
            // Neither r³ nor m r³ need be within the range of numbers.
            angular_velocity: scale((slope / r).sqrt() / mass.sqrt(), energy / 2 - length),
            radial_rate: scale(square.abs().sqrt().copysign(square) / mass.sqrt(), energy / 2 - length),
            apsidal_angle: PI / ratio,
        })
    }
}
