//! Yoshida's method of order 6: seven leapfrogs (solution A).

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, dd};

/// Yoshida's method of order 6.
pub static METHOD: Method = Method {
    name: "yoshida6",
    summary: "Symplectic, order 6, seven force evaluations per step: the fewest of order 6; others are more accurate for their work.",
    order: 6,
    stages: 7,
    symplectic: true,
    reversible: true,
    dense_order: 6,
    reference: "Yoshida, Phys. Lett. A 150 (1990) 262",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    dd(0.39225680523877865, -1.7781762374188943e-17), dd(0.5100434119184577, -2.118842583525471e-18),
    dd(-0.47105338540975644, 5.495127953021816e-18), dd(0.0687531682525201, 5.276891968781415e-19),
    dd(0.0687531682525201, 5.276891968781415e-19), dd(-0.47105338540975644, 5.495127953021816e-18),
    dd(0.5100434119184577, -2.118842583525471e-18), dd(0.39225680523877865, -1.7781762374188943e-17),
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.7845136104775573, -3.5563524748377886e-17), dd(0.23557321335935813, 3.570263965698029e-18),
    dd(-1.177679984178871, -2.0335583675283312e-17), dd(1.3151863206839112, 4.9146537684668507e-17),
    dd(-1.177679984178871, -2.0335583675283312e-17), dd(0.23557321335935813, 3.570263965698029e-18),
    dd(0.7845136104775573, -3.5563524748377886e-17),
];
// </coefficients>
