//! Heun's method of order 2, the explicit trapezoidal rule.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Tableau, ZERO, dd};

/// Heun's method of order 2.
pub static METHOD: Method = Method {
    name: "heun",
    summary: "Explicit, order 2, fixed step, two force evaluations: for comparison.",
    order: 2,
    stages: 2,
    symplectic: false,
    reversible: false,
    dense_order: 2,
    reference: "Heun, Z. Math. Phys. 45 (1900) 23; Hairer, Nørsett & Wanner, Solving ODE I, II.1",
    scheme: Scheme::RungeKutta(Tableau { a: A, b: B, c: C }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const A: &[&[DoubleDouble]] = &[
    &[],
    &[
        dd(1.0, 0.0),
    ],
];
#[rustfmt::skip]
const B: &[DoubleDouble] = &[
    dd(0.5, 0.0), dd(0.5, 0.0),
];
#[rustfmt::skip]
const C: &[DoubleDouble] = &[
    ZERO, dd(1.0, 0.0),
];
// </coefficients>
