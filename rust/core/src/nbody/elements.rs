//! The elements of a conic from a state; free fall. The way back is in `state.rs`.
//!
//! The one idea: the same double-double preparation as the propagator, so that e, the apsides and the anomalies are
//! right to a few ulps even for e near 0 or 1. Attraction and repulsion share every formula through the
//! Laplace–Runge–Lenz vector A = v×L − μ r̂ (per unit mass), which points to the pericenter and has length |μ| e.
//! Conventions: lengths a, b are positive for hyperbolas too; angles in radians; x the reference direction, z the pole.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. §3.7–3.9; hodograph: Hamilton (1847).

use super::conic::Conic;
use super::constants::dynamical_time;
use super::kepler::KeplerOrbit;
use crate::error::{Error, Result};
use crate::numerics::angles::atan2;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::words::number;
use core::f64::consts::{FRAC_PI_2, PI};
use nalgebra::Vector3;

/// The elements of an orbit about a fixed center, all per unit mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Elements {
    /// r×v.
    pub angular_momentum: Vector3<f64>,
    /// v²/2 − μ/r.
    pub energy: f64,
    /// v×L − μ r̂: towards the pericenter, length |μ| e.
    pub laplace_runge_lenz: Vector3<f64>,
    /// The velocities lie on a circle about this point (radial motion has none: NaN).
    pub hodograph_center: Vector3<f64>,
    /// |μ|/L; infinite for radial motion.
    pub hodograph_radius: f64,
    /// e.
    pub eccentricity: f64,
    /// a = |μ|/|2 energy| > 0; infinite for a parabola.
    pub semi_major_axis: f64,
    /// b = a √|1 − e²|, the impact parameter of a hyperbola.
    pub semi_minor_axis: f64,
    /// L²/|μ|.
    pub semi_latus_rectum: f64,
    /// Least distance.
    pub pericenter: f64,
    /// Greatest distance; infinite if unbound.
    pub apocenter: f64,
    /// Angle of L from z, in [0, π]; radial motion: NaN, as the two angles below.
    pub inclination: f64,
    /// Angle of the ascending node from x, in (−π, π]; 0 where the orbit lies in the xy plane.
    pub node: f64,
    /// Angle of the pericenter from the node along the motion, in (−π, π].
    pub argument_of_pericenter: f64,
    /// Angle of the body from the pericenter, in (−π, π].
    pub true_anomaly: f64,
    /// E of an ellipse in (−π, π], H of a hyperbola, D = tan(ν/2) of a parabola.
    pub eccentric_anomaly: f64,
    /// E − e sin E, e sinh H ∓ H, or D + D³/3.
    pub mean_anomaly: f64,
    /// Time since the nearest pericenter (negative before it).
    pub time_since_pericenter: f64,
    /// 2π √(a³/μ); infinite if unbound.
    pub period: f64,
    /// L/2.
    pub areal_rate: f64,
    /// The angle 2 arcsin(1/e) by which a hyperbola turns the velocity; NaN if bound, π for a parabola.
    pub turning_angle: f64,
}

impl Elements {
    /// From a state; `mu` > 0 attracts, `mu` < 0 repels.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] if an argument is not finite, `position` is zero, or `mu` is zero or negligible
    /// (below 2⁻³⁰⁰ r v²): a straight line is no conic.
    pub fn from_state(mu: f64, position: Vector3<f64>, velocity: Vector3<f64>) -> Result<Self> {
        let orbit = KeplerOrbit::new(mu, position, velocity)?;
        match &orbit.conic {
            Some(conic) => Ok(Self::from_conic(conic, orbit.length, orbit.speed)),
            None => Err(Error::invalid(
                "mu",
                format!("expected a force that bends the path, got mu = {}", number(mu)),
            )),
        }
    }

    fn from_conic(conic: &Conic, length: i32, speed: i32) -> Self {
        let lengths = |x: f64| scale(x, length);
        let strength = DoubleDouble::from(conic.mu).abs();
        let (beta, h, zeta) = (conic.beta, conic.angular_momentum, conic.zeta);
        let size = beta.abs();
        let rate = size.sqrt();
        let h_size = h.to_f64();
        let e = (zeta / strength).to_f64();
        let parabola = beta.to_f64() == 0.0;
        let bound = beta.to_f64() > 0.0;
        let (cosine, sine) = conic.true_anomaly;

        // From the anchoring apsis to the pericenter: half a turn, half a period.
        let half = if conic.epoch.to_f64() > 0.0 { -DoubleDouble::PI } else { DoubleDouble::PI };
        let mut angle = rate * conic.epoch;
        let mut since = conic.since_apsis;
        let mean_rate = size * rate / strength;
        let mut mean = mean_rate * since;
        if let (true, Some(period)) = (conic.from_apocenter, conic.period) {
            angle += half;
            mean += half;
            since += if conic.epoch.to_f64() > 0.0 { -period.scale(0.5) } else { period.scale(0.5) };
        }
        let (eccentric, mean) = if parabola {
            let d = strength * conic.epoch / h;
            (d, d + d * d * d / DoubleDouble::from(3.0))
        } else {
            (angle, mean)
        };

        let normal = conic.normal;
        let nodal = Vector3::new(-normal.y, normal.x, 0.0);
        let in_plane = (normal.x * normal.x + normal.y * normal.y).sqrt();
        let line = if in_plane > 0.0 { nodal / in_plane } else { Vector3::x() };
        let (inclination, node, argument) = if h_size > 0.0 {
            let across = normal.cross(&line);
            (
                atan2(in_plane, normal.z),
                atan2(line.y, line.x),
                atan2(conic.towards.dot(&across), conic.towards.dot(&line)),
            )
        } else {
            (f64::NAN, f64::NAN, f64::NAN)
        };
        // sin(χ/2) = 1/e and cos(χ/2) = √(e² − 1)/e: tan(χ/2) = |μ|/(L √−β).
        let turning = if bound { f64::NAN } else { 2.0 * atan2(strength.to_f64(), h_size * rate.to_f64()) };
        // Component by component: 0 · ∞ is no number where the length overflows.
        let along = |direction: Vector3<f64>, size: f64, unit: i32| direction.map(|c| scale(c * size, unit));
        let infinite_if = |condition: bool, value: f64| if condition { f64::INFINITY } else { value };
        Self {
            angular_momentum: along(normal, h_size, length + speed),
            energy: scale(-0.5 * beta.to_f64(), 2 * speed),
            laplace_runge_lenz: along(conic.towards, zeta.to_f64(), length + 2 * speed),
            hodograph_center: along(conic.along, (zeta / h).to_f64(), speed),
            hodograph_radius: infinite_if(h_size == 0.0, scale((strength / h).to_f64(), speed)),
            eccentricity: e,
            semi_major_axis: infinite_if(parabola, lengths((strength / size).to_f64())),
            semi_minor_axis: infinite_if(parabola, lengths((h / rate).to_f64())),
            semi_latus_rectum: lengths((h * h / strength).to_f64()),
            pericenter: lengths(conic.pericenter.to_f64()),
            apocenter: infinite_if(!bound, lengths(conic.apocenter)),
            inclination,
            node,
            argument_of_pericenter: argument,
            // On a straight line half a turn to either side: after the pericenter or before it.
            true_anomaly: if sine == 0.0 && cosine < 0.0 {
                PI.copysign(since.to_f64())
            } else {
                atan2(sine, cosine)
            },
            eccentric_anomaly: eccentric.to_f64(),
            mean_anomaly: mean.to_f64(),
            time_since_pericenter: scale(since.to_f64(), length - speed),
            period: infinite_if(
                !bound,
                scale(conic.period.map_or(0.0, DoubleDouble::to_f64), length - speed),
            ),
            areal_rate: scale(0.5 * h_size, length + speed),
            turning_angle: turning,
        }
    }
}

/// The time to fall from rest at the distance `start` to the distance `end` ≤ `start` of an attracting centre.
///
/// t = √(R³/(2μ)) (θ + sin θ cos θ) with r = R cos²θ; to the center itself π √(R³/(8μ)).
///
/// # Errors
/// [`Error::InvalidInput`] unless `mu` > 0 and 0 ≤ `end` ≤ `start`, all finite, `start` > 0.
pub fn free_fall_time(mu: f64, start: f64, end: f64) -> Result<f64> {
    for (name, value) in [("mu", mu), ("start", start)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::invalid(name, format!("expected a positive number, got {}", number(value))));
        }
    }
    if !(0.0..=start).contains(&end) {
        return Err(Error::invalid(
            "end",
            format!("expected a distance from 0 to start = {}, got {}", number(start), number(end)),
        ));
    }
    let (fallen, left) = ((start - end) / start, end / start);
    let angle = if end == 0.0 { FRAC_PI_2 } else { atan2(fallen.sqrt(), left.sqrt()) };
    Ok(core::f64::consts::FRAC_1_SQRT_2 * dynamical_time(mu, start) * (angle + (fallen * left).sqrt()))
}
