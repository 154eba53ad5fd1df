//! Events of eight trajectories: each is looked for in the step of its own lane.
//!
//! The one idea: the first look into a step is at the same part of it in every lane, and is read side by side; only who has to look
//! closer asks for states of its own, and pays for them.

use super::{Abreast, SideBySide};
use crate::error::{Error, Result};
use crate::generalized::events::{INSIDE, Interval};
use crate::generalized::motion::Motion;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::run::Ending;
use crate::ode::state::State;
use crate::ode::step_control::Controlled;
use crate::ode::step_control::Settled;
use crate::ode::system::System;
use crate::parallel::Ticker;

/// The step of one lane.
struct Stepped<'r, 't> {
    trial: &'r mut dyn SideBySide,
    system: &'r mut Motion<Lanes>,
    state: &'r State<Lanes>,
    between: &'r mut State<Lanes>,
    outcome: &'r Settled<Lanes>,
    ticker: &'r mut Ticker<'t>,
    lane: usize,
    span: (f64, f64),
    end: Vec<f64>,
    /// The state at the first look.
    inside: &'r [f64],
    /// That at the last one, and how many there were of its own.
    there: Vec<f64>,
    reads: u64,
}

impl Interval for Stepped<'_, '_> {
    fn span(&self) -> (f64, f64) {
        self.span
    }

    fn end(&self) -> &[f64] {
        &self.end
    }

    fn at(&mut self, theta: f64) -> Result<&[f64]> {
        if theta == 1.0 {
            return Ok(&self.end);
        }
        if theta == INSIDE {
            return Ok(self.inside);
        }
        let Self { trial, system, state, between, outcome, ticker, lane, .. } = self;
        trial.at(outcome, *system, state, Lanes::zero().with_lane(*lane, theta), between, ticker)?;
        self.reads += 1;
        self.there.clear();
        self.there.extend(between.all().0.iter().map(|y| y.0[*lane]));
        match trial.lost(*lane) {
            Some(message) => Err(Error::Convergence { message, time: self.span.0 }),
            None => Ok(&self.there),
        }
    }
}

impl Abreast<'_> {
    /// Looks for events in the steps of these lanes, of which the continuous extension is ready then; the lanes that go on or stop
    /// within their step.
    ///
    /// # Errors
    /// Those of an evaluation.
    pub(super) fn look_for_events(
        &mut self,
        outcome: &Settled<Lanes>,
        kept: Bits,
        ticker: &mut Ticker<'_>,
    ) -> Result<Bits> {
        let Self { trial, system, state, between, cost, in_step, .. } = self;
        trial.dense(outcome, system, state, ticker)?;
        let first = Lanes::select(kept, Lanes::splat(INSIDE), Lanes::zero());
        trial.at(outcome, system, state, first, between, ticker)?;
        let inside: Vec<Lanes> = between.all().0.to_vec();
        let (cost, in_step) = (*cost, *in_step);
        let together = self.taken_together();
        let mut left = kept;
        for lane in (0..WIDTH).filter(|&lane| kept.lane(lane)) {
            let (taken, lost) = (self.trial.taken(lane), self.trial.lost(lane));
            let Some(slot) = &mut self.slots[lane] else { continue };
            slot.solution.evaluations += cost.dense + cost.read + taken;
            let before = self.system.evaluations();
            let own: Vec<f64> = inside.iter().map(|y| y.0[lane]).collect();
            let mut step = Stepped {
                span: (slot.from, slot.solution.reached),
                end: self.trial.next().all().0.iter().map(|y| y.0[lane]).collect(),
                trial: &mut *self.trial,
                system: &mut self.system,
                state: &self.state,
                between: &mut self.between,
                outcome,
                ticker: &mut *ticker,
                lane,
                inside: &own,
                there: Vec::new(),
                reads: 0,
            };
            let looked = match lost {
                Some(message) => Err(Error::Convergence { message, time: slot.from }),
                None => slot.watch.look(&mut step),
            };
            let reads = step.reads;
            slot.solution.evaluations += cost.read * reads + self.trial.taken(lane);
            if in_step {
                let spent = self.system.evaluations() - before;
                slot.looked += spent;
                self.looked += spent;
                slot.solution.evaluations = together - slot.before + slot.looked;
            }
            match looked {
                Ok(stop) => slot.stop = stop,
                Err(Error::Convergence { message, .. }) => {
                    slot.solution.reached = slot.from;
                    self.end(lane, Ending::StepTooSmall, Some(message), ticker);
                    left = left.and(Bits(1 << lane).not());
                }
                Err(other) => return Err(other),
            }
        }
        Ok(left)
    }
}
