//! A torque as a formula at work: eight bodies at once from the lanes to its axes and units, through its code, and back.

use super::{Seen, Systems, lane_by_lane};
use crate::expressions::Machine;
use crate::expressions::execute::{self, Part, Scalar};
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::power_of_two::scale;
use crate::rigid::motion::bodies::Start;
use crate::rigid::motion::formula::{Formula, SPIN};
use crate::rigid::motion::loads::Load;
use crate::rigid::motion::vectors::{product, turned, turned_back};
use crate::rigid::quaternion::{Quaternion, conjugate};
use crate::tiered;

/// A formula for one body of each lane.
#[derive(Clone)]
pub(super) struct Expressed {
    body: usize,
    machine: Machine<Lanes>,
    in_body: bool,
    looks_at_velocity: bool,
    /// From the caller's axes in the body to the principal ones.
    axes: [Lanes; 4],
    /// From the formula's axes of space to the scene's, and back.
    space: Quaternion,
    back: Quaternion,
    /// What times and angular velocities are multiplied with, and the time at the start.
    time: f64,
    spin: f64,
    t0: f64,
    /// The unit of torque.
    torque: f64,
}

impl Expressed {
    /// Of the load of that index on the body at a place in each system; `of_system` says what it is in which.
    pub(super) fn new<'a>(
        (formula, in_body): (&Formula, bool),
        (systems, place): (&Systems<'_>, usize),
        of_system: impl Fn(&[Start]) -> &'a Load,
    ) -> Self {
        let Systems { bodies, starts, units, .. } = *systems;
        let own = |system: usize, index: usize| match of_system(&starts[system]) {
            Load::Formula { parameters, .. } => parameters[index],
            _ => 0.0,
        };
        let parameters: Vec<Lanes> = (0..formula.code.parameters())
            .map(|index| lane_by_lane(starts.len(), |system| own(system, index)))
            .collect();
        let axes = |system: usize| conjugate(bodies.axes[starts[system][place].at]);
        Self {
            body: systems.first + place,
            machine: Machine::new(formula.code.clone(), &parameters),
            in_body,
            looks_at_velocity: formula.looks_at_velocity,
            axes: [0, 1, 2, 3].map(|part| lane_by_lane(starts.len(), |system| axes(system)[part])),
            space: formula.axes,
            back: conjugate(formula.axes),
            time: scale(1.0 / formula.time, units.time),
            spin: scale(formula.time, -units.time),
            t0: systems.t0 / formula.time,
            torque: units.take(formula.torque, [2, 1, -2]),
        }
    }

    /// Adds its torque at a time since the start in the units of the integration.
    pub(super) fn apply(&mut self, time: &Lanes, seen: &Seen<'_>, torque: &mut [Lanes]) {
        apply_tier(self, time, seen, torque);
    }
}

tiered! {
    fn apply_tier[][](expressed: &mut Expressed, time: &Lanes, seen: &Seen<'_>, torque: &mut [Lanes]) = apply_body;
}

#[inline(always)]
fn apply_body<V: Vector8 + Scalar>(
    expressed: &mut Expressed,
    time: &Lanes,
    seen: &Seen<'_>,
    torque: &mut [Lanes],
) {
    let Expressed { body, machine, axes, .. } = expressed;
    let (at, of) = (seen.arrangement.at(*body), &seen.arrangement.bodies[*body]);
    let (q, v, torque) = (V::view(seen.q), V::view(seen.v), V::view_mut(torque));
    let principal = [q[at], q[at + 1], q[at + 2], q[at + 3]];
    let axes = [V::load(axes[0]), V::load(axes[1]), V::load(axes[2]), V::load(axes[3])];
    let orientation = product(principal, axes);
    let (code, registers) = machine.parts();
    let outputs = code.output_registers();
    let registers = V::view_mut(registers);
    registers[..SPIN].copy_from_slice(&product(splat(expressed.back), orientation));
    if expressed.looks_at_velocity {
        let mut spin = turned_back(principal, [v[at], v[at + 1], v[at + 2]]);
        for c in 0..3 {
            spin[c] = V::load(of.inverse[c]) * spin[c] * V::splat(expressed.spin);
        }
        registers[SPIN..SPIN + 3].copy_from_slice(&turned_back(axes, spin));
    }
    registers[SPIN + 3] = V::splat(expressed.time).multiply_add(V::load(*time), V::splat(expressed.t0));
    execute::execute::<V, 1>(code, Part::Body, registers);
    let mut found = [V::zero(); 3];
    for c in 0..3 {
        found[c] = registers[usize::from(outputs[c])] * V::splat(expressed.torque);
    }
    let along = if expressed.in_body { orientation } else { splat(expressed.space) };
    let found = turned(along, found);
    for c in 0..3 {
        torque[3 * *body + c] += found[c];
    }
}

#[inline(always)]
fn splat<V: Vector8>(q: Quaternion) -> [V; 4] {
    [V::splat(q[0]), V::splat(q[1]), V::splat(q[2]), V::splat(q[3])]
}
