//! From coordinates relative to the first body of each system back to those of all bodies, once for every scalar.
//!
//! No closures, as in [`loops`](super::loops).

use super::Relative;
use crate::numerics::double_double::two_sum;
use crate::numerics::real::Real;

/// A number and what it leaves out.
type Pair<S> = (S, S);

/// `a + b` to twice the digits.
#[inline(always)]
fn add<S: Real>(a: Pair<S>, b: Pair<S>) -> Pair<S> {
    let (sum, error) = two_sum(a.0, b.0);
    let error = error + (a.1 + b.1);
    let high = sum + error;
    (high, error - (high - sum))
}

/// `a·b` to twice the digits.
#[inline(always)]
fn multiply<S: Real>(a: Pair<S>, b: Pair<S>) -> Pair<S> {
    let product = a.0 * b.0;
    let error = a.0.multiply_add(b.0, -product);
    (product, a.0.multiply_add(b.1, a.1.multiply_add(b.0, error)))
}

#[inline(always)]
fn at<S: Real>(values: (&[S], &[S]), index: usize) -> Pair<S> {
    (values.0[index], values.1[index])
}

#[inline(always)]
pub(super) fn absolute<S: Real>((x, x_error): (&mut [S], &mut [S]), from: &Relative<'_, S>) {
    let components = from.shape.components;
    let bodies = from.shape.rows / from.systems;
    for system in 0..from.systems {
        for c in 0..components {
            let center = system * components + c;
            let moved = multiply(at(from.drift, center), from.elapsed);
            let mut first = add(at(from.center, center), moved);
            for body in 1..bodies {
                let index = system * (bodies - 1) + body - 1;
                let share = at(from.shares, index);
                let off = multiply(share, at(from.coordinates, index * components + c));
                first = add(first, (-off.0, -off.1));
            }
            let row = c * from.shape.rows + system * bodies;
            (x[row], x_error[row]) = first;
            for body in 1..bodies {
                let index = (system * (bodies - 1) + body - 1) * components + c;
                (x[row + body], x_error[row + body]) = add(first, at(from.coordinates, index));
            }
        }
    }
}
