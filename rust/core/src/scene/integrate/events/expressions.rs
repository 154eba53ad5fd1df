//! Expressions among events: in which steps they may be zero.
//!
//! The one idea: coordinates lie between the coefficients of the cubics through both ends of a step, or not far beyond; bounds
//! over that box tell an expression, or the cubic through its own values and rates where it is no more than a parabola.

use super::super::super::events::Working;
use super::super::super::unit::Prepared;
use super::clear::{CLEARANCE, cubic, keeps_clear, keeps_clear_after_all};
use super::{Span, Watch};
use crate::expressions::intervals::Interval;
use crate::numerics::power_of_two::scale;
use crate::scene::frame::Moved;

impl Watch<'_> {
    /// Whether an event is an expression that keeps clear of zero in the step that was come to the end of, its values at the ends
    /// being these; none of another kind.
    pub(super) fn expression_keeps_clear(
        &self,
        unit: &Prepared,
        (event, values): (usize, [f64; 2]),
        span: Span,
        h: f64,
    ) -> Option<bool> {
        let mut working = self.working.get(event)?.as_ref()?.borrow_mut();
        let (own, places) = self.event(event);
        let times = [span.from, span.to].map(|elapsed| scale(elapsed, self.job.plan.units.time));
        for (end, bodies) in [&self.before, &self.after].into_iter().enumerate() {
            let origin = if own.asks_where() { unit.origin.at(times[end]) } else { Moved::NOWHERE };
            working.take(end, (bodies, places), &origin);
        }
        let times = times.map(|elapsed| self.job.scene.t0 + elapsed);
        working.rates = None;
        let Working { ends: [before, after], shape, .. } = &mut *working;
        if let Some(shape) = shape {
            let states = between(before, after, h);
            return Some(shape.is_clear(Interval::between(times[0], times[1]), states));
        }
        working.accelerate(h);
        let rates = [0, 1].map(|end| working.run(end, times[end])[1]);
        working.rates = Some(rates);
        let cubic = cubic(values, rates, h);
        Some(keeps_clear(cubic) || keeps_clear_after_all(cubic))
    }
}

impl Watch<'_> {
    /// The rates of an event at both ends of the step that was come to the end of, if they tell it.
    pub(super) fn rates(&self, event: usize, h: f64) -> Option<[f64; 2]> {
        match self.working.get(event).and_then(Option::as_ref) {
            Some(working) => working.borrow().rates,
            None => self.event(event).0.rates([&self.sights[event], &self.next[event]], h),
        }
    }
}

/// Where the coordinates and velocities of an expression are in a step `h`, from what they are at both ends.
pub(super) fn between<'a>(
    before: &'a [f64],
    after: &'a [f64],
    h: f64,
) -> impl Iterator<Item = Interval> + 'a {
    let n = before.len() / 3;
    (0..2 * n).map(move |index| {
        let (at, velocity) = (index % n, n + index % n);
        let (x, v) = ([before[at], after[at]], [before[velocity], after[velocity]]);
        if index < n { place_between(x, v, h) } else { velocity_between(x, v, h) }
    })
}

/// Where a coordinate is in a step: between the coefficients of the cubic, or beyond by what a motion may leave it.
fn place_between(x: [f64; 2], v: [f64; 2], h: f64) -> Interval {
    around(&cubic(x, v, h))
}

/// The same of its velocity.
fn velocity_between([x0, x1]: [f64; 2], [v0, v1]: [f64; 2], h: f64) -> Interval {
    around(&[v0, 3.0 * (x1 - x0) / h - v0 - v1, v1])
}

fn around(coefficients: &[f64]) -> Interval {
    let (low, high) = coefficients
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)));
    let beyond = CLEARANCE * (high - low);
    Interval::between(low - beyond, high + beyond)
}
