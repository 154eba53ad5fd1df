//! Rigid bodies that forces and torques move, stepped on the engine of `ode` beside points.

pub mod acting;
pub mod bodies;
pub mod conserved;
pub mod controlled;
pub mod flows;
pub mod formula;
pub mod loads;
pub mod methods;
pub mod runge_kutta;
pub mod series;
pub mod splitting;
pub mod system;
pub mod turn;
pub mod vectors;

use crate::error::{Error, Result};
use crate::numerics::lanes::Lanes;
use crate::ode::state::State;
use crate::ode::stepper::Stepper;
use crate::ode::{Method, Scheme};
use acting::Loads;
use bodies::Arrangement;
use splitting::Pulls;

/// The method with step `h`, for bodies that lie so under these loads, beside points; with a tolerance in steps that follow
/// it, in parts of that length.
///
/// # Errors
/// As [`uncontrolled`].
pub fn body_stepper(
    method: &'static Method,
    (h, rtol): (f64, Option<f64>),
    assembly: (Arrangement, Loads),
    state: &State<Lanes>,
) -> Result<Box<dyn Stepper<Lanes>>> {
    match rtol {
        Some(rtol) => Ok(Box::new(controlled::Controlled::new(method, (h, rtol), assembly, state))),
        None => uncontrolled(method, (h, 0.0), assembly, state),
    }
}

/// The method with step `h`, its nodes counted from a time on.
///
/// # Errors
/// A method that has no form for bodies; plans refuse it.
fn uncontrolled(
    method: &'static Method,
    (h, since): (f64, f64),
    (arrangement, loads): (Arrangement, Loads),
    state: &State<Lanes>,
) -> Result<Box<dyn Stepper<Lanes>>> {
    let pulls = Pulls::new(arrangement, loads, since);
    match &method.scheme {
        Scheme::Splitting(table) | Scheme::NystromSplitting(table) => {
            Ok(Box::new(splitting::BodySplitting::new(table, h, pulls)))
        }
        Scheme::RungeKutta(tableau) => {
            Ok(Box::new(runge_kutta::BodyRungeKutta::new(tableau, h, pulls, state)))
        }
        _ => Err(Error::Internal(format!("{} has no form for rigid bodies", method.name))),
    }
}
