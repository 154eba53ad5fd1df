//! Symplectic Euler: a kick and a drift. Of order 1, and the only method here that is symplectic and no palindrome
//! of order 2.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, ZERO, dd};

/// Symplectic Euler, kick–drift.
pub static METHOD: Method = Method {
    name: "symplectic_euler",
    summary: "Symplectic, order 1, one force evaluation per step: the simplest that keeps orbits bound; leapfrog costs no more.",
    order: 1,
    stages: 1,
    symplectic: true,
    reversible: false,
    dense_order: 1,
    reference: "de Vogelaere (1956); Hairer, Lubich & Wanner, Geometric Numerical Integration, I.1, VI.3",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    dd(1.0, 0.0), ZERO,
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(1.0, 0.0),
];
// </coefficients>
