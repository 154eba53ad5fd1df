//! Blanes and Moan's splitting of order 6 with ten stages, for any two flows.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, dd};

/// Blanes and Moan's S10.
pub static METHOD: Method = Method {
    name: "blanes_moan_s10",
    summary: "Symplectic, order 6, ten force evaluations per step: long runs at high accuracy.",
    order: 6,
    stages: 10,
    symplectic: true,
    reversible: true,
    dense_order: 6,
    reference: "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, table 2",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    dd(0.050262764400392686, 2.9487298057731478e-19), dd(0.4135143004283438, 8.881178108838883e-18),
    dd(0.045079889794398066, -3.1806751496416912e-18), dd(-0.1880548538195689, -8.018227159407035e-18),
    dd(0.5419606784507801, 2.589241473937753e-17), dd(-0.7255255585086916, 3.552759980739674e-17),
    dd(0.5419606784507801, 2.589241473937753e-17), dd(-0.1880548538195689, -8.018227159407035e-18),
    dd(0.045079889794398066, -3.1806751496416912e-18), dd(0.4135143004283438, 8.881178108838883e-18),
    dd(0.050262764400392686, 2.9487298057731478e-19),
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.14881644790104323, 1.3037102897878669e-18), dd(-0.13238586576778363, -1.3764727254685216e-17),
    dd(0.06730760469218446, 2.519925189860013e-18), dd(0.43266640257817357, 2.7457249052407338e-17),
    dd(-0.01640458940361764, -1.6892251760193091e-19), dd(-0.01640458940361764, -1.6892251760193091e-19),
    dd(0.43266640257817357, 2.7457249052407338e-17), dd(0.06730760469218446, 2.519925189860013e-18),
    dd(-0.13238586576778363, -1.3764727254685216e-17), dd(0.14881644790104323, 1.3037102897878669e-18),
];
// </coefficients>
