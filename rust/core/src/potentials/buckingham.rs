//! V = A e^(−br) − C/r⁶: closed shells.

use super::parameters::{Declaration, Kind, Parameter, Sign, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};

/// V = A e^(−br) − C/r⁶.
#[derive(Clone, Copy, Debug)]
pub struct Buckingham {
    a: f64,
    b: f64,
    c: f64,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "buckingham",
    class_name: "Buckingham",
    summary: "The exponential-6 potential energy of two closed shells",
    formula: "V(r) = A exp(-b r) - C / r^6",
    notes: "It falls to minus infinity at r = 0, behind a barrier; with C = 0, that of Born and Mayer, it does not.",
    source: "R. A. Buckingham, Proc. R. Soc. A 168 (1938) 264",
    example: ">>> vv.potentials.Buckingham(A=1.0, b=1.0, C=2.0).value(2.0).round(6)\nnp.float64(0.104085)",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::new("A", Kind::Number(Sign::NotNegative), "Strength of the repulsion, energy")
            .of([2, 1, -2]),
        Parameter::positive("b", [-1, 0, 0], "Inverse of its range"),
        Parameter::new(
            "C",
            Kind::Number(Sign::NotNegative),
            "Strength of the attraction, energy times length^6",
        )
        .of([8, 1, -2]),
    ],
    make: held::<Buckingham>,
};

impl Buckingham {
    /// e^(−br), and what is given over r⁶, nothing if C is nothing.
    #[inline(always)]
    fn parts<S: Analytic>(&self, own: &Numbers<S>, r: S, strength: S) -> (S, S) {
        let inverse = S::one() / r;
        let square = inverse * inverse;
        let attraction = strength * (square * square * square);
        let decay = (-(own[1] * r)).exp();
        (decay, if self.c == 0.0 { S::zero() } else { attraction })
    }
}

impl Formula for Buckingham {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = true;

    fn new(values: &[Value]) -> Self {
        Self { a: values[0].number(), b: values[1].number(), c: values[2].number() }
    }

    fn numbers(&self) -> Numbers<f64> {
        [self.a, self.b, self.c, 6.0 * self.c, 42.0 * self.c]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(vec![u64::from(self.c == 0.0)])
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let (decay, attraction) = self.parts(own, r, own[2]);
        own[0] * decay - attraction
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let (decay, attraction) = self.parts(own, r, own[3]);
        let pull = if self.c == 0.0 { S::zero() } else { attraction / r };
        own[0] * own[1] * decay - pull
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let (decay, attraction) = self.parts(own, r, own[4]);
        let bend = if self.c == 0.0 { S::zero() } else { attraction / r / r };
        own[0] * own[1] * own[1] * decay - bend
    }
}
