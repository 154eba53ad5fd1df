//! A unit of integration: bodies whose motions hang together, ready to be laid into lanes.
//!
//! Packed, the lanes of a state are the bodies of one unit, massive ones first, each kind padded to whole
//! blocks. Batched, the lanes are eight units and the rows their bodies. The same integrators run both.

use super::columns::{Entry, Writer};
use super::frame::{Origin, Units};
use super::plan::Plan;
use super::request::Request;
use super::{ForceSpec, Scene, distance};
use crate::error::Result;
use crate::forces::gravity::{FewBodies, RING_MAX, Ring, Tiles};
use crate::forces::uniform_field::UniformField;
use crate::forces::{Dynamics, Force};
use crate::integrators::state::State;
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Lanes, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::power_of_two::{power_of_two, scale};
use crate::numerics::real::Real;
use crate::parallel::Ticker;

/// Padding lanes stand far out, each elsewhere, where nothing they feel or exert is felt.
const FAR_OUT: f64 = 1.267_650_600_228_229_4e30; // 2^100

/// Above this many bodies the smallest separation is estimated from the mean density instead.
const ALL_PAIRS: usize = 8192;

/// Bodies that are integrated together: massive ones first.
#[derive(Clone, Debug)]
pub struct Unit {
    /// Which copy of the scene.
    pub copy: usize,
    /// Their indices in the scene.
    pub bodies: Vec<usize>,
    /// How many of them attract.
    pub active: usize,
    /// How many of them, from the first, are recorded from this unit, and from where.
    pub recorded: core::ops::Range<usize>,
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
    /// `G·m` of the active bodies.
    pub strength: Vec<f64>,
    /// Masses.
    pub mass: Vec<f64>,
    /// Origin, in the scene's units.
    pub origin: Origin,
    /// What distances are measured from, for the error of a step: place and velocity.
    pub reference: Origin,
    /// The size of a distance and of a velocity at the start.
    pub size: (f64, f64),
}

/// How units lie in lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Lanes are bodies of one unit.
    Packed,
    /// Lanes are units.
    Batched,
}

impl Prepared {
    /// Brings a unit of a scene into the plan's units.
    pub fn new(plan: &Plan, scene: &Scene, unit: Unit) -> Self {
        let units = plan.units;
        let origin = plan.origins[unit.copy];
        let (masses, positions, velocities) =
            (scene.masses(unit.copy), scene.positions(unit.copy), scene.velocities(unit.copy));
        let relative = |x: [f64; 3], origin: [f64; 3], exponent: i32| {
            core::array::from_fn(|c| scale(x[c] - origin[c], exponent))
        };
        let position: Vec<[f64; 3]> =
            unit.bodies.iter().map(|&i| relative(positions[i], origin.center, -units.length)).collect();
        let velocity: Vec<[f64; 3]> =
            unit.bodies.iter().map(|&i| relative(velocities[i], origin.drift, units.velocity())).collect();
        let mass: Vec<f64> = unit.bodies.iter().map(|&i| scale(masses[i], -units.mass)).collect();
        let constant = plan.gravity.map_or(0.0, |(constant, _)| constant);
        let strength =
            unit.bodies[..unit.active].iter().map(|&i| units.strength(constant, masses[i])).collect();
        let mut prepared = Self {
            unit,
            position,
            velocity,
            strength,
            mass,
            origin,
            reference: Origin::default(),
            size: (1.0, 1.0),
        };
        prepared.measure(plan);
        prepared
    }

    /// Chooses what the errors of an adaptive step are measured against.
    fn measure(&mut self, plan: &Plan) {
        if !plan.method.adaptive() {
            return;
        }
        let center = plan.forces.iter().find_map(|force| match force {
            ForceSpec::CentralField { center, .. } => Some(*center),
            _ => None,
        });
        if let Some(center) = center {
            self.reference.center = center.map(|x| scale(x, -plan.units.length));
        } else {
            let total: f64 = self.strength.iter().sum();
            for (i, strength) in self.strength.iter().enumerate() {
                for c in 0..3 {
                    self.reference.center[c] += strength / total * self.position[i][c];
                    self.reference.drift[c] += strength / total * self.velocity[i][c];
                }
            }
        }
        let mut separation = f64::INFINITY;
        let mut extent = 0.0_f64;
        let mut speed = 0.0_f64;
        for (x, v) in self.position.iter().zip(&self.velocity) {
            extent = extent.max(distance(*x, self.reference.center));
            speed = speed.max(distance(*v, self.reference.drift));
        }
        let active = self.unit.active;
        if active > 0 && self.position.len() > 1 {
            if self.position.len() > ALL_PAIRS {
                // Mean spacing; a cube root by Newton would be no better for an estimate.
                separation = extent / (self.position.len() as f64).sqrt().sqrt();
            } else {
                for i in 0..active {
                    for j in i + 1..self.position.len() {
                        separation = separation.min(distance(self.position[i], self.position[j]));
                    }
                }
            }
            let softening = plan.gravity.map_or(0.0, |(_, softening)| scale(softening, -plan.units.length));
            separation = separation.max(softening);
        } else {
            separation = extent;
        }
        let length = if separation > 0.0 && separation.is_finite() { separation } else { 1.0 };
        // The speed of a circular orbit there: a system at rest has a velocity scale too.
        let total: f64 = self.strength.iter().map(|x| x.abs()).sum();
        let orbital = (total / extent.max(length)).sqrt();
        let velocity = speed.max(orbital);
        // A body at rest in a field gets its scale from the fall over that length.
        let velocity = if velocity > 0.0 { velocity } else { (length * self.field_strength(plan)).sqrt() };
        self.size = (length, if velocity > 0.0 { velocity } else { 1.0 });
    }

    /// The largest acceleration that the central fields give to a body of the unit.
    fn field_strength(&self, plan: &Plan) -> f64 {
        let mut strongest = 0.0_f64;
        for force in &plan.forces {
            if let ForceSpec::CentralField { potential, center } = force {
                let potential = potential.scaled(plan.units.length, plan.units.energy());
                let center = center.map(|x| scale(x, -plan.units.length));
                for (position, mass) in self.position.iter().zip(&self.mass) {
                    let [_, force, _] = potential.evaluate(&[distance(*position, center)]);
                    strongest = strongest.max(force[0].abs() / mass);
                }
            }
        }
        strongest
    }

    /// The forces, for `units` (one if packed, up to eight if batched) of the same make-up.
    pub fn dynamics(plan: &Plan, units: &[&Self], layout: Layout, threads: usize) -> Dynamics<Lanes> {
        let first = units[0];
        let shape = first.shape(plan, layout);
        let exponents = plan.units;
        let lanes = |of: &dyn Fn(&Self) -> f64| {
            Lanes(core::array::from_fn(|lane| of(units[lane.min(units.len() - 1)])))
        };
        let mut forces: Vec<Box<dyn Force<Lanes>>> = Vec::new();
        for force in &plan.forces {
            forces.push(match force {
                ForceSpec::UniformField { g } => {
                    Box::new(UniformField::new(shape, g.map(|g| scale(g, exponents.acceleration()))))
                }
                ForceSpec::CentralField { potential, center } => {
                    let mut inverse_mass = vec![Lanes::zero(); shape.rows];
                    for slot in 0..first.mass.len() {
                        match layout {
                            Layout::Packed => {
                                let (row, lane) = first.place(slot);
                                inverse_mass[row].0[lane] = 1.0 / first.mass[slot];
                            }
                            Layout::Batched => inverse_mass[slot] = lanes(&|unit| 1.0 / unit.mass[slot]),
                        }
                    }
                    let scaled = potential.scaled(exponents.length, exponents.energy());
                    scaled.central_force(shape, center.map(|x| scale(x, -exponents.length)), inverse_mass)
                }
                ForceSpec::Gravity { softening, .. } => {
                    let softening = scale(*softening, -exponents.length);
                    match layout {
                        Layout::Batched => {
                            let strength = (0..first.unit.active)
                                .map(|slot| lanes(&|unit| unit.strength[slot]))
                                .collect();
                            Box::new(FewBodies::new(shape, strength, softening))
                        }
                        Layout::Packed if first.unit.active <= RING_MAX => {
                            Box::new(Ring::new(shape, first.strength.clone(), softening))
                        }
                        Layout::Packed => {
                            let mut strength = vec![Lanes::zero(); first.unit.active.div_ceil(WIDTH)];
                            as_numbers_mut(&mut strength)[..first.unit.active]
                                .copy_from_slice(&first.strength);
                            Box::new(Tiles::new(shape, strength, first.unit.active, softening, threads))
                        }
                    }
                }
            });
        }
        Dynamics::new(shape, forces)
    }

    /// How this unit's coordinates lie.
    pub fn shape(&self, plan: &Plan, layout: Layout) -> Shape {
        let components = if plan.planar { 2 } else { 3 };
        let bodies = self.unit.bodies.len();
        let rows = match layout {
            Layout::Batched => bodies,
            Layout::Packed => self.unit.active.div_ceil(WIDTH) + (bodies - self.unit.active).div_ceil(WIDTH),
        };
        Shape { rows, components }
    }

    /// Row and lane of a body, packed.
    fn place(&self, slot: usize) -> (usize, usize) {
        let active = self.unit.active;
        if slot < active {
            (slot / WIDTH, slot % WIDTH)
        } else {
            (active.div_ceil(WIDTH) + (slot - active) / WIDTH, (slot - active) % WIDTH)
        }
    }

    /// The lane of a body: `unit_lane` if batched.
    fn locate(&self, slot: usize, layout: Layout, unit_lane: usize) -> (usize, usize) {
        match layout {
            Layout::Packed => self.place(slot),
            Layout::Batched => (slot, unit_lane),
        }
    }

    /// Lays the unit into a state (into one lane of it if batched).
    pub fn write(&self, state: &mut State<Lanes>, layout: Layout, unit_lane: usize) {
        let shape = state.shape;
        let ((q, q_error), (v, v_error)) = state.halves_mut();
        if layout == Layout::Packed {
            for c in 0..shape.components {
                for row in 0..shape.rows {
                    q[c * shape.rows + row] =
                        Lanes(core::array::from_fn(|lane| FAR_OUT * (1 + lane + row * WIDTH) as f64));
                }
            }
        }
        for slot in 0..self.position.len() {
            let (row, lane) = self.locate(slot, layout, unit_lane);
            for c in 0..shape.components {
                let at = c * shape.rows + row;
                q[at].0[lane] = self.position[slot][c];
                v[at].0[lane] = self.velocity[slot][c];
                q_error[at].0[lane] = 0.0;
                v_error[at].0[lane] = 0.0;
            }
        }
    }

    /// Reads a body off a state, in the scene's units and about its origin.
    pub fn read(
        &self,
        slot: usize,
        state: &State<Lanes>,
        layout: Layout,
        unit_lane: usize,
        units: Units,
        elapsed: f64,
    ) -> Entry {
        let shape = state.shape;
        let (row, lane) = self.locate(slot, layout, unit_lane);
        let mut entry = Entry::default();
        for c in 0..shape.components {
            let at = c * shape.rows + row;
            let take = |values: &[Lanes], exponent: i32| scale(values[at].0[lane], exponent);
            let velocity_exponent = -units.velocity();
            let (x, rest) = self.origin.restore(c, take(state.q(), units.length), elapsed);
            entry.position[c] = x;
            entry.position_rest[c] = rest + take(state.q_error(), units.length);
            let still = Origin { center: self.origin.drift, drift: [0.0; 3] };
            let (v, rest) = still.restore(c, take(state.v(), velocity_exponent), 0.0);
            entry.velocity[c] = v;
            entry.velocity_rest[c] = rest + take(state.v_error(), velocity_exponent);
        }
        if shape.components == 2 {
            entry.position[2] = self.origin.center[2] + self.origin.drift[2] * elapsed;
            entry.velocity[2] = self.origin.drift[2];
        }
        entry
    }

    /// Records the unit's bodies at an output time; `false` if they are no longer finite.
    pub fn record(
        &self,
        writer: &Writer<'_>,
        time: usize,
        state: &State<Lanes>,
        layout: Layout,
        unit_lane: usize,
        units: Units,
        elapsed: f64,
    ) -> bool {
        if writer.keeps_rest() || self.origin != Origin::default() {
            return self.record_precisely(writer, time, state, layout, unit_lane, units, elapsed);
        }
        // The common case, kept lean: a run of cheap steps with many outputs spends its time here.
        let Shape { rows, components } = state.shape;
        let (q, v) = (as_numbers(state.q()), as_numbers(state.v()));
        let (length, speed) = (power_of_two(units.length), power_of_two(-units.velocity()));
        let mut check = 0.0;
        for slot in self.unit.recorded.clone() {
            let (row, lane) = self.locate(slot, layout, unit_lane);
            let (mut position, mut velocity) = ([0.0; 3], [0.0; 3]);
            for c in 0..components {
                let at = (c * rows + row) * WIDTH + lane;
                position[c] = q[at] * length;
                velocity[c] = v[at] * speed;
                // Zero times a finite number is zero; times anything else it is not a number.
                check += 0.0 * position[c] + 0.0 * velocity[c];
            }
            writer.write_rounded(self.unit.copy, time, self.unit.bodies[slot], position, velocity);
        }
        check == 0.0
    }

    fn record_precisely(
        &self,
        writer: &Writer<'_>,
        time: usize,
        state: &State<Lanes>,
        layout: Layout,
        unit_lane: usize,
        units: Units,
        elapsed: f64,
    ) -> bool {
        let mut finite = true;
        for slot in self.unit.recorded.clone() {
            let entry = self.read(slot, state, layout, unit_lane, units, elapsed);
            finite &= entry.position.iter().chain(&entry.velocity).all(|x| x.is_finite());
            writer.write(self.unit.copy, time, self.unit.bodies[slot], &entry);
        }
        finite
    }
}

/// The acceleration of every particle of a scene of one copy.
///
/// # Errors
/// What [`Scene::validate`] refuses; [`Error::Interrupted`](crate::Error::Interrupted).
pub fn acceleration(scene: &Scene, threads: usize, ticker: &mut Ticker<'_>) -> Result<Vec<[f64; 3]>> {
    let request = Request {
        times: vec![scene.t0],
        method: "rk4".to_owned(),
        dt: Some(1.0),
        rtol: 1e-9,
        atol: None,
        max_step: None,
        max_steps: None,
        record: Vec::new(),
        threads,
    };
    let plan = Plan::new(scene, &request)?;
    let mut result = vec![[0.0; 3]; scene.particles];
    for unit in plan.unit_list() {
        let prepared = Prepared::new(&plan, scene, unit);
        // Packed whatever the plan's layout: it is one state of one unit.
        let layout = if plan.gravity.is_some() { Layout::Packed } else { plan.layout };
        let mut dynamics = Prepared::dynamics(&plan, &[&prepared], layout, threads);
        let zeros = vec![Lanes::zero(); dynamics.shape.len()];
        let mut state = State::new(dynamics.shape, &zeros, &zeros);
        for lane in 0..if layout == Layout::Packed { 1 } else { WIDTH } {
            prepared.write(&mut state, layout, lane);
        }
        let mut a = zeros;
        dynamics.acceleration(state.q(), state.v(), &mut a, ticker)?;
        for slot in prepared.unit.recorded.clone() {
            let (row, lane) = prepared.locate(slot, layout, 0);
            for c in 0..dynamics.shape.components {
                let value = a[c * dynamics.shape.rows + row].0[lane];
                result[prepared.unit.bodies[slot]][c] = scale(value, -plan.units.acceleration());
            }
        }
    }
    Ok(result)
}
