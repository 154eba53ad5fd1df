//! What the error of a step is measured against, lane by lane: each unit brings its own.

use super::super::super::frame::Origin;
use super::super::super::plan::Plan;
use super::super::super::unit::Prepared;
use super::super::Job;
use super::Forces;
use crate::error::Result;
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::ode::norm::{Block, Norm};
use crate::ode::state::State;
use crate::ode::step_control::Clock;
use crate::ode::system::{Form, System};
use crate::parallel::Ticker;
use crate::rigid::motion::system::BodySystem;

/// A body in the very place that distances are measured from has no size to be held to; below this share of the unit's it is
/// as good as there.
const NOTHING: f64 = 1.0 / 1_048_576.0;

/// A tolerance that nothing exceeds.
const UNBOUNDED: f64 = 1e300;

/// Whether sizes are measured from the center of mass of a unit, wherever it goes: of bodies that depend on each other,
/// where no force has a center and some force moves the whole, so that it leaves the origin.
fn from_their_center(plan: &Plan, unit: &Prepared) -> bool {
    unit.unit.active > 1
        && !plan.turning.steps()
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

/// The absolute tolerances of a unit's places or velocities, in its lanes.
fn allow(block: &mut Block<Lanes>, job: &Job<'_>, unit: &Prepared, lanes: Bits) {
    let units = job.plan.units;
    let (size, rounding, exponent) = if block.velocity {
        (unit.size.1, unit.rounding.1, units.velocity())
    } else {
        (unit.size.0, unit.rounding.0, -units.length)
    };
    let given = job.atol.and_then(|atol| atol.kinds()[usize::from(block.velocity)]);
    let at_least = |&atol: &f64| scale(atol, exponent).max(NOTHING * job.rtol * size);
    // A tolerance that nobody asked for is no finer than rounding.
    let own = (job.rtol * size).max(rounding.min(job.asked_rtol * size));
    match given {
        Some(each) if each.len() > 1 => {
            // Lanes without a body are held to what the first is.
            let first = unit.unit.bodies.first().map_or(0.0, |&body| at_least(&each[body]));
            block.atol.resize(unit.shape.rows, Lanes::zero());
            for atol in &mut block.atol {
                *atol = Lanes::select(lanes, Lanes::splat(first), *atol);
            }
            let place = lanes.0.trailing_zeros() as usize;
            for (slot, &body) in unit.unit.bodies.iter().enumerate() {
                let (row, lane) = unit.locate(slot, place);
                block.atol[row].0[lane] = at_least(&each[body]);
            }
        }
        one => {
            let allowed = Lanes::splat(one.and_then(<[f64]>::first).map_or(own, at_least));
            for atol in &mut block.atol {
                *atol = Lanes::select(lanes, allowed, *atol);
            }
        }
    }
}

/// What errors are measured by, of units that lie like that.
pub(super) fn norm(shape: Shape, forces: &mut Forces, rtol: Lanes, together: bool) -> Norm<Lanes> {
    let Forces::Turning(bodies) = forces else {
        return Norm::new(shape, forces.system().form(), rtol, together);
    };
    let mut norm = Norm::new(shape, Form::SecondOrder(shape.len()), rtol, together);
    let half = bodies.form().len() / 2;
    let first = norm.blocks[0].clone();
    norm.blocks[1].start = half;
    // A quaternion is measured against its length, which is 1.
    for (from, components) in [(0, 4), (half, 3)] {
        let arrangement = bodies.arrangement();
        norm.blocks.extend((0..arrangement.bodies.len()).map(|body| Block {
            start: from + arrangement.at(body),
            shape: Shape { rows: 1, components },
            ..first.clone()
        }));
    }
    norm
}

/// Leaves out the centers of held bodies, which are where orientations have them: rounding of places far from the origin, and of
/// velocities that are slow beside the spin, is no error of theirs.
pub(super) fn leave_out_held(norm: &mut Norm<Lanes>, bodies: &BodySystem) {
    for block in norm.blocks.iter_mut().take(2) {
        if bodies.arrangement().held().next().is_some() {
            let all = block.atol[0];
            block.atol.resize(block.shape.rows, all);
        }
        for row in bodies.arrangement().held() {
            block.atol[row] = Lanes::splat(UNBOUNDED);
        }
    }
}

/// Allows the momenta of bodies that begin a part of what they are, or come to be: by the spin that they have, by that which
/// a torque gives them while it turns them by a radian, or by a radian in all of the run.
///
/// # Errors
/// Those of an evaluation.
pub(super) fn set_momenta(
    norm: &mut Norm<Lanes>,
    bodies: &mut BodySystem,
    (state, clock): (&State<Lanes>, &Clock<Lanes>),
    fresh: Bits,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    let (y, _) = state.all();
    let mut rate = vec![Lanes::zero(); y.len()];
    bodies.rate(&clock.elapsed, y, &mut rate, ticker)?;
    let span = (clock.end - clock.elapsed).abs();
    let length = |[x, y, z]: [Lanes; 3]| (x * x + y * y + z * z).sqrt();
    let count = bodies.arrangement().bodies.len();
    let from = norm.blocks.len() - count;
    for (block, of) in norm.blocks[from..].iter_mut().zip(bodies.arrangement().bodies.iter()) {
        let vector = |of: &[Lanes]| length([of[block.start], of[block.start + 1], of[block.start + 2]]);
        let moment = of.moments[0].max(of.moments[1]).max(of.moments[2]);
        let size = vector(y).max((moment * vector(&rate)).sqrt()).max(moment / span);
        block.atol[0] = Lanes::select(fresh, norm.rtol * size, block.atol[0]);
    }
    Ok(())
}

/// Takes over a unit's measures for its lanes. Without `atol` the tolerance is scale-free: relative to the unit's size.
pub(in crate::scene::integrate) fn set(norm: &mut Norm<Lanes>, job: &Job<'_>, unit: &Prepared, lanes: Bits) {
    if from_their_center(job.plan, unit) {
        weigh(norm, unit, lanes);
    }
    let set = |into: &mut Lanes, value: f64| *into = Lanes::select(lanes, Lanes::splat(value), *into);
    // Places and velocities; how bodies turn is measured against that alone.
    for block in norm.blocks.iter_mut().take(2) {
        allow(block, job, unit, lanes);
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
