//! McLachlan's method of order 4 with five stages: a splitting that is more than a composition of leapfrogs.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, dd};

/// McLachlan's method of order 4 in five stages.
pub static METHOD: Method = Method {
    name: "mclachlan4",
    summary: "Symplectic, order 4, five force evaluations per step: errors far below those of yoshida4.",
    order: 4,
    stages: 5,
    symplectic: true,
    reversible: true,
    dense_order: 4,
    reference: "McLachlan, SIAM J. Sci. Comput. 16 (1995) 151, method S, m = 5",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    dd(0.08926945422647524, 5.4644164040030816e-18), dd(-0.0973360426368955, -1.8404721723313025e-18),
    dd(0.5080665884104203, -3.137951984730069e-17), dd(0.5080665884104203, -3.137951984730069e-17),
    dd(-0.0973360426368955, -1.8404721723313025e-18), dd(0.08926945422647524, 5.4644164040030816e-18),
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.4, -2.2204460492503132e-17), dd(-0.1, 5.551115123125783e-18), dd(0.4, -2.2204460492503132e-17),
    dd(-0.1, 5.551115123125783e-18), dd(0.4, -2.2204460492503132e-17),
];
// </coefficients>
