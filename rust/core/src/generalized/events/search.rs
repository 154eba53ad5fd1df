//! The zeros of one function in one step.
//!
//! The one idea: where the rate is known, a part of the step is understood if the function and its rate inside it are those of
//! the cubic through its ends; a part that is not is cut in two. A part that is understood has no zeros if the cubic keeps
//! clear of it by more than it errs; else the function is looked at where the cubic turns, and what changes its sign between
//! two such points, or comes down towards zero from both, is located on the solution itself. Where something may hide between
//! looks ([`Shape`](crate::expressions::shape::Shape)) a part is cut before any of that is asked.

use super::cubic::Cubic;
use super::{Interval, Working};
use crate::error::{Error, Result};
use crate::expressions::shape::Told;
use crate::ode::events::{before_the_first, zero};

/// Where a part of a step is looked at, as a fraction of it: not in the middle, so that no oscillation is in step with it.
pub(in crate::generalized) const INSIDE: f64 = 0.458_6;

/// Where a part is looked at again that seems to be understood.
const SECOND: f64 = 0.81;

/// How far a function may leave the cubic, as a part of its range, so that it turns where the cubic does.
const UNDERSTOOD: f64 = 1e-3;

/// So many parts of a step are cut because something may hide in them: on the edge of what a function is defined for, as that of an
/// angle at ±π, it may at every scale.
const CUTS_OF_NARROW: u32 = 512;

/// How often a step is cut, and its parts; and the most looks into one step: enough for a hundred thousand oscillations.
const CUTS: u32 = 24;
const LOOKS: u32 = 2_000_000;

/// What ends a run whose events are more than can be looked for.
const TOO_MANY: &str = "the function of an event has more zeros in one step than are looked for, a hundred thousand; end the run \
    before, or take a function that changes its sign less often";

/// Cuts after which it is asked whether a function is no more than its rounding, which no cut makes smooth.
const CUTS_BEFORE_ROUNDING: u32 = 6;

/// By what part of themselves the numbers of a state change to see what the rounding of a function is, and how many units of
/// that are nothing.
const NUDGE: f64 = 1.0 / 1_048_576.0;
const UNITS_OF_ROUNDING: f64 = 16.0;

/// Where a function without a rate is looked at: close to the ends to see which way it leaves and comes.
const SAMPLES: [f64; 9] = [0.015625, 0.125, 0.25, 0.375, INSIDE, 0.625, 0.75, 0.875, 0.984375];

/// What is more than this part of a function beside it, where its sign changes, is no zero: a jump, or a pole.
const JUMPS: f64 = 1e-6;

/// Parts of a bracket in which a minimum lies come down by the golden section to 1e-8 of it, where a parabola has come
/// down to round-off.
const SECTIONS: usize = 40;

/// A function in a place of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) theta: f64,
    pub(super) value: f64,
    /// Its rate along the step, if that is known.
    pub(super) rate: Option<f64>,
    /// Which of the states that are kept is the one there, if it is.
    state: Option<usize>,
}

impl Point {
    pub(super) fn at(theta: f64, (value, rate): (f64, Option<f64>), from: f64, to: f64) -> Self {
        Self { theta, value, rate: rate.map(|rate| rate * (to - from)), state: None }
    }
}

/// A zero as a fraction of the step, and whether it is passed upwards.
type Zero = (f64, bool);

/// The search in one step.
pub(super) struct Search<'s> {
    function: &'s mut Working,
    step: &'s mut dyn Interval,
    looks: u32,
    /// Parts that were cut because something may hide in them.
    narrow: u32,
    /// What is nothing beside the numbers that the function is made of, once it was asked for.
    rounding: Option<f64>,
    zeros: Vec<Zero>,
    /// States of points, one after the other, for functions in which something may hide.
    states: Vec<f64>,
}

/// What is nothing beside the numbers that a function is made of there.
pub(super) fn rounding(function: &mut Working, t: f64, y: &[f64]) -> Result<f64> {
    let mut y = y.to_vec();
    let value = function.at(t, &y)?.0;
    let mut sum = (function.at(t + NUDGE * t, &y)?.0 - value).abs();
    for index in 0..y.len() {
        let own = y[index];
        y[index] += NUDGE * own;
        sum += (function.at(t, &y)?.0 - value).abs();
        y[index] = own;
    }
    Ok(UNITS_OF_ROUNDING * f64::EPSILON * sum / NUDGE)
}

/// Whether a function leaves the sign that it has. A zero at the end counts, one at the start was told of before.
fn crosses(start: f64, end: f64) -> bool {
    (start < 0.0 && end >= 0.0) || (start > 0.0 && end <= 0.0)
}

impl<'s> Search<'s> {
    pub(super) fn new(function: &'s mut Working, step: &'s mut dyn Interval) -> Self {
        Self { function, step, looks: 0, narrow: 0, rounding: None, zeros: vec![], states: vec![] }
    }

    /// The zeros in the order of the motion, with the state at [`INSIDE`].
    pub(super) fn zeros(mut self, [mut start, mut end]: [Point; 2], inside: &[f64]) -> Result<Vec<Zero>> {
        let (from, to) = self.step.span();
        let value = self.function.at(from + INSIDE * (to - from), inside)?;
        let mut inside_point = Point::at(INSIDE, value, from, to);
        if inside_point.rate.is_some() {
            if self.function.shape().is_some() {
                inside_point.state = Some(self.keep(inside));
                let begun = self.step.at(0.0)?.to_vec();
                start.state = Some(self.keep(&begun));
                let ended = self.step.end().to_vec();
                end.state = Some(self.keep(&ended));
            }
            self.part(start, inside_point, end, CUTS)?;
        } else {
            self.sampled(start, inside_point, end)?;
        }
        self.zeros.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        self.zeros.dedup();
        Ok(self.zeros)
    }

    fn look(&mut self, theta: f64) -> Result<Point> {
        self.looks += 1;
        let (from, to) = self.step.span();
        let y = self.step.at(theta)?;
        let mut point = Point::at(theta, self.function.at(from + theta * (to - from), y)?, from, to);
        if self.function.shape().is_some() {
            point.state = Some(self.states.len() / y.len().max(1));
            self.states.extend_from_slice(y);
        }
        Ok(point)
    }

    /// Keeps a state.
    fn keep(&mut self, y: &[f64]) -> usize {
        self.states.extend_from_slice(y);
        self.states.len() / y.len().max(1) - 1
    }

    /// What the bounds of the function tell of a part of the step, if it has some.
    fn told(&mut self, points: [Point; 3]) -> Option<Told> {
        let ((from, to), numbers) = (self.step.span(), self.step.end().len());
        let [Some(a), Some(b), Some(c)] = points.map(|point| point.state) else { return None };
        let state = |k: usize| &self.states[k * numbers..][..numbers];
        let times = [points[0].theta, points[2].theta].map(|theta| from + theta * (to - from));
        let states = [state(a), state(b), state(c)];
        Some(self.function.shape()?.told(times, states))
    }

    /// Cuts a part of the step in two, and looks into both.
    fn cut(&mut self, [a, inside, b]: [Point; 3], cuts: u32) -> Result<()> {
        if self.looks >= LOOKS {
            return Err(Error::Convergence { message: TOO_MANY.to_owned(), time: self.step.span().0 });
        }
        for (left, right) in [(a, inside), (inside, b)] {
            let kept = self.states.len();
            let between = self.look(left.theta + INSIDE * (right.theta - left.theta))?;
            self.part(left, between, right, cuts - 1)?;
            self.states.truncate(kept);
        }
        Ok(())
    }

    fn value(&mut self, theta: f64) -> Result<f64> {
        Ok(self.look(theta)?.value)
    }

    /// Looks into a part of the step, of which a point inside is known.
    fn part(&mut self, a: Point, inside: Point, b: Point, cuts: u32) -> Result<()> {
        let cubic = Cubic::through(a, b);
        match self.told([a, inside, b]) {
            Some(Told::Clear) => return Ok(()),
            Some(Told::Narrow)
                if cuts > 0
                    && self.narrow < CUTS_OF_NARROW
                    && !self.is_rounding(cubic.size(), inside.theta, cuts)? =>
            {
                self.narrow += 1;
                return self.cut([a, inside, b], cuts);
            }
            _ => {}
        }
        let mut off = cubic.off(inside);
        // An oscillation may agree with the cubic in one place; far from zero that is no matter.
        let (clearance, range) = (cubic.clearance(), cubic.range());
        if clearance <= range && (clearance > 2.0 * off || off <= UNDERSTOOD * range) {
            let second = self.look(a.theta + SECOND * (b.theta - a.theta))?;
            let there = cubic.off(second);
            off = if there <= off { off } else { there };
        }
        // Nothing is known of a function that is no number inside; it counts where it is one.
        if off.is_finite() {
            if clearance > 2.0 * off {
                return Ok(());
            }
            let understood = off <= UNDERSTOOD * range || cuts == 0;
            if !understood && !self.is_rounding(cubic.size(), inside.theta, cuts)? {
                return self.cut([a, inside, b], cuts);
            }
        }
        let mut points = vec![a, inside, b];
        for turn in cubic.turns() {
            let theta = a.theta + turn * (b.theta - a.theta);
            if a.theta < theta && theta < b.theta && theta != inside.theta {
                points.push(self.look(theta)?);
            }
        }
        points.sort_by(|x, y| x.theta.total_cmp(&y.theta));
        for pair in points.windows(2) {
            if let &[left, right] = pair {
                self.between(left, right)?;
            }
        }
        Ok(())
    }

    /// Whether a function of this size is no more than its rounding: small beside how much it changes with each number that it
    /// is made of.
    fn is_rounding(&mut self, size: f64, theta: f64, cuts: u32) -> Result<bool> {
        if cuts + CUTS_BEFORE_ROUNDING > CUTS {
            return Ok(false);
        }
        let rounding = match self.rounding {
            Some(rounding) => rounding,
            None => {
                let (from, to) = self.step.span();
                let y = self.step.at(theta)?.to_vec();
                rounding(self.function, from + theta * (to - from), &y)?
            }
        };
        self.rounding = Some(rounding);
        Ok(size <= rounding)
    }

    /// The zeros between two points, if the function turns at most once there.
    fn between(&mut self, a: Point, b: Point) -> Result<()> {
        if crosses(a.value, b.value) {
            return self.cross(a, b);
        }
        let sign = a.value.signum();
        let comes_down = a.rate.zip(b.rate).filter(|&(from, to)| sign * from < 0.0 && sign * to > 0.0);
        let Some((from, to)) = comes_down.filter(|_| a.value * b.value > 0.0) else { return Ok(()) };
        let turn =
            zero([(a.theta, from), (b.theta, to)], |theta| Ok(self.look(theta)?.rate.unwrap_or(f64::NAN)))?;
        let turn = self.look(turn)?;
        if crosses(a.value, turn.value) {
            self.cross(a, turn)?;
            self.between(Point { rate: None, ..turn }, b)?;
        }
        Ok(())
    }

    /// The zero between points of different signs.
    fn cross(&mut self, a: Point, b: Point) -> Result<()> {
        let theta = zero([(a.theta, a.value), (b.theta, b.value)], |theta| self.value(theta))?;
        if self.vanishes(theta, a.value.abs().max(b.value.abs()))? || self.switches(theta, [a, b])? {
            self.zeros.push((theta, a.value < 0.0));
        }
        Ok(())
    }

    /// Whether a function of that size beside it is zero where it changes its sign, and does not jump, as an angle from π to −π,
    /// and has no pole.
    fn vanishes(&mut self, theta: f64, size: f64) -> Result<bool> {
        let value = self.value(theta)?.abs();
        if value <= JUMPS * size {
            return Ok(true);
        }
        // Close to a tangent all values beside it are round-off.
        let (from, to) = self.step.span();
        let y = self.step.at(theta)?.to_vec();
        Ok(value <= rounding(self.function, from + theta * (to - from), &y)?)
    }

    /// Whether a function has one value on either side of a place: a switch, of which the jump is the event.
    fn switches(&mut self, theta: f64, sides: [Point; 2]) -> Result<bool> {
        for side in sides {
            if self.value(0.5 * (side.theta + theta))? != side.value {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The zeros of a function without a rate: it is looked at in some places, and followed down where it turns between them.
    fn sampled(&mut self, start: Point, inside: Point, end: Point) -> Result<()> {
        let mut points = vec![start];
        for theta in SAMPLES {
            points.push(if theta == INSIDE { inside } else { self.look(theta)? });
        }
        points.push(end);
        if start.value == 0.0
            && let Some((theta, _)) =
                before_the_first((SAMPLES[0], points[1].value), |theta| self.value(theta))?
        {
            let point = self.look(theta)?;
            points.insert(1, point);
        }
        for pair in points.windows(2) {
            if let &[a, b] = pair
                && crosses(a.value, b.value)
            {
                self.cross(a, b)?;
            }
        }
        for three in points.windows(3) {
            if let &[left, middle, right] = three
                && may_turn(left.value, middle.value, right.value)
            {
                self.follow_down(left, middle, right)?;
            }
        }
        Ok(())
    }

    /// Where a function that comes near zero between points of the same sign passes it.
    fn follow_down(&mut self, mut left: Point, mut best: Point, mut right: Point) -> Result<()> {
        let part = 0.381_966_011_250_105_15; // (3 - √5)/2
        let (first, last, sign) = (left, right, best.value.signum());
        for _ in 0..SECTIONS {
            let longer = if right.theta - best.theta > best.theta - left.theta { right } else { left };
            let point = self.look(best.theta + part * (longer.theta - best.theta))?;
            if crosses(first.value, point.value) {
                self.cross(first, point)?;
                if crosses(point.value, last.value) {
                    self.cross(point, last)?;
                }
                return Ok(());
            }
            let (inner, outer) =
                if point.value * sign < best.value * sign { (point, best) } else { (best, point) };
            *(if outer.theta < inner.theta { &mut left } else { &mut right }) = outer;
            best = inner;
        }
        Ok(())
    }
}

/// Whether a function of one sign comes so near zero between points around the middle one that it may pass it. Between
/// points of a parabola it goes an eighth of the larger difference beyond the middle one, if they are evenly spaced.
fn may_turn(left: f64, middle: f64, right: f64) -> bool {
    let one_sign = (left > 0.0 && middle > 0.0 && right > 0.0) || (left < 0.0 && middle < 0.0 && right < 0.0);
    let (left, middle, right) = (left.abs(), middle.abs(), right.abs());
    let larger = if left > right { left } else { right };
    one_sign && middle <= left && middle <= right && middle < larger - middle
}
