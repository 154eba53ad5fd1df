//! What forces cannot be had with a method, or with a time transformation.

use super::super::Scene;
use crate::error::{Error, Result};
use crate::forces::ForceTerm;
use crate::forces::term::Coupling;
use crate::numerics::cosine::LARGEST;
use crate::ode::Method;
use crate::ode::system::{Form, Needs};
use crate::ode::transformation::Transformation;
use crate::registry::METHODS;
use crate::words::number;
use std::sync::Arc;

/// Refuses a method that cannot take what a force looks at.
///
/// # Errors
/// By name, with the methods that can.
pub(super) fn check_method(method: &Method, forces: &[Arc<dyn ForceTerm>]) -> Result<()> {
    // The numbers of a state do not matter here.
    let serves = |method: &Method, needs| method.serves(Form::SecondOrder(1), needs);
    let Some(force) = forces.iter().find(|force| !serves(method, force.needs())) else { return Ok(()) };
    let all = forces.iter().fold(Needs::default(), |needs, force| needs.and(force.needs()));
    let expands = forces.iter().all(|force| force.has_series());
    let others = METHODS.iter().filter(|method| serves(method, all) && (expands || method.has_table()));
    let others = others.map(|method| method.name);
    Err(Error::invalid(
        "method",
        format!(
            "{} cannot take {}, which looks at velocities; expected one of {}",
            method.name,
            force.declaration().class_name,
            others.collect::<Vec<_>>().join(", ")
        ),
    ))
}

/// The method with equal steps, of those that take what the scene's forces look at, whose errors are smallest.
pub(in crate::scene) fn with_equal_steps(scene: &Scene) -> &'static str {
    let needs = scene.forces.iter().fold(Needs::default(), |needs, force| needs.and(force.needs()));
    let bodies = scene.rigid.as_ref();
    let resisted = bodies.is_some_and(|bodies| bodies.all_loads().any(|load| load.needs_velocity()));
    match (needs.velocity || resisted, needs.rotation) {
        (false, false) => "kahan_li8",
        (false, true) if bodies.is_none() => "boris4",
        _ => "rk4",
    }
}

/// Refuses drives whose angle leaves what the cosine is known of, at the start or at the end of a run.
///
/// # Errors
/// By name, with the angle.
pub(super) fn check_drives(forces: &[Arc<dyn ForceTerm>], times: [f64; 2]) -> Result<()> {
    for drive in forces.iter().filter_map(|force| force.as_driven()) {
        for t in times {
            let angle = (drive.frequency * t + drive.phase).abs();
            // What is no number is beyond it, too.
            if angle.is_nan() || angle > LARGEST {
                return Err(Error::invalid(
                    "frequency",
                    format!(
                        "DrivenForce is known for angles frequency·t + phase of up to {} radians, got {} at t = {}; expected \
                         a lower frequency, or times nearer to 0",
                        number(LARGEST),
                        number(angle),
                        number(t)
                    ),
                ));
            }
        }
    }
    Ok(())
}

/// Refuses forces that leave nothing to watch, or whose potential energy nobody adds up on the way. `falls`: uniform fields
/// move the origin. By what the forces are, whatever they do to the bodies of a copy: its fellows must not matter.
///
/// # Errors
/// By name, with what works.
pub(super) fn check_transformation(by: Transformation, scene: &Scene, falls: bool) -> Result<()> {
    let refused = |message: String| Err(Error::invalid("time_transformation", message));
    let forces = || scene.forces.iter().filter(|force| !falls || force.as_uniform().is_none());
    let between = |force: &Arc<dyn ForceTerm>| force.coupling() == Coupling::AllPairs;
    if !forces().any(|force| between(force) || force.center().is_some()) {
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
    if let Some(other) = forces().find(|force| !attracts(force)) {
        return refused(format!(
            "potential_energy watches the attraction of Gravity and of CentralField with Coulomb, negative everywhere, and \
             nothing else may act: expected no {}; use distance, which takes any force",
            other.declaration().class_name
        ));
    }
    if forces().any(between) && scene.mass.contains(&0.0) {
        return refused(
            "potential_energy does not see massless bodies, which have no energy; use distance, which does"
                .to_owned(),
        );
    }
    if scene.particles < 2 && forces().all(between) {
        return refused("potential_energy needs two bodies with mass; use distance".to_owned());
    }
    Ok(())
}
