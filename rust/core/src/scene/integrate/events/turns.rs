//! Where a function that comes near zero turns, between three points at which it has one sign.
//!
//! The one idea: the points tell by a parabola where it is nearest to zero, wherever among them that is; from there it is
//! followed down on the solution itself.

use super::Interpolant;
use super::search::{Bracket, Search, crossings};
use crate::error::Result;
use crate::parallel::Ticker;

/// Parts of a bracket in which a minimum lies come down by the golden section to 1e-8 of it, where a parabola has come
/// down to round-off.
const SECTIONS: usize = 40;

impl Search<'_, '_> {
    /// As [`turn`](Self::turn), from three points of the same sign, on the cubic, and a fourth where the parabola through
    /// them is lowest.
    pub(super) fn turn_beside(
        &mut self,
        mut points: [(f64, f64); 3],
        theta: f64,
        step: &mut dyn Interpolant,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Bracket>> {
        let lowest = (theta, self.value_at(theta, step, ticker)?);
        // Which of them is nearest to zero is asked of the solution: there the cubic may be off by more than they differ.
        for (theta, value) in &mut points {
            *value = self.value_on_solution(*theta, step, ticker)?;
        }
        let [left, middle, right] = points;
        let passed = if lowest.0 < middle.0 {
            crossings(&[left, lowest, middle, right])
        } else {
            crossings(&[left, middle, lowest, right])
        };
        if !passed.is_empty() {
            return Ok(passed);
        }
        let (from, to) = if lowest.0 < middle.0 { (left, middle) } else { (middle, right) };
        if lowest.1.abs() <= from.1.abs().min(to.1.abs()) {
            return self.turn(from, lowest, to, step, ticker);
        }
        // The parabola was none there: the lowest of the three may still be near a turn.
        if middle.1.abs() <= left.1.abs().min(right.1.abs()) {
            return self.turn(left, middle, right, step, ticker);
        }
        Ok(Vec::new())
    }

    /// Where a function that comes near zero between two points of the same sign passes it: two brackets, or none.
    pub(super) fn turn(
        &mut self,
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
            if outer.0 < inner.0 {
                left = outer
            } else {
                right = outer
            }
            best = inner;
        }
        Ok(Vec::new())
    }
}

/// Where a function of one sign is nearest to zero between three points, if it may come to zero there: the lowest place of
/// the parabola through its sizes, if that is among them, and if it is as near zero as the parabola is bent along the
/// longer of both parts (eight times as near as it would have to be if it were one, and the points evenly spaced).
pub(super) fn turns([(a, left), (b, middle), (c, right)]: [(f64, f64); 3]) -> Option<f64> {
    let one_sign = (left > 0.0 && middle > 0.0 && right > 0.0) || (left < 0.0 && middle < 0.0 && right < 0.0);
    let (left, middle, right) = (left.abs(), middle.abs(), right.abs());
    let (before, after) = ((middle - left) / (b - a), (right - middle) / (c - b));
    let bend = (after - before) / (c - a);
    if !(one_sign && bend > 0.0) {
        return None;
    }
    // The slope at the middle point, and where there is none.
    let slope = before + bend * (b - a);
    let theta = b - 0.5 * slope / bend;
    let longer = (b - a).max(c - b);
    let near = middle - 0.25 * slope * slope / bend <= 2.0 * bend * longer * longer;
    (near && a < theta && theta < c).then_some(theta)
}

#[cfg(test)]
mod tests {
    use super::turns;

    #[test]
    fn a_turn_is_seen_wherever_it_is_between_three_points() {
        for places in
            [[0.0, 0.015625, 0.125], [0.75, 0.875, 0.984375], [0.875, 0.984375, 1.0], [0.25, 0.375, 0.5]]
        {
            for part in 1..100 {
                let at = places[0] + (places[2] - places[0]) * f64::from(part) / 100.0;
                for sign in [1.0, -1.0] {
                    let three = places.map(|x| (x, sign * ((x - at) * (x - at) + 1e-12)));
                    let found = turns(three);
                    assert!(
                        found.is_some_and(|theta| (theta - at).abs() < 1e-9),
                        "{places:?} {at} {found:?}"
                    );
                }
            }
        }
        let line = [0.0, 0.5, 1.0].map(|x| (x, 1.0 + x));
        assert_eq!(turns(line), None);
        let far = [0.0, 0.5, 1.0].map(|x| (x, 10.0 + (x - 0.5) * (x - 0.5)));
        assert_eq!(turns(far), None);
    }
}
