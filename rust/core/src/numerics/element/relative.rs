//! From coordinates relative to the first body of each system back to those of all bodies, once for every scalar.
//!
//! No closures, as in [`loops`](super::loops).

use super::Relative;
use crate::numerics::double_double::two_sum;
use crate::numerics::real::Real;

/// `a·b` to twice the digits, both with what they leave out.
#[inline(always)]
fn product<S: Real>(a: (S, S), b: (S, S)) -> (S, S) {
    let product = a.0 * b.0;
    let error = a.0.multiply_add(b.0, -product);
    (product, a.0.multiply_add(b.1, a.1.multiply_add(b.0, error)))
}

#[inline(always)]
fn at<S: Real>(values: (&[S], &[S]), index: usize) -> (S, S) {
    (values.0[index], values.1[index])
}

#[inline(always)]
pub(super) fn absolute<S: Real>((q, q_error): (&mut [S], &mut [S]), v: &mut [S], from: &Relative<'_, S>) {
    let components = from.shape.components;
    let bodies = from.shape.rows / from.systems;
    let elapsed = product((from.h, S::zero()), (from.node, S::zero()));
    for system in 0..from.systems {
        for c in 0..components {
            let center = system * components + c;
            let row = c * from.shape.rows + system * bodies;
            let drift = at(from.drift, center);
            let (place, place_error) = at(from.center, center);
            let (moved, moved_error) = product(drift, elapsed);
            let (mut place, error) = two_sum(place, moved);
            let mut rest = error + (place_error + moved_error);
            let mut speed = drift.0;
            for body in 0..bodies - 1 {
                let index = system * (bodies - 1) + body;
                let share = at(from.shares, index);
                let (part, part_error) = product(share, at(from.q, index * components + c));
                let (difference, error) = two_sum(place, -part);
                (place, rest) = (difference, rest + (error - part_error));
                speed = share.0.multiply_subtract_from(from.v[index * components + c], speed);
            }
            q[row] = place + rest;
            q_error[row] = rest - (q[row] - place);
            v[row] = speed;
            for body in 0..bodies - 1 {
                let index = (system * (bodies - 1) + body) * components + c;
                let (own, own_error) = at(from.q, index);
                let (sum, error) = two_sum(place, own);
                let rest = error + (rest + own_error);
                let reached = sum + rest;
                (q[row + 1 + body], q_error[row + 1 + body]) = (reached, rest - (reached - sum));
                v[row + 1 + body] = speed + from.v[index];
            }
        }
    }
}
