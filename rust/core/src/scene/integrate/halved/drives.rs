//! What drives make of bodies on which nothing else acts, beside which a velocity is measured.

use super::super::super::unit::Prepared;
use super::super::Job;
use super::{size, speed as speed_of};
use crate::forces::driven_force::Drive;
use crate::numerics::lanes::Lanes;
use crate::ode::state::State;
use core::f64::consts::{PI, TAU};

/// How fast they make a body in so much time; zero where something else acts, which may hold it.
pub(super) fn speed(job: &Job<'_>, unit: &Prepared, slot: usize, span: f64) -> f64 {
    let in_a_quarter = |drive: Drive| {
        let quarter = job.plan.units.take(1.0 / drive.frequency.abs(), [0, 0, 1]);
        pushed(job, unit, slot, drive.amplitude) * quarter.min(span)
    };
    if alone(job, unit) { of(job, unit).map(in_a_quarter).sum() } else { 0.0 }
}

/// What those with less than two steps to a period make of a velocity at most, as a part of it, where nothing else acts. Any
/// two steps may see the same force of one, so that it is asked what steps see, which is a slower one.
pub(super) fn error(
    job: &Job<'_>,
    unit: &Prepared,
    (slot, lane): (usize, usize),
    end: &State<Lanes>,
    steps: u64,
) -> f64 {
    if !alone(job, unit) {
        return 0.0;
    }
    let dt = job.plan.dt.map_or(0.0, f64::abs);
    let span = steps as f64 * dt;
    let gained = |drive: Drive| {
        let turns = drive.frequency.abs() * dt / TAU;
        let seen = TAU * (turns - turns.round()).abs() / dt;
        let time = job.plan.units.take(span.min(1.0 / seen), [0, 0, 1]);
        pushed(job, unit, slot, drive.amplitude) * time
    };
    let unseen = of(job, unit).filter(|drive| drive.frequency.abs() * dt > PI);
    let gained: f64 = unseen.map(gained).sum();
    if gained == 0.0 {
        return 0.0;
    }
    gained / gained.max(speed_of(unit, unit.pick(slot, end.v(), lane)))
}

/// Whether nothing else acts.
fn alone(job: &Job<'_>, unit: &Prepared) -> bool {
    job.plan.forces_of(unit.unit.copy).iter().all(|force| force.as_driven().is_some())
}

fn of<'a>(job: &Job<'a>, unit: &Prepared) -> impl Iterator<Item = Drive> + 'a {
    job.scene.forces_of(unit.unit.copy).iter().filter_map(|force| force.as_driven())
}

/// The acceleration of a body by a force.
fn pushed(job: &Job<'_>, unit: &Prepared, slot: usize, force: [f64; 3]) -> f64 {
    let mass = job.scene.masses(unit.unit.copy)[unit.unit.bodies[slot]];
    job.plan.units.take(size(force) / mass, [1, 0, -2])
}
