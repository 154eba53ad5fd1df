//! Rows of a packed unit, eight bodies at a time: into points that are recorded, and into bodies that columns are derived
//! from, in one pass.

use super::Prepared;
use super::record::Read;
use crate::forces::bodies::{Of, PreciseBodies};
use crate::numerics::fused_double::FusedDouble;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Mask;
use crate::scene::columns::Consecutive;
use crate::scene::frame::{Moved, drifted, restored};
use crate::tiered;

tiered! {
    pub(super) fn record_rows[const COMPONENTS: usize, const MOVED: bool][COMPONENTS, MOVED](read: Read<'_>, start: usize, runs: &[Consecutive]) -> bool = rows_as_points;
    pub(super) fn derive_rows[const COMPONENTS: usize, const MOVED: bool][COMPONENTS, MOVED](read: Read<'_>, runs: &[Consecutive], bodies: &mut PreciseBodies) -> bool = rows_as_bodies;
}

/// An origin, coordinate by coordinate in the first lanes: its place and what that leaves out, its velocity likewise.
struct Moving([Lanes; 4]);

impl Moving {
    #[inline(always)]
    fn at<V: Vector8>(unit: &Prepared, elapsed: f64) -> Self {
        if unit.origin.falls() {
            return Self::falling(unit.origin.at(elapsed));
        }
        let [center, drift] = &unit.reading.origin;
        let (place, rest) = drifted(V::load(*center), V::load(*drift), V::splat(elapsed));
        Self([place.store(), rest.store(), *drift, Lanes([0.0; WIDTH])])
    }

    #[cold]
    fn falling(moved: Moved) -> Self {
        let mut all = [Lanes([0.0; WIDTH]); 4];
        for c in 0..3 {
            (all[0].0[c], all[1].0[c]) = moved.position[c];
            (all[2].0[c], all[3].0[c]) = moved.velocity[c];
        }
        Self(all)
    }

    /// A coordinate of the place, or of the velocity, in every lane.
    #[inline(always)]
    fn coordinate<V: Vector8>(&self, of: Of, c: usize) -> (V, V) {
        let first = if matches!(of, Of::Position) { 0 } else { 2 };
        (V::splat(self.0[first].0[c]), V::splat(self.0[first + 1].0[c]))
    }
}

#[inline(always)]
fn rows_as_points<V: Vector8, const COMPONENTS: usize, const MOVED: bool>(
    read: Read<'_>,
    start: usize,
    runs: &[Consecutive],
) -> bool {
    each_row::<V, COMPONENTS, MOVED>(read, (start, runs), None)
}

#[inline(always)]
fn rows_as_bodies<V: Vector8, const COMPONENTS: usize, const MOVED: bool>(
    read: Read<'_>,
    runs: &[Consecutive],
    bodies: &mut PreciseBodies,
) -> bool {
    each_row::<V, COMPONENTS, MOVED>(read, (0, runs), Some(bodies))
}

/// Records the rows of the runs, the first of which is that of the number before them. Bodies, if they are given, are set,
/// from the first row on, with what they leave out.
#[inline(always)]
fn each_row<V: Vector8, const COMPONENTS: usize, const MOVED: bool>(
    (unit, state, elapsed, output): Read<'_>,
    (start, runs): (usize, &[Consecutive]),
    mut bodies: Option<&mut PreciseBodies>,
) -> bool {
    let zero = V::zero();
    let origin = if MOVED { Moving::at::<V>(unit, elapsed) } else { Moving([Lanes([0.0; WIDTH]); 4]) };
    let [length, speed] = unit.reading.factors;
    let factors = [V::splat(length), V::splat(speed)];
    let kinds = [Of::Position, Of::Velocity];
    let rows = state.q().len() / COMPONENTS;
    // Velocities follow the coordinates.
    let (y, rest) = state.all();
    let mut finite = Bits::splat(true);
    let mut largest = [zero; 2];
    let bodies_end = bodies.as_ref().map_or(0, |bodies| bodies.len());
    for index in 0..runs.len().max(bodies_end.div_ceil(WIDTH)) {
        let row = start + index;
        let mut points = [[zero; 3]; 2];
        let mut values = [[FusedDouble::<V>::zero(); 3]; 2];
        let mut check = zero;
        for kind in 0..2 {
            for c in 0..COMPONENTS {
                let at = (kind * COMPONENTS + c) * rows + row;
                let mut value = (V::load(y[at]) * factors[kind], V::load(rest[at]) * factors[kind]);
                if MOVED {
                    value = restored(origin.coordinate::<V>(kinds[kind], c), value);
                }
                points[kind][c] = value.0;
                values[kind][c] = FusedDouble { high: value.0, low: value.1 };
                // Zero times a finite number is zero; times anything else it is not a number.
                check = zero.multiply_add(value.0, check);
            }
            if MOVED && COMPONENTS == 2 {
                let own = origin.coordinate::<V>(kinds[kind], 2);
                points[kind][2] = own.0;
                let value = restored(own, (zero, zero));
                values[kind][2] = FusedDouble { high: value.0, low: value.1 };
            }
        }
        if let Some(bodies) = &mut bodies
            && row * WIDTH < bodies_end
        {
            largest = bodies.set_row(row * WIDTH, &values, largest);
        }
        if let Some(run) = runs.get(index) {
            finite = finite.and(check.less_equal(zero).or(run.idle));
            let [[x, y, z], [u, v, w]] = points;
            output.write_points(run, V::interleave(x, y, z), V::interleave(u, v, w));
        }
    }
    if let Some(bodies) = bodies {
        bodies.settle_sized(largest);
    }
    finite.all()
}
