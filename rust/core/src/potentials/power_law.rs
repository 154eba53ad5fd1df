//! V = k/rⁿ.

use super::parameters::{Declaration, Kind, Parameter, Sign, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};
use crate::numerics::power::Power;
use crate::numerics::power_of_two::{exponent, scale};
use crate::units::Units;

/// V = k/rⁿ, in the units in which it was given: those of others are powers of two in front of it, so that a broken
/// exponent has the same bits in all of them.
#[derive(Clone, Copy, Debug)]
pub struct PowerLaw {
    significand: f64,
    /// The exponent of k, which is in the power.
    unit: i32,
    n: f64,
    power: Power,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "power_law",
    class_name: "PowerLaw",
    summary: "A power of the distance",
    formula: "V(r) = k / r^n",
    notes: "Exponents that are whole, up to 64, are multiplied out. The dimension of k depends on n.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 3.5",
    example: ">>> vv.potentials.PowerLaw(k=3.0, n=2.0).value([1.0, 2.0])\narray([3.  , 0.75])",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::new(
            "k",
            Kind::Number(Sign::Any),
            "Strength, energy times length^n, so that its dimension depends on n; positive repels",
        )
        .depending(|values| [2.0 + values[1].number(), 1.0, -2.0]),
        Parameter::positive("n", [0, 0, 0], "Exponent"),
    ],
    make: held::<PowerLaw>,
};

impl Formula for PowerLaw {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = true;

    fn new(values: &[Value]) -> Self {
        let (k, n) = (values[0].number(), values[1].number());
        let unit = exponent(k);
        Self { significand: scale(k, -unit), unit, n, power: Power::new(-n).scaled(0, unit) }
    }
    fn scaled(&self, _: &[Value], units: Units) -> Self {
        let energy = units.mass + 2 * (units.length - units.time);
        Self { power: self.power.scaled(units.length, -energy), ..*self }
    }

    fn numbers(&self) -> Numbers<f64> {
        [self.significand, 0.0, 0.0, 0.0, 0.0]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(vec![self.n.to_bits(), self.unit as u64])
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[0] * r.power(&self.power)
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        S::splat(self.n) * self.value(own, r) / r
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        S::splat(self.n * (self.n + 1.0)) * self.value(own, r) / r / r
    }
}
