//! Events: zeros of functions of time and state on the way of a run, found where a function changes its sign from one node to
//! the next, and located on the interpolant to round-off. Where it is known how fast a function changes, one that turns back
//! between two nodes is seen, too: its turning point is such a zero.

use super::run::Step;
use crate::error::{Error, Result};
use crate::words::number;

/// When a zero counts, and when it ends the run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Condition {
    /// Only zeros that the function passes upwards (positive) or downwards (negative); 0 for both.
    pub direction: f64,
    /// The run ends with the zero of this number.
    pub last: Option<u64>,
}

/// Functions of time and state.
pub trait Events {
    /// The value of one of them.
    ///
    /// # Errors
    /// Those of the function.
    fn value(&mut self, which: usize, t: f64, y: &[f64]) -> Result<f64>;

    /// How fast it changes along the motion, if that is known.
    fn rate(&mut self, which: usize, t: f64, y: &[f64]) -> Option<f64> {
        let _ = (which, t, y);
        None
    }
}

/// The zeros of one function.
#[derive(Clone, Debug, Default)]
pub struct Zeros {
    /// Their times.
    pub t: Vec<f64>,
    /// The states there, one after another.
    pub y: Vec<f64>,
}

/// Functions under watch from node to node.
#[derive(Clone, Debug)]
pub struct Watch {
    conditions: Vec<Condition>,
    values: Vec<f64>,
    rates: Vec<Option<f64>>,
    /// What was found, function after function.
    pub zeros: Vec<Zeros>,
}

impl Watch {
    /// For functions with these conditions.
    pub fn new(conditions: Vec<Condition>) -> Self {
        let zeros = vec![Zeros::default(); conditions.len()];
        let (values, rates) = (vec![f64::NAN; conditions.len()], vec![None; conditions.len()]);
        Self { values, rates, conditions, zeros }
    }

    /// Takes the values at the start of the run.
    ///
    /// # Errors
    /// Those of the functions.
    pub fn start(&mut self, events: &mut dyn Events, t: f64, y: &[f64]) -> Result<()> {
        for (which, value) in self.values.iter_mut().enumerate() {
            *value = events.value(which, t, y)?;
            self.rates[which] = events.rate(which, t, y);
        }
        Ok(())
    }

    /// Finds the zeros in a step; the time of the one that ends the run, if one does.
    ///
    /// # Errors
    /// Those of the functions and of the interpolant.
    pub fn look(&mut self, events: &mut dyn Events, step: &mut Step<'_, '_>) -> Result<Option<f64>> {
        let mut found: Vec<(f64, usize)> = vec![];
        for which in 0..self.conditions.len() {
            let before = self.values[which];
            let after = events.value(which, step.to, step.end())?;
            let rate = events.rate(which, step.to, step.end());
            let rates = self.rates[which].zip(rate);
            (self.values[which], self.rates[which]) = (after, rate);
            let direction = self.conditions[which].direction;
            if let Some((from, to)) = rates.filter(|&(from, to)| before * from < 0.0 && after * to > 0.0)
                && before * after > 0.0
            {
                let between = turned(events, which, step, [before, after], [from, to])?;
                for (zero, up) in between.into_iter().flatten() {
                    if direction == 0.0 || (direction > 0.0) == up {
                        found.push((zero, which));
                    }
                }
                continue;
            }
            let (up, down) = (before <= 0.0 && after >= 0.0, before >= 0.0 && after <= 0.0);
            // A zero at a node belongs to the step before it, which has told of it.
            let told = before == 0.0 && self.zeros[which].t.last() == Some(&step.from);
            if told || !((up && direction >= 0.0) || (down && direction <= 0.0)) {
                continue;
            }
            let ends = [(step.from, before), (step.to, after)];
            let zero = zero(ends, |t| known(events, which, t, step.at(t)?))?;
            found.push((zero, which));
        }
        let forward = step.from <= step.to;
        found.sort_by(|(a, _), (b, _)| if forward { a.total_cmp(b) } else { b.total_cmp(a) });
        for (t, which) in found {
            let zeros = &mut self.zeros[which];
            zeros.t.push(t);
            zeros.y.extend_from_slice(step.at(t)?);
            if self.conditions[which].last.is_some_and(|last| zeros.t.len() as u64 >= last) {
                return Ok(Some(t));
            }
        }
        Ok(None)
    }
}

/// The value of a function between two places where its signs differ: what is no number there has no zero to be found.
fn known(events: &mut dyn Events, which: usize, t: f64, y: &[f64]) -> Result<f64> {
    let value = events.value(which, t, y)?;
    if value.is_nan() {
        let told =
            format!("event {which} is not a number at t = {}, and has different signs around it", number(t));
        return Err(Error::invalid("events", format!("expected numbers, but {told}; give it a value there")));
    }
    Ok(value)
}

/// The zeros on either side of the place where a function turns back, and whether it passes them upwards; none if it does not
/// reach zero.
fn turned(
    events: &mut dyn Events,
    which: usize,
    step: &mut Step<'_, '_>,
    values: [f64; 2],
    rates: [f64; 2],
) -> Result<[Option<(f64, bool)>; 2]> {
    let turn = zero([(step.from, rates[0]), (step.to, rates[1])], |t| {
        let y = step.at(t)?;
        Ok(events.rate(which, t, y).unwrap_or(f64::NAN))
    })?;
    let there = events.value(which, turn, step.at(turn)?)?;
    if there * values[0] > 0.0 || there.is_nan() {
        return Ok([None; 2]);
    }
    let up = values[0] < 0.0;
    if there == 0.0 {
        return Ok([Some((turn, up)), None]);
    }
    let (from, to) = (step.from, step.to);
    let mut side = |ends| zero(ends, |t| known(events, which, t, step.at(t)?));
    let first = side([(from, values[0]), (turn, there)])?;
    let second = side([(turn, there), (to, values[1])])?;
    Ok([Some((first, up)), Some((second, !up))])
}

/// More are never needed: each halves the interval at least every third time.
const MOST_ITERATIONS: usize = 200;

/// A zero between two points with values of different signs, to round-off: T. R. Chandrupatla, Adv. Eng. Software 28 (1997)
/// 145, which takes inverse quadratic interpolation where that is safe and halves the interval where it is not.
pub(crate) fn zero(
    [(a, at_a), (b, at_b)]: [(f64, f64); 2],
    mut value: impl FnMut(f64) -> Result<f64>,
) -> Result<f64> {
    if at_a == 0.0 {
        return Ok(a);
    }
    if at_b == 0.0 {
        return Ok(b);
    }
    let tolerance = 2.0 * f64::EPSILON * if a.abs() > b.abs() { a.abs() } else { b.abs() };
    let ((mut x1, mut f1), (mut x2, mut f2)) = ((b, at_b), (a, at_a));
    let mut fraction = 0.5;
    for _ in 0..MOST_ITERATIONS {
        let x = x1 + fraction * (x2 - x1);
        let f = value(x)?;
        let (x3, f3);
        if (f < 0.0) == (f1 < 0.0) {
            (x3, f3) = (x1, f1);
        } else {
            (x3, f3) = (x2, f2);
            (x2, f2) = (x1, f1);
        }
        (x1, f1) = (x, f);
        let nearest = if f2.abs() < f1.abs() { x2 } else { x1 };
        let least = tolerance / (x2 - x1).abs();
        if least > 0.5 || f == 0.0 {
            return Ok(if f == 0.0 { x } else { nearest });
        }
        let (place, height) = ((x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2));
        let safe = height * height < place && (1.0 - height) * (1.0 - height) < 1.0 - place;
        fraction = if safe {
            f1 / (f2 - f1) * f3 / (f2 - f3) + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        } else {
            0.5
        };
        fraction = if fraction > least { fraction } else { least };
        fraction = if fraction < 1.0 - least { fraction } else { 1.0 - least };
    }
    Ok(if f2.abs() < f1.abs() { x2 } else { x1 })
}

/// By which the looks before the first sample of a step come nearer to its start, and how many there are.
const NEARER: f64 = 0.125;
const LOOKS: u32 = 16;

/// Of a function that is zero at the start of a step: a point between that and the first sample at which it has the other sign
/// than there. It leaves to that side and is back soon, as what is thrown up from the ground in a step that is long beside its
/// flight. Still nearer to the start it has that sign, too, which rounding would not have made of both; a value that is
/// nothing but rounding may be told as 0.
pub(crate) fn before_the_first(
    first: (f64, f64),
    mut value: impl FnMut(f64) -> Result<f64>,
) -> Result<Option<(f64, f64)>> {
    let mut theta = first.0;
    let mut found = None;
    for _ in 0..LOOKS {
        theta *= NEARER;
        let here = value(theta)?;
        let is_other = (here < 0.0 && first.1 >= 0.0) || (here > 0.0 && first.1 <= 0.0);
        if here == 0.0 || (found.is_some() && !is_other) {
            return Ok(None);
        }
        if found.is_some() {
            return Ok(found);
        }
        if is_other {
            found = Some((theta, here));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_back_before_the_first_sample_is_seen() -> Result<()> {
        let first = 1.0 / 64.0;
        for flight in [1e-3, 1e-6, 1e-9, 3e-12] {
            let thrown = |theta: f64| theta * (flight - theta);
            let found = before_the_first((first, thrown(first)), |theta| Ok(thrown(theta)))?;
            assert!(
                found.is_some_and(|(theta, value)| value > 0.0 && 0.0 < theta && theta < flight),
                "{flight}"
            );
        }
        // What falls from rest, or leaves to the side of the first sample, has not been anywhere else, whatever rounding
        // makes of the first digits.
        let falls = |theta: f64| -theta * theta;
        assert_eq!(before_the_first((first, falls(first)), |theta| Ok(falls(theta)))?, None);
        let mut looks = 0;
        let found = before_the_first((first, falls(first)), |theta| {
            looks += 1;
            Ok(if looks == 7 { 1e-13 } else { falls(theta) })
        })?;
        assert_eq!(found, None);
        Ok(())
    }

    #[test]
    fn zeros_are_located_to_round_off() -> Result<()> {
        type Case = (fn(f64) -> f64, f64, f64, f64);
        let cases: [Case; 5] = [
            (|x| x - 7.0, 5.0, 9.0, 7.0),
            (|x| x * x - 2.0, 0.0, 2.0, core::f64::consts::SQRT_2),
            (|x| x.powi(9), -1.0, 3.0, 0.0),
            (|x| if x < 0.3 { -1e-300 } else { 1e300 }, 0.0, 1.0, 0.3),
            (|x| 1.0 / (x - 4.0) + 2.0, 3.9, 0.0, 3.5),
        ];
        for (function, a, b, exact) in cases {
            let mut calls = 0;
            let found = zero([(a, function(a)), (b, function(b))], |x| {
                calls += 1;
                Ok(function(x))
            })?;
            // A zero of the ninth order is no better known than where its value underflows to nothing beside the rest.
            let slack = if exact == 0.0 { 1e-15 } else { 4.0 * f64::EPSILON * exact };
            assert!((found - exact).abs() <= slack, "{found} for {exact}");
            assert!(calls < 120, "{calls} evaluations for {exact}");
        }
        Ok(())
    }
}
