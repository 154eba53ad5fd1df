//! How far an expression may go in a step: bounds of its value and of its rate over where the motion leads, of one step or of
//! eight side by side.
//!
//! The one idea: between its ends a function stays above what its rate may take from it, so that an expression is looked at
//! more closely only near its zeros. Bounds over a wider region hold for some steps more, which cost a comparison then.

use super::expression::{Formula, accelerations};
use crate::expressions::bounds::{Between, Bounds};
use crate::expressions::execute::Scalar;
use crate::numerics::real::{Mask, Real};
use std::sync::Arc;

/// How far a motion may leave the coefficients of the polynomials through both ends of a step, as a part of their range, …
const BEYOND: f64 = 0.5;
/// … and accelerations, which are known less well, as a part of themselves.
const OFF: f64 = 0.0625;
/// How much farther a region goes that is looked at for the steps to come: …
const WIDER: f64 = 4.0;
/// … at least, and at most.
const WIDEST: [f64; 2] = [1.0, 32.0];
/// So many steps go by before that is tried again where it tells too little.
const WAIT: u32 = 16;

/// Bounds at work. The numbers hold, one after another: two for each coordinate, velocity, acceleration and the time of the step
/// at hand, the same for the region that is known, the bounds in force, those of that region, and room.
#[derive(Clone, Debug)]
pub(crate) struct Reach {
    bounds: Arc<Bounds>,
    coordinates: usize,
    looks_at_velocities: bool,
    /// How much wider than a step the next region is to be.
    wider: f64,
    /// How many steps go by before there is one.
    wait: u32,
    /// Whether the bounds in force are those of the region, and whether the last ones have told too little.
    of_region: bool,
    too_wide: bool,
}

/// Bounds of value and rate.
type Both<S> = [Between<S>; 2];

/// The parts of the numbers.
struct Parts<'a, S> {
    here: &'a mut [S],
    region: &'a mut [S],
    told: &'a mut [S],
    known: &'a mut [S],
    room: &'a mut [S],
}

impl Reach {
    /// Of an expression, if it has bounds.
    pub(crate) fn of(formula: &Formula) -> Option<Self> {
        Some(Self {
            bounds: formula.bounds.clone()?,
            coordinates: formula.coordinates.len(),
            looks_at_velocities: formula.looks_at_velocities,
            wider: WIDER,
            wait: 0,
            of_region: false,
            too_wide: false,
        })
    }

    /// The numbers that it works with.
    pub(crate) fn numbers<S: Real>(&self) -> Vec<S> {
        let mut numbers = vec![S::zero(); 2 * self.places() + 8 + self.bounds.room()];
        // A region that holds nothing.
        numbers[self.places()..2 * self.places()].fill(S::splat(f64::NAN));
        numbers
    }

    /// Two for each coordinate, velocity and acceleration, and the time.
    fn places(&self) -> usize {
        2 * (3 * self.coordinates + 1)
    }

    #[inline(always)]
    fn parts<'a, S>(&self, numbers: &'a mut [S]) -> Parts<'a, S> {
        let (here, rest) = numbers.split_at_mut(self.places());
        let (region, rest) = rest.split_at_mut(self.places());
        let (told, rest) = rest.split_at_mut(4);
        let (known, room) = rest.split_at_mut(4);
        Parts { here, region, told, known, room }
    }

    /// Comes to a step `h` between two times, from what the expression looks at at both ends.
    #[inline(always)]
    pub(crate) fn come<S: Scalar>(
        &self,
        numbers: &mut [S],
        (times, [before, after]): ([S; 2], [&[S]; 2]),
        h: S,
    ) {
        let n = self.coordinates;
        let (third, three) = (h * S::splat(1.0 / 3.0), S::splat(3.0) / h);
        for index in 0..n {
            let (x0, x1, v0, v1) = (before[index], after[index], before[n + index], after[n + index]);
            let (a, b) = (x0 + third * v0, x1 - third * v1);
            let place = around([x0.min(a).min(b.min(x1)), x0.max(a).max(b.max(x1))], S::zero());
            numbers[2 * index..2 * index + 2].copy_from_slice(&place);
            let middle = three * (x1 - x0) - v0 - v1;
            let velocity = around([v0.min(middle).min(v1), v0.max(middle).max(v1)], S::zero());
            numbers[2 * (n + index)..2 * (n + index) + 2].copy_from_slice(&velocity);
            if self.looks_at_velocities {
                let [a, b] = accelerations([x0, x1], [v0, v1], h);
                let off = S::splat(OFF) * a.abs().max(b.abs());
                let acceleration = around([a.min(b), a.max(b)], off);
                numbers[2 * (2 * n + index)..2 * (2 * n + index) + 2].copy_from_slice(&acceleration);
            }
        }
        let [from, to] = times;
        numbers[6 * n..6 * n + 2].copy_from_slice(&[from.min(to), from.max(to)]);
    }

    /// Those lanes of these in whose step the expression may be zero for all that bounds of its value tell.
    #[inline(always)]
    pub(crate) fn may_be_zero<S: Scalar>(&mut self, numbers: &mut [S], lanes: S::Mask) -> S::Mask {
        let places = self.places();
        let mut held = S::Mask::splat(true);
        for (here, region) in
            numbers[..places].chunks_exact(2).zip(numbers[places..2 * places].chunks_exact(2))
        {
            held = held.and(region[0].less_equal(here[0])).and(here[1].less_equal(region[1]));
        }
        self.of_region = held.or(lanes.not()).all();
        if !self.of_region && self.wait == 0 {
            self.widen(numbers);
        }
        let Parts { here, told, known, room, .. } = self.parts(numbers);
        if self.of_region {
            told.copy_from_slice(known);
        } else {
            self.wait = self.wait.saturating_sub(1);
            find(&self.bounds, here, told, room);
        }
        lanes.and(is_not_zero([told[0], told[1]]).not())
    }

    /// Looks at a region around the step.
    #[inline(always)]
    fn widen<S: Scalar>(&mut self, numbers: &mut [S]) {
        if !core::mem::replace(&mut self.too_wide, false) {
            self.wider = (2.0 * self.wider).min(WIDEST[1]);
        }
        let wider = S::splat(self.wider);
        let Parts { here, region, known, room, .. } = self.parts(numbers);
        for (here, region) in here.chunks_exact(2).zip(region.chunks_exact_mut(2)) {
            let beyond = wider * (here[1] - here[0]);
            (region[0], region[1]) = (here[0] - beyond, here[1] + beyond);
        }
        find(&self.bounds, region, known, room);
        self.of_region = true;
    }

    /// Those lanes of these in whose step `h` it may be zero by its values at both ends, too.
    #[inline(always)]
    pub(crate) fn may_still<S: Scalar>(
        &mut self,
        numbers: &mut [S],
        lanes: S::Mask,
        ends: [S; 2],
        h: S,
    ) -> S::Mask {
        let same = (S::zero().less(ends[0]).and(S::zero().less(ends[1])))
            .or(ends[0].less(S::zero()).and(ends[1].less(S::zero())));
        let Parts { here, region, told, room, .. } = self.parts(numbers);
        let mut unsettled = lanes.and(same).and(stays(told, ends, h).not());
        if self.of_region && unsettled.any() {
            find(&self.bounds, here, told, room);
            unsettled = unsettled.and(is_not_zero([told[0], told[1]]).or(stays(told, ends, h)).not());
            // The next one is to be smaller.
            region.fill(S::splat(f64::NAN));
            self.too_wide = true;
            self.wait = if self.wider > WIDEST[0] { 0 } else { WAIT };
            self.wider = (0.5 * self.wider).max(WIDEST[0]);
        }
        lanes.and(same.not()).or(unsettled)
    }
}

/// What is told of a part of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Told {
    /// The expression is nowhere zero.
    Clear,
    /// It rises, or falls, from one sign to the other.
    Crosses,
    /// It may do anything.
    Unknown,
}

impl Reach {
    /// What it does in the step `h` that was come to, and in that alone.
    pub(crate) fn told(&self, numbers: &mut [f64], ends: [f64; 2], h: f64) -> Told {
        let Parts { here, told, room, .. } = self.parts(numbers);
        find(&self.bounds, here, told, room);
        let keeps_sign = ends[0] * ends[1] > 0.0;
        if is_not_zero([told[0], told[1]]) || (keeps_sign && stays(told, ends, h)) {
            Told::Clear
        } else if !keeps_sign && (told[2] > 0.0 || told[3] < 0.0) {
            Told::Crosses
        } else {
            Told::Unknown
        }
    }
}

/// From the least to the greatest, and beyond.
#[inline(always)]
fn around<S: Real>([low, high]: Between<S>, off: S) -> Between<S> {
    let beyond = S::splat(BEYOND) * (high - low) + off;
    [low - beyond, high + beyond]
}

/// Bounds of value and rate over a region.
#[inline(always)]
fn find<S: Scalar>(bounds: &Bounds, region: &[S], into: &mut [S], room: &mut [S]) {
    room[..region.len()].copy_from_slice(region);
    bounds.find(room);
    let found: Both<S> = [bounds.root(0, room), bounds.root(1, room)];
    into.copy_from_slice(found.as_flattened());
}

#[inline(always)]
fn is_not_zero<S: Real>([low, high]: Between<S>) -> S::Mask {
    S::zero().less(low).or(high.less(S::zero()))
}

/// Whether what has one sign at both ends of a step `h` keeps it between, with a rate in these bounds: it falls from the one no
/// lower than the lines of the steepest descent from both meet.
#[inline(always)]
fn stays<S: Real>(told: &[S], [start, end]: [S; 2], h: S) -> S::Mask {
    let is_below = start.less(S::zero());
    let (a, b) = (h * told[2], h * told[3]);
    let (low, high) = (a.min(b), a.max(b));
    // Differences: they are compiled in place.
    let (under, over) = (S::zero() - high, S::zero() - low);
    let (low, high) = (S::select(is_below, under, low), S::select(is_below, over, high));
    let (start, end) = (start.abs(), end.abs());
    let meet = high * start - low * end + low * high;
    S::zero().less_equal(low).or(high.less_equal(S::zero())).or(S::zero().less(meet))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_stays_is_nowhere_zero(
            start in -1.0..1.0_f64, parts in prop::collection::vec(0.0..1.0_f64, 1..12),
            slopes in [-3.0..3.0_f64, -3.0..3.0], backwards in proptest::bool::ANY,
        ) {
            // Any broken line whose slopes are in the bounds.
            let [low, high] = [slopes[0].min(slopes[1]), slopes[0].max(slopes[1])];
            let step = if backwards { -1.0 } else { 1.0 } / parts.len() as f64;
            let mut values = vec![start];
            for part in &parts {
                values.push(values[values.len() - 1] + step * (low + part * (high - low)));
            }
            let ends = [start, values[parts.len()]];
            if ends[0] * ends[1] > 0.0 && stays(&[-1.0, 1.0, low, high], ends, step * parts.len() as f64) {
                prop_assert!(values.iter().all(|value| value * start > 0.0), "{values:?}");
            }
        }
    }

    #[test]
    fn what_is_far_from_zero_stays_and_what_may_turn_there_does_not() {
        let told = |low: f64, high: f64| [-1.0, 1.0, low, high];
        assert!(stays(&told(-1.0, 1.0), [0.6, 0.6], 1.0) && !stays(&told(-1.0, 1.0), [0.4, 0.4], 1.0));
        assert!(stays(&told(-1.0, 1.0), [-0.6, -0.6], -1.0) && !stays(&told(-1.0, 1.0), [-0.4, -0.4], 1.0));
        // It rises from the start, and backwards falls to the end.
        assert!(stays(&told(0.0, 9.0), [1e-9, 3.0], 1.0) && stays(&told(0.1, 9.0), [3.0, 1e-9], -1.0));
        assert!(!stays(&told(f64::NEG_INFINITY, f64::INFINITY), [1.0, 1.0], 1.0));
    }
}
