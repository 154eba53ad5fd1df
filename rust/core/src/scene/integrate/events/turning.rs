//! How rigid bodies are turned, for functions that look at that: as the state of a unit has it, or where nothing turns them by
//! the exact solution.

use super::super::super::events::Event;
use super::super::super::plan::Turning;
use super::super::super::unit::{Prepared, Turned};
use super::Job;
use crate::error::{Error, Result};
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::scale;
use crate::ode::state::State;
use crate::rigid::free::FreeRotation;
use crate::words::number;

/// Looks for each radian of a turn.
const PER_RADIAN: f64 = 4.0;
/// Radians that are followed within one step.
const MOST: f64 = 1e6;

/// The rigid bodies of a copy.
pub(super) struct Turns {
    /// The lane of the unit in states.
    lane: usize,
    /// Their exact solutions, each with its place among the bodies of all copies.
    exact: Option<Vec<(FreeRotation, usize)>>,
    /// No faster than that those turn, in the units of the scene.
    fastest: f64,
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
        let exact = free.then(|| all.clone().map(motion).collect::<Result<_>>()).transpose()?;
        let turning = all.filter(|_| exact.is_some()).map(|body| {
            let (moments, (_, spin)) = (bodies.moments[body], bodies.principal(body));
            let momentum: f64 = (0..3).map(|c| (moments[c] * spin[c]).powi(2)).sum::<f64>().sqrt();
            let least = moments.iter().copied().filter(|moment| *moment > 0.0).fold(f64::INFINITY, f64::min);
            momentum / least
        });
        let fastest = turning.fold(0.0, f64::max);
        Ok(Some(Self { lane, exact, fastest, now: Vec::new() }))
    }

    /// Into how many parts a step of this length is to be cut, so that no turn is missed in between: steps of points know nothing
    /// of bodies whose turns are known at any time.
    ///
    /// # Errors
    /// A step in which they turn too often to be followed.
    pub(super) fn parts(&self, length: f64) -> Result<f64> {
        let spin = |(_, [x, y, z]): &Turned| (x * x + y * y + z * z).sqrt();
        // Of bodies that turn in steps, as fast as they do now.
        let fastest = match self.exact {
            Some(_) => self.fastest,
            None => self.now.iter().map(spin).fold(0.0, f64::max),
        };
        let angle = length * fastest;
        if angle > MOST {
            let message = format!(
                "expected turns that can be followed, got one step in which a rigid body turns by {} radians; give \
                 max_step={} or less",
                number(angle),
                number(MOST / fastest)
            );
            return Err(Error::invalid("events", message));
        }
        Ok((angle * PER_RADIAN).ceil())
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
