//! The words of refusals, for those that are made in Python.

use pyo3::prelude::*;
use visviva_core::words::nearest as nearest_of;

/// The nearest of the names, if one is near at all.
#[pyfunction]
pub(crate) fn nearest(word: &str, names: Vec<String>) -> Option<String> {
    nearest_of(word, names.iter().map(String::as_str)).map(str::to_owned)
}
