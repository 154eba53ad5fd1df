//! How rigid bodies are turned, for functions that look at that: as the state of a unit has it, or where nothing turns them by
//! the exact solution.

use super::super::super::events::Event;
use super::super::super::plan::Turning;
use super::super::super::unit::{Prepared, Turned};
use super::Job;
use crate::error::Result;
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::scale;
use crate::ode::state::State;
use crate::rigid::free::FreeRotation;

/// The rigid bodies of a copy.
pub(super) struct Turns {
    /// The lane of the unit in states.
    lane: usize,
    /// Their exact solutions, each with its place among the bodies of all copies.
    exact: Option<Vec<(FreeRotation, usize)>>,
    /// How they are turned in the state that was read last.
    pub(super) now: Vec<Turned>,
}

impl Turns {
    /// Those of a unit in a lane, if any event looks at them.
    ///
    /// # Errors
    /// A spin that no body has.
    pub(super) fn new(job: &Job<'_>, unit: &Prepared, lane: usize) -> Result<Option<Self>> {
        let Some(bodies) = &job.scene.rigid else { return Ok(None) };
        if !job.plan.events.iter().any(Event::sees_turning) {
            return Ok(None);
        }
        let all = unit.unit.copy * bodies.count..(unit.unit.copy + 1) * bodies.count;
        let motion = |body: usize| {
            let (orientation, spin) = bodies.principal(body);
            Ok((FreeRotation::new(bodies.moments[body], spin, orientation)?, body))
        };
        let free = matches!(job.plan.turning, Turning::Exact);
        let exact = free.then(|| all.map(motion).collect::<Result<_>>()).transpose()?;
        Ok(Some(Self { lane, exact, now: Vec::new() }))
    }

    /// Reads how they are turned in a state, so long after the start in the units of the plan.
    pub(super) fn read(&mut self, job: &Job<'_>, unit: &Prepared, state: &State<Lanes>, elapsed: f64) {
        let (Some(exact), Some(bodies)) = (&self.exact, &job.scene.rigid) else {
            self.now = unit.turned(job.scene, state, self.lane);
            return;
        };
        let elapsed = scale(elapsed, job.plan.units.time);
        self.now.clear();
        self.now.extend(exact.iter().map(|(motion, body)| {
            let turned = motion.state(elapsed);
            bodies.given(*body, turned.orientation, turned.angular_velocity)
        }));
    }
}
