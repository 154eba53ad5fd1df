//! What no stage sees: whether the rates at the end of a step are those that its polynomial leads to.
//!
//! The one idea: the last stage is before the end, and the polynomial through the stages knows of no force that begins between
//! them, as of a steep wall met after a long free way. The state at the end does. Where a motion is smooth, the polynomial errs
//! at the end of its own step by a known small share of how far it leads astray in the next one; what errs by much more has met
//! something new.

use super::Table;
use crate::numerics::lanes::{Lanes, WIDTH};

/// So many times what a smooth motion errs by, for every stage: the terms after the leading one count as well, the more the
/// higher it is, and steps grow.
const SMOOTH: f64 = 1.8;
/// What is unseen for so short a time may err by so many tolerances in a rate …
const TOLERANCES: f64 = 50.0;
/// … and rates that lose digits err by this.
const LOST_DIGITS: f64 = 1e-10;

/// The end of a step as the stages see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ending {
    /// What each stage contributes there, in all lanes.
    pub(super) weights: [Lanes; WIDTH],
    /// And at the beginning, which of the first step of a run no step before it has looked at.
    pub(super) first: [Lanes; WIDTH],
    /// By so many times the noise of rates these may miss each other.
    pub(super) noise: f64,
    /// Of what a polynomial leads astray in the next step, the most by which it errs at the end of its own where motions are smooth.
    share: f64,
}

impl Ending {
    /// Of a method.
    pub(super) fn of(table: &Table) -> Self {
        let nodes = &table.c.0[..table.stages];
        let product = |x: f64| nodes.iter().map(|c| x - c).product::<f64>();
        let farthest = 1.0 + nodes[table.stages - 1];
        let later_terms = (0..table.stages).fold(1.0, |product, _| product * SMOOTH);
        let weights = table.at(&Lanes([1.0; WIDTH]));
        Self {
            noise: weights.iter().fold(1.0, |sum, weight| sum + weight.0[0].abs()),
            weights,
            // Of as much noise: nodes are symmetric.
            first: table.at(&Lanes([0.0; WIDTH])),
            share: later_terms * product(1.0) / product(farthest),
        }
    }

    /// Whether rates that miss by so much, as a part of a size, have met something new, where steps are led astray by `delta`.
    pub(super) fn met(&self, missed: f64, delta: f64, tolerance: f64) -> bool {
        let smooth = self.share * delta;
        let least = TOLERANCES * tolerance;
        let least = if least < LOST_DIGITS { LOST_DIGITS } else { least };
        // Of what is no number as well.
        !(missed <= smooth || missed <= least)
    }
}
