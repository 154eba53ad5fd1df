//! Boris's method: leapfrog, drift–kick–drift, with the rotation of velocities in a magnetic field as a part of its own.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, ZERO, dd};

/// Boris's method.
pub static METHOD: Method = Method {
    name: "boris",
    summary: "Order 2, one force evaluation per step, velocities turned exactly: charges in magnetic fields.",
    order: 2,
    stages: 1,
    symplectic: true,
    reversible: true,
    dense_order: 2,
    reference: "Boris, Proc. 4th Conf. Numerical Simulation of Plasmas (1970) 3; Hairer & Lubich, BIT 58 (2018) 969",
    scheme: Scheme::Boris(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    ZERO, dd(1.0, 0.0), ZERO,
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.5, 0.0), dd(0.5, 0.0),
];
// </coefficients>
