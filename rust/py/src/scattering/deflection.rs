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
type Deflections<'py> = (Vec<Column<'py>>, Vec<u32>, Vec<u32>);

/// Deflections of pairs; derivatives and delays only if `everything`.
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
    let found = compute(py, b.len() as u64, None, |ticker| {
        Deflector::new(&potential, tolerance)?.deflect(&energy, &b, everything, threads, ticker)
    })?
    .whole(py)?;
    let column = |of: &dyn Fn(&Deflection) -> f64| moved(py, found.iter().map(of).collect(), &shape);
    let columns = [
        column(&|found| found.angle)?,
        column(&|found| found.complement)?,
        column(&|found| found.closest_approach)?,
        column(&|found| found.derivative)?,
        column(&|found| found.delay)?,
        column(&|found| found.error)?,
    ];
    let turning_points = found.iter().map(|found| found.turning_points).collect();
    let status = found.iter().map(|found| found.status as u32).collect();
    Ok((columns.into(), turning_points, status))
}
