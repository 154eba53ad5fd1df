//! Rutherford's formulas over arrays.

use crate::arrays::{copied, moved};
use crate::gate::compute;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use visviva_core::scattering::kinematics::{Collision, solid_angle};
use visviva_core::scattering::rutherford;
use visviva_core::{Error, Result};

type Column<'py> = Bound<'py, PyArrayDyn<f64>>;

/// κ = k/2E.
#[pyfunction]
pub(crate) fn rutherford_half_distance(k: f64, energy: f64) -> f64 {
    rutherford::half_distance(k, energy)
}

/// A function of one array, by name, with up to two fixed numbers: see `visviva.scattering`.
///
/// `half_distance` is κ = k/2E; `mass_ratio` is m₁/m₂.
#[pyfunction]
pub(crate) fn scattering_function<'py>(
    py: Python<'py>,
    name: &str,
    half_distance: f64,
    mass_ratio: f64,
    values: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<Column<'py>> {
    let (values, shape) = copied("values", &values, [None])?;
    let result = compute(py, 0, None, |_| evaluate(name, half_distance, mass_ratio, &values))?.whole(py)?;
    moved(py, result, &shape)
}

fn evaluate(name: &str, half_distance: f64, mass_ratio: f64, values: &[f64]) -> Result<Vec<f64>> {
    let collision = Collision::new(mass_ratio, 1.0)?;
    let function: &dyn Fn(f64) -> f64 = match name {
        "rutherford_deflection" => &|b| rutherford::deflection(half_distance, b),
        "rutherford_closest_approach" => &|b| rutherford::closest_approach(half_distance, b),
        "rutherford_impact_parameter" => &|angle| rutherford::impact_parameter(half_distance, angle),
        "rutherford_cm" => &|angle| rutherford::cross_section(half_distance, angle),
        "rutherford_lab" => &|angle| rutherford::lab_cross_section(half_distance, collision, angle),
        "rutherford_recoil" => &|angle| rutherford::recoil_cross_section(half_distance, angle),
        _ => return Err(Error::Internal(format!("no function '{name}'"))),
    };
    Ok(values.iter().map(|value| function(*value)).collect())
}

/// The solid angle between each two neighbouring angles from an axis.
#[pyfunction]
pub(crate) fn solid_angles<'py>(
    py: Python<'py>,
    edges: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<Column<'py>> {
    let (edges, _) = copied("edges", &edges, [None])?;
    let pairs = edges.iter().zip(edges.iter().skip(1));
    let rings = pairs.map(|(&from, &to)| solid_angle(from, to));
    let rings: Vec<f64> = compute(py, 0, None, |_| Ok(rings.collect()))?.whole(py)?;
    let length = rings.len();
    moved(py, rings, &[length])
}
