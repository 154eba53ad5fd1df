//! Whether the forces of a scene have what a time transformation watches.

use crate::error::{Error, Result};
use crate::forces::ForceTerm;
use crate::forces::term::Coupling;
use crate::ode::transformation::Transformation;
use std::sync::Arc;

/// Refuses forces that leave nothing to watch, or whose potential energy nobody adds up on the way.
///
/// # Errors
/// By name, with what works.
pub(super) fn check(
    by: Transformation,
    forces: &[Arc<dyn ForceTerm>],
    (active, passive): (usize, usize),
    coupled: bool,
) -> Result<()> {
    let refused = |message: String| Err(Error::invalid("time_transformation", message));
    let by_distance = |force: &Arc<dyn ForceTerm>| {
        (coupled && force.coupling() == Coupling::AllPairs) || force.center().is_some()
    };
    if !forces.iter().any(by_distance) {
        return refused(format!(
            "{} watches bodies that all act on each other, or a center: expected Gravity, another force between all \
             pairs or a CentralField, got none; leave time_transformation out",
            by.name()
        ));
    }
    if by == Transformation::Distance {
        return Ok(());
    }
    let attracts = |force: &Arc<dyn ForceTerm>| {
        force.as_newtonian().is_some_and(|(constant, _)| constant > 0.0)
            || force.as_inverse_distance_center().is_some_and(|(k, _)| k < 0.0)
    };
    if let Some(other) = forces.iter().find(|force| !attracts(force)) {
        return refused(format!(
            "potential_energy watches the attraction of Gravity and of CentralField with Coulomb, negative everywhere, and \
             nothing else may act: expected no {}; use distance, which takes any force",
            other.declaration().class_name
        ));
    }
    if coupled && passive > 0 {
        return refused(
            "potential_energy does not see massless bodies, which have no energy; use distance, which does"
                .to_owned(),
        );
    }
    if coupled && active < 2 {
        return refused("potential_energy needs two bodies with mass; use distance".to_owned());
    }
    Ok(())
}
