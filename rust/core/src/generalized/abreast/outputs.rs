//! Output times of eight trajectories: each is read from the step of its own lane that passes it.

use super::{Abreast, Slot};
use crate::error::Result;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::run::Ending;
use crate::ode::state::State;
use crate::ode::step_control::Settled;
use crate::parallel::Ticker;

impl Abreast<'_> {
    /// Reads the output times that the kept steps pass, of which the continuous extension may be ready.
    pub(super) fn record(
        &mut self,
        outcome: &Settled<Lanes>,
        kept: Bits,
        mut dense: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let forward = self.request.span.0 <= self.request.span.1;
        loop {
            let (mut theta, mut between) = (Lanes::zero(), Bits(0));
            let (outputs, cost) = (self.outputs, self.cost);
            let Self { slots, trial, state, .. } = self;
            for (lane, slot) in slots.iter_mut().enumerate().filter(|(lane, _)| kept.lane(*lane)) {
                let Some(slot) = slot else { continue };
                let (from, to) = (slot.from, slot.solution.reached);
                let end = slot.stop.unwrap_or(to);
                while let Some(&t) = outputs.get(slot.next_output)
                    && (if forward { t <= end } else { t >= end })
                {
                    let at = if t == to {
                        trial.next()
                    } else if t == from {
                        &*state
                    } else {
                        theta.0[lane] = (t - from) / (to - from);
                        between = between.or(Bits(1 << lane));
                        slot.solution.evaluations += if dense { cost.read } else { cost.dense + cost.read };
                        break;
                    };
                    slot.write(t, at, lane);
                }
            }
            if !between.any() {
                return Ok(());
            }
            let Self { trial, system, state, between: there, .. } = self;
            if !dense {
                trial.dense(outcome, system, state, ticker)?;
                dense = true;
            }
            trial.at(outcome, system, state, theta, there, ticker)?;
            let (in_step, together) = (self.in_step, self.taken_together());
            for lane in (0..WIDTH).filter(|&lane| between.lane(lane)) {
                let (taken, lost) = (self.trial.taken(lane), self.trial.lost(lane));
                let Some(slot) = &mut self.slots[lane] else { continue };
                slot.solution.evaluations += taken;
                if in_step {
                    slot.solution.evaluations = together - slot.before + slot.looked;
                }
                if lost.is_some() {
                    // As in a run alone: nothing is known beyond.
                    slot.solution.reached = outputs[slot.next_output];
                    self.end(lane, Ending::StepTooSmall, lost, ticker);
                } else {
                    slot.write(outputs[slot.next_output], &self.between, lane);
                }
            }
        }
    }
}

impl Slot<'_> {
    /// Writes a row.
    pub(super) fn write(&mut self, t: f64, state: &State<Lanes>, lane: usize) {
        self.solution.t.push(t);
        self.solution.y.extend(state.all().0.iter().map(|y| y.0[lane]));
        self.next_output += 1;
    }
}
