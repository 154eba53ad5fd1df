//! Where a Taylor series leads: states at fractions of a step, and the choice of the step.
//!
//! A step is long, so its increment is formed with care: its first two terms by exact products and sums, what they
//! leave out carried into the compensation of the state.

use super::errors::HUGE;
use crate::numerics::double_double::two_sum;
use crate::numerics::element::{Element, Pair, PairMut, Pass, View};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::real::{Mask, Real};

/// The larger of `square^(1/2n)` of two squares, each with its n; infinite where one is as good as that.
#[inline(always)]
pub(super) fn largest_root<V: InverseCube>(squares: [V; 2], orders: [usize; 2]) -> V {
    let mut largest = V::zero();
    for which in 0..2 {
        let root = squares[which].rough_power(0.5 / orders[which] as f64);
        let sound = squares[which].less(V::splat(HUGE));
        largest = largest.max(V::select(sound, root, V::splat(f64::INFINITY)));
    }
    largest
}

/// One over the step that coefficients allow, in their unit of time, where each number is measured by how far it goes in the
/// step, times a tolerance: that is found from the step, which begins as one unit, and the step from that.
#[derive(Debug)]
pub(in crate::ode) struct Numbers<'a, S> {
    /// Blocks of coefficients, from order 0 on.
    pub(in crate::ode) blocks: &'a [S],
    /// Numbers of a block.
    pub(in crate::ode) len: usize,
    /// The tolerance.
    pub(in crate::ode) tolerance: &'a S,
    /// How many times the step is found.
    pub(in crate::ode) times: usize,
}

impl<S: Element> Numbers<'_, S> {
    /// Of the coefficients of two orders.
    #[inline(always)]
    pub(super) fn inverse_step<V: View<S>>(&self, orders: [usize; 2]) -> V {
        let (blocks, tolerance) = (V::view(self.blocks), V::load(*self.tolerance));
        let (mut step, mut inverse) = (V::one(), V::zero());
        for _ in 0..self.times {
            let squares = own_sizes(blocks, self.len, orders, step, tolerance);
            inverse = largest_root(squares, orders);
            let found = V::zero().less(inverse).and(inverse.less(V::splat(HUGE)));
            step = V::select(found, V::one() / inverse, step);
        }
        inverse
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
    /// The result.
    pub(in crate::ode) into: PairMut<'a, S>,
}

/// Sums of all numbers of a state, or of coordinates and then of velocities.
pub(in crate::ode) struct Both<'a, S>(pub(in crate::ode) Sum<'a, S>, pub(in crate::ode) Option<Sum<'a, S>>);

/// The state so long after an expansion.
pub(in crate::ode) struct Sums<'a, S> {
    /// Of what.
    pub(in crate::ode) of: Both<'a, S>,
    /// The time since then, and one over the unit of the coefficients, a power of two.
    pub(in crate::ode) times: [&'a S; 2],
}

impl<S: Element> Pass<S> for Sums<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        self.of.write(V::load(*self.times[0]), V::load(*self.times[1]));
    }
}

impl<S: Element> Both<'_, S> {
    /// So long after an expansion; one over the unit of the coefficients is told.
    #[inline(always)]
    pub(super) fn write<V: View<S>>(self, time: V, per_unit: V) {
        let x = time * per_unit;
        let (mut of, mut further, mut factor) = (self.0, self.1, V::one());
        loop {
            of.write(x, factor);
            let Some(velocities) = further.take() else { return };
            (of, factor) = (velocities, per_unit);
        }
    }
}

impl<S: Element> Sum<'_, S> {
    #[inline(always)]
    fn write<V: View<S>>(self, x: V, factor: V) {
        let (y, e) = V::pair(self.y);
        let (into, into_e) = V::pair_mut(self.into);
        let sum =
            Polynomials { blocks: V::view(self.blocks), len: y.len(), highest: self.highest, x, factor };
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

struct Polynomials<'a, V> {
    blocks: &'a [V],
    len: usize,
    highest: usize,
    x: V,
    factor: V,
}

impl<V: Real> Polynomials<'_, V> {
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

/// The nested terms, as of [`nest`], of all numbers, from coefficients of the time since an expansion.
pub(in crate::ode) struct Nested<'a, S> {
    /// Blocks of coefficients, from order 0 on, which is left out.
    pub(in crate::ode) blocks: &'a [S],
    /// The step that was tried, that of which they are to be, and the unit of the coefficients.
    pub(in crate::ode) times: [&'a S; 3],
    /// Numbers of a block.
    pub(in crate::ode) len: usize,
    /// Blocks of terms.
    pub(in crate::ode) into: &'a mut [S],
}

impl<S: Element> Pass<S> for Nested<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let Self { blocks, times: [tried, h, unit], len, into } = self;
        let (blocks, into, unit) = (V::view(blocks), V::view_mut(into), V::load(*unit));
        let (ratio, mut power) = (V::load(*tried) / unit, V::load(*h) / unit);
        for (into, block) in into.chunks_exact_mut(len).zip(blocks[len..].chunks_exact(len)) {
            for (into, coefficient) in into.iter_mut().zip(block) {
                *into = *coefficient * power;
            }
            power = power * ratio;
        }
        let mut start = 0;
        while len - start >= 3 {
            nest_numbers::<V, 3>(into, (len, start));
            start += 3;
        }
        while len > start {
            nest_numbers::<V, 1>(into, (len, start));
            start += 1;
        }
    }
}

/// As [`nest`], of `G` numbers of blocks from one on.
#[inline(always)]
fn nest_numbers<V: Real, const G: usize>(blocks: &mut [V], (len, start): (usize, usize)) {
    let terms = blocks.len() / len;
    let mut first = 0;
    while first + 1 < terms {
        let mut sums = [V::zero(); G];
        sums.copy_from_slice(&blocks[(terms - 1) * len + start..][..G]);
        for index in (first..terms - 1).rev() {
            let (before, after) = blocks[index * len + start..].split_at_mut(len);
            for g in 0..G {
                after[g] = -sums[g];
                sums[g] = before[g] + sums[g];
            }
        }
        blocks[first * len + start..][..G].copy_from_slice(&sums);
        first += 2;
    }
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
