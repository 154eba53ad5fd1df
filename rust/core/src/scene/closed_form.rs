//! Members whose motion is known: the rows of all of them, shared out over threads.
//!
//! Each row is written as it is computed, so that an interrupted run keeps what it has. A row depends on nothing but
//! its member and its time: where the parts are cut changes no bit.

use super::Scene;
use super::columns::{Entry, Writer};
use super::plan::{Plan, member};
use crate::closed_forms::{ExactState, Motion};
use crate::error::{Error, Result};
use crate::forces::bodies::PreciseBodies;
use crate::numerics::double_double::DoubleDouble;
use crate::parallel::{Ticker, for_chunks};

/// States that one thread computes at a time, about.
const STATES_PER_CHUNK: usize = 512;
/// Rows for which preparing the motion once more does not count.
const FEWEST_ROWS: usize = 16;

/// Rows, of one member after another, that one thread computes at a time.
pub(super) fn rows_per_chunk(particles: usize) -> usize {
    (STATES_PER_CHUNK / particles.max(1)).max(FEWEST_ROWS)
}

/// What became of a member.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Rows recorded.
    pub rows: usize,
    /// Whether the next one is beyond the range of numbers.
    pub beyond: bool,
    /// The states of the last row; empty if there is none.
    pub states: Vec<[[f64; 3]; 2]>,
}

/// Some rows of a member that follow each other.
struct Segment {
    copy: usize,
    first: usize,
    report: Report,
}

/// Fills the columns; what became of each member.
///
/// # Errors
/// What a closed form refuses, by name. A caller who asks to stop is in the reports.
pub fn run(
    scene: &Scene,
    plan: &Plan,
    times: &[f64],
    writer: &Writer<'_>,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Report>> {
    let rows = scene.copies * times.len();
    let together = rows_per_chunk(scene.particles);
    ticker.control().add_total(rows as u64);
    let parts = for_chunks(plan.threads.0, rows.div_ceil(together), ticker, |chunk, ticker| {
        let (mut row, end) = (chunk * together, rows.min((chunk + 1) * together));
        let mut worker = Worker {
            scene,
            plan,
            times,
            writer,
            bodies: PreciseBodies::default(),
            exact: Vec::new(),
            entries: Vec::new(),
            last: Vec::new(),
        };
        let mut segments = Vec::new();
        while row < end && ticker.tick().is_ok() {
            let (copy, first) = (row / times.len(), row % times.len());
            let last = times.len().min(first + (end - row));
            segments.push(Segment { copy, first, report: worker.fill(copy, first..last, ticker)? });
            ticker.advance((last - first) as u64);
            row += last - first;
        }
        Ok(segments)
    })?;
    let mut reports = vec![Report::default(); scene.copies];
    for Segment { copy, first, report } in parts.into_iter().flatten() {
        let whole = &mut reports[copy];
        // What comes after a gap is not there.
        if whole.rows == first && !whole.beyond && (report.rows > 0 || report.beyond) {
            whole.beyond = report.beyond;
            if report.rows > 0 {
                *whole = Report { rows: first + report.rows, ..report };
            }
        }
    }
    Ok(reports)
}

/// A thread's.
struct Worker<'a> {
    scene: &'a Scene,
    plan: &'a Plan,
    times: &'a [f64],
    writer: &'a Writer<'a>,
    bodies: PreciseBodies,
    exact: Vec<ExactState>,
    entries: Vec<Entry>,
    last: Vec<Entry>,
}

impl Worker<'_> {
    /// Computes some rows of a member, until one is beyond the range or the caller asks to stop.
    fn fill(
        &mut self,
        copy: usize,
        rows: core::ops::Range<usize>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Report> {
        let mut report = Report::default();
        let told = self.try_fill(copy, rows, &mut report, ticker);
        if report.rows > 0 {
            report.states = self.last.iter().map(|entry| [entry.position, entry.velocity]).collect();
        }
        match told {
            Err(Error::Interrupted) | Ok(()) => Ok(report),
            Err(other) => Err(other),
        }
    }

    fn try_fill(
        &mut self,
        copy: usize,
        rows: core::ops::Range<usize>,
        report: &mut Report,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let member = member(self.scene, copy);
        let form = self.plan.solutions.of_member(copy);
        let Some(form) = form else { return Err(Error::Internal("a member has no closed form".to_owned())) };
        let motion = (form.motion)(&member, ticker)?;
        for index in rows {
            self.state(&*motion, copy, self.times[index], ticker)?;
            let finite = |x: &[f64; 3]| x.iter().all(|x| x.is_finite());
            if !self.entries.iter().all(|entry| finite(&entry.position) && finite(&entry.velocity)) {
                report.beyond = true;
                return Ok(());
            }
            // SAFETY: the rows of different chunks are different, and one thread has this one.
            let output = unsafe { self.writer.output(copy, index) };
            for (particle, entry) in self.entries.iter().enumerate() {
                output.write(particle, entry);
            }
            if self.writer.derives() {
                self.bodies.clear(self.entries.len());
                for (particle, entry) in self.entries.iter().enumerate() {
                    let position = [entry.position, entry.position_rest];
                    let velocity = [entry.velocity, entry.velocity_rest];
                    self.bodies.set(particle, member.mass[particle], position, velocity);
                }
                self.bodies.settle();
                output.derive(&self.bodies, ticker)?;
            }
            core::mem::swap(&mut self.entries, &mut self.last);
            report.rows += 1;
            ticker.tick()?;
        }
        Ok(())
    }

    /// The entries at a time.
    fn state(&mut self, motion: &dyn Motion, copy: usize, t: f64, ticker: &mut Ticker<'_>) -> Result<()> {
        let Self { scene, exact, entries, .. } = self;
        entries.clear();
        if t == scene.t0 {
            // The state at the start is the one that was given, to the bit.
            let given = scene.positions(copy).iter().zip(scene.velocities(copy));
            entries.extend(given.map(|(&position, &velocity)| Entry {
                position,
                velocity,
                ..Entry::default()
            }));
            return Ok(());
        }
        let elapsed = DoubleDouble::sum(t, -scene.t0) - DoubleDouble::from(scene.t0_rest);
        motion.states(elapsed, exact, ticker)?;
        entries.extend(exact.iter().map(|(position, velocity)| Entry {
            position: position.map(DoubleDouble::high),
            velocity: velocity.map(DoubleDouble::high),
            position_rest: position.map(DoubleDouble::low),
            velocity_rest: velocity.map(DoubleDouble::low),
        }));
        Ok(())
    }
}
