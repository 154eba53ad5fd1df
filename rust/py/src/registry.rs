//! What the registry offers: methods and potentials, as Python's tables and classes are made from them.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use visviva_core::potentials::Potential;
use visviva_core::registry;
use visviva_core::words::unknown;

/// What every integration method declares about itself.
#[pyfunction]
pub(crate) fn methods(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let row = |method: &&'static visviva_core::ode::Method| {
        let dict = PyDict::new(py);
        dict.set_item("name", method.name)?;
        dict.set_item("summary", method.summary)?;
        dict.set_item("order", method.order)?;
        dict.set_item("stages", method.stages)?;
        dict.set_item("symplectic", method.symplectic)?;
        dict.set_item("reversible", method.reversible)?;
        dict.set_item("adaptive", method.adaptive())?;
        dict.set_item("dense_order", method.dense_order)?;
        dict.set_item("reference", method.reference)?;
        Ok(dict)
    };
    registry::METHODS.iter().map(row).collect()
}

/// What every potential declares about itself.
#[pyfunction]
pub(crate) fn potentials(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let row = |declaration: &&'static visviva_core::potentials::Declaration| {
        let dict = PyDict::new(py);
        dict.set_item("name", declaration.name)?;
        dict.set_item("class_name", declaration.class_name)?;
        dict.set_item("summary", declaration.summary)?;
        dict.set_item("formula", declaration.formula)?;
        let parameters = declaration.parameters.iter().map(|parameter| {
            let dict = PyDict::new(py);
            dict.set_item("name", parameter.name)?;
            dict.set_item("description", parameter.description)?;
            dict.set_item("positive", parameter.positive)?;
            Ok(dict)
        });
        dict.set_item("parameters", parameters.collect::<PyResult<Vec<_>>>()?)?;
        Ok(dict)
    };
    registry::POTENTIALS.iter().map(row).collect()
}

/// The potential of a registry name.
///
/// # Errors
/// `InvalidInput` for an unknown name or parameters that cannot be.
pub(crate) fn build(py: Python<'_>, name: &str, parameters: &[f64]) -> PyResult<Arc<dyn Potential>> {
    let names = registry::POTENTIALS.iter().map(|declaration| declaration.name);
    registry::potential(name)
        .ok_or_else(|| unknown("potential", name, names))
        .and_then(|declaration| declaration.build(parameters))
        .map_err(|error| raised(py, error))
}

type Column<'py> = Bound<'py, PyArrayDyn<f64>>;

/// V(r), −dV/dr and d²V/dr² of a potential at each distance.
#[pyfunction]
pub(crate) fn potential<'py>(
    py: Python<'py>,
    name: &str,
    parameters: Vec<f64>,
    r: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<(Column<'py>, Column<'py>, Column<'py>)> {
    let potential = build(py, name, &parameters)?;
    let (r, shape) = copied("r", &r, [None])?;
    let [value, force, curvature] = compute(py, 0, None, |_| Ok(potential.evaluate(&r)))?.whole(py)?;
    Ok((moved(py, value, &shape)?, moved(py, force, &shape)?, moved(py, curvature, &shape)?))
}
