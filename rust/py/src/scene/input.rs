//! What Python asks of a scene: its keywords as the core's plain data.

use super::events::{Functions, events};
use super::rigid::Described;
use crate::arrays::copied;
use crate::errors::raised;
use crate::registry;
use numpy::PyReadonlyArrayDyn;
use pyo3::exceptions::PyValueError;
use pyo3::ffi::PyObject;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;
use visviva_core::Error;
use visviva_core::forces::ForceTerm;
use visviva_core::parallel::thread_count;
use visviva_core::scene::collisions::Collisions;
use visviva_core::scene::continuation::{Continuation, Held};
use visviva_core::scene::request::{AbsoluteTolerances, Request};
use visviva_core::scene::{OwnForces, Scene};

pub(super) type Array<'py> = PyReadonlyArrayDyn<'py, f64>;

/// A number for all bodies or one for each, if any.
type OneOrEach = Option<Vec<f64>>;

/// The dictionary that `run` and `plan` take: a scene of one or more copies, and what is asked of it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked<'py> {
    mass: Array<'py>,
    position: Array<'py>,
    velocity: Array<'py>,
    radius: Option<Array<'py>>,
    rigid: Option<Described<'py>>,
    forces: Bound<'py, PyList>,
    own_forces: Option<(Vec<Bound<'py, PyList>>, Vec<usize>)>,
    t0: f64,
    continuation: Option<Continued<'py>>,
    times: Array<'py>,
    end_only: bool,
    method: String,
    dt: Option<f64>,
    time_transformation: Option<String>,
    rtol: f64,
    rtol_given: bool,
    atol: Option<(OneOrEach, OneOrEach)>,
    max_step: Option<f64>,
    max_steps: Option<i64>,
    record: Vec<String>,
    events: Vec<Bound<'py, PyDict>>,
    collisions: Option<String>,
    restitution: Option<f64>,
}

/// How a run came to the scene.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Continued<'py> {
    form: i64,
    method: String,
    dt: f64,
    t0: f64,
    node: u64,
    position: Array<'py>,
    velocity: Array<'py>,
    orientation: Array<'py>,
    angular_velocity: Array<'py>,
    held: Array<'py>,
}

impl Continued<'_> {
    /// Of so many copies of so many particles.
    fn prepared(self, copies: usize, particles: usize) -> PyResult<Continuation> {
        let shape = [Some(copies), Some(particles), Some(3)];
        let position = points(&copied("position", &self.position, shape)?.0);
        let velocity = points(&copied("velocity", &self.velocity, shape)?.0);
        let (orientation, [_, rigid, _]) =
            copied("orientation", &self.orientation, [Some(copies), None, Some(4)])?;
        let spin = [Some(copies), Some(rigid), Some(3)];
        let spin = points(&copied("angular_velocity", &self.angular_velocity, spin)?.0);
        let turned = orientation.as_chunks::<4>().0.iter().copied().zip(spin).collect();
        let (numbers, [_, blocks, slots, _]) =
            copied("held", &self.held, [Some(copies), None, None, Some(3)])?;
        let Self { form, method, dt, t0, node, .. } = self;
        Ok(Continuation {
            form,
            method,
            dt,
            t0,
            position,
            velocity,
            turned,
            node,
            held: Held { blocks, slots, numbers },
        })
    }
}

impl Asked<'_> {
    /// The scene and the request, to be run on so many threads, and what Python functions among the events do.
    ///
    /// # Errors
    /// `InvalidInput` for arrays whose shapes do not agree, no copies, an unknown force, a number of threads that cannot be.
    pub(super) fn prepared(self, threads: Option<i64>) -> PyResult<(Scene, Request, Functions)> {
        let py = self.forces.py();
        let (mass, [copies, particles]) = copied("mass", &self.mass, [None, None])?;
        if copies == 0 {
            return Err(raised(
                py,
                Error::invalid("mass", "expected at least one copy of the scene, got none"),
            ));
        }
        let shape = [Some(copies), Some(particles), Some(3)];
        let position = points(&copied("position", &self.position, shape)?.0);
        let velocity = points(&copied("velocity", &self.velocity, shape)?.0);
        let radius = match &self.radius {
            Some(radius) => copied("radius", radius, [Some(copies), Some(particles)])?.0,
            None => Vec::new(),
        };
        let (t0, forces) = (self.t0, forces(&self.forces)?);
        let threads = thread_count(threads).map_err(|error| raised(py, error))?;
        let (times, _) = copied("t", &self.times, [None])?;
        let collisions = match (&self.collisions, self.restitution) {
            (None, None) => None,
            // What is given for nothing is refused like any name.
            (name, part) => {
                let name = name.as_deref().unwrap_or("stop");
                Some(Collisions::named(name, part).map_err(|error| raised(py, error))?)
            }
        };
        let mut functions = Functions::default();
        let events = events(&self.events, particles, &mut functions)?;
        let Self {
            method, dt, time_transformation, rtol, rtol_given, atol, max_step, max_steps, record, ..
        } = self;
        // An end alone means the start and the end.
        let times = if self.end_only { [t0].into_iter().chain(times).collect() } else { times };
        let continuation = self.continuation.map(|from| from.prepared(copies, particles)).transpose()?;
        let own_forces = self.own_forces.map(|own| own_forces(&own, copies)).transpose()?;
        let rigid = self.rigid.map(|rigid| rigid.prepared(copies)).transpose()?;
        let scene = Scene {
            copies,
            particles,
            mass,
            position,
            velocity,
            forces,
            own_forces,
            radius,
            rigid,
            t0,
            t0_rest: 0.0,
            continuation,
        };
        let atol = atol.map(|(position, velocity)| AbsoluteTolerances { position, velocity });
        let request = Request {
            times,
            method,
            dt,
            time_transformation,
            rtol,
            rtol_given,
            atol,
            max_step,
            first_step: None,
            max_steps,
            record,
            events,
            collisions,
            threads,
        };
        Ok((scene, request, functions))
    }
}

/// A scene of one copy, whose time does not matter.
///
/// # Errors
/// As [`Asked::prepared`].
pub(super) fn snapshot(
    mass: &Array<'_>,
    position: &Array<'_>,
    velocity: &Array<'_>,
    specs: &Bound<'_, PyList>,
) -> PyResult<Scene> {
    let (mass, [particles]) = copied("mass", mass, [None])?;
    let position = points(&copied("position", position, [Some(particles), Some(3)])?.0);
    let velocity = points(&copied("velocity", velocity, [Some(particles), Some(3)])?.0);
    Ok(Scene {
        copies: 1,
        particles,
        mass,
        position,
        velocity,
        forces: forces(specs)?,
        own_forces: None,
        radius: Vec::new(),
        rigid: None,
        t0: 0.0,
        t0_rest: 0.0,
        continuation: None,
    })
}

/// The first point of these numbers.
pub(super) fn point(values: &[f64]) -> [f64; 3] {
    values.first_chunk().copied().unwrap_or_default()
}

pub(super) fn points(values: &[f64]) -> Vec<[f64; 3]> {
    values.as_chunks().0.to_vec()
}

/// The sets of forces that copies have of their own, and which of them each has.
///
/// # Errors
/// As [`forces`], and for sets that are not there.
fn own_forces((sets, of_copy): &(Vec<Bound<'_, PyList>>, Vec<usize>), copies: usize) -> PyResult<OwnForces> {
    // A description that several sets have is one force: what is one and the same may be shared where nothing else may.
    let mut known: HashMap<*mut PyObject, Arc<dyn ForceTerm>> = HashMap::new();
    let mut force = |spec: Bound<'_, PyAny>| match known.entry(spec.as_ptr()) {
        Entry::Occupied(force) => Ok(Arc::clone(force.get())),
        Entry::Vacant(place) => Ok(Arc::clone(place.insert(registry::force(spec.cast::<PyDict>()?)?))),
    };
    let sets: Vec<_> =
        sets.iter().map(|set| set.iter().map(&mut force).collect()).collect::<PyResult<_>>()?;
    if of_copy.len() != copies || of_copy.iter().any(|&set| set >= sets.len()) {
        return Err(PyValueError::new_err("own_forces: expected a set of forces for each copy"));
    }
    Ok(OwnForces { sets, of_copy: of_copy.clone() })
}

/// The forces of a scene's description.
///
/// # Errors
/// `InvalidInput` for a kind, a parameter or a potential that is not known.
pub(super) fn forces(specs: &Bound<'_, PyList>) -> PyResult<Vec<Arc<dyn ForceTerm>>> {
    specs.iter().map(|spec| registry::force(spec.cast::<PyDict>()?)).collect()
}
