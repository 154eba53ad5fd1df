//! Rigid bodies: rotations of one or many rows, and free rotation.
//!
//! Rows of rotations are read where they are: these functions take less time than a copy of their arguments.

use crate::arrays::{copied, in_place, moved};
use crate::errors::raised;
use crate::gate::compute;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::memory::{reserved, room};
use visviva_core::parallel::Ticker;
use visviva_core::rigid::conventions::Convention;
use visviva_core::rigid::free::FreeRotation;
use visviva_core::rigid::{quaternion as q, velocity};
use visviva_core::{Error, Result};

type Array<'py> = PyReadonlyArrayDyn<'py, f64>;
type Column<'py> = Bound<'py, PyArrayDyn<f64>>;

/// Rows between two looks at the clock.
const STRIDE: usize = 4096;

/// Which row a refusal is about, if there are several.
fn located(index: usize, count: usize, error: Error) -> Error {
    match error {
        Error::InvalidInput { argument, message } if count > 1 => {
            Error::invalid(&argument, format!("{message} (entry {index} of {count})"))
        }
        other => other,
    }
}

/// A function of the rows of one array.
fn mapped<const K: usize, const M: usize>(
    ticker: &mut Ticker<'_>,
    rows: &[[f64; K]],
    function: impl Fn(&[f64; K]) -> Result<[f64; M]>,
) -> Result<Vec<f64>> {
    let mut results = room("values", "the results", rows.len().checked_mul(M))?;
    for (index, row) in rows.iter().enumerate() {
        if index % STRIDE == 0 {
            ticker.tick()?;
        }
        results.extend_from_slice(&function(row).map_err(|error| located(index, rows.len(), error))?);
    }
    Ok(results)
}

/// A function of the rows of two arrays, of which one may have a single row.
fn combined<const K: usize, const L: usize, const M: usize>(
    ticker: &mut Ticker<'_>,
    (first, second): (&[[f64; K]], &[[f64; L]]),
    function: impl Fn(&[f64; K], &[f64; L]) -> Result<[f64; M]>,
) -> Result<Vec<f64>> {
    let count = if first.len() == 1 { second.len() } else { first.len() };
    if second.len() != count && second.len() != 1 {
        return Err(Error::Internal(format!("{} rows and {}", first.len(), second.len())));
    }
    let mut results = room("values", "the results", count.checked_mul(M))?;
    let repeated = |index: usize, len: usize| if len == 1 { 0 } else { index };
    for index in 0..count {
        if index % STRIDE == 0 {
            ticker.tick()?;
        }
        let pair = first.get(repeated(index, first.len())).zip(second.get(repeated(index, second.len())));
        let Some((a, b)) = pair else { break };
        results.extend_from_slice(&function(a, b).map_err(|error| located(index, count, error))?);
    }
    Ok(results)
}

fn given<'py>(py: Python<'py>, values: Vec<f64>, width: usize) -> PyResult<Column<'py>> {
    let count = values.len() / width;
    moved(py, values, &[count, width])
}

/// Another form of each rotation, by name.
#[pyfunction]
pub(crate) fn rotation_form<'py>(py: Python<'py>, name: &str, values: Array<'py>) -> PyResult<Column<'py>> {
    let (result, width) = match name {
        "matrix" => {
            let rows = in_place::<_, 4>("quaternion", &values)?;
            let one = |row: &[f64; 4]| {
                let [[a, b, c], [d, e, f], [g, h, i]] = q::matrix(q::unit("quaternion", *row)?);
                Ok([a, b, c, d, e, f, g, h, i])
            };
            (compute(py, 0, None, |ticker| mapped(ticker, rows, one))?, 9)
        }
        "from_matrix" => {
            let rows = in_place::<_, 9>("matrix", &values)?;
            let one = |row: &[f64; 9]| {
                let [a, b, c, d, e, f, g, h, i] = *row;
                q::from_matrix("matrix", [[a, b, c], [d, e, f], [g, h, i]])
            };
            (compute(py, 0, None, |ticker| mapped(ticker, rows, one))?, 4)
        }
        "rotation_vector" => {
            let rows = in_place::<_, 4>("quaternion", &values)?;
            let one = |row: &[f64; 4]| Ok(q::rotation_vector(q::unit("quaternion", *row)?));
            (compute(py, 0, None, |ticker| mapped(ticker, rows, one))?, 3)
        }
        "from_rotation_vector" => {
            let rows = in_place::<_, 3>("rotation_vector", &values)?;
            (compute(py, 0, None, |ticker| mapped(ticker, rows, |row| Ok(q::from_rotation_vector(*row))))?, 4)
        }
        "normalized" => {
            let rows = in_place::<_, 4>("quaternion", &values)?;
            (compute(py, 0, None, |ticker| mapped(ticker, rows, |row| q::unit("quaternion", *row)))?, 4)
        }
        _ => return Err(raised(py, Error::Internal(format!("no form '{name}'")))),
    };
    given(py, result.whole(py)?, width)
}

/// The product of rotations, row by row.
#[pyfunction]
pub(crate) fn rotation_product<'py>(py: Python<'py>, a: Array<'py>, b: Array<'py>) -> PyResult<Column<'py>> {
    let both = (in_place::<_, 4>("a", &a)?, in_place::<_, 4>("b", &b)?);
    let one = |a: &[f64; 4], b: &[f64; 4]| Ok(q::product(q::unit("a", *a)?, q::unit("b", *b)?));
    let result = compute(py, 0, None, |ticker| combined(ticker, both, one))?.whole(py)?;
    given(py, result, 4)
}

/// Vectors rotated, or rotated back, row by row.
#[pyfunction]
pub(crate) fn rotated<'py>(
    py: Python<'py>,
    quaternion: Array<'py>,
    vector: Array<'py>,
    back: bool,
) -> PyResult<Column<'py>> {
    let both = (in_place::<_, 4>("quaternion", &quaternion)?, in_place::<_, 3>("vector", &vector)?);
    let sign = if back { -1.0 } else { 1.0 };
    let one = |turn: &[f64; 4], v: &[f64; 3]| {
        let [x, y, z, w] = q::unit("quaternion", *turn)?;
        Ok(q::rotated([x, y, z, sign * w], *v))
    };
    let result = compute(py, 0, None, |ticker| combined(ticker, both, one))?.whole(py)?;
    given(py, result, 3)
}

/// Euler angles of rotations, or rotations of Euler angles.
#[pyfunction]
pub(crate) fn rotation_euler<'py>(
    py: Python<'py>,
    convention: &str,
    values: Array<'py>,
    to_angles: bool,
) -> PyResult<Column<'py>> {
    let convention = Convention::new(convention).map_err(|error| raised(py, error))?;
    if to_angles {
        let rows = in_place::<_, 4>("quaternion", &values)?;
        let one = |row: &[f64; 4]| Ok(convention.angles(q::unit("quaternion", *row)?));
        return given(py, compute(py, 0, None, |ticker| mapped(ticker, rows, one))?.whole(py)?, 3);
    }
    let rows = in_place::<_, 3>("angles", &values)?;
    let one = |row: &[f64; 3]| Ok(convention.quaternion(*row));
    given(py, compute(py, 0, None, |ticker| mapped(ticker, rows, one))?.whole(py)?, 4)
}

/// Angular velocities of rates of Euler angles, or rates of angular velocities.
#[pyfunction]
pub(crate) fn rotation_rates<'py>(
    py: Python<'py>,
    convention: &str,
    angles: Array<'py>,
    values: Array<'py>,
    in_body: bool,
    to_rates: bool,
) -> PyResult<Column<'py>> {
    let convention = Convention::new(convention).map_err(|error| raised(py, error))?;
    let both = (in_place::<_, 3>("angles", &angles)?, in_place::<_, 3>("values", &values)?);
    let one = |angles: &[f64; 3], values: &[f64; 3]| {
        if to_rates {
            convention.rates(*angles, *values, in_body)
        } else {
            Ok(convention.angular_velocity(*angles, *values, in_body))
        }
    };
    given(py, compute(py, 0, None, |ticker| combined(ticker, both, one))?.whole(py)?, 3)
}

/// Velocities of points of bodies, from rows of point, velocity, angular velocity and base point.
#[pyfunction]
pub(crate) fn rigid_velocity<'py>(py: Python<'py>, values: Array<'py>) -> PyResult<Column<'py>> {
    let rows = in_place::<_, 12>("values", &values)?;
    let one = |&[x, y, z, a, b, c, d, e, f, g, h, i]: &[f64; 12]| {
        velocity::at([x, y, z], [a, b, c], [d, e, f], [g, h, i])
    };
    given(py, compute(py, 0, None, |ticker| mapped(ticker, rows, one))?.whole(py)?, 3)
}

/// The screws that bodies move as (point, direction, rate, speed and pitch), from rows of velocity, angular velocity and
/// base point.
#[pyfunction]
pub(crate) fn rigid_screw<'py>(py: Python<'py>, values: Array<'py>) -> PyResult<Column<'py>> {
    let rows = in_place::<_, 9>("values", &values)?;
    let one = |&[a, b, c, d, e, f, g, h, i]: &[f64; 9]| {
        let found = velocity::screw([a, b, c], [d, e, f], [g, h, i])?;
        let ([x, y, z], [u, v, w]) = (found.point, found.direction);
        Ok([x, y, z, u, v, w, found.rate, found.speed, found.pitch])
    };
    given(py, compute(py, 0, None, |ticker| mapped(ticker, rows, one))?.whole(py)?, 9)
}

/// Three numbers of an argument.
fn three(name: &str, array: &Array<'_>) -> PyResult<[f64; 3]> {
    let refused = || raised(array.py(), Error::invalid(name, "expected three numbers"));
    let (values, _) = copied(name, array, [Some(3)])?;
    <[f64; 3]>::try_from(values).map_err(|_| refused())
}

/// Angular velocity and momentum in the body, (T, 3) each, and orientation, (T, 4), of a body that turns freely.
#[pyfunction]
pub(crate) fn free_rotation<'py>(
    py: Python<'py>,
    moments: Array<'py>,
    angular_velocity: Array<'py>,
    orientation: Array<'py>,
    t: Array<'py>,
) -> PyResult<(Column<'py>, Column<'py>, Column<'py>)> {
    let (moments, spin) = (three("moments", &moments)?, three("angular_velocity", &angular_velocity)?);
    let (orientation, _) = copied("orientation", &orientation, [Some(4)])?;
    let orientation = <[f64; 4]>::try_from(orientation)
        .map_err(|_| raised(py, Error::invalid("orientation", "expected four numbers")))?;
    let (times, [length]) = copied("t", &t, [None])?;
    let columns = compute(py, 0, None, |ticker| {
        let body = FreeRotation::new(moments, spin, orientation)?;
        let furthest =
            times.iter().fold(0.0, |most: f64, time| if time.abs() > most.abs() { *time } else { most });
        body.check_time(furthest)?;
        let what = "the states at all these times";
        let [mut velocity, mut momentum] = reserved("t", what, length.checked_mul(3))?;
        let [mut attitude] = reserved("t", what, length.checked_mul(4))?;
        for (index, time) in times.iter().enumerate() {
            if index % STRIDE == 0 {
                ticker.tick()?;
            }
            let state = body.state(*time);
            velocity.extend(state.angular_velocity);
            momentum.extend(state.angular_momentum);
            attitude.extend(state.orientation);
        }
        Ok((velocity, momentum, attitude))
    })?
    .whole(py)?;
    let (velocity, momentum, attitude) = columns;
    Ok((given(py, velocity, 3)?, given(py, momentum, 3)?, given(py, attitude, 4)?))
}

/// What can be said of a free rotation as a whole, by name.
#[pyfunction]
pub(crate) fn polhode<'py>(
    py: Python<'py>,
    moments: Array<'py>,
    angular_velocity: Array<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let (moments, spin) = (three("moments", &moments)?, three("angular_velocity", &angular_velocity)?);
    let body = FreeRotation::new(moments, spin, q::IDENTITY).map_err(|error| raised(py, error))?;
    let found = body.polhode();
    let dict = PyDict::new(py);
    dict.set_item("kind", body.kind().name())?;
    dict.set_item("axes", found.axes)?;
    dict.set_item("rate", found.rate)?;
    dict.set_item("modulus", found.modulus)?;
    dict.set_item("complement", found.complement)?;
    dict.set_item("period", found.period)?;
    dict.set_item("precession", found.precession)?;
    dict.set_item("largest", found.largest)?;
    Ok(dict)
}
