//! A unit of integration: bodies whose motions hang together, massive ones first.
//!
//! [`Unit`] says which they are. [`Prepared`] holds them in the units and about the origin of the
//! integration: `size` measures them, `lanes` lays them into a state and reads them off, `record` does so at
//! the output times (`waiting` some of it a little later), `forces` builds what acts on them.

mod forces;
mod lanes;
mod record;
mod rows;
mod size;
mod turning;
mod waiting;

pub use forces::{Derivatives, Kernel, derivatives, dynamics, uncoupled};
pub use turning::Turned;
pub(super) use turning::assembled;

use super::Scene;
use super::frame::{Origin, Units};
use super::layout::Layout;
use super::plan::Plan;
use crate::error::{Error, Result};
use crate::forces::bodies::PreciseBodies;
use crate::numerics::double_double::two_sum;
use crate::numerics::element::Shape;
use crate::numerics::power_of_two::scale;
use crate::parallel::Ticker;
use crate::rigid::motion::bodies::Start;
use core::cell::RefCell;
use record::Reading;
use std::sync::Arc;
use waiting::Waiting;

/// Bodies that are integrated together: massive ones first.
#[derive(Clone, Debug)]
pub struct Unit {
    /// Which copy of the scene.
    pub copy: usize,
    /// Their indices in the scene; shared, as the units of all copies have the same.
    pub bodies: Arc<[usize]>,
    /// How many of them attract.
    pub active: usize,
    /// Which of them, by their place in `bodies`, are recorded from this unit.
    pub recorded: core::ops::Range<usize>,
    /// Whether it is the first unit of its copy, from which columns are derived where one unit can tell them.
    pub leads: bool,
    /// Whether it is a massless body that follows the massive ones of its copy.
    pub follows: bool,
    /// Units of the same make-up may share lanes: forces see no difference but in numbers.
    pub make_up: usize,
    /// The events that are looked for in it.
    pub events: Arc<[usize]>,
}

impl Unit {
    /// Whether it has a report. Massive bodies that are integrated once more, for massless ones to follow, have none.
    pub fn reports(&self) -> bool {
        !self.recorded.is_empty() || self.make_up != 0
    }

    /// Whether the unit can tell the columns of its copy: nothing that has a mass is elsewhere, and forces that name bodies
    /// find them in their places.
    pub fn is_whole(&self, scene: &Scene) -> bool {
        if scene.forces_of(self.copy).iter().any(|force| force.names_bodies()) {
            return self.bodies.iter().copied().eq(0..scene.particles);
        }
        let massive = scene.masses(self.copy).iter().filter(|&&mass| mass > 0.0).count();
        let own = self.bodies.iter().filter(|&&body| scene.masses(self.copy)[body] > 0.0).count();
        self.bodies.len() == scene.particles || (own > 0 && own == massive)
    }
}

/// A unit in the units and about the origin of its integration.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The unit.
    pub unit: Unit,
    /// Positions.
    pub position: Vec<[f64; 3]>,
    /// Velocities.
    pub velocity: Vec<[f64; 3]>,
    /// What the positions and the velocities leave out.
    pub rests: Vec<[[f64; 3]; 2]>,
    /// `G·m` of the active bodies; zero without gravity.
    pub strength: Vec<f64>,
    /// Masses.
    pub mass: Vec<f64>,
    /// Origin, in the scene's units.
    pub origin: Origin,
    /// What distances are measured from, for the error of a step: place and velocity.
    pub reference: Origin,
    /// The size of a distance and of a velocity at the start.
    pub size: (f64, f64),
    /// What rounding does to a place and a velocity, however short a step.
    pub rounding: (f64, f64),
    /// How its coordinates lie.
    pub shape: Shape,
    /// Its rigid bodies, if torques turn them.
    starts: Vec<Start>,
    layout: Layout,
    units: Units,
    reading: Reading,
    /// Where columns are derived.
    scratch: RefCell<PreciseBodies>,
    /// States whose energies are formed together, where that is quicker.
    waiting: RefCell<Option<Box<Waiting>>>,
}

impl Prepared {
    /// Brings a unit of a scene into the plan's units.
    ///
    /// # Errors
    /// Only errors of the library itself. If the caller asks to stop, it has no size.
    pub fn new(plan: &Plan, scene: &Scene, unit: Unit, ticker: &mut Ticker<'_>) -> Result<Self> {
        let units = plan.units;
        let origin = plan.origin_of(scene, &unit);
        let layout = plan.layout_of(&unit);
        let (masses, positions, velocities) =
            (scene.masses(unit.copy), scene.positions(unit.copy), scene.velocities(unit.copy));
        let relative = |x: [f64; 3], origin: [f64; 3], exponent: i32| {
            let [a, b, c] = [0, 1, 2].map(|c| two_sum(x[c], -origin[c]));
            [[a.0, b.0, c.0], [a.1, b.1, c.1]].map(|values| values.map(|value| scale(value, exponent)))
        };
        let (mut position, mut velocity, mut rests) = (Vec::new(), Vec::new(), Vec::new());
        for &i in unit.bodies.iter() {
            let [x, x_rest] = relative(positions[i], origin.center, -units.length);
            let [v, v_rest] = relative(velocities[i], origin.drift, units.velocity());
            position.push(x);
            velocity.push(v);
            rests.push([x_rest, v_rest]);
        }
        let mass: Vec<f64> = unit.bodies.iter().map(|&i| scale(masses[i], -units.mass)).collect();
        let constants = plan.forces_of(unit.copy).iter().filter_map(|force| force.as_newtonian());
        let constant: f64 = constants.map(|(constant, _)| units.take(constant, [3, -1, -2])).sum();
        let strength = mass[..unit.active].iter().map(|mass| constant * mass).collect();
        let mut prepared = Self {
            shape: lanes::shape(&unit, plan),
            starts: turning::starts(plan, scene, &unit),
            reading: Reading::new(&unit, layout, &origin, units),
            unit,
            position,
            velocity,
            rests,
            strength,
            mass,
            origin,
            reference: Origin::default(),
            size: (1.0, 1.0),
            rounding: (0.0, 0.0),
            layout,
            units,
            scratch: RefCell::default(),
            waiting: RefCell::default(),
        };
        if plan.has_own_times() || plan.neighbors {
            match prepared.measure(plan, ticker) {
                // Nothing is integrated any more, but its start can be recorded.
                Ok(()) | Err(Error::Interrupted) => {}
                Err(other) => return Err(other),
            }
        }
        Ok(prepared)
    }

    /// How its origin moves at the start, in its units.
    pub fn drift(&self) -> [f64; 3] {
        self.origin.drift.map(|v| scale(v, self.units.velocity()))
    }
}
