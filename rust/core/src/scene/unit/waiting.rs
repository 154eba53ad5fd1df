//! States of a packed unit whose energies are formed eight at a time, a state in each lane.
//!
//! One state at a time, most of what an energy costs is to join lanes. So states wait here until there are eight, or
//! the run ends; and an energy that [`SideBySide`] does not know to the last bit is derived from its state as any
//! other column is. What is written is thus the same, only later.

use super::super::columns::Writer;
use super::{Layout, Prepared};
use crate::conservation::columns::Column;
use crate::conservation::side_by_side::SideBySide;
use crate::error::Result;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers};
use crate::numerics::power_of_two::{power_of_two, scale};
use crate::numerics::real::Mask;
use crate::ode::state::State;
use crate::parallel::Ticker;
use crate::tiered;

/// Numbers of states that wait are below this; larger ones may be beyond the range of numbers in the scene's units.
const LARGEST: i32 = 200;

/// States that wait.
#[derive(Clone, Debug)]
pub(super) struct Waiting {
    energies: SideBySide,
    columns: Vec<&'static Column>,
    /// Numbers and what they leave out: a row for each body, of each component of the places and then of the velocities.
    numbers: [Vec<Lanes>; 2],
    /// Output times, and when they are.
    outputs: [(usize, f64); WIDTH],
    /// How far away the origin is at most: at the start, and how much farther in the scene's unit of time.
    origin: [f64; 2],
    /// The same at the output times.
    away: Lanes,
    /// How many there are.
    count: usize,
}

impl Prepared {
    /// Lets states wait if what is derived are energies under gravity alone, of bodies that the unit has in its first rows;
    /// [`catch_up`](Self::catch_up) must then come at the end.
    pub fn may_wait(&self, writer: &Writer<'_>) {
        *self.waiting.borrow_mut() = self.waiting_room(writer).map(Box::new);
    }

    fn waiting_room(&self, writer: &Writer<'_>) -> Option<Waiting> {
        let columns: Vec<_> = writer.derived().collect();
        let energies = !columns.is_empty() && columns.iter().all(|column| column.energies != [false; 2]);
        let plain = self.layout == Layout::Packed && self.starts.is_empty() && !self.origin.falls();
        let [force] = writer.scene().forces_of(self.unit.copy) else { return None };
        let (constant, softening) = force.as_newtonian()?;
        if !energies || !plain || !self.unit.leads {
            return None;
        }
        let (units, mass) = (self.units, &self.mass[..self.unit.active]);
        let gravity = (constant, units.take(softening, [1, 0, 0]));
        let exponents = [units.mass - 2 * units.velocity(), 2 * units.mass - units.length];
        let energies = SideBySide::new(mass, gravity, self.drift(), exponents)?;
        let rows = vec![Lanes::default(); 2 * self.shape.components * energies.count()];
        let numbers = [rows.clone(), rows];
        let farthest = |vector: [f64; 3]| vector.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let origin = [self.origin.center, self.origin.drift];
        let origin = origin.map(|vector| scale(farthest(vector), -units.length));
        let (outputs, away) = ([(0, 0.0); WIDTH], Lanes::default());
        Some(Waiting { energies, columns, numbers, outputs, origin, away, count: 0 })
    }

    /// As [`record`](Self::record), but energies may be recorded later.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted): the record is then not whole.
    #[inline(always)]
    pub fn record_soon(
        &self,
        writer: &Writer<'_>,
        time: usize,
        state: &State<Lanes>,
        unit_lane: usize,
        elapsed: f64,
        ticker: &mut Ticker<'_>,
    ) -> Result<bool> {
        if let Some(waiting) = self.waiting.borrow_mut().as_deref_mut()
            && within(state.all().0)
        {
            // SAFETY: as in `record`.
            let output = unsafe { writer.output(self.unit.copy, time) };
            if writer.writes_states() && !self.record_states(writer, &output, state, unit_lane, elapsed) {
                return Ok(false);
            }
            self.wait(waiting, (time, elapsed), state);
            if waiting.count == WIDTH {
                self.record_energies(waiting, writer, ticker)?;
            }
            return Ok(true);
        }
        self.record(writer, time, state, unit_lane, elapsed, ticker)
    }

    /// Records what has waited.
    ///
    /// # Errors
    /// As [`record_soon`](Self::record_soon).
    pub fn catch_up(&self, writer: &Writer<'_>, ticker: &mut Ticker<'_>) -> Result<()> {
        match self.waiting.borrow_mut().as_deref_mut() {
            Some(waiting) if waiting.count > 0 => self.record_energies(waiting, writer, ticker),
            _ => Ok(()),
        }
    }

    /// Puts a state beside those that wait.
    #[inline]
    fn wait(&self, waiting: &mut Waiting, output: (usize, f64), state: &State<Lanes>) {
        let lane = waiting.count % WIDTH;
        let (count, numbers) = (waiting.energies.count(), state.q().len() / self.shape.components * WIDTH);
        let (y, rest) = state.all();
        for (into, from) in waiting.numbers.iter_mut().zip([y, rest]) {
            for (into, from) in into.chunks_exact_mut(count).zip(as_numbers(from).chunks_exact(numbers)) {
                // Whole rows without a count, which would take longer than what it counts.
                let (mut into, mut from) = (into.chunks_exact_mut(WIDTH), from.chunks_exact(WIDTH));
                for (into, from) in into.by_ref().zip(from.by_ref()) {
                    for body in 0..WIDTH {
                        into[body].0[lane] = from[body];
                    }
                }
                let from = from.next().unwrap_or_default();
                for (into, from) in into.into_remainder().iter_mut().zip(from) {
                    into.0[lane] = *from;
                }
            }
        }
        let [center, drift] = waiting.origin;
        waiting.away.0[lane] = center + drift * output.1.abs();
        waiting.outputs[lane] = output;
        waiting.count = lane + 1;
    }

    #[inline(never)]
    fn record_energies(
        &self,
        waiting: &mut Waiting,
        writer: &Writer<'_>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Waiting { energies, columns, numbers: [y, rest], outputs, away, count, .. } = waiting;
        let rows = energies.count();
        let (q, v) = y.split_at(self.shape.components * rows);
        let (q_rest, v_rest) = rest.split_at(q.len());
        let sums = energies.sums(self.shape.components, (q, q_rest), (v, v_rest), *away);
        let mut known = Bits::splat(true);
        for (index, column) in columns.iter().enumerate() {
            let (values, fine) = energies.energies(&sums, column.energies);
            known = known.and(fine);
            for (value, &(time, _)) in values.0.iter().zip(&outputs[..*count]) {
                // SAFETY: as in `record`.
                unsafe { writer.output(self.unit.copy, time) }.write_derived(index, &[*value]);
            }
        }
        for lane in (0..*count).filter(|&lane| !known.lane(lane)) {
            let (time, elapsed) = outputs[lane];
            let mut bodies = self.scratch.borrow_mut();
            self.keep_masses(writer, &mut bodies);
            self.gather_bodies((y, rest), rows, (0, lane), elapsed, &mut bodies);
            // SAFETY: as in `record`.
            unsafe { writer.output(self.unit.copy, time) }.derive(&bodies, ticker)?;
        }
        *count = 0;
        Ok(())
    }
}

tiered! {
    fn within[][](numbers: &[Lanes]) -> bool = all_within;
}

/// Whether all numbers are finite and no larger than those of states that wait.
#[inline(always)]
fn all_within<V: Vector8>(numbers: &[Lanes]) -> bool {
    let largest = V::splat(power_of_two(LARGEST));
    let mut fine = Bits::splat(true);
    for &number in V::view(numbers) {
        fine = fine.and(number.abs().less(largest));
    }
    fine.all()
}
