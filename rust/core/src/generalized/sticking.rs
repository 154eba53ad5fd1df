//! Velocities that stick where a force leaps: dry friction brings a body to rest, and no step gets past that.
//!
//! The one idea: on both sides of the leap the rates point back to it (A. F. Filippov, *Differential Equations with Discontinuous
//! Righthand Sides*, section 4), so from step to step the velocity changes its sign, each time heading back. One that passes
//! through zero heads on. Equal steps are too long for that, their stages lie on both sides, and what is held would creep:
//! where the next of them would reach the leap, the rates on both sides of it are asked.

use super::model::Model;
use super::structure::Structure;
use crate::error::{Error, Result};
use crate::expressions::{Code, Id, Machine, Node};
use std::sync::Arc;

/// So many returns in a row are no turning of the motion, which the first would be.
const RETURNS: u32 = 4;
/// Steps without one after which nothing sticks; and the part of the time since the start that returns are apart at most.
const STEPS_BETWEEN: u32 = 200;
const APART: f64 = 1e-6;
/// Steps that are looked at together, in case they creep: by less than this part of the time since the start.
const TOGETHER: u32 = 4096;
const CREEPING: f64 = 1e-3;
/// So near to the leap its sides are looked at, as a part of the velocity or of what a step changes it by.
const BESIDE: f64 = 1e-9;

/// What ends a run there.
const STUCK: &str = "a velocity sticks at zero, where an absolute value of it turns: on both sides its forces, as dry friction, point \
    back to zero. It stays there while the other forces are weaker, which these equations do not tell; end the run before (an event \
    of the velocity), or write v·tanh(v/width) for |v| and tanh(v/width) for v/|v|";

/// Codes of what absolute values are taken of, with their rates, where these are of velocities.
///
/// # Errors
/// Expressions that are too large.
pub(super) fn switches(model: &mut Model) -> Result<Vec<Arc<Code>>> {
    let n = model.source.coordinates;
    let of_velocities = |model: &Model, id: Id| {
        model.source.graph.any(&[id], |node| matches!(node, Node::Variable(index) if *index as usize >= n))
    };
    let found: Vec<Id> =
        Structure::turning(&model.source).into_iter().filter(|&id| of_velocities(model, id)).collect();
    found.into_iter().map(|id| model.along(id).map(Arc::new)).collect()
}

/// A velocity under watch.
#[derive(Clone, Debug)]
struct Switch {
    machine: Machine<f64>,
    /// Its value and rate at the last node.
    last: (f64, f64),
    returns: u32,
    /// Steps and time since the last return.
    steps: u32,
    at: f64,
}

impl Switch {
    /// Whether a step of length `h` would come to the leap, and the rates on both sides of it point back.
    fn holds(&mut self, t: f64, y: &[f64], h: f64) -> bool {
        let (value, rate) = along(&mut self.machine, t, y);
        // It leads away from it, or not so far.
        if value * rate > 0.0 || value.abs() > h * rate.abs() {
            return false;
        }
        let n = y.len() / 2;
        let mut moved = y.to_vec();
        let slopes: Vec<f64> = (n..y.len())
            .map(|i| {
                moved[i] = y[i] + 1.0;
                let (there, _) = along(&mut self.machine, t, &moved);
                moved[i] = y[i];
                there - value
            })
            .collect();
        let square: f64 = slopes.iter().map(|slope| slope * slope).sum();
        let beside = BESIDE * if value == 0.0 { h * rate.abs() } else { value.abs() };
        let mut rate_at = |wanted: f64| {
            for (i, slope) in slopes.iter().enumerate() {
                moved[n + i] = y[n + i] + (wanted - value) * slope / square;
            }
            along(&mut self.machine, t, &moved).1
        };
        rate_at(beside) < 0.0 && rate_at(-beside) > 0.0
    }
}

/// All of a trajectory.
#[derive(Clone, Debug, Default)]
pub(super) struct Sticking {
    switches: Vec<Switch>,
    t0: f64,
    /// Steps since the time that they are measured from.
    steps: u32,
    from: f64,
}

impl Sticking {
    /// Of a trajectory with these parameters that starts then.
    pub(super) fn new(model: &Model, parameters: &[f64], t0: f64) -> Self {
        let switch = |code: &Arc<Code>| {
            let machine = Machine::new(code.clone(), parameters);
            Switch { machine, last: (0.0, 0.0), returns: 0, steps: 0, at: t0 }
        };
        Self { switches: model.switches.iter().map(switch).collect(), t0, steps: 0, from: t0 }
    }

    /// Whether there is nothing to look at.
    pub(super) fn is_empty(&self) -> bool {
        self.switches.is_empty()
    }

    /// How far many steps have come, if they creep.
    fn creeps(&mut self, t: f64) -> Option<f64> {
        self.steps += 1;
        if self.steps < TOGETHER {
            return None;
        }
        let way = (t - self.from).abs();
        (self.steps, self.from) = (0, t);
        (way <= CREEPING * (t - self.t0).abs()).then_some(way)
    }

    /// What ended a run whose steps fell to nothing after that state, if that is a velocity that sticks.
    pub(super) fn explains(&mut self, t: f64, y: &[f64]) -> Option<String> {
        let soon = APART * (t - self.t0).abs();
        self.switches.iter_mut().any(|switch| switch.holds(t, y, soon)).then(|| STUCK.to_owned())
    }

    /// Looks at the end of a step; of one as long as all others at what the next will come to.
    ///
    /// # Errors
    /// [`Error::Convergence`] where a velocity sticks.
    pub(super) fn look(&mut self, t: f64, y: &[f64], equal: Option<f64>) -> Result<()> {
        let ahead = equal.map(f64::abs).or_else(|| self.creeps(t));
        for switch in &mut self.switches {
            if ahead.is_some_and(|h| switch.holds(t, y, h)) {
                return Err(Error::Convergence { message: STUCK.to_owned(), time: t });
            }
            let (value, rate) = along(&mut switch.machine, t, y);
            let (before, rate_before) = core::mem::replace(&mut switch.last, (value, rate));
            switch.steps += 1;
            let returns = before * value < 0.0 && before * rate_before < 0.0 && value * rate < 0.0;
            if !returns {
                continue;
            }
            let soon = switch.steps <= STEPS_BETWEEN && (t - switch.at).abs() <= APART * (t - self.t0).abs();
            switch.returns = if soon { switch.returns + 1 } else { 1 };
            (switch.steps, switch.at) = (0, t);
            if switch.returns >= RETURNS {
                return Err(Error::Convergence { message: STUCK.to_owned(), time: t });
            }
        }
        Ok(())
    }
}

/// The value of a code of [`Model::along`], and its rate.
pub(super) fn along(machine: &mut Machine<f64>, t: f64, y: &[f64]) -> (f64, f64) {
    machine.state().copy_from_slice(y);
    machine.run(t);
    let terms = (machine.code().outputs() - 2) / 2;
    let of_rates = (0..terms).map(|i| machine.output(2 + i) * machine.output(2 + terms + i));
    let rate = of_rates.fold(machine.output(1), |sum, term| sum + term);
    (machine.output(0), rate)
}
