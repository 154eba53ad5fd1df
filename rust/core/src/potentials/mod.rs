//! Potential energies `V(r)`: one file each, used by central fields, pair forces and scattering alike.
//!
//! To add one, write a file with a type that implements [`Formula`] and add its line to
//! [`registry::POTENTIALS`](crate::registry::POTENTIALS). Its Python class, parameter checks,
//! documentation and property tests follow from what [`Formula::DECLARATION`] says.

pub mod coulomb;
pub mod kernels;
pub mod lennard_jones;
pub mod parameters;
pub mod yukawa;

use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::Exponential;
use crate::numerics::lanes::Lanes;
use crate::units::Units;
use core::fmt::Debug;
use kernels::{Around, around_tier};
use parameters::{Declaration, Value};
use std::sync::Arc;

/// What a potential declares about itself.
pub type PotentialDeclaration = Declaration<dyn Potential>;

/// A potential energy as written by its author: formulas generic over the scalar.
pub trait Formula: Debug + Send + Sync + Sized + 'static {
    /// What it declares about itself.
    const DECLARATION: &'static PotentialDeclaration;
    /// Whether it diverges at r = 0.
    const SINGULAR: bool;

    /// From the values of its parameters, which are what the declaration says.
    fn new(values: &[Value]) -> Self;
    /// V(r).
    fn value<S: Exponential>(&self, r: S) -> S;
    /// −dV/dr.
    fn force<S: Exponential>(&self, r: S) -> S;
    /// d²V/dr².
    fn curvature<S: Exponential>(&self, r: S) -> S;
    /// `k` if V = k/r.
    fn inverse_distance_strength(&self) -> Option<f64> {
        None
    }
}

/// A potential energy as the rest of the core holds it.
pub trait Potential: Debug + Send + Sync {
    /// What it declares about itself.
    fn declaration(&self) -> &'static PotentialDeclaration;
    /// Whether it diverges at r = 0.
    fn singular(&self) -> bool;
    /// V(r), −dV/dr and d²V/dr² at each distance.
    fn evaluate(&self, r: &[f64]) -> [Vec<f64>; 3];
    /// V(r) and −dV/dr to about thirty digits.
    fn precise(&self, r: DoubleDouble) -> (DoubleDouble, DoubleDouble);
    /// The same potential in other units.
    fn scaled(&self, units: Units) -> Arc<dyn Potential>;
    /// `k` if V = k/r.
    fn inverse_distance_strength(&self) -> Option<f64>;
    /// Writes the accelerations of bodies around a fixed point, or adds them.
    fn around(&self, field: &Around, q: &[Lanes], a: &mut [Lanes], first: bool);
}

/// A formula and the values it was made from.
#[derive(Debug)]
struct Held<P> {
    formula: P,
    values: Vec<Value>,
}

/// The potential of a formula; what its declaration makes.
///
/// # Errors
/// None.
pub fn held<P: Formula>(values: &[Value]) -> Result<Arc<dyn Potential>> {
    Ok(Arc::new(Held { formula: P::new(values), values: values.to_vec() }))
}

impl<P: Formula> Potential for Held<P> {
    fn declaration(&self) -> &'static PotentialDeclaration {
        P::DECLARATION
    }
    fn singular(&self) -> bool {
        P::SINGULAR
    }
    fn evaluate(&self, r: &[f64]) -> [Vec<f64>; 3] {
        [
            r.iter().map(|&r| self.formula.value(r)).collect(),
            r.iter().map(|&r| self.formula.force(r)).collect(),
            r.iter().map(|&r| self.formula.curvature(r)).collect(),
        ]
    }
    fn precise(&self, r: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
        (self.formula.value(r), self.formula.force(r))
    }
    fn scaled(&self, units: Units) -> Arc<dyn Potential> {
        let values = P::DECLARATION.scaled(&self.values, units);
        Arc::new(Self { formula: P::new(&values), values })
    }
    fn inverse_distance_strength(&self) -> Option<f64> {
        self.formula.inverse_distance_strength()
    }
    fn around(&self, field: &Around, q: &[Lanes], a: &mut [Lanes], first: bool) {
        around_tier(&self.formula, field, q, a, first);
    }
}

#[cfg(test)]
mod tests;
