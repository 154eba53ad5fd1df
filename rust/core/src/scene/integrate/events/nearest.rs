//! Where a function that has one sign at two points of a step passes zero between them.
//!
//! The one idea: it does so about the place where it is nearest to zero, and there its rate, which follows from what is seen
//! at one time, changes its sign.

use super::super::super::events::{Sight, What, dot};
use super::Interpolant;
use super::search::{Bracket, POLISHES, Search, crossings};
use crate::error::Result;
use crate::ode::events::zero;
use crate::parallel::Ticker;

/// The places of a bracket, and the points before and after it.
pub(super) fn around(points: &[(f64, f64)], [(from, _), (to, _)]: Bracket) -> [f64; 4] {
    let before = points.iter().rev().find(|point| point.0 < from).map_or(0.0, |point| point.0);
    let after = points.iter().find(|point| point.0 > to).map_or(1.0, |point| point.0);
    [before, from, to, after]
}

impl Search<'_, '_> {
    /// The rate of the value along the step, up to a factor above zero, where it follows from what is seen at one time.
    pub(super) fn rate(&self, sight: &Sight) -> Option<f64> {
        let along = self.span.to - self.span.from;
        Some(along.signum() * self.watch.event(self.event).0.rate(sight)?)
    }

    pub(super) fn is_distance(&self) -> bool {
        matches!(self.watch.event(self.event).0.what, What::Distance { .. })
    }

    /// Where a value that is nearest to zero between two points of the same sign, of which this is the first, passes zero
    /// there: two brackets, or none. That is where the rate changes its sign, however short the approach is; on the solution
    /// it may do so beside them.
    pub(super) fn nearest(
        &mut self,
        points: &[(f64, f64)],
        mut index: usize,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Bracket>> {
        let sign = points[index].1.signum();
        let mut rates = [0.0; 2];
        for (rate, point) in rates.iter_mut().zip(&points[index..]) {
            *rate = sign * self.rate_at(point.0, step, ticker)?;
        }
        if rates[0] >= 0.0 && index > 0 {
            index -= 1;
            rates = [sign * self.rate_at(points[index].0, step, ticker)?, rates[0]];
        } else if rates[1] <= 0.0 && index + 2 < points.len() {
            index += 1;
            rates = [rates[1], sign * self.rate_at(points[index + 1].0, step, ticker)?];
        }
        if rates[0] >= 0.0 || rates[1] <= 0.0 {
            return Ok(Vec::new());
        }
        let (a, b) = (points[index], points[index + 1]);
        let mut theta =
            zero([(a.0, rates[0]), (b.0, rates[1])], |theta| Ok(sign * self.rate_at(theta, step, ticker)?))?;
        for _ in 0..POLISHES {
            let sight = self.sight_at(theta, step, ticker)?;
            if sight.value * sign <= 0.0 {
                return Ok(vec![[a, (theta, sight.value)], [(theta, sight.value), b]]);
            }
            if !self.is_distance() {
                break;
            }
            // As if the bodies moved uniformly there: a short approach on a long step is not lost to the rounding of its place.
            let way = self.length() * dot(sight.velocity, sight.velocity);
            let next = theta - dot(sight.distance, sight.velocity) / way;
            if !(a.0 < next && next < b.0) {
                break;
            }
            theta = next;
        }
        Ok(Vec::new())
    }

    /// Where the solution passes zero about a place where the cubic does, but not between the same points.
    pub(super) fn dip(
        &mut self,
        places: [f64; 4],
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Bracket>> {
        let mut points = Vec::with_capacity(places.len());
        for theta in places {
            points.push((theta, self.value_on_solution(theta, step, ticker)?));
        }
        points.dedup_by(|later, before| later.0 == before.0);
        let told = crossings(&points);
        if !told.is_empty() {
            return Ok(told);
        }
        if self.watch.event(self.event).0.rate(&Sight::<f64>::default()).is_some() {
            return self.nearest(&[points[0], points[points.len() - 1]], 0, step, ticker);
        }
        let size = |point: (f64, f64)| point.1.abs();
        let lowest = points.windows(3).find(|three| size(three[1]) <= size(three[0]).min(size(three[2])));
        match lowest {
            Some(&[left, middle, right]) => self.turn(left, middle, right, step, ticker),
            _ => Ok(Vec::new()),
        }
    }

    fn rate_at(&mut self, theta: f64, step: &mut dyn Interpolant, ticker: &mut Ticker<'_>) -> Result<f64> {
        let sight = self.sight_at(theta, step, ticker)?;
        Ok(self.rate(&sight).unwrap_or_default())
    }
}
