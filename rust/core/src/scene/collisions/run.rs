//! A run with collisions: all copies together to the first contact of each, then every copy by itself, leg after leg, put together
//! as one run.

mod first_leg;
mod flights;
mod fly;
mod jumps;
mod leg;
mod member;
mod settled;
mod squeezed;
mod start;

use super::{Collisions, Table, contact, may_touch};
use crate::error::Result;
use crate::parallel::{Ticker, for_chunks};
use crate::scene::Scene;
use crate::scene::columns::{Columns, Wanted};
use crate::scene::events::Event;
use crate::scene::plan::Plan;
use crate::scene::request::Request;
use crate::scene::run::{Collided, Events, Kept, Output, Reached, plan_through};
use first_leg::{Leg, first_leg};
use member::Member;
pub use start::absorbed;
use start::{check_overlaps, whole_of};

/// The plan of a run with collisions.
///
/// # Errors
/// As [`Plan::new`]; what [`Collisions`] have no meaning for.
pub fn plan(scene: &Scene, request: &Request, rule: Collisions, ticker: &mut Ticker<'_>) -> Result<Plan> {
    let looking = |mut events: Vec<Event>| {
        events.push(contact(Vec::new()));
        Request { events, collisions: Some(rule), ..request.clone() }
    };
    let mut wholes = (0..scene.copies).map(|copy| whole_of(scene, copy, rule));
    let merged = wholes.find_map(Result::transpose).transpose()?;
    // Bodies that are parts of others differ from copy to copy: the plan is that of one.
    let plan = match merged {
        Some(first) => plan_through(&first, &looking(Vec::new()), ticker)?,
        None => plan_through(scene, &looking(request.events.clone()), ticker)?,
    };
    rule.check(scene, plan.direction)?;
    (0..scene.copies).try_for_each(|copy| check_overlaps(scene, copy, rule))?;
    Ok(plan)
}

/// Runs a scene with collisions.
///
/// # Errors
/// As [`run`](crate::scene::run::run); spheres that overlap at the start, unless they merge.
pub fn run(scene: &Scene, request: &Request, rule: Collisions, ticker: &mut Ticker<'_>) -> Result<Output> {
    let mut plan = plan(scene, request, rule, ticker)?;
    let copies = scene.copies;
    let threads = if request.events.iter().any(Event::calls) { 1 } else { request.threads.min(copies) };
    let mut first = first_leg(scene, request, (rule, plan.direction), ticker)?;
    if copies > 1 {
        let (done, _) = ticker.control().progress();
        ticker.control().count_whole(done + copies as u64);
        plan.threads = (threads, 1);
    }
    let mut members = for_chunks(threads, copies, ticker, |copy, ticker| {
        let first = first.as_ref().map(|all| Leg::of_copy(all, copy, scene, request)).transpose()?;
        let member = Member::run(scene, request, (rule, copy), (plan.direction, first), ticker);
        if copies > 1 {
            ticker.control().count(1);
        }
        member
    })?;
    let together = first.as_mut().map(|all| core::mem::take(&mut all.columns));
    let columns = gathered(scene, request, together, &mut members)?;
    let mut output = Output {
        columns,
        outcomes: members.iter().map(|member| member.outcome.clone()).collect(),
        reached: Reached::default(),
        kept: None,
        events: Events::default(),
        collisions: None,
        missing: Vec::new(),
        plan,
    };
    let goes_on = members.iter().all(|member| member.from > 0);
    output.plan.from = if goes_on { members.first().map_or(0, |member| member.from) } else { 0 };
    let held = kept(&mut members);
    let mut table = Table::default();
    let (mut mass, mut radius) = (Vec::new(), Vec::new());
    let mut begun = Reached::default();
    let places: Vec<usize> = (0..scene.particles).collect();
    let names: Vec<usize> = (0..request.events.len()).collect();
    for (copy, member) in members.into_iter().enumerate() {
        output.reached.position.extend(&member.bodies.position);
        output.reached.velocity.extend(&member.bodies.velocity);
        mass.extend(&member.bodies.mass);
        radius.extend(&member.bodies.radius);
        table.lines.extend(member.lines);
        output.events.extend(&member.events, copy, &names, &places);
        begun.position.extend(&member.begun.position);
        begun.velocity.extend(&member.begun.velocity);
        let from_time = member.outcome.rows;
        if from_time < request.times.len() {
            let missing = |particle| crate::scene::columns::Missing { copy, from_time, particle };
            output.missing.extend((0..scene.particles).map(missing));
        }
    }
    if copies > 1 {
        output.columns.finish(&core::mem::take(&mut output.missing));
    }
    let begun = (!goes_on && held.is_some()).then_some(begun);
    output.kept = held;
    output.collisions = Some(Collided { table, mass, radius, begun });
    Ok(output)
}

/// What is asked to be recorded.
fn wanted(request: &Request) -> Wanted {
    Wanted {
        position: request.records("position"),
        velocity: request.records("velocity"),
        derived: request.derived(),
        keep_states: false,
        rigid: 0,
    }
}

/// The columns of all members, of whom some have theirs among those of all already.
fn gathered(
    scene: &Scene,
    request: &Request,
    together: Option<Columns>,
    members: &mut [Member],
) -> Result<Columns> {
    if let [member] = members {
        return Ok(core::mem::take(&mut member.columns));
    }
    let mut all = match together {
        Some(all) => all,
        None => Columns::new(scene.copies, request.times.len(), scene.particles, &wanted(request))?,
    };
    for (copy, member) in members.iter_mut().enumerate().filter(|(_, member)| member.columns.times > 0) {
        let own = core::mem::take(&mut member.columns);
        let arrays = [(&mut all.position, &own.position), (&mut all.velocity, &own.velocity)];
        let derived =
            all.derived.iter_mut().zip(&own.derived).map(|(all, own)| (&mut all.values, &own.values));
        for (into, from) in arrays.into_iter().chain(derived) {
            into[copy * from.len()..(copy + 1) * from.len()].copy_from_slice(from);
        }
    }
    Ok(all)
}

/// What the members hold, if they count their nodes from one time.
fn kept(members: &mut [Member]) -> Option<Kept> {
    let mut all: Option<Kept> = None;
    let alike = |a: u64, b: u64| (a > 0) == (b > 0);
    let from = members.first().map_or(0, |member| member.from);
    for member in members.iter_mut() {
        let own = member.kept.take()?;
        if !alike(member.from, from) {
            return None;
        }
        match &mut all {
            None => all = Some(own),
            Some(all) if all.t0 == own.t0 && all.held.slots == own.held.slots => {
                all.nodes.extend(own.nodes);
                all.held.numbers.extend(own.held.numbers);
            }
            Some(_) => return None,
        }
    }
    all
}
