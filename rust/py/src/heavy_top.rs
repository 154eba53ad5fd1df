//! The heavy symmetric top.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::Result;
use visviva_core::memory::reserved;
use visviva_core::rigid::heavy_top::{HeavyTop, Start};

/// States between two looks at the clock.
const STRIDE: usize = 4096;

/// A, C, mass, g and R.
type Top = (f64, f64, f64, f64, f64);

fn made((across, along, mass, g, distance): Top) -> Result<HeavyTop> {
    HeavyTop::new(across, along, mass, g, distance)
}

/// The spin above which it sleeps; refuses what is no top.
#[pyfunction]
pub(crate) fn top_sleeping_threshold(py: Python<'_>, top: Top) -> PyResult<f64> {
    made(top).map(|top| top.sleeping_threshold()).map_err(|error| raised(py, error))
}

/// The least spin of a steady precession.
#[pyfunction]
pub(crate) fn top_least_spin(py: Python<'_>, top: Top, theta: f64) -> PyResult<f64> {
    made(top).map(|top| top.least_spin(theta)).map_err(|error| raised(py, error))
}

/// The slow and the fast steady precession, and the frequency of small nutations about each.
#[pyfunction]
pub(crate) fn top_steady_precession(
    py: Python<'_>,
    top: Top,
    theta: f64,
    spin: f64,
) -> PyResult<([f64; 2], [f64; 2])> {
    let found = made(top).and_then(|top| {
        let rates = top.steady_precession(theta, spin)?;
        Ok((rates, rates.map(|rate| top.nutation_frequency(theta, spin, rate))))
    });
    found.map_err(|error| raised(py, error))
}

/// The nutation from Euler's angle and rates, by name.
#[pyfunction]
pub(crate) fn top_nutation<'py>(
    py: Python<'py>,
    top: Top,
    theta: f64,
    theta_dot: f64,
    phi_dot: f64,
    psi_dot: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let start = Start { theta, theta_dot, phi_dot, psi_dot };
    let found = made(top).and_then(|top| top.nutation(start)).map_err(|error| raised(py, error))?;
    let dict = PyDict::new(py);
    dict.set_item("roots", found.roots)?;
    dict.set_item("theta", found.theta)?;
    dict.set_item("period", found.period)?;
    dict.set_item("turning", found.turning)?;
    dict.set_item("kind", found.kind)?;
    Ok(dict)
}

/// θ, φ, ψ and their rates at times, six numbers a row, from Euler's angles (θ, φ, ψ) and rates.
#[pyfunction]
pub(crate) fn top_motion<'py>(
    py: Python<'py>,
    top: Top,
    angles: (f64, f64, f64),
    rates: (f64, f64, f64),
    t: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let ((theta, phi, psi), (theta_dot, phi_dot, psi_dot)) = (angles, rates);
    let start = Start { theta, theta_dot, phi_dot, psi_dot };
    let (times, [length]) = copied("t", &t, [None])?;
    let values = compute(py, 0, None, |ticker| {
        let motion = made(top)?.motion(start, [phi, psi])?;
        let furthest =
            times.iter().fold(0.0, |most: f64, time| if time.abs() > most.abs() { *time } else { most });
        motion.check_time(furthest)?;
        let [mut values] = reserved("t", "the states at all these times", length.checked_mul(6))?;
        for (index, time) in times.iter().enumerate() {
            if index % STRIDE == 0 {
                ticker.tick()?;
            }
            let state = motion.at(*time);
            values.extend(state.angles);
            values.extend(state.rates);
        }
        Ok(values)
    })?
    .whole(py)?;
    moved(py, values, &[length, 6])
}
