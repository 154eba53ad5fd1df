//! Kahan and Li's composition of order 6: nine leapfrogs.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, dd};

/// Kahan and Li's composition of order 6.
pub static METHOD: Method = Method {
    name: "kahan_li6",
    summary: "Symplectic, order 6, nine force evaluations per step: high accuracy over long runs.",
    order: 6,
    stages: 9,
    symplectic: true,
    reversible: true,
    dense_order: 6,
    reference: "Kahan & Li, Math. Comp. 66 (1997) 1089; Hairer, Lubich & Wanner, Geometric Numerical Integration, V.3.2",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    dd(0.19608072200365706, 9.913047351716685e-18), dd(0.3623802903983368, -1.2843119834371794e-17),
    dd(-0.18682351788413995, -1.0409220554813955e-17), dd(-0.3120162881320443, 1.5122556072783204e-17),
    dd(0.44037879361419036, 2.5972312580314772e-17), dd(0.44037879361419036, 2.5972312580314772e-17),
    dd(-0.3120162881320443, 1.5122556072783204e-17), dd(-0.18682351788413995, -1.0409220554813955e-17),
    dd(0.3623802903983368, -1.2843119834371794e-17), dd(0.19608072200365706, 9.913047351716685e-18),
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.3921614440073141, 1.982609470343337e-17), dd(0.33259913678935943, 9.998816859080868e-18),
    dd(-0.7062461725576393, -3.081725796870878e-17), dd(0.0822135962935508, 5.551218883017361e-18),
    dd(0.79854399093483, -9.117744953645643e-18), dd(0.0822135962935508, 5.551218883017361e-18),
    dd(-0.7062461725576393, -3.081725796870878e-17), dd(0.33259913678935943, 9.998816859080868e-18),
    dd(0.3921614440073141, 1.982609470343337e-17),
];
// </coefficients>
