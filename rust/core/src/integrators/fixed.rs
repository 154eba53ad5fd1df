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
#[derive(Clone, Debug)]
pub enum FixedStep<S> {
    /// Kicks and drifts.
    Splitting(SplittingStep<S>),
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
    pub fn new(method: &Method, h: f64, state: &State<S>) -> Result<Self> {
        let step = S::splat(h);
        match &method.scheme {
            Scheme::Splitting(table) => {
                Ok(Self::Splitting(SplittingStep::new(table, step, state.shape.len())))
            }
            Scheme::RungeKutta(tableau) => Ok(Self::RungeKutta(RungeKuttaStep::new(tableau, step, state))),
            Scheme::Multistep(table) => Ok(Self::Multistep(Box::new(MultistepStep::new(table, h, state)))),
            Scheme::Embedded(_) => {
                Err(Error::invalid("dt", format!("{} chooses its own steps; leave dt out", method.name)))
            }
        }
    }

    /// Becomes the method with step `h`, at the state where `other` stands.
    fn follow(&mut self, method: &Method, h: f64, other: &Self) {
        match (self, &method.scheme, other) {
            (Self::Splitting(step), Scheme::Splitting(table), Self::Splitting(other)) => {
                step.follow(table, S::splat(h), other);
            }
            (Self::RungeKutta(step), ..) => step.set_step(S::splat(h)),
            (Self::Multistep(step), Scheme::Multistep(table), _) => step.follow(table, S::splat(h)),
            _ => {}
        }
    }

    /// Advances the state by one step.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn step(
        &mut self,
        state: &mut State<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        match self {
            Self::Splitting(step) => step.step(state, dynamics, ticker),
            Self::RungeKutta(step) => step.step(state, dynamics, ticker),
            Self::Multistep(step) => step.step(state, dynamics, ticker),
        }
    }

    /// Completes a state that is to be read: the velocities of a multistep method stay behind otherwise.
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
    method: &Method,
    h: f64,
    max_steps: u64,
    state: &mut State<S>,
    dynamics: &mut Dynamics<S>,
    places: impl Iterator<Item = Place>,
    ticker: &mut Ticker<'_>,
    mut record: impl FnMut(usize, &State<S>) -> Result<()>,
) -> (u64, Result<()>) {
    let mut taken = 0;
    let outcome = (|| {
        if matches!(method.scheme, Scheme::Multistep(_)) && dynamics.needs_velocity() {
            let message = format!("{} knows no velocities, which a force of this scene needs", method.name);
            return Err(Error::invalid("method", message));
        }
        let mut stepper = FixedStep::new(method, h, state)?;
        let mut shadow = None;
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
                if let Err(error) = stepper.step(state, dynamics, ticker) {
                    // Some methods change the state in place: half a step is taken back.
                    if let Some(before) = &before {
                        state.copy_from(before);
                    }
                    return Err(error);
                }
                taken += 1;
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
                    let (between, shadow) = shadow.get_or_insert_with(|| (state.clone(), stepper.clone()));
                    between.copy_from(state);
                    shadow.follow(method, past, &stepper);
                    shadow.step(between, dynamics, ticker)?;
                    &*between
                }
            };
            record(index, reached)?;
        }
        ticker.advance(taken % PROGRESS_STEPS);
        Ok(())
    })();
    (taken, outcome)
}
