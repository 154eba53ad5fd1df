//! Initial value problems `y' = f(t, y)` of any function: what is asked, what is refused, and the solution.
//!
//! The one idea: a function becomes a [`System`] here and nothing else does, so every explicit method of the registry that
//! takes systems of the first order takes it. Norm, first step and limits of the steps are those of SciPy's `solve_ivp`, so
//! that the same tolerances lead to about the same steps.

use super::embedded::EmbeddedStep;
use super::equal_steps::EqualSteps;
use super::events::{Condition, Events, Watch, Zeros};
use super::extension::Extension;
use super::norm::{Norm, RootMeanSquare};
use super::run::{Ending, Times, run};
use super::state::State;
use super::step_control::Rule;
use super::system::{Form, System};
use super::table::Table;
use super::{Method, Scheme};
use crate::error::{Error, Result};
use crate::parallel::Ticker;
use crate::words::number;

/// The least and the most that a step is multiplied with.
const LIMITS: (f64, f64) = (0.2, 10.0);

/// A function `f(t, y)` that writes the rates.
pub trait Function: FnMut(f64, &[f64], &mut [f64]) -> Result<()> + Send {}
impl<F: FnMut(f64, &[f64], &mut [f64]) -> Result<()> + Send> Function for F {}

/// What is asked of a problem.
#[derive(Clone, Debug)]
pub struct Request {
    /// One that takes systems of the first order.
    pub method: &'static Method,
    /// The start and the end, either the smaller.
    pub span: (f64, f64),
    /// The state at the start.
    pub y0: Vec<f64>,
    /// Relative tolerance, one or one of each number; `None` is 1e-3.
    pub rtol: Option<Vec<f64>>,
    /// Absolute tolerance, likewise; `None` is 1e-6.
    pub atol: Option<Vec<f64>>,
    /// The first step; chosen if not given.
    pub first_step: Option<f64>,
    /// The longest step; as long as it likes if not given.
    pub max_step: Option<f64>,
    /// The step of a method without step control.
    pub dt: Option<f64>,
    /// Output times; the nodes if not given.
    pub outputs: Option<Vec<f64>>,
    /// Whether the solution between the nodes is kept.
    pub dense: bool,
    /// When the zeros of each event function count.
    pub conditions: Vec<Condition>,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct Solution {
    /// How the run ended.
    pub ending: Ending,
    /// Times.
    pub t: Vec<f64>,
    /// States there, one after another.
    pub y: Vec<f64>,
    /// The solution between the nodes.
    pub extension: Option<Extension>,
    /// The zeros of each event function.
    pub zeros: Vec<Zeros>,
    /// Evaluations of the function.
    pub evaluations: u64,
}

/// A function as a system; it is never asked for a time outside the span.
struct Equations<'a, F> {
    function: &'a mut F,
    numbers: usize,
    t0: f64,
    /// The smaller and the larger end of the span.
    ends: (f64, f64),
    evaluations: u64,
}

impl<F: Function> System<f64> for Equations<'_, F> {
    fn form(&self) -> Form {
        Form::FirstOrder(self.numbers)
    }

    fn evaluations(&self) -> u64 {
        self.evaluations
    }

    fn rate(&mut self, t: &f64, y: &[f64], rate: &mut [f64], _: &mut Ticker<'_>) -> Result<()> {
        self.evaluations += 1;
        let (first, last) = self.ends;
        let t = self.t0 + *t;
        let t = if t < first { first } else { t };
        let t = if t > last { last } else { t };
        (self.function)(t, y, rate)
    }
}

/// A method at work, by its own type: a run is compiled for each.
enum Work {
    Embedded(Box<EmbeddedStep<f64>>),
    Equal(Box<EqualSteps<f64>>),
}

impl Request {
    fn direction(&self) -> f64 {
        if self.span.1 < self.span.0 { -1.0 } else { 1.0 }
    }

    /// The tolerances of each number.
    fn tolerances(&self) -> Result<RootMeanSquare<f64>> {
        let each = |name: &str, given: &Option<Vec<f64>>, usual: f64| {
            let values = given.clone().unwrap_or_else(|| vec![usual]);
            if let Some(bad) = values.iter().find(|x| x.is_nan() || **x < 0.0) {
                let message = format!("expected tolerances that are not negative, got {}", number(*bad));
                return Err(Error::invalid(name, message));
            }
            match values.len() {
                1 => Ok(vec![values[0]; self.y0.len()]),
                length if length == self.y0.len() => Ok(values),
                length => Err(Error::invalid(
                    name,
                    format!("expected one number or {} as in y0, got {length}", self.y0.len()),
                )),
            }
        };
        Ok(RootMeanSquare { atol: each("atol", &self.atol, 1e-6)?, rtol: each("rtol", &self.rtol, 1e-3)? })
    }

    fn check(&self) -> Result<()> {
        let (t0, end) = self.span;
        if !t0.is_finite() || end.is_nan() {
            return Err(Error::invalid(
                "t_span",
                format!("expected a finite start and an end, got ({}, {})", number(t0), number(end)),
            ));
        }
        if self.y0.iter().any(|y| !y.is_finite()) {
            return Err(Error::invalid("y0", "All components of the initial state `y0` must be finite."));
        }
        let positive = [("first_step", self.first_step), ("max_step", self.max_step), ("dt", self.dt)];
        for (name, value) in positive {
            if let Some(value) = value
                && (value.is_nan() || value <= 0.0)
            {
                return Err(Error::invalid(
                    name,
                    format!("expected a positive number, got {}", number(value)),
                ));
            }
        }
        if let Some(step) = self.first_step
            && step > (end - t0).abs()
        {
            return Err(Error::invalid(
                "first_step",
                format!(
                    "expected at most {} as t_span is long, got {}",
                    number((end - t0).abs()),
                    number(step)
                ),
            ));
        }
        let direction = self.direction();
        let outputs = self.outputs.as_deref().unwrap_or(&[]);
        if let Some(bad) =
            outputs.iter().find(|&&t| !(direction * (t - t0) >= 0.0 && direction * (end - t) >= 0.0))
        {
            return Err(Error::invalid(
                "t_eval",
                format!(
                    "expected times within t_span = ({}, {}), got {}",
                    number(t0),
                    number(end),
                    number(*bad)
                ),
            ));
        }
        // All of them are numbers: they lie within the span.
        if let Some(pair) = outputs.windows(2).find(|pair| direction * (pair[1] - pair[0]) <= 0.0) {
            return Err(Error::invalid(
                "t_eval",
                format!(
                    "expected times in the order of t_span, got {} before {}",
                    number(pair[0]),
                    number(pair[1])
                ),
            ));
        }
        Ok(())
    }

    /// The method at work.
    fn trial(&self, system: &dyn System<f64>, state: &State<f64>) -> Result<Work> {
        let method = self.method;
        let refused = |name: &str, why: String| Err(Error::invalid(name, why));
        match &method.scheme {
            Scheme::Embedded(table) => {
                if self.dt.is_some() {
                    return refused(
                        "dt",
                        format!("{} chooses its own steps; leave dt out, or set max_step", method.name),
                    );
                }
                let max_step = self.max_step.unwrap_or(f64::INFINITY);
                let mut rule = Rule::new(table.error_exponent, max_step);
                rule.limits = LIMITS;
                Ok(Work::Embedded(Box::new(EmbeddedStep::with_rule(table, system, state, rule))))
            }
            Scheme::RungeKutta(tableau) => {
                let given = [
                    ("rtol", self.rtol.is_some()),
                    ("atol", self.atol.is_some()),
                    ("first_step", self.first_step.is_some()),
                    ("max_step", self.max_step.is_some()),
                ];
                if let Some((name, _)) = given.iter().find(|(_, given)| *given) {
                    return refused(name, format!("{} has a fixed step, dt; leave {name} out", method.name));
                }
                let Some(dt) = self.dt else {
                    return refused(
                        "dt",
                        format!("expected a step, as {} has a fixed one; pass dt", method.name),
                    );
                };
                let (t0, end) = self.span;
                let farthest = if end.is_finite() && end.abs() > t0.abs() { end } else { t0 };
                if farthest + dt == farthest {
                    return refused(
                        "dt",
                        format!(
                            "expected a step that moves the time, got {} at {}",
                            number(dt),
                            number(farthest)
                        ),
                    );
                }
                Ok(Work::Equal(Box::new(EqualSteps::new(tableau, self.direction() * dt, system, state))))
            }
            Scheme::Splitting(_)
            | Scheme::NystromSplitting(_)
            | Scheme::Boris(_)
            | Scheme::Multistep(_)
            | Scheme::Taylor(_) => {
                refused("method", format!("{} takes no equations y' = f(t, y)", method.name))
            }
        }
    }
}

/// Solves a problem. A run that was interrupted, by the ticker or by [`Error::Interrupted`] of a function, gives what it has.
///
/// # Errors
/// What was asked is refused; errors of the functions but [`Error::Interrupted`].
pub fn solve<'a>(
    request: &'a Request,
    function: &mut impl Function,
    events: Option<&'a mut dyn Events>,
    ticker: &mut Ticker<'_>,
) -> Result<Solution> {
    request.check()?;
    let (t0, end) = request.span;
    let ends = if end < t0 { (end, t0) } else { (t0, end) };
    let mut system = Equations { function, numbers: request.y0.len(), t0, ends, evaluations: 0 };
    let mut state = State::first_order(request.y0.clone());
    let mut trial = request.trial(&system, &state)?;
    let norm = Norm::root_mean_square(request.tolerances()?);
    let watch = Watch::new(request.conditions.clone());
    let mut table = Table::new(request.outputs.as_deref(), request.dense, events, watch);
    let ending = if t0 == end || request.y0.is_empty() {
        match table.still(request.span, &request.y0) {
            Err(Error::Interrupted) => Ending::Interrupted,
            outcome => outcome.map(|()| Ending::Finished)?,
        }
    } else {
        let times = |nodes_are_numbers: bool| Times {
            span: request.span,
            first_step: request.first_step,
            nodes_are_numbers,
        };
        match &mut trial {
            Work::Embedded(trial) => {
                run(&mut **trial, &mut system, &mut state, &norm, times(true), &mut table, ticker)?
            }
            Work::Equal(trial) => {
                run(&mut **trial, &mut system, &mut state, &norm, times(false), &mut table, ticker)?
            }
        }
    };
    let (t, y) = (core::mem::take(&mut table.t), core::mem::take(&mut table.y));
    let extension = table.extension.take();
    Ok(Solution { ending, t, y, extension, zeros: table.into_zeros(), evaluations: system.evaluations })
}

#[cfg(test)]
mod tests;
