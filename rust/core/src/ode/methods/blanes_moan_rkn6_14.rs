//! Blanes and Moan's Runge–Kutta–Nyström splitting of order 6 with fourteen stages (SRKN14a): for kicks by
//! positions alone.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, ZERO, dd};

/// Blanes and Moan's SRKN14a.
pub static METHOD: Method = Method {
    name: "blanes_moan_rkn6_14",
    summary: "Symplectic, order 6, fourteen force evaluations per step, forces of positions alone: small errors with long steps.",
    order: 6,
    stages: 14,
    symplectic: true,
    reversible: true,
    dense_order: 6,
    reference: "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, table 3",
    scheme: Scheme::NystromSplitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    ZERO, dd(0.09171915262446201, -2.72305332291801e-18), dd(0.1839831700050049, 1.308934994926812e-17),
    dd(-0.0565343658328891, -3.2684858753714146e-18), dd(0.004914688774711886, 2.3124051867360074e-19),
    dd(0.14376112716836167, 7.202594365421463e-18), dd(0.3285676937468041, 2.7667385137826697e-17),
    dd(-0.19641146648645552, 1.2444758720368968e-17), dd(-0.19641146648645552, 1.2444758720368968e-17),
    dd(0.3285676937468041, 2.7667385137826697e-17), dd(0.14376112716836167, 7.202594365421463e-18),
    dd(0.004914688774711886, 2.3124051867360074e-19), dd(-0.0565343658328891, -3.2684858753714146e-18),
    dd(0.1839831700050049, 1.308934994926812e-17), dd(0.09171915262446201, -2.72305332291801e-18), ZERO,
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.03785931984061093, 2.4992903563011016e-18), dd(0.10263563310243655, 4.952284575668854e-18),
    dd(-0.02586788826655833, -1.4380140007066087e-18), dd(0.31424140307144643, -4.293119445486063e-18),
    dd(-0.13014445951741513, 1.0505464238416937e-17), dd(0.10641770036954137, -5.683353028660592e-18),
    dd(-0.008794243128510206, -3.6088697926381276e-19), dd(0.20730506905689675, -5.424437528632403e-18),
    dd(-0.008794243128510206, -3.6088697926381276e-19), dd(0.10641770036954137, -5.683353028660592e-18),
    dd(-0.13014445951741513, 1.0505464238416937e-17), dd(0.31424140307144643, -4.293119445486063e-18),
    dd(-0.02586788826655833, -1.4380140007066087e-18), dd(0.10263563310243655, 4.952284575668854e-18),
    dd(0.03785931984061093, 2.4992903563011016e-18),
];
// </coefficients>
