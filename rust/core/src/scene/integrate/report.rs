//! What became of a unit.

use super::super::continuation::UnitHeld;
use super::super::unit::{Prepared, Turned, Unit};
use super::{Found, Job, Unresolved};
use crate::numerics::lanes::Lanes;
use crate::ode::state::State;
use core::ops::AddAssign;

/// How a unit ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// At the last output time.
    Finished,
    /// The step fell to zero between two bodies (indices in the scene).
    CloseEncounter {
        /// The bodies; equal for a fixed centre.
        bodies: (usize, usize),
        /// Their distance.
        distance: f64,
    },
    /// The step fell to zero, and no bodies are close.
    NoStep,
    /// A velocity sticks at zero, where a force leaps.
    Sticking {
        /// Whose.
        body: usize,
    },
    /// A formula has no number where a body is.
    Undefined {
        /// Which.
        body: usize,
    },
    /// A step went over something narrower than it is, and felt nothing of it.
    PassedOver,
    /// The state became infinite or undefined.
    NotFinite,
    /// Bodies came to a distance, or to a speed, at which a force on them is not known.
    OutsideDomain,
    /// The most steps allowed were taken.
    TooManySteps,
    /// Nobody named the steps that turn bodies, and the end would take too many of them.
    Endless,
    /// The caller asked to stop.
    Interrupted,
    /// An event ended the run, or spheres that touched.
    Stopped,
    /// Spheres came to rest on each other.
    Resting {
        /// Which.
        bodies: (usize, usize),
    },
    /// One bounces ever faster between others that come together.
    Squeezed {
        /// That, and the one that it met last.
        bodies: (usize, usize),
    },
}

/// What an integration cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Steps taken.
    pub steps: u64,
    /// Steps rejected.
    pub rejected: u64,
    /// Force evaluations.
    pub evaluations: u64,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.steps += other.steps;
        self.rejected += other.rejected;
        self.evaluations += other.evaluations;
    }
}

/// What became of a unit.
#[derive(Clone, Debug)]
pub struct Report {
    /// The unit.
    pub unit: Unit,
    /// How it ended.
    pub ending: Ending,
    /// Output times recorded.
    pub rows: usize,
    /// What it cost.
    pub counts: Counts,
    /// The time reached.
    pub time: f64,
    /// Final positions and velocities of the recorded bodies.
    pub states: Vec<[[f64; 3]; 2]>,
    /// Of the rigid bodies among them, in their order, if torques turn them.
    pub turned: Vec<Turned>,
    /// The events found on the way.
    pub found: Vec<Found>,
    /// What the unit holds, if it ended on a node.
    pub held: Option<UnitHeld>,
    /// A step that does not resolve the motion, if it was looked for and found.
    pub unresolved: Option<Unresolved>,
}

impl Job<'_> {
    /// The report of the unit in `lane` of a state at `time`.
    pub(super) fn report(
        &self,
        unit: &Prepared,
        state: &State<Lanes>,
        lane: usize,
        time: f64,
        ending: Ending,
        rows: usize,
        counts: Counts,
    ) -> Report {
        let elapsed = self.scene.elapsed(time);
        let mut states = Vec::with_capacity(unit.unit.recorded.len());
        for slot in unit.unit.recorded.clone() {
            let entry = unit.read(slot, state, lane, elapsed);
            states.push([entry.position, entry.velocity]);
        }
        let turned = unit.turned(self.scene, state, lane);
        Report {
            unit: unit.unit.clone(),
            ending,
            rows,
            counts,
            time,
            states,
            turned,
            found: Vec::new(),
            held: None,
            unresolved: None,
        }
    }

    /// How many output times are that of the start.
    fn rows_at_start(&self) -> usize {
        self.times.iter().take_while(|&&t| t == self.scene.t0).count()
    }

    /// Whether what is recorded of the start is the scene as it is.
    pub(super) fn begins_plainly(&self) -> bool {
        let plain = !self.writer.derives() && !self.writer.keeps_rest();
        self.from.is_none() && (plain || self.rows_at_start() == 0)
    }

    /// The report of a unit that was interrupted before it began: where it was at the start, which is recorded if that
    /// is the scene as it is.
    pub(super) fn not_begun(&self, unit: &Unit) -> Report {
        let rows = if self.begins_plainly() { self.rows_at_start() } else { 0 };
        unit.record_start(self.writer, self.scene, rows);
        let (positions, velocities) = (self.scene.positions(unit.copy), self.scene.velocities(unit.copy));
        let recorded = unit.bodies.get(unit.recorded.clone()).unwrap_or_default();
        Report {
            unit: unit.clone(),
            ending: Ending::Interrupted,
            rows,
            counts: Counts::default(),
            time: self.scene.t0,
            states: recorded.iter().map(|&body| [positions[body], velocities[body]]).collect(),
            turned: Vec::new(),
            found: Vec::new(),
            held: None,
            unresolved: None,
        }
    }
}
