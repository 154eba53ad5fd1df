//! Leapfrog (Störmer–Verlet), kick–drift–kick: the symplectic method of order 2 that all others of this
//! kind are composed of.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, dd};

/// Leapfrog, kick–drift–kick.
pub static METHOD: Method = Method {
    name: "leapfrog",
    summary: "Symplectic, order 2, one force evaluation per step: long runs at modest accuracy.",
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
pub(crate) const KICKS: &[DoubleDouble] = &[
    dd(0.5, 0.0), dd(0.5, 0.0),
];
#[rustfmt::skip]
pub(crate) const DRIFTS: &[DoubleDouble] = &[
    dd(1.0, 0.0),
];
// </coefficients>
