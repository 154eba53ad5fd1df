//! What steps of half or twice the length make of the energy at the end, where forces may give and take any, or take some: no law
//! tells then whether a run was thrown off course, but the method does.
//!
//! Looked at where the energy has changed as it does where bodies meet between two steps, and where running half and, if that
//! tells of something, twice as many steps costs a moment.

use super::Part;
use super::resolved::energy_of;
use crate::error::Result;
use crate::forces::bodies::PreciseBodies;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::scene::columns::{Columns, Wanted};
use crate::scene::integrate::{self, Ending, Job};
use crate::scene::plan::Plan;
use crate::scene::request::Request;

/// Pairs, and bodies, of all evaluations of a run that is done again: some tenths of a second.
const MOMENT: u64 = 1 << 25;

/// Whether a run of equal steps may be done again, after so many evaluations.
pub(super) fn pays(part: &Part<'_>, evaluations: u64) -> bool {
    let Part { scene, plan, .. } = *part;
    let each = scene.particles as u64 + plan.pairs_per_evaluation();
    let plainly = scene.copies == 1 && plan.from == 0 && !plan.touching && plan.transformed.is_none();
    plainly && plan.dt.is_some() && evaluations.saturating_mul(each) <= MOMENT
}

fn left_to_do(ticker: &Ticker<'_>) -> u64 {
    let (done, total) = ticker.control().progress();
    total.saturating_sub(done)
}

/// Kinetic and potential energy where steps so many times as long lead; none if they lead nowhere.
///
/// # Errors
/// None but those of the library itself.
pub(super) fn energy_at_end(
    part: &Part<'_>,
    request: &Request,
    times_as_long: f64,
    ticker: &mut Ticker<'_>,
) -> Result<Option<Scaled>> {
    let scene = part.scene;
    let times = [request.times[request.times.len() - 1]];
    let other = Request {
        times: times.to_vec(),
        method: part.plan.method.name.to_owned(),
        dt: part.plan.dt.map(|dt| times_as_long * dt.abs()),
        events: Vec::new(),
        record: Vec::new(),
        max_steps: None,
        ..request.clone()
    };
    let plan = Plan::new(scene, &other, ticker)?;
    let nothing =
        Wanted { position: false, velocity: false, derived: Vec::new(), keep_states: false, rigid: 0 };
    let mut columns = Columns::new(scene.copies, 1, scene.particles, &nothing)?;
    let writer = columns.writer(scene, None, plan.threads.1);
    let job = Job {
        scene,
        plan: &plan,
        times: &times,
        rtol: plan.rtol(&other),
        asked_rtol: other.rtol,
        atol: other.atol.as_ref(),
        max_step: plan.max_step(&other),
        first_step: f64::MAX,
        max_steps: u64::MAX,
        watches: false,
        from: None,
        keeps: false,
        writer: &writer,
    };
    let before = left_to_do(ticker);
    let reports = integrate::run(&job, ticker);
    // Steps that end early leave some of theirs, which nobody is to wait for.
    ticker.advance(left_to_do(ticker).saturating_sub(before));
    let reports = reports?;
    if reports.iter().any(|report| report.ending != Ending::Finished) {
        return Ok(None);
    }
    let (mut position, mut velocity) = (scene.positions(0).to_vec(), scene.velocities(0).to_vec());
    for report in &reports {
        for (state, slot) in report.states.iter().zip(report.unit.recorded.clone()) {
            let body = report.unit.bodies[slot];
            (position[body], velocity[body]) = (state[0], state[1]);
        }
    }
    let mut bodies = PreciseBodies::default();
    let (kinetic, potential) = energy_of(scene, 0, (&position, &velocity), &mut bodies, ticker)?;
    Ok(Some(kinetic.plus(potential)))
}
