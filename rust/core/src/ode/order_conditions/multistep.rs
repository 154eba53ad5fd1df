//! Order conditions of a multistep table: powers of the time.
//!
//! Order `p` means that the formulas are exact for accelerations `t^k`, `k < p`. The time is counted from the present
//! node, in units of the oldest, so that no term is larger than its coefficient.
//! Source: Hairer, Nørsett & Wanner, *Solving ODE I*, III.10.

use super::super::Multistep;
use super::{Family, Kind};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// A table that a test may change.
#[derive(Clone)]
pub(super) struct Table {
    second_differences: Vec<DoubleDouble>,
    velocity: Vec<DoubleDouble>,
}

impl From<&Multistep> for Table {
    fn from(method: &Multistep) -> Self {
        Self { second_differences: method.second_differences.to_vec(), velocity: method.velocity.to_vec() }
    }
}

/// The acceleration `t^exponent`, and what belongs to it.
struct Power {
    exponent: usize,
    unit: f64,
}

impl Power {
    /// At `steps` steps from the present node.
    fn at(&self, steps: f64) -> DoubleDouble {
        let t = DoubleDouble::from(steps) / DoubleDouble::from(self.unit);
        (0..self.exponent).fold(DoubleDouble::one(), |power, _| power * t)
    }
    /// The coordinate at `steps` steps, over h²: it and its velocity are zero at the present node.
    fn coordinate(&self, steps: f64) -> DoubleDouble {
        let denominator = DoubleDouble::from(((self.exponent + 1) * (self.exponent + 2)) as f64);
        self.at(steps) * DoubleDouble::from(steps * steps) / denominator
    }
    /// `weight` times the difference of accelerations that begins at the node of age `age`, and its magnitude were
    /// nothing to cancel.
    fn difference(&self, weight: DoubleDouble, binomials: &[f64], age: f64) -> (DoubleDouble, f64) {
        let mut found = (DoubleDouble::zero(), 0.0);
        for (&binomial, more) in binomials.iter().zip(0_u32..) {
            let term = weight * DoubleDouble::from(binomial) * self.at(-age - f64::from(more));
            found = (found.0 + term, found.1 + term.to_f64().abs());
        }
        found
    }
}

/// The sum of terms, and that of their magnitudes.
fn sum(terms: impl Iterator<Item = (DoubleDouble, f64)>) -> (DoubleDouble, f64) {
    terms.fold((DoubleDouble::zero(), 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1))
}

impl Table {
    /// Every coefficient, to be changed.
    pub(super) fn coefficients(&mut self) -> Vec<&mut DoubleDouble> {
        self.second_differences.iter_mut().chain(&mut self.velocity).collect()
    }

    /// The worst miss of each family of conditions.
    pub(super) fn misses(&self, order: usize) -> Vec<Family> {
        let (mut step, mut velocity) = (Family::new(Kind::Step), Family::new(Kind::Velocity));
        let unit = (self.second_differences.len() + 1) as f64;
        for exponent in 0..order {
            let power = Power { exponent, unit };
            let second = |(&weight, age): (&DoubleDouble, u32)| {
                power.difference(weight, &[1.0, -2.0, 1.0], f64::from(age))
            };
            let whole = power.difference(DoubleDouble::one(), &[1.0], 0.0);
            let older = self.second_differences.iter().zip(0..).map(second);
            let (found, size) = sum(core::iter::once(whole).chain(older));
            step.note(found, power.coordinate(1.0) + power.coordinate(-1.0), size);

            let (present, older) = self.velocity.split_at(2);
            let present =
                [power.difference(present[0], &[1.0], 0.0), power.difference(present[1], &[1.0, -1.0], 0.0)];
            let (found, size) = sum(present.into_iter().chain(older.iter().zip(0..).map(second)));
            velocity.note(found, power.coordinate(-1.0), size);
        }
        vec![step, velocity]
    }
}
