//! Members whose motion is known: the rows of all of them, shared out over threads.
//!
//! Some rows at a time are computed and written, so that an interrupted run keeps what it has. A row depends on nothing but
//! its member and its time: where the parts are cut changes no bit.

use super::Scene;
use super::columns::{Entry, Writer};
use super::plan::{Plan, member};
use crate::closed_forms::{ExactState, Member, Motion, Shared};
use crate::error::{Error, Result};
use crate::forces::bodies::PreciseBodies;
use crate::numerics::double_double::DoubleDouble;
use crate::parallel::{Ticker, for_chunks};
use core::ops::Range;

/// States that one thread computes at a time, about: of one member, and of several, for which much may be the same.
const STATES_PER_CHUNK: [usize; 2] = [1_024, 4_096];
/// Rows for which preparing the motion once more does not count: of one particle, and of many.
const FEWEST_ROWS: [usize; 2] = [256, 32];
/// Members to one thread at a time, for which the work may still be shared out unevenly.
const FEW_COPIES: usize = 8;
/// Rows of a member that are computed together, …
const ROWS_TOGETHER: usize = 32;
/// … unless they have more states than these: 25 MB.
const MOST_STATES: usize = 1 << 18;

/// How the rows of all members are cut into parts: so many following ones, of so many members.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    rows: usize,
    copies: usize,
    /// How many parts there are of each of both.
    parts: [usize; 2],
}

impl Cut {
    pub(super) fn new(particles: usize, copies: usize, rows: usize, threads: usize) -> Self {
        let [of_one, of_many] = STATES_PER_CHUNK.map(|states| states / particles.max(1));
        let fewest = (FEWEST_ROWS[0] / particles.max(1)).max(FEWEST_ROWS[1]);
        let together = rows.min(if copies > 1 { fewest } else { of_one.max(fewest) }).max(1);
        let of_rows = rows.div_ceil(together);
        let even = (copies * of_rows).div_ceil(8 * threads.max(1)).max(FEW_COPIES);
        let members = (of_many / together).min(even).clamp(1, copies.max(1));
        Self { rows: together, copies: members, parts: [of_rows, copies.div_ceil(members)] }
    }

    /// How many parts there are.
    pub(super) const fn parts(&self) -> usize {
        self.parts[0] * self.parts[1]
    }

    /// The members of a part, and their rows.
    fn part(&self, part: usize, copies: usize, rows: usize) -> [Range<usize>; 2] {
        let range = |at: usize, each: usize, all: usize| at * each..all.min((at + 1) * each);
        [range(part / self.parts[0], self.copies, copies), range(part % self.parts[0], self.rows, rows)]
    }
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

/// The same while it is computed.
struct Filling<'a> {
    segment: Segment,
    member: Member<'a>,
    motion: Box<dyn Motion>,
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
    let cut = Cut::new(scene.particles, scene.copies, times.len(), plan.threads.0);
    ticker.control().add_total((scene.copies * times.len()) as u64);
    let parts = for_chunks(plan.threads.0, cut.parts(), ticker, |part, ticker| {
        let [copies, rows] = cut.part(part, scene.copies, times.len());
        let mut worker = Worker {
            scene,
            plan,
            times,
            writer,
            shared: Shared::default(),
            bodies: PreciseBodies::default(),
            exact: Vec::new(),
            entries: Vec::new(),
            last: Vec::new(),
        };
        let mut fillings = Vec::with_capacity(copies.len());
        match worker.fill(copies, rows, &mut fillings, ticker) {
            Ok(()) | Err(Error::Interrupted) => {}
            Err(other) => return Err(other),
        }
        Ok(fillings.into_iter().map(|filling| filling.segment).collect::<Vec<_>>())
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
    shared: Shared,
    bodies: PreciseBodies,
    exact: Vec<ExactState>,
    entries: Vec<Entry>,
    last: Vec<Entry>,
}

impl<'a> Worker<'a> {
    /// Computes some rows of some members, until all are beyond the range or the caller asks to stop.
    fn fill(
        &mut self,
        copies: Range<usize>,
        rows: Range<usize>,
        fillings: &mut Vec<Filling<'a>>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        for copy in copies {
            ticker.tick()?;
            let member = member(self.scene, copy);
            let form = self.plan.solutions.of_member(copy);
            let Some(form) = form else {
                return Err(Error::Internal("a member has no closed form".to_owned()));
            };
            let motion = (form.motion)(&member, &mut self.shared, ticker)?;
            let segment = Segment { copy, first: rows.start, report: Report::default() };
            fillings.push(Filling { segment, member, motion });
        }
        let together = (MOST_STATES / self.scene.particles.max(1)).clamp(1, ROWS_TOGETHER);
        for first in rows.clone().step_by(together) {
            let rows = first..rows.end.min(first + together);
            for filling in fillings.iter_mut() {
                if !filling.segment.report.beyond {
                    self.go_on(filling, rows.clone(), ticker)?;
                }
                ticker.advance(rows.len() as u64);
            }
        }
        Ok(())
    }

    /// Computes the next rows of a member, until one is beyond the range or the caller asks to stop.
    fn go_on(
        &mut self,
        filling: &mut Filling<'_>,
        rows: Range<usize>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Filling { segment: Segment { report, .. }, motion, .. } = filling;
        let before = report.rows;
        self.compute(&**motion, &self.times[rows.clone()], ticker)?;
        let told = self.write(filling, rows, ticker);
        let report = &mut filling.segment.report;
        if report.rows > before {
            report.states = self.last.iter().map(|entry| [entry.position, entry.velocity]).collect();
        }
        told
    }

    /// Writes what was computed.
    fn write(
        &mut self,
        filling: &mut Filling<'_>,
        rows: Range<usize>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Filling { segment: Segment { copy, report, .. }, member, .. } = filling;
        for (place, index) in rows.enumerate() {
            self.take(*copy, (place, self.times[index]));
            let finite = |x: &[f64; 3]| x.iter().all(|x| x.is_finite());
            if !self.entries.iter().all(|entry| finite(&entry.position) && finite(&entry.velocity)) {
                report.beyond = true;
                return Ok(());
            }
            self.write_row(member, (*copy, index), ticker)?;
            core::mem::swap(&mut self.entries, &mut self.last);
            report.rows += 1;
            ticker.tick()?;
        }
        Ok(())
    }

    /// The states at some times, unrounded.
    fn compute(&mut self, motion: &dyn Motion, times: &[f64], ticker: &mut Ticker<'_>) -> Result<()> {
        let Scene { t0, t0_rest, .. } = *self.scene;
        let since = |&t: &f64| DoubleDouble::sum(t, -t0) - DoubleDouble::from(t0_rest);
        let elapsed: Vec<_> = times.iter().map(since).collect();
        motion.states(&elapsed, &mut self.exact, ticker)
    }

    /// The entries of one of them.
    fn take(&mut self, copy: usize, (place, t): (usize, f64)) {
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
            return;
        }
        let exact = &exact[place * scene.particles..(place + 1) * scene.particles];
        entries.extend(exact.iter().map(|(position, velocity)| Entry {
            position: position.map(DoubleDouble::high),
            velocity: velocity.map(DoubleDouble::high),
            position_rest: position.map(DoubleDouble::low),
            velocity_rest: velocity.map(DoubleDouble::low),
        }));
    }

    fn write_row(
        &mut self,
        member: &Member<'_>,
        (copy, index): (usize, usize),
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
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
        Ok(())
    }
}
