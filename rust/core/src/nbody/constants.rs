//! What is constant on a conic, for a body of mass m in V(r) = −γ/r, and the times that follow from it.
//!
//! The one idea: energy and angular momentum alone give the shape, e² = 1 + 2El²/(mγ²); the sum is made in
//! double-double, so a near-circle keeps what the two given numbers say. γ > 0 attracts, γ < 0 repels.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. §3.7–3.8.

use super::elements::Elements;
use crate::error::{Error, Result};
use crate::numerics::angles::atan2;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::cbrt;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;
use crate::words::number;
use core::f64::consts::PI;
use nalgebra::Vector3;

/// The constants of a conic; lengths are positive for hyperbolas too.
#[derive(Clone, Debug, PartialEq)]
pub struct ConicConstants {
    /// l = m |r×v|.
    pub angular_momentum: f64,
    /// E = m v²/2 − γ/r.
    pub energy: f64,
    /// e.
    pub eccentricity: f64,
    /// a = |γ/2E|; infinite for a parabola.
    pub semi_major_axis: f64,
    /// b = a √|1 − e²|; infinite for a parabola.
    pub semi_minor_axis: f64,
    /// l²/(m|γ|).
    pub semi_latus_rectum: f64,
    /// Least distance.
    pub r_min: f64,
    /// Greatest distance; infinite if unbound.
    pub r_max: f64,
    /// 2π √(m a³/γ); infinite if unbound.
    pub period: f64,
    /// l/2m.
    pub areal_rate: f64,
    /// The angle by which a hyperbola turns the velocity; NaN if bound, π for a parabola.
    pub turning_angle: f64,
}

fn check_mass(mass: f64, strength: f64) -> Result<()> {
    if !(mass.is_finite() && mass > 0.0) {
        return Err(Error::invalid("mass", format!("expected a positive number, got {}", number(mass))));
    }
    if !(strength.is_finite() && strength != 0.0) {
        return Err(Error::invalid(
            "strength",
            format!("expected a finite number other than 0, got {}", number(strength)),
        ));
    }
    Ok(())
}

impl ConicConstants {
    /// From a state; the rounding of γ/m is an error of half an ulp in γ.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a mass that is not positive, a strength of zero, what is not finite, and r = 0.
    pub fn from_state(
        mass: f64,
        strength: f64,
        position: Vector3<f64>,
        velocity: Vector3<f64>,
    ) -> Result<Self> {
        check_mass(mass, strength)?;
        let elements =
            Elements::from_state(strength / mass, position, velocity).map_err(|error| match error {
                Error::InvalidInput { argument, message } if argument == "mu" => {
                    Error::invalid("strength", message)
                }
                other => other,
            })?;
        Ok(Self {
            angular_momentum: 2.0 * mass * elements.areal_rate,
            energy: mass * elements.energy,
            eccentricity: elements.eccentricity,
            semi_major_axis: elements.semi_major_axis,
            semi_minor_axis: elements.semi_minor_axis,
            semi_latus_rectum: elements.semi_latus_rectum,
            r_min: elements.pericenter,
            r_max: elements.apocenter,
            period: elements.period,
            areal_rate: elements.areal_rate,
            turning_angle: elements.turning_angle,
        })
    }

    /// From the angular momentum l ≥ 0 and the energy E.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a mass that is not positive, a strength of zero, l < 0, what is not finite, and an
    /// energy below that of the circle, −mγ²/2l² (repulsion: not above 0). Rounding below the circle is forgiven.
    pub fn from_constants(mass: f64, strength: f64, angular_momentum: f64, energy: f64) -> Result<Self> {
        check_mass(mass, strength)?;
        if !(angular_momentum.is_finite() && angular_momentum >= 0.0) {
            let message = format!("expected a finite number ≥ 0, got {}", number(angular_momentum));
            return Err(Error::invalid("angular_momentum", message));
        }
        if !energy.is_finite() || (strength < 0.0 && energy <= 0.0) {
            let expected =
                if strength < 0.0 { "a positive energy, for repulsion" } else { "a finite number" };
            return Err(Error::invalid("energy", format!("expected {expected}, got {}", number(energy))));
        }
        if angular_momentum == 0.0 && energy == 0.0 {
            return Err(Error::invalid(
                "energy",
                "expected a number other than 0 where the angular momentum is 0",
            ));
        }
        // Per unit mass, in powers of two in which the strength and the energy (else l) are of order one.
        let per_mass = |x: f64| {
            let (up, down) = (exponent(x), exponent(mass));
            (DoubleDouble::from(scale(x, -up)) / DoubleDouble::from(scale(mass, -down)), up - down)
        };
        let (mu, mu_exponent) = per_mass(strength);
        let (binding, energy_exponent) = per_mass(-energy);
        let (h, h_exponent) = per_mass(angular_momentum);
        let speed = if energy == 0.0 { mu_exponent - h_exponent } else { energy_exponent.div_euclid(2) };
        let length = mu_exponent - 2 * speed;
        let beta = scaled(binding.scale(2.0), energy_exponent - 2 * speed);
        // Far from order one the angular momentum is in one term alone, or in none: it is taken nearer, by 2^`rest`,
        // and each constant moved by the power of it that it then goes with.
        let size_of_h = h_exponent - length - speed;
        let rest = size_of_h - size_of_h.clamp(-250, 250);
        let h = scaled(h, size_of_h - rest);
        let size = beta.abs();
        let rate = size.sqrt();
        let strength_size = mu.abs();
        let mut square = mu * mu - beta * h * h;
        if square.to_f64() < 0.0 {
            // l²E within a few roundings of the circle's is the circle.
            if square.to_f64() < -4.0 * f64::EPSILON * (mu * mu).to_f64() {
                let least = -0.5 * mass * (strength / angular_momentum) * (strength / angular_momentum)
                    / (mass * mass);
                let message = format!(
                    "expected at least {}, the energy of the circle, got {}",
                    number(least),
                    number(energy)
                );
                return Err(Error::invalid("energy", message));
            }
            square = DoubleDouble::zero();
        }
        let zeta = square.sqrt();
        let (bound, parabola) = (energy < 0.0, energy == 0.0);
        let lengths = |x: DoubleDouble, power: i32| scale(x.to_f64(), length + power);
        let infinite_unless = |finite: bool, value: f64| if finite { value } else { f64::INFINITY };
        let pericenter = if mu.to_f64() > 0.0 { h * h / (mu + zeta) } else { (zeta - mu) / size };
        Ok(Self {
            angular_momentum,
            energy,
            eccentricity: scale((zeta / strength_size).to_f64(), rest.max(0)),
            semi_major_axis: infinite_unless(!parabola, lengths(strength_size / size, 0)),
            semi_minor_axis: infinite_unless(!parabola, lengths(h / rate, rest)),
            semi_latus_rectum: lengths(h * h / strength_size, 2 * rest),
            r_min: lengths(pericenter, if rest > 0 { rest } else { 2 * rest * i32::from(mu.to_f64() > 0.0) }),
            r_max: infinite_unless(bound, lengths((mu + zeta) / size, 0)),
            period: infinite_unless(
                bound,
                scale((DoubleDouble::PI.scale(2.0) * mu / (size * rate)).to_f64(), length - speed),
            ),
            areal_rate: scale(0.5 * h.to_f64(), length + speed + rest),
            turning_angle: if bound {
                f64::NAN
            } else {
                2.0 * atan2(strength_size.to_f64(), scale((h * rate).to_f64(), rest))
            },
        })
    }
}

/// x · 2^exponent.
pub(super) fn scaled(x: DoubleDouble, exponent: i32) -> DoubleDouble {
    DoubleDouble::new(scale(x.high(), exponent), scale(x.low(), exponent))
}

/// √(R³/μ), whatever the units.
pub(super) fn dynamical_time(mu: f64, length: f64) -> f64 {
    let (long, strong) = (exponent(length), exponent(mu));
    let odd = (long - strong).rem_euclid(2);
    let (fraction, mu) = (scale(length, -long), scale(mu, -strong));
    let root = (fraction / mu * if odd == 1 { 2.0 } else { 1.0 }).sqrt();
    scale(fraction * root, long + (long - strong - odd) / 2)
}

/// The period 2π √(a³/μ) of an ellipse.
///
/// # Errors
/// [`Error::InvalidInput`] unless both are positive and finite.
pub fn period(mu: f64, semi_major_axis: f64) -> Result<f64> {
    for (name, value) in [("mu", mu), ("semi_major_axis", semi_major_axis)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::invalid(name, format!("expected a positive number, got {}", number(value))));
        }
    }
    Ok(2.0 * PI * dynamical_time(mu, semi_major_axis))
}

/// The semi-major axis of an ellipse with the given period, ∛(μ (T/2π)²).
///
/// # Errors
/// [`Error::InvalidInput`] unless both are positive and finite.
pub fn semi_major_axis(mu: f64, period: f64) -> Result<f64> {
    for (name, value) in [("mu", mu), ("period", period)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::invalid(name, format!("expected a positive number, got {}", number(value))));
        }
    }
    // In powers of two of which the cube root is one, too.
    let (strong, long) = (exponent(mu), exponent(period));
    let rest = (strong + 2 * long).rem_euclid(3);
    let time = DoubleDouble::from(scale(period, -long)) / DoubleDouble::PI.scale(2.0);
    let cube = time * time * DoubleDouble::from(scale(mu, rest - strong));
    Ok(scale(cbrt(cube.to_f64()), (strong + 2 * long - rest) / 3))
}
