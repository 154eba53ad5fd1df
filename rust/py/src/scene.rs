//! Scenes: plans and runs, conserved quantities, accelerations.
//!
//! The dictionaries that come and go here are described in `visviva/_core.pyi`.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use numpy::PyReadonlyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use visviva_core::conservation::{self, Body};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::numerics::simd::tier;
use visviva_core::parallel::thread_count;
use visviva_core::scene::acceleration::acceleration as acceleration_of;
use visviva_core::scene::integrate::Ending;
use visviva_core::scene::plan::{Plan, Solution};
use visviva_core::scene::request::{Request, unknown};
use visviva_core::scene::run::{Outcome, Output, run as run_scene};
use visviva_core::scene::{ForceSpec, Scene};
use visviva_core::{Error, registry};

type Array<'py> = PyReadonlyArrayDyn<'py, f64>;

fn points(values: &[f64]) -> Vec<[f64; 3]> {
    values.chunks_exact(3).map(|x| [x[0], x[1], x[2]]).collect()
}

fn get<'py, T: for<'a> FromPyObject<'a, 'py, Error: Into<PyErr>>>(
    dict: &Bound<'py, PyDict>,
    key: &str,
) -> PyResult<T> {
    let value = dict
        .get_item(key)?
        .ok_or_else(|| raised(dict.py(), Error::invalid("forces", format!("a force lacks '{key}'"))))?;
    value.extract().map_err(Into::into)
}

/// A vector of a force's description, given as an array.
fn vector(dict: &Bound<'_, PyDict>, key: &str) -> PyResult<[f64; 3]> {
    let (values, _) = copied(key, &get::<Array<'_>>(dict, key)?, [Some(3)])?;
    Ok([values[0], values[1], values[2]])
}

/// The potential of a registry name.
pub(crate) fn potential(
    py: Python<'_>,
    name: &str,
    parameters: &[f64],
) -> PyResult<std::sync::Arc<dyn visviva_core::potentials::Potential>> {
    let names = registry::POTENTIALS.iter().map(|declaration| declaration.name);
    registry::potential(name)
        .ok_or_else(|| unknown("potential", name, names))
        .and_then(|declaration| declaration.build(parameters))
        .map_err(|error| raised(py, error))
}

fn force(spec: &Bound<'_, PyDict>) -> PyResult<ForceSpec> {
    let kind: String = get(spec, "kind")?;
    match kind.as_str() {
        "gravity" => Ok(ForceSpec::Gravity { constant: get(spec, "G")?, softening: get(spec, "softening")? }),
        "uniform_field" => Ok(ForceSpec::UniformField { g: vector(spec, "g")? }),
        "central_field" => {
            let (name, parameters): (String, Vec<f64>) = (get(spec, "potential")?, get(spec, "parameters")?);
            let potential = potential(spec.py(), &name, &parameters)?;
            Ok(ForceSpec::CentralField { potential, center: vector(spec, "center")? })
        }
        other => {
            let kinds = ["gravity", "uniform_field", "central_field"].into_iter();
            Err(raised(spec.py(), unknown("forces", other, kinds)))
        }
    }
}

fn forces(specs: &Bound<'_, PyList>) -> PyResult<Vec<ForceSpec>> {
    specs.iter().map(|spec| force(spec.cast::<PyDict>()?)).collect()
}

/// A scene, with or without the axis over copies.
fn scene(
    mass: &Array<'_>,
    position: &Array<'_>,
    velocity: &Array<'_>,
    specs: &Bound<'_, PyList>,
    t0: f64,
    axis_over_copies: bool,
) -> PyResult<Scene> {
    let (mass, copies, particles) = if axis_over_copies {
        let (mass, [copies, particles]) = copied("mass", mass, [None, None])?;
        (mass, copies, particles)
    } else {
        let (mass, [particles]) = copied("mass", mass, [None])?;
        (mass, 1, particles)
    };
    let vectors = |name: &str, array: &Array<'_>| {
        if axis_over_copies {
            copied(name, array, [Some(copies), Some(particles), Some(3)]).map(|(values, _)| values)
        } else {
            copied(name, array, [Some(particles), Some(3)]).map(|(values, _)| values)
        }
    };
    let (position, velocity) = (vectors("position", position)?, vectors("velocity", velocity)?);
    Ok(Scene {
        copies,
        particles,
        mass,
        position: points(&position),
        velocity: points(&velocity),
        forces: forces(specs)?,
        t0,
    })
}

/// The output times; an end alone means the start and the end.
fn output_times(times: &Array<'_>, end_only: bool, t0: f64) -> PyResult<Vec<f64>> {
    let (times, _) = copied("t", times, [None])?;
    Ok(if end_only { [t0].into_iter().chain(times).collect() } else { times })
}

fn plan_dict<'py>(py: Python<'py>, plan: &Plan) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let rows = plan.rows();
    let integration = plan.solution == Solution::Integration;
    dict.set_item("solution", rows.first().map(|row| row.decision.clone()))?;
    dict.set_item("method", plan.method_name())?;
    dict.set_item("evaluations_per_step", if integration { plan.method.stages } else { 0 })?;
    dict.set_item("pairs_per_evaluation", if integration { plan.pairs_per_evaluation() } else { 0 })?;
    dict.set_item("active", plan.active.len())?;
    dict.set_item("passive", plan.passive.len())?;
    dict.set_item("particles", plan.active.len() + plan.passive.len())?;
    dict.set_item("threads", plan.threads.0.max(plan.threads.1))?;
    dict.set_item("lanes", plan.lanes())?;
    dict.set_item("text", plan.to_string())?;
    let rows: Vec<_> = rows.into_iter().map(|row| (row.what, row.decision, row.reason)).collect();
    dict.set_item("rows", rows)?;
    dict.set_item("skipped", plan.skipped())?;
    Ok(dict)
}

/// Plans a run without running it.
#[pyfunction]
#[pyo3(signature = (*, mass, position, velocity, forces, t0, times, end_only, method, dt, rtol, atol, max_step, max_steps, record))]
pub(crate) fn plan<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    position: Array<'py>,
    velocity: Array<'py>,
    forces: Bound<'py, PyList>,
    t0: f64,
    times: Array<'py>,
    end_only: bool,
    method: String,
    dt: Option<f64>,
    rtol: f64,
    atol: Option<f64>,
    max_step: Option<f64>,
    max_steps: Option<i64>,
    record: Vec<String>,
) -> PyResult<Bound<'py, PyDict>> {
    let scene = scene(&mass, &position, &velocity, &forces, t0, true)?;
    let threads = thread_count(None).map_err(|error| raised(py, error))?;
    let times = output_times(&times, end_only, t0)?;
    let request = Request { times, method, dt, rtol, atol, max_step, max_steps, record, threads };
    let plan = compute(py, 0, None, |_| Plan::new(&scene, &request))?.whole(py)?;
    plan_dict(py, &plan)
}

/// Runs a scene, or a batch of copies of it.
#[pyfunction]
#[pyo3(signature = (*, mass, position, velocity, forces, t0, times, end_only, method, dt, rtol, atol, max_step, max_steps, record, threads, progress, ensemble))]
pub(crate) fn run<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    position: Array<'py>,
    velocity: Array<'py>,
    forces: Bound<'py, PyList>,
    t0: f64,
    times: Array<'py>,
    end_only: bool,
    method: String,
    dt: Option<f64>,
    rtol: f64,
    atol: Option<f64>,
    max_step: Option<f64>,
    max_steps: Option<i64>,
    record: Vec<String>,
    threads: Option<i64>,
    progress: Option<Py<PyAny>>,
    ensemble: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let scene = scene(&mass, &position, &velocity, &forces, t0, true)?;
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    let times = output_times(&times, end_only, t0)?;
    let request = Request { times, method, dt, rtol, atol, max_step, max_steps, record, threads };
    let start = std::time::Instant::now();
    let outcome = compute(py, 0, progress.as_ref(), |ticker| run_scene(&scene, &request, ticker))?;
    let (output, interrupted) = outcome.partial(py)?;
    let dict = output_dict(py, &scene, &request, output, start.elapsed().as_secs_f64(), ensemble)?;
    if interrupted {
        // Also for a batch, and for a run that ended before it noticed: Ctrl-C is never swallowed.
        dict.set_item("error", error_dict(py, &Error::Interrupted)?)?;
    }
    Ok(dict)
}

fn status(ending: &Ending) -> i8 {
    match ending {
        Ending::Finished => 0,
        Ending::CloseEncounter { .. } => 1,
        Ending::NotFinite => 2,
        Ending::Interrupted => 3,
        Ending::TooManySteps => 4,
    }
}

/// What an ending means, as the error that a single run raises.
fn failure(outcome: &Outcome) -> Option<Error> {
    let time = outcome.time;
    match &outcome.ending {
        Ending::Finished => None,
        Ending::CloseEncounter { bodies, distance } => {
            Some(Error::CloseEncounter { time, bodies: *bodies, distance: *distance })
        }
        Ending::NotFinite => Some(Error::Convergence {
            message: "the state became infinite or undefined; a smaller step, a softening or an adaptive \
                      method may pass"
                .to_owned(),
            time,
        }),
        Ending::TooManySteps => {
            Some(Error::Convergence { message: "max_steps were taken before the end".to_owned(), time })
        }
        Ending::Interrupted => Some(Error::Interrupted),
    }
}

/// What a run gave, as described in `visviva/_core.pyi`. A single run that failed keeps the rows it has.
fn output_dict<'py>(
    py: Python<'py>,
    scene: &Scene,
    request: &Request,
    output: Output,
    seconds: f64,
    ensemble: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let (copies, particles) = (scene.copies, scene.particles);
    let outcomes = &output.outcomes;
    let times = if ensemble { request.times.len() } else { outcomes[0].rows };
    let columns = PyDict::new(py);
    let set = |name: &str, mut values: Vec<f64>, shape: &[usize]| {
        values.truncate(shape.iter().product());
        columns.set_item(name, moved(py, values, shape)?)
    };
    if request.records("position") {
        set("position", output.columns.position, &[copies, times, particles, 3])?;
    }
    if request.records("velocity") {
        set("velocity", output.columns.velocity, &[copies, times, particles, 3])?;
    }
    for column in output.derived {
        let shape = [copies, times, column.width];
        set(&column.name, column.values, if column.width == 1 { &shape[..2] } else { &shape })?;
    }
    let dict = PyDict::new(py);
    dict.set_item("t", moved(py, request.times[..times].to_vec(), &[times])?)?;
    dict.set_item("columns", columns)?;
    dict.set_item("plan", plan_dict(py, &output.plan)?)?;
    let statuses: Vec<i8> = outcomes.iter().map(|outcome| status(&outcome.ending)).collect();
    dict.set_item("status", moved(py, statuses, &[copies])?)?;

    let (totals, each) = (PyDict::new(py), PyDict::new(py));
    type Count = fn(&Outcome) -> u64;
    let counts: [(&str, Count); 3] = [
        ("steps", |outcome| outcome.counts.steps),
        ("rejected", |outcome| outcome.counts.rejected),
        ("evaluations", |outcome| outcome.counts.evaluations),
    ];
    for (name, count) in counts {
        totals.set_item(name, outcomes.iter().map(count).sum::<u64>())?;
        each.set_item(name, moved(py, outcomes.iter().map(|o| count(o) as i64).collect(), &[copies])?)?;
    }
    totals.set_item("seconds", seconds)?;
    totals.set_item("threads", output.plan.threads.0.max(output.plan.threads.1))?;
    totals.set_item("simd", tier().name())?;
    totals.set_item("method", output.plan.method_name())?;
    dict.set_item("stats", totals)?;
    dict.set_item("per_trajectory", each)?;

    let flat = |of: fn(&Outcome) -> &Vec<[f64; 3]>| {
        let values: Vec<f64> =
            outcomes.iter().flat_map(|outcome| of(outcome).as_flattened()).copied().collect();
        moved(py, values, &[copies, particles, 3])
    };
    let last = PyDict::new(py);
    last.set_item(
        "t",
        moved(py, outcomes.iter().map(|outcome| outcome.time).collect::<Vec<f64>>(), &[copies])?,
    )?;
    last.set_item("position", flat(|outcome| &outcome.position)?)?;
    last.set_item("velocity", flat(|outcome| &outcome.velocity)?)?;
    dict.set_item("final", last)?;
    let error = if ensemble { None } else { failure(&outcomes[0]) };
    dict.set_item("error", error.map(|error| error_dict(py, &error)).transpose()?)?;
    Ok(dict)
}

/// An error of a single run, for Python to raise with what was computed.
fn error_dict<'py>(py: Python<'py>, error: &Error) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("message", error.to_string())?;
    match error {
        Error::CloseEncounter { time, bodies, distance } => {
            dict.set_item("kind", "close_encounter")?;
            dict.set_item("time", time)?;
            dict.set_item("bodies", bodies)?;
            dict.set_item("distance", distance)?;
        }
        Error::Interrupted => dict.set_item("kind", "interrupted")?,
        Error::Convergence { message, time } => {
            dict.set_item("kind", "convergence")?;
            dict.set_item("message", message)?;
            dict.set_item("time", time)?;
        }
        Error::InvalidInput { .. } | Error::Internal(_) => dict.set_item("kind", "internal")?,
    }
    Ok(dict)
}

/// Conserved quantities of recorded states.
#[pyfunction]
#[pyo3(signature = (*, mass, forces, position, velocity, about, columns))]
pub(crate) fn conserved<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    forces: Bound<'py, PyList>,
    position: Array<'py>,
    velocity: Option<Array<'py>>,
    about: Array<'py>,
    columns: Vec<String>,
) -> PyResult<Bound<'py, PyDict>> {
    let (mass, [particles]) = copied("mass", &mass, [None])?;
    let (position, [times, ..]) = copied("position", &position, [None, Some(particles), Some(3)])?;
    let velocity = match velocity {
        Some(velocity) => copied("velocity", &velocity, [Some(times), Some(particles), Some(3)])?.0,
        None => vec![0.0; position.len()],
    };
    let specs = self::forces(&forces)?;
    let about = points(&copied("about", &about, [Some(3)])?.0)[0];
    let (position, velocity) = (points(&position), points(&velocity));
    let values = compute(py, times as u64, None, |ticker| {
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
        for time in 0..times {
            let exact = |x: [f64; 3]| x.map(DoubleDouble::from);
            let bodies: Vec<Body> = (0..particles)
                .map(|i| Body {
                    mass: mass[i],
                    position: exact(position[time * particles + i]),
                    velocity: exact(velocity[time * particles + i]),
                })
                .collect();
            for (name, values) in columns.iter().zip(&mut values) {
                values.extend(conservation::column(name, &specs, &bodies, about)?);
            }
            ticker.tick()?;
        }
        Ok(values)
    })?
    .whole(py)?;
    let dict = PyDict::new(py);
    for (name, values) in columns.into_iter().zip(values) {
        let scalar = conservation::SCALARS.contains(&name.as_str());
        let shape = [times, 3];
        dict.set_item(name, moved(py, values, if scalar { &shape[..1] } else { &shape[..] })?)?;
    }
    Ok(dict)
}

/// The acceleration of every particle.
#[pyfunction]
#[pyo3(signature = (*, mass, forces, position, velocity))]
pub(crate) fn acceleration<'py>(
    py: Python<'py>,
    mass: Array<'py>,
    forces: Bound<'py, PyList>,
    position: Array<'py>,
    velocity: Array<'py>,
) -> PyResult<Bound<'py, numpy::PyArrayDyn<f64>>> {
    let scene = scene(&mass, &position, &velocity, &forces, 0.0, false)?;
    let threads = thread_count(None).map_err(|error| raised(py, error))?;
    let shape = [scene.particles, 3];
    let values = compute(py, 0, None, |ticker| acceleration_of(&scene, threads, ticker))?.whole(py)?;
    moved(py, values.into_iter().flatten().collect(), &shape)
}
