//! What the error of a step is measured against, lane by lane: each unit brings its own.

use super::super::super::frame::Origin;
use super::super::super::plan::Plan;
use super::super::super::unit::Prepared;
use super::super::Job;
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::ode::norm::Norm;

/// A body in the very place that distances are measured from has no size to be held to; below this share of the unit's it is
/// as good as there.
const NOTHING: f64 = 1.0 / 1_048_576.0;

/// Whether sizes are measured from the center of mass of a unit, wherever it goes: of bodies that depend on each other,
/// where no force has a center and some force moves the whole, so that it leaves the origin.
fn from_their_center(plan: &Plan, unit: &Prepared) -> bool {
    unit.unit.active > 1
        && plan.forces.iter().all(|force| force.center().is_none())
        && plan.forces.iter().any(|force| !force.conserves().momentum)
}

/// The share of each body in the mass of its unit, as the bodies lie in the lanes of a state.
fn weigh(norm: &mut Norm<Lanes>, unit: &Prepared, lanes: Bits) {
    let massive = unit.unit.active;
    let total: f64 = unit.mass[..massive].iter().sum();
    let weights = norm.weights.get_or_insert_with(|| vec![Lanes::zero(); unit.shape.rows]);
    for weight in weights.iter_mut() {
        *weight = Lanes::select(lanes, Lanes::zero(), *weight);
    }
    for (slot, mass) in unit.mass[..massive].iter().enumerate() {
        let (row, lane) = unit.locate(slot, lanes.0.trailing_zeros() as usize);
        weights[row].0[lane] = mass / total;
    }
}

/// Takes over a unit's measures for its lanes. Without `atol` the tolerance is scale-free: relative to the unit's size.
pub(super) fn set(norm: &mut Norm<Lanes>, job: &Job<'_>, unit: &Prepared, lanes: Bits) {
    let units = job.plan.units;
    let (length, speed) = unit.size;
    let (atol_q, atol_v) = match job.atol {
        None => (job.rtol * length, job.rtol * speed),
        Some(atol) => (
            scale(atol, -units.length).max(NOTHING * job.rtol * length),
            scale(atol, units.velocity()).max(NOTHING * job.rtol * speed),
        ),
    };
    if from_their_center(job.plan, unit) {
        weigh(norm, unit, lanes);
    }
    let set = |into: &mut Lanes, value: f64| *into = Lanes::select(lanes, Lanes::splat(value), *into);
    for block in &mut norm.blocks {
        set(&mut block.atol, if block.velocity { atol_v } else { atol_q });
        for c in 0..3 {
            let Origin { center, drift, .. } = unit.reference;
            if block.velocity {
                set(&mut block.reference[c], drift[c]);
            } else {
                set(&mut block.reference[c], center[c]);
                set(&mut block.drift[c], drift[c]);
            }
        }
    }
}
