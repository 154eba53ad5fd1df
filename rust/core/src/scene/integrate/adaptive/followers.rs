//! Massless bodies that follow massive ones through their steps, eight side by side, each with steps of its own.
//!
//! The one idea: once a step of the massive bodies is accepted, and before they are moved on, every massless body is
//! taken through it, by the same driver that moves the massive ones. So its steps depend on them and on itself alone.

use super::super::super::distance;
use super::super::super::layout::Layout;
use super::super::super::unit::{Prepared, Unit};
use super::super::report::Ending;
use super::super::{Job, Report, Result};
use super::guide::{Guided, Path, Paths};
use super::{Forces, Run};
use crate::forces::term::Coupling;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::parallel::Ticker;
use std::sync::Arc;

/// A step of the massive bodies, lane by lane.
pub(super) struct Span {
    /// The lanes in which there is one.
    pub(super) lanes: Bits,
    /// Elapsed time before it, and after it.
    pub(super) from: Lanes,
    pub(super) to: Lanes,
    /// Whether it leads to the end of the run.
    pub(super) last: Bits,
    pub(super) path: Arc<Path>,
}

/// The massless bodies that follow the massive ones in the lanes now. Packed, those of one system are in all the lanes;
/// batched, those of each system in the lane of their massive ones.
pub(super) struct Followers<'a> {
    job: &'a Job<'a>,
    /// Those of each unit of the run.
    units: &'a [&'a [Unit]],
    outputs: Arc<[f64]>,
    runs: Vec<Run<'a>>,
    /// The ways of the massive ones.
    pub(super) paths: Paths,
    /// Whether they ask for the velocities of massive bodies.
    pub(super) moving: bool,
}

impl<'a> Followers<'a> {
    pub(super) fn new(job: &'a Job<'a>, units: &'a [&'a [Unit]], outputs: &Arc<[f64]>) -> Self {
        Self {
            job,
            units,
            outputs: Arc::clone(outputs),
            runs: Vec::new(),
            paths: Paths::default(),
            moving: false,
        }
    }

    /// Whether there are any in the run.
    pub(super) fn any(&self) -> bool {
        self.units.iter().any(|units| !units.is_empty())
    }

    /// Takes up those of the unit `index`, which was given a lane.
    ///
    /// # Errors
    /// When the caller asks to stop.
    pub(super) fn take_up(
        &mut self,
        lane: usize,
        index: usize,
        guide: &Prepared,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Some(units) = self.units.get(index) else { return Ok(()) };
        for (place, unit) in units.iter().enumerate() {
            let mut unit = self.job.prepare(unit, ticker)?;
            measure(&mut unit, guide, self.job, ticker)?;
            let (run, lane) = match self.job.plan.layout {
                Layout::Packed => (place / WIDTH, place % WIDTH),
                Layout::Batched => (place, lane),
            };
            if run == self.runs.len() {
                let guided = Guided::new(self.job.plan, guide, &[&unit])?;
                self.moving = guided.asks_for_velocities();
                self.runs.push(Run::new(self.job, unit.clone(), Forces::Along(guided), &self.outputs)?);
            }
            let run = &mut self.runs[run];
            if let Forces::Along(guided) = &mut run.forces {
                guided.attach(self.job.plan, guide, Layout::Batched.mask(lane));
            }
            run.put(lane, place, unit, ticker)?;
        }
        Ok(())
    }

    /// Takes all through a step of the massive bodies.
    ///
    /// # Errors
    /// When the caller asks to stop.
    pub(super) fn through(&mut self, span: &Span, ticker: &mut Ticker<'_>) -> Result<()> {
        self.runs.iter_mut().try_for_each(|run| run.through(span, ticker))
    }

    /// Those that follow the massive bodies in a lane, which have ended, end as they did.
    pub(super) fn end(&mut self, lane: usize, ending: &Ending) {
        let lanes = self.job.plan.layout.mask(lane);
        self.runs.iter_mut().for_each(|run| run.end_with(lanes, ending));
    }

    /// The reports so far.
    pub(super) fn reports(self) -> impl Iterator<Item = (usize, Report)> {
        self.runs.into_iter().flat_map(Run::into_reports)
    }
}

/// What the errors of a massless body are measured against: its distance from the nearest of the massive ones and its
/// speed, or that of a circular orbit.
///
/// # Errors
/// When the caller asks to stop.
fn measure(unit: &mut Prepared, guide: &Prepared, job: &Job<'_>, ticker: &mut Ticker<'_>) -> Result<()> {
    let plan = job.plan;
    let forces = plan.forces_of(unit.unit.copy);
    let (place, velocity) = (unit.position[0], unit.velocity[0]);
    let nearest = guide.position.iter().map(|&other| distance(place, other)).fold(f64::INFINITY, f64::min);
    let softening = forces.iter().map(|force| force.length()).fold(0.0, f64::max);
    let nearest = nearest.max(plan.units.take(softening, [1, 0, 0]));
    let length = if nearest > 0.0 && nearest.is_finite() { nearest } else { 1.0 };
    let total: f64 = guide.strength.iter().map(|x| x.abs()).sum();
    let orbital = (total / distance(place, guide.reference.center).max(length)).sqrt();
    let speed = distance(velocity, guide.reference.drift).max(orbital);
    unit.reference = guide.reference;
    // Where there is neither, a body has the measure of the fall to the massive ones, or in another field.
    let rests = speed == 0.0;
    let mut speed = if rests { unit.size.1 } else { speed };
    if rests {
        let itself = (unit.unit.bodies[0], unit.mass[0], place);
        for ((&body, &mass), &other) in guide.unit.bodies.iter().zip(&guide.mass).zip(&guide.position) {
            for force in forces.iter().filter(|force| force.coupling() == Coupling::AllPairs) {
                let pair = [(body, mass, other), itself];
                let field = force.strongest(&pair, plan.units, [plan.t0; 3], ticker)?;
                speed = speed.max((field * length).sqrt());
            }
        }
    }
    unit.size = (length, speed);
    Ok(())
}
