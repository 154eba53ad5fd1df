//! From a scene and a request to columns: plan, do, derive.

mod derived;
mod patterns;

pub use derived::Derived;

use super::columns::{Columns, Missing};
use super::integrate::{self, Counts, Ending, Job, Report};
use super::plan::{Plan, Solution};
use super::request::Request;
use super::room::give_back;
use super::{Scene, closed_form};
use crate::error::Result;
use crate::parallel::Ticker;
use derived::derive;
use patterns::run_by_pattern;

/// What became of a copy of the scene.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// How it ended: the first unit of the copy that did not finish tells.
    pub ending: Ending,
    /// Output times recorded for all its particles.
    pub rows: usize,
    /// What all units cost.
    pub counts: Counts,
    /// The time reached.
    pub time: f64,
}

/// The states that the copies reached, particle after particle, copy after copy.
#[derive(Clone, Debug)]
pub struct Reached {
    /// Positions.
    pub position: Vec<[f64; 3]>,
    /// Velocities.
    pub velocity: Vec<[f64; 3]>,
}

/// Everything a run gives.
#[derive(Clone, Debug)]
pub struct Output {
    /// The plan that was carried out.
    pub plan: Plan,
    /// Positions and velocities, where asked for.
    pub columns: Columns,
    /// Derived columns, in the order asked for.
    pub derived: Vec<Derived>,
    /// What became of each copy.
    pub outcomes: Vec<Outcome>,
    /// The states reached.
    pub reached: Reached,
}

/// Runs a scene.
///
/// # Errors
/// Bad input, before anything runs; errors of the library itself. How each copy ended is in the output.
pub fn run(scene: &Scene, request: &Request, ticker: &mut Ticker<'_>) -> Result<Output> {
    let plan = Plan::new(scene, request)?;
    if let Some(output) = run_by_pattern(scene, request, ticker)? {
        return Ok(Output { plan, ..output });
    }
    let mut columns = Columns::new(
        scene.copies,
        request.times.len(),
        scene.particles,
        request.records("position"),
        request.records("velocity"),
        plan.derived(),
    );
    let (outcomes, reached) = if plan.solution == Solution::Integration {
        let writer = columns.writer();
        let job = Job {
            scene,
            plan: &plan,
            times: &request.times,
            rtol: request.rtol,
            atol: request.atol,
            max_step: request.max_step.unwrap_or(f64::MAX),
            max_steps: request.max_steps.map_or(u64::MAX, |steps| steps as u64),
            writer: &writer,
        };
        let reports = integrate::run(&job, ticker)?;
        let missing: Vec<Missing> = reports
            .iter()
            .filter(|report| report.rows < request.times.len())
            .flat_map(|report| {
                let unit = &report.unit;
                unit.recorded.clone().map(|slot| Missing {
                    copy: unit.copy,
                    from_time: report.rows,
                    particle: unit.bodies[slot],
                })
            })
            .collect();
        // SAFETY: there is a report for every unit, the units' recorded bodies are all particles of all
        // copies, and a unit writes its bodies at each of the first `rows` output times.
        unsafe { columns.finish(scene.copies, &missing) };
        gather(scene, request, &reports)
    } else {
        let reached = closed_form::run(scene, &plan, &request.times, &columns.writer(), ticker)?;
        // SAFETY: a closed form that succeeds has written every particle at every time.
        unsafe { columns.finish(scene.copies, &[]) };
        // It cannot fail.
        (vec![Outcome::finished(request); scene.copies], reached)
    };
    let derived = derive(scene, request, &plan, &columns, &outcomes, ticker)?;
    if !request.records("position") {
        give_back(core::mem::take(&mut columns.position));
    }
    if !request.records("velocity") {
        give_back(core::mem::take(&mut columns.velocity));
    }
    give_back(core::mem::take(&mut columns.position_rest));
    give_back(core::mem::take(&mut columns.velocity_rest));
    Ok(Output { plan, columns, derived, outcomes, reached })
}

/// Puts the units' reports together, copy by copy.
fn gather(scene: &Scene, request: &Request, reports: &[Report]) -> (Vec<Outcome>, Reached) {
    let mut outcomes = vec![Outcome::finished(request); scene.copies];
    let mut reached = Reached { position: scene.position.clone(), velocity: scene.velocity.clone() };
    for report in reports {
        let outcome = &mut outcomes[report.unit.copy];
        if outcome.ending == Ending::Finished && report.ending != Ending::Finished {
            outcome.ending = report.ending.clone();
            outcome.time = report.time;
        }
        outcome.rows = outcome.rows.min(report.rows);
        outcome.counts += report.counts;
        for (&[position, velocity], slot) in report.states.iter().zip(report.unit.recorded.clone()) {
            let particle = report.unit.copy * scene.particles + report.unit.bodies[slot];
            reached.position[particle] = position;
            reached.velocity[particle] = velocity;
        }
    }
    (outcomes, reached)
}

impl Outcome {
    /// Of a copy that comes to the end at no cost.
    fn finished(request: &Request) -> Self {
        let times = &request.times;
        Self {
            ending: Ending::Finished,
            rows: times.len(),
            counts: Counts::default(),
            time: times[times.len() - 1],
        }
    }
}
