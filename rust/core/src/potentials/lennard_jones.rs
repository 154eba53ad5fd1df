//! V = 4ε[(σ/r)¹² − (σ/r)⁶]: neutral atoms.

use super::{Declaration, Formula, Parameter};
use crate::numerics::elementary::Exponential;
use crate::numerics::power_of_two::scale;
use std::sync::Arc;

/// V = 4ε[(σ/r)¹² − (σ/r)⁶].
#[derive(Clone, Copy, Debug)]
pub struct LennardJones {
    epsilon: f64,
    sigma: f64,
}

/// What it declares about itself.
pub static DECLARATION: Declaration = Declaration {
    name: "lennard_jones",
    class_name: "LennardJones",
    summary: "The 12-6 potential energy of two neutral atoms.",
    formula: "V(r) = 4 epsilon ((sigma / r)^12 - (sigma / r)^6)",
    parameters: &[
        Parameter { name: "epsilon", description: "depth of the well, energy", positive: true },
        Parameter { name: "sigma", description: "distance at which V = 0", positive: true },
    ],
    make: |parameters| Arc::new(LennardJones { epsilon: parameters[0], sigma: parameters[1] }),
};

impl LennardJones {
    /// (σ/r)⁶.
    #[inline(always)]
    fn sixth_power<S: Exponential>(&self, r: S) -> S {
        let ratio = S::splat(self.sigma) / r;
        let square = ratio * ratio;
        square * square * square
    }
}

impl Formula for LennardJones {
    const DECLARATION: &'static Declaration = &DECLARATION;
    const SINGULAR: bool = true;

    #[inline(always)]
    fn value<S: Exponential>(&self, r: S) -> S {
        let sixth = self.sixth_power(r);
        S::splat(4.0 * self.epsilon) * (sixth * (sixth - S::one()))
    }
    #[inline(always)]
    fn force<S: Exponential>(&self, r: S) -> S {
        let sixth = self.sixth_power(r);
        S::splat(24.0 * self.epsilon) * (sixth * (sixth + sixth - S::one())) / r
    }
    #[inline(always)]
    fn curvature<S: Exponential>(&self, r: S) -> S {
        let sixth = self.sixth_power(r);
        let bracket = sixth * (S::splat(26.0) * sixth - S::splat(7.0));
        S::splat(24.0 * self.epsilon) * bracket / (r * r)
    }
    fn scaled(&self, length: i32, energy: i32) -> Self {
        Self { epsilon: scale(self.epsilon, -energy), sigma: scale(self.sigma, -length) }
    }
}
