//! Kepler orbits: elements, states, anomalies, constants.
//!
//! Every function takes flat arrays of one length, one entry per orbit; `visviva.orbits` gives them their axes.

mod states;

pub(crate) use states::{orbit_propagate, orbit_state, orbit_state_again};

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use nalgebra::Vector3;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::memory::{collected, room};
use visviva_core::nbody::anomalies::convert;
use visviva_core::nbody::constants::{self, ConicConstants};
use visviva_core::nbody::elements::{Elements, free_fall_time};
use visviva_core::parallel::Ticker;
use visviva_core::{Error, Result};

type Array<'py> = PyReadonlyArrayDyn<'py, f64>;
type Column<'py> = Bound<'py, PyArrayDyn<f64>>;

/// A value of each result, by name.
type Columns<T, V = f64> = &'static [(&'static str, fn(&T) -> V)];
type PositionVelocity = (Vector3<f64>, Vector3<f64>);

const ELEMENTS: Columns<Elements> = &[
    ("energy", |found| found.energy),
    ("hodograph_radius", |found| found.hodograph_radius),
    ("eccentricity", |found| found.eccentricity),
    ("semi_major_axis", |found| found.semi_major_axis),
    ("semi_minor_axis", |found| found.semi_minor_axis),
    ("semi_latus_rectum", |found| found.semi_latus_rectum),
    ("pericenter", |found| found.pericenter),
    ("apocenter", |found| found.apocenter),
    ("inclination", |found| found.inclination),
    ("node", |found| found.node),
    ("argument_of_pericenter", |found| found.argument_of_pericenter),
    ("true_anomaly", |found| found.true_anomaly),
    ("eccentric_anomaly", |found| found.eccentric_anomaly),
    ("mean_anomaly", |found| found.mean_anomaly),
    ("time_since_pericenter", |found| found.time_since_pericenter),
    ("period", |found| found.period),
    ("areal_rate", |found| found.areal_rate),
    ("turning_angle", |found| found.turning_angle),
];

const ELEMENT_VECTORS: Columns<Elements, Vector3<f64>> = &[
    ("angular_momentum", |found| found.angular_momentum),
    ("laplace_runge_lenz", |found| found.laplace_runge_lenz),
    ("hodograph_center", |found| found.hodograph_center),
];

const CONSTANTS: Columns<ConicConstants> = &[
    ("angular_momentum", |found| found.angular_momentum),
    ("energy", |found| found.energy),
    ("eccentricity", |found| found.eccentricity),
    ("semi_major_axis", |found| found.semi_major_axis),
    ("semi_minor_axis", |found| found.semi_minor_axis),
    ("semi_latus_rectum", |found| found.semi_latus_rectum),
    ("r_min", |found| found.r_min),
    ("r_max", |found| found.r_max),
    ("period", |found| found.period),
    ("areal_rate", |found| found.areal_rate),
    ("turning_angle", |found| found.turning_angle),
];

/// `count` vectors of an argument.
fn vectors(name: &str, array: &Array<'_>, count: usize) -> PyResult<Vec<Vector3<f64>>> {
    let (values, _) = copied(name, array, [Some(count), Some(3)])?;
    let vectors = values.chunks_exact(3).map(Vector3::from_column_slice);
    collected(name, "a copy of it", vectors).map_err(|error| raised(array.py(), error))
}

/// One result per orbit; a refusal says which orbit it is about, or that there are more of them than there is memory for.
fn each<I, T>(
    (argument, count): (&str, usize),
    ticker: &mut Ticker<'_>,
    orbits: impl Iterator<Item = I>,
    mut one: impl FnMut(I) -> Result<T>,
) -> Result<Vec<T>> {
    let which = |index: usize, error| match error {
        Error::InvalidInput { argument, message } if count > 1 => {
            Error::invalid(&argument, format!("{message} (entry {index} of {count})"))
        }
        other => other,
    };
    let mut found = room(argument, &format!("the results of {count} orbits"), Some(count))?;
    for (index, orbit) in orbits.enumerate() {
        ticker.tick()?;
        found.push(one(orbit).map_err(|error| which(index, error))?);
    }
    Ok(found)
}

fn column(py: Python<'_>, values: Vec<f64>) -> PyResult<Column<'_>> {
    let length = values.len();
    moved(py, values, &[length])
}

/// The results by name, a number of each orbit.
fn table<'py, T>(py: Python<'py>, columns: Columns<T>, found: &[T]) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, of) in columns {
        let values = collected(name, "a number of each orbit", found.iter().map(of));
        dict.set_item(name, column(py, values.map_err(|error| raised(py, error))?)?)?;
    }
    Ok(dict)
}

/// The coordinates of a vector of each orbit.
fn flat(name: &str, vectors: impl ExactSizeIterator<Item = Vector3<f64>>) -> Result<Vec<f64>> {
    let mut values = room(name, "a vector of each orbit", vectors.len().checked_mul(3))?;
    vectors.for_each(|vector| values.extend(vector.iter()));
    Ok(values)
}

/// As many numbers of each of several arguments.
struct Together<const K: usize> {
    count: usize,
    columns: [Vec<f64>; K],
}

impl<const K: usize> Together<K> {
    /// A number of each argument, orbit after orbit.
    fn orbits(&self) -> impl Iterator<Item = [f64; K]> {
        let mut columns = self.columns.each_ref().map(|column| column.iter());
        // All columns have this length.
        (0..self.count)
            .map(move |_| columns.each_mut().map(|column| column.next().copied().unwrap_or(f64::NAN)))
    }
}

/// Numbers of several arguments, all of the length of the first.
fn together<const K: usize>(arguments: [(&str, &Array<'_>); K]) -> PyResult<Together<K>> {
    let mut count = None;
    let mut columns = [const { Vec::new() }; K];
    for ((name, array), values) in arguments.into_iter().zip(&mut columns) {
        let (taken, [length]) = copied(name, array, [count])?;
        count = Some(length);
        *values = taken;
    }
    Ok(Together { count: count.unwrap_or(0), columns })
}

/// Elements of each state, by name.
#[pyfunction]
pub(crate) fn orbit_elements<'py>(
    py: Python<'py>,
    mu: Array<'py>,
    position: Array<'py>,
    velocity: Array<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let mu = together([("mu", &mu)])?;
    let count = mu.count;
    let position = vectors("position", &position, count)?;
    let velocity = vectors("velocity", &velocity, count)?;
    let found = compute(py, 0, None, |ticker| {
        let orbits = mu.orbits().zip(&position).zip(&velocity);
        each(("position", count), ticker, orbits, |(([mu], r), v)| Elements::from_state(mu, *r, *v))
    })?
    .whole(py)?;
    let dict = table(py, ELEMENTS, &found)?;
    for (name, of) in ELEMENT_VECTORS {
        let values = flat(name, found.iter().map(of)).map_err(|error| raised(py, error))?;
        dict.set_item(name, moved(py, values, &[count, 3])?)?;
    }
    Ok(dict)
}

/// A conversion between anomalies, by name.
#[pyfunction]
pub(crate) fn orbit_anomaly<'py>(
    py: Python<'py>,
    name: &str,
    anomaly: Array<'py>,
    eccentricity: Array<'py>,
    repulsive: bool,
) -> PyResult<Column<'py>> {
    let both = together([("anomaly", &anomaly), ("eccentricity", &eccentricity)])?;
    let values = compute(py, 0, None, |ticker| {
        each(("anomaly", both.count), ticker, both.orbits(), |[anomaly, e]| {
            convert(name, anomaly, e, repulsive)
        })
    })?
    .whole(py)?;
    column(py, values)
}

/// 2π √(a³/μ).
#[pyfunction]
pub(crate) fn orbit_period<'py>(
    py: Python<'py>,
    mu: Array<'py>,
    semi_major_axis: Array<'py>,
) -> PyResult<Column<'py>> {
    let both = together([("mu", &mu), ("semi_major_axis", &semi_major_axis)])?;
    let values = compute(py, 0, None, |ticker| {
        each(("mu", both.count), ticker, both.orbits(), |[mu, a]| constants::period(mu, a))
    })?
    .whole(py)?;
    column(py, values)
}

/// The semi-major axis of an ellipse.
#[pyfunction]
pub(crate) fn orbit_semi_major_axis<'py>(
    py: Python<'py>,
    mu: Array<'py>,
    period: Array<'py>,
) -> PyResult<Column<'py>> {
    let both = together([("mu", &mu), ("period", &period)])?;
    let values = compute(py, 0, None, |ticker| {
        each(("mu", both.count), ticker, both.orbits(), |[mu, t]| constants::semi_major_axis(mu, t))
    })?
    .whole(py)?;
    column(py, values)
}

/// The time of a fall from rest.
#[pyfunction]
pub(crate) fn orbit_free_fall_time<'py>(
    py: Python<'py>,
    mu: Array<'py>,
    start: Array<'py>,
    end: Array<'py>,
) -> PyResult<Column<'py>> {
    let falls = together([("mu", &mu), ("start", &start), ("end", &end)])?;
    let values = compute(py, 0, None, |ticker| {
        each(("mu", falls.count), ticker, falls.orbits(), |[mu, start, end]| free_fall_time(mu, start, end))
    })?
    .whole(py)?;
    column(py, values)
}

/// The constants of each conic from a state, by name.
#[pyfunction]
pub(crate) fn conic_from_state<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    strength: Array<'py>,
    position: Array<'py>,
    velocity: Array<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let both = together([("mass", &mass), ("strength", &strength)])?;
    let r = vectors("position", &position, both.count)?;
    let v = vectors("velocity", &velocity, both.count)?;
    let found = compute(py, 0, None, |ticker| {
        let orbits = both.orbits().zip(&r).zip(&v);
        each(("position", both.count), ticker, orbits, |(([mass, strength], r), v)| {
            ConicConstants::from_state(mass, strength, *r, *v)
        })
    })?
    .whole(py)?;
    table(py, CONSTANTS, &found)
}

/// The constants of each conic from angular momentum and energy, by name.
#[pyfunction]
pub(crate) fn conic_from_constants<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    strength: Array<'py>,
    angular_momentum: Array<'py>,
    energy: Array<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let orbits = together([
        ("mass", &mass),
        ("strength", &strength),
        ("angular_momentum", &angular_momentum),
        ("energy", &energy),
    ])?;
    let found = compute(py, 0, None, |ticker| {
        each(("angular_momentum", orbits.count), ticker, orbits.orbits(), |[mass, strength, l, energy]| {
            ConicConstants::from_constants(mass, strength, l, energy)
        })
    })?
    .whole(py)?;
    table(py, CONSTANTS, &found)
}
