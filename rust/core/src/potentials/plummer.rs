//! V = k/√(r² + a²): 1/r, softened.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, PotentialDeclaration, held};

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
            "strength, energy times length; positive repels, negative attracts",
        ),
        Parameter::positive("a", [1, 0, 0], "scale length"),
    ],
    make: held::<Plummer>,
};

impl Plummer {
    /// √(r² + a²), whose squares neither overflow nor vanish.
    #[inline(always)]
    fn distance<S: Analytic>(&self, r: S) -> S {
        let a = S::splat(self.a);
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

    #[inline(always)]
    fn value<S: Analytic>(&self, r: S) -> S {
        S::splat(self.k) / self.distance(r)
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, r: S) -> S {
        let distance = self.distance(r);
        S::splat(self.k) / distance * (r / distance) / distance
    }
    #[inline(always)]
    fn over_distance<S: Analytic>(&self, r2: S) -> S {
        let square = r2 + S::splat(self.a * self.a);
        S::splat(self.k) / (square * square.sqrt())
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, r: S) -> S {
        let distance = self.distance(r);
        let (out, within) = (r / distance, S::splat(self.a) / distance);
        S::splat(self.k) / distance * (S::splat(2.0) * out * out - within * within) / distance / distance
    }
}
