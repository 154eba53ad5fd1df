//! Runs of a model: one trajectory from a start to an end, by any method.
//!
//! The one idea: a run is that of [`ode::run`](crate::ode::run), with whatever takes its steps; outputs are read off steps and
//! never steer them. With constraints every kept step is put back on them ([`projection`]).

mod counted;

use super::discrete::{self, DiscreteStep};
use super::events::{Event, Found, Watch};
use super::exact::{self, ExactMotion};
use super::fixed::FixedSteps;
use super::gauss::{self, GaussStep, Steps};
use super::model::Model;
use super::motion::Motion;
use super::poles::Poles;
use super::projection::{Projected, Projector};
use super::sizes::sizes;
use super::sticking::Sticking;
use crate::error::{Error, Result};
use crate::expressions::{Machine, Series};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::ode::embedded::EmbeddedStep;
use crate::ode::events::Watch as Unwatched;
use crate::ode::norm::{Norm, RootMeanSquare};
use crate::ode::run::{Ending, Recorder, Times, run};
use crate::ode::state::State;
use crate::ode::step_control::{Controlled, Rule};
use crate::ode::system::{Form, System};
use crate::ode::table::Table;
use crate::ode::taylor::TaylorStep;
use crate::ode::trial::Trial;
use crate::ode::{Method, Scheme};
use crate::parallel::Ticker;
use counted::Counted;
use std::sync::Arc;

/// What takes the steps.
#[derive(Clone, Debug)]
pub enum Integrator {
    /// Collocation.
    Gauss(&'static gauss::Method),
    /// A discrete action.
    Discrete(Arc<discrete::Equations>),
    /// A method of the registry.
    Table(&'static Method),
    /// None: the motion is known at any time.
    Exact(Arc<dyn ExactMotion>),
}

/// What is asked of a run.
#[derive(Clone, Debug)]
pub struct Request {
    /// What takes the steps.
    pub integrator: Integrator,
    /// The start and the end, either the smaller.
    pub span: (f64, f64),
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance of each number, of methods that estimate their error; if not given, or no number, a
    /// thousandth of the relative one times its size in the motion.
    pub atol: Option<Vec<f64>>,
    /// The step, of methods without step control and of others that are to hold theirs.
    pub dt: Option<f64>,
    /// The longest step.
    pub max_step: Option<f64>,
    /// The most steps.
    pub max_steps: u64,
    /// Output times; the nodes if not given.
    pub outputs: Option<Vec<f64>>,
    /// Whether steps are held where energy is conserved.
    pub held: bool,
    /// What is looked for on the way.
    pub events: Vec<Event>,
    /// The equations as recurrences, if the method is made of them.
    pub series: Option<Arc<Series>>,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct Solution {
    /// How the run ended.
    pub ending: Ending,
    /// What ended it, if that was no end.
    pub failure: Option<String>,
    /// The time that it came to.
    pub reached: f64,
    /// Times.
    pub t: Vec<f64>,
    /// States there, one after another.
    pub y: Vec<f64>,
    /// The end of the last step that was kept, from where one may go on, …
    pub last_time: f64,
    /// … and the state there.
    pub last_state: Vec<f64>,
    /// Steps that were kept.
    pub steps: u64,
    /// Evaluations.
    pub evaluations: u64,
    /// The longest step.
    pub h: f64,
    /// What was found on the way; the last ended the run if it has [stopped](Ending::Stopped).
    pub found: Vec<Found>,
}

/// What errors are measured by, of so many numbers; of embedded methods absolute tolerances are still to be given.
pub(super) fn norm<S: Controlled>(request: &Request, numbers: usize) -> Norm<S> {
    let rtol = S::splat(request.rtol);
    if request.series.is_some() {
        return Norm::of_numbers(rtol);
    }
    Norm::root_mean_square(RootMeanSquare { atol: vec![S::zero(); numbers], rtol: vec![rtol; numbers] })
}

/// Absolute tolerances beside the relative one, as parts of it: what vanishes on the way is seldom asked for to all digits.
const ABSOLUTE: f64 = 1e-3;

impl Request {
    /// The absolute tolerances of a trajectory, if its method looks at them.
    pub(super) fn absolute_tolerances(
        &self,
        model: &Model,
        parameters: &[f64],
        y0: &[f64],
    ) -> Option<Vec<f64>> {
        let Integrator::Table(Method { scheme: Scheme::Embedded(_), .. }) = self.integrator else {
            return None;
        };
        let own = sizes(model, parameters, self.span, y0).into_iter().map(|size| ABSOLUTE * self.rtol * size);
        let Some(given) = &self.atol else { return Some(own.collect()) };
        Some(own.zip(given).map(|(own, &given)| if given.is_nan() { own } else { given }).collect())
    }
}

/// What ends a run that takes too many steps.
pub(super) fn too_many_steps(most: u64) -> String {
    format!("{most} steps do not reach the end; pass a larger max_steps")
}

/// Of equations that time enters, chosen steps are no longer than this part of the run: where nothing has begun yet, no method
/// can tell how long nothing will.
const LONGEST_WITH_TIME: f64 = 1.0 / 128.0;

impl Request {
    /// The longest step of a method that chooses its own.
    pub(super) fn longest_step(&self, model: &Model) -> f64 {
        let asked = self.max_step.unwrap_or(f64::INFINITY);
        let longest = (self.span.1 - self.span.0).abs() * LONGEST_WITH_TIME;
        if model.needs().time && longest < asked { longest } else { asked }
    }

    /// The steps of a collocation method.
    pub(super) fn gauss_steps(&self, method: &gauss::Method) -> Steps {
        self.dt.map_or_else(|| method.chosen(self.rtol, self.held), Steps::Equal)
    }

    /// The step of a method that has a fixed one, with the sign of time.
    pub(super) fn fixed_step(&self, method: &str) -> Result<f64> {
        let missing = || Error::invalid("dt", format!("{method} needs a step dt"));
        Ok(self.dt.ok_or_else(missing)?.copysign(self.span.1 - self.span.0))
    }
}

impl Solution {
    /// Of a run that has not begun.
    pub(super) fn at(t0: f64, y0: &[f64]) -> Self {
        Self {
            last_time: t0,
            last_state: y0.to_vec(),
            ending: Ending::Finished,
            failure: None,
            reached: t0,
            t: vec![],
            y: vec![],
            steps: 0,
            evaluations: 0,
            h: 0.0,
            found: vec![],
        }
    }
}

/// Runs a model from a state.
///
/// # Errors
/// A step that is missing or is not asked for; a method that does not take such equations.
pub fn solve(
    model: &Model,
    request: &Request,
    of: (&[f64], &[f64]),
    ticker: &mut Ticker<'_>,
) -> Result<Solution> {
    solve_within(model, request, of, request.longest_step(model), ticker)
}

/// How much shorter steps are where one went through a pole, and down to which part of the run.
const SHORTER: f64 = 1.0 / 16.0;
const SHORTEST_PART: f64 = 1.0 / 1_048_576.0;

/// In steps of at most that length, where the method chooses them; in shorter ones where one went through a pole.
fn solve_within(
    model: &Model,
    request: &Request,
    (y0, parameters): (&[f64], &[f64]),
    max_step: f64,
    ticker: &mut Ticker<'_>,
) -> Result<Solution> {
    let (t0, end) = request.span;
    let mut system = Motion::<f64>::of(model, request, parameters, t0);
    let mut state = match system.form() {
        Form::FirstOrder(_) => State::first_order(y0.to_vec()),
        Form::SecondOrder(n) => State::new(&y0[..n], &y0[n..]),
    };
    let mut norm = norm(request, y0.len());
    if let (Some(mean), Some(atol)) = (&mut norm.mean, request.absolute_tolerances(model, parameters, y0)) {
        mean.atol = atol;
    }
    let mut table = Table::new(request.outputs.as_deref(), false, None, Unwatched::new(vec![]));
    if t0 == end {
        table.still(request.span, y0)?;
        return Ok(Solution { reached: end, t: table.t, y: table.y, ..Solution::at(t0, y0) });
    }
    let watch = Watch::new(&request.events, parameters);
    let mut projector = model.projection.as_ref().map(|projection| {
        let projector = projection.at_work(parameters);
        if request.dt.is_some() { projector } else { projector.for_tolerance(request.rtol) }
    });
    let sticking = Sticking::new(model, parameters, t0);
    let poles = Poles::new(model, parameters, t0, y0);
    let most = request.max_steps;
    let mut recorder = Counted {
        table,
        watch,
        sticking,
        poles,
        passed: None,
        steps: 0,
        longest: 0.0,
        reached: t0,
        kept: t0,
        equal: request.dt,
        most,
        beyond: false,
    };
    let mut drive = Drive { system: &mut system, state: &mut state, norm: &norm, request, ticker };
    let mut own = 0;
    let outcome = match request.integrator {
        Integrator::Gauss(method) => {
            let lanes: Vec<Lanes> = parameters.iter().map(|&value| Lanes([value; WIDTH])).collect();
            let machine = Machine::new(model.code.clone(), &lanes);
            let steps = (request.gauss_steps(method), max_step);
            let trial =
                GaussStep::new(method, (machine, model.form, model.needs().velocity), drive.state, steps, t0);
            drive.with(trial, projector.take(), &mut recorder, |trial| own = trial.evaluations())
        }
        Integrator::Exact(ref motion) => {
            return exact::solve(&**motion, request, (y0, parameters), drive.ticker);
        }
        Integrator::Discrete(ref equations) => {
            let h = request.fixed_step(equations.name())?;
            let trial = DiscreteStep::new(equations, parameters, drive.state, (t0, h));
            // It keeps its constraints itself.
            drive.with(trial, None, &mut recorder, |trial| own = trial.evaluations())
        }
        Integrator::Table(method) => match &method.scheme {
            Scheme::Embedded(tableau) => {
                if request.dt.is_some() {
                    return Err(Error::invalid(
                        "dt",
                        format!("{} chooses its own steps; leave dt out", method.name),
                    ));
                }
                let rule = Rule::new(tableau.error_exponent, max_step);
                let trial = EmbeddedStep::with_rule(tableau, drive.system, drive.state, rule);
                drive.with(trial, projector.take(), &mut recorder, |_| {})
            }
            Scheme::Taylor(orders) => {
                let trial = TaylorStep::new(*orders, drive.system, drive.state, max_step);
                drive.with(trial, projector.take(), &mut recorder, |_| {})
            }
            _ => {
                let h = request.fixed_step(method.name)?;
                let trial = FixedSteps::new(method, h, drive.system, drive.state)?;
                drive.with(trial, projector.take(), &mut recorder, |_| {})
            }
        },
    };
    if let (Some(h), None) = (recorder.passed, request.dt)
        && h * SHORTER > (end - t0).abs() * SHORTEST_PART
    {
        return solve_within(model, request, (y0, parameters), h * SHORTER, ticker);
    }
    let (ending, failure) = match outcome {
        Ok(Ending::StepTooSmall) => {
            let sticks = recorder.sticking.explains(recorder.kept, state.all().0);
            (Ending::StepTooSmall, sticks.or_else(|| Ending::StepTooSmall.reason()))
        }
        Ok(ending) => (ending, ending.reason()),
        Err(Error::Convergence { message, .. }) => {
            let ending = if recorder.beyond { Ending::TooManySteps } else { Ending::StepTooSmall };
            (ending, Some(message))
        }
        Err(error) => return Err(error),
    };
    let Counted { table, watch, steps, longest, reached, kept, .. } = recorder;
    let Table { t, y, .. } = table;
    Ok(Solution {
        ending,
        failure,
        reached,
        t,
        y,
        last_time: kept,
        last_state: state.all().0.to_vec(),
        steps,
        evaluations: system.evaluations() + own,
        h: longest,
        found: watch.found,
    })
}

/// What a run is driven with, whatever takes its steps.
struct Drive<'a, 'b, 'c> {
    system: &'a mut Motion<f64>,
    state: &'a mut State<f64>,
    norm: &'a Norm<f64>,
    request: &'a Request,
    ticker: &'b mut Ticker<'c>,
}

impl Drive<'_, '_, '_> {
    /// Runs, on the constraints if there are any, and shows what took the steps.
    fn with<T: Trial<f64>>(
        &mut self,
        mut trial: T,
        projector: Option<Projector>,
        recorder: &mut dyn Recorder,
        mut seen: impl FnMut(&T),
    ) -> Result<Ending> {
        let times = Times { span: self.request.span, first_step: None, nodes_are_numbers: false };
        let Some(projector) = projector else {
            let ending = run(&mut trial, self.system, self.state, self.norm, times, recorder, self.ticker);
            seen(&trial);
            return ending;
        };
        let mut trial = Projected::new(trial, projector, self.state, self.request.span.0);
        let ending = run(&mut trial, self.system, self.state, self.norm, times, recorder, self.ticker);
        seen(&trial.inner);
        ending
    }
}
