//! What runs: version, SIMD tier, threads, build profile.

use crate::errors::raised;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::numerics::simd::{Tier, tier};
use visviva_core::parallel::thread_count;

/// The version, the SIMD tier in force and those this machine has, whether fused multiply-adds are instructions, the
/// threads used by default, and the build profile.
///
/// # Errors
/// `InvalidInput` if `VISVIVA_THREADS` is not a whole number of at least 1.
#[pyfunction]
pub(crate) fn info(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let best = Tier::detect();
    let tiers = [Tier::Portable, Tier::Avx2, Tier::Avx512];
    let available: Vec<&str> = tiers.into_iter().filter(|tier| *tier <= best).map(Tier::name).collect();
    let dict = PyDict::new(py);
    dict.set_item("version", env!("CARGO_PKG_VERSION"))?;
    dict.set_item("simd", tier().name())?;
    dict.set_item("simd_available", available)?;
    // Every other processor that the package is built for has the instruction.
    let (here, used) = (best > Tier::Portable, tier() > Tier::Portable);
    let fused = match (cfg!(target_arch = "x86_64"), here, used) {
        (false, ..) | (_, _, true) => "yes",
        (_, true, false) => {
            "this machine has it, but VISVIVA_SIMD leaves it out: runs take about ten times as long"
        }
        (_, false, false) => "this machine lacks it: runs take about ten times as long",
    };
    dict.set_item("fused_multiply_add", fused)?;
    dict.set_item("threads", thread_count(None).map_err(|error| raised(py, error))?)?;
    dict.set_item("profile", if cfg!(debug_assertions) { "debug" } else { "release" })?;
    Ok(dict)
}
