//! Potential energies `V(r)`: one file each, used by central fields, pair forces and scattering alike.
//!
//! To add one, write a file with a type that implements [`Formula`] and add its line to
//! [`registry::POTENTIALS`](crate::registry::POTENTIALS). Its Python class, parameter checks,
//! documentation and property tests follow from what [`Formula::DECLARATION`] says.

pub mod coulomb;
pub mod lennard_jones;
pub mod yukawa;

use crate::error::{Error, Result};
use crate::forces::Force;
use crate::forces::central_field::CentralField;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::Shape;
use crate::numerics::elementary::Exponential;
use crate::numerics::lanes::Lanes;
use crate::words::number;
use core::fmt::Debug;
use std::sync::Arc;

/// What a parameter of a potential is.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name in the Python interface.
    pub name: &'static str,
    /// What it means, with its dimension.
    pub description: &'static str,
    /// Whether it must be above zero.
    pub positive: bool,
}

/// What a potential declares about itself.
#[derive(Debug)]
pub struct Declaration {
    /// Its name in the registry.
    pub name: &'static str,
    /// The name of its Python class.
    pub class_name: &'static str,
    /// One line on what it is for.
    pub summary: &'static str,
    /// `V(r)` in terms of the parameters.
    pub formula: &'static str,
    /// Its parameters, in order.
    pub parameters: &'static [Parameter],
    /// Makes one from its parameters, already checked against the declaration.
    pub make: fn(&[f64]) -> Arc<dyn Potential>,
}

/// A potential energy as written by its author: formulas generic over the scalar.
pub trait Formula: Copy + Debug + Send + Sync + 'static {
    /// What it declares about itself.
    const DECLARATION: &'static Declaration;
    /// Whether it diverges at r = 0.
    const SINGULAR: bool;

    /// V(r).
    fn value<S: Exponential>(&self, r: S) -> S;
    /// −dV/dr.
    fn force<S: Exponential>(&self, r: S) -> S;
    /// d²V/dr².
    fn curvature<S: Exponential>(&self, r: S) -> S;
    /// The same potential when lengths are divided by `2^length` and energies by `2^energy`.
    fn scaled(&self, length: i32, energy: i32) -> Self;
    /// `k` if V = k/r.
    fn inverse_distance_strength(&self) -> Option<f64> {
        None
    }
}

/// A potential energy as the rest of the core holds it.
pub trait Potential: Debug + Send + Sync {
    /// What it declares about itself.
    fn declaration(&self) -> &'static Declaration;
    /// Whether it diverges at r = 0.
    fn singular(&self) -> bool;
    /// V(r), −dV/dr and d²V/dr² at each distance.
    fn evaluate(&self, r: &[f64]) -> [Vec<f64>; 3];
    /// V(r) to about thirty digits.
    fn precise_value(&self, r: DoubleDouble) -> DoubleDouble;
    /// −dV/dr to about thirty digits.
    fn precise_force(&self, r: DoubleDouble) -> DoubleDouble;
    /// The same potential when lengths are divided by `2^length` and energies by `2^energy`.
    fn scaled(&self, length: i32, energy: i32) -> Arc<dyn Potential>;
    /// `k` if V = k/r.
    fn inverse_distance_strength(&self) -> Option<f64>;
    /// The force of a fixed centre, ready to run.
    fn central_force(
        &self,
        shape: Shape,
        center: [f64; 3],
        inverse_mass: Vec<Lanes>,
    ) -> Box<dyn Force<Lanes>>;
}

impl<P: Formula> Potential for P {
    fn declaration(&self) -> &'static Declaration {
        P::DECLARATION
    }
    fn singular(&self) -> bool {
        P::SINGULAR
    }
    fn evaluate(&self, r: &[f64]) -> [Vec<f64>; 3] {
        [
            r.iter().map(|&r| self.value(r)).collect(),
            r.iter().map(|&r| self.force(r)).collect(),
            r.iter().map(|&r| self.curvature(r)).collect(),
        ]
    }
    fn precise_value(&self, r: DoubleDouble) -> DoubleDouble {
        self.value(r)
    }
    fn precise_force(&self, r: DoubleDouble) -> DoubleDouble {
        self.force(r)
    }
    fn scaled(&self, length: i32, energy: i32) -> Arc<dyn Potential> {
        Arc::new(Formula::scaled(self, length, energy))
    }
    fn inverse_distance_strength(&self) -> Option<f64> {
        Formula::inverse_distance_strength(self)
    }
    fn central_force(
        &self,
        shape: Shape,
        center: [f64; 3],
        inverse_mass: Vec<Lanes>,
    ) -> Box<dyn Force<Lanes>> {
        Box::new(CentralField::new(*self, shape, center, inverse_mass))
    }
}

impl Declaration {
    /// Makes the potential after checking its parameters.
    ///
    /// # Errors
    /// The wrong number of parameters, one that is not finite, or not positive where it must be.
    pub fn build(&self, parameters: &[f64]) -> Result<Arc<dyn Potential>> {
        if parameters.len() != self.parameters.len() {
            let names: Vec<&str> = self.parameters.iter().map(|parameter| parameter.name).collect();
            return Err(Error::invalid(
                "parameters",
                format!("{} takes {}, got {} numbers", self.class_name, names.join(", "), parameters.len()),
            ));
        }
        for (parameter, &value) in self.parameters.iter().zip(parameters) {
            if !value.is_finite() || (parameter.positive && value <= 0.0) {
                let kind = if parameter.positive { "a finite number above 0" } else { "a finite number" };
                return Err(Error::invalid(
                    parameter.name,
                    format!(
                        "{} expected {kind} ({}), got {}",
                        self.class_name,
                        parameter.description,
                        number(value)
                    ),
                ));
            }
        }
        Ok((self.make)(parameters))
    }
}

#[cfg(test)]
mod tests;
