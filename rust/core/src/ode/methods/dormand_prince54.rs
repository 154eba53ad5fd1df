//! Dormand and Prince's pair of orders 5 and 4: the adaptive method for everyday tolerances.
//!
//! The derivative at the end of a step weighs in its error estimate and begins the next one: six evaluations in a step.
//! Its continuous extension is Shampine's, of order 4: the cubic through the ends of the step with their derivatives, and
//! a term of the fourth degree from the stages that are there anyway.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Embedded, Method, Scheme, Tableau, ZERO, dd};

/// The pair of orders 5 and 4 of Dormand and Prince.
pub static METHOD: Method = Method {
    name: "dormand_prince54",
    summary: "Explicit, order 5, adaptive, six force evaluations: everyday problems to everyday tolerances.",
    order: 5,
    stages: 6,
    symplectic: false,
    reversible: false,
    dense_order: 4,
    reference: "Dormand & Prince, J. Comput. Appl. Math. 6 (1980) 19; Hairer, Nørsett & Wanner, Solving ODE I, II.5, II.6",
    scheme: Scheme::Embedded(Embedded {
        tableau: Tableau { a: A, b: B, c: C },
        error: ERROR,
        second_error: None,
        error_exponent: 5,
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
        dd(0.2, -1.1102230246251566e-17),
    ],
    &[
        dd(0.075, 2.7755575615628915e-18), dd(0.225, -5.551115123125783e-18),
    ],
    &[
        dd(0.9777777777777777, 3.20731096002823e-17), dd(-3.7333333333333334, 5.921189464667501e-17),
        dd(3.5555555555555554, 1.9737298215558337e-16),
    ],
    &[
        dd(2.9525986892242035, 8.440470121673953e-17), dd(-11.595793324188385, -8.739643160469453e-16),
        dd(9.822892851699436, 2.382554517104436e-16), dd(-0.2908093278463649, -9.975254885178018e-18),
    ],
    &[
        dd(2.8462752525252526, -7.177199351112124e-17), dd(-10.757575757575758, 2.153159805333637e-16),
        dd(8.906422717743473, -2.562801843769753e-16), dd(0.2784090909090909, 2.5232341468753557e-17),
        dd(-0.2735313036020583, -2.3518446576536335e-17),
    ],
];
#[rustfmt::skip]
const B: &[DoubleDouble] = &[
    dd(0.09114583333333333, 4.625929269271485e-18), ZERO, dd(0.44923629829290207, -3.341641628476437e-18),
    dd(0.6510416666666666, 3.700743415417188e-17), dd(-0.322376179245283, -1.7805463602478925e-17),
    dd(0.13095238095238096, -6.6084703846735505e-18),
];
#[rustfmt::skip]
const C: &[DoubleDouble] = &[
    ZERO, dd(0.2, -1.1102230246251566e-17), dd(0.3, 1.1102230246251566e-17),
    dd(0.8, -4.4408920985006264e-17), dd(0.8888888888888888, 4.9343245538895844e-17),
    dd(1.0, 1.0542197943230523e-80),
];
#[rustfmt::skip]
const ERROR: &[DoubleDouble] = &[
    dd(0.0012326388888888888, 8.577243853440879e-20), ZERO,
    dd(-0.0042527702905061394, -1.1824590090815252e-19), dd(0.03697916666666667, -4.625929269271486e-19),
    dd(-0.05086379716981132, -7.12218544099157e-19), dd(0.0419047619047619, 1.7710700630925118e-18),
    dd(-0.025, 1.3877787807814458e-18),
];
#[rustfmt::skip]
const DENSE: &[&[DoubleDouble]] = &[
    &[
        dd(0.09114583333333333, 4.625929269271485e-18), dd(0.9088541666666666, 3.700743415417188e-17),
        dd(-0.8177083333333334, 3.700743415417188e-17), dd(-1.1270175653862835, 3.68427257320943e-17),
    ],
    &[
        ZERO, ZERO, ZERO, ZERO,
    ],
    &[
        dd(0.44923629829290207, -3.341641628476437e-18), dd(-0.44923629829290207, 3.341641628476437e-18),
        dd(0.8984725965858041, -6.683283256952874e-18), dd(2.675424484351598, -1.8184827063948802e-17),
    ],
    &[
        dd(0.6510416666666666, 3.700743415417188e-17), dd(-0.6510416666666666, -3.700743415417188e-17),
        dd(1.3020833333333333, 7.401486830834377e-17), dd(-5.685526961588504, 2.1710335226270377e-16),
    ],
    &[
        dd(-0.322376179245283, -1.7805463602478925e-17), dd(0.322376179245283, 1.7805463602478925e-17),
        dd(-0.644752358490566, -3.561092720495785e-17), dd(3.5219323679207912, 1.4714550158626843e-16),
    ],
    &[
        dd(0.13095238095238096, -6.6084703846735505e-18), dd(-0.13095238095238096, 6.6084703846735505e-18),
        dd(0.2619047619047619, -1.3216940769347101e-17), dd(-1.7672812570757455, 6.096928095454083e-17),
    ],
    &[
        ZERO, ZERO, dd(-1.0, 0.0), dd(2.382468931778144, -2.218314285466272e-16),
    ],
];
// </coefficients>
