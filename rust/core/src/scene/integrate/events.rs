//! Events on the steps of a unit: which steps may hold zeros, where they are, and what the state is there.
//!
//! The one idea: a step is looked into only where the cubic through the values and rates at its ends does not keep clear of
//! zero. Then the function is sampled along the step, and where it changes its sign, or comes near zero and turns, the zero
//! is located on the solution itself: the continuous extension of an adaptive method, a shadow step of one with fixed
//! steps. Both are read and leave no trace, so events change no bit of a run.

use super::super::events::{Event, Moving, Surroundings, View};
use super::super::unit::Prepared;
use super::{Ending, Job, Report};
use crate::error::Result;
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::scale;
use crate::ode::events::zero;
use crate::ode::state::State;
use crate::parallel::Ticker;

/// Where a step is sampled, as fractions of it: close to its ends to see which way the function leaves and comes.
pub(super) const SAMPLES: [f64; 9] = [0.015625, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 0.984375];

/// How far the cubic must keep clear of zero, as a part of its range: that much the function may differ from it.
const CLEARANCE: f64 = 0.5;

/// Parts of a bracket in which a minimum lies come down by the golden section to 1e-8 of it, where a parabola has come
/// down to round-off.
const SECTIONS: usize = 40;

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

    /// The state at one of the [`SAMPLES`]; `None` if that costs more than the cubic through both ends is worth.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn sample(&mut self, index: usize, ticker: &mut Ticker<'_>) -> Result<Option<&State<Lanes>>>;
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

/// A part of a step at whose ends a function has different signs.
type Bracket = [(f64, f64); 2];

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
    /// Bodies and values at the last node.
    before: Vec<Moving>,
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
            values: Vec::new(),
            counts: vec![0; events.len()],
            found: Vec::new(),
            stopped: false,
            slots,
            events,
        };
        watch.before = watch.read(unit, state, lane);
        for event in 0..watch.events.len() {
            let value = watch.value(unit, event, &watch.before, 0.0, ticker)?;
            // What starts at zero has not come there.
            let (what, places) = watch.event(event);
            let rounding = what.rounding(&watch.view(unit, &watch.before, 0.0), places);
            watch.values.push(if value.abs() <= rounding { 0.0 } else { value });
        }
        Ok(Some(Box::new(watch)))
    }

    fn event(&self, event: usize) -> (&'a Event, &[usize]) {
        let (index, places) = &self.events[event];
        (&self.job.plan.events[*index], places)
    }

    /// The bodies that are looked at.
    fn read(&self, unit: &Prepared, state: &State<Lanes>, lane: usize) -> Vec<Moving> {
        let components = unit.shape.components;
        let rows = state.q().len() / components;
        let units = self.job.plan.units;
        let read = |&slot: &usize| {
            let (row, lane) = unit.locate(slot, lane);
            let mut moving = Moving::default();
            for c in 0..components {
                let take = |values: &[Lanes], exponent| scale(values[c * rows + row].0[lane], exponent);
                moving.position[c] = take(state.q(), units.length);
                moving.position_rest[c] = take(state.q_compensation(), units.length);
                moving.velocity[c] = take(state.v(), -units.velocity());
                moving.velocity_rest[c] = take(state.v_compensation(), -units.velocity());
            }
            moving
        };
        self.slots.iter().map(read).collect()
    }

    fn view<'v>(&self, unit: &Prepared, bodies: &'v [Moving], elapsed: f64) -> View<'v> {
        let elapsed = scale(elapsed, self.job.plan.units.time);
        View { bodies, origin: unit.origin.at(elapsed), elapsed }
    }

    fn value(
        &self,
        unit: &Prepared,
        event: usize,
        bodies: &[Moving],
        elapsed: f64,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let around = Surroundings {
            scene: self.job.scene,
            copy: unit.unit.copy,
            bodies: &self.bodies,
            massive: self.massive,
        };
        let (event, places) = self.event(event);
        event.value(&self.view(unit, bodies, elapsed), places, &around, ticker)
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
        let bodies = self.read(unit, after, lane);
        let mut zeros: Vec<(f64, usize)> = Vec::new();
        for event in 0..self.events.len() {
            let value = self.value(unit, event, &bodies, span.to, ticker)?;
            let ends = [self.values[event], value];
            self.values[event] = value;
            if self.keeps_clear(unit, event, span, &bodies, ends) {
                continue;
            }
            let search = Search { watch: self, unit, event, span, lane, after: &bodies, ends };
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
        self.before = bodies;
        Ok(())
    }

    /// Whether the cubic through the values and the rates at both ends keeps clear of zero: its coefficients in
    /// Bernstein's basis have one sign, and are no nearer to zero than the clearance.
    fn keeps_clear(
        &self,
        unit: &Prepared,
        event: usize,
        span: Span,
        after: &[Moving],
        [start, end]: [f64; 2],
    ) -> bool {
        let (event, places) = self.event(event);
        let views = [self.view(unit, &self.before, span.from), self.view(unit, after, span.to)];
        let h = views[1].elapsed - views[0].elapsed;
        let Some(rates) = event.rates([&views[0], &views[1]], h, places) else { return false };
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

/// The search for the zeros of one event in one step.
struct Search<'s, 'a> {
    watch: &'s Watch<'a>,
    unit: &'s Prepared,
    event: usize,
    span: Span,
    lane: usize,
    after: &'s [Moving],
    ends: [f64; 2],
}

/// Whether a function leaves the sign that it has. A zero at the end counts, one at the start was told of before.
fn crosses(start: f64, end: f64) -> bool {
    (start < 0.0 && end >= 0.0) || (start > 0.0 && end <= 0.0)
}

impl Search<'_, '_> {
    /// The zeros, as fractions of the step.
    fn zeros(&self, step: &mut dyn Interpolant, ticker: &mut Ticker<'_>) -> Result<Vec<f64>> {
        let mut points = vec![(0.0, self.ends[0])];
        for (index, theta) in SAMPLES.into_iter().enumerate() {
            let value = match step.sample(index, ticker)? {
                Some(state) => self.value_of(state, theta, ticker)?,
                None => self.value_on_cubic(theta, ticker)?,
            };
            points.push((theta, value));
        }
        points.push((1.0, self.ends[1]));
        let mut brackets: Vec<Bracket> = Vec::new();
        for pair in points.windows(2) {
            if crosses(pair[0].1, pair[1].1) {
                brackets.push([pair[0], pair[1]]);
            }
        }
        for three in points.windows(3) {
            if let &[left, middle, right] = three
                && turns(left.1, middle.1, right.1)
            {
                brackets.extend(self.turn(left, middle, right, step, ticker)?);
            }
        }
        let direction = self.watch.event(self.event).0.direction * (self.span.to - self.span.from);
        let mut zeros = Vec::new();
        for bracket in brackets {
            let Some([a, b]) = self.settled(bracket, step, ticker)? else { continue };
            // Upwards along the run backwards is downwards in time.
            let up = if a.1 < 0.0 { 1.0 } else { -1.0 };
            if direction * up >= 0.0 {
                zeros.push(zero([a, b], |theta| self.value_at(theta, step, ticker))?);
            }
        }
        // Brackets that the solution does not confirm lead to one zero.
        zeros.sort_by(f64::total_cmp);
        zeros.dedup();
        Ok(zeros)
    }

    /// Where a function that comes near zero between two points of the same sign passes it: two brackets, or none.
    fn turn(
        &self,
        left: (f64, f64),
        middle: (f64, f64),
        right: (f64, f64),
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Bracket>> {
        let part = 0.381_966_011_250_105_15; // (3 - √5)/2
        let (mut left, mut best, mut right, sign) = (left, middle, right, middle.1.signum());
        for _ in 0..SECTIONS {
            let longer = if right.0 - best.0 > best.0 - left.0 { right.0 } else { left.0 };
            let theta = best.0 + part * (longer - best.0);
            let point = (theta, self.value_at(theta, step, ticker)?);
            if point.1 * sign <= 0.0 {
                return Ok(vec![[left, point], [point, right]]);
            }
            let (inner, outer) = if point.1 * sign < best.1 * sign { (point, best) } else { (best, point) };
            if outer.0 < inner.0 { left = outer } else { right = outer }
            best = inner;
        }
        Ok(Vec::new())
    }

    /// A bracket with the values of the solution itself, where those of the cubic have led there; none if it has no
    /// zero after all.
    fn settled(
        &self,
        bracket: Bracket,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<Bracket>> {
        let mut settled = bracket;
        for (theta, value) in &mut settled {
            *value = match *theta {
                0.0 => self.ends[0],
                1.0 => self.ends[1],
                theta => self.value_at(theta, step, ticker)?,
            };
        }
        if crosses(settled[0].1, settled[1].1) {
            return Ok(Some(settled));
        }
        let whole = [(0.0, self.ends[0]), (1.0, self.ends[1])];
        Ok(crosses(self.ends[0], self.ends[1]).then_some(whole))
    }

    fn value_at(&self, theta: f64, step: &mut dyn Interpolant, ticker: &mut Ticker<'_>) -> Result<f64> {
        let state = step.at(theta, ticker)?;
        self.value_of(state, theta, ticker)
    }

    fn value_of(&self, state: &State<Lanes>, theta: f64, ticker: &mut Ticker<'_>) -> Result<f64> {
        let bodies = self.watch.read(self.unit, state, self.lane);
        self.watch.value(self.unit, self.event, &bodies, self.span.at(theta), ticker)
    }

    /// On the cubics through positions and velocities at both ends.
    fn value_on_cubic(&self, theta: f64, ticker: &mut Ticker<'_>) -> Result<f64> {
        let h = scale(self.span.to - self.span.from, self.watch.job.plan.units.time);
        let bodies: Vec<Moving> = self
            .watch
            .before
            .iter()
            .zip(self.after)
            .map(|(before, after)| {
                let mut moving = Moving::default();
                let rest = 1.0 - theta;
                for c in 0..3 {
                    let way = after.position[c] - before.position[c];
                    let (start, end) = (before.velocity[c], after.velocity[c]);
                    let bend = rest * (h * start - way) - theta * (h * end - way);
                    moving.position[c] = before.position[c] + theta * (way + rest * bend);
                    let slope = 6.0 * theta * rest * way / h;
                    moving.velocity[c] =
                        slope + rest * (1.0 - 3.0 * theta) * start + theta * (3.0 * theta - 2.0) * end;
                }
                moving
            })
            .collect();
        self.watch.value(self.unit, self.event, &bodies, self.span.at(theta), ticker)
    }
}

/// Whether a function of one sign comes so near zero between points around the middle one that it may pass it. Between
/// points of a parabola it goes an eighth of the larger difference beyond the middle one, if they are evenly spaced.
fn turns(left: f64, middle: f64, right: f64) -> bool {
    let one_sign = (left > 0.0 && middle > 0.0 && right > 0.0) || (left < 0.0 && middle < 0.0 && right < 0.0);
    let (left, middle, right) = (left.abs(), middle.abs(), right.abs());
    one_sign && middle <= left && middle <= right && middle < left.max(right) - middle
}
