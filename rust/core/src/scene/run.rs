//! From a scene and a request to columns: plan, do, put together.

mod begun;
mod derived;
mod events;
mod half_steps;
pub mod neighbors;
mod patterns;
mod reached;
pub(super) mod resolved;
mod turning;

use super::Scene;
use super::closed_form;
use super::collisions;
use super::columns::{Columns, Missing, Wanted, Writer};
use super::continuation::{Continuation, Held};
use super::integrate::{self, Counts, Ending, Job, Unresolved};
use super::plan::{Plan, Turning};
use super::request::Request;
use super::room::give_back;
use crate::error::{Error, Result};
use crate::memory;
use crate::parallel::Ticker;
use crate::rigid::quaternion::Quaternion;
use begun::Begun;
pub use begun::plan;
pub(super) use begun::plan_through;
use derived::derive;
pub use events::Events;
use reached::gather;
use turning::turn_freely;

/// What became of a copy of the scene.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// How it ended: the first unit of the copy that did not finish tells.
    pub ending: Ending,
    /// Output times recorded for all its particles.
    pub rows: usize,
    /// What all units cost.
    pub counts: Counts,
    /// The time that all its particles have reached.
    pub time: f64,
    /// How far the energy is off at the end, at least, against kinetic + |potential|; NaN if nobody looked.
    pub energy_error: f64,
    /// The step, at the start or at the end, that is furthest from resolving the motion, if one was found.
    pub unresolved: Option<Unresolved>,
}

/// The states that the copies reached, particle after particle, copy after copy.
#[derive(Clone, Debug, Default)]
pub struct Reached {
    /// Positions.
    pub position: Vec<[f64; 3]>,
    /// Velocities.
    pub velocity: Vec<[f64; 3]>,
    /// Orientations of rigid bodies.
    pub orientation: Vec<Quaternion>,
    /// Their angular velocities.
    pub angular_velocity: Vec<[f64; 3]>,
}

impl Reached {
    /// Where a scene is.
    pub(super) fn start(scene: &Scene) -> Self {
        let turned = scene.rigid.as_ref();
        Self {
            position: scene.position.clone(),
            velocity: scene.velocity.clone(),
            orientation: turned.map_or_else(Vec::new, |bodies| bodies.orientation.clone()),
            angular_velocity: turned.map_or_else(Vec::new, |bodies| bodies.angular_velocity.clone()),
        }
    }
}

/// What the copies hold at the nodes at which they ended.
#[derive(Clone, Debug)]
pub struct Kept {
    /// The node of each copy; 0 of one that did not end on a node.
    pub nodes: Vec<u64>,
    /// The time from which they are counted.
    pub t0: f64,
    /// What is held there.
    pub held: Held,
}

/// What collisions have made of a scene.
#[derive(Clone, Debug)]
pub struct Collided {
    /// The collisions.
    pub table: collisions::Table,
    /// The masses at the end.
    pub mass: Vec<f64>,
    /// The radii at the end.
    pub radius: Vec<f64>,
    /// The states from which what is kept was run, if that is not the start.
    pub begun: Option<Reached>,
}

/// Everything a run gives.
#[derive(Clone, Debug)]
pub struct Output {
    /// The plan that was carried out.
    pub plan: Plan,
    /// The recorded columns.
    pub columns: Columns,
    /// What became of each copy.
    pub outcomes: Vec<Outcome>,
    /// The states reached.
    pub reached: Reached,
    /// What is kept for other runs to go on.
    pub kept: Option<Kept>,
    /// The events found.
    pub events: Events,
    /// The collisions of spheres and what is left of them, if they were asked for.
    pub collisions: Option<Collided>,
    /// Of a scene of one copy, what is still to be made NaN where the rows beyond the last common one are wanted at all:
    /// the pages of millions of them may never have been touched.
    pub missing: Vec<Missing>,
}

/// Copies that are run together.
struct Part<'a> {
    /// All copies at the time of the run.
    whole: &'a Scene,
    /// The copies, as they are planned: at the time of the run, or at that of an earlier one which it goes on with.
    scene: &'a Scene,
    plan: &'a Plan,
    /// Which copies of the whole they are; `None` is all of them.
    members: Option<&'a [usize]>,
}

impl Part<'_> {
    /// The place among all copies of one of these.
    fn member(&self, copy: usize) -> usize {
        self.members.map_or(copy, |members| members[copy])
    }

    /// What an earlier run has left behind, if this one goes on with it.
    fn from(&self) -> Option<(&Continuation, Option<&[usize]>)> {
        let continuation = self.whole.continuation.as_ref().filter(|_| self.plan.from > 0)?;
        Some((continuation, self.members))
    }

    /// What its units share, where nothing is looked for on the way, and nothing goes on from before or after.
    fn job<'a>(&'a self, request: &'a Request, writer: &'a Writer<'a>) -> Job<'a> {
        let Part { scene, plan, .. } = *self;
        Job {
            scene,
            plan,
            times: &request.times,
            rtol: plan.rtol(request),
            asked_rtol: request.rtol,
            atol: request.atol.as_ref(),
            max_step: plan.max_step(request),
            first_step: request.first_step.unwrap_or(f64::MAX),
            max_steps: request.max_steps.map_or(u64::MAX, |steps| steps as u64),
            watches: false,
            from: None,
            keeps: false,
            writer,
        }
    }

    /// Whether columns can be derived at the record.
    fn tells(&self) -> bool {
        !self.plan.solutions.integrates()
            || self.plan.first_unit().is_some_and(|unit| unit.is_whole(self.scene))
    }
}

/// Runs a scene.
///
/// # Errors
/// Bad input, and output that there is no memory for, before anything runs; errors of the library itself. How each copy
/// ended is in the output.
pub fn run(scene: &Scene, request: &Request, ticker: &mut Ticker<'_>) -> Result<Output> {
    match collisions::wanted(scene, request)? {
        Some(rule) => collisions::run(scene, request, rule, ticker),
        None => run_through(scene, request, ticker),
    }
}

/// Runs a scene whose spheres pass through each other, or end the run where they touch if the request has that event.
///
/// # Errors
/// As [`run`].
pub(super) fn run_through(scene: &Scene, request: &Request, ticker: &mut Ticker<'_>) -> Result<Output> {
    let begun = Begun::of(scene, request, ticker)?;
    let parts = begun.parts(scene);
    let plan = &begun.plan;
    let derived = request.derived();
    let wanted = Wanted {
        position: request.records("position"),
        velocity: request.records("velocity"),
        rigid: if request.records_turning() || !derived.is_empty() { plan.rigid } else { 0 },
        keep_states: !derived.is_empty() && (scene.rigid.is_some() || !parts.iter().all(Part::tells)),
        derived,
    };
    check_memory(scene, request, &wanted, plan.threads.0)?;
    let mut columns = Columns::new(scene.copies, request.times.len(), scene.particles, &wanted)?;
    let mut outcomes = vec![Outcome::finished(request); scene.copies];
    let mut reached = Reached::start(scene);
    // A method that chooses its steps has no nodes, and a closed form holds nothing.
    let plans = parts.iter().map(|part| part.plan);
    let equal = plan.dt.is_some() && plan.tolerance.is_none();
    let held = if equal { Held::room(scene, plan.method, plans)? } else { None };
    let mut kept = held.map(|held| Kept { nodes: vec![u64::MAX; scene.copies], t0: plan.t0, held });
    let mut missing = Vec::new();
    let mut events = Events::default();
    for part in &parts {
        let into = (&mut columns, &mut outcomes[..], &mut reached, kept.as_mut(), &mut events);
        missing = run_part(part, request, into, ticker)?;
        if scene.copies > 1 {
            columns.finish(&core::mem::take(&mut missing));
        }
    }
    // What acts on some copies may be nothing to others.
    let free = parts.iter().filter(|part| matches!(part.plan.turning, Turning::Exact));
    let free: Vec<usize> =
        free.flat_map(|part| (0..part.scene.copies).map(|copy| part.member(copy))).collect();
    let scenes = (scene, begun.start(scene));
    turn_freely(scenes, &free, request, &mut columns, &outcomes, &mut reached, ticker)?;
    if wanted.keep_states {
        let rows: Vec<usize> = outcomes.iter().map(|outcome| outcome.rows).collect();
        derive(scene, &mut columns, &rows, request.threads, ticker)?;
    }
    for (kept, array) in [
        (wanted.position, &mut columns.position),
        (wanted.velocity, &mut columns.velocity),
        (false, &mut columns.position_rest),
        (false, &mut columns.velocity_rest),
    ] {
        if !kept {
            give_back(core::mem::take(array));
        }
    }
    events.sort(plan.direction);
    let plan = begun.plan;
    let collisions = request.collisions.map(|_| Collided {
        table: collisions::Table::default(),
        mass: scene.mass.clone(),
        radius: scene.radius.clone(),
        begun: None,
    });
    Ok(Output { plan, columns, outcomes, reached, kept, events, collisions, missing })
}

/// Refuses what there is no memory for: the columns, the times of each thread, the states reached.
fn check_memory(scene: &Scene, request: &Request, wanted: &Wanted, threads: usize) -> Result<()> {
    let times = request.times.len();
    let bytes = wanted.bytes(scene.copies, times, scene.particles).and_then(|columns| {
        let each = size_of::<f64>() * (threads + 2);
        let states = scene.copies.checked_mul(scene.particles)?.checked_mul(4 * size_of::<[f64; 3]>())?;
        columns.checked_add(times.checked_mul(each)?)?.checked_add(states)
    });
    memory::check(
        "t",
        &format!(
            "{} times of {} particles in {} copies, with what is recorded of them,",
            times, scene.particles, scene.copies
        ),
        bytes,
        "ask for fewer times, record fewer columns, or run in parts",
    )
}

/// Where what a run gives is put.
type Places<'a> = (&'a mut Columns, &'a mut [Outcome], &'a mut Reached, Option<&'a mut Kept>, &'a mut Events);

/// Runs a part; gives what was not recorded of it.
fn run_part(
    part: &Part<'_>,
    request: &Request,
    (columns, outcomes, reached, kept, events): Places<'_>,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Missing>> {
    let Part { scene, plan, .. } = *part;
    if !plan.solutions.integrates() {
        let writer = columns.writer(scene, part.members, 1);
        let reports = closed_form::run(scene, plan, &request.times, &writer, ticker)?;
        for (copy, report) in reports.iter().enumerate() {
            let member = part.member(copy);
            let places = member * scene.particles..(member + 1) * scene.particles;
            for (place, &[position, velocity]) in places.zip(&report.states) {
                reached.position[place] = position;
                reached.velocity[place] = velocity;
            }
            outcomes[member].stop(report, request, scene.t0);
        }
        return Ok(unreached(part, request, outcomes));
    }
    check_units(part)?;
    let writer = columns.writer(scene, part.members, plan.threads.1);
    let job = Job { watches: true, from: part.from(), keeps: kept.is_some(), ..part.job(request, &writer) };
    let mut reports = integrate::run(&job, ticker)?;
    if let Some(kept) = kept {
        kept.gather(part, &mut reports);
    }
    gather(part, request, &reports, columns, outcomes, reached, ticker)?;
    events.gather(part, &reports, outcomes);
    if part.scene.rigid.is_none() {
        resolved::look(part, request, outcomes, reached, ticker)?;
    }
    Ok(unreached(part, request, outcomes))
}

/// The rows beyond the end of a copy that ended early, of all its particles: there is no state of the whole.
fn unreached(part: &Part<'_>, request: &Request, outcomes: &[Outcome]) -> Vec<Missing> {
    let copies = (0..part.scene.copies).map(|copy| part.member(copy));
    copies
        .filter(|&copy| outcomes[copy].rows < request.times.len())
        .flat_map(|copy| {
            let from_time = outcomes[copy].rows;
            (0..part.scene.particles).map(move |particle| Missing { copy, from_time, particle })
        })
        .collect()
}

/// That each particle is recorded from one unit: what lets threads write side by side.
fn check_units(part: &Part<'_>) -> Result<()> {
    let Part { scene, plan, .. } = *part;
    let mut seen = vec![false; scene.copies * scene.particles];
    let broken = || Error::Internal("a particle belongs to no unit or to two".to_owned());
    for unit in plan.unit_list() {
        for slot in unit.recorded {
            let place = seen.get_mut(unit.copy * scene.particles + unit.bodies[slot]).ok_or_else(broken)?;
            if core::mem::replace(place, true) {
                return Err(broken());
            }
        }
    }
    if seen.contains(&false) { Err(broken()) } else { Ok(()) }
}

impl Outcome {
    /// Of a copy that comes to the end at no cost.
    pub(super) fn finished(request: &Request) -> Self {
        let times = &request.times;
        Self {
            ending: Ending::Finished,
            rows: times.len(),
            counts: Counts::default(),
            time: times[times.len() - 1],
            energy_error: f64::NAN,
            unresolved: None,
        }
    }

    /// Ends where a closed form did, if that is before the end.
    fn stop(&mut self, report: &closed_form::Report, request: &Request, t0: f64) {
        if report.rows < request.times.len() {
            self.ending = if report.beyond { Ending::NotFinite } else { Ending::Interrupted };
            self.rows = report.rows;
            self.time = report.rows.checked_sub(1).map_or(t0, |row| request.times[row]);
        }
    }
}
