//! A scene: what there is, what is asked of it, what must be done, and the doing of it.
//!
//! [`Scene`] is plain data. [`plan`](plan::plan) is a pure function from (scene, request) to a
//! [`Plan`](plan::Plan), and the only place where work is skipped; [`run`](run::run) does what it says.

pub mod acceleration;
pub mod closed_form;
pub mod collisions;
pub mod columns;
pub mod continuation;
pub mod events;
pub mod frame;
pub mod integrate;
pub mod layout;
pub mod plan;
pub mod request;
pub mod room;
pub mod run;
pub mod unit;

use crate::error::{Error, Result};
use crate::forces::term::Bodies;
use crate::forces::{ForceTerm, check_masses};
use crate::numerics::double_double::DoubleDouble;
pub(crate) use crate::numerics::points::distance;
use crate::rigid::motion::bodies::RigidBodies;
use crate::rigid::motion::loads::Load;
use crate::rigid::quaternion::rotated;
use crate::words::{number, numbers};
use continuation::Continuation;
use std::sync::Arc;

/// Sets of forces, one of which acts in each copy: those whose parameters differ from copy to copy.
#[derive(Clone, Debug)]
pub struct OwnForces {
    /// The sets.
    pub sets: Vec<Vec<Arc<dyn ForceTerm>>>,
    /// Which of them acts in each copy.
    pub of_copy: Vec<usize>,
}

impl OwnForces {
    /// The forces of some copies; `None` if they have the same.
    pub fn of(&self, members: &[usize]) -> Option<Self> {
        let mut places = vec![usize::MAX; self.sets.len()];
        let mut sets = Vec::new();
        let mut of_copy = Vec::with_capacity(members.len());
        for &copy in members {
            let set = self.of_copy[copy];
            if places[set] == usize::MAX {
                places[set] = sets.len();
                sets.push(self.sets[set].clone());
            }
            of_copy.push(places[set]);
        }
        (sets.len() > 1).then_some(Self { sets, of_copy })
    }
}

/// A batch of copies of a scene (a batch of one is a scene).
#[derive(Clone, Debug)]
pub struct Scene {
    /// Copies.
    pub copies: usize,
    /// Particles in each.
    pub particles: usize,
    /// Masses, `copies × particles`.
    pub mass: Vec<f64>,
    /// Positions, `copies × particles`.
    pub position: Vec<[f64; 3]>,
    /// Velocities, `copies × particles`.
    pub velocity: Vec<[f64; 3]>,
    /// The forces, in the order in which they are added; those of the first copy, if copies have their own.
    pub forces: Vec<Arc<dyn ForceTerm>>,
    /// The forces of each copy, if they differ.
    pub own_forces: Option<OwnForces>,
    /// Radii, as the masses; none if all bodies are points.
    pub radius: Vec<f64>,
    /// What turns: the last bodies of each copy, if some are rigid ones.
    pub rigid: Option<RigidBodies>,
    /// The time of this state.
    pub t0: f64,
    /// What that leaves out, if the state is that of an event: a time far from zero has no digits for it.
    pub t0_rest: f64,
    /// How a run with fixed steps came to this state, if one did.
    pub continuation: Option<Continuation>,
}

/// Refuses frames that turn, for rigid bodies: they turn them, too, by torques that nobody computes.
///
/// # Errors
/// `forces`.
pub fn refuse_frames(forces: &[Arc<dyn ForceTerm>]) -> Result<()> {
    let turns = |force: &Arc<dyn ForceTerm>| {
        force.as_rotating().is_some_and(|(omega, _)| omega.iter().any(|part| *part != 0.0))
    };
    if !forces.iter().any(turns) {
        return Ok(());
    }
    let message = "RotatingFrame moves points; how it turns rigid bodies is not computed: run them in a frame at rest, and \
                   turn orientations and angular velocities by -omega t afterwards";
    Err(Error::invalid("forces", message))
}

impl Scene {
    /// How long after the start a time is.
    #[inline]
    pub fn elapsed(&self, t: f64) -> f64 {
        // What is recorded at the time of an event is its state.
        if t == self.t0 { 0.0 } else { (t - self.t0) - self.t0_rest }
    }

    /// The time so long after the start, and what its rounding leaves out.
    pub fn time_after(&self, elapsed: f64) -> (f64, f64) {
        DoubleDouble::sum(self.t0, elapsed + self.t0_rest).parts()
    }

    /// The masses of a copy.
    pub fn masses(&self, copy: usize) -> &[f64] {
        &self.mass[copy * self.particles..(copy + 1) * self.particles]
    }
    /// The positions of a copy.
    pub fn positions(&self, copy: usize) -> &[[f64; 3]] {
        &self.position[copy * self.particles..(copy + 1) * self.particles]
    }
    /// The velocities of a copy.
    pub fn velocities(&self, copy: usize) -> &[[f64; 3]] {
        &self.velocity[copy * self.particles..(copy + 1) * self.particles]
    }

    /// The radii of a copy; none if all bodies are points.
    pub fn radii(&self, copy: usize) -> &[f64] {
        self.radius.get(copy * self.particles..(copy + 1) * self.particles).unwrap_or_default()
    }

    /// The forces of a copy.
    pub fn forces_of(&self, copy: usize) -> &[Arc<dyn ForceTerm>] {
        self.own_forces.as_ref().map_or(&self.forces, |own| &own.sets[own.of_copy[copy]])
    }

    /// The bodies, for a force to look at.
    pub fn bodies(&self) -> Bodies<'_> {
        let Self { copies, particles, .. } = *self;
        let (position, velocity) = (&self.position, &self.velocity);
        Bodies { copies, particles, mass: &self.mass, position, velocity, copy: None }
    }

    /// The bodies of a copy.
    pub fn bodies_of(&self, copy: usize) -> Bodies<'_> {
        Bodies {
            copies: 1,
            particles: self.particles,
            mass: self.masses(copy),
            position: self.positions(copy),
            velocity: self.velocities(copy),
            copy: (self.copies > 1).then_some(copy),
        }
    }

    /// Refuses springs whose direction is not known: of a length, or damped, between ends at one place.
    fn validate_springs(&self, bodies: &RigidBodies) -> Result<()> {
        let first = self.particles - bodies.count;
        for copy in 0..self.copies {
            let places = self.positions(copy);
            let coincide = |load: &&Load| {
                load.coincides(
                    |body, point| {
                        let arm = rotated(bodies.orientation[copy * bodies.count + body], point);
                        [0, 1, 2].map(|c| places[first + body][c] + arm[c])
                    },
                    places,
                )
            };
            if let Some(load) = bodies.loads_of(copy).iter().find(coincide) {
                let message = format!(
                    "ends of {} are at one place, from where it has no direction: move one",
                    load.name()
                );
                return Err(Error::invalid("position", message));
            }
        }
        Ok(())
    }

    /// Refuses rigid bodies and ends of springs without mass.
    fn validate_rigid_masses(&self, bodies: &RigidBodies) -> Result<()> {
        let first = self.particles - bodies.count;
        let pulled = |particle: usize| bodies.loads.iter().any(|load| load.pulls(particle));
        for index in 0..self.copies * self.particles {
            let particle = index % self.particles;
            if self.mass[index] == 0.0 && (particle >= first || pulled(particle)) {
                let name = self.bodies().name("mass", index);
                let what = if particle >= first { "a rigid body" } else { "what a spring pulls" };
                let message = format!("expected a positive mass of {what}, got {name} = 0.0");
                return Err(Error::invalid("mass", message));
            }
        }
        Ok(())
    }

    /// Refuses what no run could be made of.
    ///
    /// # Errors
    /// Negative or non-finite masses, non-finite coordinates, and what a force refuses: coincident bodies that attract
    /// each other without softening, a particle on a singular center, a massless particle where its mass is needed.
    pub fn validate(&self) -> Result<()> {
        let count = self.copies * self.particles;
        let radii = self.radius.len();
        if (radii != 0 && radii != count)
            || self.mass.len() != count
            || self.position.len() != count
            || self.velocity.len() != count
        {
            return Err(Error::Internal("the arrays of a scene differ in length".to_owned()));
        }
        for (index, &mass) in self.mass.iter().enumerate() {
            if !(mass >= 0.0 && mass.is_finite()) {
                let name = self.bodies().name("mass", index);
                return Err(Error::invalid(
                    "mass",
                    format!("expected finite masses of at least 0, got {name} = {}", number(mass)),
                ));
            }
        }
        for (index, &radius) in self.radius.iter().enumerate() {
            if !(radius >= 0.0 && radius.is_finite()) {
                let name = self.bodies().name("radius", index);
                return Err(Error::invalid(
                    "radius",
                    format!("expected finite radii of at least 0, got {name} = {}", number(radius)),
                ));
            }
        }
        for (argument, values) in [("position", &self.position), ("velocity", &self.velocity)] {
            if let Some(index) = values.iter().position(|x| x.iter().any(|x| !x.is_finite())) {
                let name = self.bodies().name(argument, index);
                return Err(Error::invalid(
                    argument,
                    format!("expected finite numbers, got {name} = {}", numbers(&values[index])),
                ));
            }
        }
        if let Some(bodies) = &self.rigid {
            bodies.validate(self.copies, self.particles)?;
            self.validate_rigid_masses(bodies)?;
            self.validate_springs(bodies)?;
        }
        if !self.t0.is_finite() {
            return Err(Error::invalid("t0", format!("expected a finite time, got {}", number(self.t0))));
        }
        let check = |forces: &[Arc<dyn ForceTerm>], bodies: &Bodies<'_>| {
            if self.rigid.is_some() {
                refuse_frames(forces)?;
            }
            forces.iter().try_for_each(|force| {
                let checked = check_masses(&**force, bodies).and_then(|()| force.validate(bodies));
                checked.map_err(|error| self.of_a_merger(error))
            })
        };
        if self.own_forces.is_none() {
            return check(&self.forces, &self.bodies());
        }
        (0..self.copies).try_for_each(|copy| check(self.forces_of(copy), &self.bodies_of(copy)))
    }

    /// The refusal of places or masses, with what to do about bodies that an earlier run has merged.
    fn of_a_merger(&self, error: Error) -> Error {
        match (error, collisions::absorbed(self)) {
            (Error::InvalidInput { argument, message }, Some((body, host)))
                if argument == "position" || argument == "mass" =>
            {
                let advice = format!(
                    "body {body} is a part of body {host} since they merged: run on with collisions=\"merge\", \"bounce\" \
                     or \"stop\", or make a scene without it"
                );
                Error::InvalidInput { argument, message: format!("{message}; {advice}") }
            }
            (error, _) => error,
        }
    }
}
