//! The doing of an integration: units into lanes, steps, records; a report for each unit.
//!
//! Here units are shared out over threads. `fixed` runs units in lockstep; `adaptive` runs eight
//! units each at its own pace. What a unit gives depends on nothing but the unit.

mod adaptive;
mod events;
mod fixed;
mod halved;
mod held;
pub mod neighbors;
mod report;
mod shadow;

pub use events::Found;
pub use halved::{Evidence, Unresolved};
pub use report::{Counts, Ending, Report};

use super::Scene;
use super::columns::Writer;
use super::continuation::Continuation;
use super::events::Known;
use super::plan::Plan;
use super::request::AbsoluteTolerances;
use super::unit::{Prepared, Unit};
use crate::error::Result;
use crate::numerics::lanes::WIDTH;
use crate::numerics::power_of_two::scale;
use crate::ode::Scheme;
use crate::parallel::{Ticker, for_chunks};

/// Units that one thread takes at a time: enough that lanes seldom run dry, few enough for balance.
const UNITS_PER_CHUNK: usize = 128;

/// Tolerances that continuous extensions are off at most within a step, and series. Of circles, the velocity along the radius
/// was seen to reach 2.6 of them by `tsitouras54` and `dormand_prince54`, and 0.001 by `taylor`.
const OF_EXTENSIONS: f64 = 2.0;
const OF_SERIES: f64 = 1.0 / 256.0;

/// What all units of a run share.
pub struct Job<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its plan.
    pub plan: &'a Plan,
    /// Output times.
    pub times: &'a [f64],
    /// Relative tolerance.
    pub rtol: f64,
    /// The one asked for, of which it is a part where events must not cost the digits of what is known.
    pub asked_rtol: f64,
    /// Absolute tolerances in the scene's units.
    pub atol: Option<&'a AbsoluteTolerances>,
    /// Longest step.
    pub max_step: f64,
    /// The longest first step of an adaptive method.
    pub first_step: f64,
    /// Most steps.
    pub max_steps: u64,
    /// Whether the events of the plan are looked for.
    pub watches: bool,
    /// What the units go on with, at the node of the plan, and which copies of its scene they belong to.
    pub from: Option<(&'a Continuation, Option<&'a [usize]>)>,
    /// Whether the units tell what they hold at the end.
    pub keeps: bool,
    /// Where the records go.
    pub writer: &'a Writer<'a>,
}

impl Job<'_> {
    /// The last output time.
    fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Whether anything is looked for on the way.
    fn watched(&self) -> bool {
        self.watches && !self.plan.events.is_empty()
    }

    /// How well a state within a step is known: to some tolerances, or to rounding where steps choose no error.
    fn known(&self) -> Known {
        let tolerances = match self.plan.method.scheme {
            Scheme::Embedded(_) => OF_EXTENSIONS,
            Scheme::Taylor(_) => OF_SERIES,
            _ => 0.0,
        };
        let largest =
            |each: Option<&[f64]>| each.into_iter().flatten().fold(0.0, |most: f64, &x| most.max(x));
        let absolute = self.atol.map_or([0.0; 2], |atol| atol.kinds().map(largest));
        Known { relative: tolerances * self.rtol, absolute: absolute.map(|atol| tolerances * atol) }
    }

    /// The time from the start of the scene to that of the run, in the plan's units.
    fn begun(&self) -> f64 {
        scale(self.plan.dt.unwrap_or(0.0), -self.plan.units.time) * self.plan.from as f64
    }

    /// A step of fixed length, in the plan's units.
    fn step(&self) -> f64 {
        scale(self.plan.dt.unwrap_or(self.plan.direction), -self.plan.units.time)
    }

    fn prepare(&self, unit: &Unit, ticker: &mut Ticker<'_>) -> Result<Prepared> {
        Prepared::new(self.plan, self.scene, unit.clone(), ticker)
    }

    /// Progress is counted in steps if they are fixed, else in parts of each unit's time.
    fn total_progress(&self, runs: &[&[Unit]]) -> u64 {
        let span = (self.end() - self.scene.t0).abs();
        let count = |together: usize| runs.iter().map(|run| run.len().div_ceil(together) as u64).sum::<u64>();
        match self.plan.dt {
            Some(dt) => {
                count(self.plan.in_lockstep()) * ((span / dt.abs()) as u64).saturating_sub(self.plan.from)
            }
            None => count(1) * adaptive::PROGRESS_PER_UNIT,
        }
    }
}

/// Runs all units of a plan; the reports come in no particular order.
///
/// # Errors
/// Only errors of the library itself: how a unit ended is in its report.
pub fn run(job: &Job<'_>, ticker: &mut Ticker<'_>) -> Result<Vec<Report>> {
    run_units(job, job.plan.unit_list(), ticker)
}

/// As [`run`], some of the units only.
///
/// # Errors
/// As [`run`].
pub fn run_units(job: &Job<'_>, units: Vec<Unit>, ticker: &mut Ticker<'_>) -> Result<Vec<Report>> {
    // Bodies that are looked at together record nothing, and nobody follows them.
    let (mut guided, mut apart): (Vec<Unit>, Vec<Unit>) =
        units.into_iter().partition(|unit| job.plan.guided && !unit.recorded.is_empty());
    let (over, inside) = job.plan.threads;
    ticker.control().add_total(guided.len() as u64 * adaptive::PROGRESS_PER_UNIT);
    let guided = Guided::new(job, &mut guided);
    let runs = alike(job, &mut apart);
    ticker.control().add_total(job.total_progress(&runs));
    let first = guided.chunks();
    let reports = for_chunks(over, first + runs.len(), ticker, |chunk, ticker| {
        match (chunk.checked_sub(first), &job.plan.method.scheme) {
            (None, _) => {
                let (guides, followers) = guided.chunk(chunk);
                adaptive::run(job, guides, followers, inside, ticker)
            }
            (Some(chunk), Scheme::Embedded(_) | Scheme::Taylor(_)) => {
                adaptive::run(job, runs[chunk], &[], inside, ticker)
            }
            (Some(chunk), _) if job.plan.transformed.is_some() => {
                adaptive::run(job, runs[chunk], &[], inside, ticker)
            }
            (Some(chunk), _) => fixed::run(job, runs[chunk], inside, ticker),
        }
    })?;
    let mut reports: Vec<Report> = reports.into_iter().flatten().collect();
    if job.plan.guided {
        // The first that did not finish tells how a copy ended: the same on any number of threads.
        reports.sort_by_key(|report| {
            (report.unit.copy, report.unit.make_up, report.unit.bodies.first().copied())
        });
    }
    Ok(reports)
}

/// Units that nobody follows, in runs of one make-up: massive bodies alone differ from those with massless ones beside
/// them, and only units that are alike share lanes.
fn alike<'u>(job: &Job<'_>, units: &'u mut [Unit]) -> Vec<&'u [Unit]> {
    units.sort_by_key(|unit| unit.make_up);
    let (over, lanes) = (job.plan.threads.0, job.plan.layout.units());
    let per_chunk = units.len().div_ceil(lanes * over * 4).clamp(1, UNITS_PER_CHUNK / WIDTH) * lanes;
    // Full states, once there is more than one for every thread.
    let per_chunk =
        if per_chunk > lanes { per_chunk.next_multiple_of(job.plan.in_lockstep()) } else { per_chunk };
    units.chunk_by(|a, b| a.make_up == b.make_up).flat_map(|run| run.chunks(per_chunk)).collect()
}

/// Massive bodies and the massless ones that follow them. Whatever the pieces, massless bodies have the same bits: each
/// depends on the massive ones and itself.
struct Guided<'u> {
    guides: Vec<Unit>,
    followers: Vec<&'u [Unit]>,
    per_chunk: usize,
}

impl<'u> Guided<'u> {
    fn new(job: &Job<'_>, units: &'u mut [Unit]) -> Self {
        let over = job.plan.threads.0;
        units.sort_by_key(|unit| (unit.copy, unit.make_up));
        let (mut guides, mut followers): (Vec<Unit>, Vec<&[Unit]>) = (Vec::new(), Vec::new());
        for of_copy in units.chunk_by(|a, b| a.copy == b.copy) {
            let (first, active) = (&of_copy[0], job.plan.active.len());
            let massless = &of_copy[usize::from(!first.follows)..];
            let guide = if first.follows { job.plan.guide(first.copy, false) } else { first.clone() };
            let pieces = job.plan.pieces(massless.len(), over);
            // An event ends it for all pieces at the same step: what they cost is the same on any number of threads.
            let once_more = Unit { recorded: active..active, ..guide.clone() };
            guides.push(guide);
            // Whole lanes for all but the last piece.
            let mut pieces =
                massless.chunks(massless.len().div_ceil(pieces).next_multiple_of(WIDTH).max(WIDTH));
            followers.push(pieces.next().unwrap_or_default());
            for piece in pieces {
                guides.push(once_more.clone());
                followers.push(piece);
            }
        }
        let lanes = job.plan.layout.units();
        let per_chunk = guides.len().div_ceil(lanes * over * 4).clamp(1, UNITS_PER_CHUNK / WIDTH) * lanes;
        Self { guides, followers, per_chunk }
    }

    fn chunks(&self) -> usize {
        self.guides.len().div_ceil(self.per_chunk)
    }

    fn chunk(&self, chunk: usize) -> (&[Unit], &[&'u [Unit]]) {
        let own = chunk * self.per_chunk..((chunk + 1) * self.per_chunk).min(self.guides.len());
        (&self.guides[own.clone()], &self.followers[own])
    }
}
