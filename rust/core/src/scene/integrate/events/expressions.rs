//! Expressions among events: in which steps they may be zero.
//!
//! The one idea: bounds over where the bodies may be in a step tell an expression, or the cubic through its own values and rates
//! where it is no more than a parabola of them.

use super::super::super::events::Working;
use super::super::super::events::reach::Told;
use super::super::super::unit::Prepared;
use super::clear::{cubic, keeps_clear, keeps_clear_after_all};
use super::{Span, Watch};
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
        let Working { ends: [before, after], reach, .. } = &mut *working;
        let is_bounded = reach.is_some();
        if let Some((reach, numbers)) = reach {
            reach.come(numbers, (times, [before, after]), h);
            if !reach.may_be_zero(numbers, true) || !reach.may_still(numbers, true, values, h) {
                return Some(true);
            }
            if reach.told(numbers, values, h) != Told::Crosses {
                return Some(false);
            }
        }
        working.accelerate(h);
        let rates = [0, 1].map(|end| working.run(end, times[end])[1]);
        working.rates = Some(rates);
        let cubic = cubic(values, rates, h);
        Some(!is_bounded && (keeps_clear(cubic) || keeps_clear_after_all(cubic)))
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
