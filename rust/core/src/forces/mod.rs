//! Forces: what turns positions and velocities into accelerations.
//!
//! The one idea: a force evaluation is one indirect call per force ([`Force::apply`]); everything hot is
//! inside it. A state is two blocks of coordinates laid out by [`Shape`]; lanes are particles (packed) or
//! trajectories (batch), which only the pair kernels and the reductions need to know.
//!
//! A force is described by a [`ForceTerm`], which makes its kernel; to add one, write a file with both and add its
//! line to [`registry::FORCES`](crate::registry::FORCES).

mod approach;
pub mod bodies;
pub mod central_field;
pub mod context;
pub mod coulomb;
pub mod damper;
pub mod derivative;
pub mod drag;
pub mod driven_force;
pub mod expression;
pub mod following;
pub mod gravity;
pub mod harmonic;
mod limits;
pub mod linear;
pub mod linear_drag;
mod lines;
pub mod links;
pub mod monitor;
pub mod oblate;
pub mod pair_potential;
pub mod post_newtonian;
pub mod quadratic_drag;
pub mod remaining;
pub mod rotating_frame;
pub mod series;
mod sources;
pub mod spheres;
pub mod spring;
pub mod term;
pub mod together;
pub mod uniform_electric_field;
pub mod uniform_field;
pub mod uniform_magnetic_field;

pub use limits::check_masses;
pub use term::{ForceDeclaration, ForceTerm};

use crate::error::Result;
use crate::numerics::element::{Element, PairMut, Shape};
use crate::numerics::real::Mask;
use crate::ode::Method;
use crate::ode::series::Jet;
use crate::ode::state::State;
use crate::ode::stepper::Stepper;
use crate::ode::system::{Form, Needs, System, Taken};
use crate::ode::transformation::Monitor;
use crate::parallel::Ticker;
use gravity::FewBodies;
use gravity::closed::ClosedKernel;

/// When it is, where the particles are and how they move.
#[derive(Debug)]
pub struct Phase<'a, S> {
    /// The time since the start of the run, for a force that [needs](Force::needs) it; for another it may be any.
    pub t: &'a S,
    /// Coordinates.
    pub q: &'a [S],
    /// Velocities, for a force that needs them; for another they may be of any time.
    pub v: &'a [S],
}

/// How a force adds to an acceleration: where two add once, either may come first, since a sum of two numbers is the same in
/// either order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adds {
    /// Several numbers to a coordinate, in its order.
    Severally,
    /// One number to each coordinate.
    Once,
    /// One number, that it waits long for: what another has added before is there by then, and what another does
    /// meanwhile costs little.
    OnceAtLast,
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

    /// What it looks at besides coordinates. What no force looks at may not be there in the middle of a step.
    fn needs(&self) -> Needs {
        Needs::default()
    }

    /// How it adds to an acceleration.
    fn adds(&self) -> Adds {
        Adds::Severally
    }

    /// How long a step from this state, with these accelerations, may be, if bodies come to where the force acts and steps
    /// do not feel it before.
    fn longest_step(&self, state: (&[S], &[S]), a: &[S]) -> Option<S> {
        let _ = (state, a);
        None
    }

    /// As [`System::seen_until`], of this force.
    ///
    /// # Errors
    /// As that.
    fn seen_until(&mut self, step: &Taken<'_, S>) -> Result<Option<S>> {
        let _ = step;
        Ok(None)
    }

    /// As [`System::calm`], of this force.
    fn calm(&mut self, step: &Taken<'_, S>, times: f64) -> S::Mask {
        let _ = (step, times);
        S::Mask::splat(true)
    }

    /// Turns velocities exactly as the force does in the time `h`, if that is all that it does ([`Needs::rotation`]).
    fn rotate(&mut self, h: f64, v: PairMut<'_, S>) {
        let _ = (h, v);
    }

    /// Whether an evaluation takes so long that it ticks, and so may be interrupted in its middle. Whoever
    /// changes a state between evaluations must then be able to take that back.
    fn stops_midway(&self) -> bool {
        false
    }
}

/// All forces on the particles of a state: the right-hand side of their equations of motion.
pub struct Dynamics<S: Element> {
    /// How the coordinates lie.
    pub shape: Shape,
    /// The forces, in the scene's order, which is the order of summation; but the first two may be exchanged.
    forces: Vec<Box<dyn Force<S>>>,
    /// The only force, if the bodies it acts between are all there are.
    closed: Option<FewBodies<S>>,
    /// The same forces as series, for a method that asks for them.
    series: Option<series::AllSeries<S>>,
    needs: Needs,
    evaluations: u64,
    monitor: Option<Box<dyn Monitor<S>>>,
}

impl<S: Element> Dynamics<S> {
    /// From the forces of a scene.
    pub fn new(shape: Shape, mut forces: Vec<Box<dyn Force<S>>>) -> Self {
        let adds = |at: usize| forces.get(at).map(|force| force.adds());
        if adds(0) == Some(Adds::OnceAtLast) && adds(1) == Some(Adds::Once) {
            forces.swap(0, 1);
        }
        let needs = forces.iter().fold(Needs::default(), |needs, force| needs.and(force.needs()));
        Self { shape, forces, closed: None, needs, evaluations: 0, series: None, monitor: None }
    }

    /// With what tells a time transformation how fast time goes.
    #[must_use]
    pub fn watched_by(self, monitor: Box<dyn Monitor<S>>) -> Self {
        Self { monitor: Some(monitor), ..self }
    }
}

impl<S: ClosedKernel> Dynamics<S>
where
    FewBodies<S>: Force<S>,
{
    /// Of systems of bodies on which nothing acts but their own pulls.
    pub fn closed(few: FewBodies<S>) -> Self {
        Self { closed: Some(few.clone()), ..Self::new(few.shape(), vec![Box::new(few)]) }
    }
}

impl<S: ClosedKernel> System<S> for Dynamics<S> {
    fn form(&self) -> Form {
        Form::SecondOrder(self.shape.len())
    }

    fn needs(&self) -> Needs {
        self.needs
    }

    fn evaluations(&self) -> u64 {
        self.evaluations
    }

    fn count(&mut self, evaluations: u64) {
        self.evaluations += evaluations;
    }

    fn stops_midway(&self) -> bool {
        self.forces.iter().any(|force| force.stops_midway())
    }

    fn acceleration(&mut self, t: &S, q: &[S], v: &[S], a: &mut [S], ticker: &mut Ticker<'_>) -> Result<()> {
        self.evaluations += 1;
        if self.forces.is_empty() {
            a.fill(S::zero());
        }
        let phase = Phase { t, q, v };
        for (index, force) in self.forces.iter_mut().enumerate() {
            force.apply(&phase, a, index == 0, ticker)?;
        }
        Ok(())
    }

    fn kick(&mut self, t: &S, q: &[S], a: &mut [S], ticker: &mut Ticker<'_>) -> Result<()> {
        self.evaluations += 1;
        let phase = Phase { t, q, v: &[] };
        let mut first = true;
        for force in self.forces.iter_mut().filter(|force| !force.needs().rotation) {
            force.apply(&phase, a, first, ticker)?;
            first = false;
        }
        if first {
            a.fill(S::zero());
        }
        Ok(())
    }

    fn longest_step(&self, state: (&[S], &[S]), a: &[S]) -> Option<S> {
        let longest = self.forces.iter().filter_map(|force| force.longest_step(state, a));
        longest.reduce(|one, other| one.min(other))
    }

    fn seen_until(&mut self, step: &Taken<'_, S>) -> Result<Option<S>> {
        let mut until: Option<S> = None;
        for force in &mut self.forces {
            if let Some(seen) = force.seen_until(step)? {
                until = Some(until.map_or(seen, |until| until.min(seen)));
            }
        }
        Ok(until)
    }

    fn calm(&mut self, step: &Taken<'_, S>, times: f64) -> S::Mask {
        let all = self.forces.iter_mut().map(|force| force.calm(step, times));
        all.fold(S::Mask::splat(true), |all, own| all.and(own))
    }

    fn expand(&mut self, jet: &mut Jet<S>, ticker: &mut Ticker<'_>) -> Result<()> {
        self.expand_series(jet, ticker)
    }

    fn coefficient(&mut self, n: usize, jet: &Jet<S>, a: &mut [S], ticker: &mut Ticker<'_>) -> Result<()> {
        self.coefficient_of_series(n, jet, a, ticker)
    }

    fn smooth_until(&self, jet: &Jet<S>, h: &S) -> Option<S> {
        self.series_smooth_until(jet, h)
    }

    /// Rotations about several axes do not commute: half of each in turn, then in the reverse order, which keeps the
    /// symmetry of the step.
    fn rotate(&mut self, h: f64, (v, rest): PairMut<'_, S>) {
        let turns = |force: &&mut Box<dyn Force<S>>| force.needs().rotation;
        let alone = self.forces.iter_mut().filter(turns).count() == 1;
        let part = if alone { h } else { 0.5 * h };
        for force in self.forces.iter_mut().filter(turns) {
            force.rotate(part, (&mut *v, &mut *rest));
        }
        if !alone {
            for force in self.forces.iter_mut().rev().filter(turns) {
                force.rotate(part, (&mut *v, &mut *rest));
            }
        }
    }

    fn monitor(&mut self) -> Option<&mut dyn Monitor<S>> {
        self.monitor.as_deref_mut().map(|monitor| monitor as &mut dyn Monitor<S>)
    }

    fn special(&self, method: &'static Method, h: f64, state: &State<S>) -> Option<Box<dyn Stepper<S>>> {
        self.closed.as_ref().and_then(|few| few.closed_stepper(method, h, self, state))
    }
}
