//! How trajectories leave their lanes: at the end, at a pole, where friction holds them, or interrupted.

use super::{Abreast, Slot};
use crate::error::Error;
use crate::numerics::lanes::{Bits, WIDTH};
use crate::numerics::real::Mask;
use crate::ode::run::Ending;
use crate::parallel::Ticker;

impl Abreast<'_> {
    /// The lanes of these whose step did not go through a pole; the others end.
    pub(super) fn short_of_poles(&mut self, kept: Bits, ticker: &mut Ticker<'_>) -> Bits {
        let mut short = Bits(0);
        for lane in (0..WIDTH).filter(|&lane| kept.lane(lane)) {
            let Some(slot) = self.slots[lane].as_mut() else { continue };
            if !slot.poles.is_empty() {
                let y: Vec<f64> = self.trial.next().all().0.iter().map(|y| y.0[lane]).collect();
                if let Err(Error::Convergence { message, .. }) = slot.poles.look(slot.solution.reached, &y) {
                    self.passed.push(slot.index);
                    self.end(lane, Ending::StepTooSmall, Some(message), ticker);
                    continue;
                }
            }
            short = short.or(Bits(1 << lane));
        }
        short
    }

    /// Ends those lanes of these in which friction holds what the step came to.
    pub(super) fn look_for_rest(&mut self, kept: Bits, ticker: &mut Ticker<'_>) {
        for lane in (0..WIDTH).filter(|&lane| kept.lane(lane)) {
            let next = self.trial.next();
            let looks = |slot: &&mut Slot<'_>| slot.stop.is_none() && !slot.sticking.is_empty();
            let Some(slot) = self.slots[lane].as_mut().filter(looks) else {
                continue;
            };
            let y: Vec<f64> = next.all().0.iter().map(|y| y.0[lane]).collect();
            if let Err(Error::Convergence { message, .. }) =
                slot.sticking.look(slot.solution.reached, &y, self.request.dt)
            {
                self.end(lane, Ending::StepTooSmall, Some(message), ticker);
            }
        }
    }

    /// Ends those lanes of these that an event stops.
    pub(super) fn stop_at_events(&mut self, kept: Bits, ticker: &mut Ticker<'_>) {
        for lane in (0..WIDTH).filter(|&lane| kept.lane(lane)) {
            let Some(slot) = self.slots[lane].as_mut() else { continue };
            if let Some(stop) = slot.stop {
                slot.solution.reached = stop;
                self.end(lane, Ending::Stopped, None, ticker);
            }
        }
    }

    /// Ends a trajectory, and tells so.
    pub(super) fn end(
        &mut self,
        lane: usize,
        ending: Ending,
        failure: Option<String>,
        ticker: &mut Ticker<'_>,
    ) {
        self.settle(lane, ending, failure);
        ticker.advance(1);
    }

    /// Ends all that run where they are.
    pub(super) fn interrupt(&mut self) {
        for lane in 0..WIDTH {
            self.settle(lane, Ending::Interrupted, None);
        }
    }

    /// Puts away what a trajectory has come to, if there is one in the lane.
    pub(super) fn settle(&mut self, lane: usize, ending: Ending, failure: Option<String>) {
        let Some(Slot { index, mut solution, mut sticking, watch, .. }) = self.slots[lane].take() else {
            return;
        };
        solution.found = watch.found;
        for (last, y) in solution.last_state.iter_mut().zip(self.state.all().0) {
            *last = y.0[lane];
        }
        solution.ending = ending;
        solution.failure = failure.or_else(|| match ending {
            Ending::StepTooSmall => sticking.explains(solution.last_time, &solution.last_state),
            _ => None,
        });
        solution.failure = solution.failure.or_else(|| ending.reason());
        self.done[index] = Some(solution);
    }
}
