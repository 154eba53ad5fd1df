//! What the error of a step is measured against, lane by lane: each unit brings its own.

use super::super::super::frame::Origin;
use super::super::super::unit::Prepared;
use super::super::Job;
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::ode::norm::Norm;

/// A body in the very place that distances are measured from has no size to be held to; below this share of the unit's it is
/// as good as there.
const NOTHING: f64 = 1.0 / 1_048_576.0;

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
