//! V = k·exp(−r/length)/r: a charge screened over a length.

use super::{Declaration, Formula, Parameter};
use crate::numerics::elementary::Exponential;
use crate::numerics::power_of_two::scale;
use std::sync::Arc;

/// V = k·exp(−r/length)/r.
#[derive(Clone, Copy, Debug)]
pub struct Yukawa {
    k: f64,
    length: f64,
}

/// What it declares about itself.
pub static DECLARATION: Declaration = Declaration {
    name: "yukawa",
    class_name: "Yukawa",
    summary: "Screened Coulomb potential energy.",
    formula: "V(r) = k exp(-r / length) / r",
    parameters: &[
        Parameter {
            name: "k",
            description: "strength at r << length, energy times length; positive repels, negative attracts",
            positive: false,
        },
        Parameter { name: "length", description: "screening length", positive: true },
    ],
    make: |parameters| Arc::new(Yukawa { k: parameters[0], length: parameters[1] }),
};

impl Formula for Yukawa {
    const DECLARATION: &'static Declaration = &DECLARATION;
    const SINGULAR: bool = true;

    #[inline(always)]
    fn value<S: Exponential>(&self, r: S) -> S {
        S::splat(self.k) * (-r / S::splat(self.length)).exp() / r
    }
    #[inline(always)]
    fn force<S: Exponential>(&self, r: S) -> S {
        // −dV/dr = V (1/r + 1/length)
        let s = r / S::splat(self.length);
        S::splat(self.k) * (-s).exp() * (S::one() + s) / (r * r)
    }
    #[inline(always)]
    fn curvature<S: Exponential>(&self, r: S) -> S {
        let s = r / S::splat(self.length);
        let polynomial = S::splat(2.0) + s * (S::splat(2.0) + s);
        S::splat(self.k) * (-s).exp() * polynomial / (r * r * r)
    }
    fn scaled(&self, length: i32, energy: i32) -> Self {
        Self { k: scale(self.k, -length - energy), length: scale(self.length, -length) }
    }
}
