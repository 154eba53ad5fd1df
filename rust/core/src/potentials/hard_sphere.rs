//! V = ∞ within a radius: what nothing enters.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};

/// V = ∞ within a radius.
#[derive(Clone, Copy, Debug)]
pub struct HardSphere {
    radius: f64,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "hard_sphere",
    class_name: "HardSphere",
    summary: "A sphere that nothing enters",
    formula: "V(r) = infinity where r < radius, else 0",
    notes: "It jumps, so there is no finite force: it has values, and no scene takes it.",
    source: "Landau & Lifshitz, Mechanics, 3rd ed., section 18, problem 1",
    example: ">>> vv.potentials.HardSphere(radius=1.0).value([0.5, 1.0])\narray([inf,  0.])",
    at_rest: "",
    one_way: "",
    parameters: &[Parameter::positive("radius", [1, 0, 0], "Its radius; of two spheres, the sum of theirs")],
    make: held::<HardSphere>,
};

impl Formula for HardSphere {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = false;
    const JUMPS: bool = true;

    fn new(values: &[Value]) -> Self {
        Self { radius: values[0].number() }
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, _: &Numbers<S>, r: S) -> S {
        S::select(r.less(S::splat(self.radius)), S::splat(f64::INFINITY), S::zero())
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, _: &Numbers<S>, _: S) -> S {
        S::splat(f64::NAN)
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, _: &Numbers<S>, _: S) -> S {
        S::splat(f64::NAN)
    }
}
