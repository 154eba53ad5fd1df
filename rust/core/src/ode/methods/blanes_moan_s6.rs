//! Blanes and Moan's splitting of order 4 with six stages, for any two flows.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, ZERO, dd};

/// Blanes and Moan's S6.
pub static METHOD: Method = Method {
    name: "blanes_moan_s6",
    summary: "Symplectic, order 4, six force evaluations per step: small errors for its order.",
    order: 4,
    stages: 6,
    symplectic: true,
    reversible: true,
    dense_order: 4,
    reference: "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, table 2",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    ZERO, dd(0.20951510661336203, -1.3063838059803218e-17), dd(-0.143851773179818, 1.6538501810850727e-18),
    dd(0.434336666566456, 1.1409987878718145e-17), dd(0.434336666566456, 1.1409987878718145e-17),
    dd(-0.143851773179818, 1.6538501810850727e-18), dd(0.20951510661336203, -1.3063838059803218e-17), ZERO,
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.07920369643119567, 2.9395229566172393e-18), dd(0.35317290604977397, 1.7087981492691887e-17),
    dd(-0.04206508035771953, -3.0679122584822013e-18), dd(0.21937695575349975, 7.714179041789518e-18),
    dd(-0.04206508035771953, -3.0679122584822013e-18), dd(0.35317290604977397, 1.7087981492691887e-17),
    dd(0.07920369643119567, 2.9395229566172393e-18),
];
// </coefficients>
