//! The clock of a run that chooses its own steps, and the choice of the next step, lane by lane.
//!
//! The one idea: whether a step was good enough, how long the next one is and what time it is are a few dozen
//! operations on one number per lane, the same in every lane, so they run in the tier's registers like the rest.
//! Step control: Hairer, Nørsett & Wanner, *Solving ODE I*, II.4.

use crate::numerics::double_double::{DoubleDouble, two_sum};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::tiered;

/// By what a step may change from one to the next, unless it is said otherwise (the values of DOP853).
const SHRINK: f64 = 1.0 / 3.0;
const GROW: f64 = 6.0;
/// What is left of the step that would just do.
const SAFETY: f64 = 0.9;
/// A step below this many units in the last place of the elapsed time is no step.
const SMALLEST_STEP: f64 = 4.0 * f64::EPSILON;

/// Everything about time that is one number per lane.
#[derive(Clone, Copy, Debug)]
pub struct Clock<S: Real> {
    /// Elapsed time, and what it leaves out.
    pub elapsed: S,
    error: S,
    /// The next step, signed.
    pub h: S,
    /// The end, as elapsed time.
    pub end: S,
    /// Lanes whose last step was rejected.
    rejected: S::Mask,
}

/// What a step did, lane by lane.
#[derive(Clone, Copy, Debug)]
pub struct Settled<S: Real> {
    /// The state moved.
    pub accepted: S::Mask,
    /// The end is reached.
    pub finished: S::Mask,
    /// The step fell to zero.
    pub stuck: S::Mask,
    /// Elapsed time before the step.
    pub from: S,
    /// Its length.
    pub h: S,
}

/// What the choice of a step rests on, for a whole run.
#[derive(Clone, Copy, Debug)]
pub struct Rule<S> {
    /// The step goes with the squared scaled error to the power of minus this, as a binary fraction of
    /// [`POWER_PLACES`] places: of a method with the error exponent n, 1/(2n).
    power: u32,
    /// Longest step.
    pub max_step: S,
    /// The least and the most that a step is multiplied with.
    pub limits: (f64, f64),
}

/// Places of the power that the step goes with. They tell 1/(2n) to 1.2e-4, which a step never feels: errors of 1e-12
/// change it by less than 0.4 %.
const POWER_PLACES: u32 = 12;

impl<S> Rule<S> {
    /// Of an estimate that goes with the step to the power `error_exponent`.
    pub fn new(error_exponent: u32, max_step: S) -> Self {
        let power = ((1 << POWER_PLACES) + error_exponent) / (2 * error_exponent);
        Self { power, max_step, limits: (SHRINK, GROW) }
    }
}

impl<S: Real> Clock<S> {
    /// At the start of a run that ends at `end`.
    pub fn new(end: S) -> Self {
        let zero = S::zero();
        Self { elapsed: zero, error: zero, h: zero, end, rejected: S::Mask::splat(false) }
    }

    /// As new in the lanes of the mask.
    pub fn restart(&mut self, lanes: S::Mask, end: S) {
        let fresh = Self::new(end);
        self.elapsed = S::select(lanes, fresh.elapsed, self.elapsed);
        self.error = S::select(lanes, fresh.error, self.error);
        self.h = S::select(lanes, fresh.h, self.h);
        self.end = S::select(lanes, fresh.end, self.end);
        self.rejected = self.rejected.and(lanes.not());
    }

    /// Counts time anew in the lanes of the mask, up to `end`; the next step stays what it is.
    #[inline]
    pub fn recount(&mut self, lanes: S::Mask, end: S) {
        self.elapsed = S::select(lanes, S::zero(), self.elapsed);
        self.error = S::select(lanes, S::zero(), self.error);
        self.end = S::select(lanes, end, self.end);
    }

    /// Makes the next step at most so long.
    #[inline]
    pub(super) fn shorten(&mut self, longest: S) {
        let shorter = S::select(self.h.less(S::zero()), -longest, longest);
        self.h = S::select(longest.less(self.h.abs()), shorter, self.h);
    }

    /// In registers.
    #[inline(always)]
    pub(super) fn load<V: View<S>>(&self) -> Clock<V> {
        // Not `map`, which may be compiled without the tier's instructions.
        Clock {
            elapsed: V::load(self.elapsed),
            error: V::load(self.error),
            h: V::load(self.h),
            end: V::load(self.end),
            rejected: V::mask(self.rejected),
        }
    }

    /// Back from registers.
    #[inline(always)]
    fn store<V: View<S>>(&mut self, now: Clock<V>) {
        *self = Self {
            elapsed: now.elapsed.store(),
            error: now.error.store(),
            h: now.h.store(),
            end: now.end.store(),
            rejected: V::mask_in_memory(now.rejected),
        };
    }

    /// The next step of the running lanes, 0 in the others, and whether it leads to the end.
    #[inline(always)]
    pub(super) fn next_step(&self, running: S::Mask) -> (S, S::Mask) {
        let remaining = (self.end - self.elapsed) - self.error;
        // A last step a little longer than planned beats a last step of nothing.
        let last = remaining.abs().less_equal(self.h.abs() * S::splat(1.0 + 1e-9));
        (S::select(running, S::select(last, remaining, self.h), S::zero()), last)
    }

    /// Moves on by a step that has taken so long (and what that leaves out), to the end at most; `forward` has the sign of time.
    /// A step that time does not feel, or that goes back, is none.
    #[inline(always)]
    fn pass(&mut self, running: S::Mask, (taken, rest): (S, S), forward: S) -> Settled<S> {
        let remaining = (self.end - self.elapsed) - self.error;
        let from = self.elapsed;
        let (elapsed, error) = two_sum(self.elapsed, (self.error + rest) + taken);
        // What comes so near to the end that no time is left but what rounding leaves out is there.
        let there = (self.end - elapsed).abs().less_equal(S::zero());
        let last = remaining.abs().less_equal(taken.abs()).or(there);
        let h = S::select(running, S::select(last, remaining, taken), S::zero());
        let smallest = (S::splat(SMALLEST_STEP) * from.abs()).max(S::splat(f64::MIN_POSITIVE));
        let along = S::select(forward.less(S::zero()), -taken, taken);
        let accepted = smallest.less(along).and(running);
        self.h = S::select(accepted, taken, self.h);
        self.elapsed = S::select(accepted, S::select(last, self.end, elapsed), self.elapsed);
        self.error = S::select(accepted, S::select(last, S::zero(), error), self.error);
        let (finished, stuck) = (accepted.and(last), accepted.not().and(running));
        Settled { accepted, finished, stuck, from, h }
    }

    /// Moves on by the step if its squared scaled error is at most 1, and chooses the next one.
    #[inline(always)]
    fn settle(&mut self, running: S::Mask, size2: S, rule: &Rule<S>) -> Settled<S> {
        let (h, last) = self.next_step(running);
        let accepted = size2.less_equal(S::one()).and(running);

        let (shrink, grow) = (S::splat(rule.limits.0), S::splat(rule.limits.1));
        let perfect = size2.less_equal(S::zero());
        let factor = if perfect.all() {
            grow
        } else {
            let factor = (S::splat(SAFETY) / root(size2, rule)).max(shrink).min(grow);
            S::select(perfect, grow, factor)
        };
        let factor = S::select(self.rejected.or(accepted.not()), factor.min(S::one()), factor);
        let from = self.elapsed;
        let (proposed, max_step) = (h * factor, rule.max_step);
        let longest = S::select(proposed.less(S::zero()), -max_step, max_step);
        let proposed = S::select(max_step.less(proposed.abs()), longest, proposed);
        self.h = S::select(running, proposed, self.h);
        self.rejected = accepted.not().and(running);

        let (elapsed, error) = two_sum(self.elapsed, self.error + h);
        self.elapsed = S::select(accepted, S::select(last, self.end, elapsed), self.elapsed);
        self.error = S::select(accepted, S::select(last, S::zero(), error), self.error);
        let finished = accepted.and(last);
        let smallest = (S::splat(SMALLEST_STEP) * self.elapsed.abs()).max(S::splat(f64::MIN_POSITIVE));
        let stuck = self.h.abs().less_equal(smallest).and(running).and(finished.not());
        Settled { accepted, finished, stuck, from, h }
    }
}

impl<S: Real> Settled<S> {
    #[inline(always)]
    fn stored<V: View<S>>(of: &Settled<V>) -> Self {
        Self {
            accepted: V::mask_in_memory(of.accepted),
            finished: V::mask_in_memory(of.finished),
            stuck: V::mask_in_memory(of.stuck),
            from: of.from.store(),
            h: of.h.store(),
        }
    }
}

/// Moves a clock on by a step that has taken so long.
pub(super) struct Passing<'a, S: Real> {
    pub(super) clock: &'a mut Clock<S>,
    pub(super) running: S::Mask,
    /// How long, and what that leaves out.
    pub(super) taken: &'a (S, S),
    /// With the sign of time.
    pub(super) forward: &'a S,
}

impl<S: Element> Pass<S> for Passing<'_, S> {
    type Output = Settled<S>;
    #[inline(always)]
    fn run<V: View<S>>(self) -> Settled<S> {
        let mut now = self.clock.load::<V>();
        let settled = now.pass(V::mask(self.running), V::scaled(self.taken), V::load(*self.forward));
        self.clock.store(now);
        Settled::stored(&settled)
    }
}

/// `square^(1 / (2·error_exponent))`: the product of the repeated square roots that the power, in binary, names.
#[inline(always)]
pub(super) fn root<S: Real>(square: S, rule: &Rule<S>) -> S {
    let (mut root, mut product, mut left) = (square, S::one(), rule.power);
    let mut place = POWER_PLACES;
    while left != 0 && place > 0 {
        root = root.sqrt();
        place -= 1;
        if left >> place != 0 {
            product = product * root;
            left -= 1 << place;
        }
    }
    product
}

/// Scalars whose steps can be controlled.
pub trait Controlled: Element {
    /// The next step of the running lanes, 0 in the others.
    fn next_step(clock: &Clock<Self>, running: Self::Mask) -> Self;
    /// Moves the clock on by that step if its squared scaled error is at most 1, and chooses the next one.
    fn settle(clock: &mut Clock<Self>, running: Self::Mask, size2: Self, rule: &Rule<Self>) -> Settled<Self>;
    /// The largest of the lanes, in every lane.
    #[must_use]
    fn largest_lane(self) -> Self;
    /// The sum of the lanes, in every lane.
    #[must_use]
    fn sum_of_lanes(self) -> Self;
    /// The first lane, as a double.
    fn first_lane(self) -> f64;
    /// A lane, as a double.
    fn lane(&self, lane: usize) -> f64;
    /// The same with another number in a lane.
    #[must_use]
    fn with_lane(self, lane: usize, number: f64) -> Self;
    /// How many there are.
    const LANES: usize;
}

macro_rules! controlled {
    ($($type:ty)+) => {$(
        impl Controlled for $type {
            #[inline(always)]
            fn next_step(clock: &Clock<Self>, running: bool) -> Self {
                clock.next_step(running).0
            }
            #[inline(always)]
            fn settle(clock: &mut Clock<Self>, running: bool, size2: Self, rule: &Rule<Self>) -> Settled<Self> {
                clock.settle(running, size2, rule)
            }
            #[inline(always)]
            fn largest_lane(self) -> Self {
                self
            }
            fn sum_of_lanes(self) -> Self {
                self
            }
            fn first_lane(self) -> f64 {
                DoubleDouble::from(self).to_f64()
            }
            fn lane(&self, _: usize) -> f64 {
                self.first_lane()
            }
            fn with_lane(self, _: usize, number: f64) -> Self {
                Self::splat(number)
            }
            const LANES: usize = 1;
        }
    )+};
}
controlled!(f64 DoubleDouble);

#[inline(always)]
fn next_step_lanes<V: Vector8 + InverseCube>(clock: &Clock<Lanes>, running: Bits) -> Lanes {
    clock.load::<V>().next_step(running).0.store()
}

#[inline(always)]
fn settle_lanes<V: Vector8 + InverseCube>(
    clock: &mut Clock<Lanes>,
    running: Bits,
    size2: Lanes,
    rule: &Rule<Lanes>,
) -> Settled<Lanes> {
    let mut now = clock.load::<V>();
    let rule = Rule { power: rule.power, max_step: Vector8::load(rule.max_step), limits: rule.limits };
    let settled = now.settle(running, Vector8::load(size2), &rule);
    clock.store(now);
    Settled::stored(&settled)
}

tiered! {
    fn next_step_tier[][](clock: &Clock<Lanes>, running: Bits) -> Lanes = next_step_lanes;
    fn settle_tier[][](clock: &mut Clock<Lanes>, running: Bits, size2: Lanes, rule: &Rule<Lanes>) -> Settled<Lanes> = settle_lanes;
}

impl Controlled for Lanes {
    fn next_step(clock: &Clock<Self>, running: Bits) -> Self {
        next_step_tier(clock, running)
    }
    fn settle(clock: &mut Clock<Self>, running: Bits, size2: Self, rule: &Rule<Self>) -> Settled<Self> {
        settle_tier(clock, running, size2, rule)
    }
    #[inline(always)]
    fn largest_lane(self) -> Self {
        let [a, b, c, d, e, f, g, h] = self.0;
        let low = Real::max(Real::max(a, b), Real::max(c, d));
        let high = Real::max(Real::max(e, f), Real::max(g, h));
        Self::splat(Real::max(low, high))
    }
    fn sum_of_lanes(self) -> Self {
        Self::splat(self.0.iter().sum())
    }
    fn first_lane(self) -> f64 {
        self.0[0]
    }
    fn lane(&self, lane: usize) -> f64 {
        self.0[lane]
    }
    fn with_lane(mut self, lane: usize, number: f64) -> Self {
        self.0[lane] = number;
        self
    }
    const LANES: usize = WIDTH;
}

#[cfg(test)]
mod tests;
