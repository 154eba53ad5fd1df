//! Forces: what turns positions and velocities into accelerations.
//!
//! The one idea: a force evaluation is one indirect call per force ([`Force::apply`]); everything hot is
//! inside it. A state is two blocks of coordinates laid out by [`Shape`]; lanes are particles (packed) or
//! trajectories (batch), which only the pair kernels and the reductions need to know.
//!
//! A force is described by a [`ForceTerm`], which makes its kernel; to add one, write a file with both and add its
//! line to [`registry::FORCES`](crate::registry::FORCES).

pub mod body;
pub mod central_field;
pub mod context;
pub mod gravity;
pub mod term;
pub mod uniform_field;

pub use body::Body;
pub use term::{ForceDeclaration, ForceTerm};

use crate::error::Result;
use crate::numerics::element::{Element, Nodes, Shape};
use crate::parallel::Ticker;

/// Where the particles are and how they move.
#[derive(Debug)]
pub struct Phase<'a, S> {
    /// Coordinates.
    pub q: &'a [S],
    /// Velocities, for a force that [needs](Force::needs) them; for another they may be of any time.
    pub v: &'a [S],
}

/// What a force looks at beside positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Time.
    pub time: bool,
    /// Velocities.
    pub velocity: bool,
}

/// Systems of bodies on which nothing acts but their own pulls.
#[derive(Debug)]
pub struct ClosedSystems<'a, S> {
    /// How many, equally large, one after another in the rows of the state.
    pub count: usize,
    /// `G·m` of the bodies, system after system.
    pub strength: &'a [S],
}

/// One force of a scene, ready to run.
pub trait Force<S: Element>: Send {
    /// Writes its accelerations into `a` if `first`, else adds them.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted) when the caller asked to stop; `a` is then unfinished.
    fn apply(
        &mut self,
        phase: &Phase<'_, S>,
        a: &mut [S],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()>;

    /// What it looks at. If no force looks at velocities, none may be there in the middle of a step.
    fn needs(&self) -> Needs {
        Needs::default()
    }

    /// The closed systems that the state consists of, if the force is what their bodies pull each other with and it
    /// takes steps of a multistep method for them by itself.
    fn closed_systems(&self) -> Option<ClosedSystems<'_, S>> {
        None
    }

    /// Steps of a multistep method for its [closed systems](Self::closed_systems), in coordinates relative to the first body
    /// of each: those of the bodies from the second on, system after system, the components of a body together. The
    /// present accelerations are those of the last node after it.
    fn multistep(&self, _: Nodes<'_, S>, _steps: u64) {}

    /// Whether an evaluation takes so long that it ticks, and so may be interrupted in its middle. Whoever
    /// changes a state between evaluations must then be able to take that back.
    fn stops_midway(&self) -> bool {
        false
    }
}

/// All forces of a scene: the right-hand side of the equations of motion.
pub struct Dynamics<S: Element> {
    /// How the coordinates lie.
    pub shape: Shape,
    /// The forces, in the scene's order, which is the order of summation.
    forces: Vec<Box<dyn Force<S>>>,
    /// Force evaluations so far.
    pub evaluations: u64,
    needs_velocity: bool,
}

impl<S: Element> Dynamics<S> {
    /// From the forces of a scene.
    pub fn new(shape: Shape, forces: Vec<Box<dyn Force<S>>>) -> Self {
        let needs_velocity = forces.iter().any(|force| force.needs().velocity);
        Self { shape, forces, evaluations: 0, needs_velocity }
    }

    /// Whether any force looks at velocities.
    pub fn needs_velocity(&self) -> bool {
        self.needs_velocity
    }

    /// Whether any force may be interrupted in the middle of an evaluation.
    pub fn stops_midway(&self) -> bool {
        self.forces.iter().any(|force| force.stops_midway())
    }

    /// The closed systems that the state consists of, if [`multistep`](Self::multistep) can be asked for.
    pub fn closed_systems(&self) -> Option<ClosedSystems<'_, S>> {
        match &self.forces[..] {
            [force] => force.closed_systems(),
            _ => None,
        }
    }

    /// See [`Force::multistep`].
    pub fn multistep(&mut self, nodes: Nodes<'_, S>, steps: u64) {
        if let [force] = &self.forces[..] {
            self.evaluations += steps;
            force.multistep(nodes, steps);
        }
    }

    /// The acceleration of every particle.
    ///
    /// # Errors
    /// As [`Force::apply`].
    pub fn acceleration(&mut self, q: &[S], v: &[S], a: &mut [S], ticker: &mut Ticker<'_>) -> Result<()> {
        self.evaluations += 1;
        if self.forces.is_empty() {
            a.fill(S::zero());
        }
        let phase = Phase { q, v };
        for (index, force) in self.forces.iter_mut().enumerate() {
            force.apply(&phase, a, index == 0, ticker)?;
        }
        Ok(())
    }
}
