//! Scenes: plans and runs, conserved quantities, accelerations.
//!
//! The dictionaries that come and go here are described in `visviva/_core.pyi`: `input` reads them, `output`
//! writes them.

pub(crate) mod events;
mod input;
mod output;
pub(crate) mod rigid;

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::{compute, is_ctrl_c};
use input::{Array, Asked, forces as described, point, points, snapshot};
pub(crate) use output::Planned;
use output::{error_dict, output_dict, plan_dict, status};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use rigid::{Described, Turning};
use visviva_core::Error;
use visviva_core::conservation::PreciseBodies;
use visviva_core::conservation::columns::{COLUMNS, Snapshot, column};
use visviva_core::forces::term::About;
use visviva_core::forces::together::conserved_by;
use visviva_core::parallel::thread_count;
use visviva_core::scene::Scene;
use visviva_core::scene::acceleration::acceleration as acceleration_of;
use visviva_core::scene::refuse_frames;
use visviva_core::scene::run::neighbors::{Directions, Toward, follow};
use visviva_core::scene::run::{plan as plan_scene, run as run_scene};

/// Plans a run without running it.
#[pyfunction]
pub(crate) fn plan<'py>(py: Python<'py>, asked: Asked<'py>) -> PyResult<Bound<'py, PyDict>> {
    let (scene, request, _) = asked.prepared(None)?;
    let plan = compute(py, 0, None, |ticker| plan_scene(&scene, &request, ticker))?.whole(py)?;
    plan_dict(py, &plan)
}

/// Runs a scene, or a batch of copies of it.
#[pyfunction]
#[pyo3(signature = (asked, *, threads, progress, ensemble))]
pub(crate) fn run<'py>(
    py: Python<'py>,
    asked: Asked<'py>,
    threads: Option<i64>,
    progress: Option<Py<PyAny>>,
    ensemble: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let (scene, request, functions) = asked.prepared(threads)?;
    let start = std::time::Instant::now();
    let outcome = compute(py, 0, progress.as_ref(), |ticker| run_scene(&scene, &request, ticker))?;
    let (output, mut interrupted) = outcome.partial(py)?;
    if let Some(exception) = functions.raised.take() {
        if !is_ctrl_c(py, &exception) {
            return Err(exception);
        }
        interrupted = true;
    }
    let dict = output_dict(py, &scene, request, output, start.elapsed().as_secs_f64(), ensemble)?;
    dict.set_item("without_numbers", functions.without_numbers())?;
    if interrupted {
        // Also for a batch, and for a run that ended before it noticed: Ctrl-C is never swallowed.
        dict.set_item("error", error_dict(py, &Error::Interrupted)?)?;
    }
    Ok(dict)
}

/// What neighbors of the copies of a scene do: logarithms of their growth, and how each copy ended.
#[pyfunction]
#[pyo3(signature = (asked, toward, sizes, *, threads))]
pub(crate) fn neighbors<'py>(
    py: Python<'py>,
    asked: Asked<'py>,
    toward: Array<'py>,
    sizes: Array<'py>,
    threads: Option<i64>,
) -> PyResult<Bound<'py, PyTuple>> {
    let (scene, request, _) = asked.prepared(threads)?;
    let (toward, _) = copied("toward", &toward, [Some(scene.particles), Some(2), Some(3)])?;
    let (sizes, _) = copied("sizes", &sizes, [Some(scene.copies), Some(2)])?;
    let directions = points(&toward);
    let directions = Directions::OfAll(directions.as_chunks::<2>().0);
    let toward = Toward { directions, sizes: sizes.as_chunks::<2>().0 };
    let grown = compute(py, 0, None, |ticker| follow(&scene, &request, &toward, ticker))?.whole(py)?;
    let status = grown.iter().map(|copy| status(&copy.ending)).collect();
    let shape = [grown.len(), request.times.len()];
    let growth = grown.into_iter().flat_map(|copy| copy.growth).collect();
    (moved(py, growth, &shape)?, moved(py, status, &shape[..1])?).into_pyobject(py)
}

/// What small differences of the copies of a scene become by their linear equations, and how each copy ended.
#[pyfunction]
#[pyo3(signature = (asked, toward, sizes, *, threads))]
pub(crate) fn differences<'py>(
    py: Python<'py>,
    asked: Asked<'py>,
    toward: Array<'py>,
    sizes: Array<'py>,
    threads: Option<i64>,
) -> PyResult<Bound<'py, PyTuple>> {
    let (scene, request, _) = asked.prepared(threads)?;
    let (copies, particles) = (scene.copies, scene.particles);
    let (toward, _) = copied("toward", &toward, [Some(copies), Some(particles), Some(2), Some(3)])?;
    let (sizes, _) = copied("sizes", &sizes, [Some(copies), Some(2)])?;
    let directions = points(&toward);
    let directions = Directions::OfEach(directions.as_chunks::<2>().0);
    let toward = Toward { directions, sizes: sizes.as_chunks::<2>().0 };
    let grown = compute(py, 0, None, |ticker| follow(&scene, &request, &toward, ticker))?.whole(py)?;
    let status = grown.iter().map(|copy| status(&copy.ending)).collect();
    let numbers = grown.into_iter().flat_map(|copy| copy.differences.into_flattened().into_flattened());
    let shape = [copies, request.times.len(), particles, 2, 3];
    (moved(py, numbers.collect(), &shape)?, moved(py, status, &shape[..1])?).into_pyobject(py)
}

/// Conserved quantities of recorded states.
#[pyfunction]
#[pyo3(signature = (*, mass, forces, position, velocity, about, columns, turning=None))]
pub(crate) fn conserved<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    forces: Bound<'py, PyList>,
    position: Array<'py>,
    velocity: Option<Array<'py>>,
    about: Array<'py>,
    columns: Vec<String>,
    turning: Option<(Described<'py>, Array<'py>, Array<'py>)>,
) -> PyResult<Bound<'py, PyDict>> {
    let (mass, [particles]) = copied("mass", &mass, [None])?;
    let (position, [times, ..]) = copied("position", &position, [None, Some(particles), Some(3)])?;
    let velocity = match velocity {
        Some(velocity) => copied("velocity", &velocity, [Some(times), Some(particles), Some(3)])?.0,
        None => vec![0.0; position.len()],
    };
    let specs = described(&forces)?;
    if turning.is_some() {
        refuse_frames(&specs).map_err(|error| raised(py, error))?;
    }
    let turning = turning.map(|given| Turning::prepared(given, times, &specs)).transpose()?;
    let about = point(&copied("about", &about, [Some(3)])?.0);
    let (position, velocity) = (points(&position), points(&velocity));
    let columns = columns.iter().map(|name| column("columns", name)).collect::<Result<Vec<_>, _>>();
    let columns = columns.map_err(|error| raised(py, error))?;
    let threads = thread_count(None).map_err(|error| raised(py, error))?;
    let values = compute(py, times as u64, None, |ticker| {
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
        let mut bodies = PreciseBodies::default();
        let (mut positions, mut velocities) = (position.iter(), velocity.iter());
        for time in 0..times {
            bodies.clear(particles);
            let states = positions.by_ref().zip(velocities.by_ref());
            for ((i, &mass), (&position, &velocity)) in mass.iter().enumerate().zip(states) {
                bodies.set(i, mass, [position, [0.0; 3]], [velocity, [0.0; 3]]);
            }
            bodies.settle();
            let mut state = Snapshot::new(&specs, &bodies, about, threads, ticker);
            for (column, values) in columns.iter().zip(&mut values) {
                let own = state.value(column)?;
                let places = position.get(time * particles..(time + 1) * particles).unwrap_or_default();
                let share =
                    turning.as_ref().map_or([0.0; 3], |of| of.share(column.name, time, &mass, places));
                values.extend(own.iter().zip(share).map(|(own, share)| own + share).take(column.width));
            }
            ticker.tick()?;
        }
        Ok(values)
    })?
    .whole(py)?;
    let dict = PyDict::new(py);
    for (column, values) in columns.into_iter().zip(values) {
        let shape: &[usize] = if column.width == 1 { &[times] } else { &[times, column.width] };
        dict.set_item(column.name, moved(py, values, shape)?)?;
    }
    Ok(dict)
}

/// The derived columns that there are: name, description, numbers for each time, whether velocities are needed.
#[pyfunction]
pub(crate) fn columns() -> Vec<(&'static str, &'static str, usize, bool)> {
    COLUMNS
        .iter()
        .map(|column| (column.name, column.description, column.width, column.needs_velocity))
        .collect()
}

/// What the forces on bodies leave constant.
#[pyfunction]
#[pyo3(signature = (*, mass, forces, position, velocity, about))]
pub(crate) fn conserves<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    forces: Bound<'py, PyList>,
    position: Array<'py>,
    velocity: Array<'py>,
    about: Array<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let scene = snapshot(&mass, &position, &velocity, &forces)?;
    let about = point(&copied("about", &about, [Some(3)])?.0);
    let conserves = compute(py, 0, None, |_| Ok(conserved_by(&scene.forces, &scene.bodies())))?.whole(py)?;
    let dict = PyDict::new(py);
    dict.set_item("momentum", conserves.momentum)?;
    dict.set_item(
        "angular_momentum",
        match conserves.angular_momentum {
            About::Nowhere => false,
            About::Point(point) => point == about,
            About::Everywhere => true,
        },
    )?;
    dict.set_item("spin", conserves.spin)?;
    dict.set_item("energy", conserves.energy)?;
    Ok(dict)
}

/// The acceleration of every particle at that time.
#[pyfunction]
#[pyo3(signature = (*, mass, forces, position, velocity, t0))]
pub(crate) fn acceleration<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    forces: Bound<'py, PyList>,
    position: Array<'py>,
    velocity: Array<'py>,
    t0: f64,
) -> PyResult<Bound<'py, numpy::PyArrayDyn<f64>>> {
    let scene = Scene { t0, ..snapshot(&mass, &position, &velocity, &forces)? };
    let threads = thread_count(None).map_err(|error| raised(py, error))?;
    let shape = [scene.particles, 3];
    let values = compute(py, 0, None, |ticker| acceleration_of(&scene, threads, ticker))?.whole(py)?;
    moved(py, values.into_iter().flatten().collect(), &shape)
}
