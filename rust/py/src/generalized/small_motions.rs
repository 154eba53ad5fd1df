//! Small motions: equilibria, and the linear equations about a place at rest.

use super::{Array, Column};
use crate::arrays::{copied, moved};
use crate::gate::compute;
use pyo3::prelude::*;
use std::sync::OnceLock;
use visviva_core::Result;
use visviva_core::generalized::Model;
use visviva_core::generalized::linear::{Linear, Matrices, Steps, modes};

/// A place that Newton's method has reached, if it has, and whether its steps tell it.
pub(super) type Reached = Option<(Vec<f64>, bool)>;

/// Forces and matrices as code: compiled once for a model.
fn of<'a>(model: &Model, small: &'a OnceLock<Linear>) -> Result<&'a Linear> {
    if let Some(linear) = small.get() {
        return Ok(linear);
    }
    let linear = Linear::new(&mut model.clone())?;
    Ok(small.get_or_init(|| linear))
}

/// The equilibria that Newton's method reaches from starts (S, n), each with whether its steps tell it, `None` where it
/// reaches none.
pub(super) fn equilibria(
    py: Python<'_>,
    (model, small): (&Model, &OnceLock<Linear>),
    (t, descending): (f64, bool),
    starts: &Array<'_>,
    parameters: &Array<'_>,
) -> PyResult<Vec<Reached>> {
    let n = model.source.coordinates;
    let (starts, _) = copied("position", starts, [None, Some(n)])?;
    let (parameters, _) = copied("parameters", parameters, [Some(model.source.parameters)])?;
    let steps = if descending { Steps::Descending } else { Steps::Whole };
    compute(py, 0, None, |ticker| {
        let linear = of(model, small)?;
        let find = |start: &[f64]| {
            ticker.tick()?;
            Ok(linear.equilibrium(t, start, &parameters, steps))
        };
        starts.chunks(n).map(find).collect::<Result<Vec<_>>>()
    })?
    .whole(py)
}

/// F (S, n) and M, C and K (S, n, n) at states (S, 2n).
pub(super) fn matrices<'py>(
    py: Python<'py>,
    (model, small): (&Model, &OnceLock<Linear>),
    t: f64,
    states: &Array<'py>,
    parameters: &Array<'py>,
) -> PyResult<[Column<'py>; 4]> {
    let n = model.source.coordinates;
    let (states, [count, _]) = copied("states", states, [None, Some(2 * n)])?;
    let (parameters, _) = copied("parameters", parameters, [Some(model.source.parameters)])?;
    let found = compute(py, 0, None, |_| {
        let linear = of(model, small)?;
        let all = states.chunks(2 * n).map(|state| linear.matrices_at(t, state, &parameters));
        let mut found: [Vec<f64>; 4] = Default::default();
        for at in all {
            for (column, part) in found.iter_mut().zip([at.forces, at.mass, at.damping, at.stiffness]) {
                column.extend(part);
            }
        }
        Ok(found)
    })?
    .whole(py)?;
    let [forces, mass, damping, stiffness] = found;
    Ok([
        moved(py, forces, &[count, n])?,
        moved(py, mass, &[count, n, n])?,
        moved(py, damping, &[count, n, n])?,
        moved(py, stiffness, &[count, n, n])?,
    ])
}

/// Squared frequencies (n) and modes (n, n) of M, C and K (n, n); `None` where these are no symmetric pair, or damped.
#[pyfunction]
pub(crate) fn eigenmodes<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    damping: Array<'py>,
    stiffness: Array<'py>,
) -> PyResult<Option<(Column<'py>, Column<'py>)>> {
    let (mass, [n, _]) = copied("mass", &mass, [None, None])?;
    let (damping, _) = copied("damping", &damping, [Some(n), Some(n)])?;
    let (stiffness, _) = copied("stiffness", &stiffness, [Some(n), Some(n)])?;
    let matrices = Matrices { mass, damping, stiffness, forces: vec![] };
    match compute(py, 0, None, |_| modes(&matrices, n))?.whole(py)? {
        None => Ok(None),
        Some((squares, modes)) => Ok(Some((moved(py, squares, &[n])?, moved(py, modes, &[n, n])?))),
    }
}
