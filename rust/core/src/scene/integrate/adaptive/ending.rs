//! How units leave the lanes: at the end, stuck, stopped by an event or by the caller, each with its report.

use super::followers::Followers;
use super::{Forces, PROGRESS_PER_UNIT, Run, Slot, stuck};
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Mask;
use crate::ode::step_control::Settled;
use crate::parallel::Ticker;
use crate::scene::integrate::report::{Ending, Report};
use crate::scene::unit::Unit;
use std::collections::BTreeSet;

/// A run takes no more steps that nobody named than so many: who asks for more of them names the method. …
const MOST_STEPS: f64 = 1e9;
/// … So many, half a second, tell how many it would be; fewer are one passage that is soon over.
const MANY_STEPS: u64 = 1 << 17;

impl<'a> Run<'a> {
    /// Counts what the step was to the unit in a lane, and lets the unit go if it has ended.
    pub(super) fn settle(&mut self, lane: usize, outcome: &Settled<Lanes>, ticker: &mut Ticker<'_>) {
        let (end, elapsed) = (self.end(), self.elapsed(lane));
        let sticks = self.sticks(lane, ticker);
        let undefined = if outcome.stuck.lane(lane) { self.undefined(lane, ticker) } else { None };
        let Some(slot) = self.slots[lane].as_mut() else { return };
        // What the step costs this unit, whatever the other lanes do: the derivative at its end is only
        // taken when it is kept.
        slot.counts.evaluations += self.cost.tried;
        // Who reads states by steps has read the end, too.
        slot.counts.evaluations += if outcome.finished.lane(lane) { self.cost.read } else { 0 };
        if outcome.accepted.lane(lane) {
            slot.counts.steps += 1;
            slot.counts.evaluations += self.cost.kept;
            let done = (elapsed / end * PROGRESS_PER_UNIT as f64) as u64;
            if slot.unit.unit.reports() {
                ticker.advance(done.saturating_sub(slot.progress));
            }
            slot.progress = done.max(slot.progress);
        } else {
            slot.counts.rejected += 1;
        }
        let tried = slot.counts.steps + slot.counts.rejected;
        let endless = self.job.plan.held_to.is_some()
            && self.job.max_step == f64::MAX
            && tried >= MANY_STEPS
            && tried as f64 * end.abs() > MOST_STEPS * elapsed.abs();
        let stopped = slot.watch.as_ref().is_some_and(|watch| watch.stopped);
        let ending = if outcome.finished.lane(lane) && self.part.last.lane(lane) {
            Ending::Finished
        } else if outcome.finished.lane(lane) {
            self.part.arrived = self.part.arrived.or(self.layout.mask(lane));
            return;
        } else if self.trial.passed_over().lane(lane) {
            Ending::PassedOver
        } else if let Some(body) = undefined {
            Ending::Undefined { body }
        } else if outcome.stuck.lane(lane) {
            let massive = match &mut self.forces {
                Forces::Along(guided) => guided.places(self.clock.elapsed.0[lane], lane),
                Forces::Own(_) | Forces::Turning(_) => Vec::new(),
            };
            stuck::why(self.job, &slot.unit, &self.state, (lane, elapsed), &massive)
        } else if tried >= self.job.max_steps {
            Ending::TooManySteps
        } else if endless {
            Ending::Endless
        } else if stopped {
            // The events know better where.
            Ending::Stopped
        } else if let Some(body) = sticks {
            Ending::Sticking { body }
        } else {
            return;
        };
        let time = if ending == Ending::Finished { self.job.end() } else { self.time(lane) };
        if let Some(slot) = self.slots[lane].take() {
            self.finish(slot, lane, time, ending);
        }
    }

    /// The time of the unit in a lane.
    pub(super) fn time(&self, lane: usize) -> f64 {
        self.job.scene.t0 + scale(self.elapsed(lane), self.job.plan.units.time)
    }

    /// A unit has ended; those that follow it cannot go further.
    pub(super) fn finish(&mut self, slot: Slot<'a>, lane: usize, time: f64, ending: Ending) {
        let (rows, counts) = (slot.next_output, slot.counts);
        if let Some(followers) = &mut self.followers {
            followers.end(lane, &ending);
        }
        if !slot.unit.unit.reports() {
            return;
        }
        let mut report = self.job.report(&slot.unit, &self.state, lane, time, ending, rows, counts);
        if let Some(watch) = slot.watch {
            watch.tell(&mut report);
        }
        self.reports.push((slot.index, report));
    }

    /// The units in these lanes end, if they have not.
    pub(super) fn end_with(&mut self, lanes: Bits, ending: &Ending) {
        for lane in (0..WIDTH).filter(|&lane| lanes.lane(lane)) {
            if let Some(slot) = self.slots[lane].take() {
                self.finish(slot, lane, self.time(lane), ending.clone());
            }
        }
        self.part.fresh = self.part.fresh.and(lanes.not());
    }

    /// The reports; a unit that is on its way was interrupted.
    pub(super) fn into_reports(mut self) -> Vec<(usize, Report)> {
        self.end_with(Bits(0xff), &Ending::Interrupted);
        self.reports
    }

    /// The reports of all these units and of those that follow them, also of the ones that were interrupted before they
    /// began.
    pub(super) fn into_all_reports(mut self, units: &[Unit], followers: &[&[Unit]]) -> Vec<Report> {
        let job = self.job;
        self.end_with(Bits(0xff), &Ending::Interrupted);
        let following = self.followers.take().into_iter().flat_map(Followers::reports);
        self.reports.sort_by_key(|(index, _)| *index);
        let mut reports: Vec<Report> =
            self.reports.into_iter().chain(following).map(|(_, report)| report).collect();
        let reporting = units.iter().filter(|unit| unit.reports());
        let all = reporting.chain(followers.iter().copied().flatten());
        if reports.len() < all.clone().count() {
            let first = |unit: &Unit| unit.bodies.get(unit.recorded.start).copied();
            let name = |unit: &Unit| (unit.copy, unit.make_up, first(unit));
            let begun: BTreeSet<_> = reports.iter().map(|report| name(&report.unit)).collect();
            reports.extend(all.filter(|unit| !begun.contains(&name(unit))).map(|unit| job.not_begun(unit)));
        }
        reports
    }
}
