//! The forces of a scene over lanes: each described force becomes the kernel for the layout and the size.

use super::{Layout, Plan, Prepared};
use crate::forces::Dynamics;
use crate::forces::context::{Arrangement, Context, System};
use crate::forces::gravity::newton::few_bodies;
use crate::numerics::lanes::Lanes;

/// The forces on `units` of the same make-up: one if packed, up to eight for each block of rows if batched.
pub fn dynamics(plan: &Plan, units: &[&Prepared], threads: usize) -> Dynamics<Lanes> {
    let shape = units[0].state_shape(units.len());
    let systems: Vec<System<'_>> =
        units.iter().map(|unit| System { bodies: &unit.unit.bodies, mass: &unit.mass }).collect();
    let context = Context {
        arrangement: match units[0].layout {
            Layout::Packed => Arrangement::Packed,
            Layout::Batched => Arrangement::Batched,
        },
        shape,
        active: units[0].unit.active,
        systems: &systems,
        units: plan.units,
        threads,
    };
    let only = plan.forces.first().filter(|_| plan.relative);
    if let Some((constant, softening)) = only.and_then(|force| force.as_newtonian()) {
        return Dynamics::closed(few_bodies(&context, constant, softening));
    }
    Dynamics::new(shape, plan.forces.iter().map(|force| force.kernel(&context)).collect())
}
