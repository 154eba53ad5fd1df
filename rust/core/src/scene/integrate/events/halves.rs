//! Where in a step an expression may be zero.
//!
//! The one idea: parts of a step over which bounds keep it from zero are done with; the others are halved, the longest first, as
//! often as the share of the run that the step is allows, and what is left at last is sampled at its ends. What is thin or fast in
//! a long step is seen so, and a step in which nothing may be zero costs nothing more.

use super::expressions::between;
use super::search::Search;
use crate::error::Result;
use crate::expressions::intervals::Interval;
use crate::numerics::power_of_two::scale;
use crate::parallel::Ticker;
use crate::scene::frame::Moved;

/// So many parts of a whole run are halved, …
const OF_A_RUN: f64 = 16_384.0;
/// … and of each step at least so many.
const OF_A_STEP: f64 = 24.0;
/// A part of the run that is halved no more.
const SHORTEST: f64 = 1.0 / 1_048_576.0;

/// A place in a step: at which fraction of it, and what an expression looks at there.
type Place = (f64, Vec<f64>);

impl Search<'_, '_> {
    /// Places between which the event may be zero in the step, if it is an expression that has bounds; none of another kind.
    pub(super) fn may_be_zero_between(&mut self, ticker: &mut Ticker<'_>) -> Result<Vec<f64>> {
        let working = self.watch.working.get(self.event).and_then(Option::as_ref);
        if working.is_none_or(|working| working.borrow().shape.is_none()) {
            return Ok(Vec::new());
        }
        let (job, length) = (self.watch.job, self.length().abs());
        let run = job.times.last().map_or(length, |end| (end - job.scene.t0).abs()).max(length);
        let mut left = (OF_A_RUN * length / run).max(OF_A_STEP) as usize;
        let shortest = SHORTEST * run / length;
        let mut pending = vec![(self.looked_at(0.0), self.looked_at(1.0))];
        let mut found = Vec::new();
        while !pending.is_empty() {
            let mut halves = Vec::new();
            for (from, to) in pending {
                ticker.tick()?;
                if self.is_clear_between(&from, &to) {
                    continue;
                }
                if left == 0 || to.0 - from.0 <= shortest {
                    found.extend([from.0, to.0]);
                    continue;
                }
                left -= 1;
                let middle = self.looked_at(0.5 * (from.0 + to.0));
                halves.extend([(from, middle.clone()), (middle, to)]);
            }
            pending = halves;
        }
        found.retain(|theta| 0.0 < *theta && *theta < 1.0);
        Ok(found)
    }

    /// What the expression looks at there, on the polynomial of the step.
    fn looked_at(&mut self, theta: f64) -> Place {
        self.watch.place(self.event, self.unit.shape.components, self.span, theta);
        let (own, places) = self.watch.event(self.event);
        let elapsed = scale(self.span.at(theta), self.watch.job.plan.units.time);
        let origin = if own.asks_where() { self.unit.origin.at(elapsed) } else { Moved::NOWHERE };
        let Some(Some(working)) = self.watch.working.get(self.event) else { return (theta, Vec::new()) };
        let mut working = working.borrow_mut();
        working.take(0, (&self.watch.inside, places), &origin);
        (theta, working.ends[0].clone())
    }

    /// Whether the expression is nowhere zero between two places.
    fn is_clear_between(&self, from: &Place, to: &Place) -> bool {
        let job = self.watch.job;
        let times =
            [from.0, to.0].map(|theta| job.scene.t0 + scale(self.span.at(theta), job.plan.units.time));
        let h = self.length() * (to.0 - from.0);
        let Some(Some(working)) = self.watch.working.get(self.event) else { return true };
        let mut working = working.borrow_mut();
        let Some(shape) = &mut working.shape else { return true };
        shape.is_clear(Interval::between(times[0], times[1]), between(&from.1, &to.1, h))
    }
}
