//! Turning points between their brackets, eight side by side, each to the last digits that its function has.
//!
//! The one idea: the grid's V and its derivatives at both ends of a cell tell where 1 − V/E − b²/r² vanishes to seven digits
//! or more (Hermite's quintic of r by that function), and Halley's steps, of which each makes three times as many digits, do
//! the rest: one, as a rule, so short that Taylor's series knows V and dV/dr after it. What leaves the bracket is halved
//! instead. Each lane goes by itself.

use super::grid::ENDS;
use super::profile::Profile;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::real::Mask;
use crate::tiered;

/// Steps at most; halving alone ends after sixty.
const MOST_STEPS: usize = 200;
/// Rows that are refined together, so that one need not wait for another.
const TOGETHER: usize = 4;
/// What is left after a step is the cube of it, times this at least, …
const BENT: f64 = 64.0;
/// … and done is what leaves less than this part of r.
const LEFT: f64 = 1.0 / (1_u64 << 55) as f64;
/// After a step whose square, as a part of r and times how fast V bends, or at least this, is less, what Taylor's series of
/// dV/dr leaves out is 1e-13 of it, which makes 1e-14 of the angle, and of V far less.
const SHORT: f64 = 1.0 / (1_u64 << 42) as f64;
const SHORT_BENT: f64 = 16.0;

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
    /// V, rF and r²V″ at both ends, where they are cells of the grid.
    pub(super) ends: [Vec<Lanes>; ENDS],
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
    pub(super) fn put(&mut self, at: usize, energy: f64, b: f64, [low, high]: [f64; 2], ends: [f64; ENDS]) {
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
            let ends = core::array::from_fn(|end| of(&self.ends[end]));
            self.put(at, of(&self.energy), of(&self.b), [of(&self.low), of(&self.high)], ends);
        }
        self.resize(pairs.div_ceil(WIDTH));
    }

    /// Finds them; d²V/dr² with all digits only if `all` is asked for.
    pub(super) fn refine(&mut self, profile: &Profile, all: bool) {
        start_tier(self);
        let rows = self.r.len();
        for from in (0..rows).step_by(TOGETHER) {
            let range = from..rows.min(from + TOGETHER);
            let mut here = [[Lanes([0.0; WIDTH]); TOGETHER]; 3];
            for _ in 0..MOST_STEPS {
                let [value, force, curvature] = &mut here;
                let count = range.len();
                profile.rows(
                    &self.r[range.clone()],
                    &mut value[..count],
                    &mut force[..count],
                    &mut curvature[..count],
                );
                if !improve_tier(self, &here, range.start, range.end) {
                    break;
                }
            }
            if all {
                profile.rows(
                    &self.r[range.clone()],
                    &mut self.value[range.clone()],
                    &mut self.force[range.clone()],
                    &mut self.curvature[range],
                );
            }
        }
        scale_tier(self);
    }
}

/// 1 − V/E − b²/r² and r times its slope, of V and rF.
#[inline(always)]
fn rest<V: Vector8>(inverse_energy: V, b: V, r: V, value: V, pull: V) -> (V, V, V) {
    let root = b / r;
    let share = root * root;
    ((V::one() - value * inverse_energy) - share, pull * inverse_energy + (share + share), share)
}

/// Where steps begin.
#[inline(always)]
fn start<V: Vector8>(turned: &mut Turned) {
    let (zero, one, half) = (V::zero(), V::one(), V::splat(0.5));
    for row in 0..turned.r.len() {
        let (inverse, b) = (one / V::load(turned.energy[row]), V::load(turned.b[row]));
        let (low, high) = (V::load(turned.low[row]), V::load(turned.high[row]));
        let [v0, v1, p0, p1, c0, c1] = &turned.ends;
        let (f0, s0, share0) = rest(inverse, b, low, V::load(v0[row]), V::load(p0[row]));
        let (f1, s1, share1) = rest(inverse, b, high, V::load(v1[row]), V::load(p1[row]));
        let (across, width) = (f1 - f0, high - low);
        let part = -f0 / across;
        // Slopes and bends of the part of the cell by the part of the function.
        let (inverse0, inverse1, cells) = (one / s0, one / s1, one / width);
        let (t0, t1) = (across * inverse0, across * inverse1);
        let (m0, m1) = (t0 * (low * cells), t1 * (high * cells));
        let bend0 = V::load(c0[row]) * inverse + V::splat(6.0) * share0;
        let bend1 = V::load(c1[row]) * inverse + V::splat(6.0) * share1;
        let (n0, n1) = (m0 * t0 * (bend0 * inverse0), m1 * t1 * (bend1 * inverse1));
        // Hermite's quintic, as what it is more than the straight line.
        let others = one - part;
        let (both, twice) = (part * others, part * part);
        let lean = m0 * others * others * (one + part + part + part)
            - m1 * twice * (one + others + others + others)
            - (others - part) * (one + V::splat(3.0) * both);
        let bent = half * both * (n0 * others + n1 * part);
        let bent = V::select(zero.less_equal(bent.abs()), bent, zero);
        let quintic = part + both * lean + both * bent;
        // It rises where its slopes are no more than three times the secant's.
        let three = V::splat(3.0);
        let good = zero.less(m0).and(m0.less(three)).and(zero.less(m1)).and(m1.less(three));
        let guess = V::select(good, quintic, part);
        let guess = V::select(zero.less(guess).and(guess.less(one)), guess, half);
        let inside = width.multiply_add(guess, low);
        // Where a bracket is wide or its ends are not known, at the geometric mean.
        let known = V::load(v0[row]).less_equal(V::splat(f64::MAX)).and(high.less(low + low));
        let start = V::select(known, inside, low.sqrt() * high.sqrt());
        turned.r[row] = start.store();
        turned.going[row] = Bits::splat(true);
    }
}

/// One step of the lanes that are not done, from V, −dV/dr and d²V/dr² where they are; whether some are not done yet.
#[inline(always)]
fn improve<V: Vector8>(turned: &mut Turned, here: &[[Lanes; TOGETHER]; 3], from: usize, to: usize) -> bool {
    let (zero, one, half) = (V::zero(), V::one(), V::splat(0.5));
    let mut open = Bits(0);
    for row in from..to {
        let (b, at) = (V::load(turned.b[row]), V::load(turned.r[row]));
        let inverse = one / V::load(turned.energy[row]);
        let (value, force) = (V::load(here[0][row - from]), V::load(here[1][row - from]));
        let curvature = V::load(here[2][row - from]);
        let pull = at * force;
        let (rest, slope, share) = rest(inverse, b, at, value, pull);
        let steep = at * at * curvature * inverse;
        let bend = -steep - V::splat(6.0) * share;
        let going = turned.going[row];
        let beyond = zero.less_equal(rest);
        let low = V::select(going.and(beyond.not()), at, V::load(turned.low[row]));
        let high = V::select(going.and(beyond), at, V::load(turned.high[row]));
        let inverse_slope = one / slope;
        let newton = rest * inverse_slope;
        let bent = half * newton * (bend * inverse_slope);
        let part = newton / (one - bent);
        let next = at - at * part;
        let inside = low.less_equal(next).and(next.less_equal(high));
        let next = V::select(inside, next, half * (low + high));
        let zeroed = rest.less_equal(zero).and(beyond);
        let moves = going.and(zeroed.not());
        let next = V::select(moves, next, at);
        let step = next - at;
        let left = part.abs() * (bent * bent + V::splat(BENT) * part * part);
        let pulled = one + (pull * inverse).abs();
        let short = part * part * (V::splat(SHORT_BENT) * pulled * pulled + steep * steep);
        let done = inside
            .and(left.less_equal(V::splat(LEFT)))
            .and(short.less_equal(V::splat(SHORT) * pulled * pulled))
            .or(step.abs().less_equal(zero));
        turned.r[row] = next.store();
        turned.low[row] = low.store();
        turned.high[row] = high.store();
        let after = value - step * (force - half * curvature * step);
        turned.value[row] = V::select(going, after, V::load(turned.value[row])).store();
        let after = curvature.multiply_subtract_from(step, force);
        turned.force[row] = V::select(going, after, V::load(turned.force[row])).store();
        turned.curvature[row] = V::select(going, curvature, V::load(turned.curvature[row])).store();
        let goes = moves.and(done.not()).and(low.less(high));
        turned.going[row] = goes;
        open = open.or(goes);
    }
    open.any()
}

/// In units of the energy and the turning point.
#[inline(always)]
fn scale<V: Vector8>(turned: &mut Turned) {
    for row in 0..turned.r.len() {
        let (energy, r) = (V::load(turned.energy[row]), V::load(turned.r[row]));
        let (inverse, inverse_energy) = (V::one() / r, V::one() / energy);
        let root = V::load(turned.b[row]) / r;
        let force = r * V::load(turned.force[row]) * inverse_energy;
        // Of r₀ rounded V knows less where it is steep than b/r₀, and at the turning point V/E is 1 − (b/r₀)².
        let turned_back = (V::one() - root) * (V::one() + root);
        let steep = V::one().less(force.abs());
        let value = V::select(steep, turned_back, V::load(turned.value[row]) * inverse_energy);
        turned.value[row] = value.store();
        turned.force[row] = force.store();
        turned.root[row] = root.store();
        turned.inverse[row] = inverse.store();
        turned.scale[row] = (energy * value.abs().min(V::splat(0.5)) * inverse).store();
        turned.curvature[row] = (r * r * V::load(turned.curvature[row]) * inverse_energy).store();
    }
}

tiered! {
    fn scale_tier[][](turned: &mut Turned) = scale;
    fn start_tier[][](turned: &mut Turned) = start;
    fn improve_tier[][](turned: &mut Turned, here: &[[Lanes; TOGETHER]; 3], from: usize, to: usize) -> bool = improve;
}
