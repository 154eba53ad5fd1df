//! Bogacki and Shampine's pair of orders 3 and 2: the adaptive method for rough problems and loose tolerances.
//!
//! The derivative at the end of a step weighs in its error estimate and begins the next one: three evaluations in a step.
//! Its continuous extension is the cubic through the ends of the step with their derivatives, of order 3.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Embedded, Method, Scheme, Tableau, ZERO, dd};

/// The pair of orders 3 and 2 of Bogacki and Shampine.
pub static METHOD: Method = Method {
    name: "bogacki_shampine32",
    summary: "Explicit, order 3, adaptive, three force evaluations: rough problems to loose tolerances.",
    order: 3,
    stages: 3,
    symplectic: false,
    reversible: false,
    dense_order: 3,
    reference: "Bogacki & Shampine, Appl. Math. Lett. 2 (1989) 321",
    scheme: Scheme::Embedded(Embedded {
        tableau: Tableau { a: A, b: B, c: C },
        error: ERROR,
        second_error: None,
        error_exponent: 3,
        dense_a: &[],
        dense_c: &[],
        dense: DENSE,
    }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const A: &[&[DoubleDouble]] = &[
    &[],
    &[
        dd(0.5, 0.0),
    ],
    &[
        ZERO, dd(0.75, 0.0),
    ],
];
#[rustfmt::skip]
const B: &[DoubleDouble] = &[
    dd(0.2222222222222222, 1.2335811384723961e-17), dd(0.3333333333333333, 1.850371707708594e-17),
    dd(0.4444444444444444, 2.4671622769447922e-17),
];
#[rustfmt::skip]
const C: &[DoubleDouble] = &[
    ZERO, dd(0.5, 0.0), dd(0.75, 0.0),
];
#[rustfmt::skip]
const ERROR: &[DoubleDouble] = &[
    dd(-0.06944444444444445, 3.0839528461809902e-18), dd(0.08333333333333333, 4.625929269271485e-18),
    dd(0.1111111111111111, 6.1679056923619804e-18), dd(-0.125, 0.0),
];
#[rustfmt::skip]
const DENSE: &[&[DoubleDouble]] = &[
    &[
        dd(0.2222222222222222, 1.2335811384723961e-17), dd(0.7777777777777778, -1.2335811384723961e-17),
        dd(-0.5555555555555556, 2.4671622769447922e-17),
    ],
    &[
        dd(0.3333333333333333, 1.850371707708594e-17), dd(-0.3333333333333333, -1.850371707708594e-17),
        dd(0.6666666666666666, 3.700743415417188e-17),
    ],
    &[
        dd(0.4444444444444444, 2.4671622769447922e-17), dd(-0.4444444444444444, -2.4671622769447922e-17),
        dd(0.8888888888888888, 4.9343245538895844e-17),
    ],
    &[
        ZERO, ZERO, dd(-1.0, 0.0),
    ],
];
// </coefficients>
