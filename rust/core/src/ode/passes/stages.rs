//! What the stages of a Runge–Kutta method add to a state.

use super::updates::add_compensated;
use crate::numerics::element::{Element, Pair, PairMut, Pass, View};
use crate::numerics::real::Real;
use crate::ode::nystrom::Row;
use crate::ode::state::State;

/// One term of a weighted sum of stages.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Term<S> {
    /// Which stage.
    pub stage: usize,
    /// Its weight.
    pub weight: S,
}

/// Terms seen as those of the tier's vectors: same layout, so a view and not a copy.
#[inline(always)]
fn view_terms<S, V: View<S>>(terms: &[Term<S>]) -> &[Term<V>] {
    const { assert!(size_of::<Term<V>>() == size_of::<Term<S>>() && align_of::<V>() <= align_of::<S>()) }
    // SAFETY: a `V` is a view of an `S`, of its size and validity; `Term` is `repr(C)`, so the two have the same layout
    // (the sizes are checked above).
    unsafe { core::slice::from_raw_parts(terms.as_ptr().cast(), terms.len()) }
}

/// As [`view_terms`], to be changed.
#[inline(always)]
pub(super) fn view_terms_mut<S, V: View<S>>(terms: &mut [Term<S>]) -> &mut [Term<V>] {
    const { assert!(size_of::<Term<V>>() == size_of::<Term<S>>() && align_of::<V>() <= align_of::<S>()) }
    // SAFETY: as in `view_terms`.
    unsafe { core::slice::from_raw_parts_mut(terms.as_mut_ptr().cast(), terms.len()) }
}

/// The weights of stages, and their derivatives one after another.
#[derive(Clone, Copy, Debug)]
pub struct Weighted<'a, S> {
    /// The step.
    pub h: &'a S,
    /// The weights.
    pub terms: &'a [Term<S>],
    /// The derivatives.
    pub k: &'a [S],
}

/// `Σ weight·k[stage]` at `G` elements from `i` on, in the order of the terms. Several elements at a time,
/// because one sum alone waits for each of its additions.
#[inline(always)]
fn weighted<S: Real, const G: usize>(terms: &[Term<S>], k: &[S], stride: usize, i: usize) -> [S; G] {
    let mut sums = [S::zero(); G];
    for &Term { stage, weight } in terms {
        let column = &k[stage * stride + i..][..G];
        for g in 0..G {
            sums[g] = weight.multiply_add(column[g], sums[g]);
        }
    }
    sums
}

/// Runs `$body` with `$i` and `$sum = Σ weight·k[stage]` for every element below `$n`, six at a time while
/// there are six. A macro and not a closure: a closure would be compiled without the tier's instructions.
macro_rules! for_weighted {
    (($n:expr, $terms:expr, $k:expr), |$i:ident, $sum:ident| $body:expr) => {{
        let mut start = 0;
        for_weighted!(@groups 6, ($n, $terms, $k), start, |$i, $sum| $body);
        for_weighted!(@groups 3, ($n, $terms, $k), start, |$i, $sum| $body);
        for_weighted!(@groups 2, ($n, $terms, $k), start, |$i, $sum| $body);
        for_weighted!(@groups 1, ($n, $terms, $k), start, |$i, $sum| $body);
    }};
    (@groups $g:literal, ($n:expr, $terms:expr, $k:expr), $start:ident, |$i:ident, $sum:ident| $body:expr) => {
        while $n - $start >= $g {
            let sums = weighted::<V, $g>($terms, $k, $n, $start);
            for g in 0..$g {
                let ($i, $sum) = ($start + g, sums[g]);
                $body;
            }
            $start += $g;
        }
    };
}

/// `out = q + (e + h·slope.1·slope.0 + h² Σ weight·k)`: coordinates within a step, `slope` being the velocities at its start
/// and a fraction of it.
#[derive(Debug)]
pub struct Positions<'a, S> {
    /// Where they go.
    pub out: &'a mut [S],
    /// Coordinates at the start.
    pub q: Pair<'a, S>,
    /// Velocities at the start, and the fraction.
    pub slope: (&'a [S], &'a S),
    /// What the stages add.
    pub stages: Weighted<'a, S>,
}

impl<S: Element> Pass<S> for Positions<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let Weighted { h, terms, k } = self.stages;
        let (h, terms, k) = (V::load(*h), view_terms::<S, V>(terms), V::view(k));
        let out = V::view_mut(self.out);
        let n = out.len();
        let (q, e) = V::pair(self.q);
        let (q, e, slope) = (&q[..n], &e[..n], &V::view(self.slope.0)[..n]);
        let (drift, square) = (h * V::load(*self.slope.1), h * h);
        // All but the last operation can be done before the last acceleration is there.
        for_weighted!((n, terms, k), |i, sum| {
            out[i] = square.multiply_add(sum, q[i] + drift.multiply_add(slope[i], e[i]));
        });
    }
}

/// The point of a stage of a system of the second order, both in one kernel: the way into another takes as long as what it
/// does. What it goes by is told by reference, by which a processor does not wait for copies.
#[derive(Debug)]
pub struct Point<'a, S> {
    /// Where the coordinates go.
    pub position: &'a mut [S],
    /// Where the velocities go, if somebody looks at them.
    pub velocity: Option<&'a mut [S]>,
    /// The state at the start.
    pub state: &'a State<S>,
    /// The step.
    pub h: &'a S,
    /// How long it is until then, and what the stages weigh.
    pub row: &'a Row<S>,
    /// Their derivatives.
    pub k: &'a [S],
}

impl<S: Element> Pass<S> for Point<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let Self { state, h, row, k, .. } = self;
        let slope = (state.v(), &row.fraction);
        let stages = Weighted { h, terms: &row.position, k };
        Positions { out: self.position, q: state.position(), slope, stages }.run::<V>();
        if let Some(out) = self.velocity {
            let stages = Weighted { h, terms: &row.velocity, k };
            Rates { out, y: state.velocity(), stages }.run::<V>();
        }
    }
}

/// As [`Positions`], compensated, into `(out, out_e)`.
#[derive(Debug)]
pub struct CompensatedPositions<'a, S> {
    /// Where they go.
    pub out: PairMut<'a, S>,
    /// Coordinates at the start.
    pub q: Pair<'a, S>,
    /// Velocities at the start, and the fraction.
    pub slope: (&'a [S], &'a S),
    /// What the stages add.
    pub stages: Weighted<'a, S>,
}

impl<S: Element> Pass<S> for CompensatedPositions<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let Weighted { h, terms, k } = self.stages;
        let (h, terms, k) = (V::load(*h), view_terms::<S, V>(terms), V::view(k));
        let (out, out_error) = V::pair_mut(self.out);
        let n = out.len();
        let (q, e) = V::pair(self.q);
        let (q, e, slope, out_error) = (&q[..n], &e[..n], &V::view(self.slope.0)[..n], &mut out_error[..n]);
        let (drift, square) = (h * V::load(*self.slope.1), h * h);
        for_weighted!((n, terms, k), |i, sum| {
            let change = square.multiply_add(sum, drift * slope[i]);
            (out[i], out_error[i]) = add_compensated(q[i], e[i], change);
        });
    }
}

/// `out = y + (e + h Σ weight·k)`: velocities within a step, or all numbers of a system of the first order.
#[derive(Debug)]
pub struct Rates<'a, S> {
    /// Where they go.
    pub out: &'a mut [S],
    /// What is there at the start.
    pub y: Pair<'a, S>,
    /// What the stages add.
    pub stages: Weighted<'a, S>,
}

impl<S: Element> Pass<S> for Rates<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let Weighted { h, terms, k } = self.stages;
        let (h, terms, k) = (V::load(*h), view_terms::<S, V>(terms), V::view(k));
        let out = V::view_mut(self.out);
        let n = out.len();
        let (y, e) = V::pair(self.y);
        let (y, e) = (&y[..n], &e[..n]);
        for_weighted!((n, terms, k), |i, sum| out[i] = y[i] + h.multiply_add(sum, e[i]));
    }
}

/// As [`Rates`], compensated, into `(out, out_e)`.
#[derive(Debug)]
pub struct CompensatedRates<'a, S> {
    /// Where they go.
    pub out: PairMut<'a, S>,
    /// What is there at the start.
    pub y: Pair<'a, S>,
    /// What the stages add.
    pub stages: Weighted<'a, S>,
}

impl<S: Element> Pass<S> for CompensatedRates<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let Weighted { h, terms, k } = self.stages;
        let (h, terms, k) = (V::load(*h), view_terms::<S, V>(terms), V::view(k));
        let (out, out_error) = V::pair_mut(self.out);
        let n = out.len();
        let (y, e) = V::pair(self.y);
        let (y, e, out_error) = (&y[..n], &e[..n], &mut out_error[..n]);
        for_weighted!((n, terms, k), |i, sum| (out[i], out_error[i]) = add_compensated(y[i], e[i], h * sum));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_take_the_compensations_along() {
        let (left_out, small) = (f64::EPSILON / 1024.0, f64::EPSILON / 16.0);
        let terms = [Term { stage: 0, weight: 1.0 }];
        let stages = Weighted { h: &1.0, terms: &terms, k: &[small] };
        let (mut out, mut left) = ([0.0], [0.0]);
        let (near, far) = ((&[0.0][..], &[left_out][..]), (&[1.0][..], &[left_out][..]));
        let slope = (&[0.0][..], &0.5);
        f64::pass(Positions { out: &mut out, q: near, slope, stages });
        assert_eq!(out[0], small + left_out);
        f64::pass(Rates { out: &mut out, y: near, stages });
        assert_eq!(out[0], small + left_out);
        f64::pass(CompensatedPositions { out: (&mut out, &mut left), q: far, slope, stages });
        assert_eq!((out[0], left[0]), (1.0, small + left_out));
        f64::pass(CompensatedRates { out: (&mut out, &mut left), y: far, stages });
        assert_eq!((out[0], left[0]), (1.0, small + left_out));
    }
}
