//! Yoshida's method of order 4 (also Forest and Ruth's): three leapfrogs, the middle one backwards.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, dd};

/// Yoshida's triple jump of leapfrogs.
pub static METHOD: Method = Method {
    name: "yoshida4",
    summary: "Symplectic, order 4, three force evaluations per step: the textbook composition.",
    order: 4,
    stages: 3,
    symplectic: true,
    reversible: true,
    dense_order: 4,
    reference: "Yoshida, Phys. Lett. A 150 (1990) 262; Forest & Ruth, Physica D 43 (1990) 105",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    dd(0.6756035959798288, 4.21370887772588e-17), dd(-0.17560359597982883, 1.337406245399903e-17),
    dd(-0.17560359597982883, 1.337406245399903e-17), dd(0.6756035959798288, 4.21370887772588e-17),
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(1.3512071919596575, 8.42741775545176e-17), dd(-1.7024143839193153, 5.349624981599612e-17),
    dd(1.3512071919596575, 8.42741775545176e-17),
];
// </coefficients>
