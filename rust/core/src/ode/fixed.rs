//! Runs with a fixed step: nodes at `t0 + n·h`, outputs that never touch them.
//!
//! An output on a node is the node's state, to the bit; one between nodes comes from a sub-step on a
//! copy, of the method's own order (a multistep method's is of the kind that starts it). So does an end that is
//! not a node.

use super::ahead::Ahead;
use super::state::State;
use super::stepper::Stepper;
use super::system::System;
use crate::error::Result;
use crate::numerics::element::Element;
use crate::numerics::lanes::Bits;
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

    /// Whether it is told by [`suspects`](Self::suspects) which steps must be looked into; the first one is, always.
    fn looks_ahead(&self) -> bool {
        false
    }

    /// The node up to which steps need not be looked into.
    fn looks_again_at(&self) -> u64 {
        0
    }

    /// Takes note of the state at a node, in the first, the second … of nine places.
    fn note(&mut self, place: usize, node: u64, state: &State<S>) {
        let _ = (place, node, state);
    }

    /// Which of so many steps between those nodes must be looked into.
    fn suspects(&mut self, steps: usize) -> Bits {
        let _ = steps;
        Bits(0xff)
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

    /// Whether it has just seen the end of something that wants to know what was [spent](Self::spent) on it.
    fn asks(&self) -> bool {
        false
    }

    /// Told when it asks: steps, and evaluations but for those of steps that were taken again.
    fn spent(&mut self, steps: u64, evaluations: u64) {
        let _ = (steps, evaluations);
    }
}

/// A step that was taken, to be looked into, or the last part of the run, which is shorter than a step.
pub struct Taken<'a, S: Element> {
    /// The node at which it begins.
    pub node: u64,
    /// The settled state there.
    pub before: &'a State<S>,
    /// The one to which it led.
    pub after: &'a State<S>,
    /// How long it is, if that is no whole step.
    pub part: Option<f64>,
    /// To take shadow steps from the node at which it begins.
    pub stepper: &'a mut dyn Stepper<S>,
    /// For those steps.
    pub system: &'a mut dyn System<S>,
    /// Evaluations of steps that were taken again.
    pub repeated: u64,
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
    /// Evaluations of steps that were taken again.
    pub repeated: u64,
    /// `Ok` at the last output time, or where the most steps were taken or the recorder gave up; else what ended it.
    pub outcome: Result<()>,
}

/// What advances what, and how far it has come.
pub(super) struct Walk<'a, S: Element> {
    pub(super) stepper: &'a mut dyn Stepper<S>,
    pub(super) state: &'a mut State<S>,
    pub(super) system: &'a mut dyn System<S>,
    pub(super) node: u64,
    /// As in [`Ended`].
    pub(super) stands: bool,
    /// As in [`Ended`].
    pub(super) repeated: u64,
    /// The state before a step that may be broken off.
    before: Option<State<S>>,
}

impl<S: Element> Walk<'_, S> {
    /// Takes a step, or up to so many.
    ///
    /// # Errors
    /// Those of an evaluation; the state is that of the last node.
    #[inline(always)]
    pub(super) fn step(&mut self, at_most: u64, ticker: &mut Ticker<'_>) -> Result<()> {
        if let Some(before) = &mut self.before {
            self.stepper.settle(self.state);
            before.copy_from(self.state);
        }
        match self.stepper.step(self.node, at_most, self.state, self.system, ticker) {
            Ok(steps) => self.node += steps,
            Err(error) => {
                self.stands = false;
                // Some methods change the state in place: half a step is taken back.
                if let Some(before) = &self.before {
                    self.state.copy_from(before);
                }
                return Err(error);
            }
        }
        Ok(())
    }

    /// Takes so many steps and shows each settled state that they lead to.
    ///
    /// # Errors
    /// Those of an evaluation; the state is then of no node.
    #[inline(always)]
    pub(super) fn steps(
        &mut self,
        count: u64,
        ticker: &mut Ticker<'_>,
        each: &mut dyn FnMut(&State<S>),
    ) -> Result<()> {
        let outcome = self.stepper.steps(self.node, count, self.state, self.system, ticker, each);
        self.node += count;
        self.stands = outcome.is_ok();
        outcome
    }

    /// Tells the recorder what was spent since the node `from`, if it asks.
    #[inline(always)]
    fn tell(&self, from: u64, recorder: &mut impl Recorder<S>) {
        if recorder.asks() {
            recorder.spent(self.node - from, self.system.evaluations() - self.repeated);
        }
    }

    /// Has the last step looked into, which began at that state.
    ///
    /// # Errors
    /// Whatever ends the run.
    pub(super) fn look(
        &mut self,
        before: &State<S>,
        ticker: &mut Ticker<'_>,
        recorder: &mut impl Recorder<S>,
    ) -> Result<bool> {
        let (node, repeated) = (self.node - 1, self.repeated);
        let (stepper, system) = (&mut *self.stepper, &mut *self.system);
        recorder
            .look(Taken { node, before, after: self.state, part: None, stepper, system, repeated }, ticker)
    }
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
    let before = system.stops_midway().then(|| state.clone());
    let mut walk = Walk { stepper, state, system, node: from, stands: true, repeated: 0, before };
    let outcome = through(&mut walk, max_steps, places, ticker, recorder);
    let Walk { node, stands, repeated, .. } = walk;
    Ended { node, steps: node - from, stands, repeated, outcome }
}

#[inline(always)]
fn through<S: Element>(
    walk: &mut Walk<'_, S>,
    max_steps: u64,
    places: impl Iterator<Item = Place>,
    ticker: &mut Ticker<'_>,
    recorder: &mut impl Recorder<S>,
) -> Result<()> {
    let from = walk.node;
    let last = from.saturating_add(max_steps);
    let mut between = None;
    let watches = recorder.watches();
    // Where the step began that is looked into.
    let mut before = watches.map(|_| walk.state.clone());
    if watches.is_some() {
        walk.stepper.look_back();
    }
    let mut ahead = if recorder.looks_ahead() { Ahead::new(walk.state) } else { None };
    let mut going = true;
    for (index, place) in places.enumerate() {
        while going && walk.node < place.node {
            if walk.node == last {
                walk.stepper.settle(walk.state);
                return Ok(());
            }
            let past = walk.node - from;
            let at_most = (place.node.min(last) - walk.node).min(PROGRESS_STEPS - past % PROGRESS_STEPS);
            going = match (&mut before, &mut ahead) {
                (None, _) => {
                    walk.step(at_most, ticker)?;
                    true
                }
                // What starts at zero is told from what comes there in the first step alone.
                (Some(before), Some(ahead)) if past > 0 => {
                    ahead.advance(at_most, walk, before, ticker, recorder)?
                }
                (Some(_), _) if recorder.looks_again_at() > walk.node => {
                    walk.step(at_most.min(recorder.looks_again_at() - walk.node), ticker)?;
                    walk.stepper.settle(walk.state);
                    true
                }
                (Some(before), _) => {
                    before.copy_from(walk.state);
                    walk.step(1, ticker)?;
                    walk.stepper.settle(walk.state);
                    walk.look(before, ticker, recorder)?
                }
            };
            let past = walk.node - from;
            if past.is_multiple_of(PROGRESS_STEPS) {
                ticker.advance(PROGRESS_STEPS);
            }
            if !going {
                break;
            }
            if past.is_multiple_of(WATCH_STEPS) {
                walk.stepper.settle(walk.state);
                let goes_on = recorder.goes_on(walk.state);
                walk.tell(from, recorder);
                if !goes_on {
                    return Ok(());
                }
            }
            if let Err(error) = ticker.tick() {
                walk.stepper.settle(walk.state);
                return Err(error);
            }
        }
        // What ended the run may have been at this very node.
        if !going && (walk.node < place.node || place.past.is_some()) {
            return Ok(());
        }
        let Walk { node, repeated, .. } = *walk;
        let (stepper, state, system) = (&mut *walk.stepper, &mut *walk.state, &mut *walk.system);
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
            let part = Some(past);
            let taken = Taken { node, before: state, after: reached, part, stepper, system, repeated };
            let _: bool = recorder.look(taken, ticker)?;
        }
        recorder.record(index, reached, ticker)?;
        walk.tell(from, recorder);
    }
    ticker.advance((walk.node - from) % PROGRESS_STEPS);
    Ok(())
}
