//! Blanes and Moan's Runge–Kutta–Nyström splitting of order 6 with eleven stages (SRKN11b): for kicks by positions
//! alone.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, dd};

/// Blanes and Moan's SRKN11b.
pub static METHOD: Method = Method {
    name: "blanes_moan_rkn6_11",
    summary: "Symplectic, order 6, eleven force evaluations per step, forces of positions alone: long runs at high accuracy.",
    order: 6,
    stages: 11,
    symplectic: true,
    reversible: true,
    dense_order: 6,
    reference: "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, table 3",
    scheme: Scheme::NystromSplitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    dd(0.041464998518262845, -1.9741188764033423e-18), dd(0.19812867191806655, -4.517387024039763e-18),
    dd(-0.04000619210415269, 2.5039092216585368e-18), dd(0.07525398430158034, 1.1061921127324587e-18),
    dd(-0.01151138742068777, 6.760156645475697e-19), dd(0.23666992478693072, 1.2613729757365383e-17),
    dd(0.23666992478693072, 1.2613729757365383e-17), dd(-0.01151138742068777, 6.760156645475697e-19),
    dd(0.07525398430158034, 1.1061921127324587e-18), dd(-0.04000619210415269, 2.5039092216585368e-18),
    dd(0.19812867191806655, -4.517387024039763e-18), dd(0.041464998518262845, -1.9741188764033423e-18),
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.12322977594627116, -6.8211306010750526e-18), dd(0.29055379779955826, 1.488953252853928e-17),
    dd(-0.1270492126254169, -8.255177582381008e-18), dd(-0.2463317610620754, 6.367170895026016e-18),
    dd(0.3572088727959278, -2.612284801984449e-17), dd(0.20477705429147028, 1.2129329943841584e-17),
    dd(0.3572088727959278, -2.612284801984449e-17), dd(-0.2463317610620754, 6.367170895026016e-18),
    dd(-0.1270492126254169, -8.255177582381008e-18), dd(0.29055379779955826, 1.488953252853928e-17),
    dd(0.12322977594627116, -6.8211306010750526e-18),
];
// </coefficients>
