//! Arguments that are one number, or one for each result.

use crate::arrays::copied;
use crate::errors::raised;
use numpy::PyReadonlyArrayDyn;
use pyo3::prelude::*;
use visviva_core::Error;
use visviva_core::memory::room;
use visviva_core::parallel::Ticker;

pub(super) type Array<'py> = PyReadonlyArrayDyn<'py, f64>;

/// `K` arguments of rows of `N` numbers, each of one row, or of as many as there are results.
pub(super) struct Rows<const K: usize, const N: usize> {
    columns: [Vec<f64>; K],
    /// How many results.
    pub(super) count: usize,
}

impl<const K: usize, const N: usize> Rows<K, N> {
    /// From flat arrays.
    ///
    /// # Errors
    /// `InvalidInput` with the name of an argument that has neither one row nor as many as the others.
    pub(super) fn of(arguments: [(&str, &Array<'_>); K]) -> PyResult<Self> {
        let (mut count, mut columns) = (1, [const { Vec::new() }; K]);
        for ((name, array), column) in arguments.into_iter().zip(&mut columns) {
            let (values, _) = copied(name, array, [None])?;
            let rows = values.len() / N;
            if values.len() != rows * N || rows == 0 || (rows != 1 && count != 1 && rows != count) {
                let message =
                    format!("expected one row of {N} numbers, or {count}, got {} numbers", values.len());
                return Err(raised(array.py(), Error::invalid(name, message)));
            }
            count = count.max(rows);
            *column = values;
        }
        Ok(Self { columns, count })
    }
    /// Whether all of them are one row.
    pub(super) fn is_one(&self) -> bool {
        self.count == 1
    }
    /// The rows of a result.
    pub(super) fn at(&self, index: usize) -> [[f64; N]; K] {
        self.columns.each_ref().map(|column| {
            let (rows, _) = column.as_chunks::<N>();
            rows.get(index).or(rows.first()).copied().unwrap_or([f64::NAN; N])
        })
    }
}

/// One result of each index; a refusal says of which it is.
pub(super) fn each<T>(
    what: &str,
    count: usize,
    ticker: &mut Ticker<'_>,
    mut one: impl FnMut(usize) -> visviva_core::Result<T>,
) -> visviva_core::Result<Vec<T>> {
    let mut found = room(what, &format!("{count} results"), Some(count))?;
    for index in 0..count {
        ticker.tick()?;
        found.push(one(index).map_err(|error| match error {
            Error::InvalidInput { argument, message } if count > 1 => {
                Error::invalid(&argument, format!("{message} (entry {index} of {count})"))
            }
            other => other,
        })?);
    }
    Ok(found)
}
