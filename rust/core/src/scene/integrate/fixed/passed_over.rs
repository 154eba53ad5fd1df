//! Equal steps that went over something narrower than they are: the unit ends where such a step began.
//!
//! The one idea: steps that are chosen are taken again, shorter ones; of those that were asked for nothing is left but to tell.

use super::place;
use crate::error::Result;
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::real::Real;
use crate::ode::state::State;
use crate::ode::system::{System, Taken};
use crate::scene::integrate::Job;
use crate::scene::integrate::report::{Counts, Ending, Report};
use crate::scene::unit::Prepared;

/// So many steps go unasked where nothing would be unseen in one …
const UNASKED: u64 = 7;
/// … so many times as long: rates may grow fourfold meanwhile.
const CALM: f64 = 32.0;

/// The units of a group that have ended so.
#[derive(Default)]
pub(super) struct PassedOver {
    /// Of each unit; nothing, where the forces have nothing narrow.
    reports: Vec<Option<Report>>,
    /// Where a step looks.
    looks: Vec<f64>,
    /// The node up to which nothing is looked for.
    pub(super) calm_until: u64,
}

impl PassedOver {
    /// Of so many units of a run.
    pub(super) fn new(job: &Job<'_>, units: usize) -> Self {
        if job.plan.passes_over() {
            Self { reports: vec![None; units], looks: job.plan.method.looks(), calm_until: 0 }
        } else {
            Self::default()
        }
    }

    /// Whether each step is to be looked into.
    pub(super) fn looks(&self) -> bool {
        !self.reports.is_empty()
    }

    /// The lanes that a step from the first to the second state, at `from` and for `h`, to a node, has led over something unseen.
    ///
    /// # Errors
    /// As [`System::seen_until`].
    pub(super) fn lanes(
        &mut self,
        [before, after]: [&State<Lanes>; 2],
        ((from, h), node): ((f64, f64), u64),
        system: &mut dyn System<Lanes>,
    ) -> Result<Bits> {
        if !self.looks() {
            return Ok(Bits(0));
        }
        let (times, ends) = ((Lanes::splat(from), Lanes::splat(h)), [before.all().0, after.all().0]);
        let taken = Taken { nodes: &self.looks, ..Taken::from_end_to_end(Bits(0xff), times, ends) };
        let points = system.form().evaluated();
        let seen = if before.q().len() > points {
            taken.ask_first_of_halves(points, system)?
        } else {
            system.seen_until(&taken)?
        };
        if seen.is_none() && system.is_calm(&taken, CALM) {
            self.calm_until = node + UNASKED;
        }
        Ok(seen.map_or(Bits(0), |seen| seen.less(Lanes::one())))
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
