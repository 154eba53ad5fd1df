//! The one gate between Python and a computation.
//!
//! Everything that computes goes through [`compute`]: it releases the GIL, runs the work on the calling
//! thread, and about every 50 ms takes the GIL back to look for signals and to report progress. No panic
//! gets past it. An exception of a signal handler or of the progress callback stops the run, and the
//! same exception object is raised again.

use crate::errors::raised;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use visviva_core::parallel::{Control, Ticker, panicked};
use visviva_core::{Error, Result};

/// What a run gave, and whether somebody asked to stop it.
#[must_use]
pub(crate) struct Worked<T> {
    value: T,
    pending: Option<PyErr>,
}

impl<T> Worked<T> {
    /// The value of work that has no use for a part of it: whatever stopped it is raised.
    ///
    /// # Errors
    /// `Interrupted` after Ctrl-C, or the exception of a callback or signal handler.
    pub(crate) fn whole(self, py: Python<'_>) -> PyResult<T> {
        match self.pending {
            None => Ok(self.value),
            Some(pending) => Err(stopped(py, pending)),
        }
    }

    /// The value of work that keeps what it has when it is cancelled, and whether Ctrl-C did that.
    ///
    /// # Errors
    /// The exception of a callback or signal handler other than Ctrl-C: nobody asked for a partial result.
    pub(crate) fn partial(self, py: Python<'_>) -> PyResult<(T, bool)> {
        match self.pending {
            None => Ok((self.value, false)),
            Some(pending) if is_ctrl_c(py, &pending) => Ok((self.value, true)),
            Some(pending) => Err(pending),
        }
    }
}

/// Runs `work` with the GIL released.
///
/// `total` is the work in units of progress, 0 if it is not known yet (the work then says it by
/// [`Control::set_total`]). `progress` is called as `progress(done, total)` about every 50 ms and once
/// at the end. Work that notices cancellation returns `Err(Interrupted)`, or `Ok` with what it has.
///
/// # Errors
/// The error of the work as an exception of `visviva.errors`; if the run was stopped, what stopped it.
pub(crate) fn compute<T: Send>(
    py: Python<'_>,
    total: u64,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&mut Ticker<'_>) -> Result<T> + Send,
) -> PyResult<Worked<T>> {
    let control = Control::new(total);
    let (result, pending) = py.detach(|| {
        let look = |done, total| Python::try_attach(|py| watched(py, progress, done, total));
        worked(&control, look, work)
    });
    finished(py, &control, progress, result, pending)
}

/// As [`compute`], with the GIL held: for work that is calls of Python for the most part.
///
/// # Errors
/// As [`compute`].
pub(crate) fn compute_attached<T>(
    py: Python<'_>,
    work: impl FnOnce(&mut Ticker<'_>) -> Result<T>,
) -> PyResult<Worked<T>> {
    let control = Control::new(0);
    let (result, pending) = worked(&control, |_, _| Some(py.check_signals()), work);
    finished(py, &control, None, result, pending)
}

/// Calls Python in the middle of work, which may hold the GIL or not.
pub(crate) fn attached<T>(call: impl FnOnce(Python<'_>) -> T) -> T {
    Python::attach(call)
}

/// Does the work, with a look at Python now and then; the first exception of a look stops it.
fn worked<T>(
    control: &Control,
    mut look: impl FnMut(u64, u64) -> Option<PyResult<()>>,
    work: impl FnOnce(&mut Ticker<'_>) -> Result<T>,
) -> (Result<T>, Option<PyErr>) {
    let mut pending = None;
    let mut monitor = |done, total| match look(done, total) {
        Some(Ok(())) => true,
        Some(Err(exception)) => {
            pending = pending.take().or(Some(exception));
            false
        }
        // The interpreter is shutting down: nobody is left to take the result.
        None => false,
    };
    let result = catch_unwind(AssertUnwindSafe(|| work(&mut Ticker::new(control, &mut monitor))))
        .unwrap_or_else(|payload| Err(panicked(payload.as_ref())));
    (result, pending)
}

/// What the work gave, or what it raised.
fn finished<T>(
    py: Python<'_>,
    control: &Control,
    progress: Option<&Py<PyAny>>,
    result: Result<T>,
    pending: Option<PyErr>,
) -> PyResult<Worked<T>> {
    match (result, pending) {
        (Ok(value), None) => {
            let (done, total) = control.progress();
            // What came after the last look: Python would raise it on the way out, bare and without the value.
            let pending = watched(py, progress, done, total).err();
            Ok(Worked { value, pending })
        }
        (Ok(value), pending) => Ok(Worked { value, pending }),
        // A defect of ours is not hidden by the wish to stop.
        (Err(error @ Error::Internal(_)), _) | (Err(error), None) => Err(raised(py, error)),
        (Err(_), Some(pending)) => Err(stopped(py, pending)),
    }
}

/// What happens every 50 ms.
fn watched(py: Python<'_>, progress: Option<&Py<PyAny>>, done: u64, total: u64) -> PyResult<()> {
    py.check_signals()?;
    reported(py, progress, done, total)
}

fn reported(py: Python<'_>, progress: Option<&Py<PyAny>>, done: u64, total: u64) -> PyResult<()> {
    progress.map_or(Ok(()), |callback| callback.call1(py, (done, total)).map(drop))
}

/// Whether this is what Python's own handler of SIGINT raises; a subclass is somebody else's.
pub(crate) fn is_ctrl_c(py: Python<'_>, exception: &PyErr) -> bool {
    exception.get_type(py).is(py.get_type::<PyKeyboardInterrupt>())
}

/// Ctrl-C as `visviva.Interrupted`; any other exception as the very object it is.
fn stopped(py: Python<'_>, pending: PyErr) -> PyErr {
    if is_ctrl_c(py, &pending) { raised(py, Error::Interrupted) } else { pending }
}
