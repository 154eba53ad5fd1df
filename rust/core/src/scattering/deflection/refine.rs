//! Turning points between their brackets, eight side by side, each to the last digits that its function has.
//!
//! The one idea: the grid's V and dV/dr at both ends of a cell tell where 1 − V/E − b²/r² vanishes to four digits or more
//! (Hermite's cubic of r by that function), and Halley's steps, of which each makes three times as many digits, do the
//! rest; what leaves the bracket is halved instead. Each lane goes by itself.

use super::profile::Profile;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::real::Mask;
use crate::tiered;
use core::ops::Range;

/// Steps at most; halving alone ends after sixty.
const MOST_STEPS: usize = 200;
/// Where V is steep as an exponential they come nearer by a part of its scale each: after so many two of three are halvings.
const SOON: usize = 12;
/// Rows that are refined together, so that one need not wait for another.
const TOGETHER: usize = 4;
/// What is left after a step is the cube of it, times this at least, …
const BENT: f64 = 64.0;
/// … and done is what leaves less than this part of r.
const LEFT: f64 = 1.0 / (1_u64 << 55) as f64;
/// Beside breaks of V, over which what the step began with tells nothing of what is beyond, the last step is no longer than this
/// part of r.
const OVER_BREAKS: f64 = 1.0 / (1_u64 << 40) as f64;

/// Rows of pairs, and what is found of them: the turning points, and V, −dV/dr and d²V/dr² there.
#[derive(Debug, Default)]
pub(super) struct Turned {
    pub(super) energy: Vec<Lanes>,
    pub(super) b: Vec<Lanes>,
    /// Between which the turning points are.
    pub(super) low: Vec<Lanes>,
    pub(super) high: Vec<Lanes>,
    pub(super) r: Vec<Lanes>,
    pub(super) value: Vec<Lanes>,
    pub(super) force: Vec<Lanes>,
    pub(super) curvature: Vec<Lanes>,
    /// b/r₀; the three above are V/E, rF/E and r²V″/E in the end.
    pub(super) root: Vec<Lanes>,
    /// E min(|V/E|, ½)/r₀, and 1/r₀.
    pub(super) scale: Vec<Lanes>,
    pub(super) inverse: Vec<Lanes>,
    /// V and rF at both ends, where they are cells of the grid.
    pub(super) ends: [Vec<Lanes>; 4],
    going: Vec<Bits>,
}

impl Turned {
    /// Makes room for so many rows.
    pub(super) fn resize(&mut self, rows: usize) {
        let empty = Lanes([0.0; WIDTH]);
        for row in [
            &mut self.energy,
            &mut self.b,
            &mut self.low,
            &mut self.high,
            &mut self.r,
            &mut self.value,
            &mut self.force,
            &mut self.curvature,
            &mut self.root,
            &mut self.scale,
            &mut self.inverse,
        ] {
            row.resize(rows, empty);
        }
        for end in &mut self.ends {
            end.resize(rows, empty);
        }
        self.going.resize(rows, Bits(0));
    }

    /// Writes the next of so many pairs down.
    #[inline(always)]
    pub(super) fn put(&mut self, at: usize, energy: f64, b: f64, [low, high]: [f64; 2], ends: [f64; 4]) {
        as_numbers_mut(&mut self.energy)[at] = energy;
        as_numbers_mut(&mut self.b)[at] = b;
        as_numbers_mut(&mut self.low)[at] = low;
        as_numbers_mut(&mut self.high)[at] = high;
        for (row, end) in self.ends.iter_mut().zip(ends) {
            as_numbers_mut(row)[at] = end;
        }
    }
    /// Fills the last row up with its last pair, and forgets the rows after it.
    pub(super) fn close(&mut self, pairs: usize) {
        for at in pairs..pairs.next_multiple_of(WIDTH) {
            let last = pairs - 1;
            let of = |row: &[Lanes]| as_numbers(row)[last];
            let ends = [of(&self.ends[0]), of(&self.ends[1]), of(&self.ends[2]), of(&self.ends[3])];
            self.put(at, of(&self.energy), of(&self.b), [of(&self.low), of(&self.high)], ends);
        }
        self.resize(pairs.div_ceil(WIDTH));
    }

    /// Finds them.
    pub(super) fn refine(&mut self, profile: &Profile) {
        start_tier(self);
        let longest = if profile.breaks().is_empty() { 1.0 } else { OVER_BREAKS };
        let rows = self.r.len();
        for from in (0..rows).step_by(TOGETHER) {
            let range = from..rows.min(from + TOGETHER);
            for step in 0..MOST_STEPS {
                profile.rows(
                    &self.r[range.clone()],
                    &mut self.value[range.clone()],
                    &mut self.force[range.clone()],
                    &mut self.curvature[range.clone()],
                );
                // What stood still has its V and its forces now.
                if !self.going[range.clone()].iter().any(|going| going.any()) {
                    break;
                }
                let halve = step >= SOON && step % 3 > 0;
                improve_tier(self, range.clone(), halve, longest);
            }
        }
        scale_tier(self);
    }
}

/// 1 − V/E − b²/r² and r times its slope, of V and rF.
#[inline(always)]
fn rest<V: Vector8>(energy: V, b: V, r: V, value: V, pull: V) -> (V, V, V) {
    let share = (b / r) * (b / r);
    ((V::one() - value / energy) - share, pull / energy + (share + share), share)
}

/// Where steps begin.
#[inline(always)]
fn start<V: Vector8>(turned: &mut Turned) {
    let (zero, one, half) = (V::zero(), V::one(), V::splat(0.5));
    for row in 0..turned.r.len() {
        let (energy, b) = (V::load(turned.energy[row]), V::load(turned.b[row]));
        let (low, high) = (V::load(turned.low[row]), V::load(turned.high[row]));
        let [v0, v1, p0, p1] =
            [turned.ends[0][row], turned.ends[1][row], turned.ends[2][row], turned.ends[3][row]];
        let (f0, s0, _) = rest(energy, b, low, V::load(v0), V::load(p0));
        let (f1, s1, _) = rest(energy, b, high, V::load(v1), V::load(p1));
        let (across, width) = (f1 - f0, high - low);
        let part = -f0 / across;
        // Slopes of the part of the cell by the part of the function.
        let (m0, m1) = (across * low / (s0 * width), across * high / (s1 * width));
        let others = one - part;
        let cubic = part * part * (one + others + others) + part * others * (m0 * others - m1 * part);
        // Hermite's cubic rises where its slopes are no more than three times the secant's.
        let three = V::splat(3.0);
        let good = zero.less(m0).and(m0.less(three)).and(zero.less(m1)).and(m1.less(three));
        let guess = V::select(good, cubic, part);
        let guess = V::select(zero.less(guess).and(guess.less(one)), guess, half);
        let inside = width.multiply_add(guess, low);
        // Where a bracket is wide or its ends are not known, at the geometric mean.
        let known = V::load(v0).less_equal(V::splat(f64::MAX)).and(high.less(low + low));
        let start = V::select(known, inside, low.sqrt() * high.sqrt());
        turned.r[row] = start.store();
        turned.going[row] = Bits::splat(true);
    }
}

/// One step of the lanes that are not done; a halving of their brackets if that is asked for. The last one is no longer than
/// that part of r.
#[inline(always)]
fn improve<V: Vector8>(turned: &mut Turned, rows: Range<usize>, halve: bool, longest: f64) {
    let (zero, one, half) = (V::zero(), V::one(), V::splat(0.5));
    for row in rows {
        let (energy, b, at) = (V::load(turned.energy[row]), V::load(turned.b[row]), V::load(turned.r[row]));
        let pull = at * V::load(turned.force[row]);
        let (rest, slope, share) = rest(energy, b, at, V::load(turned.value[row]), pull);
        let bend = -(at * at * V::load(turned.curvature[row]) / energy) - V::splat(6.0) * share;
        // Beyond the range of numbers it would end the steps: without it they are Newton's.
        let bend = V::select(bend.abs().less_equal(V::splat(f64::MAX)), bend, zero);
        let going = turned.going[row];
        let beyond = zero.less_equal(rest);
        let low = V::select(going.and(beyond.not()), at, V::load(turned.low[row]));
        let high = V::select(going.and(beyond), at, V::load(turned.high[row]));
        let newton = rest / slope;
        let bent = half * newton * (bend / slope);
        let next = at - at * (newton / (one - bent));
        let inside = low.less_equal(next).and(next.less_equal(high)).and(Bits::splat(!halve));
        let next = V::select(inside, next, half * (low + high));
        let step = (next - at).abs();
        let part = step / at;
        let left = part * (bent * bent + V::splat(BENT) * part * part);
        let done = inside.and(left.less_equal(V::splat(LEFT))).and(part.less_equal(V::splat(longest)));
        let zeroed = rest.less_equal(zero).and(beyond);
        let moves = going.and(zeroed.not());
        turned.r[row] = V::select(moves, next, at).store();
        turned.low[row] = low.store();
        turned.high[row] = high.store();
        turned.going[row] = moves.and(done.not()).and(zero.less(step)).and(low.less(high));
    }
}

/// In units of the energy and the turning point.
#[inline(always)]
fn scale<V: Vector8>(turned: &mut Turned) {
    for row in 0..turned.r.len() {
        let (energy, r) = (V::load(turned.energy[row]), V::load(turned.r[row]));
        let inverse = V::one() / r;
        let root = V::load(turned.b[row]) / r;
        let force = r * V::load(turned.force[row]) / energy;
        // Of r₀ rounded V knows less where it is steep than b/r₀, and at the turning point V/E is 1 − (b/r₀)².
        let turned_back = (V::one() - root) * (V::one() + root);
        let steep = V::one().less(force.abs());
        let value = V::select(steep, turned_back, V::load(turned.value[row]) / energy);
        turned.value[row] = value.store();
        turned.force[row] = force.store();
        turned.root[row] = root.store();
        turned.inverse[row] = inverse.store();
        turned.scale[row] = (energy * value.abs().min(V::splat(0.5)) * inverse).store();
        // What has left the range of numbers on the way to a second derivative is that of the power that V is there.
        let bend = r * r * V::load(turned.curvature[row]) / energy;
        let of_power = force * (V::one() + force / value);
        turned.curvature[row] = V::select(bend.abs().less_equal(V::splat(f64::MAX)), bend, of_power).store();
    }
}

tiered! {
    fn scale_tier[][](turned: &mut Turned) = scale;
    fn start_tier[][](turned: &mut Turned) = start;
    fn improve_tier[][](turned: &mut Turned, rows: Range<usize>, halve: bool, longest: f64) = improve;
}
