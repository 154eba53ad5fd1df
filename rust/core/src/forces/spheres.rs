//! Spheres in a fluid: which law of drag holds, and how strong it is.
//!
//! The Reynolds number is ρ a v/μ with the radius a. Stokes' law, −6πaμ v, holds far below 1, the quadratic one,
//! −½ C ρ π a² |v| v with a constant C, from 10³ to 10⁵ about, where the flow is not yet turbulent at the surface.
//! Source: Landau & Lifshitz, *Fluid Mechanics*, 2nd ed., sections 20 and 45.

use crate::error::{Error, Result};
use crate::words::number;
use core::f64::consts::PI;

/// Where the quadratic law holds.
const QUADRATIC: [f64; 2] = [1e3, 1e5];
/// Below what Stokes' law is within about a tenth: its first correction is 3/8 of the number.
const STOKES: f64 = 0.3;

/// ρ a v/μ.
pub fn reynolds_number(density: f64, radius: f64, speed: f64, viscosity: f64) -> f64 {
    density * radius * speed / viscosity
}

/// The coefficient ½ C ρ π a² of quadratic drag, refused where that law does not hold at a speed; a viscosity of zero is one
/// that is not known, by which nothing is refused.
///
/// # Errors
/// By the name of the speed, with the Reynolds number.
pub fn quadratic_coefficient(
    density: f64,
    radius: f64,
    drag_coefficient: f64,
    [viscosity, speed]: [f64; 2],
) -> Result<f64> {
    if viscosity > 0.0 {
        let found = reynolds_number(density, radius, speed, viscosity);
        if !(QUADRATIC[0]..=QUADRATIC[1]).contains(&found) {
            let message = format!(
                "expected a Reynolds number from 1e3 to 1e5, where drag is quadratic, got {}; use another speed, or \
                 LinearDrag far below 1",
                number(found)
            );
            return Err(Error::invalid("speed", message));
        }
    }
    Ok(0.5 * drag_coefficient * density * PI * radius * radius)
}

/// The time m/(6πaμ) in which Stokes' law slows a sphere down by a factor e, refused where it does not hold at a speed; a
/// density of zero is one that is not known.
///
/// # Errors
/// By the name of the speed, with the Reynolds number.
pub fn stokes_time(mass: f64, radius: f64, viscosity: f64, [density, speed]: [f64; 2]) -> Result<f64> {
    if density > 0.0 {
        let found = reynolds_number(density, radius, speed, viscosity);
        if found > STOKES {
            let message = format!(
                "expected a Reynolds number of at most 0.3, where drag is linear, got {}; use another speed, or \
                 QuadraticDrag above 1e3",
                number(found)
            );
            return Err(Error::invalid("speed", message));
        }
    }
    Ok(mass / (6.0 * PI * radius * viscosity))
}

/// The speed at which Stokes' law and the quadratic one give the same drag.
pub fn crossover_speed(density: f64, radius: f64, viscosity: f64, drag_coefficient: f64) -> f64 {
    12.0 * viscosity / (drag_coefficient * density * radius)
}
