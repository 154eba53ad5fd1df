//! What forces refuse: bodies without mass, potentials that jump, and bodies at distances at which a potential is not.

use super::term::{Bodies, ForceTerm};
use crate::error::{Error, Result};
use crate::potentials::Potential;
use crate::words::number;

/// Refuses a potential that jumps.
///
/// # Errors
/// By name.
pub(super) fn check_force(force: &str, potential: &dyn Potential) -> Result<()> {
    if !potential.jumps() {
        return Ok(());
    }
    let class = potential.declaration().class_name;
    let expected = format!("{force} expected a potential with a finite force, and {class} jumps");
    Err(Error::invalid("potential", format!("{expected}; use a smooth one, as SoftSphere or Morse")))
}

/// The refusal of bodies at a distance at which a potential is not.
pub(super) fn outside(
    force: &str,
    potential: &dyn Potential,
    (first, last): (f64, f64),
    bodies: &str,
) -> Error {
    let class = potential.declaration().class_name;
    let (first, last) = (number(first), number(last));
    Error::invalid(
        "position",
        format!("{force} has a {class} that is known from {first} to {last} only, and {bodies}; move one"),
    )
}

/// Refuses a massless body on which a force acts that moves only what has mass.
///
/// # Errors
/// By name.
pub fn check_masses(term: &dyn ForceTerm, bodies: &Bodies<'_>) -> Result<()> {
    let massless = |&(index, &mass): &(usize, &f64)| mass == 0.0 && term.needs_mass(index % bodies.particles);
    match bodies.mass.iter().enumerate().find(massless) {
        None => Ok(()),
        Some((index, &mass)) => Err(Error::invalid(
            "mass",
            format!(
                "{} acts by its force, so every mass must be positive, got {} = {}; give a mass of 1 for the force on \
                 each unit of mass, or where masses attract others write it as ExpressionForce(acceleration=…)",
                term.declaration().class_name,
                bodies.name("mass", index),
                number(mass)
            ),
        )),
    }
}
