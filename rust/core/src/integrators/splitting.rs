//! The step of a splitting method: kicks and drifts, each compensated.
//!
//! The force at the end of a step is the force at the start of the next, so a step costs as many
//! evaluations as it has drifts; steps are never merged, so that a state can be read at every node.

use super::Splitting;
use super::state::State;
use crate::error::Result;
use crate::forces::Dynamics;
use crate::numerics::element::{Element, Scaled};
use crate::parallel::Ticker;

/// A splitting method with its step.
#[derive(Clone, Debug)]
pub struct SplittingStep<S> {
    table: &'static Splitting,
    /// `kick[i]`, then `drift[i]`.
    pairs: Vec<(Scaled<S>, Scaled<S>)>,
    last_kick: Scaled<S>,
    /// Whether a kick of a pair is nothing (a method that starts with a drift).
    idle: Vec<bool>,
    last_idle: bool,
    acceleration: Vec<S>,
    /// Whether `acceleration` belongs to the present coordinates.
    fresh: bool,
}

impl<S: Element> SplittingStep<S> {
    /// The method `table` with step `h`, for states of `len` coordinates.
    pub fn new(table: &'static Splitting, h: S, len: usize) -> Self {
        let zero = |index: usize| table.kicks[index].to_f64() == 0.0;
        let stages = table.drifts.len();
        Self {
            table,
            pairs: (0..stages).map(|i| (h.scaled_by(table.kicks[i]), h.scaled_by(table.drifts[i]))).collect(),
            last_kick: h.scaled_by(table.kicks[stages]),
            idle: (0..stages).map(zero).collect(),
            last_idle: zero(stages),
            acceleration: vec![S::zero(); len],
            fresh: false,
        }
    }

    /// Becomes the method with step `h`, at the state where `other` stands.
    pub fn follow(&mut self, h: S, other: &Self) {
        for (i, pair) in self.pairs.iter_mut().enumerate() {
            *pair = (h.scaled_by(self.table.kicks[i]), h.scaled_by(self.table.drifts[i]));
        }
        self.last_kick = h.scaled_by(self.table.kicks[self.pairs.len()]);
        self.acceleration.copy_from_slice(&other.acceleration);
        self.fresh = other.fresh;
    }

    /// Begins anew, at another state.
    pub fn restart(&mut self) {
        self.fresh = false;
    }

    /// Advances the state by one step.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    #[inline(always)]
    pub fn step(
        &mut self,
        state: &mut State<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        for (index, (kick, drift)) in self.pairs.iter().enumerate() {
            if self.idle[index] {
                let ((q, q_error), (v, _)) = state.halves_mut();
                S::advance((q, q_error), v, drift);
            } else {
                if !self.fresh {
                    dynamics.acceleration(state.q(), state.v(), &mut self.acceleration, ticker)?;
                }
                let (q, v) = state.halves_mut();
                S::kick_drift(q, v, &self.acceleration, kick, drift);
            }
            self.fresh = false;
        }
        if !self.last_idle {
            dynamics.acceleration(state.q(), state.v(), &mut self.acceleration, ticker)?;
            self.fresh = true;
            let (_, v) = state.halves_mut();
            S::advance(v, &self.acceleration, &self.last_kick);
        }
        Ok(())
    }
}
