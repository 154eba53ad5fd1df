//! The bodies that the events of a unit look at: where they lie in a state, and how they move there.

use super::super::super::events::{Moving, apart};
use super::super::super::unit::Prepared;
use super::Job;
use crate::numerics::lanes::{Lanes, WIDTH, as_numbers};
use crate::numerics::power_of_two::power_of_two;
use crate::ode::state::State;

/// Bodies of a unit.
#[derive(Clone)]
pub(super) struct Bodies {
    /// Their indices in the scene.
    pub(super) indices: Vec<usize>,
    /// Where the first coordinate of each lies among the coordinates of a state.
    places: Vec<usize>,
    /// From one coordinate of a body to the next.
    pub(super) stride: usize,
    pub(super) components: usize,
    /// What takes a length and a velocity back to the scene's units.
    pub(super) factors: [f64; 2],
}

impl Bodies {
    /// Those in these places of a unit, in a lane of states like this one.
    pub(super) fn new(
        job: &Job<'_>,
        unit: &Prepared,
        slots: &[usize],
        (state, lane): (&State<Lanes>, usize),
    ) -> Self {
        let components = unit.shape.components;
        let units = job.plan.units;
        let place = |&slot: &usize| {
            let (row, lane) = unit.locate(slot, lane);
            row * WIDTH + lane
        };
        Self {
            indices: slots.iter().map(|&slot| unit.unit.bodies[slot]).collect(),
            places: slots.iter().map(place).collect(),
            stride: unit.rows_in(state.q().len()) * WIDTH,
            components,
            factors: [power_of_two(units.length), power_of_two(-units.velocity())],
        }
    }

    /// Reads them off a state.
    #[inline]
    pub(super) fn read(&self, state: &State<Lanes>, into: &mut [Moving]) {
        for (body, moving) in into.iter_mut().enumerate().take(self.places.len()) {
            *moving = self.one(body, state);
        }
    }

    /// Reads one of them off a state.
    #[inline(always)]
    pub(super) fn one(&self, body: usize, state: &State<Lanes>) -> Moving {
        let [length, speed] = self.factors;
        let [q, q_rest, v, v_rest] = numbers(state);
        let mut moving = Moving::default();
        for c in 0..self.components {
            let at = self.places[body] + c * self.stride;
            moving.position[c] = q[at] * length;
            moving.position_rest[c] = q_rest[at] * length;
            moving.velocity[c] = v[at] * speed;
            moving.velocity_rest[c] = v_rest[at] * speed;
        }
        moving
    }

    /// Distance vector and relative velocity of two of them, one component after the other.
    #[inline(always)]
    pub(super) fn apart(
        &self,
        [a, b]: [usize; 2],
        state: &State<Lanes>,
        mut each: impl FnMut(usize, [f64; 2]),
    ) {
        let [length, speed] = self.factors;
        let [q, q_rest, v, v_rest] = numbers(state);
        let (mut i, mut j) = (self.places[a], self.places[b]);
        for c in 0..self.components {
            let distance = apart((q[i], q_rest[i]), (q[j], q_rest[j]));
            let velocity = apart((v[i], v_rest[i]), (v[j], v_rest[j]));
            each(c, [distance * length, velocity * speed]);
            (i, j) = (i + self.stride, j + self.stride);
        }
    }

    /// Place, what it leaves out, velocity and what that leaves out of one of them, one component after the other, in the plan's
    /// units.
    #[inline(always)]
    pub(super) fn numbers_of(
        &self,
        body: usize,
        state: &State<Lanes>,
        mut each: impl FnMut(usize, [f64; 4]),
    ) {
        let all = numbers(state);
        for c in 0..self.components {
            let at = self.places[body] + c * self.stride;
            each(c, all.map(|numbers| numbers[at]));
        }
    }

    /// The row where one of them has its first coordinate.
    pub(super) fn row(&self, body: usize) -> usize {
        self.places[body] / WIDTH
    }

    /// The places of all their coordinates among the numbers of a state, body after body.
    #[inline]
    pub(super) fn coordinates(&self) -> impl Iterator<Item = usize> {
        self.places.iter().flat_map(move |&place| (0..self.components).map(move |c| place + c * self.stride))
    }
}

/// Coordinates and velocities of a state, each with what they leave out: all of one length, to be looked at once.
#[inline(always)]
fn numbers(state: &State<Lanes>) -> [&[f64]; 4] {
    let ((q, q_rest), (v, v_rest)) = (state.position(), state.velocity());
    let q = as_numbers(q);
    let len = q.len();
    [q, &as_numbers(q_rest)[..len], &as_numbers(v)[..len], &as_numbers(v_rest)[..len]]
}
