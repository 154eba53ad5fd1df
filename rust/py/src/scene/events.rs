//! Events as Python describes them, and Python functions among them.
//!
//! A function is called with the GIL held, on the thread that called `run`. What it raises ends the run and is raised again,
//! the same object.

use crate::arrays::moved;
use crate::errors::raised;
use crate::gate::attached;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use visviva_core::scene::events::{Event, Expression, Focus, Function, What};
use visviva_core::scene::unit::Turned;
use visviva_core::{Error, Result};

/// What a Python function among the events has raised.
#[derive(Clone, Default)]
pub(crate) struct Raised(Arc<Mutex<Option<PyErr>>>);

/// What the Python functions among the events did.
#[derive(Default)]
pub(super) struct Functions {
    pub(super) raised: Raised,
    /// Of each its place among the events, and whether it has given a number yet.
    numbers: Vec<(usize, Arc<AtomicBool>)>,
}

impl Functions {
    /// The places of those that gave none but NaN.
    pub(super) fn without_numbers(&self) -> Vec<usize> {
        let without = self.numbers.iter().filter(|(_, given)| !given.load(Ordering::Relaxed));
        without.map(|(place, _)| *place).collect()
    }
}

impl Raised {
    fn with<T>(&self, action: impl FnOnce(&mut Option<PyErr>) -> T) -> T {
        action(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// What a function gives; what it raises is kept and ends the run, and it is not called again.
    pub(crate) fn called(&self, call: impl FnOnce(Python<'_>) -> PyResult<f64>) -> Result<f64> {
        if self.with(|exception| exception.is_some()) {
            return Err(Error::Interrupted);
        }
        attached(call).map_err(|exception| {
            self.with(|place| *place = Some(exception));
            Error::Interrupted
        })
    }

    /// The exception, once.
    pub(crate) fn take(&self) -> Option<PyErr> {
        self.with(Option::take)
    }
}

/// The events that are described by these dictionaries.
///
/// # Errors
/// `InvalidInput` for an unknown kind; `KeyError` and `TypeError` for what `visviva.events` does not write.
pub(super) fn events(
    descriptions: &[Bound<'_, PyDict>],
    particles: usize,
    functions: &mut Functions,
) -> PyResult<Vec<Event>> {
    let of_each = |(place, description)| event(description, place, particles, functions);
    descriptions.iter().enumerate().map(of_each).collect()
}

fn event(
    description: &Bound<'_, PyDict>,
    place: usize,
    particles: usize,
    functions: &mut Functions,
) -> PyResult<Event> {
    let item = |name: &str| description.as_any().get_item(name);
    let kind: String = item("kind")?.extract()?;
    let what = match kind.as_str() {
        "distance" => What::Distance {
            bodies: (item("first")?.extract()?, item("second")?.extract()?),
            length: item("distance")?.extract()?,
        },
        "plane" => {
            let normal: [f64; 3] = item("normal")?.extract()?;
            // First by the largest, so that no square leaves the range.
            let largest = normal.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
            let direction = normal.map(|x| x / largest);
            let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
            What::Plane {
                body: item("body")?.extract()?,
                point: item("point")?.extract()?,
                normal: direction.map(|x| x / length),
            }
        }
        "apsis" => {
            let about = item("about")?;
            let about = match about.extract::<usize>() {
                Ok(body) => Focus::Body(body),
                Err(_) => Focus::Point(about.extract()?),
            };
            What::Apsis { body: item("body")?.extract()?, about }
        }
        "energy" => What::Energy(item("value")?.extract()?),
        "expression" => {
            let nodes: Vec<f64> = item("nodes")?.extract()?;
            let coordinates: Vec<(usize, usize)> = item("coordinates")?.extract()?;
            let read = Expression::read(&nodes, &coordinates);
            What::Expression(read.map_err(|error| raised(description.py(), error))?)
        }
        "function" => {
            let given = Arc::new(AtomicBool::new(false));
            functions.numbers.push((place, given.clone()));
            let sees_turning = item("sees_turning")?.extract()?;
            let call = item("function")?.unbind();
            function((call, sees_turning), particles, functions.raised.clone(), given)
        }
        other => {
            let message = format!("expected one of visviva.events, got the kind {other}");
            return Err(raised(description.py(), Error::invalid("events", message)));
        }
    };
    Ok(Event { what, direction: item("direction")?.extract()?, last: item("last")?.extract()? })
}

/// The number that an event function gave.
///
/// # Errors
/// `InvalidInput` for anything else.
pub(crate) fn number(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    value.extract().map_err(|_| {
        let class = value.get_type().name().map_or_else(|_| "object".to_owned(), |name| name.to_string());
        let message = format!(
            "expected functions of time and state that give a number, got {class}; end with float(…)"
        );
        raised(value.py(), Error::invalid("events", message))
    })
}

fn function(
    (function, sees_turning): (Py<PyAny>, bool),
    particles: usize,
    exceptions: Raised,
    given: Arc<AtomicBool>,
) -> What {
    let call = move |t: f64, position: &[f64], velocity: &[f64], turned: &[Turned]| -> Result<f64> {
        let value = exceptions.called(|py| {
            let shape = [particles, 3];
            let position = moved(py, position.to_vec(), &shape)?;
            let velocity = moved(py, velocity.to_vec(), &shape)?;
            if !sees_turning {
                return number(function.call1(py, (t, position, velocity))?.bind(py));
            }
            let orientations = turned.iter().flat_map(|(orientation, _)| *orientation).collect();
            let spins = turned.iter().flat_map(|(_, angular_velocity)| *angular_velocity).collect();
            let orientation = moved(py, orientations, &[turned.len(), 4])?;
            let angular_velocity = moved(py, spins, &[turned.len(), 3])?;
            number(function.call1(py, (t, position, velocity, orientation, angular_velocity))?.bind(py))
        })?;
        if !value.is_nan() {
            given.store(true, Ordering::Relaxed);
        }
        Ok(value)
    };
    What::Function(Function { call: Arc::new(call), sees_turning })
}
