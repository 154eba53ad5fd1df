//! From a scene and a request to columns: plan, do, derive.

use super::columns::{Columns, Entry, Missing};
use super::integrate::{self, Counts, Ending, Job, Report};
use super::plan::{Plan, Solution};
use super::request::Request;
use super::{Scene, closed_form};
use crate::conservation::{self, Body};
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::parallel::{Ticker, for_chunks};

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
    /// Final positions.
    pub position: Vec<[f64; 3]>,
    /// Final velocities.
    pub velocity: Vec<[f64; 3]>,
}

/// A derived column: its name and its numbers, `copies × times × width`.
#[derive(Clone, Debug)]
pub struct Derived {
    /// Its name.
    pub name: String,
    /// Numbers per time.
    pub width: usize,
    /// The numbers; NaN where nothing was recorded.
    pub values: Vec<f64>,
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
    let outcomes = if plan.solution == Solution::Integration {
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
        let outcomes = closed_form::run(scene, &plan, &request.times, &columns.writer(), ticker)?;
        // SAFETY: a closed form that succeeds has written every particle at every time.
        unsafe { columns.finish(scene.copies, &[]) };
        outcomes
    };
    let derived = derive(scene, request, &plan, &columns, &outcomes, ticker)?;
    if !request.records("position") {
        columns.position = Vec::new();
    }
    if !request.records("velocity") {
        columns.velocity = Vec::new();
    }
    columns.position_rest = Vec::new();
    columns.velocity_rest = Vec::new();
    Ok(Output { plan, columns, derived, outcomes })
}

/// Copies with different sets of massless bodies are run apart, so that each has the bits it has alone.
fn run_by_pattern(scene: &Scene, request: &Request, ticker: &mut Ticker<'_>) -> Result<Option<Output>> {
    let pattern = |copy: usize| -> Vec<bool> { scene.masses(copy).iter().map(|&m| m > 0.0).collect() };
    let first = pattern(0);
    if (1..scene.copies).all(|copy| pattern(copy) == first) {
        return Ok(None);
    }
    let mut groups: std::collections::BTreeMap<Vec<bool>, Vec<usize>> = std::collections::BTreeMap::new();
    for copy in 0..scene.copies {
        groups.entry(pattern(copy)).or_default().push(copy);
    }
    let times = request.times.len();
    let mut whole: Option<Output> = None;
    for members in groups.values() {
        let pick = |values: &[[f64; 3]]| {
            let of = |&copy: &usize| values[copy * scene.particles..(copy + 1) * scene.particles].to_vec();
            members.iter().flat_map(of).collect()
        };
        let part = Scene {
            copies: members.len(),
            mass: members.iter().flat_map(|&copy| scene.masses(copy).to_vec()).collect(),
            position: pick(&scene.position),
            velocity: pick(&scene.velocity),
            ..scene.clone()
        };
        let part = run(&part, request, ticker)?;
        let whole = whole.get_or_insert_with(|| Output {
            plan: part.plan.clone(),
            columns: Columns {
                position: vec![f64::NAN; part.columns.position.len() / members.len() * scene.copies],
                velocity: vec![f64::NAN; part.columns.velocity.len() / members.len() * scene.copies],
                times,
                particles: scene.particles,
                ..Columns::default()
            },
            derived: part
                .derived
                .iter()
                .map(|column| Derived {
                    values: vec![f64::NAN; column.values.len() / members.len() * scene.copies],
                    ..column.clone()
                })
                .collect(),
            outcomes: vec![part.outcomes[0].clone(); scene.copies],
        });
        for (index, &copy) in members.iter().enumerate() {
            let scatter = |into: &mut Vec<f64>, from: &Vec<f64>| {
                let size = from.len() / members.len();
                into[copy * size..(copy + 1) * size].copy_from_slice(&from[index * size..(index + 1) * size]);
            };
            scatter(&mut whole.columns.position, &part.columns.position);
            scatter(&mut whole.columns.velocity, &part.columns.velocity);
            for (into, from) in whole.derived.iter_mut().zip(&part.derived) {
                scatter(&mut into.values, &from.values);
            }
            whole.outcomes[copy] = part.outcomes[index].clone();
        }
    }
    Ok(whole)
}

/// Puts the units' reports together, copy by copy.
fn gather(scene: &Scene, request: &Request, reports: &[Report]) -> Vec<Outcome> {
    let mut outcomes: Vec<Outcome> = (0..scene.copies)
        .map(|copy| Outcome {
            ending: Ending::Finished,
            rows: request.times.len(),
            counts: Counts::default(),
            time: request.times[request.times.len() - 1],
            position: scene.positions(copy).to_vec(),
            velocity: scene.velocities(copy).to_vec(),
        })
        .collect();
    for report in reports {
        let outcome = &mut outcomes[report.unit.copy];
        if outcome.ending == Ending::Finished && report.ending != Ending::Finished {
            outcome.ending = report.ending.clone();
            outcome.time = report.time;
        }
        outcome.rows = outcome.rows.min(report.rows);
        outcome.counts += report.counts;
        for (index, slot) in report.unit.recorded.clone().enumerate() {
            let body = report.unit.bodies[slot];
            outcome.position[body] = report.position[index];
            outcome.velocity[body] = report.velocity[index];
        }
    }
    outcomes
}

/// The derived columns, from the recorded states and what they leave out.
fn derive(
    scene: &Scene,
    request: &Request,
    plan: &Plan,
    columns: &Columns,
    outcomes: &[Outcome],
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Derived>> {
    let names: Vec<&String> =
        request.record.iter().filter(|name| *name != "position" && *name != "velocity").collect();
    let times = request.times.len();
    let widths: Vec<usize> =
        names.iter().map(|name| if conservation::SCALARS.contains(&name.as_str()) { 1 } else { 3 }).collect();
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let threads = plan.threads.0.max(plan.threads.1);
    // What was computed before an interrupt is not lost: an interrupted run is still derived from, and an
    // interrupt that comes now leaves the rest of a column as NaN.
    let interrupted = outcomes.iter().any(|outcome| outcome.ending == Ending::Interrupted);
    let per_copy = for_chunks(threads, scene.copies, ticker, |copy, ticker| {
        let mut values: Vec<Vec<f64>> = widths.iter().map(|width| vec![f64::NAN; width * times]).collect();
        for time in 0..outcomes[copy].rows {
            if ticker.tick().is_err() && !interrupted {
                break;
            }
            let bodies = recorded_bodies(scene, columns, copy, time);
            for (index, name) in names.iter().enumerate() {
                let numbers = conservation::column(name, &scene.forces, &bodies, [0.0; 3])?;
                values[index][time * widths[index]..(time + 1) * widths[index]].copy_from_slice(&numbers);
            }
        }
        Ok(values)
    })?;
    let mut derived: Vec<Derived> = names
        .iter()
        .zip(&widths)
        .map(|(name, &width)| Derived { name: (*name).clone(), width, values: Vec::new() })
        .collect();
    for values in per_copy {
        for (column, values) in derived.iter_mut().zip(values) {
            column.values.extend(values);
        }
    }
    Ok(derived)
}

fn recorded_bodies(scene: &Scene, columns: &Columns, copy: usize, time: usize) -> Vec<Body> {
    let at = |particle: usize| ((copy * columns.times + time) * columns.particles + particle) * 3;
    (0..scene.particles)
        .map(|particle| {
            let exact = |values: &[f64], rest: &[f64]| {
                core::array::from_fn(|c| DoubleDouble::sum(values[at(particle) + c], rest[at(particle) + c]))
            };
            Body {
                mass: scene.masses(copy)[particle],
                position: exact(&columns.position, &columns.position_rest),
                velocity: exact(&columns.velocity, &columns.velocity_rest),
            }
        })
        .collect()
}

impl Outcome {
    /// Of a closed form: it cannot fail.
    pub(super) fn closed_form(times: usize, time: f64, entries: &[Entry]) -> Self {
        Self {
            ending: Ending::Finished,
            rows: times,
            counts: Counts::default(),
            time,
            position: entries.iter().map(|entry| entry.position).collect(),
            velocity: entries.iter().map(|entry| entry.velocity).collect(),
        }
    }
}
