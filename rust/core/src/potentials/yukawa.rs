//! V = k·exp(−r/length)/r: a charge screened over a length.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};

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
            "Strength at r << length, energy times length; positive repels, negative attracts",
        ),
        Parameter::positive("length", [1, 0, 0], "Screening length"),
    ],
    make: held::<Yukawa>,
};

/// The exponential of minus this is nothing, and the square of this is a number.
const FAR: f64 = 1e100;

impl Yukawa {
    /// r/length, cut off where there is nothing left.
    #[inline(always)]
    fn lengths<S: Analytic>(own: &Numbers<S>, r: S) -> S {
        (r / own[1]).min(S::splat(FAR))
    }
}

impl Formula for Yukawa {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = true;

    fn new(values: &[Value]) -> Self {
        Self { k: values[0].number(), length: values[1].number() }
    }

    fn numbers(&self) -> Numbers<f64> {
        [self.k, self.length, 0.0, 0.0, 0.0]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[0] * (-r / own[1]).exp() / r
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        // −dV/dr = V (1/r + 1/length)
        let s = Self::lengths(own, r);
        own[0] * (-s).exp() * (S::one() + s) / (r * r)
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let s = Self::lengths(own, r);
        let polynomial = S::splat(2.0) + s * (S::splat(2.0) + s);
        own[0] * (-s).exp() * polynomial / (r * r * r)
    }
    #[inline(always)]
    fn all<S: Analytic>(&self, own: &Numbers<S>, r: S) -> [S; 3] {
        let s = Self::lengths(own, r);
        let decay = own[0] * (-s).exp();
        let polynomial = S::splat(2.0) + s * (S::splat(2.0) + s);
        [decay / r, decay * (S::one() + s) / (r * r), decay * polynomial / (r * r * r)]
    }
}
