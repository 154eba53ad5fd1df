//! V = k/r: charges, and gravity with k = −G·m·M.

use super::{Declaration, Formula, Parameter};
use crate::numerics::elementary::Exponential;
use crate::numerics::power_of_two::scale;
use std::sync::Arc;

/// V = k/r.
#[derive(Clone, Copy, Debug)]
pub struct Coulomb {
    k: f64,
}

/// What it declares about itself.
pub static DECLARATION: Declaration = Declaration {
    name: "coulomb",
    class_name: "Coulomb",
    summary: "Inverse-distance potential energy of two charges, or of gravity with k = -G m M.",
    formula: "V(r) = k / r",
    parameters: &[Parameter {
        name: "k",
        description: "strength, energy times length; positive repels, negative attracts",
        positive: false,
    }],
    make: |parameters| Arc::new(Coulomb { k: parameters[0] }),
};

impl Formula for Coulomb {
    const DECLARATION: &'static Declaration = &DECLARATION;
    const SINGULAR: bool = true;

    #[inline(always)]
    fn value<S: Exponential>(&self, r: S) -> S {
        S::splat(self.k) / r
    }
    #[inline(always)]
    fn force<S: Exponential>(&self, r: S) -> S {
        S::splat(self.k) / (r * r)
    }
    #[inline(always)]
    fn curvature<S: Exponential>(&self, r: S) -> S {
        S::splat(2.0 * self.k) / (r * r * r)
    }
    fn scaled(&self, length: i32, energy: i32) -> Self {
        Self { k: scale(self.k, -length - energy) }
    }
    fn inverse_distance_strength(&self) -> Option<f64> {
        Some(self.k)
    }
}
