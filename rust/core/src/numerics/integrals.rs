//! Taylor coefficients of integrals: those of what is integrated over whole numbers.
//!
//! What the reciprocals of those numbers leave out goes with them, else they would bias every step alike.

use super::element::Scaled;
use super::real::Real;

/// A number over a whole one, whose reciprocal comes with what it leaves out.
#[inline(always)]
pub(crate) fn over<V: Real>(value: V, reciprocal: Scaled<V>) -> V {
    value.multiply_add(reciprocal.0, value * reciprocal.1)
}

/// `v = a/(n+1)`, `q = v/(n+2)`, of a system of the second order.
#[inline(always)]
pub(crate) fn raise<V: Real>(a: &[V], of_v: Scaled<V>, of_q: Scaled<V>, v: &mut [V], q: &mut [V]) {
    let n = a.len();
    let (v, q) = (&mut v[..n], &mut q[..n]);
    for i in 0..n {
        v[i] = over(a[i], of_v);
        q[i] = over(v[i], of_q);
    }
}
