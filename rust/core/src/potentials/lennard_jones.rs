//! V = 4ε[(σ/r)¹² − (σ/r)⁶]: neutral atoms.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};

/// V = 4ε[(σ/r)¹² − (σ/r)⁶].
#[derive(Clone, Copy, Debug)]
pub struct LennardJones {
    epsilon: f64,
    sigma: f64,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "lennard_jones",
    class_name: "LennardJones",
    summary: "The 12-6 potential energy of two neutral atoms.",
    formula: "V(r) = 4 epsilon ((sigma / r)^12 - (sigma / r)^6)",
    notes: "",
    source: "J. E. Jones, Proc. R. Soc. A 106 (1924) 463",
    example: ">>> vv.potentials.LennardJones(epsilon=1.0, sigma=1.0).value([1.0, 2.0 ** (1 / 6)]).round(12) + 0.0\narray([ 0., -1.])",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::positive("epsilon", [2, 1, -2], "Depth of the well, energy"),
        Parameter::positive("sigma", [1, 0, 0], "Distance at which V = 0"),
    ],
    make: held::<LennardJones>,
};

impl LennardJones {
    /// (σ/r)⁶.
    #[inline(always)]
    fn sixth_power<S: Analytic>(own: &Numbers<S>, r: S) -> S {
        let ratio = own[1] / r;
        let square = ratio * ratio;
        square * square * square
    }
}

impl Formula for LennardJones {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = true;

    fn new(values: &[Value]) -> Self {
        Self { epsilon: values[0].number(), sigma: values[1].number() }
    }

    fn numbers(&self) -> Numbers<f64> {
        [self.epsilon, self.sigma, 24.0 * self.epsilon, self.sigma * self.sigma, 0.0]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let sixth = Self::sixth_power(own, r);
        S::splat(4.0) * own[0] * (sixth * (sixth - S::one()))
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let sixth = Self::sixth_power(own, r);
        own[2] * (sixth * (sixth + sixth - S::one())) / r
    }
    #[inline(always)]
    fn over_distance<S: Analytic>(&self, own: &Numbers<S>, r2: S) -> S {
        let inverse = S::one() / r2;
        let ratio = own[3] * inverse;
        let sixth = ratio * ratio * ratio;
        own[2] * (sixth * (sixth + sixth - S::one())) * inverse
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let sixth = Self::sixth_power(own, r);
        let bracket = sixth * (S::splat(26.0) * sixth - S::splat(7.0));
        own[2] * bracket / (r * r)
    }
    #[inline(always)]
    fn all<S: Analytic>(&self, own: &Numbers<S>, r: S) -> [S; 3] {
        let sixth = Self::sixth_power(own, r);
        let bend = sixth * (S::splat(26.0) * sixth - S::splat(7.0));
        [
            S::splat(4.0) * own[0] * (sixth * (sixth - S::one())),
            own[2] * (sixth * (sixth + sixth - S::one())) / r,
            own[2] * bend / (r * r),
        ]
    }
}
