//! Euler's method: the simplest there is, to be compared with and for nothing else.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Tableau, ZERO, dd};

/// Euler's method.
pub static METHOD: Method = Method {
    name: "euler",
    summary: "Explicit, order 1, fixed step, one force evaluation: the simplest method, for comparison.",
    order: 1,
    stages: 1,
    symplectic: false,
    reversible: false,
    dense_order: 1,
    reference: "Euler, Institutiones calculi integralis (1768); Hairer, Nørsett & Wanner, Solving ODE I, I.7",
    scheme: Scheme::RungeKutta(Tableau { a: A, b: B, c: C }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const A: &[&[DoubleDouble]] = &[
    &[],
];
#[rustfmt::skip]
const B: &[DoubleDouble] = &[
    dd(1.0, 0.0),
];
#[rustfmt::skip]
const C: &[DoubleDouble] = &[
    ZERO,
];
// </coefficients>
