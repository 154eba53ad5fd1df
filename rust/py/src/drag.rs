//! Drag of spheres, and throws against it.

use crate::errors::raised;
use pyo3::prelude::*;
use visviva_core::closed_forms::vertical::{with_linear_drag, with_quadratic_drag};
use visviva_core::forces::spheres;

/// Terminal speed, time and height of the apex, time and speed of the return of a throw straight up.
#[pyfunction]
pub(crate) fn drag_throw(speed: f64, g: f64, tau: Option<f64>, terminal_speed: f64) -> [f64; 5] {
    let throw = match tau {
        Some(tau) => with_linear_drag(speed, g, tau),
        None => with_quadratic_drag(speed, g, terminal_speed),
    };
    [throw.terminal_speed, throw.apex_time, throw.apex_height, throw.return_time, throw.return_speed]
}

/// The Reynolds number of a sphere.
#[pyfunction]
pub(crate) fn drag_reynolds_number(density: f64, radius: f64, speed: f64, viscosity: f64) -> f64 {
    spheres::reynolds_number(density, radius, speed, viscosity)
}

/// The coefficient of quadratic drag on a sphere; zero for what is not known.
#[pyfunction]
pub(crate) fn drag_quadratic(
    py: Python<'_>,
    density: f64,
    radius: f64,
    drag_coefficient: f64,
    viscosity: f64,
    speed: f64,
) -> PyResult<f64> {
    spheres::quadratic_coefficient(density, radius, drag_coefficient, [viscosity, speed])
        .map_err(|error| raised(py, error))
}

/// The time of linear drag on a sphere; zero for what is not known.
#[pyfunction]
pub(crate) fn drag_stokes(
    py: Python<'_>,
    mass: f64,
    radius: f64,
    viscosity: f64,
    density: f64,
    speed: f64,
) -> PyResult<f64> {
    spheres::stokes_time(mass, radius, viscosity, [density, speed]).map_err(|error| raised(py, error))
}

/// Where both laws give the same.
#[pyfunction]
pub(crate) fn drag_crossover_speed(density: f64, radius: f64, viscosity: f64, drag_coefficient: f64) -> f64 {
    spheres::crossover_speed(density, radius, viscosity, drag_coefficient)
}
