//! Kepler orbits: elements, states, anomalies, constants.
//!
//! Every function takes flat arrays of one length, one entry per orbit; `visviva.orbits` gives them their axes.

use crate::arrays::{copied, moved};
use crate::gate::compute;
use nalgebra::Vector3;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::nbody::anomalies::convert;
use visviva_core::nbody::constants::{self, ConicConstants};
use visviva_core::nbody::elements::{Elements, free_fall_time, state_from_elements};
use visviva_core::nbody::kepler::KeplerOrbit;
use visviva_core::parallel::Ticker;
use visviva_core::{Error, Result};

type Array<'py> = PyReadonlyArrayDyn<'py, f64>;
type Column<'py> = Bound<'py, PyArrayDyn<f64>>;

/// A value of each result, by name.
type Columns<T, V = f64> = &'static [(&'static str, fn(&T) -> V)];
type State = (Vector3<f64>, Vector3<f64>);

const ELEMENTS: Columns<Elements> = &[
    ("energy", |found| found.energy),
    ("hodograph_radius", |found| found.hodograph_radius),
    ("eccentricity", |found| found.eccentricity),
    ("semi_major_axis", |found| found.semi_major_axis),
    ("semi_minor_axis", |found| found.semi_minor_axis),
    ("semi_latus_rectum", |found| found.semi_latus_rectum),
    ("pericentre", |found| found.pericenter),
    ("apocentre", |found| found.apocenter),
    ("inclination", |found| found.inclination),
    ("node", |found| found.node),
    ("argument_of_pericentre", |found| found.argument_of_pericenter),
    ("true_anomaly", |found| found.true_anomaly),
    ("eccentric_anomaly", |found| found.eccentric_anomaly),
    ("mean_anomaly", |found| found.mean_anomaly),
    ("time_since_pericentre", |found| found.time_since_pericenter),
    ("period", |found| found.period),
    ("areal_rate", |found| found.areal_rate),
    ("turning_angle", |found| found.turning_angle),
];

const ELEMENT_VECTORS: Columns<Elements, Vector3<f64>> = &[
    ("angular_momentum", |found| found.angular_momentum),
    ("laplace_runge_lenz", |found| found.laplace_runge_lenz),
    ("hodograph_centre", |found| found.hodograph_center),
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
    Ok(values.chunks_exact(3).map(Vector3::from_column_slice).collect())
}

/// One result per orbit; a refusal says which orbit it is about.
fn each<T>(count: usize, ticker: &mut Ticker<'_>, mut one: impl FnMut(usize) -> Result<T>) -> Result<Vec<T>> {
    let which = |index: usize, error| match error {
        Error::InvalidInput { argument, message } if count > 1 => {
            Error::invalid(&argument, format!("{message} (entry {index} of {count})"))
        }
        other => other,
    };
    (0..count)
        .map(|index| {
            ticker.tick()?;
            one(index).map_err(|error| which(index, error))
        })
        .collect()
}

fn column(py: Python<'_>, values: Vec<f64>) -> PyResult<Column<'_>> {
    let length = values.len();
    moved(py, values, &[length])
}

/// The results by name, a number of each orbit.
fn table<'py, T>(py: Python<'py>, columns: Columns<T>, found: &[T]) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, of) in columns {
        dict.set_item(name, column(py, found.iter().map(of).collect())?)?;
    }
    Ok(dict)
}

/// `count` numbers of each of several arguments.
fn together<const K: usize>(arguments: [(&str, &Array<'_>); K]) -> PyResult<(usize, [Vec<f64>; K])> {
    let mut count = None;
    let mut all = [const { Vec::new() }; K];
    for ((name, array), values) in arguments.into_iter().zip(&mut all) {
        let (taken, [length]) = copied(name, array, [count])?;
        count = Some(length);
        *values = taken;
    }
    Ok((count.unwrap_or(0), all))
}

/// Elements of each state, by name.
#[pyfunction]
pub(crate) fn orbit_elements<'py>(
    py: Python<'py>,
    mu: Array<'py>,
    position: Array<'py>,
    velocity: Array<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let (count, [mu]) = together([("mu", &mu)])?;
    let position = vectors("position", &position, count)?;
    let velocity = vectors("velocity", &velocity, count)?;
    let found = compute(py, 0, None, |ticker| {
        each(count, ticker, |i| Elements::from_state(mu[i], position[i], velocity[i]))
    })?
    .whole(py)?;
    let dict = table(py, ELEMENTS, &found)?;
    for (name, of) in ELEMENT_VECTORS {
        let values = found.iter().flat_map(|elements| <[f64; 3]>::from(of(elements))).collect();
        dict.set_item(name, moved(py, values, &[count, 3])?)?;
    }
    Ok(dict)
}

/// Position and velocity of each set of elements.
#[pyfunction]
pub(crate) fn orbit_state<'py>(
    py: Python<'py>,
    mu: Array<'py>,
    pericentre: Array<'py>,
    eccentricity: Array<'py>,
    inclination: Array<'py>,
    node: Array<'py>,
    argument_of_pericentre: Array<'py>,
    true_anomaly: Array<'py>,
) -> PyResult<(Column<'py>, Column<'py>)> {
    let (count, [mu, q, e, i, node, w, nu]) = together([
        ("mu", &mu),
        ("pericentre", &pericentre),
        ("eccentricity", &eccentricity),
        ("inclination", &inclination),
        ("node", &node),
        ("argument_of_pericentre", &argument_of_pericentre),
        ("true_anomaly", &true_anomaly),
    ])?;
    let states = compute(py, 0, None, |ticker| {
        each(count, ticker, |k| state_from_elements(mu[k], q[k], e[k], i[k], node[k], w[k], nu[k]))
    })?
    .whole(py)?;
    let flat = |part: fn(&State) -> Vector3<f64>| {
        states.iter().flat_map(|state| <[f64; 3]>::from(part(state))).collect()
    };
    Ok((moved(py, flat(|state| state.0), &[count, 3])?, moved(py, flat(|state| state.1), &[count, 3])?))
}

/// Position and velocity, (T, N, 3) each, of N orbits at T times since their epoch.
#[pyfunction]
pub(crate) fn orbit_propagate<'py>(
    py: Python<'py>,
    mu: Array<'py>,
    position: Array<'py>,
    velocity: Array<'py>,
    t: Array<'py>,
) -> PyResult<(Column<'py>, Column<'py>)> {
    let (count, [mu]) = together([("mu", &mu)])?;
    let r = vectors("position", &position, count)?;
    let v = vectors("velocity", &velocity, count)?;
    let (times, [length]) = copied("t", &t, [None])?;
    let (position, velocity) = compute(py, 0, None, |ticker| {
        let orbits = each(count, ticker, |i| KeplerOrbit::new(mu[i], r[i], v[i]))?;
        let mut position = Vec::with_capacity(3 * count * length);
        let mut velocity = Vec::with_capacity(3 * count * length);
        for &time in &times {
            for orbit in &orbits {
                let (r, v) = orbit.state(time);
                position.extend(r.iter());
                velocity.extend(v.iter());
                ticker.tick()?;
            }
        }
        Ok((position, velocity))
    })?
    .whole(py)?;
    let shape = [length, count, 3];
    Ok((moved(py, position, &shape)?, moved(py, velocity, &shape)?))
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
    let (count, [anomaly, e]) = together([("anomaly", &anomaly), ("eccentricity", &eccentricity)])?;
    let values =
        compute(py, 0, None, |ticker| each(count, ticker, |i| convert(name, anomaly[i], e[i], repulsive)))?
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
    let (count, [mu, a]) = together([("mu", &mu), ("semi_major_axis", &semi_major_axis)])?;
    let values =
        compute(py, 0, None, |ticker| each(count, ticker, |i| constants::period(mu[i], a[i])))?.whole(py)?;
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
    let (count, [mu, start, end]) = together([("mu", &mu), ("start", &start), ("end", &end)])?;
    let values =
        compute(py, 0, None, |ticker| each(count, ticker, |i| free_fall_time(mu[i], start[i], end[i])))?
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
    let (count, [mass, strength]) = together([("mass", &mass), ("strength", &strength)])?;
    let r = vectors("position", &position, count)?;
    let v = vectors("velocity", &velocity, count)?;
    let found = compute(py, 0, None, |ticker| {
        each(count, ticker, |i| ConicConstants::from_state(mass[i], strength[i], r[i], v[i]))
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
    let (count, [mass, strength, l, energy]) = together([
        ("mass", &mass),
        ("strength", &strength),
        ("angular_momentum", &angular_momentum),
        ("energy", &energy),
    ])?;
    let found = compute(py, 0, None, |ticker| {
        each(count, ticker, |i| ConicConstants::from_constants(mass[i], strength[i], l[i], energy[i]))
    })?
    .whole(py)?;
    table(py, CONSTANTS, &found)
}
