//! Constraints at a state: what they leave, the nearest state on them, and which of them hang on each other.

use super::{Array, Column};
use crate::arrays::{copied, moved};
use crate::errors::raised;
use pyo3::prelude::*;
use visviva_core::Error;
use visviva_core::generalized::Model;
use visviva_core::generalized::dependence::Dependence;

/// The residuals of constraints at a state, of places and of velocities, and the nearest state on them.
pub(super) fn projected<'py>(
    py: Python<'py>,
    model: &Model,
    t: f64,
    state: &Array<'py>,
    parameters: &Array<'py>,
) -> PyResult<(Vec<f64>, Vec<f64>, Column<'py>)> {
    let (mut state, _) = copied("state", state, [Some(model.numbers())])?;
    let (parameters, _) = copied("parameters", parameters, [Some(model.source.parameters)])?;
    let (places, velocities) = match &model.projection {
        None => (vec![], vec![]),
        Some(projection) => {
            let mut projector = projection.at_work(&parameters);
            if let Some(found) = projector.dependence(t, &state) {
                return Err(raised(py, dependent(&found)));
            }
            let residuals = projector.residuals(t, &state);
            let mut rest = vec![0.0; state.len()];
            projector.project(t, &mut state, &mut rest, true).map_err(|error| raised(py, error))?;
            residuals
        }
    };
    let length = state.len();
    Ok((places, velocities, moved(py, state, &[length])?))
}

/// Constraints that do not leave the multipliers determined.
fn dependent(found: &Dependence) -> Error {
    let one = found.one;
    let names: Vec<String> = found.others.iter().map(usize::to_string).collect();
    let names = names.join(", ");
    let words = match (found.others.len(), found.disagree) {
        (0, _) => format!("constraint {one} has no gradient at the start; start elsewhere"),
        (1, false) => format!("constraints {names} and {one} are dependent at the start; leave one out"),
        (_, false) => {
            format!("constraint {one} follows from constraints {names} at the start; leave one out")
        }
        (_, true) => format!(
            "constraints {names} and {one} do not agree: their gradients are dependent at the start, and no small change \
             there makes all of them hold; change one, leave it out, or start elsewhere"
        ),
    };
    Error::invalid("constraints", words)
}
