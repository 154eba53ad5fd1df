//! V = k·exp(−r/length)/r: a charge screened over a length.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, PotentialDeclaration, held};

/// V = k·exp(−r/length)/r.
#[derive(Clone, Copy, Debug)]
pub struct Yukawa {
    k: f64,
    length: f64,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "yukawa",
    class_name: "Yukawa",
    summary: "Screened Coulomb potential energy.",
    formula: "V(r) = k exp(-r / length) / r",
    notes: "",
    source: "H. Yukawa, Proc. Phys.-Math. Soc. Japan 17 (1935) 48",
    example: ">>> vv.potentials.Yukawa(k=-1.0, length=2.0).rescaled(length=10.0)\nYukawa(k=-1000.0, length=20.0)",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::number(
            "k",
            [3, 1, -2],
            "strength at r << length, energy times length; positive repels, negative attracts",
        ),
        Parameter::positive("length", [1, 0, 0], "screening length"),
    ],
    make: held::<Yukawa>,
};

/// The exponential of minus this is nothing, and the square of this is a number.
const FAR: f64 = 1e100;

impl Yukawa {
    /// r/length, cut off where there is nothing left.
    #[inline(always)]
    fn lengths<S: Analytic>(&self, r: S) -> S {
        (r / S::splat(self.length)).min(S::splat(FAR))
    }
}

impl Formula for Yukawa {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = true;

    fn new(values: &[Value]) -> Self {
        Self { k: values[0].number(), length: values[1].number() }
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, r: S) -> S {
        S::splat(self.k) * (-r / S::splat(self.length)).exp() / r
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, r: S) -> S {
        // −dV/dr = V (1/r + 1/length)
        let s = self.lengths(r);
        S::splat(self.k) * (-s).exp() * (S::one() + s) / (r * r)
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, r: S) -> S {
        let s = self.lengths(r);
        let polynomial = S::splat(2.0) + s * (S::splat(2.0) + s);
        S::splat(self.k) * (-s).exp() * polynomial / (r * r * r)
    }
}
