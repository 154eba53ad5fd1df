//! What the error of a step is measured against, lane by lane: each unit brings its own.

use super::super::super::unit::Prepared;
use super::super::Job;
use crate::integrators::adaptive::{Reference, Tolerance};
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;

/// The tolerance and the reference of the unit in each lane.
pub(super) struct Measure {
    tolerance: Tolerance<Lanes>,
    reference: Reference<Lanes>,
}

impl Measure {
    /// Of empty lanes.
    pub(super) fn new(rtol: f64) -> Self {
        Self {
            tolerance: Tolerance { rtol: Lanes::splat(rtol), atol_q: Lanes::one(), atol_v: Lanes::one() },
            reference: Reference { position: [Lanes::zero(); 3], velocity: [Lanes::zero(); 3] },
        }
    }

    /// As the integrator takes them.
    pub(super) fn parts(&self) -> (Tolerance<Lanes>, Reference<Lanes>) {
        (self.tolerance, self.reference.clone())
    }

    /// Takes over a unit's for its lanes. Without `atol` the tolerance is scale-free: relative to the unit's size.
    pub(super) fn set(&mut self, job: &Job<'_>, unit: &Prepared, lanes: Bits) {
        let units = job.plan.units;
        let (length, speed) = unit.size;
        let (atol_q, atol_v) = match job.atol {
            None => (job.rtol * length, job.rtol * speed),
            Some(atol) => (scale(atol, -units.length), scale(atol, units.velocity())),
        };
        let set = |into: &mut Lanes, value: f64| *into = Lanes::select(lanes, Lanes::splat(value), *into);
        set(&mut self.tolerance.atol_q, atol_q);
        set(&mut self.tolerance.atol_v, atol_v);
        for c in 0..3 {
            set(&mut self.reference.position[c], unit.reference.center[c]);
            set(&mut self.reference.velocity[c], unit.reference.drift[c]);
        }
    }
}
