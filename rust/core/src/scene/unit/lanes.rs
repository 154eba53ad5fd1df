//! A unit in the lanes of a state: laid in at the start, read off at the output times.
//!
//! Packed, the lanes are its bodies, massive ones first, each kind padded to whole blocks. Batched, it has
//! one lane, and the rows are its bodies; the rows of eight further units may follow those of the first eight.

use super::super::columns::Entry;
use super::super::frame::restored;
use super::{Layout, Plan, Prepared, Unit, scale};
use crate::forces::context::packed_place;
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::state::State;

/// Padding lanes stand far out, each elsewhere, where nothing they feel or exert is felt.
const FAR_OUT: f64 = 1.267_650_600_228_229_4e30; // 2^100

/// How the coordinates of a unit lie.
pub(super) fn shape(unit: &Unit, plan: &Plan) -> Shape {
    let components = if plan.planar { 2 } else { 3 };
    let bodies = unit.bodies.len();
    let rows = match plan.layout_of(unit) {
        Layout::Batched => bodies,
        Layout::Packed => unit.active.div_ceil(WIDTH) + (bodies - unit.active).div_ceil(WIDTH),
    };
    Shape { rows, components }
}

impl Prepared {
    /// Row and lane of a body, of a unit that has the place `unit_lane` among the units of a state if batched.
    pub(in crate::scene) fn locate(&self, slot: usize, unit_lane: usize) -> (usize, usize) {
        match self.layout {
            Layout::Batched => (unit_lane / WIDTH * self.shape.rows + slot, unit_lane % WIDTH),
            Layout::Packed => packed_place(slot, self.unit.active),
        }
    }

    /// How the coordinates of so many units of this make-up lie in one state.
    pub(in crate::scene) fn state_shape(&self, units: usize) -> Shape {
        Shape { rows: units.div_ceil(self.layout.units()) * self.shape.rows, ..self.shape }
    }

    /// A state for so many units of this make-up, all zeros.
    pub fn blank_state(&self, units: usize) -> State<Lanes> {
        let shape = self.state_shape(units);
        let turning = units.div_ceil(self.layout.units()) * self.turning_numbers();
        let zeros = vec![Lanes::zero(); shape.len() + turning];
        State::new(&zeros, &zeros)
    }

    /// Lays the unit into a state (at one place in it if batched).
    pub fn write(&self, state: &mut State<Lanes>, unit_lane: usize) {
        let components = self.shape.components;
        let rows = self.rows_in(state.q().len());
        self.write_turning(state, unit_lane);
        let ((q, q_error), (v, v_error)) = state.halves_mut();
        if self.layout == Layout::Packed {
            for c in 0..components {
                for row in 0..rows {
                    q[c * rows + row] =
                        Lanes(core::array::from_fn(|lane| FAR_OUT * (1 + lane + row * WIDTH) as f64));
                }
            }
        }
        for slot in 0..self.position.len() {
            let (row, lane) = self.locate(slot, unit_lane);
            for c in 0..components {
                let at = c * rows + row;
                q[at].0[lane] = self.position[slot][c];
                v[at].0[lane] = self.velocity[slot][c];
                q_error[at].0[lane] = self.rests[slot][0][c];
                v_error[at].0[lane] = self.rests[slot][1][c];
            }
        }
    }

    /// Whether all coordinates of the unit are finite in a state.
    pub fn is_finite(&self, state: &State<Lanes>, unit_lane: usize) -> bool {
        let rows = self.rows_in(state.q().len());
        self.turning_is_finite(state, unit_lane)
            && (0..self.position.len()).all(|slot| {
                let (row, lane) = self.locate(slot, unit_lane);
                (0..self.shape.components).all(|c| state.q()[c * rows + row].0[lane].is_finite())
            })
    }

    /// What a block that lies as the coordinates do holds of a body.
    pub fn pick(&self, slot: usize, block: &[Lanes], unit_lane: usize) -> [f64; 3] {
        let rows = self.rows_in(block.len());
        let (row, lane) = self.locate(slot, unit_lane);
        let mut point = [0.0; 3];
        for c in 0..self.shape.components {
            point[c] = block[c * rows + row].0[lane];
        }
        point
    }

    /// Lays what a block holds of a body into its place.
    pub fn lay(&self, slot: usize, block: &mut [Lanes], unit_lane: usize, point: [f64; 3]) {
        let rows = self.rows_in(block.len());
        let (row, lane) = self.locate(slot, unit_lane);
        for c in 0..self.shape.components {
            block[c * rows + row].0[lane] = point[c];
        }
    }

    /// Where a body is, in the units and about the origin of the integration.
    pub fn place(&self, slot: usize, state: &State<Lanes>, unit_lane: usize) -> [f64; 3] {
        self.pick(slot, state.q(), unit_lane)
    }

    /// Reads a body off a state, in the scene's units and about its origin.
    pub fn read(&self, slot: usize, state: &State<Lanes>, unit_lane: usize, elapsed: f64) -> Entry {
        let pick = |block: &[Lanes]| self.pick(slot, block, unit_lane);
        let (position, velocity) = (state.position(), state.velocity());
        let [position, velocity] = [position, velocity].map(|(values, rests)| [pick(values), pick(rests)]);
        self.entry(position, velocity, elapsed)
    }

    /// A body in the scene's units and about its origin, from the numbers of a state and what they leave out.
    pub fn entry(&self, [q, q_rest]: [[f64; 3]; 2], [v, v_rest]: [[f64; 3]; 2], elapsed: f64) -> Entry {
        let components = self.shape.components;
        let (length, speed) = (self.units.length, -self.units.velocity());
        let moved = self.origin.at(elapsed);
        let mut entry = Entry::default();
        for c in 0..components {
            let position = (scale(q[c], length), scale(q_rest[c], length));
            let velocity = (scale(v[c], speed), scale(v_rest[c], speed));
            let [x, v] = if self.origin.is_elsewhere() {
                [restored(moved.position[c], position), restored(moved.velocity[c], velocity)]
            } else {
                [position, velocity]
            };
            (entry.position[c], entry.position_rest[c]) = x;
            (entry.velocity[c], entry.velocity_rest[c]) = v;
        }
        if components == 2 {
            (entry.position[2], entry.position_rest[2]) = moved.position[2];
            (entry.velocity[2], entry.velocity_rest[2]) = moved.velocity[2];
        }
        entry
    }
}
