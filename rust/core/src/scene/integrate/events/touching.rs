//! Which of the events in a step are searched, and where spheres touch.
//!
//! The one idea: a run ends where spheres touch, so that of all pairs that may do so in a step the first alone is located; of
//! the others it is enough that the cubics through both ends keep clear up to there.

use super::clear::{cubic, keeps_clear_after_all};
use super::search::{Bracket, Search, Zero, crosses, slope_of};
use super::{Interpolant, Span, Watch};
use crate::error::Result;
use crate::ode::events::zero;
use crate::parallel::Ticker;
use crate::scene::events::dot;
use crate::scene::unit::Prepared;

impl<'a> Watch<'a> {
    /// The search for the zeros of an event in the step that was come to the end of.
    fn search<'s>(&'s mut self, unit: &'s Prepared, event: usize, span: Span) -> Search<'s, 'a> {
        let shift = self.shift(event);
        let ends = [self.sights[event].value + shift, self.next[event].value + shift];
        Search { watch: self, unit, event, span, ends, shift }
    }

    /// The zeros in the step that was come to the end of, in the order of the motion, and of which events.
    ///
    /// # Errors
    /// Those of the functions and of the evaluations that the inside of the step takes.
    pub(super) fn zeros_in_step(
        &mut self,
        unit: &Prepared,
        span: Span,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<(Zero, usize)>> {
        let mut zeros: Vec<(Zero, usize)> = Vec::new();
        let mut suspects = core::mem::take(&mut self.suspects);
        let pairs = suspects.partition_point(|&event| event < self.events.len());
        if suspects.len() - pairs > 1 {
            suspects[pairs..].sort_by_cached_key(|&event| {
                let soonest = self.search(unit, event, span).soonest();
                soonest.max(0.0).to_bits()
            });
        }
        // The run ends where spheres touch: who does so later does not.
        let mut first = 1.0;
        for event in suspects {
            let is_pair = event >= self.events.len();
            let mut search = self.search(unit, event, span);
            if is_pair && first < 1.0 && search.is_clear_until(first, ticker)? {
                continue;
            }
            let found = search.zeros(step, ticker)?;
            if is_pair && let Some(&(theta, _)) = found.first() {
                first = theta.min(first);
            }
            zeros.extend(found.into_iter().map(|zero| (zero, event)));
        }
        zeros.sort_by(|(a, i), (b, j)| a.0.total_cmp(&b.0).then(i.cmp(j)));
        Ok(zeros)
    }
}

impl Search<'_, '_> {
    /// Whether it is looked for spheres that touch, for the first time in the step alone.
    pub(super) fn is_contact(&self) -> bool {
        self.event >= self.watch.events.len()
    }

    /// Where in the step spheres would touch, or be nearest, that go on as they do at its start: those that do so sooner are
    /// looked at first.
    pub(super) fn soonest(&self) -> f64 {
        let (h, sight) = (self.length(), &self.watch.sights[self.event]);
        let (speed, approach) =
            (h * h * dot(sight.velocity, sight.velocity), -h * dot(sight.distance, sight.velocity));
        let square = approach * approach - speed * self.ends[0];
        (approach - square.max(0.0).sqrt()) / speed
    }

    /// Whether spheres do not touch up to a place in the step, for all that is known of their motion from its ends.
    pub(super) fn is_clear_until(&mut self, theta: f64, ticker: &mut Ticker<'_>) -> Result<bool> {
        let there = self.sight_between(theta, ticker)?;
        let here = &self.watch.sights[self.event];
        let h = theta * self.length();
        let Some(rates) = self.watch.event(self.event).0.rates([here, &there], h) else { return Ok(false) };
        Ok(keeps_clear_after_all(cubic([self.ends[0], there.value], rates, h)))
    }

    /// Where spheres touch that come into reach of each other in a part of a step.
    pub(super) fn touch(
        &mut self,
        part: Bracket,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let [from, to] = part.map(|(theta, _)| self.sight_between(theta, ticker));
        let between = [(part[0].0, from?.value), (part[1].0, to?.value)];
        if !crosses(between[0].1, between[1].1) {
            return zero(part, |theta| self.value_at(theta, step, ticker));
        }
        let theta = zero(between, |theta| Ok(self.sight_between(theta, ticker)?.value))?;
        let sight = self.sight_between(theta, ticker)?;
        let rate = self.watch.event(self.event).0.rate(&sight);
        let slope = rate.map_or_else(|| slope_of(part), |rate| rate * self.length());
        self.one_zero(part, (theta, slope), step, ticker)
    }
}
