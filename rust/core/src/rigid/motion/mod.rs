//! Rigid bodies that forces and torques move, stepped on the engine of `ode` beside points.

pub mod acting;
pub mod bodies;
pub mod conserved;
pub mod flows;
pub mod loads;
pub mod methods;
pub mod runge_kutta;
pub mod splitting;
pub mod turn;
pub mod vectors;

use crate::error::{Error, Result};
use crate::numerics::lanes::Lanes;
use crate::ode::state::State;
use crate::ode::stepper::Stepper;
use crate::ode::{Method, Scheme};
use acting::Loads;
use bodies::Arrangement;

/// The method with step `h`, for bodies that lie so under these loads, beside points.
///
/// # Errors
/// A method that has no form for bodies; plans refuse it.
pub fn body_stepper(
    method: &'static Method,
    h: f64,
    assembly: (Arrangement, Loads),
    state: &State<Lanes>,
) -> Result<Box<dyn Stepper<Lanes>>> {
    match &method.scheme {
        Scheme::Splitting(table) | Scheme::NystromSplitting(table) => {
            Ok(Box::new(splitting::BodySplitting::new(table, h, assembly)))
        }
        Scheme::RungeKutta(tableau) => {
            Ok(Box::new(runge_kutta::BodyRungeKutta::new(tableau, h, assembly, state)))
        }
        _ => Err(Error::Internal(format!("{} has no form for rigid bodies", method.name))),
    }
}
