//! Runs with a fixed step: nodes at `t0 + n·h`, outputs that never touch them.
//!
//! An output on a node is the node's state, to the bit; one between nodes comes from a sub-step on a
//! copy, of the method's own order (a multistep method's is of the kind that starts it). So does an end that is
//! not a node.

use super::state::State;
use super::stepper::Stepper;
use super::system::System;
use crate::error::Result;
use crate::numerics::element::Element;
use crate::numerics::real::Real;
use crate::parallel::Ticker;

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
/// What `record` returns, or [`Error::Interrupted`](crate::Error::Interrupted).
pub fn run<S: Element>(
    stepper: &mut dyn Stepper<S>,
    max_steps: u64,
    state: &mut State<S>,
    system: &mut dyn System<S>,
    places: impl Iterator<Item = Place>,
    ticker: &mut Ticker<'_>,
    mut record: impl FnMut(usize, &State<S>, &mut Ticker<'_>) -> Result<()>,
) -> (u64, Result<()>) {
    let mut taken = 0;
    let outcome = (|| {
        stepper.restart();
        let mut between = None;
        let mut before = system.stops_midway().then(|| state.clone());
        for (index, place) in places.enumerate() {
            while taken < place.node {
                if taken == max_steps {
                    stepper.settle(state);
                    return Ok(());
                }
                if let Some(before) = &mut before {
                    stepper.settle(state);
                    before.copy_from(state);
                }
                let at_most =
                    (place.node.min(max_steps) - taken).min(PROGRESS_STEPS - taken % PROGRESS_STEPS);
                taken += match stepper.step(taken, at_most, state, system, ticker) {
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
                    stepper.settle(state);
                    return Err(error);
                }
            }
            stepper.settle(state);
            let reached: &State<S> = match place.past {
                None => state,
                Some(past) => {
                    let between = between.get_or_insert_with(|| state.clone());
                    between.copy_from(state);
                    stepper.between(taken, past, between, system, ticker)?;
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
