//! Long quiet runs: bodies on orbits about one another that are far from an encounter at the start, for hundreds
//! of the shortest period.
//!
//! For more bodies than series serve (`auto` takes those for few) a multistep method with equal steps is more exact in
//! less time than steps that the error chooses. Nothing known at the start keeps an encounter from coming later, though,
//! and equal steps go through it without a word: so it is told, not done.
//! Measured: a sun with eight planets, 400 and 2000 periods of the inner one. Steps of a two-hundredth of the period that goes
//! with the pericenter are off by 1e-12 to 2e-9 of the orbit for eccentricities from 0 to 0.5; Verner's 9(8) as it is held by
//! itself by 3e-8 to 2e-6, at least 50 times as much, in 1.6 to 3 times the time.

use super::super::Scene;
use super::turn::turn;
use crate::forces::ForceTerm;
use std::sync::Arc;

/// The method that is told, and how many of its steps go into the shortest period.
pub(super) const METHOD: &str = "stormer13";
const STEPS: f64 = 200.0;
/// A run of fewer periods is over soon enough.
const PERIODS: f64 = 300.0;
/// The largest eccentricity for which this was measured.
const ECCENTRIC: f64 = 0.5;
/// Beyond these the closest pairs would take as long as a step.
const BODIES: usize = 64;

/// A step of a quiet run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quiet {
    /// Shortest periods in the run.
    pub(super) periods: f64,
    /// The step, signed.
    pub(super) dt: f64,
}

/// Whether a run of a scene of one copy is long and, at the start, quiet.
pub(super) fn quiet(scene: &Scene, forces: &[Arc<dyn ForceTerm>], signed_span: f64) -> Option<Quiet> {
    let [force] = forces else { return None };
    let (constant, 0.0) = force.as_newtonian()? else { return None };
    if scene.copies != 1 || scene.particles > BODIES {
        return None;
    }
    let mut shortest = f64::INFINITY;
    for body in 0..scene.particles {
        let Some(turn) = turn(scene, 0, constant, body)? else { continue };
        (turn.eccentricity <= ECCENTRIC).then_some(())?;
        shortest = shortest.min(turn.at_pericenter);
    }
    let periods = signed_span.abs() / shortest;
    let dt = signed_span / periods / STEPS;
    // Two digits are enough to be typed.
    let dt = format!("{dt:.1e}").parse().unwrap_or(dt);
    (periods >= PERIODS && periods.is_finite()).then_some(Quiet { periods, dt })
}
