//! The first leg of all copies of an ensemble: they run together, in lanes, each to its first contact or to the end.
//!
//! The one idea: most copies meet nobody for most of the way, and up to there they are an ensemble as any other, of which those
//! that touch fall out one by one.

use super::super::{Collisions, contact, flies, may_touch};
use super::start::bodies_of;
use super::wanted;
use crate::error::{Error, Result};
use crate::forces::remaining::Remaining;
use crate::parallel::Ticker;
use crate::scene::Scene;
use crate::scene::columns::Columns;
use crate::scene::events::{Event, What};
use crate::scene::request::Request;
use crate::scene::run::{Events, Kept, Outcome, Output, Reached, run_through};

/// What a leg gives.
pub(super) struct Leg {
    pub(super) outcome: Outcome,
    pub(super) reached: Reached,
    pub(super) columns: Columns,
    pub(super) events: Events,
    pub(super) kept: Option<Kept>,
    /// The node that it went on from.
    pub(super) from: u64,
}

impl Leg {
    /// Of a run of one copy.
    ///
    /// # Errors
    /// A run without an outcome.
    pub(super) fn of(mut output: Output) -> Result<Self> {
        let missing = || Error::Internal("a run without an outcome".to_owned());
        Ok(Self {
            outcome: output.outcomes.pop().ok_or_else(missing)?,
            reached: output.reached,
            columns: output.columns,
            events: output.events,
            kept: output.kept,
            from: output.plan.from,
        })
    }

    /// That of one copy of several which ran together. Who has come to the end has its columns among those of all.
    pub(super) fn of_copy(all: &Output, copy: usize, scene: &Scene, request: &Request) -> Result<Self> {
        let outcome = all.outcomes[copy].clone();
        let own = copy * scene.particles..(copy + 1) * scene.particles;
        let mut columns = Columns::default();
        if outcome.rows < request.times.len() {
            columns = Columns::new(1, outcome.rows, scene.particles, &wanted(request))?;
            columns.take_rows(&all.columns, copy);
        }
        Ok(Self {
            columns,
            outcome,
            reached: Reached {
                position: all.reached.position[own.clone()].to_vec(),
                velocity: all.reached.velocity[own].to_vec(),
                ..Reached::default()
            },
            events: all.events.of_copy(copy, scene.particles),
            kept: all.kept.as_ref().map(|kept| Kept {
                nodes: vec![kept.nodes[copy]],
                t0: kept.t0,
                held: kept.held.of_copy(copy),
            }),
            from: all.plan.from,
        })
    }
}

/// Runs all copies to their first contacts; `None` where they have to be looked at one by one: where some of them fly, their spheres
/// touch at the start or are parts of others, or a function is asked on the way.
///
/// # Errors
/// Those of the run.
pub(super) fn first_leg(
    scene: &Scene,
    request: &Request,
    (rule, direction): (Collisions, f64),
    ticker: &mut Ticker<'_>,
) -> Result<Option<Output>> {
    let calls = |event: &Event| matches!(event.what, What::Function(_));
    if scene.copies == 1 || request.events.iter().any(calls) {
        return Ok(None);
    }
    let meets_nobody_yet = |copy: usize| {
        let bodies = bodies_of(scene, copy, rule, direction);
        may_touch(scene, copy)
            && !flies(scene, copy, request)
            && !Remaining::of(&bodies.host).some_have_gone()
            && bodies.touching().is_empty()
    };
    if !(0..scene.copies).all(meets_nobody_yet) {
        return Ok(None);
    }
    let mut events = request.events.clone();
    events.push(contact(Vec::new()));
    run_through(scene, &Request { events, collisions: None, ..request.clone() }, ticker).map(Some)
}
