//! What a run of a model records: outputs, events and poles, and whether a velocity sticks.
//!
//! The one idea: everything is read off a step before it is kept; a step on which something cannot be told is not kept.

use super::too_many_steps;
use crate::error::{Error, Result};
use crate::generalized::events::{Interval, Watch};
use crate::generalized::poles::Poles;
use crate::generalized::sticking::Sticking;
use crate::ode::run::{Recorder, Step};
use crate::ode::table::Table;

/// A table that counts steps.
pub(super) struct Counted<'a> {
    pub(super) table: Table<'a>,
    pub(super) watch: Watch<'a>,
    pub(super) sticking: Sticking,
    pub(super) poles: Poles,
    /// The length of the step that went through a pole.
    pub(super) passed: Option<f64>,
    pub(super) steps: u64,
    /// The longest of them.
    pub(super) longest: f64,
    /// Where the last one ended, or could not be read.
    pub(super) reached: f64,
    /// Where the last one ended that was kept.
    pub(super) kept: f64,
    /// How long all steps are, if they are alike.
    pub(super) equal: Option<f64>,
    /// The most steps.
    pub(super) most: u64,
    /// Whether there was one more.
    pub(super) beyond: bool,
}

impl Recorder for Counted<'_> {
    fn start(&mut self, t: f64, y: &[f64]) -> Result<()> {
        self.watch.start(t, y)?;
        self.table.start(t, y)
    }

    fn step(&mut self, step: &mut Step<'_, '_>) -> Result<Option<f64>> {
        if self.steps == self.most {
            self.beyond = true;
            return Err(Error::Convergence { message: too_many_steps(self.most), time: step.from });
        }
        self.steps += 1;
        let length = (step.to - step.from).abs();
        if !self.poles.is_empty() {
            self.poles.look(step.to, step.end()).inspect_err(|_| self.passed = Some(length))?;
        }
        self.longest = if length > self.longest { length } else { self.longest };
        let stop = self.watch.look(&mut Stepped(step))?;
        self.reached = stop.unwrap_or(step.to);
        self.table.keep(step, stop).inspect_err(|_| {
            // Where a state inside the step is not found, nothing is known beyond.
            self.reached = self.table.next_output().unwrap_or(self.reached);
        })?;
        if stop.is_none() && !self.sticking.is_empty() {
            self.sticking.look(step.to, step.end(), self.equal)?;
        }
        self.kept = step.to;
        Ok(stop)
    }
}

/// A step as events ask it.
struct Stepped<'a, 'b, 'c>(&'a mut Step<'b, 'c>);

impl Interval for Stepped<'_, '_, '_> {
    fn span(&self) -> (f64, f64) {
        (self.0.from, self.0.to)
    }

    fn end(&self) -> &[f64] {
        self.0.end()
    }

    fn at(&mut self, theta: f64) -> Result<&[f64]> {
        self.0.between(theta)
    }
}
