//! How good a step by a series is: its last coefficients, and its rates at the end, beside what each vector of the state may be
//! off.
//!
//! The one idea: what a vector may be off is found once for a step, before its coefficients, which a processor waits for and
//! nothing of this does; and what comes of it for all blocks of vectors at once.

use super::errors::{HUGE, inverse_tolerance};
use super::series::largest_root;
use super::step_by_series::{Missed, slopes_and_reaches};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::real::{Mask, Real};
use crate::ode::norm::Block;
use crate::ode::step_control::Controlled;

/// Numbers of a state in its two halves: coordinates (or all of a system of the first order), and velocities.
pub(in crate::ode) type Halves<'a, S> = [&'a [S]; 2];

/// Runs a function of the number of components of a vector, known when compiled.
macro_rules! by_components {
    ($components:expr, $function:ident::<$type:ty>($($argument:expr),*)) => {
        match $components {
            1 => $function::<$type, 1>($($argument),*),
            2 => $function::<$type, 2>($($argument),*),
            3 => $function::<$type, 3>($($argument),*),
            _ => $function::<$type, 4>($($argument),*),
        }
    };
}

/// Finds one over what each vector may be off, block after block.
pub(in crate::ode) struct InverseTolerances<'a, S> {
    /// The vectors.
    pub(in crate::ode) blocks: &'a [Block<S>],
    /// The state.
    pub(in crate::ode) halves: Halves<'a, S>,
    /// From where sizes are measured, if not from the references.
    pub(in crate::ode) centers: &'a [[S; 4]],
    /// The time since the start.
    pub(in crate::ode) elapsed: &'a S,
    /// The tolerance relative to a size.
    pub(in crate::ode) rtol: &'a S,
    /// The result.
    pub(in crate::ode) into: &'a mut [S],
}

impl<S: Element> Pass<S> for InverseTolerances<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let (elapsed, rtol, into) = (V::load(*self.elapsed), V::load(*self.rtol), V::view_mut(self.into));
        let mut start = 0;
        for (index, block) in self.blocks.iter().enumerate() {
            let mut place = [V::zero(); 4];
            for c in 0..block.shape.components.min(4) {
                place[c] = match self.centers.get(index) {
                    Some(center) => V::load(center[c]),
                    None => V::load(block.reference[c]) + V::load(block.drift[c]) * elapsed,
                };
            }
            let y = V::view(&self.halves[usize::from(block.velocity)][block.start..]);
            let rows = block.shape.rows;
            let (atol, into) = (V::view(&block.atol), &mut into[start..start + rows]);
            by_components!(block.shape.components, inverse_tolerances::<V>(y, &place, (atol, rtol), into));
            start += rows;
        }
    }
}

#[inline(always)]
fn inverse_tolerances<V: InverseCube, const C: usize>(
    y: &[V],
    place: &[V; 4],
    (atol, rtol): (&[V], V),
    into: &mut [V],
) {
    let of_each = usize::from(atol.len() > 1);
    let rows = into.len();
    for (row, into) in into.iter_mut().enumerate() {
        let mut distance2 = V::zero();
        for c in 0..C {
            let distance = y[c * rows + row] - place[c];
            distance2 = distance.multiply_add(distance, distance2);
        }
        *into = inverse_tolerance(distance2, atol[row * of_each], rtol);
    }
}

/// The largest squared ratio of two sets of vectors, times a factor, to what each may be off; NaN counts as infinite.
#[inline(always)]
fn largest<V: Real, const C: usize>(
    k: [&[V]; 2],
    factor: V,
    inverse_tolerances: &[V],
    mut largest: [V; 2],
) -> [V; 2] {
    let rows = inverse_tolerances.len();
    let k = k.map(|k| &k[..C * rows]);
    for (row, &inverse) in inverse_tolerances.iter().enumerate() {
        for which in 0..2 {
            let mut square = V::zero();
            for c in 0..C {
                let error = factor * k[which][c * rows + row] * inverse;
                square = error.multiply_add(error, square);
            }
            let square = V::select(square.less_equal(V::splat(HUGE)), square, V::splat(HUGE));
            largest[which] = largest[which].max(square);
        }
    }
    largest
}

/// One over the step that coefficients allow, in their unit of time, where vectors are measured by what they may be off.
pub(in crate::ode) struct Vectors<'a, S> {
    /// Where they are.
    pub(in crate::ode) blocks: &'a [Block<S>],
    /// One over what each may be off.
    pub(in crate::ode) inverse_tolerances: &'a [S],
    /// Blocks of coefficients from order 0 on, each of so many numbers.
    pub(in crate::ode) coefficients: Halves<'a, S>,
    pub(in crate::ode) len: usize,
    /// Whether those of velocities are in the unit of time.
    pub(in crate::ode) in_units: bool,
    /// Whether the lanes share a step.
    pub(in crate::ode) together: bool,
}

impl<S: Controlled> Vectors<'_, S> {
    /// Of the coefficients of two orders; one over the unit of time is told.
    #[inline(always)]
    pub(super) fn inverse_step<V: View<S>>(&self, orders: [usize; 2], per_unit: V) -> V {
        let inverse = V::view(self.inverse_tolerances);
        let (mut squares, mut start) = ([V::zero(); 2], 0);
        for block in self.blocks {
            let numbers = V::view(self.coefficients[usize::from(block.velocity)]);
            let [first, second] = orders;
            let from = [first * self.len + block.start, second * self.len + block.start];
            let k = [&numbers[from[0]..], &numbers[from[1]..]];
            let factor = if block.velocity && self.in_units { per_unit } else { V::one() };
            let own = &inverse[start..start + block.shape.rows];
            squares = by_components!(block.shape.components, largest::<V>(k, factor, own, squares));
            start += block.shape.rows;
        }
        let inverse = largest_root(squares, orders);
        if self.together { V::load(inverse.store().largest_lane()) } else { inverse }
    }
}

/// Where vectors miss by more than so many times what they may be off, so that the step has led astray.
pub(in crate::ode) struct Astray<'a, S> {
    /// What they miss.
    pub(in crate::ode) missed: Missed<'a, S>,
    /// The vectors.
    pub(in crate::ode) blocks: &'a [Block<S>],
    /// One over what each may be off.
    pub(in crate::ode) inverse_tolerances: &'a [S],
    /// The tolerance, the least that it is taken for, and how many there may be.
    pub(in crate::ode) tolerance: &'a S,
    pub(in crate::ode) least: f64,
    pub(in crate::ode) most: f64,
}

impl<S: Element> Pass<S> for Astray<'_, S> {
    type Output = S::Mask;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S::Mask {
        let Missed { rates, blocks: numbers, highest, times, second_order } = self.missed;
        let (rates, numbers, inverse) =
            (V::view_mut(rates), V::view(numbers), V::view(self.inverse_tolerances));
        let (unit, len) = (V::load(*times[1]), rates.len());
        let x = V::load(*times[0]) / unit;
        // What a rate moves a number by in the unit of time.
        let moves = if second_order { unit * unit } else { unit };
        let mut start = 0;
        macro_rules! groups {
            ($($size:literal)+) => {$(
                while len - start >= $size {
                    let (slopes, _) =
                        slopes_and_reaches::<V, $size>([numbers; 2], (len, start), highest, x);
                    for g in 0..$size {
                        rates[start + g] = rates[start + g] * moves - slopes[g];
                    }
                    start += $size;
                }
            )+};
        }
        groups!(6 3 2 1);
        let of_places = if second_order { x * x } else { x };
        let (mut squares, mut start) = ([V::zero(); 2], 0);
        for block in self.blocks {
            let factor = if block.velocity && second_order { x / unit } else { of_places };
            let (k, own) = (&rates[block.start..], &inverse[start..start + block.shape.rows]);
            squares = by_components!(block.shape.components, largest::<V>([k, k], factor, own, squares));
            start += block.shape.rows;
        }
        let tolerance = V::load(*self.tolerance);
        let rounding = tolerance / tolerance.max(V::splat(self.least));
        let square = squares[0] * rounding * rounding;
        V::mask_in_memory(square.less_equal(V::splat(self.most * self.most)).not())
    }
}
