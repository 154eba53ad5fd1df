//! A run as a table: its nodes or the outputs asked for, its polynomials, the zeros of functions.

use super::events::{Events, Watch};
use super::extension::Extension;
use super::run::{Recorder, Step};
use crate::error::{Error, Result};

/// What is kept of a run. Without `outputs` its nodes are.
pub struct Table<'a> {
    /// Times, in the direction of the run.
    outputs: Option<&'a [f64]>,
    next_output: usize,
    /// The functions whose zeros are looked for.
    events: Option<&'a mut dyn Events>,
    watch: Watch,
    /// Times.
    pub t: Vec<f64>,
    /// States there, one after another.
    pub y: Vec<f64>,
    /// The polynomials, if asked for.
    pub extension: Option<Extension>,
}

impl<'a> Table<'a> {
    /// For these outputs (`None`: the nodes) and functions; with `dense`, the polynomials too.
    pub fn new(
        outputs: Option<&'a [f64]>,
        dense: bool,
        events: Option<&'a mut dyn Events>,
        watch: Watch,
    ) -> Self {
        let extension = dense.then(Extension::default);
        Self { outputs, next_output: 0, events, watch, t: vec![], y: vec![], extension }
    }

    /// The zeros that were found, function after function.
    pub fn into_zeros(self) -> Vec<super::events::Zeros> {
        self.watch.zeros
    }

    /// A run that stays where it is: of no equations, or of no length.
    ///
    /// # Errors
    /// Those of the functions.
    pub fn still(&mut self, (t0, end): (f64, f64), y: &[f64]) -> Result<()> {
        self.start(t0, y)?;
        for &t in self.outputs.unwrap_or(&[end]) {
            row(&mut self.t, &mut self.y, t, y)?;
        }
        if let Some(extension) = &mut self.extension {
            extension.nodes.push(end);
            extension.lengths.push(0.0);
            extension.starts.extend_from_slice(y);
        }
        Ok(())
    }
}

/// Adds a row; memory that is not there is no reason to abort the process.
fn row(t: &mut Vec<f64>, y: &mut Vec<f64>, time: f64, state: &[f64]) -> Result<()> {
    let room = t.try_reserve(1).and_then(|()| y.try_reserve(state.len()));
    room.map_err(|_| {
        let numbers = y.len() as f64;
        Error::Convergence {
            message: format!(
                "no memory beyond {:.1} GB of states; ask for fewer with t_eval",
                8e-9 * numbers
            ),
            time,
        }
    })?;
    t.push(time);
    y.extend_from_slice(state);
    Ok(())
}

impl Recorder for Table<'_> {
    fn start(&mut self, t: f64, y: &[f64]) -> Result<()> {
        if self.outputs.is_none() {
            row(&mut self.t, &mut self.y, t, y)?;
        }
        if let Some(extension) = &mut self.extension {
            extension.nodes.push(t);
        }
        self.events.as_deref_mut().map_or(Ok(()), |events| self.watch.start(events, t, y))
    }

    fn step(&mut self, step: &mut Step<'_, '_>) -> Result<Option<f64>> {
        let stop = match self.events.as_deref_mut() {
            Some(events) => self.watch.look(events, step)?,
            None => None,
        };
        self.keep(step, stop)?;
        Ok(stop)
    }
}

impl Table<'_> {
    /// The output that is to be written next, if outputs were asked for.
    pub fn next_output(&self) -> Option<f64> {
        self.outputs?.get(self.next_output).copied()
    }

    /// Writes what a step adds, up to its end or to where the run ends in it.
    ///
    /// # Errors
    /// Those of the states in the step.
    pub fn keep(&mut self, step: &mut Step<'_, '_>, stop: Option<f64>) -> Result<()> {
        let end = stop.unwrap_or(step.to);
        // A run that ends where the step before did has nothing of this one.
        if let Some(extension) = &mut self.extension
            && (end != step.from || extension.lengths.is_empty())
        {
            step.extend(extension)?;
            extension.nodes.push(end);
        }
        let Self { t, y, .. } = self;
        match self.outputs {
            None if end == step.from && t.len() > 1 => {}
            None => row(t, y, end, step.at(end)?)?,
            Some(outputs) => {
                let forward = step.from <= step.to;
                while let Some(&output) = outputs.get(self.next_output)
                    && (if forward { output <= end } else { output >= end })
                {
                    row(t, y, output, step.at(output)?)?;
                    self.next_output += 1;
                }
            }
        }
        Ok(())
    }
}
