//! Outputs of an adaptive run: those that a step has passed are read off it before it is committed.
//!
//! Each lane has its own next output, so the outputs of a step are taken in rounds: one output per lane in
//! each, at the fraction of the step where that lane has it.

use super::{Run, Slot};
use crate::error::Result;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::step_control::Settled;
use crate::parallel::Ticker;

/// The next outputs that a step has passed.
struct Round {
    /// The lanes that have one.
    due: Bits,
    /// Those of them that have it before the end of the step.
    inside: Bits,
    /// Where, as a fraction of the step.
    theta: Lanes,
}

impl Run<'_> {
    /// Records the outputs at the start of a unit.
    ///
    /// # Errors
    /// When the caller asks to stop.
    pub(super) fn record_start(
        &self,
        slot: &mut Slot<'_>,
        lane: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        if !slot.unit.unit.reports() {
            slot.next_output = self.outputs.len();
        }
        while slot.next_output < self.outputs.len() && self.outputs[slot.next_output] == 0.0 {
            let _: bool =
                slot.unit.record(self.job.writer, slot.next_output, &self.state, lane, 0.0, ticker)?;
            slot.next_output += 1;
        }
        Ok(())
    }

    /// Records the outputs that the step has passed, before it is committed; the continuous extension may be `ready`
    /// and charged. Gives the lanes that have paid for it; it is then ready.
    ///
    /// # Errors
    /// When the caller asks to stop.
    pub(super) fn record(
        &mut self,
        outcome: &Settled<Lanes>,
        mut ready: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<Bits> {
        let mut charged = if ready { outcome.accepted } else { Bits(0) };
        loop {
            let round = self.round(outcome);
            if !round.due.any() {
                return Ok(charged);
            }
            if round.inside.any() {
                let Self { trial, state, between, forces, .. } = self;
                if !ready {
                    trial.dense(outcome, forces.system(), state, ticker)?;
                    ready = true;
                }
                trial.at(outcome, forces.system(), state, round.theta, between, ticker)?;
                self.charge(round.inside.and(charged.not()), self.cost.dense);
                self.charge(round.inside, self.cost.read);
                charged = charged.or(round.inside);
            }
            self.write(&round, ticker)?;
        }
    }

    /// The next output of each lane that lies inside the step.
    fn round(&self, outcome: &Settled<Lanes>) -> Round {
        let direction = self.job.plan.direction;
        let mut round = Round { due: Bits(0), inside: Bits(0), theta: Lanes::one() };
        for lane in 0..WIDTH {
            let Some(slot) = self.slots[lane].as_ref() else { continue };
            if !outcome.accepted.lane(lane) || slot.next_output == self.outputs.len() {
                continue;
            }
            let output = self.outputs[slot.next_output];
            let to = self.elapsed(lane);
            let at_the_end = outcome.finished.lane(lane) && self.part.last.lane(lane);
            if (output - to) * direction > 0.0 && !at_the_end {
                continue;
            }
            round.due = round.due.or(Bits(1 << lane));
            if (to - output) * direction > 0.0 {
                let lanes = self.layout.mask(lane);
                let since = (output - self.part.from.0[lane]) - outcome.from.0[lane];
                let fraction = since / outcome.h.0[lane];
                round.inside = round.inside.or(lanes);
                round.theta = Lanes::select(lanes, Lanes::splat(fraction), round.theta);
            }
        }
        round
    }

    fn write(&mut self, round: &Round, ticker: &mut Ticker<'_>) -> Result<()> {
        for lane in 0..WIDTH {
            if !round.due.lane(lane) {
                continue;
            }
            let Some(slot) = self.slots[lane].as_mut() else { continue };
            let state = if round.inside.lane(lane) { &self.between } else { self.trial.next() };
            let elapsed = self.job.scene.elapsed(self.job.times[slot.next_output]);
            // A step is only accepted with a finite error, so its states are finite.
            let _: bool =
                slot.unit.record(self.job.writer, slot.next_output, state, lane, elapsed, ticker)?;
            slot.next_output += 1;
        }
        Ok(())
    }

    /// Counts evaluations of the continuous extension for the units that read it.
    pub(super) fn charge(&mut self, lanes: Bits, evaluations: u64) {
        for (lane, slot) in self.slots.iter_mut().enumerate() {
            if let Some(slot) = slot {
                slot.counts.evaluations += if lanes.lane(lane) { evaluations } else { 0 };
            }
        }
    }
}
