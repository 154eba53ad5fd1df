//! What is asked of a run, and what came of it.

use super::events::Sought;
use super::{Array, GeneralizedModel};
use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::{compute, is_ctrl_c};
use crate::scene::events::Raised;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use visviva_core::generalized::abreast::{solve_together, together};
use visviva_core::generalized::run::{Integrator, Request, Solution, solve};
use visviva_core::generalized::{discrete, gauss};
use visviva_core::memory::check;
use visviva_core::numerics::lanes::WIDTH;
use visviva_core::ode::run::Ending;
use visviva_core::ode::{Method, Scheme};
use visviva_core::parallel::{for_chunks, thread_count};
use visviva_core::{Error, Result, registry};

/// The method that takes no steps.
const LINEAR: &str = "matrix_exponential";
const PENDULUM: &str = "elliptic_functions";

/// What is asked of a run.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Asked<'py> {
    method: String,
    span: (f64, f64),
    rtol: f64,
    atol: Option<Vec<f64>>,
    dt: Option<f64>,
    max_step: Option<f64>,
    max_steps: u64,
    outputs: Option<Array<'py>>,
    events: Vec<Sought>,
}

impl Asked<'_> {
    /// What takes the steps, by its name.
    fn integrator(&self, of: &GeneralizedModel) -> Result<Integrator> {
        let name = &self.method;
        if let Some(method) = gauss::method(name) {
            return Ok(Integrator::Gauss(method));
        }
        if let Some(method) = discrete::method(name) {
            return Ok(Integrator::Discrete(Arc::new(discrete::Equations::new(&of.model, method)?)));
        }
        if name == LINEAR {
            let linear =
                of.linear.clone().ok_or_else(|| Error::invalid("method", "the equations are not linear"));
            return Ok(Integrator::Exact(linear?));
        }
        if name == PENDULUM {
            let pendulum = of.pendulum.clone();
            return Ok(Integrator::Exact(
                pendulum.ok_or_else(|| Error::invalid("method", "the equation is not that of a pendulum"))?,
            ));
        }
        let method = registry::method(name);
        method.map(Integrator::Table).ok_or_else(|| Error::invalid("method", format!("no method {name}")))
    }

    fn request(&self, py: Python<'_>, of: &GeneralizedModel, exceptions: &Raised) -> PyResult<Request> {
        let integrator = self.integrator(of).map_err(|error| raised(py, error))?;
        let outputs = self.outputs.as_ref().map(|t| PyResult::Ok(copied("t", t, [None])?.0)).transpose()?;
        let events = self.events.iter().map(|event| event.event(py, of, exceptions));
        let events = events.collect::<Result<_>>().map_err(|error| raised(py, error))?;
        let series = matches!(integrator, Integrator::Table(Method { scheme: Scheme::Taylor(_), .. }));
        let series = series.then(|| of.model.series()).transpose().map_err(|error| raised(py, error))?;
        Ok(Request {
            events,
            series,
            integrator,
            span: self.span,
            rtol: self.rtol,
            atol: self.atol.clone(),
            dt: self.dt,
            max_step: self.max_step,
            max_steps: self.max_steps,
            outputs,
            held: of.structure.holds_steps,
        })
    }
}

/// Solutions as columns, member after member.
fn collected<'py>(py: Python<'py>, solutions: &[Solution], numbers: usize) -> PyResult<Bound<'py, PyDict>> {
    let result = PyDict::new(py);
    let lengths: Vec<usize> = solutions.iter().map(|solution| solution.t.len()).collect();
    let t: Vec<f64> = solutions.iter().flat_map(|solution| solution.t.iter().copied()).collect();
    let y: Vec<f64> = solutions.iter().flat_map(|solution| solution.y.iter().copied()).collect();
    let rows = t.len();
    let lines = || solutions.iter().flat_map(|solution| &solution.found);
    let found: Vec<usize> = solutions.iter().map(|solution| solution.found.len()).collect();
    let which: Vec<usize> = lines().map(|line| line.which).collect();
    let at: Vec<f64> = lines().map(|line| line.t).collect();
    let there: Vec<f64> = lines().flat_map(|line| line.y.iter().copied()).collect();
    let count = at.len();
    result.set_item("found", found)?;
    result.set_item("found_which", which)?;
    result.set_item("found_t", moved(py, at, &[count])?)?;
    result.set_item("found_y", moved(py, there, &[count, numbers])?)?;
    result.set_item("lengths", lengths)?;
    result.set_item("t", moved(py, t, &[rows])?)?;
    result.set_item("y", moved(py, y, &[rows, numbers])?)?;
    let endings: Vec<&str> = solutions
        .iter()
        .map(|solution| match solution.ending {
            Ending::Finished => "finished",
            Ending::Stopped => "stopped",
            Ending::StepTooSmall => "step too small",
            Ending::NotFinite => "not finite",
            Ending::TooManySteps => "too many steps",
            Ending::Interrupted => "interrupted",
        })
        .collect();
    result.set_item("endings", endings)?;
    let failures: Vec<Option<&str>> = solutions.iter().map(|solution| solution.failure.as_deref()).collect();
    result.set_item("failures", failures)?;
    result.set_item("reached", solutions.iter().map(|solution| solution.reached).collect::<Vec<_>>())?;
    let last: Vec<f64> = solutions.iter().flat_map(|solution| solution.last_state.iter().copied()).collect();
    result.set_item("last_y", moved(py, last, &[solutions.len(), numbers])?)?;
    result.set_item("last_t", solutions.iter().map(|solution| solution.last_time).collect::<Vec<_>>())?;
    result.set_item("steps", solutions.iter().map(|solution| solution.steps).collect::<Vec<_>>())?;
    result
        .set_item("evaluations", solutions.iter().map(|solution| solution.evaluations).collect::<Vec<_>>())?;
    result.set_item("longest_step", solutions.iter().map(|solution| solution.h).collect::<Vec<_>>())?;
    Ok(result)
}

/// Runs states (B, 2n) with parameters (B, p) from a time to another.
pub(super) fn run<'py>(
    py: Python<'py>,
    of: &GeneralizedModel,
    asked: &Asked<'py>,
    (states, parameters): (&Array<'py>, &Array<'py>),
    threads: Option<i64>,
    progress: Option<&Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let model = &*of.model;
    let (states, [members, _]) = copied("states", states, [None, Some(model.numbers())])?;
    let (parameters, _) = copied("parameters", parameters, [Some(members), Some(model.source.parameters)])?;
    let exceptions = Raised::default();
    let request = asked.request(py, of, &exceptions)?;
    check_memory(&request, members, model.numbers()).map_err(|error| raised(py, error))?;
    let threads = thread_count(threads).map_err(|error| raised(py, error))?;
    // A function of Python is called on the thread of the run.
    let threads = if asked.events.iter().any(Sought::calls) { 1 } else { threads };
    let (numbers, count) = (model.numbers(), model.source.parameters);
    let several = if together(model, &request) { abreast(members, threads) } else { 1 };
    let worked = compute(py, members as u64, progress, |ticker| {
        if members == 1 {
            ticker.control().count_whole(SHARES);
        }
        for_chunks(threads, members.div_ceil(several), ticker, |chunk, ticker| {
            let last = (chunk * several + several).min(members);
            let own_of = |all: &[f64], width: usize| {
                let own = all.get(chunk * several * width..last * width);
                own.map(<[f64]>::to_vec).unwrap_or_default()
            };
            let (states, own) = (own_of(&states, numbers), own_of(&parameters, count));
            if several > 1 {
                return solve_together(model, &request, (&states, &own), ticker);
            }
            let outcome = solve(model, &request, (&states, &own), ticker);
            ticker.advance(1);
            if outcome.as_ref().is_ok_and(|solution| solution.ending == Ending::Finished) {
                ticker.reach(1.0);
            }
            Ok(vec![outcome?])
        })
    })?;
    let (solutions, mut interrupted) = worked.partial(py)?;
    if let Some(exception) = exceptions.take() {
        if !is_ctrl_c(py, &exception) {
            return Err(exception);
        }
        interrupted = true;
    }
    let solutions = solutions.concat();
    let result = collected(py, &solutions, numbers)?;
    result.set_item("interrupted", interrupted)?;
    Ok(result)
}

/// Refuses what there is no memory for: each copy's rows, and the columns of all of them.
fn check_memory(request: &Request, members: usize, numbers: usize) -> Result<()> {
    let times = request.outputs.as_ref().map_or(0, Vec::len);
    let bytes =
        times.checked_mul(members).and_then(|rows| rows.checked_mul(2 * (numbers + 1) * size_of::<f64>()));
    let what = format!("{times} times of states of {numbers} numbers in {members} copies");
    check("t", &what, bytes, "ask for fewer times, or run fewer copies at a time")
}

/// Into how many parts of its time the progress of a single run is counted.
const SHARES: u64 = 10_000;

/// The most copies that are run side by side: lanes are taken up by those that wait.
const ABREAST: usize = 64;

/// How many copies are run side by side: all threads have as much to do, and eight lanes.
fn abreast(members: usize, threads: usize) -> usize {
    if members == 1 { 1 } else { members.div_ceil(threads).next_multiple_of(WIDTH).min(ABREAST) }
}
