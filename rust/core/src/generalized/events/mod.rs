//! Events of runs in generalized coordinates: functions of state and time whose zeros are located on the way of a run.
//!
//! The one idea: a step is asked for states inside it, which leaves no trace, so events change no bit of a run. Every step is
//! looked at in one place inside it; where value and rate there are not those of the cubic through its ends, or that cubic
//! comes near zero, the [`search`] goes on in its parts.
//!
//! Directions are those of increasing time, also in a run backwards. A zero at the start does not count.

mod cubic;
mod search;

use super::Model;
use super::sticking::along;
use crate::error::Result;
use crate::expressions::intervals::Intervals;
use crate::expressions::shape::Shape;
use crate::expressions::{Code, Id, Machine, narrow};
use core::fmt;
pub(super) use search::INSIDE;
use search::{Point, Search, rounding};
use std::sync::Arc;

/// A function of time and state that somebody else evaluates.
pub type Called = dyn Fn(f64, &[f64]) -> Result<f64> + Send + Sync;

/// What an event is a zero of.
#[derive(Clone)]
pub enum Function {
    /// An expression and its rate, as [`Model::along`] gives them, and the bounds of one in which something may hide.
    Expression(Arc<Code>, Option<Arc<Intervals>>),
    /// Of which no rate is known.
    Called(Arc<Called>),
}

impl fmt::Debug for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Expression(code, _) => f.debug_tuple("Expression").field(code).finish(),
            Self::Called(_) => f.write_str("Called"),
        }
    }
}

impl Function {
    /// An expression of a model's time and state.
    ///
    /// # Errors
    /// Expressions that are too large.
    pub fn of(model: &mut Model, expression: Id) -> Result<Self> {
        let code = Arc::new(model.along(expression)?);
        let graph = &model.source.graph;
        let hides = narrow::may_hide(graph, &[expression]);
        let bounds = hides.then(|| Arc::new(Intervals::new(graph.clone(), vec![expression])));
        Ok(Self::Expression(code, bounds))
    }
}

/// What is looked for.
#[derive(Clone, Debug)]
pub struct Event {
    /// What is zero there.
    pub function: Function,
    /// In increasing time: upwards if positive, downwards if negative, else both.
    pub direction: f64,
    /// The run ends with the zero of this number.
    pub last: Option<u64>,
    /// Of what the motion conserves, the value that it is to pass.
    pub conserved: Option<f64>,
}

/// A zero.
#[derive(Clone, Debug)]
pub struct Found {
    /// Of which event.
    pub which: usize,
    /// When.
    pub t: f64,
    /// The state there.
    pub y: Vec<f64>,
}

/// A step, and the states inside it.
pub(super) trait Interval {
    /// The times at its ends, in the direction of the run.
    fn span(&self) -> (f64, f64);

    /// The state at its end.
    fn end(&self) -> &[f64];

    /// The state at a fraction of it.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn at(&mut self, theta: f64) -> Result<&[f64]>;
}

/// A function at work.
enum Working {
    Expression(Machine<f64>, Option<Box<Shape>>),
    Called(Arc<Called>),
}

impl Working {
    fn of(function: &Function, parameters: &[f64]) -> Self {
        match function {
            Function::Expression(code, bounds) => {
                let shape = bounds.as_ref().map(|bounds| Box::new(Shape::new(bounds, parameters)));
                Self::Expression(Machine::new(code.clone(), parameters), shape)
            }
            Function::Called(call) => Self::Called(call.clone()),
        }
    }

    /// Its value, and its rate in time where that is known.
    fn at(&mut self, t: f64, y: &[f64]) -> Result<(f64, Option<f64>)> {
        let machine = match self {
            Self::Called(call) => return Ok((call(t, y)?, None)),
            Self::Expression(machine, _) => machine,
        };
        let (value, rate) = along(machine, t, y);
        Ok((value, Some(rate)))
    }

    /// Its bounds, of one in which something may hide.
    fn shape(&mut self) -> Option<&mut Shape> {
        match self {
            Self::Expression(_, shape) => shape.as_deref_mut(),
            Self::Called(_) => None,
        }
    }
}

/// Events under watch from step to step.
pub(super) struct Watch<'a> {
    events: &'a [Event],
    working: Vec<Working>,
    /// Value and rate of each at the last node.
    ends: Vec<(f64, Option<f64>)>,
    counts: Vec<u64>,
    /// Events that no motion from this start has: what it conserves is the value that was to be passed.
    never: Vec<bool>,
    begun: bool,
    /// The state inside a step at which every event is looked at first.
    inside: Vec<f64>,
    /// What was found, in the order of the motion.
    pub(super) found: Vec<Found>,
}

/// A zero that is nearer to the start than so many units in the last place is the start: who runs on from where an event has
/// ended a run does not meet it again.
const AT_THE_START: f64 = 16.0 * f64::EPSILON;

/// A conserved value is that of the start if they are no more units in the last place apart.
const UNITS_OF_VALUES: f64 = 16.0;

impl<'a> Watch<'a> {
    /// For events of a system with these parameters.
    pub(super) fn new(events: &'a [Event], parameters: &[f64]) -> Self {
        Self {
            events,
            working: events.iter().map(|event| Working::of(&event.function, parameters)).collect(),
            ends: vec![(f64::NAN, None); events.len()],
            counts: vec![0; events.len()],
            never: vec![false; events.len()],
            begun: false,
            inside: vec![],
            found: vec![],
        }
    }

    /// Takes the values at the start of the run.
    ///
    /// # Errors
    /// Those of the functions.
    pub(super) fn start(&mut self, t: f64, y: &[f64]) -> Result<()> {
        for (which, (working, end)) in self.working.iter_mut().zip(&mut self.ends).enumerate() {
            *end = working.at(t, y)?;
            if let Some(value) = self.events[which].conserved {
                let nothing = rounding(working, t, y)? + UNITS_OF_VALUES * f64::EPSILON * value.abs();
                self.never[which] = end.0.abs() <= nothing;
            }
        }
        Ok(())
    }

    /// Finds the zeros in a step; the time of the one that ends the run, if one does.
    ///
    /// # Errors
    /// Those of the functions and of the states inside the step.
    pub(super) fn look(&mut self, step: &mut dyn Interval) -> Result<Option<f64>> {
        if self.events.is_empty() {
            return Ok(None);
        }
        let (from, to) = step.span();
        self.inside.clear();
        self.inside.extend_from_slice(step.at(INSIDE)?);
        let mut zeros: Vec<(f64, usize)> = vec![];
        for (which, event) in self.events.iter().enumerate().filter(|&(which, _)| !self.never[which]) {
            let start = Point::at(0.0, self.ends[which], from, to);
            let after = self.working[which].at(to, step.end())?;
            self.ends[which] = after;
            let end = Point::at(1.0, after, from, to);
            let search = Search::new(&mut self.working[which], step);
            let found = search.zeros([start, end], &self.inside)?;
            // Upwards along a run backwards is downwards in time.
            let along = if from <= to { event.direction } else { -event.direction };
            let counted = found.into_iter().filter(|&(_, up)| along == 0.0 || (along > 0.0) == up);
            zeros.extend(counted.map(|(theta, _)| (theta, which)));
        }
        if !self.begun {
            self.begun = true;
            let (h, size) = ((to - from).abs(), from.abs());
            let nearest = AT_THE_START * if size > h { size } else { h };
            zeros.retain(|(theta, _)| theta * h > nearest);
        }
        zeros.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        for (theta, which) in zeros {
            let t = if theta == 1.0 { to } else { from + theta * (to - from) };
            let y = step.at(theta)?.to_vec();
            self.found.push(Found { which, t, y });
            self.counts[which] += 1;
            if self.events[which].last.is_some_and(|last| self.counts[which] >= last) {
                return Ok(Some(t));
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests;
