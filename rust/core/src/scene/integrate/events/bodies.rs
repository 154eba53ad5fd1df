//! The bodies that the events of a unit look at: where they lie in a state, and how they move there.

use super::super::super::events::Moving;
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
            stride: state.q().len() / components * WIDTH,
            components,
            factors: [power_of_two(units.length), power_of_two(-units.velocity())],
        }
    }

    /// Reads them off a state.
    #[inline]
    pub(super) fn read(&self, state: &State<Lanes>, into: &mut [Moving]) {
        let [length, speed] = self.factors;
        let ((q, q_rest), (v, v_rest)) = (state.position(), state.velocity());
        let [q, q_rest, v, v_rest] = [q, q_rest, v, v_rest].map(as_numbers);
        for (moving, &place) in into.iter_mut().zip(&self.places) {
            for c in 0..self.components {
                let at = place + c * self.stride;
                moving.position[c] = q[at] * length;
                moving.position_rest[c] = q_rest[at] * length;
                moving.velocity[c] = v[at] * speed;
                moving.velocity_rest[c] = v_rest[at] * speed;
            }
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
