//! A state from the elements of a conic; the way back is in `elements.rs`, and `state_again.rs` has a state from all of them.
//!
//! The one idea: position and velocity in the plane of the motion from whichever anomaly is given, each by the formula
//! that keeps its digits: none goes by way of another angle, so nothing is lost near e = 1 or near an asymptote.
//! Source: Danby, *Fundamentals of Celestial Mechanics* (1988) §6.2–6.8; Goldstein, Poole & Safko, *Classical
//! Mechanics* 3rd ed. §3.7–3.8.

use super::anomalies::{eccentric_anomaly, hyperbolic_anomaly, parabolic_anomaly};
use crate::error::{Error, Result};
use crate::numerics::angles::sin_cos;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::stumpff::UniversalFunctions;
use crate::words::{number, numbers};
use core::f64::consts::{PI, SQRT_2};
use nalgebra::Vector3;

/// Where on its conic a body is, by one of the three anomalies as [`Elements`](super::elements::Elements) has them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Anomaly {
    /// Angle from the pericenter.
    True(f64),
    /// E of an ellipse, H of a hyperbola, D = tan(ν/2) of a parabola.
    Eccentric(f64),
    /// E − e sin E, e sinh H ∓ H, or D + D³/3.
    Mean(f64),
}

/// Size and place of a conic: pericenter distance, eccentricity, and inclination, node and argument of pericenter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Least distance, above 0; for a given semi-major axis a|1 − e| (repulsive: a(e + 1)).
    pub pericenter: f64,
    /// e ≥ 0; for repulsion e > 1.
    pub eccentricity: f64,
    /// In [0, π].
    pub inclination: f64,
    /// Angle of the ascending node from x.
    pub node: f64,
    /// Angle of the pericenter from the node along the motion.
    pub argument_of_pericenter: f64,
}

/// Position and velocity on a conic; `mu` > 0 attracts, `mu` < 0 repels.
///
/// # Errors
/// [`Error::InvalidInput`] for arguments out of range, for a true anomaly on or beyond an asymptote, and for a place
/// that float64 does not hold.
pub fn state_from_elements(mu: f64, shape: Shape, anomaly: Anomaly) -> Result<(Vector3<f64>, Vector3<f64>)> {
    let Shape { pericenter, eccentricity: e, .. } = shape;
    if !mu.is_finite() || mu == 0.0 {
        return Err(Error::invalid(
            "mu",
            format!("expected a finite number other than 0, got {}", number(mu)),
        ));
    }
    if !(pericenter.is_finite() && pericenter > 0.0) {
        return Err(Error::invalid(
            "pericenter",
            format!("expected a positive distance, got {}", number(pericenter)),
        ));
    }
    if !(e.is_finite() && e >= 0.0 && (mu > 0.0 || e > 1.0)) {
        return Err(Error::invalid(
            "eccentricity",
            format!("expected e ≥ 0 (mu < 0: e > 1), got {}", number(e)),
        ));
    }
    let directions = shape.directions()?;
    let plane = match anomaly {
        Anomaly::True(nu) => from_true(mu, pericenter, e, nu)?,
        Anomaly::Eccentric(eccentric) => {
            from_eccentric(mu, pericenter, e, eccentric, ("eccentric_anomaly", eccentric))?
        }
        Anomaly::Mean(mean) => {
            let found = if e < 1.0 {
                eccentric_anomaly(mean, e)
            } else if e > 1.0 {
                hyperbolic_anomaly(mean, e, mu < 0.0)
            } else {
                Ok(parabolic_anomaly(mean))
            };
            let eccentric = found.map_err(|error| match error {
                Error::InvalidInput { argument, message } if argument == "mean" => {
                    Error::invalid("mean_anomaly", message)
                }
                other => other,
            })?;
            from_eccentric(mu, pericenter, e, eccentric, ("mean_anomaly", mean))?
        }
    };
    Ok(plane.in_space(&directions))
}

impl Shape {
    /// The direction towards the pericenter, and that of the motion there.
    pub(super) fn directions(&self) -> Result<[Vector3<f64>; 2]> {
        let Self { inclination, node, argument_of_pericenter, .. } = *self;
        let angles = [inclination, node, argument_of_pericenter];
        if !angles.iter().all(|angle| angle.is_finite()) {
            return Err(Error::invalid(
                "angles",
                format!("expected finite angles, got {}", numbers(&angles)),
            ));
        }
        if !(0.0..=PI).contains(&inclination) {
            return Err(Error::invalid(
                "inclination",
                format!("expected an angle in radians from 0 to π, got {}", number(inclination)),
            ));
        }
        let (node_sine, node_cosine) = sin_cos(node);
        let (sine_i, cosine_i) = sin_cos(inclination);
        let (sine_w, cosine_w) = sin_cos(argument_of_pericenter);
        let line = Vector3::new(node_cosine, node_sine, 0.0);
        let across = Vector3::new(-node_sine * cosine_i, node_cosine * cosine_i, sine_i);
        Ok([line * cosine_w + across * sine_w, across * cosine_w - line * sine_w])
    }
}

/// Position and velocity in the plane of the motion, towards the pericenter and along the motion there, each in a unit.
pub(super) struct Plane {
    pub(super) place: [f64; 2],
    pub(super) length: f64,
    pub(super) rate: [f64; 2],
    pub(super) speed: f64,
}

impl Plane {
    pub(super) fn in_space(&self, [towards, along]: &[Vector3<f64>; 2]) -> (Vector3<f64>, Vector3<f64>) {
        let ([x, y], [u, v]) = (self.place, self.rate);
        ((towards * x + along * y) * self.length, (towards * u + along * v) * self.speed)
    }
}

fn from_true(mu: f64, pericenter: f64, e: f64, nu: f64) -> Result<Plane> {
    if !nu.is_finite() {
        return Err(Error::invalid("true_anomaly", format!("expected a finite angle, got {}", number(nu))));
    }
    let (half_sine, half_cosine) = sin_cos(0.5 * nu);
    // ±1 + e cos ν, without the cancellation at an apocenter far out or near ν = 0 of repulsion.
    let (shape, focal) = if mu > 0.0 {
        ((1.0 - e) + 2.0 * e * half_cosine * half_cosine, 1.0 + e)
    } else {
        ((e - 1.0) - 2.0 * e * half_sine * half_sine, e - 1.0)
    };
    // e ± cos ν likewise: where the motion is nearly radial, this is what is left of it across.
    let half = if mu > 0.0 { half_cosine } else { half_sine };
    let across = (e - 1.0) + 2.0 * half * half;
    if shape <= 0.0 {
        return Err(Error::invalid(
            "true_anomaly",
            format!("expected an angle inside the asymptotes of e = {}, got {}", number(e), number(nu)),
        ));
    }
    let (sine, cosine) = sin_cos(nu);
    let distance = pericenter * (focal / shape);
    // v = (μ/L)(−sin ν P + cos ν Q) + (|μ| e/L) Q, and |μ|/L = √(|μ|/p).
    if !distance.is_finite() {
        return Err(Error::invalid(
            "true_anomaly",
            format!("expected a point within the range of f64, got {}", number(nu)),
        ));
    }
    // In an even power of two.
    let unit = (exponent(mu) - exponent(pericenter)).div_euclid(2);
    let near = exponent(pericenter);
    let hodograph =
        scale((scale(mu.abs(), -near - 2 * unit) / scale(pericenter, -near) / focal).sqrt(), unit);
    let sign = mu.signum();
    Ok(Plane { place: [cosine, sine], length: distance, rate: [-sign * sine, across], speed: hodograph })
}

/// By E, H or D. In units of the pericenter distance q and of √(|μ|/q), with c = |1 − e| (repulsive: e + 1) = q/a and
/// g₂ = 1 − cos E or cosh H − 1: x = 1 ∓ g₂/c, r = 1 + e g₂/c, so that nothing cancels.
fn from_eccentric(mu: f64, q: f64, e: f64, eccentric: f64, given: (&str, f64)) -> Result<Plane> {
    let (place, rate) = if e == 1.0 {
        let d = eccentric;
        let r = 1.0 + d * d;
        ([(1.0 - d) * (1.0 + d), 2.0 * d], [-SQRT_2 * d / r, SQRT_2 / r])
    } else {
        let g = UniversalFunctions::<f64>::new(if e < 1.0 { 1.0 } else { -1.0 }, eccentric);
        let (sign, c, other) =
            if mu > 0.0 { (1.0, (1.0 - e).abs(), 1.0 + e) } else { (-1.0, 1.0 + e, e - 1.0) };
        let r = 1.0 + e * g.g2 / c;
        (
            [1.0 - sign * g.g2 / c, (other / c).sqrt() * g.g1],
            [-sign * g.g1 / (c.sqrt() * r), other.sqrt() * g.g0 / r],
        )
    };
    let speed = (mu.abs() / q).sqrt();
    if place.iter().all(|x| (x * q).is_finite()) && rate.iter().all(|v| (v * speed).is_finite()) {
        Ok(Plane { place, length: q, rate, speed })
    } else {
        let (name, value) = given;
        Err(Error::invalid(
            name,
            format!("expected a place within the range of float64, got {}", number(value)),
        ))
    }
}
