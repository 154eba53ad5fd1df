//! The classical Runge–Kutta method of order 4, with a fixed step.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Tableau, ZERO, dd};

/// The classical Runge–Kutta method.
pub static METHOD: Method = Method {
    name: "rk4",
    summary: "Explicit, order 4, fixed step, four force evaluations: the textbook method, for comparison.",
    order: 4,
    stages: 4,
    symplectic: false,
    reversible: false,
    dense_order: 4,
    reference: "Kutta, Z. Math. Phys. 46 (1901) 435; Hairer, Nørsett & Wanner, Solving ODE I, II.1",
    scheme: Scheme::RungeKutta(Tableau { a: A, b: B, c: C }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const A: &[&[DoubleDouble]] = &[
    &[],
    &[
        dd(0.5, 0.0),
    ],
    &[
        ZERO, dd(0.5, 0.0),
    ],
    &[
        ZERO, ZERO, dd(1.0, 0.0),
    ],
];
#[rustfmt::skip]
const B: &[DoubleDouble] = &[
    dd(0.16666666666666666, 9.25185853854297e-18), dd(0.3333333333333333, 1.850371707708594e-17),
    dd(0.3333333333333333, 1.850371707708594e-17), dd(0.16666666666666666, 9.25185853854297e-18),
];
#[rustfmt::skip]
const C: &[DoubleDouble] = &[
    ZERO, dd(0.5, 0.0), dd(0.5, 0.0), dd(1.0, 0.0),
];
// </coefficients>
