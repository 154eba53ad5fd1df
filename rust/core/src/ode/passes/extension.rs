//! What a continuous extension is read by: the weights of the stages at a fraction of the step, and the terms of one
//! coordinate.

use super::stages::{Term, view_terms_mut};
use crate::numerics::element::{Element, Pass, View};

/// For every stage its weight at the fraction `theta` of the step, from its weights in the nested basis of
/// [`Embedded::dense`](crate::ode::Embedded::dense).
#[derive(Debug)]
pub struct Weigh<'a, S> {
    /// Where the weights go.
    pub terms: &'a mut [Term<S>],
    /// For every stage, its weights in the basis.
    pub basis: &'a [Vec<S>],
    /// The fraction.
    pub theta: &'a S,
}

impl<S: Element> Pass<S> for Weigh<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let theta = V::load(*self.theta);
        let rest = V::one() - theta;
        let terms = view_terms_mut::<S, V>(self.terms);
        let count = terms.len().min(self.basis.len());
        let mut start = 0;
        // Several stages at a time: the sum of one alone waits for each of its operations.
        while count - start >= 4 {
            weigh::<S, V, 4>(&mut terms[start..], &self.basis[start..], theta, rest);
            start += 4;
        }
        while count > start {
            weigh::<S, V, 1>(&mut terms[start..], &self.basis[start..], theta, rest);
            start += 1;
        }
    }
}

/// Of the first `G` stages.
#[inline(always)]
fn weigh<S, V: View<S>, const G: usize>(terms: &mut [Term<V>], basis: &[Vec<S>], theta: V, rest: V) {
    let mut sums = [V::zero(); G];
    for index in (0..basis[0].len()).rev() {
        let factor = if index % 2 == 0 { theta } else { rest };
        for g in 0..G {
            sums[g] = factor * (V::view(&basis[g])[index] + sums[g]);
        }
    }
    for g in 0..G {
        terms[g].weight = sums[g];
    }
}

/// `Σ weight·k[stage]` of one coordinate, by the weights of every term of the basis: those in the coordinates and those in
/// the velocities.
#[derive(Debug)]
pub struct Coordinate<'a, S> {
    /// Which.
    pub coordinate: usize,
    /// For every stage, its weights in the basis.
    pub basis: &'a [Vec<Vec<S>>; 2],
    /// The derivatives, one after another.
    pub k: &'a [S],
    /// Numbers of each derivative.
    pub stride: usize,
    /// Where the sums go, term after term.
    pub into: &'a mut [[S; 2]],
}

impl<S: Element> Pass<S> for Coordinate<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let Self { coordinate, basis, k, stride, into } = self;
        let k = &V::view(k)[coordinate..];
        for of in 0..2 {
            let mut start = 0;
            while into.len() - start >= 4 {
                coordinate_sums::<S, V, 4>(&basis[of], (k, stride), start, of, into);
                start += 4;
            }
            while into.len() > start {
                coordinate_sums::<S, V, 1>(&basis[of], (k, stride), start, of, into);
                start += 1;
            }
        }
    }
}

/// Of `G` terms from `start` on.
#[inline(always)]
fn coordinate_sums<S, V: View<S>, const G: usize>(
    basis: &[Vec<S>],
    (k, stride): (&[V], usize),
    start: usize,
    of: usize,
    into: &mut [[S; 2]],
) {
    let mut sums = [V::zero(); G];
    for stage in 0..basis.len() {
        let weights = &V::view(&basis[stage])[start..][..G];
        let derivative = k[stage * stride];
        for g in 0..G {
            sums[g] += weights[g] * derivative;
        }
    }
    for g in 0..G {
        into[start + g][of] = sums[g].store();
    }
}
