//! Arrays in by copy, arrays out by move.
//!
//! Inputs are copied while the GIL is held: another Python thread may write to them during the run, and
//! one pass over them is nothing against the steps of the run. The copy goes through strides, so Fortran
//! order can never be read as C order. Results move into NumPy without a copy. The full check of what a
//! user gave, with its messages, is `visviva._arrays`; this is the second line.

use crate::errors::raised;
use core::mem::ManuallyDrop;
use core::ptr::NonNull;
use numpy::ndarray::{ArrayD, ArrayViewD, IxDyn};
use numpy::npyffi::NPY_ARRAY_ALIGNED;
use numpy::{
    Element, IntoPyArray, PyArray, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use visviva_core::Error;
use visviva_core::memory::collected;
use visviva_core::scene::room::give_back;

/// The values in row-major order and the shape, which must match `shape` wherever that says a length.
///
/// # Errors
/// `InvalidInput` with the name of the argument, also where there is no memory for the copy.
pub(crate) fn copied<T: Element + Copy, const D: usize>(
    name: &str,
    array: &PyReadonlyArrayDyn<'_, T>,
    shape: [Option<usize>; D],
) -> PyResult<(Vec<T>, [usize; D])> {
    let refused = |message: String| raised(array.py(), Error::invalid(name, message));
    let came = array.shape();
    let matches = |found: &[usize; D]| {
        found.iter().zip(shape).all(|(&length, wanted)| wanted.is_none_or(|wanted| wanted == length))
    };
    let found = <[usize; D]>::try_from(came).ok().filter(matches).ok_or_else(|| {
        let expected = shape.map(|length| length.map_or("any".to_owned(), |length| length.to_string()));
        refused(format!("expected shape ({}), got {came:?}", expected.join(", ")))
    })?;
    // SAFETY: the array is alive and its flags are only read.
    let flags = unsafe { (*array.as_array_ptr()).fields.flags };
    if flags & NPY_ARRAY_ALIGNED == 0 {
        // As arrays are that a worker gets as a part of a message.
        let aligned = array.call_method0("copy")?.cast_into::<PyArrayDyn<T>>()?;
        return copied(name, &aligned.readonly(), shape);
    }
    let view = array.as_array();
    let what = "a copy of it";
    let values = view
        .as_slice()
        .map_or_else(
            || collected(name, what, view.iter().copied()),
            |all| collected(name, what, all.iter().copied()),
        )
        .map_err(|error| raised(array.py(), error))?;
    Ok((values, found))
}

/// The rows of `K` values each, where they are: for what takes less time than a copy of them.
///
/// # Errors
/// `InvalidInput` with the name of the argument, for another layout.
pub(crate) fn in_place<'a, T: Element, const K: usize>(
    name: &str,
    array: &'a PyReadonlyArrayDyn<'_, T>,
) -> PyResult<&'a [[T; K]]> {
    let refused = || {
        let message = format!("expected contiguous rows of {K} numbers, aligned in memory");
        raised(array.py(), Error::invalid(name, message))
    };
    let (rows, []) = array.as_slice().map_err(|_| refused())?.as_chunks::<K>() else { return Err(refused()) };
    Ok(rows)
}

/// A NumPy array of that shape which owns `values`.
///
/// # Errors
/// `InternalError` if there are not as many values as the shape says.
pub(crate) fn moved<'py, T: Element>(
    py: Python<'py>,
    values: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let length = values.len();
    let array = ArrayD::from_shape_vec(IxDyn(shape), values).map_err(|_| {
        raised(py, Error::Internal(format!("{length} values for an array of shape {shape:?}")))
    })?;
    Ok(array.into_pyarray(py))
}

/// The base of an array of numbers; its room goes to the next run when the array is gone.
///
/// Taken apart, the vector is no longer ours to read: only through the array.
#[pyclass(frozen)]
struct Buffer {
    numbers: NonNull<f64>,
    length: usize,
    capacity: usize,
}

// SAFETY: nothing is read or written through it but by its `Drop`, when nobody else has the numbers any more.
unsafe impl Send for Buffer {}
// SAFETY: as above.
unsafe impl Sync for Buffer {}

impl Buffer {
    fn new(values: Vec<f64>) -> Self {
        let mut values = ManuallyDrop::new(values);
        let (length, capacity) = (values.len(), values.capacity());
        let numbers = NonNull::new(values.as_mut_ptr()).unwrap_or(NonNull::dangling());
        Self { numbers, length, capacity }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: these are the parts of a vector that was taken apart, all its numbers initialised, and this is the
        // one time that it is put together; the array that used them is gone, as it kept this alive.
        give_back(unsafe { Vec::from_raw_parts(self.numbers.as_ptr(), self.length, self.capacity) });
    }
}

/// As [`moved`], of a column of a run.
///
/// # Errors
/// As [`moved`].
pub(crate) fn moved_column<'py>(
    py: Python<'py>,
    values: Vec<f64>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let length = values.len();
    let counted = shape.iter().try_fold(1_usize, |product, &axis| product.checked_mul(axis));
    if counted != Some(length) {
        return Err(raised(py, Error::Internal(format!("{length} values for an array of shape {shape:?}"))));
    }
    let room = Bound::new(py, Buffer::new(values))?;
    // SAFETY: there are as many numbers as the shape says, in row-major order, and the pointer is the owner's.
    let view = unsafe { ArrayViewD::from_shape_ptr(IxDyn(shape), room.get().numbers.as_ptr()) };
    // SAFETY: the array keeps the room alive as its base, and nothing but the array reads or writes there.
    Ok(unsafe { PyArray::borrow_from_array(&view, room.clone().into_any()) })
}
