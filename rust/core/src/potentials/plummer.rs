//! V = k/√(r² + a²): 1/r, softened.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};

/// V = k/√(r² + a²).
#[derive(Clone, Copy, Debug)]
pub struct Plummer {
    k: f64,
    a: f64,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "plummer",
    class_name: "Plummer",
    summary: "The potential energy of a point in Plummer's sphere, or of two softened ones",
    formula: "V(r) = k / sqrt(r^2 + a^2)",
    notes: "",
    source: "H. C. Plummer, Mon. Not. R. Astron. Soc. 71 (1911) 460",
    example: ">>> vv.potentials.Plummer(k=-10.0, a=3.0).value([0.0, 4.0]).round(12)\narray([-3.33333333, -2.        ])",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::number(
            "k",
            [3, 1, -2],
            "Strength, energy times length; positive repels, negative attracts",
        ),
        Parameter::positive("a", [1, 0, 0], "Scale length"),
    ],
    make: held::<Plummer>,
};

impl Plummer {
    /// √(r² + a²), whose squares neither overflow nor vanish.
    #[inline(always)]
    fn distance<S: Analytic>(own: &Numbers<S>, r: S) -> S {
        let a = own[1];
        let (large, small) = (r.max(a), r.min(a));
        let ratio = small / large;
        large * (S::one() + ratio * ratio).sqrt()
    }
}

impl Formula for Plummer {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = false;

    fn new(values: &[Value]) -> Self {
        Self { k: values[0].number(), a: values[1].number() }
    }

    fn numbers(&self) -> Numbers<f64> {
        [self.k, self.a, self.a * self.a, 0.0, 0.0]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[0] / Self::distance(own, r)
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let distance = Self::distance(own, r);
        own[0] / distance * (r / distance) / distance
    }
    #[inline(always)]
    fn over_distance<S: Analytic>(&self, own: &Numbers<S>, r2: S) -> S {
        let square = r2 + own[2];
        own[0] / (square * square.sqrt())
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let distance = Self::distance(own, r);
        let (out, within) = (r / distance, own[1] / distance);
        own[0] / distance * (S::splat(2.0) * out * out - within * within) / distance / distance
    }
}
