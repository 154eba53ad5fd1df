//! What the units report, put together: of each copy one ending, and one state of one time.
//!
//! Units of a copy may stop at different times: one meets another body, or Ctrl-C finds each on its way. The state that
//! the copy has reached is then the one at the earliest of those times: units that went further are integrated once more,
//! up to there. After Ctrl-C nobody wants to wait for that: then it is the last output time that all have reached, if
//! states were recorded, else the start. A unit whose numbers have ceased to be finite has reached its last output.

use super::super::columns::Columns;
use super::super::integrate::{self, Ending, Job, Report, Unresolved};
use super::super::request::Request;
use super::super::unit::Unit;
use super::{Outcome, Part, Reached};
use crate::error::Result;
use crate::numerics::power_of_two::power_of_two;
use crate::parallel::Ticker;
use crate::scene::Scene;
use crate::scene::columns::Wanted;

/// Puts the reports together, copy by copy.
///
/// # Errors
/// Only errors of the library itself.
pub(super) fn gather(
    part: &Part<'_>,
    request: &Request,
    reports: &[Report],
    columns: &Columns,
    outcomes: &mut [Outcome],
    reached: &mut Reached,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    let t0 = part.whole.t0;
    for report in reports {
        let member = part.member(report.unit.copy);
        let outcome = &mut outcomes[member];
        let time = time_of(report, request, t0);
        let earlier = (time - t0).abs() < (outcome.time - t0).abs();
        // Of what ends a copy nothing counts that would have come later.
        let replaces = match (&outcome.ending, &report.ending) {
            (_, Ending::Finished) => false,
            (Ending::Finished, _) => true,
            _ => earlier,
        };
        if replaces {
            outcome.ending =
                if left_a_domain(part.scene, report) { Ending::OutsideDomain } else { report.ending.clone() };
        }
        outcome.rows = outcome.rows.min(report.rows);
        outcome.counts += report.counts;
        outcome.unresolved = Unresolved::worse(outcome.unresolved, report.unresolved);
        if earlier {
            outcome.time = time;
        }
        put(part, report, reached);
    }
    let mut behind: Vec<&Report> = Vec::new();
    for report in reports {
        let outcome = &outcomes[part.member(report.unit.copy)];
        // Of a unit that only looks for events nobody asks where it is.
        if outcome.ending != Ending::Finished
            && !report.unit.recorded.is_empty()
            && (report.ending == Ending::NotFinite || report.time != outcome.time)
        {
            behind.push(report);
        }
    }
    behind.sort_by_key(|report| report.unit.copy);
    for apart in behind.chunk_by(|a, b| a.unit.copy == b.unit.copy) {
        let of_copy =
            |report: &&Report| report.unit.copy == apart[0].unit.copy && !report.unit.recorded.is_empty();
        let all: Vec<&Report> = reports.iter().filter(of_copy).collect();
        bring_together(part, request, (apart, &all), columns, outcomes, reached, ticker)?;
    }
    for report in reports.iter().filter(|report| report.ending == Ending::Stopped) {
        if report.time == outcomes[part.member(report.unit.copy)].time {
            put_where_it_stopped(part, report, reached);
        }
    }
    Ok(())
}

/// Puts the bodies that an event looks at where it stopped the motion, if it was looked for on steps of its own: on those of
/// each body it might be to come yet.
fn put_where_it_stopped(part: &Part<'_>, report: &Report, reached: &mut Reached) {
    let Some(last) = report.found.last() else { return };
    let Part { scene, plan, .. } = *part;
    let looked_at = plan.events[last.which].bodies(&plan.groups, scene.particles, &plan.active);
    for (&[position, velocity], &body) in last.states.iter().zip(&*report.unit.bodies) {
        if looked_at.contains(&body) {
            let particle = part.member(report.unit.copy) * scene.particles + body;
            (reached.position[particle], reached.velocity[particle]) = (position, velocity);
        }
    }
}

/// Whether what became undefined did so by leaving the distances or the speeds at which a force is known: it is no number
/// there. The state that is told may be the last that was one.
fn left_a_domain(scene: &Scene, report: &Report) -> bool {
    let infinite = || report.states.iter().flatten().flatten().any(|x| x.is_infinite());
    report.ending == Ending::NotFinite
        && scene.forces_of(report.unit.copy).iter().any(|force| {
            force.domain().is_some()
                || report.unit.bodies.iter().any(|&body| force.speed_limit(body).is_some())
        })
        && !infinite()
}

/// The time of a report's state, or of the last output before it ceased to be one.
fn time_of(report: &Report, request: &Request, t0: f64) -> f64 {
    match report.ending {
        Ending::NotFinite if report.rows == 0 => t0,
        Ending::NotFinite => request.times[report.rows - 1],
        _ => report.time,
    }
}

/// Puts the state of a report in its places.
fn put(part: &Part<'_>, report: &Report, reached: &mut Reached) {
    for (&[position, velocity], slot) in report.states.iter().zip(report.unit.recorded.clone()) {
        let particle = part.member(report.unit.copy) * part.scene.particles + report.unit.bodies[slot];
        reached.position[particle] = position;
        reached.velocity[particle] = velocity;
    }
    let bodies = report.unit.bodies.iter().enumerate();
    let rigid = bodies.filter_map(|(slot, &body)| Some((slot, part.plan.rigid_place(body)?)));
    let recorded = |slot: &usize| report.unit.recorded.contains(slot);
    for (&(orientation, spin), (_, place)) in
        report.turned.iter().zip(rigid).filter(|(_, (slot, _))| recorded(slot))
    {
        let body = part.member(report.unit.copy) * part.plan.rigid + place;
        reached.orientation[body] = orientation;
        reached.angular_velocity[body] = spin;
    }
}

/// How often units are brought together at an earlier time, where some do not come to the one before.
const ATTEMPTS: i32 = 8;

/// Brings a copy to one time, of whose units, which are `all`, those `apart` are not at the time of its outcome.
fn bring_together(
    part: &Part<'_>,
    request: &Request,
    (apart, all): (&[&Report], &[&Report]),
    columns: &Columns,
    outcomes: &mut [Outcome],
    reached: &mut Reached,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    let (scene, copy) = (part.whole, part.member(apart[0].unit.copy));
    let outcome = &mut outcomes[copy];
    let row = request.times[..outcome.rows].iter().rposition(|&t| t == outcome.time);
    let on_a_row = apart.iter().all(|report| report.ending == Ending::NotFinite) && row.is_some();
    let interrupted = ticker.tick().is_err();
    let after_row = |time: f64| {
        let row = outcome.rows.checked_sub(1).map_or(scene.t0, |row| request.times[row]);
        (time - scene.t0).abs() > (row - scene.t0).abs()
    };
    let (mut units, mut time) = (apart, outcome.time);
    for attempt in 0..ATTEMPTS {
        if interrupted || on_a_row || !(attempt == 0 || after_row(time)) || time == scene.t0 {
            break;
        }
        let Some(short) = again(part, request, units, time, reached, ticker)? else {
            outcome.time = time;
            return Ok(());
        };
        // A close encounter is where it is only to the last digits: on other steps some end a little earlier.
        (units, time) = (all, short - (short - scene.t0) * power_of_two(4 * attempt - 44));
    }
    let turning = scene.rigid.is_none() || columns.rigid > 0;
    let recorded =
        !columns.position.is_empty() && !columns.velocity.is_empty() && turning && outcome.time != scene.t0;
    let places = copy * scene.particles..(copy + 1) * scene.particles;
    match outcome.rows.checked_sub(1).filter(|_| recorded) {
        Some(row) => {
            outcome.time = request.times[row];
            let from = (copy * columns.times + row) * columns.particles * 3;
            for (particle, place) in places.enumerate() {
                let at = from + 3 * particle;
                let point = |values: &[f64]| [values[at], values[at + 1], values[at + 2]];
                reached.position[place] = point(&columns.position);
                reached.velocity[place] = point(&columns.velocity);
            }
            for body in 0..columns.rigid {
                let (from, into) =
                    ((copy * columns.times + row) * columns.rigid + body, copy * columns.rigid + body);
                reached.orientation[into] = core::array::from_fn(|c| columns.orientation[4 * from + c]);
                reached.angular_velocity[into] =
                    core::array::from_fn(|c| columns.angular_velocity[3 * from + c]);
            }
        }
        None => {
            outcome.time = scene.t0;
            reached.position[places.clone()].copy_from_slice(scene.positions(copy));
            reached.velocity[places].copy_from_slice(scene.velocities(copy));
            if let Some(bodies) = &scene.rigid {
                let own = copy * bodies.count..(copy + 1) * bodies.count;
                reached.orientation[own.clone()].copy_from_slice(&bodies.orientation[own.clone()]);
                reached.angular_velocity[own.clone()].copy_from_slice(&bodies.angular_velocity[own]);
            }
        }
    }
    Ok(())
}

/// Integrates units once more, up to a time at which they are finite; if not all of them come there, where the first ends.
fn again(
    part: &Part<'_>,
    request: &Request,
    apart: &[&Report],
    time: f64,
    reached: &mut Reached,
    ticker: &mut Ticker<'_>,
) -> Result<Option<f64>> {
    let nothing =
        Wanted { position: false, velocity: false, derived: Vec::new(), keep_states: false, rigid: 0 };
    let mut columns = Columns::new(part.scene.copies, 1, part.scene.particles, &nothing)?;
    let writer = columns.writer(part.scene, None, part.plan.threads.1);
    let times = [time];
    let job = Job {
        scene: part.scene,
        plan: part.plan,
        times: &times,
        rtol: part.plan.rtol(request),
        asked_rtol: request.rtol,
        atol: request.atol.as_ref(),
        max_step: part.plan.max_step(request),
        first_step: request.first_step.unwrap_or(f64::MAX),
        max_steps: u64::MAX,
        watches: false,
        from: part.from(),
        keeps: false,
        writer: &writer,
    };
    let units: Vec<Unit> = apart.iter().map(|report| report.unit.clone()).collect();
    let reports = integrate::run_units(&job, units, ticker)?;
    let t0 = part.whole.t0;
    let short = reports.iter().filter(|report| report.ending != Ending::Finished);
    let time_of = |report: &Report| if report.ending == Ending::NotFinite { t0 } else { report.time };
    let short = short.map(time_of).min_by(|a, b| (a - t0).abs().total_cmp(&(b - t0).abs()));
    if short.is_none() {
        reports.iter().for_each(|report| put(part, report, reached));
    }
    Ok(short)
}
