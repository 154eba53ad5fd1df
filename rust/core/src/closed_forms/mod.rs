//! Closed forms: motions known at every time, so that any time costs the same and nothing is stepped.
//!
//! The one idea: a form looks at one ensemble member and at the forces that act on it, says whether it applies, and then
//! makes the [`Motion`], which gives the states unrounded at any time after the start. One file each; the line in
//! [`registry::CLOSED_FORMS`](crate::registry::CLOSED_FORMS) is what makes the plan look at it.
//!
//! Errors, beside half a unit in the last place of what is given: straight lines, parabolas and linear drag 1e-27 of the
//! largest term of their sums; gyration and rotation 1e-27 times (1 + angle in radians) of it; oscillations 1e-26 times
//! (1 + largest angle, number of decays and of drives' radians since time 0) of it; motion along a line with quadratic drag
//! 1e-25 times (1 + number of decays) of it; linear flows 1e-30 times (1 + time over the shortest of periods and decays) of it;
//! Kepler orbits a few units in the last place times the conditioning
//! ([`kepler`](crate::nbody::kepler)). What is beyond the range of `f64` is infinite.

pub mod crossed_fields;
pub mod fixed_center;
pub mod free;
pub mod linear_drag;
pub mod linear_forces;
pub mod one_massive;
pub mod oscillation;
mod parabola;
pub mod quadratic_drag;
pub mod rotating_frame;
pub mod two_body;
pub mod uniform;
pub mod vertical;

use crate::error::Result;
use crate::forces::ForceTerm;
pub use crate::nbody::two_body::ExactState;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use core::any::Any;
use std::rc::Rc;

/// An ensemble member at its start, and what acts on it.
#[derive(Debug)]
pub struct Member<'a> {
    /// Masses.
    pub mass: &'a [f64],
    /// Positions.
    pub position: &'a [[f64; 3]],
    /// Velocities.
    pub velocity: &'a [[f64; 3]],
    /// The forces that do anything to it, in order.
    pub forces: Vec<&'a dyn ForceTerm>,
    /// The time at the start.
    pub t0: f64,
}

/// A closed form.
#[derive(Debug)]
pub struct ClosedForm {
    /// What the plan calls the motion.
    pub name: &'static str,
    /// Why it applies.
    pub reason: &'static str,
    /// Whether it is that of a member.
    pub applies: fn(&Member<'_>) -> bool,
    /// The motion of a member to which it applies; errors are refusals by name, or that the caller asked to stop.
    pub motion: fn(&Member<'_>, &mut Shared, &mut Ticker<'_>) -> Result<Box<dyn Motion>>,
}

impl PartialEq for ClosedForm {
    fn eq(&self, other: &Self) -> bool {
        core::ptr::eq(self, other)
    }
}

/// What the motions that a thread makes one after another have in common; only their form knows what it is.
#[derive(Debug, Default)]
pub struct Shared(Option<Rc<dyn Any>>);

impl Shared {
    /// That of a form, or a new one.
    fn of_form<T: Default + 'static>(&mut self) -> Rc<T> {
        let known = self.0.clone().and_then(|shared| shared.downcast().ok());
        known.unwrap_or_else(|| {
            let new = Rc::new(T::default());
            self.0 = Some(new.clone());
            new
        })
    }
}

/// A motion, ready to be asked.
pub trait Motion {
    /// The states of all particles, in order and unrounded, so long after the start, for one time after another; all of them
    /// after it, or (if negative) before it.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted), and then some are missing.
    fn states(
        &self,
        elapsed: &[DoubleDouble],
        states: &mut Vec<ExactState>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()>;
}

/// A particle that moves by itself.
trait Path {
    /// Its state.
    fn state(&self, elapsed: DoubleDouble) -> ExactState;

    /// Its states at some times, each put to where it belongs.
    fn states(&self, elapsed: &[DoubleDouble], mut put: impl FnMut(usize, ExactState)) {
        elapsed.iter().enumerate().for_each(|(time, &elapsed)| put(time, self.state(elapsed)));
    }
}

/// Particles that move each by itself.
struct Paths<P>(Vec<P>);

impl<P: Path + 'static> Paths<P> {
    /// From the path of each.
    fn motion(
        member: &Member<'_>,
        ticker: &mut Ticker<'_>,
        mut path: impl FnMut(usize) -> Result<P>,
    ) -> Result<Box<dyn Motion>> {
        let each = 0..member.mass.len();
        let paths = each.map(|particle| ticker.tick().and_then(|()| path(particle)));
        Ok(Box::new(Self(paths.collect::<Result<_>>()?)))
    }
}

impl<P: Path> Motion for Paths<P> {
    fn states(
        &self,
        elapsed: &[DoubleDouble],
        states: &mut Vec<ExactState>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        states.clear();
        states.resize(self.0.len() * elapsed.len(), ExactState::default());
        for (particle, path) in self.0.iter().enumerate() {
            ticker.tick()?;
            path.states(elapsed, |time, state| states[time * self.0.len() + particle] = state);
        }
        Ok(())
    }
}

/// Whether a force accelerates each particle by a vector of its own, the same everywhere and always.
fn is_uniform(force: &dyn ForceTerm) -> bool {
    force.as_uniform().is_some() || force.as_electric(0).is_some()
}

/// The sum of the uniform fields on a particle.
fn uniform_part(member: &Member<'_>, particle: usize) -> [Scaled; 3] {
    let mut sum = [Scaled::ZERO; 3];
    for force in &member.forces {
        if let Some(g) = force.as_uniform() {
            sum = core::array::from_fn(|c| sum[c].plus(Scaled::from(g[c])));
        }
        // A body without mass may be there, if it has no charge.
        if let Some((field, charge)) = force.as_electric(particle).filter(|&(_, charge)| charge != 0.0) {
            let mass = Scaled::from(member.mass[particle]);
            sum = core::array::from_fn(|c| sum[c].plus(Scaled::from(charge).times(field[c]).over(mass)));
        }
    }
    sum
}

/// As an unrounded number of `f64`'s range; infinite beyond it.
fn unrounded(value: Scaled) -> DoubleDouble {
    let number = value.to_double_double();
    if number.is_finite() { number } else { DoubleDouble::from(number.to_f64()) }
}

/// a + b, infinite beyond the range.
fn sum(a: DoubleDouble, b: f64) -> DoubleDouble {
    let sum = a + DoubleDouble::from(b);
    if sum.is_finite() { sum } else { unrounded(Scaled::new(a, 0).plus(Scaled::from(b))) }
}
