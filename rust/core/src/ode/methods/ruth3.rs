//! Ruth's method of order 3: no palindrome, so that a step backwards does not undo a step.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, ZERO, dd};

/// Ruth's method of order 3.
pub static METHOD: Method = Method {
    name: "ruth3",
    summary: "Symplectic, order 3, three force evaluations per step, not reversible: for comparison.",
    order: 3,
    stages: 3,
    symplectic: true,
    reversible: false,
    dense_order: 3,
    reference: "Ruth, IEEE Trans. Nucl. Sci. 30 (1983) 2669",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    dd(0.2916666666666667, -1.850371707708594e-17), dd(0.75, 0.0),
    dd(-0.041666666666666664, -2.3129646346357427e-18), ZERO,
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.6666666666666666, 3.700743415417188e-17), dd(-0.6666666666666666, -3.700743415417188e-17),
    dd(1.0, 0.0),
];
// </coefficients>
