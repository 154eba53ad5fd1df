//! Positions and velocities: of elements, of elements that were found of a state, and of a state at another time.

use super::{Array, Column, PositionVelocity, each, flat, together, vectors};
use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use nalgebra::Vector3;
use pyo3::prelude::*;
use visviva_core::memory::reserved;
use visviva_core::nbody::kepler::KeplerOrbit;
use visviva_core::nbody::state::{Anomaly, Shape, state_from_elements};
use visviva_core::nbody::state_again::{AllElements, state_of_all};
use visviva_core::words::unknown;

/// Position and velocity of each set of elements, the last of which is an anomaly of that name.
#[pyfunction]
pub(crate) fn orbit_state<'py>(
    py: Python<'py>,
    name: &str,
    mu: Array<'py>,
    pericenter: Array<'py>,
    eccentricity: Array<'py>,
    inclination: Array<'py>,
    node: Array<'py>,
    argument_of_pericenter: Array<'py>,
    anomaly: Array<'py>,
) -> PyResult<(Column<'py>, Column<'py>)> {
    let elements = together([
        ("mu", &mu),
        ("pericenter", &pericenter),
        ("eccentricity", &eccentricity),
        ("inclination", &inclination),
        ("node", &node),
        ("argument_of_pericenter", &argument_of_pericenter),
        (name, &anomaly),
    ])?;
    let kind = match name {
        "true_anomaly" => Anomaly::True,
        "eccentric_anomaly" => Anomaly::Eccentric,
        "mean_anomaly" => Anomaly::Mean,
        other => {
            let known = ["true_anomaly", "eccentric_anomaly", "mean_anomaly"];
            return Err(raised(py, unknown("name", other, known.into_iter())));
        }
    };
    let count = elements.count;
    let states = compute(py, 0, None, |ticker| {
        let one =
            |[mu, pericenter, eccentricity, inclination, node, argument_of_pericenter, anomaly]: [f64; 7]| {
                let shape = Shape { pericenter, eccentricity, inclination, node, argument_of_pericenter };
                state_from_elements(mu, shape, kind(anomaly))
            };
        each((name, count), ticker, elements.orbits(), one)
    })?
    .whole(py)?;
    states_apart(py, name, &states)
}

/// Position and velocity of each set of elements that was found of a state, in the order
/// that is taken apart below.
#[pyfunction]
pub(crate) fn orbit_state_again<'py>(
    py: Python<'py>,
    elements: [Array<'py>; 12],
) -> PyResult<(Column<'py>, Column<'py>)> {
    let elements = together(elements.each_ref().map(|column| ("elements", column)))?;
    let count = elements.count;
    let states = compute(py, 0, None, |ticker| {
        let one = |[
            mu,
            energy,
            pericenter,
            eccentricity,
            inclination,
            node,
            argument_of_pericenter,
            semi_major_axis,
            semi_minor_axis,
            true_anomaly,
            eccentric_anomaly,
            mean_anomaly,
        ]: [f64; 12]| {
            let shape = Shape { pericenter, eccentricity, inclination, node, argument_of_pericenter };
            let all = AllElements {
                shape,
                energy,
                semi_major_axis,
                semi_minor_axis,
                true_anomaly,
                eccentric_anomaly,
                mean_anomaly,
            };
            state_of_all(mu, &all)
        };
        each(("true_anomaly", count), ticker, elements.orbits(), one)
    })?
    .whole(py)?;
    states_apart(py, "elements", &states)
}

/// Positions and velocities as two arrays.
fn states_apart<'py>(
    py: Python<'py>,
    name: &str,
    states: &[PositionVelocity],
) -> PyResult<(Column<'py>, Column<'py>)> {
    let vectors = |part: fn(&PositionVelocity) -> Vector3<f64>| {
        let values = flat(name, states.iter().map(part)).map_err(|error| raised(py, error))?;
        moved(py, values, &[states.len(), 3])
    };
    Ok((vectors(|state| state.0)?, vectors(|state| state.1)?))
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
    let mu = together([("mu", &mu)])?;
    let count = mu.count;
    let r = vectors("position", &position, count)?;
    let v = vectors("velocity", &velocity, count)?;
    let (times, [length]) = copied("t", &t, [None])?;
    let (position, velocity) = compute(py, 0, None, |ticker| {
        let [mut position, mut velocity] = reserved(
            "t",
            "positions and velocities at all these times",
            count.checked_mul(length).and_then(|n| n.checked_mul(3)),
        )?;
        let states = mu.orbits().zip(&r).zip(&v);
        let orbits =
            each(("position", count), ticker, states, |(([mu], r), v)| KeplerOrbit::new(mu, *r, *v))?;
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
