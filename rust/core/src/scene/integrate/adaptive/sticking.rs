//! Velocities that stick at zero where a force leaps, as dry friction's does: steps hardly advance there, and without end. And
//! places where a formula has no number, from which there is no step.
//!
//! The one idea: what creeps is asked for the accelerations on both sides of the leap. If both point back to it (A. F. Filippov,
//! *Differential Equations with Discontinuous Righthand Sides*, section 4), no step gets past it.

use super::{Forces, Run};
use crate::parallel::Ticker;

/// Tries of a step that are looked at together, …
const TRIES: u32 = 1 << 13;
/// … and how many the rest of the run would take at their pace if it is to be asked why.
const MANY: f64 = 1e7;
/// So near to zero the accelerations are asked for, as a part of the velocity.
const BESIDE: f64 = 1e-6;

/// How a unit gets on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pace {
    tries: u32,
    from: f64,
}

impl Pace {
    /// Counts a try that ended at a time; how far many came, if that would make too many of the rest.
    fn count(&mut self, elapsed: f64, end: f64) -> Option<f64> {
        self.tries += 1;
        if self.tries < TRIES {
            return None;
        }
        let way = (elapsed - self.from).abs();
        *self = Self { tries: 0, from: elapsed };
        ((end - elapsed).abs() * f64::from(TRIES) > MANY * way).then_some(way)
    }
}

impl Run<'_> {
    /// The body of the unit in a lane whose velocity sticks, if its steps creep for that.
    pub(super) fn sticks(&mut self, lane: usize, ticker: &mut Ticker<'_>) -> Option<usize> {
        let (end, elapsed) = (self.end(), self.elapsed(lane));
        let slot = self.slots[lane].as_mut()?;
        let way = slot.pace.count(elapsed, end)?;
        let unit = &slot.unit;
        let (system, state) = (self.forces.system(), &self.state);
        let mut velocities = state.v().to_vec();
        let mut accelerations = velocities.clone();
        for (at, &body) in unit.unit.bodies.iter().enumerate() {
            let velocity = unit.pick(at, state.v(), lane);
            let square: f64 = velocity.iter().map(|v| v * v).sum();
            // By how much it grows on either side, as a part of what it is.
            let [mut ahead, mut behind] = [0.0; 2];
            for (side, growth) in [(BESIDE, &mut ahead), (-BESIDE, &mut behind)] {
                unit.lay(at, &mut velocities, lane, velocity.map(|v| side * v));
                let t = &self.clock.elapsed;
                system.acceleration(t, state.q(), &velocities, &mut accelerations, ticker).ok()?;
                let a = unit.pick(at, &accelerations, lane);
                *growth = a.iter().zip(&velocity).map(|(a, v)| a * v).sum::<f64>() / square;
            }
            unit.lay(at, &mut velocities, lane, velocity);
            // Not of one that is slowed down by no more than it would be in that time.
            if ahead < 0.0 && behind > 0.0 && way * behind.min(-ahead) > 1.0 {
                return Some(body);
            }
        }
        None
    }

    /// The body of the unit in a lane of whose acceleration a formula makes no number.
    pub(super) fn undefined(&mut self, lane: usize, ticker: &mut Ticker<'_>) -> Option<usize> {
        let unit = &self.slots[lane].as_ref()?.unit;
        let formula = self.job.plan.forces_of(unit.unit.copy).iter().any(|force| force.is_formula());
        if !formula || matches!(self.forces, Forces::Turning(_)) {
            return None;
        }
        let mut accelerations = self.state.v().to_vec();
        let (t, q, v) = (&self.clock.elapsed, self.state.q(), self.state.v());
        self.forces.system().acceleration(t, q, v, &mut accelerations, ticker).ok()?;
        let undefined = |at: &usize| unit.pick(*at, &accelerations, lane).iter().any(|part| part.is_nan());
        (0..unit.unit.bodies.len()).find(undefined).map(|at| unit.unit.bodies[at])
    }
}
