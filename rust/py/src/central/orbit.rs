//! One orbit from a state: its constants, and where it is.

use super::{Array, Column, NUMBERS, described, flat, numbers_of, range_of};
use crate::arrays::moved;
use crate::gate::compute;
use nalgebra::Vector3;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::central::inverse_cube::InverseCube;
use visviva_core::central::landscape::Landscape;
use visviva_core::central::motion::Motion;
use visviva_core::central::state::Constants;
use visviva_core::{Error, Result};

/// A state: mass, position and velocity.
type State = (f64, [f64; 3], [f64; 3]);

fn constants(landscape: &Landscape, (mass, position, velocity): State) -> Constants {
    landscape.field().constants(mass, Vector3::from(position), Vector3::from(velocity))
}

/// Time and angle since the pericenter; NaN of what has none, or is a circle.
fn phase_of(landscape: &Landscape, found: &Constants, mass: f64) -> Result<(f64, f64)> {
    let ranges = landscape.ranges(found.energy, found.centrifugal);
    match range_of(&ranges, found.radius)? {
        Some(range) if matches!(range.kind(), "bound" | "escapes") => {
            let motion = Motion::new(landscape, range, found.energy, mass, found.centrifugal);
            if motion.counts_from_pericenter() {
                return motion.since_turn(motion.start(found.radius, found.radial_velocity));
            }
        }
        _ => {}
    }
    Ok((f64::NAN, f64::NAN))
}

/// What is constant of a state: numbers by name, those of its radial motion, and two directions that span the plane.
#[pyfunction]
pub(crate) fn central_state<'py>(
    py: Python<'py>,
    potentials: Vec<Bound<'py, PyDict>>,
    state: State,
) -> PyResult<(Bound<'py, PyDict>, &'static str)> {
    let potentials = described(&potentials)?;
    let (found, (numbers, kind), phase) = compute(py, 0, None, |_| {
        let landscape = Landscape::of(&potentials);
        let found = constants(&landscape, state);
        if !found.energy.is_finite() {
            let message = "expected one at which the potential is known and finite";
            return Err(Error::invalid("position", message));
        }
        let motion = numbers_of(&landscape, (found.energy, found.centrifugal, state.0, found.radius))?;
        let phase = phase_of(&landscape, &found, state.0)?;
        Ok((found, motion, phase))
    })?
    .whole(py)?;
    let dict = PyDict::new(py);
    dict.set_item("angular_momentum", found.angular_momentum)?;
    dict.set_item("energy", found.energy.to_f64())?;
    dict.set_item("outward", <[f64; 3]>::from(found.outward))?;
    dict.set_item("across", <[f64; 3]>::from(found.across))?;
    dict.set_item("phase", phase)?;
    for (name, value) in NUMBERS.iter().zip(numbers) {
        dict.set_item(name, value)?;
    }
    Ok((dict, kind))
}

/// Distance, angle and radial velocity at times, or at angles, since a state.
#[pyfunction]
pub(crate) fn central_places<'py>(
    py: Python<'py>,
    potentials: Vec<Bound<'py, PyDict>>,
    state: State,
    values: Array<'py>,
    angles: bool,
) -> PyResult<Column<'py>> {
    let potentials = described(&potentials)?;
    let values = flat("t", &values)?;
    let found = compute(py, 0, None, |ticker| {
        let landscape = Landscape::of(&potentials);
        let found = constants(&landscape, state);
        let ranges = landscape.ranges(found.energy, found.centrifugal);
        let Some(range) = range_of(&ranges, found.radius)? else {
            return Err(Error::Internal("a state beyond its own range of motion".to_owned()));
        };
        let motion = Motion::new(&landscape, range, found.energy, state.0, found.centrifugal);
        let start = (found.radius, found.radial_velocity);
        let mut places = Vec::with_capacity(values.len());
        for some in values.chunks(AT_A_TIME) {
            ticker.tick()?;
            places.extend(if angles {
                motion.at_angles(start, some)?
            } else {
                motion.places(start, some)?
            });
        }
        Ok(places)
    })?
    .whole(py)?;
    let numbers = found.iter().flat_map(|place| [place.radius, place.angle, place.radial_velocity]).collect();
    moved(py, numbers, &[found.len(), 3])
}

/// Places between two looks at the clock.
const AT_A_TIME: usize = 64;

/// The closed form of an inverse-square and an inverse-cube force: its constants, and distances at angles (NaN where it
/// does not come).
#[pyfunction]
pub(crate) fn central_inverse_cube<'py>(
    py: Python<'py>,
    strengths: (f64, f64),
    state: State,
    angles: Array<'py>,
) -> PyResult<(Bound<'py, PyDict>, Column<'py>)> {
    let angles = flat("angle", &angles)?;
    let (found, radii) = compute(py, 0, None, |_| {
        let (mass, position, velocity) = state;
        let (position, velocity) = (Vector3::from(position), Vector3::from(velocity));
        let r = position.norm();
        let across = position.cross(&velocity).norm() / r;
        let found = InverseCube::new(mass, strengths.0, strengths.1, r, position.dot(&velocity) / r, across)?;
        let radii: Vec<f64> = angles.iter().map(|angle| found.radius(*angle).unwrap_or(f64::NAN)).collect();
        Ok((found, radii))
    })?
    .whole(py)?;
    let dict = PyDict::new(py);
    dict.set_item("beta_squared", found.beta_squared)?;
    dict.set_item("angular_momentum", found.angular_momentum)?;
    dict.set_item("energy", found.energy)?;
    dict.set_item("eccentricity", found.eccentricity)?;
    dict.set_item("r_min", found.range.0)?;
    dict.set_item("r_max", found.range.1)?;
    dict.set_item("apsidal_angle", found.apsidal_angle)?;
    dict.set_item("radial_period", found.radial_period)?;
    let count = radii.len();
    Ok((dict, moved(py, radii, &[count])?))
}
