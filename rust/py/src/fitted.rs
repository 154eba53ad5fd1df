//! Functions and tables as polynomials in pieces: what `potentials.Custom` and `drag.custom` make.

use crate::arrays::{copied, moved};
use crate::gate::{compute, compute_attached};
use crate::solve_ivp::Raised;
use numpy::{PyArray1, PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use visviva_core::forces::drag::sampled;
use visviva_core::potentials::fit::{Fit, POTENTIAL, fit};

type Column<'py> = PyReadonlyArrayDyn<'py, f64>;
type Values<'py> = Bound<'py, PyArrayDyn<f64>>;

/// Where polynomials in pieces meet, their coefficients and the largest error found.
type Pieces<'py> = (Values<'py>, Values<'py>, f64);

/// A function as polynomials in pieces: a potential V(r), or drag as F(R). `sample` gives the values of an array.
#[pyfunction]
pub(crate) fn fitted<'py>(
    py: Python<'py>,
    sample: &Bound<'py, PyAny>,
    between: (f64, f64),
    tolerance: f64,
    drag: bool,
) -> PyResult<Pieces<'py>> {
    let exception = Raised::default();
    let outcome = compute_attached(py, |_| {
        let mut values = |r: &[f64]| {
            let asked =
                |values: Bound<'py, PyAny>| copied("function", &values.extract::<Column<'_>>()?, [None]);
            Ok(exception.kept(sample.call1((PyArray1::from_slice(py, r),)).and_then(asked))?.0)
        };
        let between = [between.0, between.1];
        if drag {
            sampled::of_function(&mut values, between, tolerance)
        } else {
            fit(&mut values, between, tolerance, POTENTIAL)
        }
    });
    if let Some(exception) = exception.exception() {
        return Err(exception);
    }
    told(py, outcome?.whole(py)?)
}

/// Drag as polynomials in pieces, from a table of F(R).
#[pyfunction]
pub(crate) fn tabulated_drag<'py>(
    py: Python<'py>,
    reynolds: Column<'py>,
    law: Column<'py>,
) -> PyResult<Pieces<'py>> {
    let (reynolds, _) = copied("R", &reynolds, [None])?;
    let (law, _) = copied("F", &law, [None])?;
    told(py, compute(py, 0, None, |_| sampled::of_table(&reynolds, &law))?.whole(py)?)
}

fn told(py: Python<'_>, made: Fit) -> PyResult<Pieces<'_>> {
    let (breaks, terms) = (made.breaks.len(), made.coefficients.len());
    Ok((moved(py, made.breaks, &[breaks])?, moved(py, made.coefficients, &[terms])?, made.error))
}
