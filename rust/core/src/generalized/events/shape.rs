//! What a function may do in a part of a step, told by the states that the part leads through.
//!
//! The one idea: a few looks tell a function only where nothing narrow hides between them, and none are needed where it is nowhere
//! zero. Bounds over the box of the states tell both.

use crate::expressions::intervals::{Interval, Intervals};
use std::sync::Arc;

/// How far states may be beyond those that are known, as a part of how far these are apart.
const BEYOND: f64 = 0.5;

/// What is told of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Told {
    /// The function is nowhere zero.
    Clear,
    /// A few looks tell it.
    Plain,
    /// Something may hide between them.
    Narrow,
}

/// The bounds of a function.
pub(super) struct Shape {
    intervals: Intervals,
    parameters: Vec<f64>,
    state: Vec<Interval>,
}

impl Shape {
    /// Of a function with these parameters.
    pub(super) fn new(intervals: &Arc<Intervals>, parameters: &[f64]) -> Self {
        Self { intervals: (**intervals).clone(), parameters: parameters.to_vec(), state: vec![] }
    }

    /// What the function does between two times, on a way through three states.
    pub(super) fn told(&mut self, [from, to]: [f64; 2], states: [&[f64]; 3]) -> Told {
        let [first, middle, last] = states;
        self.state.clear();
        self.state.extend(first.iter().zip(middle).zip(last).map(|((&a, &b), &c)| {
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            let beyond = BEYOND * (high - low);
            Interval::between(low - beyond, high + beyond)
        }));
        let bounds = self.intervals.over(Interval::between(from, to), &self.state, &self.parameters);
        match bounds.values.first() {
            Some(value) if value.low > 0.0 || value.high < 0.0 => Told::Clear,
            _ if bounds.is_plain => Told::Plain,
            _ => Told::Narrow,
        }
    }
}
