//! A torque as a formula at work: eight bodies at once from the lanes to its axes and units, through its code, and back.

use super::{Seen, Systems, lane_by_lane};
use crate::expressions::Machine;
use crate::expressions::execute::{self, Part, Scalar};
use crate::narrow::Features;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::power_of_two::scale;
use crate::rigid::motion::bodies::{LaneBody, Start};
use crate::rigid::motion::formula::{Formula, VARIABLES};
use crate::rigid::motion::loads::Load;
use crate::rigid::motion::vectors::{product, turned, turned_back};
use crate::rigid::quaternion::{Quaternion, conjugate};
use crate::tiered;
use std::sync::Arc;

/// A formula for one body of each lane.
#[derive(Clone)]
pub(super) struct Expressed {
    pub(super) way: Way,
    machine: Machine<Lanes>,
    in_body: bool,
    /// From the formula's axes of space to the scene's.
    space: Quaternion,
    /// The unit of torque.
    pub(super) torque: f64,
    /// What may be too narrow for a step, and the parameters.
    pub(super) narrow: Option<Arc<Features>>,
    pub(super) parameters: Vec<Lanes>,
}

/// The way from the units and axes of the integration to those of the formula.
#[derive(Clone)]
pub(super) struct Way {
    pub(super) body: usize,
    /// From the caller's axes in the body to the principal ones.
    pub(super) axes: [Lanes; 4],
    /// From the scene's axes of space to the formula's.
    pub(super) back: Quaternion,
    /// What times and angular velocities are multiplied with, and the time at the start.
    pub(super) time: f64,
    pub(super) spin: f64,
    pub(super) t0: f64,
}

impl Way {
    /// The orientation of the caller's axes in the scene, and what the formula looks at: that in its own space, and the angular
    /// velocity along them.
    #[inline(always)]
    pub(super) fn seen<V: Vector8>(
        &self,
        of: &LaneBody,
        q: [V; 4],
        momentum: [V; 3],
    ) -> ([V; 4], [V; VARIABLES]) {
        let axes = loaded(&self.axes);
        let orientation = product(q, axes);
        let [x, y, z, w] = product(splat(self.back), orientation);
        let mut spin = turned_back(q, momentum);
        for c in 0..3 {
            spin[c] = V::load(of.inverse[c]) * spin[c] * V::splat(self.spin);
        }
        let [a, b, c] = turned_back(axes, spin);
        (orientation, [x, y, z, w, a, b, c])
    }
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
            way: Way {
                body: systems.first + place,
                axes: [0, 1, 2, 3].map(|part| lane_by_lane(starts.len(), |system| axes(system)[part])),
                back: conjugate(formula.axes),
                time: scale(1.0 / formula.time, units.time),
                spin: scale(formula.time, -units.time),
                t0: systems.t0 / formula.time,
            },
            machine: Machine::new(formula.code.clone(), &parameters),
            in_body,
            space: formula.axes,
            torque: units.take(formula.torque, [2, 1, -2]),
            narrow: formula.narrow.clone(),
            parameters,
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
    let Expressed { way, machine, .. } = expressed;
    let (at, of) = (seen.arrangement.at(way.body), &seen.arrangement.bodies[way.body]);
    let (q, v, torque) = (V::view(seen.q), V::view(seen.v), V::view_mut(torque));
    let (orientation, numbers) =
        way.seen(of, [q[at], q[at + 1], q[at + 2], q[at + 3]], [v[at], v[at + 1], v[at + 2]]);
    let (code, registers) = machine.parts();
    let outputs = code.output_registers();
    let registers = V::view_mut(registers);
    registers[..VARIABLES].copy_from_slice(&numbers);
    registers[VARIABLES] = V::splat(way.time).multiply_add(V::load(*time), V::splat(way.t0));
    execute::execute::<V, 1>(code, Part::Body, registers);
    let mut found = [V::zero(); 3];
    for c in 0..3 {
        found[c] = registers[usize::from(outputs[c])] * V::splat(expressed.torque);
    }
    let along = if expressed.in_body { orientation } else { splat(expressed.space) };
    let found = turned(along, found);
    for c in 0..3 {
        torque[3 * way.body + c] += found[c];
    }
}

#[inline(always)]
pub(super) fn loaded<V: Vector8>(q: &[Lanes; 4]) -> [V; 4] {
    [V::load(q[0]), V::load(q[1]), V::load(q[2]), V::load(q[3])]
}

#[inline(always)]
pub(super) fn splat<V: Vector8>(q: Quaternion) -> [V; 4] {
    [V::splat(q[0]), V::splat(q[1]), V::splat(q[2]), V::splat(q[3])]
}
