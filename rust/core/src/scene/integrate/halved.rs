//! Whether equal steps resolve the motion: a step at the start and one at the end, each against two of half its length.
//!
//! The one idea: where the energy tells nothing, the method does. Drag that takes more than all of a velocity in a step,
//! massless bodies, which have no energy, and states in which only the method comes to rest (of a stiff spring, under drag)
//! have in common that half of the step leads elsewhere. Of Runge-Kutta methods, which come to rest where forces do not let
//! them (Iserles, Peplow & Stuart, SIAM J. Numer. Anal. 28 (1991) 1723); splittings never do, and energies tell of them.

use super::super::distance;
use super::super::unit::Prepared;
use super::report::{Ending, Report};
use super::{Job, Result, fixed};
use crate::error::Error;
use crate::forces::Dynamics;
use crate::numerics::lanes::Lanes;
use crate::ode::Scheme;
use crate::ode::state::State;
use crate::ode::stepper::stepper;
use crate::parallel::Ticker;

/// A velocity that is off by this part of itself after one step tells nothing. Oscillations come to that with seven steps to
/// a period by Euler's method, and with three by `rk4`; decays with 0.9 and with 2 times of decay to a step.
const TOLERATED: f64 = 0.2;

/// What a body moves in a step, as a part of its place, may be the rounding of forces that cancel below this.
const ROUNDING: f64 = 1e-9;

/// Six steps more are nothing beside so many.
const MANY_STEPS: u64 = 1_000;
/// Bodies, and pairs of them, of all copies, for which they take no time that anybody sees.
const FEW: u64 = 4_096;

/// A step that does not resolve the motion of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unresolved {
    /// The body.
    pub body: usize,
    /// How far its velocity is off, as a part of it.
    pub error: f64,
    /// Whether it is the step that would follow on the last, and not the first.
    pub at_end: bool,
}

impl Unresolved {
    /// The worse of two.
    pub fn worse(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        a.into_iter().chain(b).reduce(|a, b| if b.error > a.error { b } else { a })
    }
}

/// Whether it is looked for in a run of so many steps.
pub(super) fn pays(job: &Job<'_>, steps: u64) -> bool {
    let plan = job.plan;
    let each = job.scene.particles as u64 + plan.pairs_per_evaluation();
    let few = each.saturating_mul(job.scene.copies as u64) <= FEW;
    let comes_to_rest = matches!(plan.method.scheme, Scheme::RungeKutta(_));
    // A leg between two collisions is no run.
    comes_to_rest && !plan.touching && !plan.turning.steps() && steps > 0 && (few || steps >= MANY_STEPS)
}

/// Tells in the reports of units that have come to the end, in the state `end` at `node`, what does not resolve them.
///
/// # Errors
/// Only errors of the library itself.
pub(super) fn look(
    job: &Job<'_>,
    units: &[Prepared],
    (reports, end, node): (&mut [Report], &State<Lanes>, u64),
    dynamics: &mut Dynamics<Lanes>,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    if reports.iter().all(|report| report.ending != Ending::Finished) {
        return Ok(());
    }
    // What goes on from a node of an earlier run was looked at when that began.
    let start = job.from.is_none().then(|| {
        let mut start = end.clone();
        fixed::lay(job.plan, units, &mut start);
        start
    });
    let steps = [start.as_ref().map(|start| (start, 0, false)), Some((end, node, true))];
    for (before, node, at_end) in steps.into_iter().flatten() {
        let [whole, halves] = match both(job, before, node, dynamics, ticker) {
            Ok(states) => states,
            // Who wants to stop does not wait for this.
            Err(Error::Interrupted) => return Ok(()),
            Err(other) => return Err(other),
        };
        for (lane, (unit, report)) in units.iter().zip(&mut *reports).enumerate() {
            let finished = report.ending == Ending::Finished;
            for slot in unit.unit.recorded.clone().filter(|_| finished) {
                let error = error(unit, (slot, lane), before, [&whole, &halves], job.step());
                if error > TOLERATED {
                    let doubt = Unresolved { body: unit.unit.bodies[slot], error, at_end };
                    report.unresolved = Unresolved::worse(report.unresolved, Some(doubt));
                }
            }
        }
    }
    Ok(())
}

/// The states to which one step leads, and two of half its length.
fn both(
    job: &Job<'_>,
    before: &State<Lanes>,
    node: u64,
    dynamics: &mut Dynamics<Lanes>,
    ticker: &mut Ticker<'_>,
) -> Result<[State<Lanes>; 2]> {
    let [mut whole, mut halves] = [before.clone(), before.clone()];
    let mut step = stepper(job.plan.method, job.step(), dynamics, before)?;
    let mut half = stepper(job.plan.method, 0.5 * job.step(), dynamics, before)?;
    let _one = step.step(node, 1, &mut whole, dynamics, ticker)?;
    for part in 0..2 {
        let _one = half.step(2 * node + part, 1, &mut halves, dynamics, ticker)?;
    }
    Ok([whole, halves])
}

/// How far the velocity of a body is off after a step, as a part of the largest on the way.
fn error(
    unit: &Prepared,
    (slot, lane): (usize, usize),
    before: &State<Lanes>,
    after: [&State<Lanes>; 2],
    step: f64,
) -> f64 {
    let size = |x: [f64; 3]| distance(x, [0.0; 3]);
    let velocity = |state: &State<Lanes>| unit.pick(slot, state.v(), lane);
    let place = |state: &State<Lanes>| size(unit.place(slot, state, lane));
    let [whole, halves] = after.map(velocity);
    if whole.iter().any(|x| !x.is_finite()) {
        return f64::INFINITY;
    }
    let off = distance(whole, halves);
    let largest = size(velocity(before)).max(size(whole)).max(size(halves));
    if off * step.abs() > ROUNDING * place(before).max(place(after[1])) { off / largest } else { 0.0 }
}
