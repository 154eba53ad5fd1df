//! Work without a purpose, by which the tests see what the gate promises.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use std::time::{Duration, Instant};
use visviva_core::parallel::{for_chunks, thread_count};
use visviva_core::{Error, Result};

/// Ten chunks per thread.
const CHUNKS_PER_THREAD: usize = 10;

/// Keeps `threads` threads busy for `seconds` through the gate, in ten chunks each.
///
/// Returns the number of chunks done and whether Ctrl-C ended it (only with `keep`, which asks for what was
/// done until then instead of an exception). Chunk `panic` panics; if there are
/// just so many chunks, the work panics after them.
#[pyfunction]
#[pyo3(signature = (seconds, threads=None, progress=None, *, keep=false, panic=None))]
pub(crate) fn _busy(
    py: Python<'_>,
    seconds: f64,
    threads: Option<i64>,
    progress: Option<Py<PyAny>>,
    keep: bool,
    panic: Option<usize>,
) -> PyResult<(u64, bool)> {
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    let each = Duration::try_from_secs_f64(seconds / CHUNKS_PER_THREAD as f64)
        .map_err(|_| raised(py, Error::invalid("seconds", format!("expected a duration, got {seconds}"))))?;
    let chunks = threads * CHUNKS_PER_THREAD;
    let outcome = gate::compute(py, chunks as u64, progress.as_ref(), |ticker| {
        let done = for_chunks(threads, chunks, ticker, |chunk, ticker| -> Result<u64> {
            let started = Instant::now();
            while started.elapsed() < each {
                match ticker.tick() {
                    Err(Error::Interrupted) if keep => return Ok(0),
                    ticked => ticked?,
                }
            }
            #[expect(clippy::panic, reason = "the only way to see that no panic reaches Python")]
            if panic == Some(chunk) {
                panic!("on request");
            }
            ticker.advance(1);
            Ok(1)
        })?;
        #[expect(clippy::panic, reason = "as above, outside the chunks")]
        if panic == Some(chunks) {
            panic!("on request");
        }
        Ok(done.iter().sum())
    })?;
    if keep { outcome.partial(py) } else { outcome.whole(py).map(|done| (done, false)) }
}

/// An array of shape (N, 3) after its way into the core and out again.
#[pyfunction]
pub(crate) fn _echo<'py>(
    py: Python<'py>,
    array: PyReadonlyArrayDyn<'py, f64>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let (values, shape) = copied("array", &array, [None, Some(3)])?;
    moved(py, values, &shape)
}
