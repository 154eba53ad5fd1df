//! The solution between its nodes: one polynomial for each step, kept to be read at any time.

use super::equal_steps::nested;
use crate::error::{Error, Result};

/// The polynomials of the steps of a run, in the basis of [`Trial::extension`](super::trial::Trial::extension).
#[derive(Clone, Debug, Default)]
pub struct Extension {
    /// The time before each step, and at the end of the last.
    pub nodes: Vec<f64>,
    /// How long each step is. The last node may lie within the last step.
    pub lengths: Vec<f64>,
    /// The state before each step, one after another.
    pub starts: Vec<f64>,
    /// The terms of each step, one after another.
    pub terms: Vec<f64>,
}

impl Extension {
    /// To be read.
    pub fn view(&self) -> View<'_> {
        let Self { nodes, lengths, starts, terms } = self;
        View { nodes, lengths, starts, terms }
    }
}

/// An [`Extension`] wherever its numbers may lie.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// As those of an [`Extension`].
    pub nodes: &'a [f64],
    /// As those of an [`Extension`].
    pub lengths: &'a [f64],
    /// As those of an [`Extension`].
    pub starts: &'a [f64],
    /// As those of an [`Extension`].
    pub terms: &'a [f64],
}

impl View<'_> {
    /// The states at these times, one after another: of the step that ends there at a node, and of the first and the last
    /// step beyond the ends.
    ///
    /// # Errors
    /// Arrays that do not belong together.
    pub fn at(&self, times: &[f64]) -> Result<Vec<f64>> {
        let steps = self.lengths.len();
        let numbers = self.starts.len().checked_div(steps).unwrap_or(0);
        let terms = self.terms.len().checked_div(self.starts.len()).unwrap_or(0);
        let fits = self.nodes.len() == steps + 1
            && self.starts.len() == steps * numbers
            && self.terms.len() == self.starts.len() * terms;
        if steps == 0 || !fits {
            return Err(Error::Internal("no polynomial for each step".to_owned()));
        }
        let forward = self.nodes[0] <= self.nodes[steps];
        let mut states = Vec::with_capacity(times.len() * numbers);
        for &t in times {
            let before = |&node: &f64| if forward { node < t } else { node > t };
            let step = self.nodes.partition_point(before).clamp(1, steps) - 1;
            let (from, length) = (self.nodes[step], self.lengths[step]);
            let theta = if length == 0.0 { 0.0 } else { (t - from) / length };
            let start = &self.starts[step * numbers..][..numbers];
            let polynomial = &self.terms[step * numbers * terms..][..numbers * terms];
            states.extend(start.iter().enumerate().map(|(i, y)| {
                let terms = (0..terms).map(|term| polynomial[term * numbers + i]);
                y + nested(terms.rev(), theta)
            }));
        }
        Ok(states)
    }
}
