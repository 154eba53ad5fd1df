//! States that are told at zeros: on the far side of them, so that a run that goes on from there does not find them again.
//!
//! The one idea: a start that is zero for all that its numbers tell is zero ([`Event::rounding_as_told`]); so a state in
//! which a run ends has behind it what it is beyond, or as good as at. It is told at the end of the run, then.
//!
//! [`Event::rounding_as_told`]: crate::scene::events::Event::rounding_as_told

use super::super::{Ending, Report};
use super::search::{Search, Zero};
use super::{Found, Interpolant, Watch};
use crate::error::Result;
use crate::numerics::power_of_two::{power_of_two, scale};
use crate::parallel::Ticker;
use crate::scene::events::{Moving, Sight, What};
use crate::scene::frame::Moved;
use crate::scene::unit::Prepared;

/// How often the way beyond a zero is doubled, from a last digit on, until the function has its other sign.
const DOUBLINGS: i32 = 36;

/// So many times what a last digit of all numbers makes of an energy is rounding.
const ROUNDINGS: f64 = 8.0;

/// Two zeros of a step by which a function turns at nothing are no farther apart, as fractions of it: the root of a rounding, and
/// some.
const TURNING: f64 = 1e-7;

/// The end of a run, as steps come to it.
const LAST_DIGITS: f64 = 4.0 * f64::EPSILON;

/// By what part of themselves the numbers change that a function of one's own is made of, to see what their rounding is.
const NUDGE: f64 = 1.0 / 1_048_576.0;

/// Position and velocity of bodies of the scene, as they are told.
pub(super) type Told<'t> = dyn Fn(usize) -> [[f64; 3]; 2] + 't;

impl Search<'_, '_> {
    /// A zero, or where beside it the very state that is told is on the far side, by more than the rounding that a start is
    /// allowed: from the near side a run that goes on would find the zero once more.
    pub(super) fn beyond(
        &mut self,
        (zero, rises): Zero,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let mut theta = zero;
        for doubled in 0..DOUBLINGS {
            // What is at the end of the step is known.
            if theta >= 1.0 {
                return Ok(1.0);
            }
            let state = step.at(theta, ticker)?;
            self.watch.bodies.read(state, &mut self.watch.inside);
            self.watch.turn(self.unit, state, self.span.at(theta));
            let sight = self.sight_inside(theta, ticker)?;
            let (value, rounding) = (sight.value, self.watch.event(self.event).0.rounding(&sight));
            if value.abs() <= rounding || (value > 0.0) == rises {
                return Ok(theta);
            }
            theta = zero * (1.0 + power_of_two(doubled) * f64::EPSILON);
        }
        Ok(zero)
    }
}

impl Search<'_, '_> {
    /// Whether what is looked at is where it is to rounding, and would be at the end of the run: what rests on a plane does not
    /// pass it.
    pub(super) fn rests(&self) -> bool {
        let what = &self.watch.event(self.event).0.what;
        let by_place = matches!(what, What::Plane { .. } | What::Distance { .. });
        let job = self.watch.job;
        let run = scale(job.times.last().map_or(0.0, |end| end - job.scene.t0), job.plan.units.time);
        let sights = [&self.watch.sights[self.event], &self.watch.next[self.event]];
        let still = |(sight, value): (&Sight, f64)| {
            let rounding = self.watch.event(self.event).0.rounding(sight);
            value.abs() <= rounding && self.rate(sight).is_some_and(|rate| (rate * run).abs() <= rounding)
        };
        by_place && sights.into_iter().zip(self.ends).all(still)
    }

    /// A zero at the end of the run, to which the function comes from one side for all that is known of the state: what
    /// goes on from there takes it for its start, at which nothing comes to zero.
    pub(super) fn arrival(&self) -> Option<Zero> {
        let (watch, [start, end]) = (&*self.watch, self.ends);
        let job = watch.job;
        let last = scale(job.scene.elapsed(job.end()), -job.plan.units.time);
        let is_last = (self.span.to - last).abs() <= LAST_DIGITS * last.abs();
        let comes_near = start * end > 0.0 && end.abs() <= 0.5 * start.abs();
        if !is_last || !comes_near || self.event >= watch.events.len() {
            return None;
        }
        let (event, places) = watch.event(self.event);
        if !event.has_rates() {
            return None;
        }
        // As a run that goes on sees it.
        let moved = self.unit.origin.at(scale(self.span.to, job.plan.units.time));
        let told = |body: &Moving| Moving {
            position: rounded(moved.position, (body.position, body.position_rest)),
            velocity: rounded(moved.velocity, (body.velocity, body.velocity_rest)),
            ..Moving::default()
        };
        let bodies: Vec<Moving> = watch.after.iter().map(told).collect();
        let sight = event.sight_of(&bodies, places, &Moved::NOWHERE);
        let far = places.iter().map(|&place| [bodies[place].position, bodies[place].velocity]);
        let rounding = event.rounding_as_told(&sight, far.fold([0.0; 2], farther));
        // What comes so near to its zero at the start has been there, too.
        let nothing = rounding.max(event.least_swing(&sight, &watch.known).unwrap_or(0.0));
        let is_there = sight.value.abs() <= nothing || sight.value * start < 0.0;
        let arrives = is_there && start.abs() > nothing && self.counts(start);
        arrives.then_some((1.0, start < 0.0))
    }
}

/// What numbers about an origin are as they are told.
fn rounded(origin: [(f64, f64); 3], (numbers, rests): ([f64; 3], [f64; 3])) -> [f64; 3] {
    core::array::from_fn(|c| origin[c].0 + (numbers[c] + (origin[c].1 + rests[c])))
}

impl Watch<'_> {
    /// Tells of other events that would have come on the same step, whose zero the state in which the run ends, after that
    /// time, has behind it for all that its numbers tell: a run that goes on from there does not come to it.
    pub(super) fn tell_what_is_over(
        &mut self,
        unit: &Prepared,
        later: &[(Zero, usize)],
        (end, elapsed): (&Found, f64),
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let told = |body: usize| {
            let slot = unit.unit.bodies.iter().position(|other| *other == body);
            slot.map_or([[0.0; 3]; 2], |slot| end.states[slot])
        };
        // What has a zero ahead has those after it ahead, too, whatever its sign is.
        let mut is_ahead = vec![false; self.events.len()];
        // A value of nothing tells of one zero, or of two about the place where it turns.
        let mut of_nothing: Vec<Option<f64>> = vec![None; self.events.len()];
        for &((theta, rises), event) in later {
            let Some(&(which, _)) = self.events.get(event).filter(|(which, _)| *which != end.which) else {
                continue;
            };
            if is_ahead[event] {
                continue;
            }
            let sight = self.sight(unit, event, (&self.inside, elapsed), ticker)?;
            let zero = self.rounding_as_told(unit, event, (&sight, &self.inside, elapsed), &told, ticker)?;
            let first = of_nothing[event];
            let is_nothing = sight.value.abs() <= zero && first.is_none_or(|first| theta - first < TURNING);
            if is_nothing {
                of_nothing[event] = Some(first.unwrap_or(theta));
            }
            let is_behind = sight.value.abs() > zero && (sight.value > 0.0) == rises;
            if is_nothing || is_behind {
                self.counts[event] += 1;
                self.found.push(Found { which, ..end.clone() });
            } else {
                is_ahead[event] = true;
            }
        }
        Ok(())
    }

    /// Below what the value of an event is zero for all that the numbers of a state tell: these bodies, after that time, of
    /// which it sees that.
    pub(super) fn rounding_as_told(
        &self,
        unit: &Prepared,
        event: usize,
        (sight, bodies, elapsed): (&Sight, &[Moving], f64),
        told: &Told<'_>,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let (own, places) = self.event(event);
        let of = |place: usize| told(self.bodies.indices[place]);
        if !matches!(own.what, What::Energy(_)) || self.is_kept(event) {
            let far = places.iter().map(|&place| of(place)).fold([0.0; 2], farther);
            return Ok(own.rounding_as_told(sight, far));
        }
        let change = self.nudged(unit, event, (sight, bodies, elapsed), (told, f64::EPSILON), ticker)?;
        Ok(own.rounding(sight).max(ROUNDINGS * change))
    }

    /// The same, also of a function of one's own, of which nothing is known but what it makes of other numbers.
    pub(super) fn rounding_of_any(
        &self,
        unit: &Prepared,
        event: usize,
        seen: (&Sight, &[Moving], f64),
        told: &Told<'_>,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        if !matches!(self.event(event).0.what, What::Function(_) | What::Expression(_)) {
            return self.rounding_as_told(unit, event, seen, told, ticker);
        }
        let change = self.nudged(unit, event, seen, (told, NUDGE), ticker)?;
        Ok(ROUNDINGS * change * (f64::EPSILON / NUDGE))
    }

    /// How much an event changes if all numbers of a state change by a part of themselves.
    fn nudged(
        &self,
        unit: &Prepared,
        event: usize,
        (sight, bodies, elapsed): (&Sight, &[Moving], f64),
        (told, part): (&Told<'_>, f64),
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let mut nudged = bodies.to_vec();
        for &place in self.event(event).1 {
            let digits = told(self.bodies.indices[place]).map(|vector| vector.map(|x| part * x.abs()));
            for c in 0..3 {
                let sign = if (place + c).is_multiple_of(2) { 1.0 } else { -1.0 };
                nudged[place].position_rest[c] += sign * digits[0][c];
                nudged[place].velocity_rest[c] += sign * digits[1][c];
            }
        }
        let beside = self.sight(unit, event, (&nudged, elapsed), ticker)?;
        Ok((beside.value - sight.value).abs())
    }

    /// What was found, and the ending of a unit that an event has stopped, in the report.
    pub(in super::super) fn tell(self, report: &mut Report) {
        if let (true, Some(last)) = (self.stopped, self.found.last()) {
            report.ending = Ending::Stopped;
            report.time = last.t;
            report.states = last.states[report.unit.recorded.clone()].to_vec();
            report.turned.clone_from(&last.turned);
            let direction = self.job.plan.direction;
            let passed = self.job.times.partition_point(|t| (t - last.t) * direction <= 0.0);
            report.rows = report.rows.min(passed);
        }
        report.found = self.found;
    }
}

/// The largest coordinate and the largest component of a velocity, with those of one more body.
fn farther(most: [f64; 2], state: [[f64; 3]; 2]) -> [f64; 2] {
    core::array::from_fn(|kind| state[kind].iter().fold(most[kind], |most, x| most.max(x.abs())))
}
