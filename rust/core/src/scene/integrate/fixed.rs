//! Fixed steps: up to sixteen units in lockstep, each recorded until it is no longer finite.

mod passed_over;

use super::super::layout::Layout;
use super::super::plan::Plan;
use super::super::unit::{self, Prepared, Unit};
use super::events::{Abreast, Along, Span, Watch};
use super::report::{Counts, Ending, Report};
use super::shadow::Shadow;
use super::{Job, Result, halved, held};
use crate::error::Error;
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::{Mask, Real};
use crate::ode::fixed::{self, Ended, Place, Recorder, Taken};
use crate::ode::state::State;
use crate::ode::stepper::{Stepper, stepper};
use crate::ode::system::System;
use crate::parallel::Ticker;
use crate::rigid::motion::body_stepper;
use passed_over::PassedOver;

/// Runs the units, a state full of them at a time.
///
/// # Errors
/// As [`run`](super::run).
pub(super) fn run(
    job: &Job<'_>,
    units: &[Unit],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Report>> {
    let mut reports = Vec::with_capacity(units.len());
    let mut room = None;
    for group in units.chunks(job.plan.in_lockstep()) {
        // Nothing is prepared for what stops before it begins: of millions of units it takes seconds.
        if ticker.tick().is_err() && job.begins_plainly() {
            reports.extend(group.iter().map(|unit| job.not_begun(unit)));
            continue;
        }
        reports.extend(lockstep(job, group, threads, &mut room, ticker)?);
    }
    Ok(reports)
}

/// How a state lies, the state and what advances it, for one group of units after another.
type Workspace = (Shape, State<Lanes>, Box<dyn Stepper<Lanes>>);

fn lockstep(
    job: &Job<'_>,
    units: &[Unit],
    threads: usize,
    room: &mut Option<Workspace>,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Report>> {
    let (plan, t0) = (job.plan, job.scene.t0);
    let prepared: Vec<Prepared> =
        units.iter().map(|unit| job.prepare(unit, ticker)).collect::<Result<_>>()?;
    prepared.iter().for_each(|unit| unit.may_wait(job.writer));
    let views: Vec<&Prepared> = prepared.iter().collect();
    let mut dynamics = unit::dynamics(plan, &views, threads);
    let dt = plan.dt.unwrap_or(plan.direction);
    let shape = dynamics.shape;
    // A special kernel holds the masses of its group.
    let rigid = unit::assembled(plan, job.scene, &views);
    let own = plan.relative || rigid.is_some();
    if own || room.as_ref().is_none_or(|(other, ..)| *other != shape) {
        let state = prepared[0].blank_state(units.len());
        let h = job.step();
        let stepper = match rigid {
            Some(assembly) => body_stepper(plan.method, (h, plan.tolerance), assembly, &state)?,
            None => stepper(plan.method, h, &dynamics, &state)?,
        };
        *room = Some((shape, state, stepper));
    }
    let Some((_, state, stepper)) = room else { return Ok(Vec::new()) };
    lay(plan, &prepared, state);
    match job.from {
        None => stepper.restart(),
        Some(from) => held::take_up(job, from, &prepared, state, &mut **stepper),
    }
    let places = job.times.iter().map(|&t| place(job, t));
    let mut watches = Vec::new();
    if job.watched() {
        for (lane, unit) in prepared.iter().enumerate() {
            match Watch::begin(job, unit, (state, lane), ticker) {
                Ok(watch) => watches.push(watch),
                Err(Error::Interrupted) => break,
                Err(other) => return Err(other),
            }
        }
    }
    let mut abreast: Vec<Option<Abreast<'_>>> = Vec::new();
    if plan.layout == Layout::Batched && watches.len() == units.len() {
        for (watches, units) in watches.chunks(WIDTH).zip(prepared.chunks(WIDTH)) {
            let mut eight = watches.iter().flatten().next().and_then(|watch| Abreast::of(watch));
            for (lane, (watch, unit)) in watches.iter().zip(units).enumerate() {
                if let (Some(eight), Some(watch)) = (&mut eight, watch) {
                    eight.begin(lane, unit, watch);
                }
            }
            abreast.push(eight);
        }
    }
    let passed_over = PassedOver::new(job, units.len());
    let along = match (plan.layout, &watches[..]) {
        (Layout::Packed, [Some(watch)]) if !passed_over.looks() => Along::of(watch, job.step()),
        _ => None,
    };
    let mut records = Records {
        job,
        along,
        node: plan.from,
        abreast,
        step: job.step(),
        between: None,
        watched: passed_over.looks() || watches.iter().any(Option::is_some),
        passed_over,
        looks: vec![0; units.len()],
        spent: vec![None; units.len()],
        asks: false,
        watches,
        failed: vec![None; units.len()],
        ended: vec![false; units.len()],
        running: units.len(),
        units: prepared,
        rows: 0,
        last: None,
    };
    let Ended { node, steps, stands, repeated, outcome } = fixed::run(
        &mut **stepper,
        plan.from,
        job.max_steps,
        state,
        &mut dynamics,
        places,
        ticker,
        &mut records,
    );
    for unit in &records.units {
        unit.catch_up(job.writer, ticker)?;
    }
    let short = match outcome {
        Ok(()) | Err(Error::Convergence { .. }) => Ending::TooManySteps,
        Err(Error::Interrupted) => Ending::Interrupted,
        Err(other) => return Err(other),
    };
    // What it takes is told, not what was done twice.
    let counts = Counts { steps, rejected: 0, evaluations: dynamics.evaluations() - repeated };
    let ended = place(job, job.end()).past.is_none() || records.last.is_none();
    let mut reports = records.reports(state, t0 + node as f64 * dt, &short, counts);
    if job.keeps && stands && ended && node > 0 {
        held::leave(plan.method, &records.units, &mut reports, node, state, &mut **stepper);
    }
    if stands && halved::pays(job, steps) {
        let reached = (&mut reports[..], &*state, node);
        halved::look(job, &records.units, reached, &mut **stepper, &mut dynamics, ticker)?;
    }
    Ok(reports)
}

/// Where a time lies among the nodes of a run, the time past a node in the plan's units.
fn place(job: &Job<'_>, t: f64) -> Place {
    let (plan, t0) = (job.plan, job.scene.t0);
    let dt = plan.dt.unwrap_or(plan.direction);
    let place = fixed::place(job.scene.elapsed(t), dt, Real::max(t.abs(), t0.abs()));
    Place { past: place.past.map(|past| scale(past, -plan.units.time)), ..place }
}

/// Lays units at their start into a state.
pub(super) fn lay(plan: &Plan, units: &[Prepared], state: &mut State<Lanes>) {
    state.clear();
    for lane in 0..units.len().next_multiple_of(plan.layout.units()) {
        // Lanes without a unit run along with a copy of the last.
        units[lane.min(units.len() - 1)].write(state, lane);
    }
}

/// What has been recorded of units in lockstep.
struct Records<'a> {
    job: &'a Job<'a>,
    /// The step in the plan's units.
    step: f64,
    /// Room for states between nodes.
    between: Option<State<Lanes>>,
    /// Whether any unit has events, or may pass over something.
    watched: bool,
    /// The units that have.
    passed_over: PassedOver,
    /// The events of the only unit, if they are looked for in several steps side by side.
    along: Option<Along<'a>>,
    /// The node at which their watch stands, then.
    node: u64,
    /// The events of eight units after another, if they are looked for side by side.
    abreast: Vec<Option<Abreast<'a>>>,
    /// The events of each unit.
    watches: Vec<Option<Box<Watch<'a>>>>,
    /// What looking for them took, which each unit pays for itself.
    looks: Vec<u64>,
    /// What a unit that ended before the others had cost by then.
    spent: Vec<Option<Counts>>,
    /// Whether one has ended whose cost is to be told.
    asks: bool,
    units: Vec<Prepared>,
    /// The output time at which a unit was no longer finite.
    failed: Vec<Option<usize>>,
    /// Whether it has ended with that: where events are looked for, with the step in which the output was, as without it.
    ended: Vec<bool>,
    /// How many are still finite.
    running: usize,
    /// Output times so far.
    rows: usize,
    /// The state at the last output time, which need not be a node.
    last: Option<State<Lanes>>,
}

impl Recorder<Lanes> for Records<'_> {
    /// [`Error::Convergence`] when no unit is finite any more; [`Error::Interrupted`].
    #[inline(always)]
    fn record(&mut self, index: usize, state: &State<Lanes>, ticker: &mut Ticker<'_>) -> Result<()> {
        let job = self.job;
        let t = job.times[index];
        let elapsed = job.scene.elapsed(t);
        for (lane, unit) in self.units.iter().enumerate() {
            if self.failed[lane].is_none()
                && !unit.record_soon(job.writer, index, state, lane, elapsed, ticker)?
            {
                self.failed[lane] = Some(index);
                // Whether others in its lanes have events is none of its business.
                if self.watches.get(lane).is_none_or(Option::is_none) {
                    self.ended[lane] = true;
                    self.running -= 1;
                    self.asks = true;
                }
            }
        }
        self.rows = index + 1;
        if self.rows == job.times.len() {
            self.last = Some(state.clone());
        }
        if self.running == 0 {
            return Err(Error::Convergence { message: "not finite".to_owned(), time: t });
        }
        Ok(())
    }

    fn watches(&self) -> Option<usize> {
        (self.watched && !self.job.times.is_empty()).then(|| self.job.times.len() - 1)
    }

    fn looks_ahead(&self) -> bool {
        self.along.is_some()
    }

    fn looks_again_at(&self) -> u64 {
        // Events are looked for in each step.
        if self.watches.iter().any(Option::is_some) {
            0
        } else {
            self.passed_over.calm_until(self.under_way())
        }
    }

    #[inline(always)]
    fn note(&mut self, place: usize, node: u64, state: &State<Lanes>) {
        if let (Some(along), [unit]) = (&mut self.along, &self.units[..]) {
            along.note(place, unit, node, state);
        }
    }

    fn suspects(&mut self, steps: usize) -> Bits {
        self.along.as_mut().map_or(Bits(0xff), |along| along.suspects(steps))
    }

    fn look(&mut self, taken: Taken<'_, Lanes>, ticker: &mut Ticker<'_>) -> Result<bool> {
        let Taken { node, before, after, part, stepper, system, repeated } = taken;
        let from = self.step * node as f64;
        let to = part.map_or_else(|| self.step * (node + 1) as f64, |part| from + part);
        let (span, steps) = (Span { from, to }, node + u64::from(part.is_none()));
        let running = self.under_way();
        let passed = self.passed_over.lanes([before, after], ((from, to - from), node), running, system)?;
        let between = self.between.get_or_insert_with(|| before.clone());
        let length = Lanes::splat(scale(span.to - span.from, self.job.plan.units.time));
        // Whose watches must look, and which of them are where the step begins.
        let mut blocks = [[Bits(0xff), Bits::splat(self.along.is_none() || self.node == node)]; 2];
        self.node = steps;
        for (block, abreast) in blocks.iter_mut().zip(&mut self.abreast) {
            if let Some(abreast) = abreast {
                *block = abreast.step(Bits(0xff), &length, after);
            }
        }
        let taken_so_far = steps - self.job.plan.from;
        let step = part.unwrap_or(self.step);
        let mut inside = Shadow { stepper, system, node, before, between, last: None, step };
        let mut going = false;
        for (lane, unit) in self.units.iter().enumerate() {
            let watch = self.watches.get_mut(lane).and_then(Option::as_mut);
            let stopped = watch.as_ref().is_some_and(|watch| watch.stopped);
            if self.ended[lane] || stopped {
                continue;
            }
            let begun = inside.system.evaluations();
            if passed.lane(lane % WIDTH) {
                let counts = Counts { steps: taken_so_far, rejected: 0, evaluations: begun - repeated };
                let counts = paid_by(lane, counts, &self.looks);
                self.passed_over.end(self.job, (unit, lane), (before, node), counts);
                (self.failed[lane], self.ended[lane]) = (Some(self.rows), true);
                self.running -= 1;
                continue;
            }
            let [looked_at, in_step] = blocks[lane / WIDTH % 2].map(|lanes| lanes.lane(lane % WIDTH));
            let mut over = self.failed[lane].is_some();
            if let (Some(watch), true) = (watch, looked_at) {
                // A unit pays for what it looks at, whatever was looked at for another one.
                inside.last = None;
                // Who has not seen every node turns to where the step begins.
                if !in_step {
                    watch.turn_to(unit, span.from, before, ticker)?;
                }
                if watch.step(unit, span, after, ticker)? {
                    watch.look(unit, span, (after, lane), &mut inside, ticker)?;
                }
                over |= watch.stopped;
            }
            let evaluations = inside.system.evaluations();
            self.looks[lane] += evaluations - begun;
            self.ended[lane] = self.failed[lane].is_some();
            self.running -= usize::from(self.ended[lane]);
            going |= !over;
            if over {
                let counts = Counts { steps: taken_so_far, rejected: 0, evaluations: evaluations - repeated };
                self.spent[lane] = Some(paid_by(lane, counts, &self.looks));
            }
        }
        Ok(going)
    }

    fn goes_on(&mut self, state: &State<Lanes>) -> bool {
        for (lane, unit) in self.units.iter().enumerate() {
            if !self.ended[lane] && (self.failed[lane].is_some() || !unit.is_finite(state, lane)) {
                self.failed[lane] = self.failed[lane].or(Some(self.rows));
                self.ended[lane] = true;
                self.running -= 1;
                self.asks = true;
            }
        }
        self.running > 0
    }

    fn asks(&self) -> bool {
        self.asks
    }

    fn spent(&mut self, steps: u64, evaluations: u64) {
        let counts = Counts { steps, rejected: 0, evaluations };
        for (lane, spent) in self.spent.iter_mut().enumerate() {
            if self.ended[lane] && spent.is_none() {
                *spent = Some(paid_by(lane, counts, &self.looks));
            }
        }
        self.asks = false;
    }
}

impl Records<'_> {
    /// The reports of a run that has come to `reached` at `time`; `short` says why, if that is not the end.
    fn reports(&mut self, reached: &State<Lanes>, time: f64, short: &Ending, all: Counts) -> Vec<Report> {
        let last = self.last.take();
        let (state, time, otherwise) = match &last {
            Some(last) => (last, self.job.end(), &Ending::Finished),
            None => (reached, time, short),
        };
        self.watches.resize_with(self.units.len(), || None);
        let watches = core::mem::take(&mut self.watches);
        let report = |((lane, unit), watch): ((usize, &Prepared), Option<Box<Watch<'_>>>)| {
            let ended = self.passed_over.take(lane);
            let (rows, ending) = match self.failed[lane] {
                Some(failed) => (failed, Ending::NotFinite),
                None => (self.rows, otherwise.clone()),
            };
            let counts = self.spent[lane];
            let counts = counts.unwrap_or_else(|| paid_by(lane, all, &self.looks));
            let mut report =
                ended.unwrap_or_else(|| self.job.report(unit, state, lane, time, ending, rows, counts));
            if let Some(watch) = watch {
                watch.tell(&mut report);
            }
            report
        };
        self.units.iter().enumerate().zip(watches).map(report).collect()
    }
}

/// What a unit cost of all that was done for those in lockstep, who looked for their events apart.
fn paid_by(lane: usize, all: Counts, looks: &[u64]) -> Counts {
    let others = looks.iter().sum::<u64>() - looks.get(lane).copied().unwrap_or_default();
    Counts { evaluations: all.evaluations - others, ..all }
}
