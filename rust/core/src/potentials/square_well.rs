//! V = −depth within a radius: no force but on its edge.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};

/// V = −depth within a radius.
#[derive(Clone, Copy, Debug)]
pub struct SquareWell {
    depth: f64,
    radius: f64,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "square_well",
    class_name: "SquareWell",
    summary: "A constant potential energy within a radius",
    formula: "V(r) = -depth where r < radius, else 0",
    notes: "It jumps, so there is no finite force: it has values, and no scene takes it. A negative depth is a barrier.",
    source: "Landau & Lifshitz, Mechanics, 3rd ed., section 19, problem 2",
    example: ">>> vv.potentials.SquareWell(depth=2.0, radius=1.0).value([0.5, 1.0, 1.5])\narray([-2.,  0.,  0.])",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::number("depth", [2, 1, -2], "Depth of the well, energy"),
        Parameter::positive("radius", [1, 0, 0], "Its radius"),
    ],
    make: held::<SquareWell>,
};

impl Formula for SquareWell {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = false;
    const JUMPS: bool = true;

    fn new(values: &[Value]) -> Self {
        Self { depth: values[0].number(), radius: values[1].number() }
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, _: &Numbers<S>, r: S) -> S {
        S::select(r.less(S::splat(self.radius)), S::splat(0.0 - self.depth), S::zero())
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
