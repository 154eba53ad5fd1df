//! Leapfrog (Störmer–Verlet), drift–kick–drift: the force is evaluated in the middle of the step.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, ZERO, dd};

/// Leapfrog, drift–kick–drift.
pub static METHOD: Method = Method {
    name: "leapfrog_dkd",
    summary: "Symplectic, order 2, one force evaluation per step, at the middle of it: the other leapfrog.",
    order: 2,
    stages: 1,
    symplectic: true,
    reversible: true,
    dense_order: 2,
    reference: "Störmer (1907); Verlet, Phys. Rev. 159 (1967) 98; Hairer, Lubich & Wanner, Acta Numerica 12 (2003) 399",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
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
