//! Steps that each unit chooses: eight units in the lanes, each at its own pace.
//!
//! The one idea: when a unit ends, the next that waits takes its lane, so lanes seldom run dry. Packed,
//! there is one unit at a time, in all lanes. Massless bodies go through each step of the massive ones in the same way,
//! before those are moved on ([`followers`]).

mod ending;
mod events;
mod followers;
mod guide;
pub(super) mod measure;
mod outputs;
mod part;
mod sticking;
mod stuck;

use super::super::layout::Layout;
use super::super::unit::{self, Prepared, Unit};
use super::events::{Abreast, Watch};
use super::report::{Counts, Ending, Report};
use super::{Job, Result};
use crate::error::Error;
use crate::forces::Dynamics;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::{Mask, Real};
use crate::ode::norm::Norm;
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Settled};
use crate::ode::system::System;
use crate::ode::transformed::Transformed;
use crate::ode::trial::{Cost, Trial, trial};
use crate::ode::{Embedded, Scheme};
use crate::parallel::Ticker;
use crate::rigid::motion::series::InLanes;
use crate::rigid::motion::system::BodySystem;
use core::iter::Enumerate;
use core::slice;
use followers::{Followers, Span};
use guide::{Guided, Path};
use part::Part;
use std::sync::Arc;

/// Units of progress of a unit: thousandths of its time.
pub(super) const PROGRESS_PER_UNIT: u64 = 1000;

/// Runs the units; one that is stopped reports how far it came.
///
/// # Errors
/// As [`run`](super::run).
pub(super) fn run(
    job: &Job<'_>,
    units: &[Unit],
    followers: &[&[Unit]],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Report>> {
    let elapsed = |&t: &f64| scale(job.scene.elapsed(t), -job.plan.units.time);
    let outputs: Arc<[f64]> = job.times.iter().map(elapsed).collect();
    let first = job.prepare(&units[0], ticker)?;
    let own = Forces::own(job, &[&first], threads)?;
    let mut run = Run::new(job, first, own, &outputs)?;
    run.waiting = units.iter().enumerate();
    run.threads = threads;
    let guided = Followers::new(job, followers, &outputs);
    run.followers = guided.any().then_some(guided);
    loop {
        let fresh = match run.take_up(ticker) {
            Ok(fresh) => fresh,
            Err(Error::Interrupted) => return Ok(run.into_all_reports(units, followers)),
            Err(other) => return Err(other),
        };
        let running = run.running();
        if !running.any() {
            return Ok(run.into_all_reports(units, followers));
        }
        match run.advance(fresh, running, ticker) {
            Ok(()) => {}
            Err(Error::Interrupted) => return Ok(run.into_all_reports(units, followers)),
            Err(other) => return Err(other),
        }
    }
}

/// The fractions of a step at which a method of stages evaluates forces, but for its start.
fn stages_of(scheme: &Scheme) -> Vec<Lanes> {
    let Scheme::Embedded(Embedded { tableau, .. }) = scheme else { return Vec::new() };
    let mut fractions: Vec<Lanes> = tableau.c.iter().skip(1).map(|&c| Lanes::from_double_double(c)).collect();
    fractions.dedup();
    fractions
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
    pace: sticking::Pace,
    /// Its events, if it has any.
    watch: Option<Box<Watch<'a>>>,
}

/// What moves the units in the lanes.
enum Forces {
    /// Forces among themselves and from outside.
    Own(Dynamics<Lanes>),
    /// Those, and what turns rigid bodies beside them.
    Turning(Box<BodySystem>),
    /// Forces from outside and from massive bodies that move along a path.
    Along(Guided),
}

impl Forces {
    /// Those of units in the lanes that follow nobody.
    ///
    /// # Errors
    /// Only errors of the library itself.
    fn own(job: &Job<'_>, units: &[&Prepared], threads: usize) -> Result<Self> {
        let dynamics = unit::dynamics(job.plan, units, threads);
        let Some(assembly) = unit::assembled(job.plan, job.scene, units) else {
            return Ok(Self::Own(dynamics));
        };
        let bodies = BodySystem::new(Box::new(dynamics), assembly, &units[0].blank_state(1))
            .looking(job.plan.has_narrow());
        if !matches!(job.plan.method.scheme, Scheme::Taylor(_)) {
            return Ok(Self::Turning(Box::new(bodies)));
        }
        let uniform = |unit: &&Prepared| {
            job.plan.forces_of(unit.unit.copy).iter().all(|force| force.as_uniform().is_some())
        };
        let of = InLanes { alone: units.len() == 1, alike: units.iter().all(uniform) };
        Ok(Self::Turning(Box::new(bodies.with_series(of)?)))
    }

    fn system(&mut self) -> &mut dyn System<Lanes> {
        match self {
            Self::Own(dynamics) => dynamics,
            Self::Turning(bodies) => &mut **bodies,
            Self::Along(guided) => guided,
        }
    }
}

/// Units on their way through the lanes.
struct Run<'a> {
    job: &'a Job<'a>,
    threads: usize,
    layout: Layout,
    waiting: Enumerate<slice::Iter<'a, Unit>>,
    slots: [Option<Slot<'a>>; WIDTH],
    /// The reports of the units that have ended, and their places among the units of the run.
    reports: Vec<(usize, Report)>,
    /// Output times as elapsed time in the plan's units.
    outputs: Arc<[f64]>,
    /// The first unit stands in for one in idle lanes.
    first: Prepared,
    state: State<Lanes>,
    /// A state between two steps.
    between: State<Lanes>,
    /// The forces on the units that are in the lanes now.
    forces: Forces,
    norm: Norm<Lanes>,
    clock: Clock<Lanes>,
    trial: Box<dyn Trial<Lanes>>,
    /// At what fractions of a step a method of stages evaluates forces, from the second stage on.
    fractions: Vec<Lanes>,
    cost: Cost,
    /// The events of the units in the lanes, if they are looked for side by side.
    abreast: Option<Abreast<'a>>,
    /// The end of a step that events are looked for in, and its inside.
    after: State<Lanes>,
    polynomials: events::Polynomials,
    /// Those that follow the units in the lanes.
    followers: Option<Followers<'a>>,
    /// What of the time of each lane the clock counts: all of it, or a step of those that it follows.
    part: Part,
}

impl<'a> Run<'a> {
    /// For units of one make-up, like the first.
    fn new(job: &'a Job<'a>, first: Prepared, mut forces: Forces, outputs: &Arc<[f64]>) -> Result<Self> {
        let plan = job.plan;
        let layout = plan.layout_of(&first.unit);
        let mut state = first.blank_state(1);
        if matches!(forces, Forces::Turning(_)) {
            state = state.into_first_order();
        }
        for lane in 0..layout.units() {
            first.write(&mut state, lane);
        }
        let system = forces.system();
        let max_step = Lanes::splat(scale(job.max_step, -plan.units.time));
        let end = Lanes::splat(outputs[outputs.len() - 1]);
        let together = layout == Layout::Packed;
        let trial: Box<dyn Trial<Lanes>> = match (&plan.method.scheme, plan.transformed) {
            (Scheme::Splitting(table), Some((by, dt))) => {
                let dt = Lanes::splat(scale(dt, -plan.units.time));
                Box::new(Transformed::new(table, by, dt, system, &state, together))
            }
            _ => trial(plan.method, system, &state, max_step)?,
        };
        Ok(Self {
            job,
            threads: 1,
            layout,
            waiting: [].iter().enumerate(),
            slots: [const { None }; WIDTH],
            reports: Vec::new(),
            clock: Clock::new(end),
            fractions: stages_of(&plan.method.scheme),
            cost: trial.cost(),
            trial,
            norm: measure::norm(first.state_shape(1), &mut forces, Lanes::splat(job.rtol), together),
            forces,
            between: state.clone(),
            after: state.clone(),
            polynomials: events::Polynomials::default(),
            outputs: Arc::clone(outputs),
            first,
            state,
            abreast: None,
            followers: None,
            part: Part {
                from: Lanes::zero(),
                to: end,
                length: end,
                last: Bits(0xff),
                arrived: Bits(0),
                fresh: Bits(0),
                reference: [Lanes::zero(); 4],
            },
        })
    }

    /// The end as elapsed time in the plan's units.
    fn end(&self) -> f64 {
        self.outputs[self.outputs.len() - 1]
    }

    /// The lanes with a unit in them.
    fn running(&self) -> Bits {
        let lanes = self.slots.iter().enumerate().filter(|(_, slot)| slot.is_some());
        lanes.fold(Bits(0), |mask, (lane, _)| mask.or(self.layout.mask(lane)))
    }

    /// Gives the free lanes to units that wait; which lanes were given.
    ///
    /// # Errors
    /// When the caller asks to stop.
    fn take_up(&mut self, ticker: &mut Ticker<'_>) -> Result<Bits> {
        for lane in 0..self.layout.units() {
            while self.slots[lane].is_none() {
                let Some((index, unit)) = self.waiting.next() else { break };
                let unit = self.job.prepare(unit, ticker)?;
                if let Some(followers) = &mut self.followers {
                    followers.take_up(lane, index, &unit, ticker)?;
                }
                self.put(lane, index, unit, ticker)?;
            }
        }
        // A unit that was prepared when somebody had asked to stop takes no step.
        ticker.tick()?;
        Ok(core::mem::replace(&mut self.part.fresh, Bits(0)))
    }

    /// Puts a unit into a free lane, to be started.
    ///
    /// # Errors
    /// When the caller asks to stop.
    fn put(&mut self, lane: usize, index: usize, unit: Prepared, ticker: &mut Ticker<'_>) -> Result<()> {
        let mask = self.layout.mask(lane);
        unit.write(&mut self.state, lane);
        measure::set(&mut self.norm, self.job, &unit, mask);
        if let (Forces::Turning(bodies), Scheme::Taylor(_)) = (&self.forces, &self.job.plan.method.scheme) {
            measure::leave_out_held(&mut self.norm, bodies);
        }
        for block in self.norm.blocks.iter().filter(|block| !block.velocity) {
            for (start, &now) in self.part.reference.iter_mut().zip(&block.reference) {
                *start = Lanes::select(mask, now, *start);
            }
        }
        self.part.from = Lanes::select(mask, Lanes::zero(), self.part.from);
        self.clock.recount(mask, self.part.length);
        let counts = Counts { evaluations: self.cost.start, ..Counts::default() };
        let watched = self.job.watched();
        let watch = if watched { Watch::begin(self.job, &unit, (&self.state, lane), ticker)? } else { None };
        if let (Some(watch), Layout::Batched) = (&watch, self.layout) {
            self.abreast = self.abreast.take().or_else(|| Abreast::of(watch));
            self.abreast.iter_mut().for_each(|abreast| abreast.begin(lane, &unit, watch));
        }
        let mut slot =
            Slot { unit, index, next_output: 0, counts, progress: 0, pace: sticking::Pace::default(), watch };
        self.record_start(&mut slot, lane, ticker)?;
        if self.end() == 0.0 {
            if slot.unit.unit.reports() {
                ticker.advance(PROGRESS_PER_UNIT);
            }
            self.finish(slot, lane, self.job.scene.t0, Ending::Finished);
        } else {
            self.slots[lane] = Some(slot);
            self.part.fresh = self.part.fresh.or(mask);
        }
        Ok(())
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
        if outcome.finished.any() {
            // A step that was cut short by the end of a part tells little about the next.
            let cut = outcome.finished.and(outcome.h.abs().less(before.h.abs() * Lanes::splat(0.5)));
            let longer = cut.and(self.clock.h.abs().less(before.h.abs()));
            self.clock.h = Lanes::select(longer, before.h, self.clock.h);
        }
        self.trial.keep(outcome.accepted, &mut self.state);
        for lane in 0..self.layout.units() {
            if running.lane(lane) {
                self.settle(lane, &outcome, ticker);
            }
        }
        ticker.tick()
    }

    /// Tries a step and records the outputs on it, up to where the state moves.
    fn step(&mut self, running: Bits, ticker: &mut Ticker<'_>) -> Result<Settled<Lanes>> {
        let Self { trial, state, clock, forces, norm, .. } = self;
        let outcome = trial.attempt(running, forces.system(), state, clock, norm, ticker)?;
        let guiding = self.followers.is_some() && outcome.accepted.any();
        if guiding {
            self.trial.dense(&outcome, self.forces.system(), &self.state, ticker)?;
            self.charge(outcome.accepted, self.cost.dense);
        }
        let dense = self.record(&outcome, guiding, ticker)?;
        if self.job.watched() {
            self.watch(&outcome, dense, ticker)?;
        }
        if let Some(followers) = self.followers.as_mut().filter(|_| guiding) {
            let told = (self.layout == Layout::Packed, followers.moving);
            let (trial, state) = ((&*self.trial, &self.fractions[..]), &self.state);
            let lay = |path: &mut Path| path.lay(&self.first, trial, state, outcome.h, told);
            let span = Span {
                lanes: outcome.accepted,
                from: outcome.from,
                to: self.clock.elapsed,
                last: outcome.finished,
                path: followers.paths.next(lay),
            };
            followers.through(&span, ticker)?;
        }
        Ok(outcome)
    }

    fn start(&mut self, fresh: Bits, ticker: &mut Ticker<'_>) -> Result<()> {
        // Masses differ from unit to unit, so the forces are set up again with the new lanes.
        let slots = self.slots[..self.layout.units()].iter();
        let units: Vec<&Prepared> =
            slots.map(|slot| slot.as_ref().map_or(&self.first, |slot| &slot.unit)).collect();
        // Behind the last that moves there is nobody to be told of.
        let taken = self.slots.iter().rposition(Option::is_some).map_or(1, |last| last + 1);
        let index = self.slots[0].as_ref().map(|slot| slot.index);
        match &mut self.forces {
            // The first unit of all, in all lanes, has those with which the run was made.
            Forces::Own(_) if self.layout == Layout::Packed && index == Some(0) => {}
            Forces::Along(guided) => guided.take_up(self.job.plan, &units),
            own => *own = Forces::own(self.job, &units[..taken], self.threads)?,
        }
        self.clock.restart(fresh, self.part.length);
        let Self { trial, state, clock, forces, norm, .. } = self;
        if let Forces::Turning(bodies) = forces {
            measure::set_momenta(norm, bodies, (state, clock), fresh, ticker)?;
        }
        trial.start(fresh, forces.system(), state, clock, norm, ticker)?;
        let first = Lanes::splat(scale(self.job.first_step, -self.job.plan.units.time));
        let shorter = Lanes::select(clock.h.less(Lanes::zero()), -first, first);
        clock.h = Lanes::select(fresh.and(first.less(clock.h.abs())), shorter, clock.h);
        Ok(())
    }
}
