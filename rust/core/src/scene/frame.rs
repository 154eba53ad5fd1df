//! The units and the origin in which a scene is integrated.
//!
//! Lengths, times and masses are divided by powers of two near the scene's own, which is exact and keeps
//! 1e±100 units from overflowing. A scene of pair forces that sits far from the origin, or moves fast as
//! a whole, is integrated about its centre of mass: the small differences that matter then keep their
//! digits. The centre is only moved away from the origin where that saves some.

pub use crate::units::Units;

use super::Scene;
use crate::numerics::double_double::two_sum;
use crate::numerics::power_of_two::exponent;

impl Units {
    /// Units near the scene's own sizes.
    pub fn of(scene: &Scene, offsets: &[Origin]) -> Self {
        let mut size = 0.0_f64;
        let mut speed = 0.0_f64;
        for copy in 0..scene.copies {
            let origin = offsets[copy];
            for (x, v) in scene.positions(copy).iter().zip(scene.velocities(copy)) {
                for c in 0..3 {
                    size = size.max((x[c] - origin.center[c]).abs());
                    speed = speed.max((v[c] - origin.drift[c]).abs());
                }
            }
        }
        let length = exponent(scene.forces.iter().map(|force| force.length()).fold(size, f64::max));
        let mass = exponent(scene.mass.iter().copied().fold(0.0, f64::max));
        // The time in which a force moves the largest mass over that length, else the crossing time.
        let massive = scene.mass.iter().any(|&mass| mass > 0.0);
        let given =
            scene.forces.iter().filter(|_| massive).find_map(|force| force.unit_of_time(length, mass));
        let time = given.unwrap_or(if speed > 0.0 { length - exponent(speed) } else { 0 });
        // One factor then takes a length or a velocity back to the scene's units.
        let time = time.clamp(length - 1000, length + 1000);
        Self { length, time, mass }
    }
}

/// Where the origin of the integration lies, and how it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Origin {
    /// Its place at the start.
    pub center: [f64; 3],
    /// Its velocity.
    pub drift: [f64; 3],
}

/// How far from the origin, in units of its own extent, a scene must sit to be moved.
const FAR: f64 = 8.0;

impl Origin {
    /// The origin for a copy of a scene; `closed` when only pair forces act.
    pub fn of(scene: &Scene, copy: usize, closed: bool) -> Self {
        if !closed {
            return Self::default();
        }
        let mass = scene.masses(copy);
        Self { center: far_mean(mass, scene.positions(copy)), drift: far_mean(mass, scene.velocities(copy)) }
    }

    /// A coordinate of the scene from one relative to this origin, as (nearest number, rest).
    #[inline]
    pub fn restore(&self, component: usize, relative: f64, elapsed: f64) -> (f64, f64) {
        let (center, drift) = (self.center[component], self.drift[component]);
        if center == 0.0 && drift == 0.0 {
            return (relative, 0.0);
        }
        let (moved, first) = two_sum(center, drift * elapsed);
        let (sum, second) = two_sum(moved, relative);
        (sum + (first + second), (sum - (sum + (first + second))) + (first + second))
    }
}

/// The mass-weighted mean of the points if it is far from zero compared with their extent, else zero.
fn far_mean(mass: &[f64], points: &[[f64; 3]]) -> [f64; 3] {
    let total: f64 = mass.iter().sum();
    let count = points.len() as f64;
    // Masses are divided first, so that 1e300-kilogram stars do not overflow the sum.
    let weight = |i: usize| if total > 0.0 { mass[i] / total } else { 1.0 / count };
    let mut mean = [0.0; 3];
    for (i, point) in points.iter().enumerate() {
        let weight = weight(i);
        for c in 0..3 {
            mean[c] += weight * point[c];
        }
    }
    let mut extent = 0.0_f64;
    for point in points {
        for c in 0..3 {
            extent = extent.max((point[c] - mean[c]).abs());
        }
    }
    let distance = mean.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    if distance.is_finite() && distance > FAR * extent { mean } else { [0.0; 3] }
}
