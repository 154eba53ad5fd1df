//! A unit's bodies, read off a state and written into the columns at an output time.
//!
//! A run of cheap steps with many outputs spends its time here, so what can be decided is decided once, when the
//! unit is prepared; and packed bodies go eight at a time, coordinates into points by the tier's vectors.

use super::super::columns::{Output, Run, Writer};
use super::super::frame::{Moved, Units, restored};
use super::{Layout, Origin, Prepared, Unit};
use crate::error::Result;
use crate::forces::bodies::{Of, PreciseBodies};
use crate::numerics::fused_double::FusedDouble;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers};
use crate::numerics::power_of_two::power_of_two;
use crate::numerics::real::Mask;
use crate::ode::state::State;
use crate::parallel::Ticker;
use crate::tiered;

/// How a unit is read off.
#[derive(Clone, Debug)]
pub(super) struct Reading {
    /// What takes a length and a velocity back to the scene's units.
    factors: [f64; 2],
    /// Whether they are relative to an origin that has to be added.
    moved: bool,
    way: Way,
}

#[derive(Clone, Debug)]
enum Way {
    /// Body after body.
    Bodies,
    /// Row after row, from the row `start` on.
    Rows { start: usize, runs: Vec<Run> },
}

impl Reading {
    pub(super) fn new(unit: &Unit, layout: Layout, origin: &Origin, units: Units) -> Self {
        let moved = origin.is_elsewhere();
        let way = if layout == Layout::Packed { rows(unit).unwrap_or(Way::Bodies) } else { Way::Bodies };
        Self { factors: [power_of_two(units.length), power_of_two(-units.velocity())], moved, way }
    }
}

/// The rows of a packed unit, if the particles of each follow each other in the scene. Massless ones begin a row of
/// their own, and a unit records from the beginning of a row on.
fn rows(unit: &Unit) -> Option<Way> {
    let start = unit.recorded.start.div_ceil(WIDTH);
    let border = unit.active.clamp(unit.recorded.start, unit.recorded.end);
    let kinds = [unit.recorded.start..border, border..unit.recorded.end];
    let rows = kinds.into_iter().flat_map(|kind| unit.bodies[kind].chunks(WIDTH));
    let runs = rows.map(|bodies| {
        let (first, last) = (bodies[0], bodies[bodies.len() - 1]);
        (last - first + 1 == bodies.len()).then(|| Run::new(first, bodies.len()))
    });
    Some(Way::Rows { start, runs: runs.collect::<Option<_>>()? })
}

impl Prepared {
    /// Records the unit's bodies at an output time; `false` if they are no longer finite.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted): the record of this time is then not whole.
    #[inline(always)]
    pub fn record(
        &self,
        writer: &Writer<'_>,
        time: usize,
        state: &State<Lanes>,
        unit_lane: usize,
        elapsed: f64,
        ticker: &mut Ticker<'_>,
    ) -> Result<bool> {
        // SAFETY: a particle is recorded from one unit (`run` looked), and one thread has the unit.
        let output = unsafe { writer.output(self.unit.copy, time) };
        let finite = self.record_states(writer, &output, state, unit_lane, elapsed);
        if writer.derives() && self.unit.leads && finite {
            self.derive(writer, &output, state, unit_lane, elapsed, ticker)?;
        }
        Ok(finite)
    }

    #[inline(always)]
    fn record_states(
        &self,
        writer: &Writer<'_>,
        output: &Output<'_>,
        state: &State<Lanes>,
        unit_lane: usize,
        elapsed: f64,
    ) -> bool {
        if writer.keeps_rest() {
            return self.record_precisely(output, state, unit_lane, elapsed);
        }
        let Reading { moved, way, .. } = &self.reading;
        let planar = self.shape.components == 2;
        let read = (self, state, elapsed, output);
        match (way, planar, *moved) {
            (Way::Rows { start, runs }, true, false) => record_rows::<2, false>(read, *start, runs),
            (Way::Rows { start, runs }, false, false) => record_rows::<3, false>(read, *start, runs),
            (Way::Rows { start, runs }, true, true) => record_rows::<2, true>(read, *start, runs),
            (Way::Rows { start, runs }, false, true) => record_rows::<3, true>(read, *start, runs),
            (Way::Bodies, true, false) => record_bodies::<2, false>(read, unit_lane),
            (Way::Bodies, false, false) => record_bodies::<3, false>(read, unit_lane),
            (Way::Bodies, true, true) => record_bodies::<2, true>(read, unit_lane),
            (Way::Bodies, false, true) => record_bodies::<3, true>(read, unit_lane),
        }
    }

    /// With what the rounded values leave out.
    fn record_precisely(
        &self,
        output: &Output<'_>,
        state: &State<Lanes>,
        unit_lane: usize,
        elapsed: f64,
    ) -> bool {
        let mut finite = true;
        for slot in self.unit.recorded.clone() {
            let entry = self.read(slot, state, unit_lane, elapsed);
            finite &= entry.position.iter().chain(&entry.velocity).all(|x| x.is_finite());
            output.write(self.unit.bodies[slot], &entry);
        }
        finite
    }
}

impl Prepared {
    /// Derives columns from the state and its compensation.
    #[inline(never)]
    fn derive(
        &self,
        writer: &Writer<'_>,
        output: &Output<'_>,
        state: &State<Lanes>,
        unit_lane: usize,
        elapsed: f64,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let unit = &self.unit;
        // Massless bodies have no share in anything, unless there are no others.
        let count = if unit.active > 0 { unit.active } else { unit.bodies.len() };
        let mut bodies = self.scratch.borrow_mut();
        if !bodies.keeps_masses(count) {
            bodies.clear(count);
            let masses = writer.masses(unit.copy);
            for (slot, &body) in unit.bodies[..count].iter().enumerate() {
                bodies.set_mass(slot, masses[body]);
            }
        }
        let read = (self, state, elapsed, output);
        match (self.layout, self.shape.components == 2) {
            (Layout::Packed, true) => gather_rows::<2>(read, &mut bodies),
            (Layout::Packed, false) => gather_rows::<3>(read, &mut bodies),
            (Layout::Batched, _) => self.gather_bodies(state, unit_lane, elapsed, &mut bodies),
        }
        bodies.settle();
        output.derive(&bodies, ticker)
    }

    /// Of a unit that has one lane.
    fn gather_bodies(
        &self,
        state: &State<Lanes>,
        unit_lane: usize,
        elapsed: f64,
        bodies: &mut PreciseBodies,
    ) {
        let (rows, components) = (state.q().len() / self.shape.components, self.shape.components);
        let (y, error) = state.all();
        let (y, error) = (as_numbers(y), as_numbers(error));
        let (row, lane) = self.locate(0, unit_lane);
        let moved = if self.reading.moved { self.origin.at(elapsed) } else { Moved::NOWHERE };
        let [length, speed] = self.reading.factors;
        for (of, factor, first, origin) in
            [(Of::Position, length, 0, moved.position), (Of::Velocity, speed, components, moved.velocity)]
        {
            for c in 0..3 {
                let [values, rests] = bodies.coordinates_mut(of, c);
                if c < components {
                    let from = ((first + c) * rows + row) * WIDTH + lane;
                    for (into, from) in [(&mut *values, &y[from..]), (&mut *rests, &error[from..])] {
                        into.iter_mut()
                            .zip(from.iter().step_by(WIDTH))
                            .for_each(|(into, from)| *into = from * factor);
                    }
                } else {
                    values.fill(0.0);
                    rests.fill(0.0);
                }
                if self.reading.moved {
                    for (value, rest) in values.iter_mut().zip(rests) {
                        (*value, *rest) = restored(origin[c], (*value, *rest));
                    }
                }
            }
        }
    }
}

/// A unit, the state that it is in, the elapsed time, and where it is recorded.
type Read<'a> = (&'a Prepared, &'a State<Lanes>, f64, &'a Output<'a>);

tiered! {
    fn record_rows[const COMPONENTS: usize, const MOVED: bool][COMPONENTS, MOVED](read: Read<'_>, start: usize, runs: &[Run]) -> bool = rows_as_points;
    fn record_bodies[const COMPONENTS: usize, const MOVED: bool][COMPONENTS, MOVED](read: Read<'_>, unit_lane: usize) -> bool = body_after_body;
    fn gather_rows[const COMPONENTS: usize][COMPONENTS](read: Read<'_>, bodies: &mut PreciseBodies) = rows_of_bodies;
}

/// A pair of numbers in every lane.
#[inline(always)]
fn splat<V: Vector8>((value, rest): (f64, f64)) -> (V, V) {
    (V::splat(value), V::splat(rest))
}

#[inline(always)]
fn rows_as_points<V: Vector8, const COMPONENTS: usize, const MOVED: bool>(
    (unit, state, elapsed, output): Read<'_>,
    start: usize,
    runs: &[Run],
) -> bool {
    let origin = if MOVED { unit.origin.at(elapsed) } else { Moved::NOWHERE };
    let [length, speed] = unit.reading.factors;
    let (length, speed) = (V::splat(length), V::splat(speed));
    let rows = state.q().len() / COMPONENTS;
    // Velocities follow the coordinates.
    let (y, rest) = state.all();
    let mut finite = Bits::splat(true);
    for (row, run) in (start..).zip(runs) {
        let (mut position, mut velocity) = ([V::zero(); 3], [V::zero(); 3]);
        if MOVED {
            position[2] = V::splat(origin.position[2].0);
            velocity[2] = V::splat(origin.velocity[2].0);
        }
        let mut check = V::zero();
        for c in 0..COMPONENTS {
            let (q, v) = (c * rows + row, (COMPONENTS + c) * rows + row);
            position[c] = V::load(y[q]) * length;
            velocity[c] = V::load(y[v]) * speed;
            if MOVED {
                let (q_rest, v_rest) = (V::load(rest[q]) * length, V::load(rest[v]) * speed);
                position[c] = restored(splat::<V>(origin.position[c]), (position[c], q_rest)).0;
                velocity[c] = restored(splat::<V>(origin.velocity[c]), (velocity[c], v_rest)).0;
            }
            // Zero times a finite number is zero; times anything else it is not a number.
            check += V::zero() * position[c] + V::zero() * velocity[c];
        }
        finite = finite.and(check.less_equal(V::zero()).or(run.idle));
        let ([x, y, z], [u, v, w]) = (position, velocity);
        output.write_points(run, V::interleave(x, y, z), V::interleave(u, v, w));
    }
    finite.all()
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "`tiered!` names a vector type to all that it compiles"
)]
#[inline(always)]
fn body_after_body<V: Vector8, const COMPONENTS: usize, const MOVED: bool>(
    (unit, state, elapsed, output): Read<'_>,
    unit_lane: usize,
) -> bool {
    let origin = if MOVED { unit.origin.at(elapsed) } else { Moved::NOWHERE };
    let [length, speed] = unit.reading.factors;
    let stride = state.q().len() / COMPONENTS * WIDTH;
    let (q, v) = (as_numbers(state.q()), as_numbers(state.v()));
    let (q_rest, v_rest) = (as_numbers(state.q_compensation()), as_numbers(state.v_compensation()));
    // Sums of their own, lest each addition wait for the one before.
    let mut check = [[0.0; 2]; COMPONENTS];
    for slot in unit.unit.recorded.clone() {
        let (row, lane) = unit.locate(slot, unit_lane);
        let (mut position, mut velocity) = ([0.0; 3], [0.0; 3]);
        if MOVED {
            (position[2], velocity[2]) = (origin.position[2].0, origin.velocity[2].0);
        }
        for c in 0..COMPONENTS {
            let at = c * stride + row * WIDTH + lane;
            position[c] = q[at] * length;
            velocity[c] = v[at] * speed;
            if MOVED {
                position[c] = restored(origin.position[c], (position[c], q_rest[at] * length)).0;
                velocity[c] = restored(origin.velocity[c], (velocity[c], v_rest[at] * speed)).0;
            }
            // As in `rows_as_points`.
            check[c][0] += 0.0 * position[c];
            check[c][1] += 0.0 * velocity[c];
        }
        output.write_rounded(unit.unit.bodies[slot], position, velocity);
    }
    check.iter().flatten().all(|&sum| sum == 0.0)
}

/// Positions and velocities of a packed unit, from the first row on, with what they leave out.
#[inline(always)]
fn rows_of_bodies<V: Vector8, const COMPONENTS: usize>(
    (unit, state, elapsed, _): Read<'_>,
    bodies: &mut PreciseBodies,
) {
    let Reading { factors: [length, speed], moved, .. } = unit.reading;
    let origin = if moved { unit.origin.at(elapsed) } else { Moved::NOWHERE };
    let rows = state.q().len() / COMPONENTS;
    let (y, rest) = state.all();
    for (of, factor, first, origin) in
        [(Of::Position, length, 0, origin.position), (Of::Velocity, speed, COMPONENTS, origin.velocity)]
    {
        let factor = V::splat(factor);
        for c in 0..3 {
            for row in 0..bodies.len().div_ceil(WIDTH) {
                let at = (first + c) * rows + row;
                let mut value = (V::zero(), V::zero());
                if c < COMPONENTS {
                    value = (V::load(y[at]) * factor, V::load(rest[at]) * factor);
                }
                if moved {
                    value = restored(splat::<V>(origin[c]), value);
                }
                bodies.set_row(of, c, row * WIDTH, FusedDouble { high: value.0, low: value.1 });
            }
        }
    }
}
