//! Steps that each unit chooses: eight units in the lanes, each at its own pace.
//!
//! The one idea: when a unit ends, the next that waits takes its lane, so lanes seldom run dry. Packed,
//! there is one unit at a time, in all lanes.

mod events;
mod measure;
mod outputs;
mod stuck;

use super::super::layout::Layout;
use super::super::unit::{self, Prepared, Unit};
use super::events::Watch;
use super::report::{Counts, Ending, Report};
use super::{Job, Result};
use crate::error::Error;
use crate::forces::Dynamics;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::{Mask, Real};
use crate::ode::norm::Norm;
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Outcome};
use crate::ode::system::System;
use crate::ode::trial::{Cost, Trial, trial};
use crate::parallel::Ticker;
use core::iter::Enumerate;
use core::slice;

/// Units of progress of a unit: thousandths of its time.
pub(super) const PROGRESS_PER_UNIT: u64 = 1000;

/// Runs the units; one that is stopped reports how far it came.
///
/// # Errors
/// As [`run`](super::run).
pub(super) fn run(
    job: &Job<'_>,
    units: &[Unit],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Report>> {
    let mut run = Run::new(job, units, threads)?;
    loop {
        let fresh = match run.take_up(ticker) {
            Ok(fresh) => fresh,
            Err(Error::Interrupted) => return Ok(run.into_reports()),
            Err(other) => return Err(other),
        };
        let running = run.running();
        if !running.any() {
            return Ok(run.into_reports());
        }
        match run.advance(fresh, running, ticker) {
            Ok(()) => {}
            Err(Error::Interrupted) => return Ok(run.into_reports()),
            Err(other) => return Err(other),
        }
    }
}

/// A unit in its lane (in all lanes, if packed).
struct Slot<'a> {
    unit: Prepared,
    /// Its place among the units of the run.
    index: usize,
    next_output: usize,
    counts: Counts,
    /// How much of it was counted as progress.
    progress: u64,
    /// Its events, if it has any.
    watch: Option<Box<Watch<'a>>>,
}

/// Units on their way through the lanes.
struct Run<'a> {
    job: &'a Job<'a>,
    units: &'a [Unit],
    threads: usize,
    waiting: Enumerate<slice::Iter<'a, Unit>>,
    slots: [Option<Slot<'a>>; WIDTH],
    reports: Vec<Option<Report>>,
    /// Output times as elapsed time in the plan's units.
    outputs: Vec<f64>,
    /// The first unit stands in for one in idle lanes.
    first: Prepared,
    state: State<Lanes>,
    /// A state between two steps.
    between: State<Lanes>,
    /// The forces on the units that are in the lanes now.
    dynamics: Dynamics<Lanes>,
    norm: Norm<Lanes>,
    clock: Clock<Lanes>,
    trial: Box<dyn Trial<Lanes>>,
    cost: Cost,
}

impl<'a> Run<'a> {
    /// For units of one make-up.
    fn new(job: &'a Job<'a>, units: &'a [Unit], threads: usize) -> Result<Self> {
        let plan = job.plan;
        let elapsed = |&t: &f64| scale(t - job.scene.t0, -plan.units.time);
        let outputs: Vec<f64> = job.times.iter().map(elapsed).collect();
        let first = job.prepare(&units[0]);
        let mut state = first.blank_state(1);
        for lane in 0..plan.layout.units() {
            first.write(&mut state, lane);
        }
        let dynamics = unit::dynamics(plan, &[&first], threads);
        let max_step = Lanes::splat(scale(job.max_step, -plan.units.time));
        let trial = trial(plan.method, &dynamics, &state, max_step)?;
        Ok(Self {
            job,
            units,
            threads,
            waiting: units.iter().enumerate(),
            slots: [const { None }; WIDTH],
            reports: units.iter().map(|_| None).collect(),
            clock: Clock::new(Lanes::splat(outputs[outputs.len() - 1])),
            cost: trial.cost(),
            trial,
            norm: Norm::new(
                dynamics.shape,
                dynamics.form(),
                Lanes::splat(job.rtol),
                plan.layout == Layout::Packed,
            ),
            dynamics,
            between: state.clone(),
            outputs,
            first,
            state,
        })
    }

    /// The end as elapsed time in the plan's units.
    fn end(&self) -> f64 {
        self.outputs[self.outputs.len() - 1]
    }

    /// The lanes with a unit in them.
    fn running(&self) -> Bits {
        let lanes = self.slots.iter().enumerate().filter(|(_, slot)| slot.is_some());
        lanes.fold(Bits(0), |mask, (lane, _)| mask.or(self.job.plan.layout.mask(lane)))
    }

    /// Gives the free lanes to units that wait; which lanes were given.
    ///
    /// # Errors
    /// When the caller asks to stop.
    fn take_up(&mut self, ticker: &mut Ticker<'_>) -> Result<Bits> {
        let mut fresh = Bits(0);
        let watched = self.job.watched();
        for lane in 0..self.job.plan.layout.units() {
            while self.slots[lane].is_none() {
                let Some((index, unit)) = self.waiting.next() else { break };
                let unit = self.job.prepare(unit);
                let mask = self.job.plan.layout.mask(lane);
                unit.write(&mut self.state, lane);
                measure::set(&mut self.norm, self.job, &unit, mask);
                let mut slot = Slot {
                    unit,
                    index,
                    next_output: 0,
                    counts: Counts { evaluations: self.cost.start, ..Counts::default() },
                    progress: 0,
                    watch: None,
                };
                if watched {
                    slot.watch = Watch::begin(self.job, &slot.unit, (&self.state, lane), ticker)?;
                }
                self.record_start(&mut slot, lane, ticker)?;
                if slot.next_output < self.outputs.len() {
                    self.slots[lane] = Some(slot);
                    fresh = fresh.or(mask);
                } else {
                    self.finish(slot, lane, self.job.scene.t0, Ending::Finished);
                }
            }
        }
        Ok(fresh)
    }

    /// Starts the fresh lanes and takes a step in all that run.
    ///
    /// # Errors
    /// When the caller asks to stop; a step that was not whole is then not kept.
    fn advance(&mut self, fresh: Bits, running: Bits, ticker: &mut Ticker<'_>) -> Result<()> {
        if fresh.any() {
            self.start(fresh, ticker)?;
        }
        let before = self.clock;
        let outcome = match self.step(running, ticker) {
            Ok(outcome) => outcome,
            Err(error) => {
                // The state has not moved yet; the clock may have.
                self.clock = before;
                return Err(error);
            }
        };
        self.trial.keep(outcome.accepted, &mut self.state);
        for lane in 0..self.job.plan.layout.units() {
            self.settle(lane, &outcome, ticker);
        }
        ticker.tick()
    }

    /// Tries a step and records the outputs on it, up to where the state moves.
    fn step(&mut self, running: Bits, ticker: &mut Ticker<'_>) -> Result<Outcome<Lanes>> {
        let Self { trial, state, clock, dynamics, norm, .. } = self;
        let outcome = trial.attempt(running, dynamics, state, clock, norm, ticker)?;
        let dense = self.record(&outcome, ticker)?;
        if self.job.watched() {
            self.watch(&outcome, dense, ticker)?;
        }
        Ok(outcome)
    }

    fn start(&mut self, fresh: Bits, ticker: &mut Ticker<'_>) -> Result<()> {
        // Masses differ from unit to unit, so the forces are set up again with the new lanes.
        let slots = self.slots[..self.job.plan.layout.units()].iter();
        let units: Vec<&Prepared> =
            slots.map(|slot| slot.as_ref().map_or(&self.first, |slot| &slot.unit)).collect();
        self.dynamics = unit::dynamics(self.job.plan, &units, self.threads);
        self.clock.restart(fresh, Lanes::splat(self.end()));
        let Self { trial, state, clock, dynamics, norm, .. } = self;
        trial.start(fresh, dynamics, state, clock, norm, ticker)
    }

    /// Counts what the step was to the unit in a lane, and lets the unit go if it has ended.
    fn settle(&mut self, lane: usize, outcome: &Outcome<Lanes>, ticker: &mut Ticker<'_>) {
        let end = self.end();
        let Some(slot) = self.slots[lane].as_mut() else { return };
        let elapsed = self.clock.elapsed.0[lane];
        // What the step costs this unit, whatever the other lanes do: the derivative at its end is only
        // taken when it is kept.
        slot.counts.evaluations += self.cost.tried;
        if outcome.accepted.lane(lane) {
            slot.counts.steps += 1;
            slot.counts.evaluations += self.cost.kept;
            let done = (elapsed / end * PROGRESS_PER_UNIT as f64) as u64;
            ticker.advance(done - slot.progress);
            slot.progress = done;
        } else {
            slot.counts.rejected += 1;
        }
        let stopped = slot.watch.as_ref().is_some_and(|watch| watch.stopped);
        let ending = if outcome.finished.lane(lane) {
            Ending::Finished
        } else if outcome.stuck.lane(lane) {
            stuck::why(self.job, &slot.unit, &self.state, lane, elapsed)
        } else if slot.counts.steps + slot.counts.rejected >= self.job.max_steps {
            Ending::TooManySteps
        } else if stopped {
            // The events know better where.
            Ending::Stopped
        } else {
            return;
        };
        let time = if ending == Ending::Finished { self.job.end() } else { self.time(lane) };
        if let Some(slot) = self.slots[lane].take() {
            self.finish(slot, lane, time, ending);
        }
    }

    /// The time of the unit in a lane.
    fn time(&self, lane: usize) -> f64 {
        self.job.scene.t0 + scale(self.clock.elapsed.0[lane], self.job.plan.units.time)
    }

    fn finish(&mut self, slot: Slot<'a>, lane: usize, time: f64, ending: Ending) {
        let (rows, counts) = (slot.next_output, slot.counts);
        let mut report = self.job.report(&slot.unit, &self.state, lane, time, ending, rows, counts);
        if let Some(watch) = slot.watch {
            watch.tell(&mut report);
        }
        self.reports[slot.index] = Some(report);
    }

    /// The reports; a unit that has not ended was interrupted, on its way or before it began.
    fn into_reports(mut self) -> Vec<Report> {
        for lane in 0..WIDTH {
            if let Some(slot) = self.slots[lane].take() {
                self.finish(slot, lane, self.time(lane), Ending::Interrupted);
            }
        }
        let not_begun = |unit| {
            let prepared = self.job.prepare(unit);
            let mut state = prepared.blank_state(1);
            prepared.write(&mut state, 0);
            let t0 = self.job.scene.t0;
            self.job.report(&prepared, &state, 0, t0, Ending::Interrupted, 0, Counts::default())
        };
        let reports = self.units.iter().zip(self.reports);
        reports.map(|(unit, report)| report.unwrap_or_else(|| not_begun(unit))).collect()
    }
}
