//! V = D [(1 − e^(−a(r − r_e)))² − 1]: two atoms that are bound.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};

/// V = D [(1 − e^(−a(r − r_e)))² − 1].
#[derive(Clone, Copy, Debug)]
pub struct Morse {
    depth: f64,
    a: f64,
    r_e: f64,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "morse",
    class_name: "Morse",
    summary: "The potential energy of a diatomic molecule",
    formula: "V(r) = depth ((1 - exp(-a (r - r_e)))^2 - 1)",
    notes: "It is finite at r = 0, where its force has no direction and is taken as none.",
    source: "P. M. Morse, Phys. Rev. 34 (1929) 57",
    example: ">>> vv.potentials.Morse(depth=4.5, a=1.0, r_e=0.75).value([0.75, 1000.0])\narray([-4.5, -0. ])",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::positive("depth", [2, 1, -2], "Depth of the well, energy"),
        Parameter::positive("a", [-1, 0, 0], "Inverse of its width"),
        Parameter::positive("r_e", [1, 0, 0], "Distance of equilibrium"),
    ],
    make: held::<Morse>,
};

impl Morse {
    #[inline(always)]
    fn decay<S: Analytic>(own: &Numbers<S>, r: S) -> S {
        ((own[2] - r) * own[1]).exp()
    }
}

impl Formula for Morse {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = false;

    fn new(values: &[Value]) -> Self {
        Self { depth: values[0].number(), a: values[1].number(), r_e: values[2].number() }
    }

    fn numbers(&self) -> Numbers<f64> {
        [self.depth, self.a, self.r_e, 0.0, 0.0]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let e = Self::decay(own, r);
        own[0] * (e * (e - S::splat(2.0)))
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let e = Self::decay(own, r);
        own[0] * (S::splat(2.0) * own[1]) * (e * (e - S::one()))
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let e = Self::decay(own, r);
        let a = own[1];
        own[0] * (S::splat(2.0) * own[1]) * a * (e * (e + e - S::one()))
    }
    #[inline(always)]
    fn all<S: Analytic>(&self, own: &Numbers<S>, r: S) -> [S; 3] {
        let e = Self::decay(own, r);
        let slope = own[0] * (S::splat(2.0) * own[1]);
        [
            own[0] * (e * (e - S::splat(2.0))),
            slope * (e * (e - S::one())),
            slope * own[1] * (e * (e + e - S::one())),
        ]
    }
}
