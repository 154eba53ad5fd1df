//! Taylor coefficients of integrals: those of what is integrated over whole numbers.
//!
//! What the reciprocals of those numbers leave out goes with them, else they would bias every step alike.

use super::element::Scaled;
use super::real::Real;

/// `y = rate/(n+1)`, of a system of the first order.
#[inline(always)]
pub(crate) fn raise_rates<V: Real>(rates: &[V], over: Scaled<V>, y: &mut [V]) {
    let y = &mut y[..rates.len()];
    for i in 0..rates.len() {
        y[i] = rates[i].multiply_add(over.0, rates[i] * over.1);
    }
}

/// `v = a/(n+1)`, `q = v/(n+2)`, of one of the second order.
#[inline(always)]
pub(crate) fn raise<V: Real>(a: &[V], of_v: Scaled<V>, of_q: Scaled<V>, v: &mut [V], q: &mut [V]) {
    let n = a.len();
    let (v, q) = (&mut v[..n], &mut q[..n]);
    for i in 0..n {
        let speed = a[i].multiply_add(of_v.0, a[i] * of_v.1);
        v[i] = speed;
        q[i] = speed.multiply_add(of_q.0, speed * of_q.1);
    }
}
