//! What a run gave, as the dictionaries that are described in `visviva/_core.pyi`.

use crate::arrays::{moved, moved_column};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use visviva_core::Error;
use visviva_core::narrow::UNSEEN;
use visviva_core::numerics::simd::tier;
use visviva_core::scene::Scene;
use visviva_core::scene::collisions::{Collision, Table};
use visviva_core::scene::columns::Derived;
use visviva_core::scene::continuation::FORM;
use visviva_core::scene::integrate::{Ending, Unresolved};
use visviva_core::scene::plan::{Plan, TooLong};
use visviva_core::scene::request::Request;
use visviva_core::scene::run::{Kept, Outcome, Output};

/// The plan that was carried out, for whoever asks: to tell it takes as long as a short run.
#[pyclass(frozen, module = "visviva._core")]
pub(crate) struct Planned(Plan);

#[pymethods]
impl Planned {
    /// What was done.
    fn told<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        plan_dict(py, &self.0)
    }
}

/// What will be done.
pub(super) fn plan_dict<'py>(py: Python<'py>, plan: &Plan) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let rows = plan.rows();
    let integration = plan.solutions.integrates();
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

/// What was done. A single run that failed keeps the rows it has.
pub(super) fn output_dict<'py>(
    py: Python<'py>,
    scene: &Scene,
    request: Request,
    mut output: Output,
    seconds: f64,
    ensemble: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let (copies, particles) = (scene.copies, scene.particles);
    let times = if ensemble {
        request.times.len()
    } else {
        output.outcomes.first().map_or(0, |outcome| outcome.rows)
    };
    if ensemble {
        output.columns.finish(&output.missing);
    }
    let columns = PyDict::new(py);
    let set = |name: &str, mut values: Vec<f64>, shape: &[usize]| {
        values.truncate(shape.iter().product());
        columns.set_item(name, moved_column(py, values, shape)?)
    };
    if request.records("position") {
        set("position", output.columns.position, &[copies, times, particles, 3])?;
    }
    if request.records("velocity") {
        set("velocity", output.columns.velocity, &[copies, times, particles, 3])?;
    }
    let rigid = output.columns.rigid;
    if rigid > 0 && request.records("orientation") {
        set("orientation", output.columns.orientation, &[copies, times, rigid, 4])?;
    }
    if rigid > 0 && request.records("angular_velocity") {
        set("angular_velocity", output.columns.angular_velocity, &[copies, times, rigid, 3])?;
    }
    for Derived { column, values } in output.columns.derived {
        let shape: &[usize] =
            if column.width == 1 { &[copies, times] } else { &[copies, times, column.width] };
        set(column.name, values, shape)?;
    }
    let dict = PyDict::new(py);
    let outcomes = &output.outcomes;
    let looked_for = !request.events.is_empty();
    // Of a run that goes on with another, that of both.
    let span = request.times.last().map_or(0.0, |end| (end - output.plan.t0).abs());
    let mut reached = request.times;
    reached.truncate(times);
    dict.set_item("t", moved(py, reached, &[times])?)?;
    dict.set_item("columns", columns)?;
    let statuses: Vec<i8> = outcomes.iter().map(|outcome| status(&outcome.ending)).collect();
    dict.set_item("status", moved(py, statuses, &[copies])?)?;

    if looked_for {
        let found = &output.events;
        let events = PyDict::new(py);
        let shape = [found.len(), particles, 3];
        let whole = |of: fn((usize, usize, f64)) -> usize| {
            moved(py, found.lines().map(|line| of(line) as i64).collect::<Vec<i64>>(), &shape[..1])
        };
        events.set_item("member", whole(|line| line.0)?)?;
        events.set_item("which", whole(|line| line.1)?)?;
        events
            .set_item("t", moved(py, found.lines().map(|line| line.2).collect::<Vec<f64>>(), &shape[..1])?)?;
        events.set_item("position", moved(py, found.states(0, particles), &shape)?)?;
        events.set_item("velocity", moved(py, found.states(1, particles), &shape)?)?;
        dict.set_item("events", events)?;
    }

    let last = PyDict::new(py);
    if let Some(collided) = output.collisions {
        dict.set_item("collisions", collisions_dict(py, &collided.table)?)?;
        last.set_item("mass", moved(py, collided.mass, &[copies, particles])?)?;
        if !collided.radius.is_empty() {
            last.set_item("radius", moved(py, collided.radius, &[copies, particles])?)?;
        }
        if let Some(begun) = collided.begun {
            let shape = [copies, particles, 3];
            last.set_item("begun_position", moved(py, begun.position.into_flattened(), &shape)?)?;
            last.set_item("begun_velocity", moved(py, begun.velocity.into_flattened(), &shape)?)?;
        }
    }

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

    let flat = |points: Vec<[f64; 3]>| moved(py, points.into_flattened(), &[copies, particles, 3]);
    last.set_item(
        "t",
        moved(py, outcomes.iter().map(|outcome| outcome.time).collect::<Vec<f64>>(), &[copies])?,
    )?;
    last.set_item("position", flat(output.reached.position)?)?;
    last.set_item("velocity", flat(output.reached.velocity)?)?;
    let rigid = output.plan.rigid;
    if rigid > 0 {
        let orientation = output.reached.orientation.into_flattened();
        last.set_item("orientation", moved(py, orientation, &[copies, rigid, 4])?)?;
        let spin = output.reached.angular_velocity.into_flattened();
        last.set_item("angular_velocity", moved(py, spin, &[copies, rigid, 3])?)?;
    }
    if let Some(Kept { nodes, t0, held }) = output.kept
        && nodes.iter().any(|&node| on_a_node(node))
    {
        // What is the same for all copies, and what each has of its own.
        let kept = PyDict::new(py);
        kept.set_item("form", FORM)?;
        kept.set_item("method", output.plan.method.name)?;
        kept.set_item("dt", output.plan.dt)?;
        kept.set_item("t0", t0)?;
        kept.set_item("goes_on", output.plan.from > 0)?;
        dict.set_item("continuation", kept)?;
        let shape = [copies, held.blocks, held.slots, 3];
        last.set_item("held", moved(py, held.numbers, &shape)?)?;
        let nodes = nodes.into_iter().map(|node| if on_a_node(node) { node as i64 } else { 0 });
        last.set_item("node", moved(py, nodes.collect::<Vec<i64>>(), &[copies])?)?;
    }
    dict.set_item("final", last)?;
    if let Some(dt) = output.plan.dt {
        let step = dt.abs();
        if span > 0.0 && span < step {
            dict.set_item("dt_beyond", (step, span))?;
        }
    }
    if let Some(turn @ TooLong { copy, body, steps, fewest, at_pericenter, .. }) = &output.plan.too_long {
        dict.set_item("too_long", (copy, (body, turn.place()), steps, fewest, at_pericenter))?;
    }
    let worst =
        outcomes.iter().map(|outcome| outcome.energy_error).enumerate().filter(|(_, error)| !error.is_nan());
    if let Some((copy, error)) = worst.max_by(|a, b| a.1.total_cmp(&b.1)) {
        let step = output.plan.dt.or(output.plan.transformed.map(|(_, dt)| dt)).map(f64::abs);
        dict.set_item("energy_error", (copy, error, step, output.plan.method.order))?;
    }
    let doubts = outcomes.iter().enumerate().filter_map(|(copy, outcome)| Some((copy, outcome.unresolved?)));
    if let (Some((copy, Unresolved { body, error, by })), Some(dt)) =
        (doubts.max_by(|a, b| a.1.error.total_cmp(&b.1.error)), output.plan.dt)
    {
        let velocity = format!("the velocity of body {body}");
        dict.set_item("unresolved", (copy, velocity, error, by.name(), dt.abs(), output.plan.method.order))?;
    }
    // Steps that are chosen for rigid bodies end where no two lengths of them agree.
    let chosen = output.plan.turning.steps() && output.plan.tolerance.is_some();
    let error = outcomes.first().filter(|_| !ensemble).and_then(|outcome| failure(outcome, chosen));
    dict.set_item("error", error.map(|error| error_dict(py, &error)).transpose()?)?;
    dict.set_item("plan", Planned(output.plan))?;
    Ok(dict)
}

/// The collisions, column by column.
fn collisions_dict<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let lines = &table.lines;
    let shape = [lines.len(), 3];
    let numbers = |of: fn(&Collision) -> f64| moved(py, lines.iter().map(of).collect(), &shape[..1]);
    let whole = |of: fn(&Collision) -> i64| moved(py, lines.iter().map(of).collect(), &shape[..1]);
    let dict = PyDict::new(py);
    dict.set_item("t", numbers(|line| line.t)?)?;
    dict.set_item("first", whole(|line| line.bodies.0 as i64)?)?;
    dict.set_item("second", whole(|line| line.bodies.1 as i64)?)?;
    dict.set_item("speed", numbers(|line| line.speed)?)?;
    dict.set_item("position", moved(py, lines.iter().flat_map(|line| line.position).collect(), &shape)?)?;
    dict.set_item("energy_lost", numbers(|line| line.energy_lost)?)?;
    dict.set_item("survivor", whole(|line| line.survivor.map_or(-1, |body| body as i64))?)?;
    dict.set_item("member", whole(|line| line.copy as i64)?)?;
    Ok(dict)
}

/// Whether a copy came to a node other than the first.
fn on_a_node(node: u64) -> bool {
    node > 0 && node < u64::MAX
}

pub(super) fn status(ending: &Ending) -> i8 {
    match ending {
        Ending::Finished => 0,
        Ending::CloseEncounter { .. } => 1,
        Ending::NoStep
        | Ending::NotFinite
        | Ending::PassedOver
        | Ending::Undefined { .. }
        | Ending::Sticking { .. }
        | Ending::Endless => 2,
        Ending::Interrupted => 3,
        Ending::TooManySteps => 4,
        Ending::Stopped => 5,
        Ending::OutsideDomain => 6,
        Ending::Resting { .. } | Ending::Squeezed { .. } => 7,
    }
}

/// What an ending means, as the error that a single run raises; whether its steps were `chosen` for bodies that torques turn.
fn failure(outcome: &Outcome, chosen: bool) -> Option<Error> {
    let time = outcome.time;
    match &outcome.ending {
        Ending::Finished | Ending::Stopped => None,
        Ending::CloseEncounter { bodies, distance } => {
            Some(Error::CloseEncounter { time, bodies: *bodies, distance: *distance })
        }
        Ending::NoStep => Some(Error::Convergence {
            message: "the step size fell to zero, and no bodies are close: the tolerances ask for more than a step can \
                      give (raise rtol or atol), or allow steps so long that forces on the way are beyond float64 (lower \
                      them, or set max_step); or the motion goes to infinity there (end the run before); under a time \
                      transformation, that dt is too long"
                .to_owned(),
            time,
        }),
        Ending::Undefined { body } => Some(Error::Convergence {
            message: format!(
                "a formula has no number for the force on body {body} where it is: it is a root or a logarithm of what is \
                 negative there, or 0/0, or beyond float64 (start elsewhere, end the run before it, or write what holds there)"
            ),
            time,
        }),
        Ending::Sticking { body } => Some(Error::Convergence {
            message: format!(
                "the velocity of body {body} sticks at zero: on both sides of it a force, as of dry friction, points back, \
                 and no step gets past that. It stays there while the other forces are weaker, which the force does not \
                 tell; end the run before (an event of the velocity), or write v·tanh(|v|/width)/|v| for v/|v|"
            ),
            time,
        }),
        Ending::Endless => Some(Error::Convergence {
            message: "the rigid bodies turn so fast that the run would take more than 1e9 steps; a larger rtol, a shorter \
                      run, or a step dt or a method of your own may pass"
                .to_owned(),
            time,
        }),
        Ending::PassedOver => Some(Error::Convergence { message: UNSEEN.to_owned(), time }),
        Ending::NotFinite if chosen => Some(Error::Convergence {
            message: "steps that turn the rigid bodies were made ever smaller and did not agree to rtol; a larger rtol, a \
                      shorter run, or a step dt of your own may pass"
                .to_owned(),
            time,
        }),
        Ending::NotFinite => Some(Error::Convergence {
            message: "after the last output the state became infinite or undefined: the motion itself goes to infinity, or \
                      a step came where a formula has no number, such as exactly on the corner of an absolute value (end \
                      the run before, or start or step a little otherwise); or a smaller step, a softening or an adaptive \
                      method may pass"
                .to_owned(),
            time,
        }),
        Ending::OutsideDomain => Some(Error::Convergence {
            message: "bodies came to a distance, or to a speed, at which a force of the scene is not known: it is a table \
                      that ends there, or a law (give it more points, or end the run before it)"
                .to_owned(),
            time,
        }),
        Ending::Resting { bodies: (i, j) } => Some(Error::Convergence {
            message: format!(
                "bodies {i} and {j} came to rest on each other: spheres that bounce know no lasting contact (end the run \
                 before it, or let a soft repulsion hold them apart)"
            ),
            time,
        }),
        Ending::Squeezed { bodies: (i, j) } => Some(Error::Convergence {
            message: format!(
                "bodies {i} and {j}, one of which the other does not feel, met ever faster, ever sooner: between spheres \
                 that come together it bounces infinitely often before they meet (end the run before it, or give the \
                 light one a mass that turns them back)"
            ),
            time,
        }),
        Ending::TooManySteps => {
            Some(Error::Convergence { message: "max_steps were taken before the end".to_owned(), time })
        }
        Ending::Interrupted => Some(Error::Interrupted),
    }
}

/// An error of a single run, for Python to raise with what was computed.
pub(super) fn error_dict<'py>(py: Python<'py>, error: &Error) -> PyResult<Bound<'py, PyDict>> {
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
