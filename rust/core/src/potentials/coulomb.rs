//! V = k/r: charges, and gravity with k = −G·m·M.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};

/// V = k/r.
#[derive(Clone, Copy, Debug)]
pub struct Coulomb {
    k: f64,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "coulomb",
    class_name: "Coulomb",
    summary: "Inverse-distance potential energy of two charges, or of gravity with k = -G m M.",
    formula: "V(r) = k / r",
    notes: "",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 3.7",
    example: ">>> vv.potentials.Coulomb(k=2.0).value([1.0, 4.0])\narray([2. , 0.5])",
    at_rest: "",
    one_way: "",
    parameters: &[Parameter::number(
        "k",
        [3, 1, -2],
        "Strength, energy times length; positive repels, negative attracts",
    )],
    make: held::<Coulomb>,
};

impl Formula for Coulomb {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = true;

    fn new(values: &[Value]) -> Self {
        Self { k: values[0].number() }
    }

    fn numbers(&self) -> Numbers<f64> {
        [self.k, 0.0, 0.0, 0.0, 0.0]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[0] / r
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[0] / (r * r)
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        S::splat(2.0) * own[0] / (r * r * r)
    }
    fn inverse_distance_strength(&self) -> Option<f64> {
        Some(self.k)
    }
}
