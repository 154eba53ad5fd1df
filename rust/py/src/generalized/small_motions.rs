//! Small motions: equilibria, and the linear equations about a place at rest.

use super::Array;
use crate::arrays::{copied, moved};
use crate::gate::compute;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::OnceLock;
use visviva_core::Result;
use visviva_core::generalized::Model;
use visviva_core::generalized::linear::{Linear, modes};

/// Forces and matrices as code: compiled once for a model.
fn of<'a>(model: &Model, small: &'a OnceLock<Linear>) -> Result<&'a Linear> {
    if let Some(linear) = small.get() {
        return Ok(linear);
    }
    let linear = Linear::new(&mut model.clone())?;
    Ok(small.get_or_init(|| linear))
}

/// The equilibria that Newton's method reaches from starts (S, n), `None` where it reaches none.
pub(super) fn equilibria(
    py: Python<'_>,
    (model, small): (&Model, &OnceLock<Linear>),
    t: f64,
    starts: &Array<'_>,
    parameters: &Array<'_>,
) -> PyResult<Vec<Option<Vec<f64>>>> {
    let n = model.source.coordinates;
    let (starts, _) = copied("position", starts, [None, Some(n)])?;
    let (parameters, _) = copied("parameters", parameters, [Some(model.source.parameters)])?;
    compute(py, 0, None, |ticker| {
        let linear = of(model, small)?;
        let find = |start: &[f64]| {
            ticker.tick()?;
            Ok(linear.equilibrium(t, start, &parameters))
        };
        starts.chunks(n).map(find).collect::<Result<Vec<_>>>()
    })?
    .whole(py)
}

/// M, C, K and F of small motions about a place at rest; eigenvalues, squared frequencies and modes.
pub(super) fn linearized<'py>(
    py: Python<'py>,
    (model, small): (&Model, &OnceLock<Linear>),
    t: f64,
    position: &Array<'py>,
    parameters: &Array<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let n = model.source.coordinates;
    let (position, _) = copied("position", position, [Some(n)])?;
    let (parameters, _) = copied("parameters", parameters, [Some(model.source.parameters)])?;
    let (at, found) = compute(py, 0, None, |_| {
        let at = of(model, small)?.matrices(t, &position, &parameters);
        let found = modes(&at, n)?;
        Ok((at, found))
    })?
    .whole(py)?;
    let result = PyDict::new(py);
    result.set_item("mass", moved(py, at.mass, &[n, n])?)?;
    result.set_item("damping", moved(py, at.damping, &[n, n])?)?;
    result.set_item("stiffness", moved(py, at.stiffness, &[n, n])?)?;
    result.set_item("forces", moved(py, at.forces, &[n])?)?;
    result.set_item("eigenvalues", found.eigenvalues)?;
    result.set_item(
        "symmetric",
        match found.symmetric {
            None => None,
            Some((squares, modes)) => Some((moved(py, squares, &[n])?, moved(py, modes, &[n, n])?)),
        },
    )?;
    Ok(result)
}
