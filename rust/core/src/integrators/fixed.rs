//! Runs with a fixed step: nodes at `t0 + n·h`, outputs that never touch them.
//!
//! An output on a node is the node's state, to the bit; one between nodes comes from a sub-step on a
//! copy, of the method's own order (a multistep method's is of the kind that starts it). So does an end that is
//! not a node.

use super::multistep::MultistepStep;
use super::runge_kutta::RungeKuttaStep;
use super::splitting::SplittingStep;
use super::state::State;
use super::{Method, Scheme};
use crate::error::{Error, Result};
use crate::forces::Dynamics;
use crate::numerics::element::Element;
use crate::numerics::real::Real;
use crate::parallel::Ticker;

/// A method with a step, ready to advance a state.
#[derive(Debug)]
pub enum FixedStep<S> {
    /// Kicks and drifts; and what takes steps to times between nodes, from the first of them on.
    Splitting(SplittingStep<S>, Option<SplittingStep<S>>),
    /// Explicit Runge–Kutta.
    RungeKutta(RungeKuttaStep<S>),
    /// Störmer's multistep method.
    Multistep(Box<MultistepStep<S>>),
}

impl<S: Element> FixedStep<S> {
    /// The method with step `h`, for states like `state`.
    ///
    /// # Errors
    /// A method that chooses its own steps.
    pub fn new(method: &'static Method, h: f64, state: &State<S>) -> Result<Self> {
        let step = S::splat(h);
        match &method.scheme {
            Scheme::Splitting(table) => {
                Ok(Self::Splitting(SplittingStep::new(table, step, state.shape.len()), None))
            }
            Scheme::RungeKutta(tableau) => Ok(Self::RungeKutta(RungeKuttaStep::new(tableau, step, state))),
            Scheme::Multistep(table) => Ok(Self::Multistep(Box::new(MultistepStep::new(table, h, state)))),
            Scheme::Embedded(_) => {
                Err(Error::invalid("dt", format!("{} chooses its own steps; leave dt out", method.name)))
            }
        }
    }

    /// Begins anew, at another state of the same shape.
    pub fn restart(&mut self) {
        match self {
            Self::Splitting(step, _) => step.restart(),
            Self::RungeKutta(_) => {}
            Self::Multistep(step) => step.restart(),
        }
    }

    /// Advances a copy of the state at the present node by a step `h` instead.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    fn step_between(
        &mut self,
        h: f64,
        state: &mut State<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let h = S::splat(h);
        match self {
            Self::Splitting(step, between) => {
                let between = between.get_or_insert_with(|| step.clone());
                between.follow(h, step);
                between.step(state, dynamics, ticker)
            }
            Self::RungeKutta(step) => step.step_by(h, state, dynamics, ticker),
            Self::Multistep(step) => step.starter_mut().step_by(h, state, dynamics, ticker),
        }
    }

    /// Advances the state by one step or, where that saves time, by more, up to `at_most`; returns how many.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn step(
        &mut self,
        state: &mut State<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
        at_most: u64,
    ) -> Result<u64> {
        match self {
            Self::Splitting(step, _) => step.step(state, dynamics, ticker)?,
            Self::RungeKutta(step) => step.step(state, dynamics, ticker)?,
            Self::Multistep(step) => return step.step(state, dynamics, ticker, at_most),
        }
        Ok(1)
    }

    /// Completes a state that is to be read: that of a multistep method stays behind otherwise.
    #[inline]
    pub fn complete(&mut self, state: &mut State<S>) {
        if let Self::Multistep(step) = self {
            step.complete(state);
        }
    }
}

/// Steps between two counts of progress.
const PROGRESS_STEPS: u64 = 64;

/// Where a time lies among the nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The last node not after it.
    pub node: u64,
    /// The time past that node; `None` on the node.
    pub past: Option<f64>,
}

/// Finds the place of `elapsed = t - t0` among the nodes `n·h`.
///
/// Within two units in the last place of the time itself (`magnitude` is the larger of |t|, |t0|) a time
/// is on the node: it cannot be told from it, and a grid such as `linspace` hits nodes only that closely.
pub fn place(elapsed: f64, h: f64, magnitude: f64) -> Place {
    let ratio = elapsed / h;
    // Adding 1.5·2^52 leaves a number below 2^51 as an integer in the last bits, without a call.
    let shift = 6_755_399_441_055_744.0_f64;
    let (nearest, node) = if ratio < 2.0e15 {
        let shifted = ratio + shift;
        (shifted - shift, shifted.to_bits().saturating_sub(shift.to_bits()))
    } else {
        (ratio.round(), ratio.round() as u64)
    };
    let distance = elapsed.abs();
    if (elapsed - nearest * h).abs() <= 2.0 * f64::EPSILON * Real::max(magnitude, distance) {
        return Place { node, past: None };
    }
    let (nearest, node) =
        if nearest * h.abs() > distance { (nearest - 1.0, node - 1) } else { (nearest, node) };
    Place { node, past: Some(elapsed - nearest * h) }
}

/// Advances `state` through the places of the outputs, in order, and hands each state to `record`.
///
/// Returns the number of steps taken; it stops short at `max_steps`. `record` may refuse a state, which ends the run.
///
/// # Errors
/// What `record` returns, or [`Error::Interrupted`]; a force that looks at velocities, with a multistep method.
pub fn run<S: Element>(
    stepper: &mut FixedStep<S>,
    max_steps: u64,
    state: &mut State<S>,
    dynamics: &mut Dynamics<S>,
    places: impl Iterator<Item = Place>,
    ticker: &mut Ticker<'_>,
    mut record: impl FnMut(usize, &State<S>, &mut Ticker<'_>) -> Result<()>,
) -> (u64, Result<()>) {
    let mut taken = 0;
    let outcome = (|| {
        if matches!(stepper, FixedStep::Multistep(_)) && dynamics.needs_velocity() {
            let message = "the method knows no velocities, which a force of this scene needs".to_owned();
            return Err(Error::invalid("method", message));
        }
        stepper.restart();
        let mut between = None;
        let mut before = dynamics.stops_midway().then(|| state.clone());
        for (index, place) in places.enumerate() {
            while taken < place.node {
                if taken == max_steps {
                    stepper.complete(state);
                    return Ok(());
                }
                if let Some(before) = &mut before {
                    stepper.complete(state);
                    before.copy_from(state);
                }
                let at_most =
                    (place.node.min(max_steps) - taken).min(PROGRESS_STEPS - taken % PROGRESS_STEPS);
                taken += match stepper.step(state, dynamics, ticker, at_most) {
                    Ok(steps) => steps,
                    Err(error) => {
                        // Some methods change the state in place: half a step is taken back.
                        if let Some(before) = &before {
                            state.copy_from(before);
                        }
                        return Err(error);
                    }
                };
                if taken % PROGRESS_STEPS == 0 {
                    ticker.advance(PROGRESS_STEPS);
                }
                if let Err(error) = ticker.tick() {
                    stepper.complete(state);
                    return Err(error);
                }
            }
            stepper.complete(state);
            let reached: &State<S> = match place.past {
                None => state,
                Some(past) => {
                    let between = between.get_or_insert_with(|| state.clone());
                    between.copy_from(state);
                    stepper.step_between(past, between, dynamics, ticker)?;
                    &*between
                }
            };
            record(index, reached, ticker)?;
        }
        ticker.advance(taken % PROGRESS_STEPS);
        Ok(())
    })();
    (taken, outcome)
}
