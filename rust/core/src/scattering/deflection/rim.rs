//! What turns just within the rim of a table that still repels there.
//!
//! The one idea: so near to the rim r₀ has no digits left as a distance, but the depth s of r₀ below it has: V is there
//! F s + ½V″s², and the radial motion K = K₀ − ks − qs², which has its integrals in closed form. Without the depth it would be
//! a hard sphere.

use super::{Deflection, Status};
use crate::numerics::angles::atan2;
use crate::potentials::Potential;

/// How deep, as a part of the radius, …
const SHALLOW: f64 = 1e-6;
/// … and of the piece of the table that ends at the rim.
const OF_PIECE: f64 = 1e-3;

/// The rim of a table that repels there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rim {
    radius: f64,
    /// V, −dV/dr and d²V/dr² just within.
    value: f64,
    force: f64,
    curvature: f64,
    /// How large the third derivative is there, about.
    third: f64,
    /// How deep what comes may turn, to be told by them.
    depth: f64,
}

impl Rim {
    /// Of a potential that ends at a distance.
    pub(super) fn of(potential: &dyn Potential) -> Option<Self> {
        let radius = potential.domain()?.1;
        let [value, force, curvature] = potential.at(radius);
        let piece = radius - potential.breaks().into_iter().filter(|r| *r < radius).fold(0.0, f64::max);
        let depth = (SHALLOW * radius).min(OF_PIECE * piece);
        let [.., before] = potential.at(radius - 0.5 * piece);
        let third = ((curvature - before) / (0.5 * piece)).abs();
        (force > 0.0 && third.is_finite()).then_some(Self { radius, value, force, curvature, third, depth })
    }

    /// The deflection of a pair that turns so near to it, if it does.
    pub(super) fn deflection(&self, energy: f64, b: f64) -> Option<Deflection> {
        let radius = self.radius;
        if b >= radius {
            return None;
        }
        let across = ((radius - b) * (radius + b)).sqrt();
        let (speed, share) = (across / radius, b / radius);
        // K where V begins, if it leaves any.
        let within = (speed * speed - self.value / energy).max(0.0);
        let k = self.force / energy + 2.0 * share * share / radius;
        let q = 0.5 * self.curvature / energy + 3.0 * share * share / (radius * radius);
        let depth = within / k;
        let bent = q * depth / k;
        if depth > self.depth || bent.abs() > SHALLOW {
            return None;
        }
        let shallow = depth / radius;
        // The angle swept within is b times this: ∫ds/√K of 1/r² = (1 + 2s/R)/R², twice.
        let whole = 2.0 * within.sqrt() / (radius * radius * k);
        let part = 2.0 - 8.0 / 3.0 * (bent - shallow);
        let per_b = whole * part;
        // Along b.
        let (k_slope, q_slope) = (4.0 * share / (radius * radius), 6.0 * share / (radius * radius * radius));
        let within_slope = -2.0 * share / radius;
        let depth_slope = (within_slope - depth * k_slope) / k;
        let bent_slope = (q_slope * depth + q * depth_slope - bent * k_slope) / k;
        let part_slope = -8.0 / 3.0 * (bent_slope - depth_slope / radius);
        let logarithm = if within > 0.0 { 0.5 * within_slope / within } else { 0.0 } - k_slope / k;
        let slope = per_b * logarithm + whole * part_slope;
        let swept = b * per_b;
        let angle = 2.0 * atan2(across, b) - swept;
        // Squares are left out, and what V bends otherwise.
        let left_out = bent * bent + shallow * shallow + self.third * depth * depth / (energy * k);
        Some(Deflection {
            angle,
            complement: 2.0 * atan2(b, across) + swept,
            closest_approach: radius - depth * (1.0 - bent),
            derivative: -2.0 / across - per_b - b * slope,
            delay: -2.0 * across + radius * radius * whole * (2.0 - 8.0 / 3.0 * bent),
            error: 4.0 * f64::EPSILON * (angle.abs() + swept) + left_out * swept,
            turning_points: 1,
            status: Status::Scattered,
        })
    }
}
