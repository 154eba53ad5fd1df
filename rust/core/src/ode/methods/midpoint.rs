//! The explicit midpoint rule (Runge's method).

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Tableau, ZERO, dd};

/// The explicit midpoint rule.
pub static METHOD: Method = Method {
    name: "midpoint",
    summary: "Explicit, order 2, fixed step, two force evaluations: for comparison.",
    order: 2,
    stages: 2,
    symplectic: false,
    reversible: false,
    dense_order: 2,
    reference: "Runge, Math. Ann. 46 (1895) 167; Hairer, Nørsett & Wanner, Solving ODE I, II.1",
    scheme: Scheme::RungeKutta(Tableau { a: A, b: B, c: C }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const A: &[&[DoubleDouble]] = &[
    &[],
    &[
        dd(0.5, 0.0),
    ],
];
#[rustfmt::skip]
const B: &[DoubleDouble] = &[
    ZERO, dd(1.0, 0.0),
];
#[rustfmt::skip]
const C: &[DoubleDouble] = &[
    ZERO, dd(0.5, 0.0),
];
// </coefficients>
