//! The forces of a scene over lanes: each described force becomes the kernel for the layout and the size.

use super::{Layout, Plan, Prepared};
use crate::forces::context::{Arrangement, Context, System};
use crate::forces::derivative::Derivative;
use crate::forces::gravity::newton::few_bodies;
use crate::forces::monitor::InverseDistances;
use crate::forces::series::Series;
use crate::forces::term::Coupling;
use crate::forces::{Dynamics, Force, ForceTerm};
use crate::numerics::lanes::Lanes;
use crate::ode::Scheme;
use std::sync::Arc;

/// A force, and the same as a series if it has one and the method asks for it.
pub type Kernel = (Box<dyn Force<Lanes>>, Option<Box<dyn Series<Lanes>>>);

/// The systems that units are, each with its own forces.
fn systems<'a>(plan: &'a Plan, units: &'a [&Prepared]) -> Vec<System<'a>> {
    let system = |unit: &&'a Prepared| System {
        bodies: &unit.unit.bodies,
        mass: &unit.mass,
        forces: plan.forces_of(unit.unit.copy),
    };
    units.iter().map(system).collect()
}

/// What a kernel for all systems is made of: the forces on the first of them, which say what all have alike.
fn described<'a>(systems: &[System<'a>]) -> impl Iterator<Item = (usize, &'a Arc<dyn ForceTerm>)> {
    systems.first().map_or(&[][..], |system| system.forces).iter().enumerate()
}

/// A force as a series: if it has not in every lane what the kernel has, of the forces on the first copy, without a look at
/// another's.
fn series(force: &Arc<dyn ForceTerm>, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
    if force.series_in_every_lane() {
        return force.series(context);
    }
    let alike: Vec<System<'_>> =
        context.systems.iter().map(|system| System { forces: &[], ..*system }).collect();
    force.series(&Context { systems: &alike, ..*context })
}

/// The forces on massless bodies, one in each lane, that do not couple them to others; `None` in the place of
/// one that does.
pub fn uncoupled(plan: &Plan, units: &[&Prepared]) -> Vec<Option<Kernel>> {
    let systems = systems(plan, units);
    let mut context = Context {
        arrangement: Arrangement::Batched,
        shape: units[0].state_shape(units.len()),
        active: 0,
        systems: &systems,
        term: 0,
        units: plan.units,
        t0: plan.t0,
        threads: 1,
        equal_steps: !plan.method.adaptive(),
    };
    let expands = matches!(plan.method.scheme, Scheme::Taylor(_));
    let kernel = |(term, force): (usize, &Arc<dyn ForceTerm>)| {
        if force.coupling() == Coupling::AllPairs {
            return None;
        }
        context.term = term;
        let series = if expands { series(force, &context) } else { None };
        Some((force.kernel(&context), series))
    };
    described(&systems).map(kernel).collect()
}

/// What kernels for units of the same make-up are made for.
fn context<'a>(plan: &Plan, units: &[&Prepared], systems: &'a [System<'a>], threads: usize) -> Context<'a> {
    Context {
        arrangement: match units[0].layout {
            Layout::Packed => Arrangement::Packed,
            Layout::Batched => Arrangement::Batched,
        },
        shape: units[0].state_shape(units.len()),
        active: units[0].unit.active,
        systems,
        term: 0,
        units: plan.units,
        t0: plan.t0,
        threads,
        equal_steps: !plan.method.adaptive(),
    }
}

/// How forces change along a direction, and those that do not know it, if there are any.
pub type Derivatives = (Vec<Box<dyn Derivative<Lanes>>>, Option<Dynamics<Lanes>>);

/// How the forces on `units` change along a direction, and the forces that do not know it, if there are any.
pub fn derivatives(plan: &Plan, units: &[&Prepared], threads: usize) -> Derivatives {
    let systems = systems(plan, units);
    let mut context = context(plan, units, &systems, threads);
    let (mut known, mut others) = (Vec::new(), Vec::new());
    for (term, force) in described(&systems) {
        if units.iter().any(|unit| plan.acts_on(term, &unit.unit.bodies)) {
            context.term = term;
            match force.derivative(&context) {
                Some(derivative) => known.push(derivative),
                None => others.push(force.kernel(&context)),
            }
        }
    }
    let others = (!others.is_empty()).then(|| Dynamics::new(context.shape, others));
    (known, others)
}

/// The forces on `units` of the same make-up: one if packed, up to eight for each block of rows if batched.
pub fn dynamics(plan: &Plan, units: &[&Prepared], threads: usize) -> Dynamics<Lanes> {
    let systems = systems(plan, units);
    let mut context = context(plan, units, &systems, threads);
    if let (true, Some(few)) = (plan.relative, few_bodies(&context)) {
        return Dynamics::closed(few);
    }
    let forces = systems.first().map_or(&[][..], |system| system.forces);
    let mut kernels = Vec::with_capacity(forces.len());
    if let [one, other, ..] = forces {
        // Which of two comes first their sum does not tell.
        kernels.extend(one.kernel_after(&**other, &context));
        if kernels.is_empty() {
            context.term = 1;
            kernels.extend(other.kernel_after(&**one, &context));
        }
    }
    let taken = 2 * kernels.len();
    for (term, force) in forces.iter().enumerate().skip(taken) {
        if !units.iter().any(|unit| plan.acts_on(term, &unit.unit.bodies)) {
            continue;
        }
        context.term = term;
        kernels.push(force.kernel(&context));
    }
    let dynamics = Dynamics::new(context.shape, kernels);
    if matches!(plan.method.scheme, Scheme::Taylor(_)) {
        let mut all = Vec::with_capacity(forces.len());
        for (term, force) in forces.iter().enumerate() {
            context.term = term;
            all.extend(series(force, &context));
        }
        return dynamics.with_series(all);
    }
    match plan.transformed {
        None => dynamics,
        Some((by, _)) => dynamics.watched_by(Box::new(InverseDistances::new(by, forces, &context))),
    }
}
