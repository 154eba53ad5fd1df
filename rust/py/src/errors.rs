//! Core errors as the exception classes of `visviva.errors`.
//!
//! The classes are Python's, so that they pickle, carry fields and have two bases; they are looked up
//! when an error is raised and never at import.

use pyo3::call::PyCallArgs;
use pyo3::prelude::*;
use visviva_core::Error;

/// The exception that a core error becomes.
pub(crate) fn raised(py: Python<'_>, error: Error) -> PyErr {
    let made = match error {
        Error::InvalidInput { argument, message } => made(py, "InvalidInput", (argument, message)),
        Error::Convergence { message, time } => made(py, "ConvergenceError", (message, time)),
        Error::CloseEncounter { time, bodies, distance } => {
            made(py, "CloseEncounter", (time, bodies, distance))
        }
        Error::Interrupted => made(py, "Interrupted", ()),
        Error::Internal(message) => made(py, "InternalError", (message,)),
    };
    made.unwrap_or_else(|failure| failure)
}

/// An instance of a class of `visviva.errors`; the error of making it, if that fails.
fn made<'py>(py: Python<'py>, class: &str, arguments: impl PyCallArgs<'py>) -> PyResult<PyErr> {
    let class = py.import("visviva.errors")?.getattr(class)?;
    Ok(PyErr::from_value(class.call1(arguments)?))
}
