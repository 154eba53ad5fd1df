//! Why a step fell to zero: an encounter that is closer than steps can follow, a state that is no longer finite, or neither.

use super::super::super::distance;
use super::super::super::unit::Prepared;
use super::super::{Ending, Job};
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::scale;
use crate::ode::state::State;

/// Bodies are what takes the steps away if they are closer than this share of their smallest distance at the start (an orbit
/// there is a billion times as quick), …
const CLOSE: f64 = 1e-6;
/// … or so close that an orbit there is over in so many of the shortest steps that the time can tell.
const STEPS: f64 = 1e6;
/// A fall into a force that grows faster than gravity is quicker than such an orbit: what is closer than this share, and is
/// past each other in so many steps at the speed that it has.
const FALLING: f64 = 1e-3;

/// Steps that fall to zero at an end of what is known of a force stop nearer to it than this share of the distance or speed.
const AT_THE_END: f64 = 1e-6;

/// Whether bodies at those places are at a distance where a potential ends.
fn at_an_end(job: &Job<'_>, unit: &Prepared, places: &[[f64; 3]]) -> bool {
    let units = job.plan.units;
    job.plan.forces_of(unit.unit.copy).iter().any(|force| {
        let Some((first, last)) = force.domain() else { return false };
        let ends = [first, last].map(|end| scale(end, -units.length));
        let ending = |distance: f64| {
            !(ends[0]..=ends[1]).contains(&distance)
                || ends.iter().any(|end| *end > 0.0 && (distance - end).abs() <= AT_THE_END * end)
        };
        match force.center() {
            Some(center) => {
                let center = units.take_vector(center, [1, 0, 0]);
                places.iter().any(|place| ending(distance(*place, center)))
            }
            None => (0..places.len())
                .any(|i| (i + 1..places.len()).any(|j| ending(distance(places[i], places[j])))),
        }
    })
}

/// Whether a body of a unit is as fast as a force is known.
fn at_a_speed_limit(job: &Job<'_>, unit: &Prepared, state: &State<Lanes>, lane: usize) -> bool {
    unit.unit.bodies.iter().enumerate().any(|(slot, &body)| {
        let speed = distance(unit.pick(slot, state.v(), lane), [0.0; 3]);
        let limits = job.plan.forces_of(unit.unit.copy).iter().filter_map(|force| force.speed_limit(body));
        limits.into_iter().any(|limit| speed >= (1.0 - AT_THE_END) * job.plan.units.take(limit, [1, 0, -1]))
    })
}

/// The ending of a unit whose step fell to zero, in its lane at that time; `massive` are the places of those that it follows.
pub(super) fn why(
    job: &Job<'_>,
    unit: &Prepared,
    state: &State<Lanes>,
    (lane, elapsed): (usize, f64),
    massive: &[[f64; 3]],
) -> Ending {
    let bodies = &unit.unit.bodies;
    // Relative to the unit's own origin: differences of places far away would have no digits.
    let places: Vec<[f64; 3]> = (0..bodies.len()).map(|slot| unit.place(slot, state, lane)).collect();
    if places.iter().flatten().any(|x| !x.is_finite()) {
        return Ending::NotFinite;
    }
    let mut closest = (f64::INFINITY, (0, 0));
    for i in 0..unit.unit.active {
        for j in i + 1..bodies.len() {
            let distance = distance(places[i], places[j]);
            if distance < closest.0 {
                closest = (distance, (bodies[i].min(bodies[j]), bodies[i].max(bodies[j])));
            }
        }
    }
    for (&other, &place) in job.plan.active.iter().zip(massive) {
        let (distance, body) = (distance(places[0], place), bodies[0]);
        if distance < closest.0 {
            closest = (distance, (body.min(other), body.max(other)));
        }
    }
    for center in job.plan.forces_of(unit.unit.copy).iter().filter_map(|force| force.center()) {
        let center = job.plan.units.take_vector(center, [1, 0, 0]);
        for (slot, &body) in bodies.iter().enumerate() {
            let distance = distance(places[slot], center);
            if distance < closest.0 {
                closest = (distance, (body, body));
            }
        }
    }
    if at_an_end(job, unit, &places) || at_a_speed_limit(job, unit, state, lane) {
        return Ending::OutsideDomain;
    }
    let (length, speed) = unit.size;
    let share = closest.0 / length;
    let soon = STEPS * f64::EPSILON * elapsed.abs();
    let quick = share * share.sqrt() * (length / speed) <= soon;
    let speeds = (0..bodies.len()).map(|slot| distance(unit.pick(slot, state.v(), lane), [0.0; 3]));
    let falls = share <= FALLING && closest.0 <= soon * speeds.fold(0.0, f64::max);
    if share <= CLOSE || quick || falls {
        Ending::CloseEncounter { distance: scale(closest.0, job.plan.units.length), bodies: closest.1 }
    } else {
        Ending::NoStep
    }
}
