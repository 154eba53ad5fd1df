//! Equal steps that went over something narrower than they are: the unit ends where such a step began.
//!
//! The one idea: steps that are chosen are taken again, shorter ones; of those that were asked for nothing is left but to tell.

use super::{Records, place};
use crate::error::Result;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::looks::{EqualLooks, EqualStep};
use crate::ode::state::State;
use crate::ode::system::System;
use crate::scene::integrate::Job;
use crate::scene::integrate::report::{Counts, Ending, Report};
use crate::scene::layout::Layout;
use crate::scene::unit::Prepared;

/// Up to the next node of which this is a divisor steps go unasked where nothing would be unseen in one …
const UNASKED: u64 = 8;
/// … so many times as long: rates may grow fourfold meanwhile.
const CALM: f64 = 32.0;

/// The units of a group that have ended so.
#[derive(Default)]
pub(super) struct PassedOver {
    /// Of each unit; nothing, where the forces have nothing narrow.
    reports: Vec<Option<Report>>,
    /// Whether lanes are parts of one unit.
    is_one: bool,
    /// What asks of each step.
    looks: Option<EqualLooks<Lanes>>,
    /// The nodes at which the first step begins, and the last one, which may be a part of one.
    first: u64,
    last: u64,
    /// The nodes up to which nothing is looked for, lane by lane: a copy is asked where it is alone.
    calm_until: [u64; WIDTH],
}

impl PassedOver {
    /// Of so many units of a run.
    pub(super) fn new(job: &Job<'_>, units: usize) -> Self {
        if job.plan.passes_over() {
            Self {
                reports: vec![None; units],
                is_one: job.plan.layout == Layout::Packed,
                looks: Some(EqualLooks::of(job.plan.method)),
                first: job.plan.from,
                last: last_node(job),
                calm_until: [0; WIDTH],
            }
        } else {
            Self::default()
        }
    }

    /// Whether each step is to be looked into.
    pub(super) fn looks(&self) -> bool {
        self.looks.is_some()
    }

    /// The node up to which none of the lanes that run is asked.
    pub(super) fn calm_until(&self, running: Bits) -> u64 {
        let until = self.calm_until.iter().enumerate().filter(|(lane, _)| running.lane(*lane));
        until.map(|(_, &until)| until).min().unwrap_or_default()
    }

    /// The lanes among those that run that a step from the first to the second state, at `from` and for `h`, from a node, has led
    /// over something unseen.
    ///
    /// # Errors
    /// As [`System::seen_until`].
    pub(super) fn lanes(
        &mut self,
        [before, after]: [&State<Lanes>; 2],
        ((from, h), node): ((f64, f64), u64),
        running: Bits,
        system: &mut dyn System<Lanes>,
    ) -> Result<Bits> {
        let due = |asked: Bits, lane: usize| {
            if self.calm_until[lane] <= node { asked.or(Bits(1 << lane)) } else { asked }
        };
        let asked = running.and((0..WIDTH).fold(Bits(0), due));
        let Some(looks) = self.looks.as_mut().filter(|_| asked.any()) else { return Ok(Bits(0)) };
        let (times, ends) = ((Lanes::splat(from), Lanes::splat(h)), [before.all().0, after.all().0]);
        let step = EqualStep {
            asked,
            times,
            ends,
            is_outermost: [node == self.first, node >= self.last],
            is_one: self.is_one,
        };
        let points = system.form().evaluated();
        let has_bodies = before.q().len() > points;
        let seen = looks.ask(step, system, |taken, system| {
            if has_bodies { taken.ask_first_of_halves(points, system) } else { system.seen_until(taken) }
        })?;
        let over = asked.and(seen.map_or(Bits(0), |seen| seen.less(Lanes::one())));
        let calm = asked.and(over.not()).and(looks.are_calm(step, CALM, system));
        for lane in (0..WIDTH).filter(|&lane| calm.lane(lane)) {
            self.calm_until[lane] = ((node + 1) / UNASKED + 1) * UNASKED;
        }
        Ok(over)
    }

    /// Ends the unit in a lane of that state, at a node: what was recorded after it is of a part of the step.
    pub(super) fn end(
        &mut self,
        job: &Job<'_>,
        (unit, lane): (&Prepared, usize),
        (state, node): (&State<Lanes>, u64),
        counts: Counts,
    ) {
        let time = job.scene.t0 + node as f64 * job.plan.dt.unwrap_or(job.plan.direction);
        let rows = job.times.partition_point(|&t| {
            let place = place(job, t);
            place.node < node || (place.node == node && place.past.is_none())
        });
        let report = job.report(unit, state, lane, time, Ending::PassedOver, rows, counts);
        if let Some(place) = self.reports.get_mut(lane) {
            *place = Some(report);
        }
    }

    /// The report of a unit that has ended so.
    pub(super) fn take(&mut self, lane: usize) -> Option<Report> {
        self.reports.get_mut(lane).and_then(Option::take)
    }
}

/// The node at which the last step of a run begins.
fn last_node(job: &Job<'_>) -> u64 {
    let end = place(job, job.end());
    if end.past.is_some() { end.node } else { end.node.saturating_sub(1) }
}

impl Records<'_> {
    /// The lanes of units that have not ended.
    pub(super) fn under_way(&self) -> Bits {
        if self.job.plan.layout == Layout::Packed {
            return Bits::splat(!self.ended.first().copied().unwrap_or(true));
        }
        let goes_on = |lane: &usize| {
            let stopped = self.watches.get(*lane).and_then(Option::as_ref).is_some_and(|watch| watch.stopped);
            !self.ended[*lane] && self.failed[*lane].is_none() && !stopped
        };
        (0..self.units.len().min(WIDTH)).filter(goes_on).fold(Bits(0), |all, lane| all.or(Bits(1 << lane)))
    }
}
