//! A unit's bodies, read off a state and written into the columns at an output time.
//!
//! A run of cheap steps with many outputs spends its time here, so what can be decided is decided once, when the
//! unit is prepared; and packed bodies go eight at a time (`rows`), coordinates into points by the tier's vectors.

use super::super::columns::{Consecutive, Output, Writer};
use super::super::frame::{Moved, Units, restored};
use super::rows::{derive_rows, record_rows};
use super::{Layout, Origin, Prepared, Scene, Unit};
use crate::error::Result;
use crate::forces::bodies::{Of, PreciseBodies};
use crate::numerics::lanes::{Lanes, Vector8, WIDTH, as_numbers};
use crate::numerics::power_of_two::power_of_two;
use crate::ode::state::State;
use crate::parallel::Ticker;
use crate::tiered;

/// How a unit is read off.
#[derive(Clone, Debug)]
pub(super) struct Reading {
    /// What takes a length and a velocity back to the scene's units.
    pub(super) factors: [f64; 2],
    /// Whether they are relative to an origin that has to be added.
    pub(super) moved: bool,
    /// Place and velocity of that origin at the start, in the first lanes.
    pub(super) origin: [Lanes; 2],
    way: Way,
    /// Whether columns are derived from rows that are all recorded.
    whole: bool,
}

#[derive(Clone, Debug)]
enum Way {
    /// Body after body.
    Bodies,
    /// Row after row, from the row `start` on.
    Rows { start: usize, runs: Vec<Consecutive> },
}

impl Reading {
    pub(super) fn new(unit: &Unit, layout: Layout, origin: &Origin, units: Units) -> Self {
        let moved = origin.is_elsewhere();
        let way = if layout == Layout::Packed { rows(unit).unwrap_or(Way::Bodies) } else { Way::Bodies };
        let first = |[x, y, z]: [f64; 3]| Lanes([x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0]);
        Self {
            factors: [power_of_two(units.length), power_of_two(-units.velocity())],
            moved,
            origin: [first(origin.center), first(origin.drift)],
            whole: matches!(way, Way::Rows { start: 0, .. }) && unit.recorded.end >= derived_from(unit),
            way,
        }
    }
}

/// How many bodies columns are derived from: massless ones have no share in anything, unless there are no others.
fn derived_from(unit: &Unit) -> usize {
    if unit.active > 0 { unit.active } else { unit.bodies.len() }
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
        (last - first + 1 == bodies.len()).then(|| Consecutive::new(first, bodies.len()))
    });
    Some(Way::Rows { start, runs: runs.collect::<Option<_>>()? })
}

impl Unit {
    /// Records its bodies where the scene has them, in so many rows.
    pub fn record_start(&self, writer: &Writer<'_>, scene: &Scene, rows: usize) {
        let (positions, velocities) = (scene.positions(self.copy), scene.velocities(self.copy));
        for time in 0..rows {
            // SAFETY: as of a unit that has begun.
            let output = unsafe { writer.output(self.copy, time) };
            for &body in &self.bodies[self.recorded.clone()] {
                output.write_rounded(body, positions[body], velocities[body]);
                if let Some(bodies) = &scene.rigid
                    && let Some(place) = body.checked_sub(scene.particles - bodies.count)
                {
                    let at = self.copy * bodies.count + place;
                    output.write_turned(place, (bodies.orientation[at], bodies.angular_velocity[at]));
                }
            }
        }
    }
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
        if !self.starts.is_empty() && !self.record_turning(writer.scene(), &output, state, unit_lane) {
            return Ok(false);
        }
        if writer.derives() && self.unit.leads {
            self.record_and_derive(writer, &output, state, unit_lane, elapsed, ticker)
        } else {
            Ok(self.record_states(writer, &output, state, unit_lane, elapsed))
        }
    }

    #[inline(always)]
    pub(super) fn record_states(
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
    /// Records, and derives columns from the state and its compensation.
    #[inline(never)]
    fn record_and_derive(
        &self,
        writer: &Writer<'_>,
        output: &Output<'_>,
        state: &State<Lanes>,
        unit_lane: usize,
        elapsed: f64,
        ticker: &mut Ticker<'_>,
    ) -> Result<bool> {
        let mut bodies = self.scratch.borrow_mut();
        self.keep_masses(writer, &mut bodies);
        let Reading { moved, way, whole, .. } = &self.reading;
        let runs = match way {
            Way::Rows { runs, .. } if *whole => &runs[..],
            _ => &[],
        };
        if !whole && !self.record_states(writer, output, state, unit_lane, elapsed) {
            return Ok(false);
        }
        let read = (self, state, elapsed, output);
        let finite = match (self.layout, self.shape.components == 2, *moved) {
            (Layout::Packed, true, false) => derive_rows::<2, false>(read, runs, &mut bodies),
            (Layout::Packed, false, false) => derive_rows::<3, false>(read, runs, &mut bodies),
            (Layout::Packed, true, true) => derive_rows::<2, true>(read, runs, &mut bodies),
            (Layout::Packed, false, true) => derive_rows::<3, true>(read, runs, &mut bodies),
            (Layout::Batched, ..) => {
                let rows = self.rows_in(state.q().len());
                let (row, lane) = self.locate(0, unit_lane);
                self.gather_bodies(state.all(), rows, (row, lane), elapsed, &mut bodies);
                true
            }
        };
        if finite {
            output.derive(&bodies, ticker)?;
        }
        Ok(finite)
    }

    /// Sees to it that bodies have the masses from which columns are derived.
    pub(super) fn keep_masses(&self, writer: &Writer<'_>, bodies: &mut PreciseBodies) {
        let count = derived_from(&self.unit);
        if !bodies.keeps_masses(count) {
            bodies.clear(count);
            let masses = writer.masses(self.unit.copy);
            for (slot, &body) in self.unit.bodies[..count].iter().enumerate() {
                bodies.set_mass(slot, masses[body]);
            }
        }
    }

    /// Sets bodies from numbers and what they leave out, of which each has a lane of a row: so many rows for each
    /// component of the places, then of the velocities.
    pub(super) fn gather_bodies(
        &self,
        (y, error): (&[Lanes], &[Lanes]),
        rows: usize,
        (row, lane): (usize, usize),
        elapsed: f64,
        bodies: &mut PreciseBodies,
    ) {
        let components = self.shape.components;
        let (y, error) = (as_numbers(y), as_numbers(error));
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
        bodies.settle();
    }
}

/// A unit, the state that it is in, the elapsed time, and where it is recorded.
pub(super) type Read<'a> = (&'a Prepared, &'a State<Lanes>, f64, &'a Output<'a>);

tiered! {
    fn record_bodies[const COMPONENTS: usize, const MOVED: bool][COMPONENTS, MOVED](read: Read<'_>, unit_lane: usize) -> bool = body_after_body;
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
    let stride = unit.rows_in(state.q().len()) * WIDTH;
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
            // As in `rows::each_row`.
            check[c][0] += 0.0 * position[c];
            check[c][1] += 0.0 * velocity[c];
        }
        output.write_rounded(unit.unit.bodies[slot], position, velocity);
    }
    check.iter().flatten().all(|&sum| sum == 0.0)
}
