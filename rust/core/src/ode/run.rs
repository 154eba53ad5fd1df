//! Runs of any system from one time to another, step by step, with everything that is read on the way left to a recorder.
//!
//! The one idea: the loop knows a [`System`], a [`Trial`] and a [`Recorder`]. A recorder looks at each step before it is
//! kept, at its ends and anywhere between, and may end the run there; what nobody looks at is not computed.

use super::extension::Extension;
use super::norm::Norm;
use super::state::State;
use super::step_control::{Clock, Settled};
use super::system::System;
use super::trial::Trial;
use crate::error::{Error, Result};
use crate::parallel::Ticker;

/// The shortest step, in units in the last place of the time.
const SMALLEST_STEP: f64 = 10.0;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// At the end of the span.
    Finished,
    /// Where the recorder said.
    Stopped,
    /// The step fell below what can be told apart from the time.
    StepTooSmall,
    /// A number is infinite or none.
    NotFinite,
    /// The most steps that it may take were taken.
    TooManySteps,
    /// Somebody asked to stop.
    Interrupted,
}

impl Ending {
    /// What ended a run of given equations, if that was no end.
    pub fn reason(self) -> Option<String> {
        let why = match self {
            Self::StepTooSmall => {
                "the step fell below what can be told from the time: a singularity, or a rtol too small"
            }
            Self::NotFinite => {
                "a number became infinite, or none: a singularity of the expressions, or growth beyond 1.8e308"
            }
            Self::Finished | Self::Stopped | Self::TooManySteps | Self::Interrupted => return None,
        };
        Some(why.to_owned())
    }
}

/// What looks at the steps of a run.
pub trait Recorder {
    /// The state at the start.
    ///
    /// # Errors
    /// Its own; [`Error::Interrupted`] ends the run with what there is.
    fn start(&mut self, t: f64, y: &[f64]) -> Result<()>;

    /// A step is about to be kept. The time at which the run ends, if it does.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    fn step(&mut self, step: &mut Step<'_, '_>) -> Result<Option<f64>>;
}

/// A step that is about to be kept, and what may be asked of it.
pub struct Step<'a, 'b> {
    /// The time before it.
    pub from: f64,
    /// The time after it.
    pub to: f64,
    outcome: Settled<f64>,
    trial: &'a mut dyn Trial<f64>,
    system: &'a mut dyn System<f64>,
    state: &'a State<f64>,
    between: &'a mut State<f64>,
    ticker: &'a mut Ticker<'b>,
    dense: bool,
}

impl Step<'_, '_> {
    /// The state before it.
    pub fn start(&self) -> &[f64] {
        self.state.all().0
    }

    /// The state after it.
    pub fn end(&self) -> &[f64] {
        self.trial.next().all().0
    }

    /// Readies the continuous extension.
    fn ready(&mut self) -> Result<()> {
        if !self.dense {
            self.trial.dense(&self.outcome, self.system, self.state, self.ticker)?;
            self.dense = true;
        }
        Ok(())
    }

    /// The state at a time within it.
    ///
    /// # Errors
    /// Those of an evaluation.
    pub fn at(&mut self, t: f64) -> Result<&[f64]> {
        if t == self.to {
            return Ok(self.end());
        }
        if t == self.from {
            return Ok(self.start());
        }
        self.between((t - self.from) / (self.to - self.from))
    }

    /// The state at a fraction of it: nothing is lost to the rounding of the time.
    ///
    /// # Errors
    /// Those of an evaluation.
    pub fn between(&mut self, theta: f64) -> Result<&[f64]> {
        if theta == 1.0 {
            return Ok(self.end());
        }
        self.ready()?;
        self.trial.at(&self.outcome, self.system, self.state, theta, self.between, self.ticker)?;
        Ok(self.between.all().0)
    }

    /// Adds its polynomial to the others; the node at its end is left to the caller.
    ///
    /// # Errors
    /// Those of an evaluation.
    pub fn extend(&mut self, into: &mut Extension) -> Result<()> {
        self.ready()?;
        into.lengths.push(self.to - self.from);
        into.starts.extend_from_slice(self.start());
        self.trial.extension(self.state, self.outcome.h, &mut into.terms);
        Ok(())
    }
}

/// When a run begins and ends, and where its nodes are.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    /// From the first time to the second.
    pub span: (f64, f64),
    /// The first step, if it is not chosen.
    pub first_step: Option<f64>,
    /// Whether steps end at times that are numbers: far from zero the time of a node that is told is else another than its own,
    /// by half a rounding, in which a fast motion goes farther than it errs. Of steps that have to be equal it is not asked.
    pub nodes_are_numbers: bool,
}

/// Runs a system from one time to another, neither of which need be smaller. The clock and the system count time from the
/// first; the first step is chosen unless it is given. The state is that of the last kept step.
///
/// # Errors
/// Those of the system and of the recorder but [`Error::Interrupted`].
pub fn run<T: Trial<f64>>(
    trial: &mut T,
    system: &mut dyn System<f64>,
    state: &mut State<f64>,
    norm: &Norm<f64>,
    times: Times,
    recorder: &mut dyn Recorder,
    ticker: &mut Ticker<'_>,
) -> Result<Ending> {
    let ending = steps(trial, system, state, norm, times, recorder, ticker);
    if ending == Err(Error::Interrupted) { Ok(Ending::Interrupted) } else { ending }
}

fn steps<T: Trial<f64>>(
    trial: &mut T,
    system: &mut dyn System<f64>,
    state: &mut State<f64>,
    norm: &Norm<f64>,
    Times { span: (t0, end), first_step, nodes_are_numbers }: Times,
    recorder: &mut dyn Recorder,
    ticker: &mut Ticker<'_>,
) -> Result<Ending> {
    let mut clock = Clock::new(end - t0);
    let direction = if end < t0 { -1.0 } else { 1.0 };
    clock.h = direction * first_step.unwrap_or(0.0);
    recorder.start(t0, state.all().0)?;
    trial.start(true, system, state, &mut clock, norm, ticker)?;
    let mut between = state.clone();
    loop {
        let from = t0 + clock.elapsed;
        let smallest = smallest_step(from);
        if clock.h.abs() < smallest && clock.elapsed != clock.end {
            clock.h = direction * smallest;
        }
        let outcome = loop {
            ticker.tick()?;
            if nodes_are_numbers && t0 != 0.0 {
                let node = t0 + (clock.elapsed + clock.h);
                clock.h = (node - t0) - clock.elapsed;
            }
            let outcome = trial.attempt(true, system, state, &mut clock, norm, ticker)?;
            if outcome.accepted {
                break outcome;
            }
            if clock.h.is_nan() || clock.h.abs() < smallest {
                return Ok(Ending::StepTooSmall);
            }
        };
        if is_lost(outcome.h, smallest) && !outcome.finished {
            return Ok(Ending::StepTooSmall);
        }
        if !trial.next().all().0.iter().all(|y| y.is_finite()) {
            return Ok(Ending::NotFinite);
        }
        let to = if outcome.finished { end } else { t0 + clock.elapsed };
        let mut step = Step {
            from,
            to,
            outcome,
            trial: &mut *trial,
            system: &mut *system,
            state,
            between: &mut between,
            ticker: &mut *ticker,
            dense: false,
        };
        let stopped = recorder.step(&mut step)?;
        trial.keep(true, state);
        if stopped.is_some() {
            return Ok(Ending::Stopped);
        }
        ticker.reach((to - t0) / (end - t0));
        if outcome.finished {
            return Ok(Ending::Finished);
        }
    }
}

/// Whether a step that was taken is lost in the rounding of the time, below its last digit, as those may be that a method
/// chooses whatever the clock says.
pub(crate) fn is_lost(h: f64, smallest: f64) -> bool {
    h.abs() * SMALLEST_STEP < smallest
}

/// The shortest step from a time.
pub(crate) fn smallest_step(t: f64) -> f64 {
    let t = t.abs();
    SMALLEST_STEP * (t.next_up() - t)
}
