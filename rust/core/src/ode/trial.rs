//! Steps that may be refused, each lane by itself: what every method that chooses its steps offers to the run.
//!
//! The one idea: a step is computed for all lanes and kept where it is accepted, so eight trajectories with eight step
//! sequences share every instruction, and one trajectory packed over the lanes is the same code with all lanes alike.
//! Outputs and events read the same continuous extension and never steer; only the last step is clamped to the end.

use super::Method;
use super::Scheme;
use super::embedded::EmbeddedStep;
use super::norm::Norm;
use super::series::Jet;
use super::state::State;
use super::step_control::{Clock, Controlled, Settled};
use super::system::System;
use super::taylor::TaylorStep;
use crate::error::{Error, Result};
use crate::numerics::real::Mask;
use crate::parallel::Ticker;

/// Evaluations that a step costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// The start of a trajectory.
    pub start: u64,
    /// A step that is tried.
    pub tried: u64,
    /// One that is kept, besides.
    pub kept: u64,
    /// Its continuous extension, besides.
    pub dense: u64,
    /// Each state that is read off it.
    pub read: u64,
}

/// A method that chooses its own steps, at work on one state.
pub trait Trial<S: Controlled>: Send {
    /// Starts the lanes of `fresh`: evaluates their first derivative and, unless the clock has one, chooses their first
    /// step.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn start(
        &mut self,
        fresh: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        norm: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()>;

    /// Tries one step in every running lane. The state stays where it is.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn attempt(
        &mut self,
        running: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        norm: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Settled<S>>;

    /// The state at the end of the step tried last.
    fn next(&self) -> &State<S>;

    /// Between [`attempt`](Self::attempt) and [`keep`](Self::keep): readies the continuous extension. Who reads states by
    /// steps has nothing to ready.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn dense(
        &mut self,
        outcome: &Settled<S>,
        system: &mut dyn System<S>,
        state: &State<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let _ = (outcome, system, state, ticker);
        Ok(())
    }

    /// The state at the fraction `theta` of the step, lane by lane; needs [`dense`](Self::dense).
    ///
    /// # Errors
    /// Those of an evaluation.
    fn at(
        &mut self,
        outcome: &Settled<S>,
        system: &mut dyn System<S>,
        state: &State<S>,
        theta: S,
        into: &mut State<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()>;

    /// What the continuous extension is made of, once [`dense`](Self::dense) has readied it: a block of numbers (of a
    /// system of the second order: of the coordinates) for each of the [`terms`](Self::terms) `f` in
    /// `y(t + θh) = y + θ(f0 + (1-θ)(f1 + θ(f2 + (1-θ)(f3 + …))))`. Who reads states by steps has none.
    fn extension(&self, state: &State<S>, h: S, into: &mut Vec<S>) {
        let _ = (state, h, into);
    }

    /// Of a system of the second order: the terms of the accelerations' weighted sums in one coordinate (times h²) and in its
    /// velocity (times h, the step), in the basis of [`extension`](Self::extension). The coordinate moves by `θh` times its
    /// velocity, besides.
    fn polynomial(&self, coordinate: usize, h: S, into: &mut Vec<[S; 2]>) {
        let _ = (coordinate, h, into);
    }

    /// The Taylor coefficients of the step tried last, if the method is made of them.
    fn series(&self) -> Option<&Jet<S>> {
        None
    }

    /// How many terms the continuous extension has.
    fn terms(&self) -> usize {
        0
    }

    /// The lanes whose step, which cannot be shorter, went over something unseen; it is not accepted.
    fn passed_over(&self) -> S::Mask {
        S::Mask::splat(false)
    }

    /// Moves the accepted lanes to the end of their step.
    fn keep(&mut self, accepted: S::Mask, state: &mut State<S>);

    /// What steps cost.
    fn cost(&self) -> Cost;
}

/// The method for a system and states like `state`, with steps of at most `max_step`.
///
/// # Errors
/// A method with a fixed step; [`equal_steps`](super::equal_steps) has trials of those, which are never refused.
pub fn trial<S: Controlled>(
    method: &'static Method,
    system: &dyn System<S>,
    state: &State<S>,
    max_step: S,
) -> Result<Box<dyn Trial<S>>> {
    match &method.scheme {
        Scheme::Embedded(table) => Ok(Box::new(EmbeddedStep::new(table, system, state, max_step))),
        Scheme::Taylor(orders) => Ok(Box::new(TaylorStep::new(*orders, system, state, max_step))),
        _ => Err(Error::invalid("dt", format!("{} needs a step dt", method.name))),
    }
}
