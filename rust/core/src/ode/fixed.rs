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
use crate::numerics::power_of_two::{exponent, power_of_two};
use crate::numerics::real::Real;
use crate::parallel::Ticker;

/// Steps between two counts of progress.
const PROGRESS_STEPS: u64 = 64;
/// Steps between two looks at whether the run is worth going on with: a multistep method has to settle its state for it.
const WATCH_STEPS: u64 = 1024;

/// Where a time lies among the nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The last node not after it.
    pub node: u64,
    /// The time past that node; `None` on the node.
    pub past: Option<f64>,
}

/// The distance between numbers of this magnitude.
fn spacing(magnitude: f64) -> f64 {
    power_of_two(exponent(magnitude) - 52)
}

/// Finds the place of `elapsed = t - t0` among the nodes `n·h`.
///
/// Within two units in the last place of the time itself (`magnitude` is the larger of |t|, |t0|) a time
/// is on the node: it cannot be told from it, and a grid such as `linspace` hits nodes only that closely. But not an
/// eighth of a step off: where times are that coarse, each is meant.
#[inline]
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
    let off = (elapsed - nearest * h).abs();
    let near = || off <= 2.0 * spacing(Real::max(magnitude, distance)) && off <= 0.124 * h.abs();
    if off == 0.0 || near() {
        return Place { node, past: None };
    }
    let (nearest, node) =
        if nearest * h.abs() > distance { (nearest - 1.0, node - 1) } else { (nearest, node) };
    Place { node, past: Some(elapsed - nearest * h) }
}

/// Who looks at the states of a run.
pub trait Recorder<S: Element> {
    /// Takes the state at an output time; to refuse it ends the run.
    ///
    /// # Errors
    /// Whatever ends the run.
    fn record(&mut self, index: usize, state: &State<S>, ticker: &mut Ticker<'_>) -> Result<()>;

    /// The last output, if each step up to it is to be looked into.
    fn watches(&self) -> Option<usize> {
        None
    }

    /// Looks into the step that led to the present node, or into a part of the next one; `false` ends the run.
    ///
    /// # Errors
    /// Whatever ends the run.
    fn look(&mut self, taken: Taken<'_, S>, ticker: &mut Ticker<'_>) -> Result<bool> {
        let _ = (taken, ticker);
        Ok(true)
    }

    /// Whether the run is worth going on with; asked every few steps.
    fn goes_on(&mut self, state: &State<S>) -> bool;
}

/// A step that was taken, to be looked into.
pub struct Taken<'a, S: Element> {
    /// The present node.
    pub node: u64,
    /// The settled state there.
    pub present: &'a State<S>,
    /// The state that the run has come to past the present node, and how far past; else it has come to the node.
    pub past: Option<(f64, &'a State<S>)>,
    /// To take shadow steps from the present node.
    pub stepper: &'a mut dyn Stepper<S>,
    /// For those steps.
    pub system: &'a mut dyn System<S>,
}

/// How a run ended.
#[derive(Debug)]
pub struct Ended {
    /// The last node.
    pub node: u64,
    /// Steps taken.
    pub steps: u64,
    /// Whether all that the stepper holds belongs to that node: not if a step was broken off.
    pub stands: bool,
    /// `Ok` at the last output time, or where the most steps were taken or the recorder gave up; else what ended it.
    pub outcome: Result<()>,
}

/// Advances `state`, with the stepper at the node `from`, through the places of the outputs, in order, and hands each
/// state to the recorder; stops short after `max_steps`.
pub fn run<S: Element>(
    stepper: &mut dyn Stepper<S>,
    from: u64,
    max_steps: u64,
    state: &mut State<S>,
    system: &mut dyn System<S>,
    places: impl Iterator<Item = Place>,
    ticker: &mut Ticker<'_>,
    recorder: &mut impl Recorder<S>,
) -> Ended {
    let mut node = from;
    let mut stands = true;
    let last = from.saturating_add(max_steps);
    let outcome = (|| {
        let mut between = None;
        let watches = recorder.watches();
        let mut before = system.stops_midway().then(|| state.clone());
        for (index, place) in places.enumerate() {
            while node < place.node {
                if node == last {
                    stepper.settle(state);
                    return Ok(());
                }
                if let Some(before) = &mut before {
                    stepper.settle(state);
                    before.copy_from(state);
                }
                let at_most =
                    (place.node.min(last) - node).min(PROGRESS_STEPS - (node - from) % PROGRESS_STEPS);
                let at_most = if watches.is_some() { 1 } else { at_most };
                node += match stepper.step(node, at_most, state, system, ticker) {
                    Ok(steps) => steps,
                    Err(error) => {
                        stands = false;
                        // Some methods change the state in place: half a step is taken back.
                        if let Some(before) = &before {
                            state.copy_from(before);
                        }
                        return Err(error);
                    }
                };
                if (node - from).is_multiple_of(PROGRESS_STEPS) {
                    ticker.advance(PROGRESS_STEPS);
                }
                if (node - from).is_multiple_of(WATCH_STEPS) {
                    stepper.settle(state);
                    if !recorder.goes_on(state) {
                        return Ok(());
                    }
                }
                if watches.is_some() {
                    stepper.settle(state);
                    let step = Taken { node, present: state, past: None, stepper: &mut *stepper, system };
                    if !recorder.look(step, ticker)? {
                        return Ok(());
                    }
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
                    stepper.between(node, past, between, system, ticker)?;
                    &*between
                }
            };
            if let (true, Some(past)) = (watches == Some(index), place.past) {
                let past = Some((past, reached));
                let step = Taken { node, present: state, past, stepper: &mut *stepper, system };
                let _: bool = recorder.look(step, ticker)?;
            }
            recorder.record(index, reached, ticker)?;
        }
        ticker.advance((node - from) % PROGRESS_STEPS);
        Ok(())
    })();
    Ended { node, steps: node - from, stands, outcome }
}
