//! Where a Taylor series leads: states at fractions of a step, and the choice of the step.
//!
//! A step is long, so its increment is formed with care: its first two terms by exact products and sums, what they
//! leave out carried into the compensation of the state.

use super::errors::HUGE;
use crate::numerics::double_double::two_sum;
use crate::numerics::element::{Element, Pair, PairMut, Pass, View};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::real::{Mask, Real};

/// The larger of `square^(1/2n)` of two squares, each with its n; infinite where one is as good as that. And where it is zero.
#[derive(Debug)]
pub(in crate::ode) struct LargestRoot<S> {
    /// The squares.
    pub(in crate::ode) squares: [S; 2],
    /// The orders n.
    pub(in crate::ode) orders: [usize; 2],
}

impl<S: Element> Pass<S> for LargestRoot<S> {
    type Output = (S, S::Mask);
    #[inline(always)]
    fn run<V: View<S>>(self) -> (S, S::Mask) {
        let squares = [V::load(self.squares[0]), V::load(self.squares[1])];
        let root = largest_root(squares, self.orders);
        (root.store(), V::own_mask(root.less_equal(V::zero())))
    }
}

#[inline(always)]
fn largest_root<V: InverseCube>(squares: [V; 2], orders: [usize; 2]) -> V {
    let mut largest = V::zero();
    for which in 0..2 {
        let root = squares[which].rough_power(0.5 / orders[which] as f64);
        let sound = squares[which].less(V::splat(HUGE));
        largest = largest.max(V::select(sound, root, V::splat(f64::INFINITY)));
    }
    largest
}

/// One over the step that the coefficients of two orders allow, in their unit of time, where each number is measured by how
/// far it goes in the step, times a tolerance: that is found from the step, which begins as one unit, and the step from that.
#[derive(Debug)]
pub(in crate::ode) struct OwnInverse<'a, S> {
    /// Blocks of coefficients, from order 0 on.
    pub(in crate::ode) blocks: &'a [S],
    /// Numbers of a block.
    pub(in crate::ode) len: usize,
    /// The two orders.
    pub(in crate::ode) orders: [usize; 2],
    /// The tolerance.
    pub(in crate::ode) tolerance: &'a S,
    /// How many times the step is found.
    pub(in crate::ode) times: usize,
}

impl<S: Element> Pass<S> for OwnInverse<'_, S> {
    /// And where nothing tells of it.
    type Output = (S, S::Mask);
    #[inline(always)]
    fn run<V: View<S>>(self) -> (S, S::Mask) {
        let (blocks, tolerance) = (V::view(self.blocks), V::load(*self.tolerance));
        let (mut step, mut inverse) = (V::one(), V::zero());
        for _ in 0..self.times {
            let squares = own_sizes(blocks, self.len, self.orders, step, tolerance);
            inverse = largest_root(squares, self.orders);
            let found = V::zero().less(inverse).and(inverse.less(V::splat(HUGE)));
            step = V::select(found, V::one() / inverse, step);
        }
        (inverse.store(), V::own_mask(inverse.less_equal(V::zero())))
    }
}

/// Orders that tell how far a number goes. They may all vanish, as of a body that a drive moves from rest: then the largest
/// of those up to the ones that are measured tells, lest what is measured be infinite.
const TELLING: usize = 3;

/// The largest squared ratio of the coefficients of two orders to how far their number goes in a step, times a tolerance.
#[inline(always)]
fn own_sizes<V: Real>(blocks: &[V], len: usize, orders: [usize; 2], step: V, tolerance: V) -> [V; 2] {
    let mut largest = [V::zero(); 2];
    for number in 0..len {
        let (mut size, mut power) = (V::zero(), V::one());
        for order in 1..=TELLING {
            power = power * step;
            size = (blocks[order * len + number] * power).abs().max(size);
        }
        let told = V::zero().less(size);
        if !told.all() {
            let mut later = V::zero();
            for order in TELLING + 1..=orders[1] {
                power = power * step;
                later = (blocks[order * len + number] * power).abs().max(later);
            }
            size = V::select(told, size, later);
        }
        let size = size * tolerance;
        for which in 0..2 {
            let of = blocks[orders[which] * len + number].abs();
            let ratio = V::select(of.less_equal(V::zero()), V::zero(), of / size);
            let square = ratio * ratio;
            // No number is as bad as an infinite one.
            let sound = square.less(V::splat(HUGE));
            largest[which] = V::select(sound, square, V::splat(f64::INFINITY)).max(largest[which]);
        }
    }
    largest
}

/// By how much the rates at the end of a step are not those of the polynomial that led there.
#[derive(Debug)]
pub(in crate::ode) struct Missed<'a, S> {
    /// The rates that were found; afterwards what they differ by, in the unit of time of the coefficients.
    pub(in crate::ode) rates: &'a mut [S],
    /// Blocks of coefficients of what they are the rates of, from order 0 on.
    pub(in crate::ode) blocks: &'a [S],
    /// The highest order.
    pub(in crate::ode) highest: usize,
    /// The step.
    pub(in crate::ode) h: &'a S,
    /// That unit of time.
    pub(in crate::ode) unit: &'a S,
    /// Whether they are accelerations, and the coefficients those of velocities in that unit.
    pub(in crate::ode) second_order: bool,
}

impl<S: Element> Pass<S> for Missed<'_, S> {
    /// The step in that unit; and what it moves a coordinate and a velocity by that misses one.
    type Output = (S, [S; 2]);
    #[inline(always)]
    fn run<V: View<S>>(self) -> (S, [S; 2]) {
        let (rates, blocks) = (V::view_mut(self.rates), V::view(self.blocks));
        let (unit, len) = (V::load(*self.unit), rates.len());
        let x = V::load(*self.h) / unit;
        let moves = if self.second_order { unit * unit } else { unit };
        for (number, rate) in rates.iter_mut().enumerate() {
            let (mut slope, mut power) = (V::zero(), V::one());
            for order in 1..=self.highest {
                slope = (V::splat(order as f64) * blocks[order * len + number]).multiply_add(power, slope);
                power = power * x;
            }
            *rate = *rate * moves - slope;
        }
        let moved = if self.second_order { [x * x, x / unit] } else { [x; 2] };
        (x.store(), [moved[0].store(), moved[1].store()])
    }
}

/// The largest square of how far numbers that miss by so much go astray in a step, against how far they go in it.
#[derive(Debug)]
pub(in crate::ode) struct OwnMissed<'a, S> {
    /// What they miss.
    pub(in crate::ode) missed: &'a [S],
    /// Blocks of coefficients, from order 0 on.
    pub(in crate::ode) blocks: &'a [S],
    /// The highest order.
    pub(in crate::ode) highest: usize,
    /// The step in the unit of time of the coefficients.
    pub(in crate::ode) x: &'a S,
    /// The tolerance.
    pub(in crate::ode) tolerance: &'a S,
}

impl<S: Element> Pass<S> for OwnMissed<'_, S> {
    type Output = S;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S {
        let (missed, blocks) = (V::view(self.missed), V::view(self.blocks));
        let (x, tolerance) = (V::load(*self.x), V::load(*self.tolerance));
        let len = missed.len();
        let in_a_step = (x * x).max(V::one());
        let mut most = V::zero();
        for (number, &missed) in missed.iter().enumerate() {
            let (mut goes, mut power) = (V::zero(), V::one());
            for order in 1..=self.highest {
                power = power * x;
                goes = (blocks[order * len + number] * power).abs().max(goes);
            }
            let missed = missed.abs() * in_a_step;
            let nothing = missed.less_equal(V::zero());
            let ratio = V::select(nothing, V::zero(), missed / (tolerance * goes));
            let square = ratio * ratio;
            let sound = square.less(V::splat(HUGE));
            most = V::select(sound, square, V::splat(f64::INFINITY)).max(most);
        }
        most.store()
    }
}

/// The choice of a step.
#[derive(Debug)]
pub(in crate::ode) struct Choice<'a, S: Real> {
    /// One over the step that the coefficients allow, in their unit of time: infinite if they are no numbers.
    pub(in crate::ode) inverse: &'a S,
    /// That unit, and the shortest that there is.
    pub(in crate::ode) units: [&'a S; 2],
    /// The share of that step that is taken.
    pub(in crate::ode) margin: f64,
    /// The longest step, by two bounds.
    pub(in crate::ode) longest: [&'a S; 2],
    /// The time, and that of the end.
    pub(in crate::ode) times: [&'a S; 2],
    /// The step of the lanes that do not run.
    pub(in crate::ode) h: &'a S,
    /// Those that do.
    pub(in crate::ode) running: S::Mask,
}

impl<S: Element> Pass<S> for Choice<'_, S> {
    /// The step, without its sign and with it, and a squared error that refuses it where it must be.
    type Output = [S; 3];
    #[inline(always)]
    fn run<V: View<S>>(self) -> [S; 3] {
        let (inverse, [unit, least]) =
            (V::load(*self.inverse), [V::load(*self.units[0]), V::load(*self.units[1])]);
        let [now, end] = [V::load(*self.times[0]), V::load(*self.times[1])];
        let zero = V::zero();
        let sound = inverse.less(V::splat(HUGE));
        // The unit of time may be to blame; of the shortest there is, it is not.
        let shorter = V::select(least.less(unit), unit, zero);
        let step = V::select(sound, V::splat(self.margin) * unit / inverse, shorter);
        // What nothing limits goes to the end.
        let span = (end - now).abs();
        let longest = V::load(*self.longest[0]).min(V::load(*self.longest[1]));
        let step = step.min(longest).min(span + span);
        let signed = V::select(end.less(now), -step, step);
        let signed = V::select(V::mask(self.running), signed, V::load(*self.h));
        let size2 = V::select(sound, zero, V::splat(HUGE));
        [step.store(), signed.store(), size2.store()]
    }
}

/// What was expanded in, and whether that must be longer.
#[derive(Debug)]
pub(in crate::ode) struct Expanded<'a, S: Real> {
    /// The squared error that refuses the step, if it must be.
    pub(in crate::ode) size2: &'a S,
    /// The unit of time.
    pub(in crate::ode) unit: &'a S,
    /// The shortest unit that was too long.
    pub(in crate::ode) too_long: &'a S,
    /// The step, without its sign.
    pub(in crate::ode) step: &'a S,
    /// Beyond so many units a step is expanded once more, in a longer one.
    pub(in crate::ode) far: f64,
    /// The lanes that run.
    pub(in crate::ode) running: S::Mask,
}

/// What [`Expanded`] found.
#[derive(Debug)]
pub(in crate::ode) struct Judged<S: Real> {
    /// The shortest unit that was too long.
    pub(in crate::ode) too_long: S,
    /// The squared error that refuses the step, if it must be.
    pub(in crate::ode) size2: S,
    /// Where the coefficients are numbers.
    pub(in crate::ode) sound: S::Mask,
    /// Where the motion is to be expanded once more.
    pub(in crate::ode) again: S::Mask,
}

impl<S: Element> Pass<S> for Expanded<'_, S> {
    type Output = Judged<S>;
    #[inline(always)]
    fn run<V: View<S>>(self) -> Judged<S> {
        let (size2, unit, step) = (V::load(*self.size2), V::load(*self.unit), V::load(*self.step));
        let running = V::mask(self.running);
        let sound = size2.less(V::one());
        let too_long = V::select(sound.or(running.not()), V::load(*self.too_long), unit);
        let again = (V::splat(self.far) * unit).less(step.min(too_long)).and(sound);
        let size2 = V::select(again, V::splat(HUGE), size2);
        Judged {
            too_long: too_long.store(),
            size2: size2.store(),
            sound: V::own_mask(sound),
            again: V::own_mask(again),
        }
    }
}

/// In what the next step is expanded.
#[derive(Debug)]
pub(in crate::ode) struct NextUnit<'a, S: Real> {
    /// The unit of time of this one.
    pub(in crate::ode) unit: &'a S,
    /// The step that its coefficients allowed, and the one that is tried next.
    pub(in crate::ode) steps: [&'a S; 2],
    /// As in [`Expanded`].
    pub(in crate::ode) far: f64,
    /// As in [`Judged`].
    pub(in crate::ode) sound: S::Mask,
    /// As in [`Judged`].
    pub(in crate::ode) again: S::Mask,
    /// The lanes that run.
    pub(in crate::ode) running: S::Mask,
}

impl<S: Element> Pass<S> for NextUnit<'_, S> {
    type Output = S;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S {
        let unit = V::load(*self.unit);
        let [allowed, next] = [V::load(*self.steps[0]), V::load(*self.steps[1])];
        let near = V::select(V::mask(self.sound), allowed, next);
        let next = V::select(V::mask(self.again), V::splat(self.far) * unit, near);
        V::select(V::mask(self.running), next, unit).store()
    }
}

/// `y + (c1 x + c2 x² + …) factor`, compensated, the coefficients being blocks of `len` numbers.
pub(in crate::ode) struct Sum<'a, S> {
    /// The state.
    pub(in crate::ode) y: Pair<'a, S>,
    /// Blocks of coefficients, from order 0 on.
    pub(in crate::ode) blocks: &'a [S],
    /// What the block of order 1 leaves out, if it is known.
    pub(in crate::ode) rest: Option<&'a [S]>,
    /// The highest order, at least 2.
    pub(in crate::ode) highest: usize,
    /// The time.
    pub(in crate::ode) t: &'a S,
    /// The unit of time of the coefficients, a power of two.
    pub(in crate::ode) unit: &'a S,
    /// Whether they are velocities in that unit: the factor is then one over it, else one.
    pub(in crate::ode) velocities: bool,
    /// The result.
    pub(in crate::ode) into: PairMut<'a, S>,
}

impl<S: Element> Pass<S> for Sum<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let (y, e) = V::pair(self.y);
        let (into, into_e) = V::pair_mut(self.into);
        let unit = V::load(*self.unit);
        let sum = Sums {
            blocks: V::view(self.blocks),
            len: y.len(),
            highest: self.highest,
            x: V::load(*self.t) / unit,
            factor: if self.velocities { V::one() / unit } else { V::one() },
        };
        let rest = match self.rest {
            Some(rest) => V::view(rest),
            None => &[],
        };
        let mut start = 0;
        macro_rules! groups {
            ($($size:literal)+) => {$(
                while y.len() - start >= $size {
                    let increments = sum.increments::<$size>(start, rest);
                    for g in 0..$size {
                        let (high, low) = increments[g];
                        let (value, error) = two_sum(y[start + g], high);
                        let low = error + (low + e[start + g]);
                        into[start + g] = value + low;
                        into_e[start + g] = low - (into[start + g] - value);
                    }
                    start += $size;
                }
            )+};
        }
        groups!(6 3 2 1);
    }
}

struct Sums<'a, V> {
    blocks: &'a [V],
    len: usize,
    highest: usize,
    x: V,
    factor: V,
}

impl<V: Real> Sums<'_, V> {
    /// Of `G` numbers from `start` on, each with what it leaves out.
    #[inline(always)]
    fn increments<const G: usize>(&self, start: usize, rest: &[V]) -> [(V, V); G] {
        let Self { blocks, len, highest, x, factor } = *self;
        let mut tails = [V::zero(); G];
        let mut order = highest;
        while order > 1 {
            let block = &blocks[order * len + start..][..G];
            for g in 0..G {
                tails[g] = if order == highest { block[g] } else { tails[g].multiply_add(x, block[g]) };
            }
            order -= 1;
        }
        let mut increments = [(V::zero(), V::zero()); G];
        let first = &blocks[len + start..][..G];
        for g in 0..G {
            let (second, second_rest) = product(tails[g], x);
            let (sum, sum_rest) = two_sum(first[g], second);
            let mut low = sum_rest + second_rest;
            if !rest.is_empty() {
                low += rest[start + g];
            }
            let (high, product_rest) = product(sum, x);
            let low = low.multiply_add(x, product_rest);
            increments[g] = (high * factor, low * factor);
        }
        increments
    }
}

/// `a * b` exactly, as a product and what it leaves out.
#[inline(always)]
fn product<V: Real>(a: V, b: V) -> (V, V) {
    let product = a * b;
    (product, a.multiply_add(b, -product))
}

/// The nested terms `f` of `y(θ) = y + θ(f0 + (1-θ)(f1 + θ(f2 + …)))` from the coefficients of θ, θ², …, in place.
pub(in crate::ode) fn nest<S: Real>(coefficients: &mut [S]) {
    for start in (0..coefficients.len()).step_by(2) {
        // At θ = 1 it is the sum, and the other factor's coefficients are sums of those after; at θ = 0 it is the first.
        let rest = &mut coefficients[start..];
        for index in (1..rest.len()).rev() {
            rest[index - 1] += rest[index];
        }
        for later in &mut rest[1..] {
            *later = -*later;
        }
    }
}
