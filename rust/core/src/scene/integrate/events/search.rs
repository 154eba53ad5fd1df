//! The zeros of one event in one step: the function is sampled along it; where it changes its sign, or comes near zero and
//! turns, the zero is located on the solution itself.

use super::super::super::events::{What, dot};
use super::super::super::unit::Prepared;
use super::clear::{cubic, cubic_at, is_straight};
use super::nearest::around;
use super::turns::turns;
use super::{Interpolant, Span, Watch};
use crate::error::Result;
use crate::numerics::power_of_two::scale;
use crate::ode::events::{before_the_first, zero};
use crate::parallel::Ticker;

/// Where a step is sampled, as fractions of it: close to its ends to see which way the function leaves and comes.
const SAMPLES: [f64; 9] = [0.015625, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 0.984375];

/// A function of which nothing else is known is sampled so often in a run at least: of a free body one step may be the whole.
const FEWEST: f64 = 128.0;

/// Secants after which a zero is sought in another way.
const SECANTS: usize = 6;

/// Steps of the last kind, which find it to round-off if the motion is uniform.
pub(super) const POLISHES: usize = 3;

/// How far a function may bend away from the cubic in the middle of a step through which it goes almost straight, as a part
/// of its way: not by enough to turn.
const BEND: f64 = 0.0625;

/// Zeros to the same side that are nearer than this part of a step are one.
const ONE_ZERO: f64 = 1e-6;

/// A part of a step at whose ends a function has different signs.
pub(super) type Bracket = [(f64, f64); 2];

/// The search for the zeros of one event in one step.
pub(super) struct Search<'s, 'a> {
    pub(super) watch: &'s mut Watch<'a>,
    pub(super) unit: &'s Prepared,
    pub(super) event: usize,
    pub(super) span: Span,
    pub(super) ends: [f64; 2],
    /// What is added to the value of the event.
    pub(super) shift: f64,
}

/// Whether a function leaves the sign that it has. A zero at the end counts, one at the start was told of before.
pub(super) fn crosses(start: f64, end: f64) -> bool {
    (start < 0.0 && end >= 0.0) || (start > 0.0 && end <= 0.0)
}

/// How fast a function goes from one end of a bracket to the other.
pub(super) fn slope_of([from, to]: Bracket) -> f64 {
    (to.1 - from.1) / (to.0 - from.0)
}

/// The brackets between points beside each other.
pub(super) fn crossings(points: &[(f64, f64)]) -> Vec<Bracket> {
    let pairs = points.windows(2).map(|pair| [pair[0], pair[1]]);
    pairs.filter(|[start, end]| crosses(start.1, end.1)).collect()
}

/// A zero: at what fraction of the step, and whether the function comes up to it from below.
pub(super) type Zero = (f64, bool);

impl Search<'_, '_> {
    /// The zeros of the motion.
    pub(super) fn zeros(&mut self, step: &mut dyn Interpolant, ticker: &mut Ticker<'_>) -> Result<Vec<Zero>> {
        let mut zeros = self.all_zeros(step, ticker)?;
        if zeros.last().is_none_or(|&(theta, _)| theta < 1.0 - ONE_ZERO) {
            zeros.extend(self.arrival());
        }
        zeros.retain(|&(theta, _)| self.is_of_the_motion(theta));
        // Spheres that touch do not come to that once more; what the motion keeps is rounding everywhere.
        if self.event < self.watch.events.len() && !self.watch.is_kept(self.event) {
            for (theta, rises) in &mut zeros {
                *theta = self.beyond((*theta, *rises), step, ticker)?;
            }
        }
        Ok(zeros)
    }

    /// Whether a zero is none that rounding and the errors of steps have made. Told at once, and from this step alone: a run
    /// may end with it. The value may have come further from zero since it was zero last than they take it, were it a
    /// parabola with the slope that it has here; and where on this step it comes no further, a radian must have passed.
    fn is_of_the_motion(&mut self, theta: f64) -> bool {
        let Some(last) = self.watch.last.get_mut(self.event) else { return true };
        let at = self.span.at(theta);
        let since = at - core::mem::replace(last, at);
        let sight = &self.watch.sights[self.event];
        let Some(least) = self.watch.event(self.event).0.least_swing(sight, &self.watch.known) else {
            return true;
        };
        let [start, end] = self.ends.map(f64::abs);
        let steps = since / (self.span.to - self.span.from);
        let turned = scale(since, self.watch.job.plan.units.time);
        let a_radian =
            turned * turned * dot(sight.velocity, sight.velocity) >= dot(sight.distance, sight.distance);
        0.25 * (start + end) * steps > least && (start.max(end) > least || a_radian)
    }

    /// Whether the zeros of an event count that the function comes to from a side.
    pub(super) fn counts(&self, start: f64) -> bool {
        // Upwards along the run backwards is downwards in time.
        let direction = self.watch.event(self.event).0.direction * (self.span.to - self.span.from);
        direction * if start < 0.0 { 1.0 } else { -1.0 } >= 0.0
    }

    /// All zeros.
    fn all_zeros(&mut self, step: &mut dyn Interpolant, ticker: &mut Ticker<'_>) -> Result<Vec<Zero>> {
        if self.watch.is_kept(self.event) {
            if !crosses(self.ends[0], self.ends[1]) || !self.counts(self.ends[0]) {
                return Ok(vec![]);
            }
            let ends = [(0.0, self.ends[0]), (1.0, self.ends[1])];
            return Ok(vec![(zero(ends, |theta| self.value_at(theta, step, ticker))?, self.ends[0] < 0.0)]);
        }
        if self.rests() {
            return Ok(Vec::new());
        }
        if crosses(self.ends[0], self.ends[1])
            && let Some((theta, slope)) = self.straight(ticker)?
        {
            let mut zeros = Vec::new();
            if self.counts(self.ends[0]) {
                zeros.push((self.one_zero(self.whole(), (theta, slope), step, ticker)?, self.ends[0] < 0.0));
            }
            return Ok(zeros);
        }
        let [start, end] =
            [&self.watch.sights[self.event], &self.watch.next[self.event]].map(|sight| self.rate(sight));
        let (mut points, mut rates) = (vec![(0.0, self.ends[0])], vec![start]);
        let mut samples = self.samples()?;
        samples.extend(self.may_be_zero_between(ticker)?);
        samples.sort_by(f64::total_cmp);
        samples.dedup();
        for theta in samples {
            let sight = self.sight_on_the_way(theta, step, ticker)?;
            points.push((theta, sight.value));
            rates.push(self.rate(&sight));
        }
        points.push((1.0, self.ends[1]));
        rates.push(end);
        let begins = self.ends[0] == 0.0 && self.span.from == self.watch.job.begun();
        if begins && start.is_none_or(|rate| rate * points[1].1 <= 0.0) {
            let before = before_the_first(points[1], |theta| {
                let sight = self.sight_on_the_way(theta, step, ticker)?;
                let rounding = self.watch.event(self.event).0.rounding(&sight);
                let nothing = self.watch.nothing.get(self.event).map_or(rounding, |&own| rounding.max(own));
                Ok(if sight.value.abs() <= nothing { 0.0 } else { sight.value })
            })?;
            if let Some(point) = before {
                let sight = self.sight_on_the_way(point.0, step, ticker)?;
                points.insert(1, point);
                rates.insert(1, self.rate(&sight));
            }
        }
        let mut brackets = crossings(&points);
        for (index, rates) in rates.windows(2).enumerate() {
            let (a, b) = (points[index], points[index + 1]);
            if let &[Some(from), Some(to)] = rates
                && a.1 * b.1 > 0.0
                && a.1.signum() * from < 0.0
                && a.1.signum() * to > 0.0
            {
                brackets.extend(self.nearest(&points, index, step, ticker)?);
            }
        }
        for three in points.windows(3).filter(|_| end.is_none()) {
            if let &[left, middle, right] = three
                && let Some(theta) = turns([left, middle, right])
            {
                brackets.extend(self.turn_beside([left, middle, right], theta, step, ticker)?);
            }
        }
        // Windows overlap: one turn may be found from two of them.
        brackets.sort_by(|[(a, _), _], [(b, _), _]| a.total_cmp(b));
        brackets.dedup_by(|later, before| later[0].0 < before[1].0);
        if let (true, &[bracket]) = (self.watch.terms.is_empty(), &brackets[..])
            && crosses(self.ends[0], self.ends[1])
        {
            if !self.counts(self.ends[0]) {
                return Ok(Vec::new());
            }
            let theta = zero(bracket, |theta| Ok(self.sight_on_the_way(theta, step, ticker)?.value))?;
            let near = (theta, slope_of(bracket));
            return Ok(vec![(self.one_zero(self.whole(), near, step, ticker)?, self.ends[0] < 0.0)]);
        }
        let mut zeros = Vec::new();
        let mut told = Vec::new();
        let mut looked_up_to = 0.0;
        for bracket in brackets {
            match self.settled(bracket, step, ticker)? {
                Some(settled) => told.push(settled),
                // It has passed zero a little sooner or later, or come near it and turned.
                None if bracket[0].0 >= looked_up_to => {
                    let around = around(&points, bracket);
                    looked_up_to = around[3];
                    told.extend(self.dip(around, step, ticker)?);
                }
                None => {}
            }
            // The run ends where spheres touch.
            if self.is_contact() && told.last().is_some_and(|&[a, _]| self.counts(a.1)) {
                break;
            }
        }
        for [a, b] in told {
            if self.counts(a.1) {
                let theta = if self.is_contact() && self.watch.terms.is_empty() {
                    self.touch([a, b], step, ticker)?
                } else {
                    zero([a, b], |theta| self.value_at(theta, step, ticker))?
                };
                zeros.push((self.polished(theta, [a.0, b.0], step, ticker)?, a.1 < 0.0));
            }
        }
        // Brackets that the solution does not confirm lead to one zero.
        zeros.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Between two zeros to one side there is one to the other, which is not this near.
        zeros.dedup_by(|later, before| later.1 == before.1 && later.0 - before.0 <= ONE_ZERO);
        Ok(zeros)
    }

    /// Where the step is sampled.
    ///
    /// # Errors
    /// A step in which bodies turn too often to be followed.
    fn samples(&self) -> Result<Vec<f64>> {
        let (job, length) = (self.watch.job, self.length().abs());
        let run = job.times.last().map_or(0.0, |end| (end - job.scene.t0).abs());
        let mut parts = (FEWEST * length / run).ceil().min(FEWEST);
        let mut samples = SAMPLES.to_vec();
        let event = self.watch.event(self.event).0;
        let is_known = !matches!(event.what, What::Function(_) | What::Expression(_));
        if let (true, Some(turns)) = (event.sees_turning(), &self.watch.turns) {
            parts = parts.max(turns.parts(length)?);
        }
        if is_known || parts <= SAMPLES.len() as f64 {
            return Ok(samples);
        }
        samples.extend((1..parts as u32).map(|part| f64::from(part) / parts));
        samples.sort_by(f64::total_cmp);
        samples.dedup();
        Ok(samples)
    }

    /// Where the function is zero, and its slope there, if it goes almost straight from one sign to the other: told from the
    /// ends of the step and its middle.
    fn straight(&mut self, ticker: &mut Ticker<'_>) -> Result<Option<(f64, f64)>> {
        let h = self.length();
        let Some(rates) = self.watch.rates(self.event, h) else { return Ok(None) };
        let cubic = cubic(self.ends, rates, h);
        if !is_straight(cubic) {
            return Ok(None);
        }
        let off = self.sight_between(0.5, ticker)?.value - cubic_at(cubic, 0.5)[0];
        if off.abs() > BEND * (self.ends[1] - self.ends[0]).abs() {
            return Ok(None);
        }
        let value = |theta: f64| {
            let bump = theta * (1.0 - theta);
            cubic_at(cubic, theta)[0] + 16.0 * bump * bump * off
        };
        let theta = zero([(0.0, self.ends[0]), (1.0, self.ends[1])], |theta| Ok(value(theta)))?;
        let slope = cubic_at(cubic, theta)[1] + 32.0 * theta * (1.0 - theta) * (1.0 - 2.0 * theta) * off;
        Ok(Some((theta, slope)))
    }

    fn whole(&self) -> Bracket {
        [(0.0, self.ends[0]), (1.0, self.ends[1])]
    }

    /// The one zero in a part of a step, which is near `theta`, where the function has about that slope. Each shadow step costs
    /// as much as a step: a few secants do.
    pub(super) fn one_zero(
        &mut self,
        mut whole: Bracket,
        (mut theta, mut slope): (f64, f64),
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let mut last: Option<(f64, f64)> = None;
        for _ in 0..SECANTS {
            if !(whole[0].0 < theta && theta < whole[1].0) {
                break;
            }
            let sight = self.sight_at(theta, step, ticker)?;
            let (value, rounding) = (sight.value, self.watch.event(self.event).0.rounding(&sight));
            if value.abs() <= 0.25 * rounding {
                return Ok(theta);
            }
            whole[usize::from(crosses(whole[0].1, value))] = (theta, value);
            if let Some((other, at_other)) = last.filter(|(_, value)| value.abs() > 1e3 * rounding) {
                slope = (value - at_other) / (theta - other);
            }
            let next = theta - value / slope;
            if (next - theta).abs() <= f64::EPSILON * theta {
                return Ok(theta);
            }
            last = Some((theta, value));
            theta = next;
        }
        zero(whole, |theta| self.value_at(theta, step, ticker))
    }

    /// The length of the step.
    pub(super) fn length(&self) -> f64 {
        scale(self.span.to - self.span.from, self.watch.job.plan.units.time)
    }

    /// A zero of a distance as exactly as the time from the start of the step allows, where the step is long beside the
    /// approach: as if the bodies moved uniformly there.
    fn polished(
        &mut self,
        mut theta: f64,
        bracket: [f64; 2],
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let h = self.length();
        for _ in 0..POLISHES {
            let sight = self.sight_at(theta, step, ticker)?;
            if !self.is_distance() {
                break;
            }
            let rounding = self.watch.event(self.event).0.rounding(&sight);
            let (a, b) =
                (h * h * dot(sight.velocity, sight.velocity), h * dot(sight.distance, sight.velocity));
            let square = b * b - a * sight.value;
            let next = theta - sight.value / (b + b.signum() * square.max(0.0).sqrt());
            if sight.value.abs() <= rounding || !(bracket[0] <= next && next <= bracket[1]) {
                break;
            }
            theta = next;
        }
        Ok(theta)
    }

    /// A bracket with the values of the solution itself, where those of the cubic have led there; none if it has no
    /// zero after all.
    fn settled(
        &mut self,
        bracket: Bracket,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<Bracket>> {
        let mut settled = bracket;
        for (theta, value) in &mut settled {
            *value = self.value_on_solution(*theta, step, ticker)?;
        }
        if crosses(settled[0].1, settled[1].1) {
            return Ok(Some(settled));
        }
        let whole = [(0.0, self.ends[0]), (1.0, self.ends[1])];
        Ok(crosses(self.ends[0], self.ends[1]).then_some(whole))
    }
}
