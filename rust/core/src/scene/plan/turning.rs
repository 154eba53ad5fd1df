//! How rigid bodies turn: by the exact solution where nothing turns them, else step by step beside the points.

use super::super::Scene;
use super::super::request::Request;
use super::{Groups, Plan};
use crate::error::{Error, Result};
use crate::forces::ForceTerm;
use crate::ode::{Method, Scheme};
use crate::registry;
use crate::rigid::motion::bodies::RigidBodies;
use crate::rigid::motion::flows::Free;
use crate::rigid::motion::loads::Load;
use crate::rigid::motion::methods::discrete;
use std::sync::Arc;

/// How rigid bodies turn.
#[derive(Clone, Copy, Debug)]
pub enum Turning {
    /// There are none.
    None,
    /// Freely: their orientations are known at any time.
    Exact,
    /// By torques, in steps.
    Stepped(Free),
}

impl Turning {
    /// That of the rigid bodies of a scene under these forces, by a method that was named or not.
    pub(super) fn of(scene: &Scene, method: &Method, forces: &[Arc<dyn ForceTerm>]) -> Self {
        let Some(bodies) = &scene.rigid else { return Self::None };
        if let Some(order) = discrete(method) {
            return Self::Stepped(Free::Discrete(order));
        }
        // Copies may have forces of their own.
        let own = scene.own_forces.iter().flat_map(|own| &own.sets).flatten();
        let mut newtonian = forces.iter().chain(own).filter_map(|force| force.as_newtonian());
        let pulls = newtonian.any(|(constant, _)| constant != 0.0);
        if bodies.is_loaded() || (pulls && scene.particles > 1 && bodies.any_shape()) {
            return Self::Stepped(Free::Exact);
        }
        Self::Exact
    }

    /// Whether bodies turn in steps.
    pub const fn steps(self) -> bool {
        matches!(self, Self::Stepped(_))
    }
}

/// Whether a method can step bodies that turn under forces of which some look at velocities, or none does.
const fn serves(method: &Method, velocities: bool) -> bool {
    match method.scheme {
        Scheme::RungeKutta(_) | Scheme::Embedded(_) | Scheme::Taylor(_) => true,
        Scheme::Splitting(_) | Scheme::NystromSplitting(_) => !velocities,
        _ => false,
    }
}

/// Whether a method can step bodies that turn.
pub const fn steps_bodies(method: &Method) -> bool {
    serves(method, false)
}

/// What looks at velocities in a scene of rigid bodies, by name.
fn looking(bodies: &RigidBodies, forces: &[Arc<dyn ForceTerm>]) -> Option<&'static str> {
    let load = bodies.all_loads().find(|load| load.needs_velocity()).map(Load::name);
    load.or_else(|| {
        forces.iter().find(|force| force.needs().velocities()).map(|force| force.declaration().class_name)
    })
}

/// The method that steps bodies well under what looks at velocities, or under nothing that does.
const fn best(velocities: bool) -> &'static str {
    if velocities { "rk4" } else { "kahan_li8" }
}

/// Whether some points move by themselves, beside bodies: in parts of a run nothing is refined but what is with a body.
fn points_apart(scene: &Scene, bodies: &RigidBodies, forces: &[Arc<dyn ForceTerm>]) -> bool {
    let points = scene.particles - bodies.count;
    match groups(scene, forces) {
        Groups::All => false,
        Groups::Single => points > 0,
        Groups::Listed(groups) => (0..points).any(|point| {
            let group = groups.iter().find(|group| group.binary_search(&point).is_ok());
            group.is_none_or(|group| group.iter().all(|&body| body < points))
        }),
    }
}

/// What forces and springs on bodies make depend on each other.
pub(super) fn groups(scene: &Scene, forces: &[Arc<dyn ForceTerm>]) -> Groups {
    let ties = scene
        .rigid
        .iter()
        .flat_map(|bodies| bodies.loads.iter().filter_map(|load| load.pair(scene.particles, bodies.count)));
    Groups::of(scene.particles, forces, ties)
}

/// Into how many parts a run is cut whose steps are chosen.
pub(super) const PARTS: u32 = 64;

/// What chooses its steps for them, where events are looked for on the way, something looks at velocities, the steps are
/// steered, or three moments differ: exact turns are elliptic functions then, and take ten times as long.
const ADAPTIVE: &str = "verner98";

/// What chooses them for bodies by themselves that nothing turns but weight and torques along their own axes: series then take
/// a third of the time of that or of what goes in parts, and are off by less (`rigid::motion::series::one_body`). In the place
/// of what goes in parts they take half to two thirds of the time where springs hold bodies, and are off by a thousandth.
/// Beside other loads they take up to four times as long.
const SERIES: &str = "taylor";

/// Whether that is so.
fn by_themselves(scene: &Scene, bodies: &RigidBodies, forces: &[Arc<dyn ForceTerm>]) -> bool {
    forces.iter().all(|force| force.as_uniform().is_some())
        && bodies.loads.iter().all(|load| matches!(load, Load::Torque { in_body: true, .. }))
        && groups(scene, forces) == Groups::Single
}

/// Whether springs hold them, and beside what has a series nothing else acts but weight.
fn are_held(bodies: &RigidBodies, forces: &[Arc<dyn ForceTerm>]) -> bool {
    forces.iter().all(|force| force.as_uniform().is_some())
        && bodies.loads.iter().all(Load::has_series)
        && bodies.loads.iter().any(|load| matches!(load, Load::Spring { .. }))
}

/// The size of a rigid body of a copy, √(moment/mass), whose angular momentum has no square among numbers.
fn out_of_range(scene: &Scene, bodies: &RigidBodies, copy: usize) -> Option<f64> {
    let mass = &scene.masses(copy)[scene.particles - bodies.count..];
    let moments = &bodies.moments[copy * bodies.count..(copy + 1) * bodies.count];
    let sizes = moments.iter().zip(mass).flat_map(|(moments, &mass)| {
        moments.iter().filter(|&&moment| moment > 0.0).map(move |moment| (moment / mass).sqrt())
    });
    sizes.into_iter().find(|size| !(1e-40..=1e40).contains(size))
}

/// Whether series are not to be chosen for a copy: where rounding takes of a spin, steps in parts are made smaller until the
/// result agrees, and tell where it does not.
pub(in crate::scene) fn are_series_poor(scene: &Scene, copy: usize, rtol: f64) -> bool {
    scene
        .rigid
        .as_ref()
        .is_some_and(|bodies| bodies.loses_spin(copy, rtol) || out_of_range(scene, bodies, copy).is_some())
}

/// Errors of chosen steps add up over many turns: where nobody named the method each is held to a tolerance that is so many
/// times smaller, …
const TIMES_CLOSER: f64 = 1e3;
/// … but to no less than what rounding leaves of a step; and those of series, whose digits cost next to nothing, to that.
const LEAST: f64 = 1e-13;

/// What the steps that are chosen of themselves are held to.
pub(super) fn held_to(chosen: &Request) -> f64 {
    let closer = if chosen.method == SERIES { LEAST } else { (chosen.rtol / TIMES_CLOSER).max(LEAST) };
    chosen.rtol.min(closer)
}

/// The request with the method that bodies that turn are stepped with, where it leaves the method open; if it names no step
/// either, with the length of a part, or none for a method that chooses its own: between the ends of long parts nobody sees
/// events.
pub(in crate::scene) fn with_method(scene: &Scene, request: &Request) -> Option<Request> {
    let bodies = scene.rigid.as_ref()?;
    if request.method != "auto" {
        return None;
    }
    let span = (request.times.last()? - scene.t0).abs();
    let part = if span > 0.0 { span / f64::from(PARTS) } else { 1.0 };
    let forces = super::own::acting(scene, &scene.forces);
    let velocities = looking(bodies, &forces).is_some();
    let poor = (0..scene.copies).any(|copy| are_series_poor(scene, copy, request.rtol));
    let steered = request.max_step.is_some() || request.atol.is_some();
    let in_parts = request.events.is_empty()
        && !steered
        && !velocities
        && !bodies.loads.iter().any(Load::is_formula)
        && !bodies.moments.iter().any(|&[a, b, c]| a != b && b != c && c != a)
        && !points_apart(scene, bodies, &forces);
    let (method, dt) = match request.dt {
        None if request.time_transformation.is_some() => return None,
        None if by_themselves(scene, bodies, &forces) && !poor => (SERIES, None),
        None if !in_parts => (ADAPTIVE, None),
        None if are_held(bodies, &forces) && !poor => (SERIES, None),
        None => (best(velocities), Some(part)),
        given => (best(velocities), given),
    };
    let stepped = Turning::of(scene, registry::method(method)?, &forces).steps();
    stepped.then(|| Request { method: method.to_owned(), dt, ..request.clone() })
}

/// Refuses what bodies that turn cannot be run with.
///
/// # Errors
/// By name, with what works.
pub(super) fn check(
    scene: &Scene,
    request: &Request,
    method: &Method,
    forces: &[Arc<dyn ForceTerm>],
) -> Result<()> {
    let Some(bodies) = &scene.rigid else { return Ok(()) };
    let looking = looking(bodies, forces);
    if request.time_transformation.is_some() {
        let message = "expected None for rigid bodies that torques turn";
        return Err(Error::invalid("time_transformation", message));
    }
    if !serves(method, looking.is_some()) {
        let of = |adaptive: bool| {
            let names = registry::methods_for(true)
                .filter(|method| serves(method, looking.is_some()) && method.adaptive() == adaptive)
                .map(|method| method.name);
            names.collect::<Vec<_>>().join(", ")
        };
        let why = looking.map_or_else(String::new, |name| format!("; {name} looks at velocities"));
        let message = format!(
            "got {}, which moves no bodies that torques turn{why}: expected one of those that choose their steps, {}, \
             or one with a step (such as {} with dt={}), {}",
            request.method,
            of(true),
            best(looking.is_some()),
            suggested_step(bodies),
            of(false)
        );
        return Err(Error::invalid("method", message));
    }
    let unknown = bodies.loads.iter().find(|load| !load.has_series());
    if let (Scheme::Taylor(_), Some(load)) = (&method.scheme, unknown) {
        let message = format!(
            "{} needs the Taylor series of every torque, and {} has none; use {ADAPTIVE} or dop853",
            method.name,
            load.name()
        );
        return Err(Error::invalid("method", message));
    }
    let size = (0..scene.copies).find_map(|copy| out_of_range(scene, bodies, copy));
    if let (Scheme::Taylor(_), Some(size)) = (&method.scheme, size) {
        let message = format!(
            "expected sizes √(moment/mass) of rigid bodies between 1e-40 and 1e40 for {}, got {size:.0e}: squares of angular \
             momenta leave the range of numbers; take other units (scene.rescaled), or {ADAPTIVE}",
            method.name
        );
        return Err(Error::invalid("moments", message));
    }
    let softened =
        forces.iter().any(|force| force.as_newtonian().is_some_and(|(_, softening)| softening != 0.0));
    if softened && bodies.any_shape() {
        let message = "expected 0 beside rigid bodies that are no spheres, whose shape is not softened";
        return Err(Error::invalid("softening", message));
    }
    if request.records("virial") {
        let message = "virial is not known of bodies that torques turn; leave it out";
        return Err(Error::invalid("record", message));
    }
    Ok(())
}

/// A twentieth of a radian of the fastest spin, to one digit.
fn suggested_step(bodies: &RigidBodies) -> String {
    let spins = bodies.angular_velocity.iter().flatten();
    let fastest = spins.fold(0.0_f64, |most, part| most.max(part.abs()));
    if fastest > 0.0 && fastest.is_finite() { format!("{:.0e}", 0.05 / fastest) } else { "0.01".to_owned() }
}

impl Plan {
    /// How rigid bodies turn, and why; `None` without any.
    pub(super) fn describe_turning(&self) -> Option<(String, String)> {
        let count = self.rigid;
        let bodies = if count == 1 { "1 rigid body".to_owned() } else { format!("{count} rigid bodies") };
        match self.turning {
            Turning::None => None,
            Turning::Exact => Some(("elliptic functions".to_owned(), format!("no torque turns {bodies}"))),
            Turning::Stepped(free) => {
                let how = match (&self.method.scheme, free) {
                    (Scheme::RungeKutta(_), _) => "Runge–Kutta on the group of rotations",
                    (Scheme::Taylor(_), _) => "series of quaternions and momenta beside the points",
                    (Scheme::Embedded(_), _) => "quaternions and momenta beside the points",
                    (_, Free::Exact) => "exact free turns between kicks",
                    (_, Free::Discrete(_)) => "discrete free turns between kicks",
                };
                Some((how.to_owned(), format!("torques turn {bodies}, or the method was named")))
            }
        }
    }

    /// The place of a body among the rigid ones of its copy.
    pub fn rigid_place(&self, body: usize) -> Option<usize> {
        body.checked_sub(self.particles - self.rigid)
    }

    /// Of what make a rigid body by itself is: those that the same loads act on share lanes.
    pub(super) fn make_of(&self, body: usize) -> usize {
        match (self.turning.steps(), self.rigid_place(body)) {
            (true, Some(place)) => 1 + self.makes.get(place).copied().unwrap_or(0),
            _ => 0,
        }
    }
}

/// Numbers of makes of the rigid bodies of a copy.
pub(super) fn makes(scene: &Scene) -> Vec<usize> {
    let Some(bodies) = &scene.rigid else { return Vec::new() };
    let mut known: Vec<(bool, Vec<usize>)> = Vec::new();
    let make = |body: usize| {
        let acting = (0..bodies.loads.len()).filter(|&load| bodies.loads[load].acts_on(body)).collect();
        let key = (bodies.pivoted.get(body).copied().unwrap_or(false), acting);
        known.iter().position(|other| *other == key).unwrap_or_else(|| {
            known.push(key);
            known.len() - 1
        })
    };
    (0..bodies.count).map(make).collect()
}
