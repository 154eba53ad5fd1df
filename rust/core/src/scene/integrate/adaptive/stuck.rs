//! Why a step fell to zero: the closest bodies, or a state that is no longer finite.

use super::super::super::distance;
use super::super::super::unit::Prepared;
use super::super::{Ending, Job};
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::scale;
use crate::ode::state::State;

/// The ending of a unit whose step fell to zero; `massive` are the places of those that it follows.
pub(super) fn why(
    job: &Job<'_>,
    unit: &Prepared,
    state: &State<Lanes>,
    lane: usize,
    massive: &[[f64; 3]],
) -> Ending {
    let bodies = &unit.unit.bodies;
    let places: Vec<[f64; 3]> =
        (0..bodies.len()).map(|slot| unit.read(slot, state, lane, 0.0).position).collect();
    let mut closest = (f64::INFINITY, (0, 0));
    for i in 0..unit.unit.active {
        for j in i + 1..bodies.len() {
            let distance = distance(places[i], places[j]);
            if distance < closest.0 {
                closest = (distance, (bodies[i].min(bodies[j]), bodies[i].max(bodies[j])));
            }
        }
    }
    for (&other, place) in job.plan.active.iter().zip(massive) {
        let place =
            core::array::from_fn(|c| unit.origin.restore(c, scale(place[c], job.plan.units.length), 0.0).0);
        let (distance, body) = (distance(places[0], place), bodies[0]);
        if distance < closest.0 {
            closest = (distance, (body.min(other), body.max(other)));
        }
    }
    for force in &job.plan.forces {
        if let Some(center) = force.center() {
            for (slot, &body) in bodies.iter().enumerate() {
                let distance = distance(places[slot], center);
                if distance < closest.0 {
                    closest = (distance, (body, body));
                }
            }
        }
    }
    if closest.0.is_finite() {
        Ending::CloseEncounter { distance: closest.0, bodies: closest.1 }
    } else {
        Ending::NotFinite
    }
}
