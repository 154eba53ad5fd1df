//! Events on the steps of a unit: which steps may hold zeros, where they are, and what the state is there.
//!
//! The one idea: a step is looked into only where the cubic through the values and rates at its ends does not keep clear of
//! zero. Then the function is sampled along the step, and where it changes its sign, or comes near zero and turns, the zero
//! is located on the solution itself: the continuous extension of an adaptive method, a shadow step of one with fixed
//! steps. Both are read and leave no trace, so events change no bit of a run.

mod inside;
mod search;

use super::super::events::{Event, Moving, Surroundings, View};
use super::super::unit::Prepared;
use super::{Ending, Job, Report};
use crate::error::Result;
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::scale;
use crate::ode::state::State;
use crate::parallel::Ticker;
use search::Search;

/// How far the cubic must keep clear of zero, as a part of its range: that much the function may differ from it.
const CLEARANCE: f64 = 0.5;

/// A zero that was found.
#[derive(Clone, Debug)]
pub struct Found {
    /// Of which event.
    pub which: usize,
    /// When.
    pub t: f64,
    /// Positions and velocities of the bodies of the unit.
    pub states: Vec<[[f64; 3]; 2]>,
}

/// A step of a unit, in the plan's units, and what may be asked about its inside.
pub(super) trait Interpolant {
    /// The state at a fraction of the step.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn at(&mut self, theta: f64, ticker: &mut Ticker<'_>) -> Result<&State<Lanes>>;

    /// How one coordinate moves in a lane: the terms of [`polynomial`](crate::ode::trial::Trial::polynomial). None are
    /// added by who has no polynomial.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn polynomial(
        &mut self,
        coordinate: usize,
        lane: usize,
        into: &mut Vec<[f64; 2]>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()>;
}

/// From where to where a step leads, as elapsed time in the plan's units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) from: f64,
    pub(super) to: f64,
}

impl Span {
    fn at(self, theta: f64) -> f64 {
        if theta == 1.0 { self.to } else { self.from + theta * (self.to - self.from) }
    }
}

/// The events of one unit under watch.
pub(super) struct Watch<'a> {
    job: &'a Job<'a>,
    /// Their places among all events, and those of their bodies in `before`.
    events: Vec<(usize, Vec<usize>)>,
    /// The bodies that are looked at, by their places in the unit.
    slots: Vec<usize>,
    /// The same by their indices in the scene.
    bodies: Vec<usize>,
    massive: bool,
    /// Bodies and values at the last node, and room for the bodies at the next one and inside a step.
    before: Vec<Moving>,
    after: Vec<Moving>,
    inside: Vec<Moving>,
    /// The terms of each coordinate of each body on the step at hand.
    terms: Vec<[f64; 2]>,
    values: Vec<f64>,
    /// Zeros of each event so far.
    counts: Vec<u64>,
    found: Vec<Found>,
    /// Whether the last one found has ended the run.
    pub(super) stopped: bool,
}

impl<'a> Watch<'a> {
    /// Of a unit at its start, if it has events.
    ///
    /// # Errors
    /// Those of the functions.
    pub(super) fn begin(
        job: &'a Job<'a>,
        unit: &Prepared,
        (state, lane): (&State<Lanes>, usize),
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<Box<Self>>> {
        if unit.unit.events.is_empty() {
            return Ok(None);
        }
        let (plan, scene) = (job.plan, job.scene);
        let mut slots: Vec<usize> = Vec::new();
        let mut events = Vec::with_capacity(unit.unit.events.len());
        for &index in &*unit.unit.events {
            let looked_at = plan.events[index].bodies(&plan.groups, scene.particles, &plan.active);
            let places = looked_at.iter().filter_map(|body| {
                let slot = unit.unit.bodies.iter().position(|own| own == body)?;
                Some(slots.iter().position(|&known| known == slot).unwrap_or_else(|| {
                    slots.push(slot);
                    slots.len() - 1
                }))
            });
            events.push((index, places.collect()));
        }
        let mut watch = Self {
            job,
            bodies: slots.iter().map(|&slot| unit.unit.bodies[slot]).collect(),
            massive: unit.unit.bodies.len() < scene.particles,
            before: Vec::new(),
            after: Vec::new(),
            inside: Vec::new(),
            terms: Vec::new(),
            values: Vec::new(),
            counts: vec![0; events.len()],
            found: Vec::new(),
            stopped: false,
            slots,
            events,
        };
        watch.read(unit, state, lane);
        core::mem::swap(&mut watch.before, &mut watch.after);
        let view = watch.view(unit, &watch.before, job.begun());
        let mut values = Vec::with_capacity(watch.events.len());
        for event in 0..watch.events.len() {
            let value = watch.value(unit, event, &view, ticker)?;
            // What starts at zero has not come there.
            let (what, places) = watch.event(event);
            values.push(if value.abs() <= what.rounding(&view, places) { 0.0 } else { value });
        }
        watch.values = values;
        Ok(Some(Box::new(watch)))
    }

    fn event(&self, event: usize) -> (&'a Event, &[usize]) {
        let (index, places) = &self.events[event];
        (&self.job.plan.events[*index], places)
    }

    /// Reads the bodies that are looked at into `after`.
    fn read(&mut self, unit: &Prepared, state: &State<Lanes>, lane: usize) {
        let components = unit.shape.components;
        let rows = state.q().len() / components;
        let units = self.job.plan.units;
        let (length, speed) = (units.length, -units.velocity());
        self.after.clear();
        for &slot in &self.slots {
            let (row, lane) = unit.locate(slot, lane);
            let mut moving = Moving::default();
            for c in 0..components {
                let at = c * rows + row;
                moving.position[c] = scale(state.q()[at].0[lane], length);
                moving.position_rest[c] = scale(state.q_compensation()[at].0[lane], length);
                moving.velocity[c] = scale(state.v()[at].0[lane], speed);
                moving.velocity_rest[c] = scale(state.v_compensation()[at].0[lane], speed);
            }
            self.after.push(moving);
        }
    }

    fn view<'v>(&self, unit: &Prepared, bodies: &'v [Moving], elapsed: f64) -> View<'v> {
        let elapsed = scale(elapsed, self.job.plan.units.time);
        View { bodies, origin: unit.origin, elapsed }
    }

    fn value(&self, unit: &Prepared, event: usize, view: &View<'_>, ticker: &mut Ticker<'_>) -> Result<f64> {
        let around = Surroundings {
            scene: self.job.scene,
            copy: unit.unit.copy,
            bodies: &self.bodies,
            massive: self.massive,
        };
        let (event, places) = self.event(event);
        event.value(view, places, &around, ticker)
    }

    /// Looks into a step that leads to the state in a lane.
    ///
    /// # Errors
    /// Those of the functions and of the evaluations that the inside of the step takes.
    pub(super) fn look(
        &mut self,
        unit: &Prepared,
        span: Span,
        (after, lane): (&State<Lanes>, usize),
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.read(unit, after, lane);
        let mut zeros: Vec<(f64, usize)> = Vec::new();
        let mut asked = false;
        for event in 0..self.events.len() {
            let views = [self.view(unit, &self.before, span.from), self.view(unit, &self.after, span.to)];
            let value = self.value(unit, event, &views[1], ticker)?;
            let ends = [self.values[event], value];
            let clear = self.keeps_clear(event, &views, ends);
            self.values[event] = value;
            if clear {
                continue;
            }
            if !asked {
                self.ask(unit, after, lane, step, ticker)?;
                asked = true;
            }
            let mut search = Search { watch: self, unit, event, span, lane, ends };
            zeros.extend(search.zeros(step, ticker)?.into_iter().map(|theta| (theta, event)));
        }
        zeros.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (theta, event) in zeros {
            let t = self.job.scene.t0 + scale(span.at(theta), self.job.plan.units.time);
            let state = if theta == 1.0 { after } else { step.at(theta, ticker)? };
            let elapsed = t - self.job.scene.t0;
            let states = (0..unit.unit.bodies.len()).map(|slot| {
                let entry = unit.read(slot, state, lane, elapsed);
                [entry.position, entry.velocity]
            });
            self.found.push(Found { which: self.events[event].0, t, states: states.collect() });
            self.counts[event] += 1;
            if self.event(event).0.last.is_some_and(|last| self.counts[event] >= last) {
                self.stopped = true;
                break;
            }
        }
        core::mem::swap(&mut self.before, &mut self.after);
        Ok(())
    }

    /// Whether the cubic through the values and the rates at both ends keeps clear of zero: its coefficients in
    /// Bernstein's basis have one sign, and are no nearer to zero than the clearance.
    fn keeps_clear(&self, event: usize, [before, after]: &[View<'_>; 2], [start, end]: [f64; 2]) -> bool {
        let (event, places) = self.event(event);
        let h = after.elapsed - before.elapsed;
        let Some(rates) = event.rates([before, after], h, places) else { return false };
        let hull = [start, start + h * rates[0] / 3.0, end - h * rates[1] / 3.0, end];
        let least = hull.into_iter().fold(f64::INFINITY, f64::min);
        let most = hull.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let clearance = CLEARANCE * (most - least);
        least > clearance || most < -clearance
    }

    /// What was found, and the ending of a unit that an event has stopped, in the report.
    pub(super) fn tell(self, report: &mut Report) {
        if let (true, Some(last)) = (self.stopped, self.found.last()) {
            report.ending = Ending::Stopped;
            report.time = last.t;
            report.states = last.states[report.unit.recorded.clone()].to_vec();
            let direction = self.job.plan.direction;
            let passed = self.job.times.partition_point(|t| (t - last.t) * direction <= 0.0);
            report.rows = report.rows.min(passed);
        }
        report.found = self.found;
    }
}
