//! Taylor series of the motion itself, to as high an order as the tolerance asks for.
//!
//! The coefficients follow one from another by recurrences that each force brings along, so a step costs a few
//! convolutions, is as long as the series allows, and comes with its continuous extension. Orders and steps: Jorba & Zou,
//! Experimental Mathematics 14 (2005) 99; Biscani & Izzo, MNRAS 504 (2021) 2614.

use crate::ode::{Method, Scheme, Taylor};

/// Adaptive Taylor series.
pub static METHOD: Method = Method {
    name: "taylor",
    summary: "Adaptive, order 8 to 22 as the tolerance asks: the fastest for smooth forces, at any accuracy.",
    order: 22,
    stages: 1,
    symplectic: false,
    reversible: false,
    dense_order: 22,
    reference: "Jorba & Zou, Experimental Mathematics 14 (2005) 99; Biscani & Izzo, MNRAS 504 (2021) 2614",
    scheme: Scheme::Taylor(Taylor { lowest: 8, highest: 22 }),
};
