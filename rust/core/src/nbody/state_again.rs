//! The state that elements were found of, from all of them at once.
//!
//! The one idea: near e = 1 neither 1 − e nor the true anomaly tells the place, but the axes a and b, the pericenter
//! q and the eccentric anomaly do. With g₁ = sin E, g₂ = 1 − cos E, or sinh H and cosh H − 1: x = q ∓ a g₂, y = b g₁
//! and r = q + a e g₂ (the lower sign repels), where nothing cancels that the anomaly does not itself leave open.
//! Source: Danby, *Fundamentals of Celestial Mechanics* (1988) §6.2–6.8.

use super::state::{Anomaly, Plane, Shape, state_from_elements};
use crate::error::Result;
use crate::numerics::angles::sin_cos;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::stumpff::UniversalFunctions;
use core::f64::consts::PI;
use nalgebra::Vector3;

/// Elements that say the same thing more than once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllElements {
    /// Size and place, as the least that is needed.
    pub shape: Shape,
    /// Per unit mass: its sign is the kind of the conic, also where e rounds to 1.
    pub energy: f64,
    /// a > 0, infinite for a parabola.
    pub semi_major_axis: f64,
    /// b = a √|1 − e²|.
    pub semi_minor_axis: f64,
    /// From the pericenter, in (−π, π].
    pub true_anomaly: f64,
    /// E, H or D.
    pub eccentric_anomaly: f64,
    /// E − e sin E, e sinh H ∓ H, or D + D³/3.
    pub mean_anomaly: f64,
}

/// Numbers that are rounded by the same state agree to this, with their conditioning.
const AGREEMENT: f64 = 64.0 * f64::EPSILON;

/// Position and velocity of elements that were found of a state. Where some do not agree with the others, since they
/// were changed or left out (NaN), they are those of the shape and the true anomaly.
///
/// # Errors
/// As [`state_from_elements`]; for radial motion, which has no angles.
pub fn state_of_all(mu: f64, all: &AllElements) -> Result<(Vector3<f64>, Vector3<f64>)> {
    let plane = if all.energy == 0.0 { all.on_parabola(mu) } else { all.on_axes(mu) };
    match plane {
        Some(plane) => Ok(plane.in_space(&all.shape.directions()?)),
        None => state_from_elements(mu, all.shape, Anomaly::True(all.true_anomaly)),
    }
}

impl AllElements {
    fn on_parabola(&self, mu: f64) -> Option<Plane> {
        let (d, q) = (self.eccentric_anomaly, self.shape.pericenter);
        let r = 1.0 + d * d;
        let place = [(1.0 - d) * (1.0 + d), 2.0 * d];
        let speed = core::f64::consts::SQRT_2 * circular_speed(mu, q);
        let agrees = mu > 0.0 && self.shape.eccentricity == 1.0 && self.semi_major_axis == f64::INFINITY;
        (agrees && self.points_to(place, r, r) && (r * q).is_finite() && speed.is_finite()).then_some(Plane {
            place,
            length: q,
            rate: [-d / r, 1.0 / r],
            speed,
        })
    }

    fn on_axes(&self, mu: f64) -> Option<Plane> {
        let Self { shape: Shape { pericenter: q, eccentricity: e, .. }, semi_major_axis: a, .. } = *self;
        let b = self.semi_minor_axis;
        let bound = self.energy < 0.0;
        let side = if mu > 0.0 { 1.0 } else { -1.0 };
        if !self.has_one_size(mu) {
            return None;
        }
        let [g0, g1, g2] = if bound { self.circular() } else { self.hyperbolic(side) };
        let place = [q - side * (a * g2), b * g1];
        let r = q + (a * e) * g2;
        let rate = [-side * (a * g1 / r), b * g0 / r];
        let speed = circular_speed(mu, a);
        let finite = r > 0.0 && place.iter().chain(&rate).all(|x| x.is_finite()) && speed.is_finite();
        // By how much the place moves with the relative error of the anomaly.
        let felt = self.eccentric_anomaly.abs() * ((a * g1).abs() + (b * g0).abs());
        (finite && self.points_to(place, r, r + felt)).then_some(Plane { place, length: 1.0, rate, speed })
    }

    /// Whether a, b, q and e are those of one conic.
    fn has_one_size(&self, mu: f64) -> bool {
        let Self { shape: Shape { pericenter: q, eccentricity: e, .. }, semi_major_axis: a, .. } = *self;
        let bound = self.energy < 0.0;
        let kind = if bound { mu > 0.0 && e <= 1.0 } else { e >= 1.0 };
        let (departure, ratio) = (if mu > 0.0 { (1.0 - e).abs() } else { 1.0 + e }, self.semi_minor_axis / a);
        // b² = a q (1 + e), without 1 − e, which has no digits near 1; of repulsion a q (e − 1), where it has none either.
        let (square, size) = if mu > 0.0 {
            (q / a * (1.0 + e), q / a * (1.0 + e))
        } else {
            (q / a * (e - 1.0), (1.0 + e) * (1.0 + e))
        };
        kind && a > 0.0
            && a.is_finite()
            && (q / a - departure).abs() <= AGREEMENT * (1.0 + e)
            && (ratio * ratio - square).abs() <= AGREEMENT * size
    }

    /// Whether the true anomaly is that of a place at the distance `r`, which may be off by what goes with `size`.
    fn points_to(&self, [x, y]: [f64; 2], r: f64, size: f64) -> bool {
        let (sine, cosine) = sin_cos(self.true_anomaly);
        (x / r * sine - y / r * cosine).abs() <= AGREEMENT * (size / r) && x / r * cosine + y / r * sine > 0.0
    }

    /// cos E, sin E and 1 − cos E.
    fn circular(&self) -> [f64; 3] {
        let angle = self.eccentric_anomaly;
        let (sine, cosine) = sin_cos(angle);
        let (half, _) = sin_cos(0.5 * angle);
        // The number π stands for the apocenter itself, where a long ellipse would feel what it lacks.
        [cosine, if angle.abs() == PI { 0.0 } else { sine }, 2.0 * half * half]
    }

    /// cosh H, sinh H and cosh H − 1.
    fn hyperbolic(&self, side: f64) -> [f64; 3] {
        let (h, e) = (self.eccentric_anomaly, self.shape.eccentricity);
        // Far out H has lost digits of its exponential, which the mean anomaly still has.
        let sine = (self.mean_anomaly + side * h) / e;
        let g = UniversalFunctions::<f64>::new(-1.0, h);
        let agrees = (sine - g.g1).abs() <= AGREEMENT * (1.0 + h.abs()) * g.g0;
        if h.abs() < 1.0 || !agrees {
            return [g.g0, g.g1, g.g2];
        }
        let cosine = sine.hypot(1.0);
        [cosine, sine, sine * (sine / (1.0 + cosine))]
    }
}

/// √(|μ|/r), without leaving the range on the way.
fn circular_speed(mu: f64, r: f64) -> f64 {
    let near = exponent(r);
    let unit = (exponent(mu) - near).div_euclid(2);
    scale((scale(mu.abs(), -near - 2 * unit) / scale(r, -near)).sqrt(), unit)
}
