//! What units hold at a node: laid into lanes to go on with, and read off where a run ends.

use super::super::continuation::{Continuation, UnitHeld, blocks as blocks_of};
use super::super::unit::Prepared;
use super::{Ending, Job, Report};
use crate::numerics::lanes::Lanes;
use crate::ode::Method;
use crate::ode::state::State;
use crate::ode::stepper::Stepper;

/// Goes over the blocks of a state and of a stepper at a node.
fn blocks(
    node: u64,
    state: &mut State<Lanes>,
    stepper: &mut dyn Stepper<Lanes>,
    each: &mut dyn FnMut(&mut [Lanes]),
) {
    let ((q, q_rest), (v, v_rest)) = state.halves_mut();
    [q, q_rest, v, v_rest].into_iter().for_each(&mut *each);
    stepper.memory(node, each);
}

/// Puts state and stepper where they were at the node of the plan.
pub(super) fn take_up(
    job: &Job<'_>,
    (from, members): (&Continuation, Option<&[usize]>),
    units: &[Prepared],
    state: &mut State<Lanes>,
    stepper: &mut dyn Stepper<Lanes>,
) {
    stepper.restart();
    let plan = job.plan;
    let mut block = 0;
    blocks(plan.from, state, stepper, &mut |numbers| {
        for lane in 0..units.len().next_multiple_of(plan.layout.units()) {
            let unit = &units[lane.min(units.len() - 1)];
            let copy = members.map_or(unit.unit.copy, |members| members[unit.unit.copy]);
            for slot in 0..unit.held() {
                let point = from.point(plan, job.scene.particles, (copy, &unit.unit), block, slot);
                unit.lay_held(slot, numbers, lane, point);
            }
        }
        block += 1;
    });
}

/// Tells what the units that have come to a node hold there.
pub(super) fn leave(
    method: &Method,
    units: &[Prepared],
    reports: &mut [Report],
    node: u64,
    state: &mut State<Lanes>,
    stepper: &mut dyn Stepper<Lanes>,
) {
    for (unit, report) in units.iter().zip(reports.iter_mut()) {
        if matches!(report.ending, Ending::Finished | Ending::TooManySteps | Ending::Interrupted) {
            report.held =
                Some(UnitHeld { node, points: Vec::with_capacity(blocks_of(method) * unit.held()) });
        }
    }
    blocks(node, state, stepper, &mut |numbers| {
        for (lane, (unit, report)) in units.iter().zip(reports.iter_mut()).enumerate() {
            if let Some(held) = &mut report.held {
                held.points.extend((0..unit.held()).map(|slot| unit.pick_held(slot, numbers, lane)));
            }
        }
    });
}
