//! The forces of a scene over lanes: each described force becomes the kernel for the layout and the size.

use super::{Layout, Plan, Prepared};
use crate::forces::context::{Arrangement, Context, System};
use crate::forces::gravity::newton::few_bodies;
use crate::forces::monitor::InverseDistances;
use crate::forces::{Dynamics, Force};
use crate::numerics::lanes::Lanes;

/// The forces on massless bodies, one in each lane, that do not couple them to others; `None` in the place of gravity.
pub fn uncoupled(plan: &Plan, units: &[&Prepared]) -> Vec<Option<Box<dyn Force<Lanes>>>> {
    let systems: Vec<System<'_>> =
        units.iter().map(|unit| System { bodies: &unit.unit.bodies, mass: &unit.mass }).collect();
    let context = Context {
        arrangement: Arrangement::Batched,
        shape: units[0].state_shape(units.len()),
        active: 0,
        systems: &systems,
        units: plan.units,
        t0: plan.t0,
        threads: 1,
    };
    let forces = plan.forces.iter();
    forces.map(|force| force.as_newtonian().is_none().then(|| force.kernel(&context))).collect()
}

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
        t0: plan.t0,
        threads,
    };
    let newtonian = plan.forces.first().and_then(|force| force.as_newtonian());
    if let (true, Some((constant, softening))) = (plan.relative, newtonian) {
        return Dynamics::closed(few_bodies(&context, constant, softening));
    }
    let dynamics = Dynamics::new(shape, plan.forces.iter().map(|force| force.kernel(&context)).collect());
    match plan.transformed {
        None => dynamics,
        Some((by, _)) => dynamics.watched_by(Box::new(InverseDistances::new(by, &plan.forces, &context))),
    }
}
