//! The rigid bodies of a unit in the lanes of a state, behind its points: four numbers for each in either half.

use super::super::columns::Output;
use super::{Plan, Prepared, Unit};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::ode::state::State;
use crate::rigid::motion::acting::{Loads, Systems};
use crate::rigid::motion::bodies::{Arrangement, LaneBody, RigidBodies, Start};
use crate::rigid::motion::vectors::turned_back;
use crate::rigid::quaternion::Quaternion;
use crate::scene::Scene;
use crate::scene::plan::Turning;

/// The orientation and the angular velocity of a body, of the caller's axes.
pub type Turned = (Quaternion, [f64; 3]);

/// The rigid bodies of a unit at the start.
pub(super) fn starts(plan: &Plan, scene: &Scene, unit: &Unit) -> Vec<Start> {
    let Some(bodies) = scene.rigid.as_ref().filter(|_| plan.turning.steps()) else { return Vec::new() };
    let (masses, places) = (scene.masses(unit.copy), scene.positions(unit.copy));
    let rigid = unit.bodies.iter().filter_map(|&body| Some((body, plan.rigid_place(body)?)));
    let start = |(body, place): (usize, usize)| {
        Start::new(bodies, unit.copy * bodies.count + place, masses[body], places[body], plan.units)
    };
    rigid.map(start).collect()
}

impl Prepared {
    /// Numbers of a unit, beside those of points, in each half of a state that holds up to eight.
    pub(super) fn turning_numbers(&self) -> usize {
        4 * self.starts.len()
    }

    /// Rows of points in a half of so many numbers.
    #[inline(always)]
    pub(in crate::scene) fn rows_in(&self, numbers: usize) -> usize {
        let components = self.shape.components;
        if self.starts.is_empty() {
            return numbers / components;
        }
        numbers / (self.shape.len() + self.turning_numbers()) * self.shape.rows
    }

    /// Where the numbers of a rigid body of the unit begin, in a half of so many.
    fn turning_at(&self, place: usize, numbers: usize, unit_lane: usize) -> (usize, usize) {
        let points = self.shape.components * self.rows_in(numbers);
        let body = unit_lane / WIDTH * self.starts.len() + place;
        (points + 4 * body, unit_lane % WIDTH)
    }

    /// Lays the rigid bodies into a state.
    pub(super) fn write_turning(&self, state: &mut State<Lanes>, unit_lane: usize) {
        let numbers = state.q().len();
        let ((q, q_rest), (v, v_rest)) = state.halves_mut();
        for (place, start) in self.starts.iter().enumerate() {
            let (at, lane) = self.turning_at(place, numbers, unit_lane);
            for c in 0..4 {
                q[at + c].0[lane] = start.orientation[c];
                // Another unit may have been there.
                (q_rest[at + c].0[lane], v_rest[at + c].0[lane]) = (0.0, 0.0);
            }
            for c in 0..3 {
                v[at + c].0[lane] = start.momentum[c];
            }
        }
    }

    /// Whether all rigid bodies are somewhere.
    pub(super) fn turning_is_finite(&self, state: &State<Lanes>, unit_lane: usize) -> bool {
        (0..self.starts.len()).all(|place| {
            let (at, lane) = self.turning_at(place, state.q().len(), unit_lane);
            let finite = |half: &[Lanes]| half[at..at + 4].iter().all(|x| x.0[lane].is_finite());
            finite(state.q()) && finite(state.v())
        })
    }

    /// Points that are held of the unit in each block: of its bodies, and two of each that turns.
    pub(in crate::scene) fn held(&self) -> usize {
        self.unit.bodies.len() + 2 * self.starts.len()
    }

    /// What a block holds of a body, or of half of how one turns.
    pub(in crate::scene) fn pick_held(&self, slot: usize, block: &[Lanes], unit_lane: usize) -> [f64; 3] {
        let Some(half) = slot.checked_sub(self.unit.bodies.len()) else {
            return self.pick(slot, block, unit_lane);
        };
        let (at, lane) = self.turning_at(half / 2, block.len(), unit_lane);
        match half % 2 {
            0 => [0, 1, 2].map(|c| block[at + c].0[lane]),
            _ => [block[at + 3].0[lane], 0.0, 0.0],
        }
    }

    /// Lays it into its place.
    pub(in crate::scene) fn lay_held(
        &self,
        slot: usize,
        block: &mut [Lanes],
        unit_lane: usize,
        point: [f64; 3],
    ) {
        let Some(half) = slot.checked_sub(self.unit.bodies.len()) else {
            return self.lay(slot, block, unit_lane, point);
        };
        let (at, lane) = self.turning_at(half / 2, block.len(), unit_lane);
        match half % 2 {
            0 => (0..3).for_each(|c| block[at + c].0[lane] = point[c]),
            _ => block[at + 3].0[lane] = point[0],
        }
    }

    /// Whether orientations and momenta, as they are held, are those of a copy of a scene, whose quaternions may have been
    /// brought to length 1 since.
    pub(in crate::scene) fn turns_agree(
        &self,
        scene: &Scene,
        copy: usize,
        held: impl Fn(usize) -> [[f64; 4]; 2],
    ) -> bool {
        let Some(bodies) = &scene.rigid else { return self.starts.is_empty() };
        self.starts.iter().enumerate().all(|(place, start)| {
            let at = copy * bodies.count + start.at % bodies.count;
            let [q, [x, y, z, _]] = held(place);
            let (orientation, spin) = self.turned_to(bodies, place, q, [x, y, z]);
            // The farthest from length 1 that a step leaves one, of large turns by explicit methods.
            let near = |(one, other): (&f64, &f64)| (one - other).abs() <= 16.0 * f64::EPSILON;
            orientation.iter().zip(&bodies.orientation[at]).all(near) && spin == bodies.angular_velocity[at]
        })
    }

    /// Whether a point of a body is held.
    pub(in crate::scene) fn is_held(&self, plan: &Plan, scene: &Scene, body: usize) -> bool {
        let place = plan.rigid_place(body).filter(|_| !self.starts.is_empty());
        scene.rigid.as_ref().zip(place).is_some_and(|(bodies, place)| bodies.pivoted[place])
    }

    /// The orientation and the angular velocity of a rigid body in the scene's terms, from its numbers.
    fn turned_to(&self, bodies: &RigidBodies, place: usize, q: Quaternion, momentum: [f64; 3]) -> Turned {
        let start = &self.starts[place];
        let spin = start.spin(turned_back(q, momentum)).map(|part| scale(part, -self.units.time));
        bodies.given(start.at, q, spin)
    }

    /// Reads a rigid body off a state.
    fn read_turning(
        &self,
        bodies: &RigidBodies,
        place: usize,
        state: &State<Lanes>,
        unit_lane: usize,
    ) -> Turned {
        let (at, lane) = self.turning_at(place, state.q().len(), unit_lane);
        let q: Quaternion = core::array::from_fn(|c| state.q()[at + c].0[lane]);
        let momentum = [0, 1, 2].map(|c| state.v()[at + c].0[lane]);
        self.turned_to(bodies, place, q, momentum)
    }

    /// The rigid bodies among those that are recorded, in their order.
    pub(in crate::scene) fn turned(
        &self,
        scene: &Scene,
        state: &State<Lanes>,
        unit_lane: usize,
    ) -> Vec<Turned> {
        let Some(bodies) = &scene.rigid else { return Vec::new() };
        (0..self.starts.len()).map(|place| self.read_turning(bodies, place, state, unit_lane)).collect()
    }

    /// Records those that are recorded from this unit; `false` if some are no longer finite.
    pub(super) fn record_turning(
        &self,
        scene: &Scene,
        output: &Output<'_>,
        state: &State<Lanes>,
        unit_lane: usize,
    ) -> bool {
        let Some(bodies) = &scene.rigid else { return true };
        let points = scene.particles - bodies.count;
        let slots = self.unit.bodies.iter().enumerate().filter(|(_, body)| **body >= points);
        let mut finite = true;
        for (place, (start, (slot, _))) in self.starts.iter().zip(slots).enumerate() {
            let turned = self.read_turning(bodies, place, state, unit_lane);
            finite &= turned.0.iter().chain(&turned.1).all(|x| x.is_finite());
            if self.unit.recorded.contains(&slot) {
                output.write_turned(start.at % bodies.count, turned);
            }
        }
        finite
    }
}

/// The rigid bodies of units in lanes, and what acts on them; `None` if they have none.
pub(in crate::scene) fn assembled(
    plan: &Plan,
    scene: &Scene,
    units: &[&Prepared],
) -> Option<(Arrangement, Loads)> {
    let Turning::Stepped(free) = plan.turning else { return None };
    let bodies = scene.rigid.as_ref().filter(|_| !units[0].starts.is_empty())?;
    let first = units[0];
    // Copies may have forces of their own.
    let constant = |unit: &&Prepared| {
        let constants = plan.forces_of(unit.unit.copy).iter().filter_map(|force| force.as_newtonian());
        constants.map(|(constant, _)| constant).sum()
    };
    let (mut lanes, mut loads) = (Vec::new(), Loads::default());
    for (block, units) in units.chunks(WIDTH).enumerate() {
        let row = block * first.shape.rows;
        let starts: Vec<Vec<Start>> = units.iter().map(|unit| unit.starts.clone()).collect();
        let mut of_block = Vec::new();
        let slots =
            (0..first.unit.bodies.len()).filter(|&slot| plan.rigid_place(first.unit.bodies[slot]).is_some());
        for (place, slot) in slots.enumerate() {
            let of_lanes: Vec<Start> = starts.iter().map(|of| of[place]).collect();
            of_block.push(LaneBody::new(free, &of_lanes, row + slot));
        }
        let systems = Systems {
            bodies,
            starts: &starts,
            mass: units.iter().map(|unit| &unit.mass[..]).collect(),
            members: &first.unit.bodies,
            particles: scene.particles,
            row,
            first: lanes.len(),
            constants: units.iter().map(constant).collect(),
            units: plan.units,
            t0: plan.t0,
        };
        loads.add(&systems, &of_block);
        lanes.extend(of_block);
    }
    let rows = units.len().div_ceil(WIDTH) * first.shape.rows;
    let held = lanes.iter().filter(|body| body.pivoted).count();
    Some((Arrangement { rows, free_points: held < rows, bodies: lanes.into() }, loads))
}
