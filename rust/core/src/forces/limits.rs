//! What forces refuse of their potentials: jumps, and bodies at distances at which a potential is not.

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
