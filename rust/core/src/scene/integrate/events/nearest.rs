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

/// What is between bodies, and the velocity that is not evaluated, may be so many times farther off than they are from those of
/// the cubic.
const TIMES_OFF: f64 = 4.0;

/// Whether bodies near their closest approach, with distance and velocity that may be so far off, come no nearer than by a half
/// of what is between them and the distance that is looked for, if they go on as they do there.
fn clears(Sight { value, distance, velocity }: &Sight, [off, slower]: [f64; 2]) -> bool {
    let apart = dot(*distance, *distance).sqrt();
    let along = dot(*distance, *velocity).abs() + slower * apart;
    along * along + 2.0 * off * apart * dot(*velocity, *velocity) < 0.5 * value * dot(*velocity, *velocity)
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

    /// Whether its value is told by positions alone.
    pub(super) fn is_of_positions(&self) -> bool {
        match &self.watch.event(self.event).0.what {
            What::Expression(expression) => !expression.formula.looks_at_velocities,
            what => matches!(what, What::Distance { .. } | What::Plane { .. }),
        }
    }

    /// Where a value that is nearest to zero between two points of the same sign, of which this is the first, passes zero
    /// there: two brackets, or none. That is where the rate changes its sign, however short the approach is; on the solution
    /// it may do so beside them.
    pub(super) fn nearest(
        &mut self,
        points: &[(f64, f64)],
        index: usize,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Bracket>> {
        if self.passes_by(points, index, step, ticker)? {
            return Ok(Vec::new());
        }
        let Some(([a, b], mut theta)) = self.turn_of_rate(points, (index, true), step, ticker)? else {
            return Ok(Vec::new());
        };
        let sign = a.1.signum();
        for _ in 0..POLISHES {
            let sight = self.sight_of_state(theta, true, step, ticker)?;
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

    /// Whether two bodies pass each other by far, as most do: told from about where they are nearest, since to find that place
    /// takes several states.
    fn passes_by(
        &mut self,
        points: &[(f64, f64)],
        index: usize,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<bool> {
        if !self.is_distance() || !self.watch.terms.is_empty() {
            return Ok(false);
        }
        let Some(([a, _], theta)) = self.turn_of_rate(points, (index, false), step, ticker)? else {
            return Ok(false);
        };
        let (about, between) = (self.sight_at(theta, step, ticker)?, self.sight_between(theta, ticker)?);
        let off = |a: [f64; 3], b: [f64; 3]| {
            let off = core::array::from_fn(|c| a[c] - b[c]);
            TIMES_OFF * dot(off, off).sqrt()
        };
        let (place, slower) = (off(about.distance, between.distance), off(about.velocity, between.velocity));
        let far = clears(&about, [place, slower])
            || clears(&self.sight_of_state(theta, true, step, ticker)?, [place, 0.0]);
        Ok(a.1 > 0.0 && far)
    }

    /// Between which points of the same sign the rate changes its sign, and where; beside the first of them that is this one.
    /// By velocities as exact as the positions, or by those that cost nothing.
    fn turn_of_rate(
        &mut self,
        points: &[(f64, f64)],
        (mut index, velocities): (usize, bool),
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<(Bracket, f64)>> {
        let sign = points[index].1.signum();
        let mut rate = |theta: f64| -> Result<f64> {
            let sight = self.sight_of_state(theta, velocities, step, ticker)?;
            Ok(sign * self.rate(&sight).unwrap_or_default())
        };
        let mut rates = [rate(points[index].0)?, rate(points[index + 1].0)?];
        if rates[0] >= 0.0 && index > 0 {
            index -= 1;
            rates = [rate(points[index].0)?, rates[0]];
        } else if rates[1] <= 0.0 && index + 2 < points.len() {
            index += 1;
            rates = [rates[1], rate(points[index + 1].0)?];
        }
        if rates[0] >= 0.0 || rates[1] <= 0.0 {
            return Ok(None);
        }
        let (a, b) = (points[index], points[index + 1]);
        Ok(Some(([a, b], zero([(a.0, rates[0]), (b.0, rates[1])], rate)?)))
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
}
