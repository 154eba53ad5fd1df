//! Sums of products of coefficients, for one order or for two.
//!
//! The one idea: but for the products with the two outermost coefficients, what the order n + 1 of a product needs is there at
//! the order n, and it is what that needs, one place further. So of even orders both sums go through the coefficients
//! together: what is read serves two products, and there are twice as many chains to wait for. An odd order adds the rest.

use super::ORDERS;
use crate::numerics::real::Real;

/// Σ x[i] y[last − i], in four chains.
#[inline(always)]
pub(super) fn convolved<S: Real>(x: &[S], y: &[S]) -> S {
    let y = &y[..x.len()];
    let (mut first, mut second, mut third, mut fourth) = (S::zero(), S::zero(), S::zero(), S::zero());
    let (forward, backward) = (x.chunks_exact(4), y.rchunks_exact(4));
    let rest = (forward.remainder(), backward.remainder());
    for four in forward.zip(backward) {
        if let ([x0, x1, x2, x3], [y0, y1, y2, y3]) = four {
            first = x0.multiply_add(*y3, first);
            second = x1.multiply_add(*y2, second);
            third = x2.multiply_add(*y1, third);
            fourth = x3.multiply_add(*y0, fourth);
        }
    }
    match rest {
        ([x0], [y0]) => first = x0.multiply_add(*y0, first),
        ([x0, x1], [y0, y1]) => {
            first = x0.multiply_add(*y1, first);
            second = x1.multiply_add(*y0, second);
        }
        ([x0, x1, x2], [y0, y1, y2]) => {
            first = x0.multiply_add(*y2, first);
            second = x1.multiply_add(*y1, second);
            third = x2.multiply_add(*y0, third);
        }
        _ => {}
    }
    (first + second) + (third + fourth)
}

/// A coefficient of an order below [`ORDERS`], as all are that sums go through.
#[inline(always)]
fn at<S: Real>(of: &[S; ORDERS], order: usize) -> S {
    debug_assert!(order < ORDERS);
    // SAFETY: sums up to the order n (which has a next one) begin at its coefficients of n + 1 at most, and go down from there to
    // those of 1, or up from those of 1 to n.
    unsafe { *of.get_unchecked(order) }
}

/// Σ a_j b_{m−j} and Σ a_j b_{m+1−j} of `from` ≤ j < `to`, in two chains each; `to` ≤ m.
#[inline(always)]
fn two_orders<S: Real>(a: &[S; ORDERS], b: &[S; ORDERS], (from, to): (usize, usize), m: usize) -> (S, S) {
    let (mut even, mut odd) = ((S::zero(), S::zero()), (S::zero(), S::zero()));
    let (mut j, mut further) = (from, at(b, m + 1 - from));
    while j + 1 < to {
        let (first, second) = (at(a, j), at(a, j + 1));
        let (own, next) = (at(b, m - j), at(b, m - j - 1));
        even = (first.multiply_add(own, even.0), first.multiply_add(further, even.1));
        odd = (second.multiply_add(next, odd.0), second.multiply_add(own, odd.1));
        further = next;
        j += 2;
    }
    if j < to {
        let first = at(a, j);
        even = (first.multiply_add(at(b, m - j), even.0), first.multiply_add(further, even.1));
    }
    (even.0 + odd.0, even.1 + odd.1)
}

/// Σ a_j b_{n−j} and Σ a_j b_{n+1−j} of 0 < j < n: the second lacks a_n b_1.
#[inline(always)]
pub(super) fn begun<S: Real>(a: &[S; ORDERS], b: &[S; ORDERS], n: usize) -> (S, S) {
    two_orders(a, b, (1, n), n)
}

/// As [`begun`], of two series in the place of `a`, a chain each.
#[inline(always)]
pub(super) fn both_begun<S: Real>([a, c]: [&[S; ORDERS]; 2], b: &[S; ORDERS], n: usize) -> ((S, S), (S, S)) {
    let (mut of_a, mut of_c) = ((S::zero(), S::zero()), (S::zero(), S::zero()));
    let mut further = at(b, n);
    for j in 1..n {
        let (a, c, own) = (at(a, j), at(c, j), at(b, n - j));
        of_a = (a.multiply_add(own, of_a.0), a.multiply_add(further, of_a.1));
        of_c = (c.multiply_add(own, of_c.0), c.multiply_add(further, of_c.1));
        further = own;
    }
    (of_a, of_c)
}

/// Σ a_j b_{n−j} of 0 < j < n, and Σ a_j b_{n+1−j} of 0 < j ≤ n, of an even n.
#[inline(always)]
pub(super) fn inside<S: Real>(a: &[S; ORDERS], b: &[S; ORDERS], n: usize) -> (S, S) {
    let (own, later) = begun(a, b, n);
    (own, a[n].multiply_add(b[1], later))
}

/// As [`inside`] of a square: each product comes twice but the one in the middle.
#[inline(always)]
pub(super) fn inside_square<S: Real>(a: &[S; ORDERS], n: usize) -> (S, S) {
    let half = n / 2;
    let (own, later) = two_orders(a, a, (1, half), n);
    let (middle, next) = (a[half], a[half + 1]);
    let later = middle.multiply_add(next, later);
    (middle.multiply_add(middle, own + own), later + later)
}
