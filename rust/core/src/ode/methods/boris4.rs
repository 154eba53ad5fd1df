//! Suzuki's composition of five steps of Boris's method: order 4, with velocities turned exactly in the middle of
//! every kick.
//!
//! A kick with its turning is no flow that could be parted, so that whole steps are composed and only drifts are
//! merged.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, ZERO, dd};

/// Boris's method at order 4.
pub static METHOD: Method = Method {
    name: "boris4",
    summary: "Order 4, five force evaluations per step, velocities turned exactly: charges in magnetic fields at higher accuracy.",
    order: 4,
    stages: 5,
    symplectic: true,
    reversible: true,
    dense_order: 4,
    reference: "Suzuki, Phys. Lett. A 146 (1990) 319; He, Sun, Liu & Qin, J. Comput. Phys. 305 (2016) 172",
    scheme: Scheme::Boris(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    ZERO, dd(0.4144907717943757, 2.5197374150855977e-17), dd(0.4144907717943757, 2.5197374150855977e-17),
    dd(-0.657963087177503, 1.023280585909174e-17), dd(0.4144907717943757, 2.5197374150855977e-17),
    dd(0.4144907717943757, 2.5197374150855977e-17), ZERO,
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.20724538589718786, 1.2598687075427989e-17), dd(0.4144907717943757, 2.5197374150855977e-17),
    dd(-0.12173615769156361, 3.837302197159402e-18), dd(-0.12173615769156361, 3.837302197159402e-18),
    dd(0.4144907717943757, 2.5197374150855977e-17), dd(0.20724538589718786, 1.2598687075427989e-17),
];
// </coefficients>
