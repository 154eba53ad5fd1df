//! V = C ε [(σ/r)ⁿ − (σ/r)ᵐ]: Lennard-Jones with exponents of one's own.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};
use crate::error::{Error, Result};
use crate::numerics::power::{Power, Powers};
use crate::words::number;

/// V = C ε [(σ/r)ⁿ − (σ/r)ᵐ] with C that makes ε the depth.
#[derive(Clone, Copy, Debug)]
pub struct Mie {
    strength: f64,
    sigma: f64,
    exponents: [f64; 2],
    /// (σ/r)ᵐ, and (σ/r)ⁿ⁻ᵐ, by which the repelling term is more.
    powers: [Power; 2],
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "mie",
    class_name: "Mie",
    summary: "The n-m potential energy of two neutral atoms",
    formula: "V(r) = C epsilon ((sigma / r)^n - (sigma / r)^m) with C = n / (n - m) (n / m)^(m / (n - m))",
    notes: "With n = 12 and m = 6 it is LennardJones. Its minimum, -epsilon, is at sigma (n / m)^(1 / (n - m)).",
    source: "G. Mie, Ann. Phys. 316 (1903) 657",
    example: ">>> vv.potentials.Mie(epsilon=1.0, sigma=1.0, n=12.0, m=6.0).value([1.0, 2.0 ** (1 / 6)]).round(12) + 0.0\n\
              array([ 0., -1.])",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::positive("epsilon", [2, 1, -2], "Depth of the well, energy"),
        Parameter::positive("sigma", [1, 0, 0], "Distance at which V = 0"),
        Parameter::positive("n", [0, 0, 0], "Exponent of the repelling term"),
        Parameter::positive("m", [0, 0, 0], "Exponent of the attracting term, less than n"),
    ],
    make: |values| {
        check(values[2].number(), values[3].number())?;
        held::<Mie>(values)
    },
};

fn check(n: f64, m: f64) -> Result<()> {
    if m >= n {
        return Err(Error::invalid("m", format!("expected less than n = {}, got {}", number(n), number(m))));
    }
    if !factor(n, m).is_finite() {
        let message = format!("expected exponents that are not as near as {} and {}", number(n), number(m));
        return Err(Error::invalid("m", message));
    }
    Ok(())
}

/// What makes ε the depth.
fn factor(n: f64, m: f64) -> f64 {
    n / (n - m) * (n / m).power(&Power::new(m / (n - m)))
}

impl Formula for Mie {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = true;

    fn new(values: &[Value]) -> Self {
        let [epsilon, sigma, n, m] = [0, 1, 2, 3].map(|at: usize| values[at].number());
        let powers = [Power::new(m), Power::new(n - m)];
        Self { strength: epsilon * factor(n, m), sigma, exponents: [n, m], powers }
    }

    fn numbers(&self) -> Numbers<f64> {
        [self.strength, self.sigma, 0.0, 0.0, 0.0]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(self.exponents.map(f64::to_bits).to_vec())
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let ratio = own[1] / r;
        own[0] * (ratio.power(&self.powers[0]) * (ratio.power(&self.powers[1]) - S::one()))
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let ratio = own[1] / r;
        let [n, m] = self.exponents.map(S::splat);
        let bracket = n * ratio.power(&self.powers[1]) - m;
        own[0] * (ratio.power(&self.powers[0]) * bracket) / r
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let ratio = own[1] / r;
        let [n, m] = self.exponents.map(|x| S::splat(x * (x + 1.0)));
        let bracket = n * ratio.power(&self.powers[1]) - m;
        own[0] * (ratio.power(&self.powers[0]) * bracket) / r / r
    }
    #[inline(always)]
    fn all<S: Analytic>(&self, own: &Numbers<S>, r: S) -> [S; 3] {
        let ratio = own[1] / r;
        let (slow, fast) = (ratio.power(&self.powers[0]), ratio.power(&self.powers[1]));
        let [n, m] = self.exponents;
        let slope = S::splat(n) * fast - S::splat(m);
        let bend = S::splat(n * (n + 1.0)) * fast - S::splat(m * (m + 1.0));
        [own[0] * (slow * (fast - S::one())), own[0] * (slow * slope) / r, own[0] * (slow * bend) / r / r]
    }
}
