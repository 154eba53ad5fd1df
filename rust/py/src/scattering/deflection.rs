//! The deflection function of a potential, over pairs of energies and impact parameters.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use crate::registry::described_potential;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::parallel::thread_count;
use visviva_core::scattering::deflection::{Deflection, Deflector};

type Column<'py> = Bound<'py, PyArrayDyn<f64>>;
/// Angle, complement, closest approach, derivative, delay, error; turning points and statuses.
type Deflections<'py> = (Vec<Column<'py>>, Vec<Bound<'py, PyArrayDyn<i64>>>);

/// Deflections of pairs, or if not `everything` their angles.
#[pyfunction]
pub(crate) fn deflections<'py>(
    py: Python<'py>,
    description: &Bound<'py, PyDict>,
    energy: PyReadonlyArrayDyn<'py, f64>,
    impact_parameter: PyReadonlyArrayDyn<'py, f64>,
    tolerance: f64,
    everything: bool,
    threads: Option<i64>,
) -> PyResult<Deflections<'py>> {
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    let potential = described_potential(description)?;
    let (energy, _) = copied("energy", &energy, [None])?;
    let (b, shape) = copied("impact_parameter", &impact_parameter, [None])?;
    if !everything {
        let angles = compute(py, b.len() as u64, None, |ticker| {
            Deflector::new(&potential, tolerance)?.angles(&energy, &b, threads, ticker)
        })?
        .whole(py)?;
        return Ok((vec![moved(py, angles, &shape)?], Vec::new()));
    }
    let found = compute(py, b.len() as u64, None, |ticker| {
        Deflector::new(&potential, tolerance)?.deflect(&energy, &b, true, threads, ticker)
    })?
    .whole(py)?;
    let column = |of: fn(&Deflection) -> f64| moved(py, found.iter().map(of).collect(), &shape);
    let columns = vec![
        column(|found| found.angle)?,
        column(|found| found.complement)?,
        column(|found| found.closest_approach)?,
        column(|found| found.derivative)?,
        column(|found| found.delay)?,
        column(|found| found.error)?,
    ];
    let count = |of: fn(&Deflection) -> i64| moved(py, found.iter().map(of).collect(), &shape);
    let counts = vec![count(|found| i64::from(found.turning_points))?, count(|found| found.status as i64)?];
    Ok((columns, counts))
}
