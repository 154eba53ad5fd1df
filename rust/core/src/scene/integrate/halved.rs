//! Whether equal steps resolve the motion: a step at the start and one at the end, each against two of half its length.
//!
//! The one idea: where the energy tells nothing, the method does. Drag that takes more than all of a velocity in a step,
//! massless bodies, which have no energy, forces of the time, which give any, and states in which only the method comes to
//! rest (of a stiff spring, under drag) have in common that half of the step leads elsewhere. Runge-Kutta methods come to
//! rest where forces do not let them (Iserles, Peplow & Stuart, SIAM J. Numer. Anal. 28 (1991) 1723); splittings never do,
//! and what energies tell of them is enough.
//!
//! Two things are no matter of a step. A multistep method may be unstable where the one-step method that starts it is not:
//! at the end it is compared with that. And of a drive that is faster than steps any two may see the same force: [`drives`].

mod drives;

use super::super::distance;
use super::super::unit::Prepared;
use super::report::{Ending, Report};
use super::{Job, Result, fixed};
use crate::error::Error;
use crate::forces::Dynamics;
use crate::forces::together::Energy;
use crate::numerics::lanes::Lanes;
use crate::ode::Scheme;
use crate::ode::state::State;
use crate::ode::stepper::{Stepper, stepper};
use crate::parallel::Ticker;

/// A velocity that is off by this part of itself after one step tells nothing. Oscillations come to that with seven steps to
/// a period by Euler's method, and with three by `rk4`; decays with 0.9 and with 2 times of decay to a step.
const TOLERATED: f64 = 0.2;

/// What a body moves in a step, as a part of its place, may be the rounding of forces that cancel below this, …
const ROUNDING: f64 = 1e-9;
/// … and as a part of the farthest place of all.
const ROUNDING_OF_ALL: f64 = 1e-12;

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
    /// What tells.
    pub by: Evidence,
}

/// What tells that a step does not resolve a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// The first step.
    FirstStep,
    /// The one that would follow on the last.
    StepFromTheEnd,
    /// A drive with less than two steps to a period.
    Drive,
}

impl Evidence {
    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FirstStep => "first_step",
            Self::StepFromTheEnd => "step_from_the_end",
            Self::Drive => "drive",
        }
    }
}

impl Unresolved {
    /// The worse of two.
    pub fn worse(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        a.into_iter().chain(b).reduce(|a, b| if b.error > a.error { b } else { a })
    }
}

/// Whether it is looked for in a run of so many steps: where energies do not tell, or not everything.
pub(super) fn pays(job: &Job<'_>, steps: u64) -> bool {
    let plan = job.plan;
    let each = job.scene.particles as u64 + plan.pairs_per_evaluation();
    let few = each.saturating_mul(job.scene.copies as u64) <= FEW;
    let comes_to_rest = matches!(plan.method.scheme, Scheme::RungeKutta(_));
    // Last, as it looks at all bodies, for each of the thousands of chunks that as many may make.
    let untold =
        || matches!(plan.energy, Energy::Unknown | Energy::Driven) || job.scene.masses(0).contains(&0.0);
    // A leg between two collisions is no run.
    let is_run = !plan.touching && !plan.turning.steps() && steps > 0;
    is_run && (few || steps >= MANY_STEPS) && (comes_to_rest || untold())
}

/// Tells in the reports of units that have come to the end, in the state `end` at `node`, what does not resolve them. The
/// method is there, too, and is taken on.
///
/// # Errors
/// Only errors of the library itself.
pub(super) fn look(
    job: &Job<'_>,
    units: &[Prepared],
    (reports, end, node): (&mut [Report], &State<Lanes>, u64),
    method: &mut dyn Stepper<Lanes>,
    dynamics: &mut Dynamics<Lanes>,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    if reports.iter().all(|report| report.ending != Ending::Finished) {
        return Ok(());
    }
    match pairs(job, units, (end, node), method, dynamics, ticker) {
        Ok(pairs) => {
            let finished = units.iter().zip(reports).enumerate();
            let finished = finished.filter(|(_, (_, report))| report.ending == Ending::Finished);
            for (lane, (unit, report)) in finished {
                let seen: Vec<_> = pairs.iter().map(|pair| (pair, pair.farthest(unit, lane))).collect();
                for slot in unit.unit.recorded.clone() {
                    let usual = usual_speed(job, unit, (slot, lane), end, report.counts.steps);
                    let by_pair = |&(pair, farthest): &(&Pair, f64)| {
                        (pair.error(unit, (slot, lane), (usual, farthest), job.step()), pair.by)
                    };
                    let by_drive =
                        (drives::error(job, unit, (slot, lane), end, report.counts.steps), Evidence::Drive);
                    let found = seen.iter().map(by_pair).chain([by_drive]);
                    for (error, by) in found.filter(|&(error, _)| error > TOLERATED) {
                        let doubt = Unresolved { body: unit.unit.bodies[slot], error, by };
                        report.unresolved = Unresolved::worse(report.unresolved, Some(doubt));
                    }
                }
            }
            Ok(())
        }
        // Who wants to stop does not wait for this.
        Err(Error::Interrupted) => Ok(()),
        Err(other) => Err(other),
    }
}

/// Two ways from one state over the time of a step, which lead to the same if it resolves the motion.
struct Pair {
    by: Evidence,
    before: State<Lanes>,
    after: [State<Lanes>; 2],
}

/// How fast a body is in a run, as a measure for its first step and for one from its end.
#[derive(Clone, Copy)]
struct Usual {
    at_start: f64,
    at_end: f64,
}

/// Those that are looked at in a run.
fn pairs(
    job: &Job<'_>,
    units: &[Prepared],
    (end, node): (&State<Lanes>, u64),
    method: &mut dyn Stepper<Lanes>,
    dynamics: &mut Dynamics<Lanes>,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Pair>> {
    let mut pairs = Vec::new();
    // What goes on from a node of an earlier run was looked at when that began.
    if job.from.is_none() {
        let mut start = end.clone();
        fixed::lay(job.plan, units, &mut start);
        for after in halved(job, &start, 0, dynamics, ticker)? {
            pairs.push(Pair { by: Evidence::FirstStep, before: start.clone(), after });
        }
    }
    for after in halved(job, end, node, dynamics, ticker)? {
        pairs.push(Pair { by: Evidence::StepFromTheEnd, before: end.clone(), after });
    }
    if matches!(job.plan.method.scheme, Scheme::Multistep(_)) {
        let [mut own, mut begun] = [end.clone(), end.clone()];
        method.between(node, job.step(), &mut begun, dynamics, ticker)?;
        let _one = method.step(node, 1, &mut own, dynamics, ticker)?;
        method.settle(&mut own);
        pairs.push(Pair { by: Evidence::StepFromTheEnd, before: end.clone(), after: [own, begun] });
    }
    Ok(pairs)
}

/// The states to which one step leads, and two of half its length. Of a method of first order two steps and four, too: it moves
/// bodies at rest from where they are, which forces notice in the next one.
fn halved(
    job: &Job<'_>,
    before: &State<Lanes>,
    node: u64,
    dynamics: &mut Dynamics<Lanes>,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<[State<Lanes>; 2]>> {
    let [mut whole, mut halves] = [before.clone(), before.clone()];
    let mut step = stepper(job.plan.method, job.step(), dynamics, before)?;
    let mut half = stepper(job.plan.method, 0.5 * job.step(), dynamics, before)?;
    let steps = if job.plan.method.order == 1 { 2 } else { 1 };
    let mut all = Vec::with_capacity(steps);
    for part in 0..steps as u64 {
        let _one = step.step(node + part, 1, &mut whole, dynamics, ticker)?;
        for part in 2 * part..2 * part + 2 {
            let _one = half.step(2 * node + part, 1, &mut halves, dynamics, ticker)?;
        }
        let mut reached = [whole.clone(), halves.clone()];
        let [by_whole, by_halves] = &mut reached;
        step.settle(by_whole);
        half.settle(by_halves);
        all.push(reached);
    }
    Ok(all)
}

impl Pair {
    /// How far apart they are in the velocity of a body, as a part of the largest on the way, or of what is usual.
    fn error(
        &self,
        unit: &Prepared,
        (slot, lane): (usize, usize),
        (usual, farthest): (Usual, f64),
        step: f64,
    ) -> f64 {
        let velocity = |state: &State<Lanes>| unit.pick(slot, state.v(), lane);
        let [one, other] = [&self.after[0], &self.after[1]].map(velocity);
        if one.iter().any(|x| !x.is_finite()) {
            return f64::INFINITY;
        }
        let off = distance(one, other);
        let speeds = [velocity(&self.before), one, other].map(|v| speed(unit, v));
        let usual = if self.by == Evidence::FirstStep { usual.at_start } else { usual.at_end };
        let largest = speeds.into_iter().fold(usual, f64::max);
        let known = (ROUNDING * self.place(unit, slot, lane)).max(ROUNDING_OF_ALL * farthest);
        if off * step.abs() > known { off / largest } else { 0.0 }
    }
    /// How far from the origin a body is.
    fn place(&self, unit: &Prepared, slot: usize, lane: usize) -> f64 {
        let [before, after] = [&self.before, &self.after[0]].map(|state| size(unit.place(slot, state, lane)));
        before.max(after)
    }
    /// How far the farthest is.
    fn farthest(&self, unit: &Prepared, lane: usize) -> f64 {
        (0..unit.unit.bodies.len()).map(|slot| self.place(unit, slot, lane)).fold(0.0, f64::max)
    }
}

/// How fast a body is that may stand still at both ends of a run: what is lost there of what hardly moves is nothing. It is as
/// fast as at the end, as it was in the mean, or, where nothing hinders them, as drives make it. Under drag what comes to rest
/// at the end is measured by itself: the steps of a method may rest where bodies do not.
fn usual_speed(
    job: &Job<'_>,
    unit: &Prepared,
    (slot, lane): (usize, usize),
    end: &State<Lanes>,
    steps: u64,
) -> Usual {
    let span = steps as f64 * job.step().abs();
    let mean = distance(unit.place(slot, end, lane), unit.position[slot]) / span;
    let on_the_way = mean.max(drives::speed(job, unit, slot, span));
    Usual {
        at_start: on_the_way.max(speed(unit, unit.pick(slot, end.v(), lane))),
        at_end: if job.plan.energy == Energy::Driven { on_the_way } else { 0.0 },
    }
}

/// How fast a body is: among others, beside them; alone, in the scene, and not beside the origin that goes along with it.
fn speed(unit: &Prepared, velocity: [f64; 3]) -> f64 {
    if unit.unit.bodies.len() > 1 {
        return size(velocity);
    }
    let drift = unit.drift();
    size(core::array::from_fn(|c| velocity[c] + drift[c]))
}

fn size(x: [f64; 3]) -> f64 {
    distance(x, [0.0; 3])
}
