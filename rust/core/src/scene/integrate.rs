//! The doing of an integration: units into lanes, steps, records; a status for each unit.
//!
//! Fixed steps run eight units in lockstep. Adaptive steps run eight units each at its own pace; when one
//! ends, the next takes its lane. What a unit gives depends on nothing but the unit.

use super::columns::Writer;
use super::layout::Layout;
use super::plan::Plan;
use super::unit::{self, Prepared, Unit};
use super::{Scene, distance};
use crate::error::{Error, Result};
use crate::forces::Dynamics;
use crate::integrators::adaptive::{Adaptive, Clock, Outcome, Reference, Tolerance};
use crate::integrators::fixed::{self, Place};
use crate::integrators::state::State;
use crate::integrators::{Embedded, Scheme};
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::{Mask, Real};
use crate::parallel::{Ticker, for_chunks};

/// Units that one thread takes at a time: enough that lanes seldom run dry, few enough for balance.
const UNITS_PER_CHUNK: usize = 256;

/// Units of progress of an adaptive unit.
const THOUSANDTHS: u64 = 1000;

/// How a unit ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// At the last output time.
    Finished,
    /// The step fell to zero between two bodies (indices in the scene).
    CloseEncounter {
        /// The bodies; equal for a fixed centre.
        bodies: (usize, usize),
        /// Their distance.
        distance: f64,
    },
    /// The state became infinite or undefined.
    NotFinite,
    /// The most steps allowed were taken.
    TooManySteps,
    /// The caller asked to stop.
    Interrupted,
}

/// What became of a unit.
#[derive(Clone, Debug)]
pub struct Report {
    /// The unit.
    pub unit: Unit,
    /// How it ended.
    pub ending: Ending,
    /// Output times recorded.
    pub rows: usize,
    /// Steps taken.
    pub steps: u64,
    /// Steps rejected.
    pub rejected: u64,
    /// Force evaluations.
    pub evaluations: u64,
    /// The time reached.
    pub time: f64,
    /// Final positions of the recorded bodies.
    pub position: Vec<[f64; 3]>,
    /// Final velocities of the recorded bodies.
    pub velocity: Vec<[f64; 3]>,
}

/// What all units of a run share.
pub struct Job<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its plan.
    pub plan: &'a Plan,
    /// Output times.
    pub times: &'a [f64],
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance in the scene's units.
    pub atol: Option<f64>,
    /// Longest step.
    pub max_step: f64,
    /// Most steps.
    pub max_steps: u64,
    /// Where the records go.
    pub writer: &'a Writer<'a>,
}

/// Runs all units of a plan; the reports come in no particular order.
///
/// # Errors
/// Only errors of the library itself: how a unit ended is in its report.
pub fn run(job: &Job<'_>, ticker: &mut Ticker<'_>) -> Result<Vec<Report>> {
    let mut units = job.plan.unit_list();
    // Units share lanes with units of the same make-up; massive bodies alone differ from those with
    // massless ones beside them.
    units.sort_by_key(|unit| (unit.active, unit.bodies.len()));
    let (over, inside) = job.plan.threads;
    let lanes = job.plan.layout.units();
    let per_chunk = units.len().div_ceil(lanes * over * 4).clamp(1, UNITS_PER_CHUNK / WIDTH) * lanes;
    let mut runs: Vec<&[Unit]> = Vec::new();
    for run in units.chunk_by(|a, b| {
        job.plan.layout == Layout::Packed || (a.active, a.bodies.len()) == (b.active, b.bodies.len())
    }) {
        runs.extend(run.chunks(per_chunk));
    }
    ticker.control().set_total(total_progress(job, units.len(), lanes));
    let reports = for_chunks(over, runs.len(), ticker, |chunk, ticker| match &job.plan.method.scheme {
        Scheme::Embedded(method) => adaptive(job, method, runs[chunk], inside, ticker),
        _ => fixed_steps(job, runs[chunk], inside, ticker),
    })?;
    Ok(reports.into_iter().flatten().collect())
}

/// Progress is counted in steps if they are fixed, else in thousandths of each unit's time.
fn total_progress(job: &Job<'_>, units: usize, lanes: usize) -> u64 {
    let span = (job.times[job.times.len() - 1] - job.scene.t0).abs();
    match job.plan.dt {
        Some(dt) => units.div_ceil(lanes) as u64 * (span / dt.abs()) as u64,
        None => THOUSANDTHS * units as u64,
    }
}

fn prepare(job: &Job<'_>, unit: &Unit) -> Prepared {
    Prepared::new(job.plan, job.scene, unit.clone())
}

fn report(job: &Job<'_>, unit: &Prepared, state: &State<Lanes>, lane: usize, time: f64) -> Report {
    let (mut position, mut velocity) = (Vec::new(), Vec::new());
    for slot in unit.unit.recorded.clone() {
        let elapsed = time - job.scene.t0;
        let entry = unit.read(slot, state, lane, elapsed);
        position.push(entry.position);
        velocity.push(entry.velocity);
    }
    Report {
        unit: unit.unit.clone(),
        ending: Ending::Finished,
        rows: 0,
        steps: 0,
        rejected: 0,
        evaluations: 0,
        time,
        position,
        velocity,
    }
}

fn fixed_steps(
    job: &Job<'_>,
    units: &[Unit],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Report>> {
    let lanes = job.plan.layout.units();
    let mut reports = Vec::with_capacity(units.len());
    for group in units.chunks(lanes) {
        reports.extend(fixed_group(job, group, threads, ticker)?);
    }
    Ok(reports)
}

/// Up to eight units in lockstep.
fn fixed_group(
    job: &Job<'_>,
    units: &[Unit],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Report>> {
    let plan = job.plan;
    let prepared: Vec<Prepared> = units.iter().map(|unit| prepare(job, unit)).collect();
    let views: Vec<&Prepared> = prepared.iter().collect();
    let mut dynamics = unit::dynamics(plan, &views, threads);
    let mut state = prepared[0].blank_state();
    let lanes = plan.layout.units();
    for lane in 0..lanes {
        // Lanes without a unit run along with a copy of the last.
        prepared[lane.min(units.len() - 1)].write(&mut state, lane);
    }
    let dt = plan.dt.unwrap_or(plan.direction);
    let t0 = job.scene.t0;
    let places = job.times.iter().map(|&t| {
        let place = fixed::place(t - t0, dt, t.abs().max(t0.abs()));
        Place { past: place.past.map(|past| scale(past, -plan.units.time)), ..place }
    });
    let h = scale(dt, -plan.units.time);
    let max_steps = job.max_steps;
    let mut failed: Vec<Option<usize>> = vec![None; units.len()];
    let mut rows = 0;
    let mut last = None;
    let (taken, outcome) =
        fixed::run(plan.method, h, max_steps, &mut state, &mut dynamics, places, ticker, |index, state| {
            let t = job.times[index];
            for (lane, unit) in prepared.iter().enumerate() {
                if failed[lane].is_none() && !unit.record(job.writer, index, state, lane, t - t0) {
                    failed[lane] = Some(index);
                }
            }
            rows = index + 1;
            if index + 1 == job.times.len() {
                last = Some(state.clone());
            }
            if failed.iter().all(Option::is_some) {
                return Err(Error::Convergence { message: "not finite".to_owned(), time: t });
            }
            Ok(())
        });
    let interrupted = match outcome {
        Ok(()) | Err(Error::Convergence { .. }) => false,
        Err(Error::Interrupted) => true,
        Err(other) => return Err(other),
    };
    let complete = last.is_some();
    let time = if complete { job.times[job.times.len() - 1] } else { t0 + taken as f64 * dt };
    let end = last.unwrap_or(state);
    let evaluations = dynamics.evaluations;
    Ok(prepared
        .iter()
        .enumerate()
        .map(|(lane, unit)| {
            let ending = match failed[lane] {
                Some(_) => Ending::NotFinite,
                None if interrupted => Ending::Interrupted,
                None if !complete => Ending::TooManySteps,
                None => Ending::Finished,
            };
            let rows = failed[lane].unwrap_or(rows);
            Report { ending, rows, steps: taken, evaluations, ..report(job, unit, &end, lane, time) }
        })
        .collect())
}

/// A lane (all lanes, if packed) and the unit that is in it.
struct Slot {
    unit: Prepared,
    index: usize,
    next_output: usize,
    steps: u64,
    rejected: u64,
    evaluations: u64,
    /// Thousandths of its time that were counted as progress.
    progress: u64,
}

/// The lanes of an adaptive run.
struct Slots<'a> {
    job: &'a Job<'a>,
    slots: [Option<Slot>; WIDTH],
    /// Output times as elapsed time in the plan's units.
    outputs: Vec<f64>,
}

impl Slots<'_> {
    fn mask(&self, lane: usize) -> Bits {
        self.job.plan.layout.mask(lane)
    }
    fn running(&self) -> Bits {
        let lanes = self.slots.iter().enumerate().filter(|(_, slot)| slot.is_some());
        lanes.fold(Bits(0), |mask, (lane, _)| mask.or(self.mask(lane)))
    }
    fn end(&self) -> f64 {
        self.outputs[self.outputs.len() - 1]
    }
}

fn adaptive(
    job: &Job<'_>,
    method: &Embedded,
    units: &[Unit],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Report>> {
    let plan = job.plan;
    let t0 = job.scene.t0;
    let lanes = plan.layout.units();
    let outputs: Vec<f64> = job.times.iter().map(|&t| scale(t - t0, -plan.units.time)).collect();
    let mut slots = Slots { job, slots: [const { None }; WIDTH], outputs };
    let mut reports: Vec<Option<Report>> = units.iter().map(|_| None).collect();
    let mut waiting = units.iter().enumerate();

    let first = prepare(job, &units[0]);
    let mut state = first.blank_state();
    let mut scratch = state.clone();
    for lane in 0..lanes {
        first.write(&mut state, lane);
    }
    let mut dynamics = unit::dynamics(plan, &[&first], threads);
    let mut tolerance =
        Tolerance { rtol: Lanes::splat(job.rtol), atol_q: Lanes::one(), atol_v: Lanes::one() };
    let mut reference = Reference { position: [Lanes::zero(); 3], velocity: [Lanes::zero(); 3] };
    let mut clock = Clock::new(Lanes::splat(slots.end()));
    let mut engine =
        Adaptive::new(method, &state, tolerance, reference.clone(), scale(job.max_step, -plan.units.time));

    loop {
        let mut fresh = Bits(0);
        for lane in 0..lanes {
            while slots.slots[lane].is_none() {
                let Some((index, unit)) = waiting.next() else { break };
                let unit = prepare(job, unit);
                unit.write(&mut state, lane);
                set_lane(job, &unit, lane, slots.mask(lane), &mut tolerance, &mut reference);
                let mut slot =
                    Slot { unit, index, next_output: 0, steps: 0, rejected: 0, evaluations: 2, progress: 0 };
                if start_outputs(&slots, &mut slot, &state, lane) {
                    slots.slots[lane] = Some(slot);
                    fresh = fresh.or(slots.mask(lane));
                } else {
                    reports[index] = Some(finish(job, &slot, &state, lane, t0, Ending::Finished));
                }
            }
        }
        let running = slots.running();
        if !running.any() {
            break;
        }
        if fresh.any() {
            let views: Vec<&Prepared> = current(&slots, &first, lanes);
            if plan.layout == Layout::Batched {
                // Masses differ from unit to unit, so the forces are set up again with the new lanes.
                let evaluations = dynamics.evaluations;
                dynamics = unit::dynamics(plan, &views, threads);
                dynamics.evaluations = evaluations;
            }
            engine.set_measure(tolerance, reference.clone());
            clock.restart(fresh, Lanes::splat(slots.end()));
            if engine.start(fresh, &state, &mut clock, &mut dynamics, &plan.layout, ticker).is_err() {
                return Ok(interrupted(job, slots, reports, units, &state, &clock));
            }
        }
        let stepped = engine.step(running, &mut state, &mut clock, &mut dynamics, &plan.layout, ticker);
        let Ok(outcome) = stepped else {
            return Ok(interrupted(job, slots, reports, units, &state, &clock));
        };
        if record(
            &mut slots,
            &engine_outputs(&outcome, &clock),
            &mut engine,
            &state,
            &mut scratch,
            &mut dynamics,
            ticker,
        )
        .is_err()
        {
            return Ok(interrupted(job, slots, reports, units, &state, &clock));
        }
        engine.commit(outcome.accepted, &mut state);
        for lane in 0..lanes {
            let Some(slot) = slots.slots[lane].as_mut() else { continue };
            // What the step costs this unit, whatever the other lanes do: the derivative at its end is
            // only taken when it is kept.
            slot.evaluations += u64::from(method.tableau.b.len() as u32) - 1;
            if outcome.accepted.lane(lane) {
                slot.steps += 1;
                slot.evaluations += 1;
                let done = (clock.elapsed.0[lane] / slots.outputs[slots.outputs.len() - 1] * 1000.0) as u64;
                ticker.advance(done - slot.progress);
                slot.progress = done;
            } else {
                slot.rejected += 1;
            }
            let ending = if outcome.finished.lane(lane) {
                Ending::Finished
            } else if outcome.stuck.lane(lane) {
                stuck(job, &slot.unit, &state, lane)
            } else if slot.steps + slot.rejected >= job.max_steps {
                Ending::TooManySteps
            } else {
                continue;
            };
            let time = if ending == Ending::Finished {
                job.times[job.times.len() - 1]
            } else {
                t0 + scale(clock.elapsed.0[lane], plan.units.time)
            };
            reports[slot.index] = Some(finish(job, slot, &state, lane, time, ending));
            slots.slots[lane] = None;
        }
        if ticker.tick().is_err() {
            return Ok(interrupted(job, slots, reports, units, &state, &clock));
        }
    }
    Ok(reports.into_iter().flatten().collect())
}

/// The units in the lanes, an idle lane standing in for by `first`.
fn current<'a>(slots: &'a Slots<'_>, first: &'a Prepared, lanes: usize) -> Vec<&'a Prepared> {
    slots.slots[..lanes].iter().map(|slot| slot.as_ref().map_or(first, |slot| &slot.unit)).collect()
}

fn set_lane(
    job: &Job<'_>,
    unit: &Prepared,
    lane: usize,
    mask: Bits,
    tolerance: &mut Tolerance<Lanes>,
    reference: &mut Reference<Lanes>,
) {
    let units = job.plan.units;
    let (length, speed) = unit.size;
    let (atol_q, atol_v) = match job.atol {
        None => (job.rtol * length, job.rtol * speed),
        Some(atol) => (scale(atol, -units.length), scale(atol, units.velocity())),
    };
    let set = |into: &mut Lanes, value: f64| *into = Lanes::select(mask, Lanes::splat(value), *into);
    debug_assert!(mask.lane(lane));
    set(&mut tolerance.atol_q, atol_q);
    set(&mut tolerance.atol_v, atol_v);
    for c in 0..3 {
        set(&mut reference.position[c], unit.reference.center[c]);
        set(&mut reference.velocity[c], unit.reference.drift[c]);
    }
}

/// Records the outputs at the start; whether anything is left to do.
fn start_outputs(slots: &Slots<'_>, slot: &mut Slot, state: &State<Lanes>, lane: usize) -> bool {
    let job = slots.job;
    while slot.next_output < slots.outputs.len() && slots.outputs[slot.next_output] == 0.0 {
        let _: bool = slot.unit.record(job.writer, slot.next_output, state, lane, 0.0);
        slot.next_output += 1;
    }
    slot.next_output < slots.outputs.len()
}

fn finish(
    job: &Job<'_>,
    slot: &Slot,
    state: &State<Lanes>,
    lane: usize,
    time: f64,
    ending: Ending,
) -> Report {
    Report {
        ending,
        rows: slot.next_output,
        steps: slot.steps,
        rejected: slot.rejected,
        evaluations: slot.evaluations,
        ..report(job, &slot.unit, state, lane, time)
    }
}

/// Reports of a run that was asked to stop.
fn interrupted(
    job: &Job<'_>,
    slots: Slots<'_>,
    mut reports: Vec<Option<Report>>,
    units: &[Unit],
    state: &State<Lanes>,
    clock: &Clock<Lanes>,
) -> Vec<Report> {
    for (lane, slot) in slots.slots.iter().enumerate() {
        if let Some(slot) = slot {
            let time = job.scene.t0 + scale(clock.elapsed.0[lane], job.plan.units.time);
            reports[slot.index] = Some(finish(job, slot, state, lane, time, Ending::Interrupted));
        }
    }
    for (unit, report) in units.iter().zip(&mut reports) {
        if report.is_none() {
            let prepared = prepare(job, unit);
            let mut state = prepared.blank_state();
            prepared.write(&mut state, 0);
            let begun = self::report(job, &prepared, &state, 0, job.scene.t0);
            *report = Some(Report { ending: Ending::Interrupted, ..begun });
        }
    }
    reports.into_iter().flatten().collect()
}

/// The step as its outputs see it.
struct Span {
    accepted: Bits,
    finished: Bits,
    from: Lanes,
    to: Lanes,
    h: Lanes,
}

fn engine_outputs(outcome: &Outcome<Lanes>, clock: &Clock<Lanes>) -> Span {
    Span {
        accepted: outcome.accepted,
        finished: outcome.finished,
        from: outcome.from,
        to: clock.elapsed,
        h: outcome.h,
    }
}

/// Records the outputs that the step has passed, before it is committed.
fn record(
    slots: &mut Slots<'_>,
    span: &Span,
    engine: &mut Adaptive<Lanes>,
    state: &State<Lanes>,
    scratch: &mut State<Lanes>,
    dynamics: &mut Dynamics<Lanes>,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    let job = slots.job;
    let direction = job.plan.direction;
    let mut ready = false;
    let mut charged = Bits(0);
    loop {
        // The next output of each lane that lies inside the step.
        let mut theta = Lanes::one();
        let mut inside = Bits(0);
        let mut due = Bits(0);
        for lane in 0..WIDTH {
            let Some(slot) = slots.slots[lane].as_ref() else { continue };
            if !span.accepted.lane(lane) || slot.next_output == slots.outputs.len() {
                continue;
            }
            let output = slots.outputs[slot.next_output];
            let to = span.to.0[lane];
            if (output - to) * direction > 0.0 && !span.finished.lane(lane) {
                continue;
            }
            due = due.or(Bits(1 << lane));
            if (to - output) * direction > 0.0 {
                inside = inside.or(slots.mask(lane));
                let fraction = (output - span.from.0[lane]) / span.h.0[lane];
                theta = Lanes::select(slots.mask(lane), Lanes::splat(fraction), theta);
            }
        }
        if !due.any() {
            return Ok(());
        }
        if inside.any() {
            if !ready {
                engine.prepare_dense(state, span.h, dynamics, ticker)?;
                ready = true;
            }
            charge(slots, inside.and(charged.not()), engine.dense_stages());
            charged = charged.or(inside);
            engine.interpolate(state, span.h, theta, scratch);
        }
        for lane in 0..WIDTH {
            if !due.lane(lane) {
                continue;
            }
            let Some(slot) = slots.slots[lane].as_mut() else { continue };
            let t = job.times[slot.next_output];
            let source = if inside.lane(lane) { &*scratch } else { engine.next() };
            let elapsed = t - job.scene.t0;
            // A step is only accepted with a finite error, so its states are finite.
            let _: bool = slot.unit.record(job.writer, slot.next_output, source, lane, elapsed);
            slot.next_output += 1;
        }
    }
}

/// Counts the evaluations of the continuous extension for the units that read it.
fn charge(slots: &mut Slots<'_>, lanes: Bits, evaluations: u64) {
    for (lane, slot) in slots.slots.iter_mut().enumerate() {
        if let Some(slot) = slot {
            slot.evaluations += if lanes.lane(lane) { evaluations } else { 0 };
        }
    }
}

/// Why the step fell to zero: the closest bodies, or a state that is no longer finite.
fn stuck(job: &Job<'_>, unit: &Prepared, state: &State<Lanes>, lane: usize) -> Ending {
    let bodies = &unit.unit.bodies;
    let entry = |slot: usize| {
        let entry = unit.read(slot, state, lane, 0.0);
        entry.position
    };
    let places: Vec<[f64; 3]> = (0..bodies.len()).map(entry).collect();
    let mut closest = (f64::INFINITY, (0, 0));
    for i in 0..unit.unit.active {
        for j in i + 1..bodies.len() {
            let distance = distance(places[i], places[j]);
            if distance < closest.0 {
                closest = (distance, (bodies[i].min(bodies[j]), bodies[i].max(bodies[j])));
            }
        }
    }
    for force in &job.plan.forces {
        if let super::ForceSpec::CentralField { center, .. } = force {
            for (slot, &body) in bodies.iter().enumerate() {
                let distance = distance(places[slot], *center);
                if distance < closest.0 {
                    closest = (distance, (body, body));
                }
            }
        }
    }
    if closest.0.is_finite() {
        Ending::CloseEncounter { distance: closest.0, bodies: closest.1 }
    } else {
        Ending::NotFinite
    }
}
