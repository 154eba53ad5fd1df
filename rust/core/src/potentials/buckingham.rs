//! V = A e^(−br) − C/r⁶: closed shells.

use super::parameters::{Declaration, Kind, Parameter, Sign, Value};
use super::{Analytic, Formula, PotentialDeclaration, held};

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
        Parameter::new("A", Kind::Number(Sign::NotNegative), "strength of the repulsion, energy")
            .of([2, 1, -2]),
        Parameter::positive("b", [-1, 0, 0], "inverse of its range"),
        Parameter::new(
            "C",
            Kind::Number(Sign::NotNegative),
            "strength of the attraction, energy times length^6",
        )
        .of([8, 1, -2]),
    ],
    make: held::<Buckingham>,
};

impl Buckingham {
    /// e^(−br), and C/r⁶ times what is given, nothing if C is nothing.
    #[inline(always)]
    fn parts<S: Analytic>(&self, r: S, factor: f64) -> (S, S) {
        let inverse = S::one() / r;
        let square = inverse * inverse;
        let attraction = S::splat(self.c * factor) * (square * square * square);
        let decay = (-(S::splat(self.b) * r)).exp();
        (decay, if self.c == 0.0 { S::zero() } else { attraction })
    }
}

impl Formula for Buckingham {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = true;

    fn new(values: &[Value]) -> Self {
        Self { a: values[0].number(), b: values[1].number(), c: values[2].number() }
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, r: S) -> S {
        let (decay, attraction) = self.parts(r, 1.0);
        S::splat(self.a) * decay - attraction
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, r: S) -> S {
        let (decay, attraction) = self.parts(r, 6.0);
        let pull = if self.c == 0.0 { S::zero() } else { attraction / r };
        S::splat(self.a) * S::splat(self.b) * decay - pull
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, r: S) -> S {
        let (decay, attraction) = self.parts(r, 42.0);
        let bend = if self.c == 0.0 { S::zero() } else { attraction / r / r };
        S::splat(self.a) * S::splat(self.b) * S::splat(self.b) * decay - bend
    }
}
