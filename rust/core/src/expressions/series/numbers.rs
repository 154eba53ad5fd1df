//! The coefficients of all series of a program, where they lie.
//!
//! The one idea: that places are there was seen when the series were made, and that there are as many numbers is seen once for a
//! whole order.

use super::ORDERS;
use super::convolution::{convolved, inside, inside_square};
use super::recurrence::Place;
use crate::numerics::real::Real;
use core::marker::PhantomData;

/// All coefficients: as many as recurrences, inputs and outputs of series were seen to lie among, which are no further looked at;
/// looks at where every coefficient lies were half of all that is done.
pub(super) struct Numbers<'a, S> {
    first: *mut S,
    all: PhantomData<&'a mut [S]>,
}

impl<'a, S> Numbers<'a, S> {
    /// Those of series with so many.
    ///
    /// # Panics
    /// If there are fewer.
    #[inline(always)]
    pub(super) fn new(numbers: &'a mut [S], many: usize) -> Self {
        assert!(numbers.len() >= many, "too few numbers");
        Self { first: numbers.as_mut_ptr(), all: PhantomData }
    }
}

impl<S: Real> Numbers<'_, S> {
    #[inline(always)]
    pub(super) fn series(&self, place: Place) -> &[S; ORDERS] {
        // SAFETY: places of recurrences are there, series with all their coefficients.
        unsafe { &*self.first.add(place).cast() }
    }

    /// A constant, or the value of a series.
    #[inline(always)]
    pub(super) fn value(&self, place: Place) -> S {
        // SAFETY: as above.
        unsafe { *self.first.add(place) }
    }

    #[inline(always)]
    pub(super) fn series_mut(&mut self, place: Place) -> &mut [S; ORDERS] {
        // SAFETY: as above, and they are ours alone.
        unsafe { &mut *self.first.add(place).cast() }
    }

    /// A coefficient, and of an even order what it leaves for the next.
    #[inline(always)]
    pub(super) fn put<const EVEN: bool>(&mut self, place: Place, n: usize, value: S, later: S) {
        let into = self.series_mut(place);
        into[n] = value;
        if EVEN {
            into[n + 1] = later;
        }
    }

    /// a_0 b_n + a_n b_0.
    #[inline(always)]
    pub(super) fn ends(&self, a: Place, b: Place, n: usize) -> S {
        let (of_a, of_b) = (self.series(a), self.series(b));
        let first = of_a[0] * of_b[n];
        if a == b { first + first } else { of_a[n].multiply_add(of_b[0], first) }
    }

    /// As [`inside`](super::convolution::inside), of any two series.
    #[inline(always)]
    pub(super) fn between(&self, a: Place, b: Place, n: usize) -> (S, S) {
        let of_a = self.series(a);
        if a == b { inside_square(of_a, n) } else { inside(of_a, self.series(b), n) }
    }

    /// Σ slopes_j rate_{n−j} of 0 < j ≤ n: n times what the integral of a product has at the order n.
    #[inline(always)]
    pub(super) fn integral(&self, slopes: Place, rate: Place, n: usize) -> S {
        convolved(&self.series(slopes)[1..n + 1], &self.series(rate)[..n])
    }
}
