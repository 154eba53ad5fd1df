//! Sums of products of coefficients, for one order or for two.
//!
//! The one idea: but for the products with the two outermost coefficients, what the order n + 1 of a product needs is there at
//! the order n, and it is what that needs, one place further. So of even orders both sums go through the coefficients
//! together: what is read serves two products, and there are twice as many chains to wait for. An odd order adds the rest.

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

/// Σ x[i] y[last − 1 − i] and Σ x[i] y[last − i], `y` being longer by one: two chains each.
#[inline(always)]
fn two_orders<S: Real>(x: &[S], y: &[S]) -> (S, S) {
    let (y, mut further) = (&y[..x.len()], y[x.len()]);
    let (mut even, mut odd) = ((S::zero(), S::zero()), (S::zero(), S::zero()));
    let (forward, backward) = (x.chunks_exact(2), y.rchunks_exact(2));
    let rest = (forward.remainder(), backward.remainder());
    for two in forward.zip(backward) {
        if let ([x0, x1], [y0, y1]) = two {
            even = (x0.multiply_add(*y1, even.0), x0.multiply_add(further, even.1));
            odd = (x1.multiply_add(*y0, odd.0), x1.multiply_add(*y1, odd.1));
            further = *y0;
        }
    }
    if let ([x], [y]) = rest {
        even = (x.multiply_add(*y, even.0), x.multiply_add(further, even.1));
    }
    (even.0 + odd.0, even.1 + odd.1)
}

/// As [`two_orders`] of `x` and of `z`, a chain each.
#[inline(always)]
fn two_orders_of_both<S: Real>(x: &[S], z: &[S], y: &[S]) -> ((S, S), (S, S)) {
    let (z, y, mut further) = (&z[..x.len()], &y[..x.len()], y[x.len()]);
    let (mut of_x, mut of_z) = ((S::zero(), S::zero()), (S::zero(), S::zero()));
    for ((x, z), y) in x.iter().zip(z).zip(y.iter().rev()) {
        of_x = (x.multiply_add(*y, of_x.0), x.multiply_add(further, of_x.1));
        of_z = (z.multiply_add(*y, of_z.0), z.multiply_add(further, of_z.1));
        further = *y;
    }
    (of_x, of_z)
}

/// Σ a_j b_{n−j} and Σ a_j b_{n+1−j} of 0 < j < n: the second lacks a_n b_1.
#[inline(always)]
pub(super) fn begun<S: Real>(a: &[S], b: &[S], n: usize) -> (S, S) {
    two_orders(&a[1..n], &b[1..n + 1])
}

/// As [`begun`], of two series in the place of `a`.
#[inline(always)]
pub(super) fn both_begun<S: Real>([a, c]: [&[S]; 2], b: &[S], n: usize) -> ((S, S), (S, S)) {
    two_orders_of_both(&a[1..n], &c[1..n], &b[1..n + 1])
}

/// Σ a_j b_{n−j} of 0 < j < n, and Σ a_j b_{n+1−j} of 0 < j ≤ n, of an even n.
#[inline(always)]
pub(super) fn inside<S: Real>(a: &[S], b: &[S], n: usize) -> (S, S) {
    let (own, later) = begun(a, b, n);
    (own, a[n].multiply_add(b[1], later))
}

/// As [`inside`] of a square: each product comes twice but the one in the middle.
#[inline(always)]
pub(super) fn inside_square<S: Real>(a: &[S], n: usize) -> (S, S) {
    let half = n / 2;
    let (own, later) = two_orders(&a[1..half], &a[n + 1 - half..n + 1]);
    let (middle, next) = (a[half], a[half + 1]);
    let later = middle.multiply_add(next, later);
    (middle.multiply_add(middle, own + own), later + later)
}
