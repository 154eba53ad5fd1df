//! What a function may do in a part of a step, told by the states that the part leads through.
//!
//! The one idea: a few looks tell a function only where nothing narrow hides between them, and none are needed where it is nowhere
//! zero. Bounds over the box of the states tell both; those over a wider box hold for some steps more.

use super::intervals::{Interval, Intervals};
use std::sync::Arc;

/// How far states may be beyond those that are known, as a part of how far these are apart.
const BEYOND: f64 = 0.5;
/// How much farther a box goes that is looked at for the steps to come …
const WIDER: f64 = 4.0;
/// … and how many parts of steps go by before that is tried again where too much hides in one.
const WAIT: u32 = 16;

/// What is told of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// The function is nowhere zero.
    Clear,
    /// A few looks tell it.
    Plain,
    /// Something may hide between them.
    Narrow,
}

/// Times and states.
#[derive(Clone, Debug)]
struct Region {
    time: Interval,
    state: Vec<Interval>,
}

/// The bounds of a function.
#[derive(Clone, Debug)]
pub struct Shape {
    intervals: Intervals,
    parameters: Vec<f64>,
    here: Region,
    /// Where nothing hides, and what is told there.
    known: Region,
    told: Told,
    /// How many parts go by before a wider region is looked at again.
    wait: u32,
}

impl Region {
    fn nowhere() -> Self {
        Self { time: Interval::at(0.0), state: vec![] }
    }

    fn holds(&self, other: &Self) -> bool {
        let within =
            |(outer, inner): (&Interval, &Interval)| outer.low <= inner.low && inner.high <= outer.high;
        self.state.len() == other.state.len()
            && within((&self.time, &other.time))
            && self.state.iter().zip(&other.state).all(within)
    }

    /// The same, and as much around it as it is wide, so many times.
    fn wider(&self, times: f64) -> Self {
        let wider = |of: &Interval| {
            let beyond = times * (of.high - of.low);
            Interval::between(of.low - beyond, of.high + beyond)
        };
        Self { time: wider(&self.time), state: self.state.iter().map(wider).collect() }
    }
}

impl Shape {
    /// Of a function with these parameters.
    pub fn new(intervals: &Arc<Intervals>, parameters: &[f64]) -> Self {
        Self {
            intervals: (**intervals).clone(),
            parameters: parameters.to_vec(),
            here: Region::nowhere(),
            known: Region::nowhere(),
            told: Told::Narrow,
            wait: 0,
        }
    }

    /// What the function does between two times, on a way through three states.
    pub fn told(&mut self, [from, to]: [f64; 2], states: [&[f64]; 3]) -> Told {
        let [first, middle, last] = states;
        self.here.time = Interval::between(from, to);
        self.here.state.clear();
        self.here.state.extend(first.iter().zip(middle).zip(last).map(|((&a, &b), &c)| {
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            let beyond = BEYOND * (high - low);
            Interval::between(low - beyond, high + beyond)
        }));
        self.told_here(|told| told != Told::Narrow)
    }

    /// Whether the function is nowhere zero between two times, while the state is in a box.
    pub fn is_clear(&mut self, time: Interval, state: impl Iterator<Item = Interval>) -> bool {
        self.here.time = time;
        self.here.state.clear();
        self.here.state.extend(state);
        self.told_here(|told| told == Told::Clear) == Told::Clear
    }

    /// What is told here, and of a wider region if that is enough there.
    fn told_here(&mut self, is_enough: fn(Told) -> bool) -> Told {
        if self.known.holds(&self.here) {
            return self.told;
        }
        if self.wait == 0 {
            let wider = self.here.wider(WIDER);
            let told = told(&mut self.intervals, &wider, &self.parameters);
            if is_enough(told) {
                (self.known, self.told) = (wider, told);
                return told;
            }
            self.wait = WAIT;
        }
        self.wait -= 1;
        told(&mut self.intervals, &self.here, &self.parameters)
    }
}

/// What a function does in a region.
fn told(intervals: &mut Intervals, region: &Region, parameters: &[f64]) -> Told {
    let bounds = intervals.over(region.time, &region.state, parameters);
    match bounds.values.first() {
        Some(value) if value.low > 0.0 || value.high < 0.0 => Told::Clear,
        _ if bounds.is_plain => Told::Plain,
        _ => Told::Narrow,
    }
}
