//! V on a grid of distances, sixteen to an octave, so that the place of a distance is read off its bits: where a turning
//! point is bracketed, and from where on a potential is too faint to count.

use crate::numerics::elementary::{Exponential, ln};
use crate::numerics::lanes::WIDTH;

/// Octaves of the grid on either side of the unit of length.
const OCTAVES: usize = 64;
/// Distances to an octave, as bits of a number.
const DIVISIONS: u32 = 4;
/// Distances of the grid.
pub(super) const POINTS: usize = (2 * OCTAVES) << DIVISIONS;
/// The bits of a distance before those of its place in a cell of the grid.
const SHIFT: u32 = 52 - DIVISIONS;
/// Cells in which most turning points are found, beyond b and where V passes E.
const NEAR_CELLS: usize = 16;
/// The first distance, as such bits.
const BASE: u64 = (1023 - OCTAVES as u64) << DIVISIONS;

/// What a potential is on the grid.
#[derive(Debug)]
pub(super) struct Grid {
    /// V and −r dV/dr.
    pub(super) value: Vec<f64>,
    pub(super) pull: Vec<f64>,
    /// The part of it where there is a potential: first and last place.
    pub(super) inside: [usize; 2],
    /// The largest |V| and |r dV/dr| from there on, features between places among them.
    beyond: Vec<[f64; 2]>,
    /// For every power of two the place from which on |V|/r, or |r² dV/dr|, is at most that.
    faint: [Vec<u16>; 2],
    /// For every half octave of energies the first place at which V is not more than what is in it.
    climbed: Vec<u16>,
    /// Whether it repels everywhere.
    pub(super) repels: bool,
}

/// The distance of a place of the grid.
#[inline(always)]
pub(super) fn radius(place: usize) -> f64 {
    f64::from_bits((BASE + place as u64) << SHIFT)
}

/// The place of the grid at or before a distance.
#[inline(always)]
pub(super) fn place(r: f64) -> usize {
    ((r.to_bits() >> SHIFT).saturating_sub(BASE) as usize).min(POINTS - 1)
}

impl Grid {
    /// Of V and −r dV/dr at all places, and at distances between them.
    pub(super) fn new(value: Vec<f64>, pull: Vec<f64>, inside: [usize; 2], between: &[[f64; 3]]) -> Self {
        let mut beyond = vec![[0.0; 2]; POINTS + 1];
        let mut tail = [vec![0.0; POINTS], vec![0.0; POINTS]];
        let larger = |old: f64, new: f64| if new.abs() > old { new.abs() } else { old };
        let mut most = 0.0;
        let mut features = between.iter().rev().peekable();
        for at in (0..POINTS).rev() {
            let [mut v, mut f] = beyond[at + 1];
            while let Some([_, value, pull]) = features.next_if(|[r, ..]| place(*r) >= at) {
                [v, f] = [larger(v, *value), larger(f, *pull)];
            }
            [v, f] = [larger(v, value[at]), larger(f, pull[at])];
            beyond[at] = [v, f];
            most = larger(most, f * radius(at));
            tail[0][at] = v / radius(at);
            tail[1][at] = most;
        }
        let mut climbed = falls_to::<51>(&value, inside[0]);
        // One more, as energies are up to √2 or 4/3 times the number by which they are found.
        climbed.rotate_left(1);
        let repels = pull[inside[0]..=inside[1]].iter().all(|pull| *pull >= 0.0)
            && between.iter().all(|[_, _, pull]| *pull >= 0.0);
        let faint = tail.map(|tail| falls_to::<52>(&tail, 0));
        Self { value, pull, inside, beyond, faint, climbed, repels }
    }
    /// The largest |V| (0) or |r dV/dr| (1) at this distance and beyond, or a little more.
    pub(super) fn beyond(&self, r: f64, which: usize) -> f64 {
        self.beyond[if r < radius(0) { 0 } else { place(r) }][which]
    }
    /// The outermost place at or beyond which |V| comes to an energy.
    pub(super) fn outermost(&self, energy: f64) -> Option<usize> {
        self.beyond[..POINTS].iter().rposition(|[value, _]| *value >= energy)
    }
    /// The distance within which |V| comes to an energy, V going as 1/rⁿ with that n inward of the grid.
    pub(super) fn reach(&self, energy: f64, power: f64) -> f64 {
        let short_of = self.beyond.partition_point(|[value, _]| *value >= energy);
        if short_of > 0 {
            return radius((short_of - 1).min(POINTS - 1));
        }
        radius(0) * Exponential::exp(ln(self.beyond[0][0] / energy) / power)
    }
    /// The places of the grid at which h first comes to b², of pairs whose h rises wherever it is positive; zero for those
    /// that turn beyond the grid.
    #[inline(always)]
    pub(super) fn places(&self, energy: &[f64; WIDTH], b: &[f64; WIDTH]) -> [usize; WIDTH] {
        let [first, last] = self.inside;
        let (mut at, mut inverse, mut square) = ([first; WIDTH], [0.0; WIDTH], [0.0; WIDTH]);
        let short = |inverse: f64, square: f64, at: usize| {
            let r = radius(at);
            let h = (1.0 - self.value[at & (POINTS - 1)] * inverse) * (r * r);
            (usize::from(h >= square) ^ 1) & usize::from(at <= last)
        };
        let mut near = 1;
        for lane in 0..WIDTH {
            inverse[lane] = 1.0 / energy[lane];
            square[lane] = b[lane] * b[lane];
            // Where V > E nothing comes, and where it repels nothing comes nearer than b.
            at[lane] = usize::from(self.climbed[(energy[lane].to_bits() >> 51) as usize & 4095]);
            if self.repels {
                at[lane] = at[lane].max(place(b[lane])).min(last);
            }
            near &= 1 - short(inverse[lane], square[lane], at[lane] + NEAR_CELLS - 1);
        }
        let mut step = if near == 1 { NEAR_CELLS / 2 } else { POINTS / 2 };
        while step > 0 {
            for lane in 0..WIDTH {
                at[lane] += step * short(inverse[lane], square[lane], at[lane] + step - 1);
            }
            step /= 2;
        }
        // The last place was not asked: what comes there turns in its cell, or beyond the grid.
        at.map(|at| if at > first && at < last { at } else { 0 })
    }
    /// The cell of the grid that ends at a place.
    #[inline(always)]
    pub(super) fn cell(&self, place: usize) -> [f64; 2] {
        [radius(place - 1), radius(place)]
    }
    /// V and −r dV/dr at both ends of the cell that ends at a place.
    #[inline(always)]
    pub(super) fn around(&self, place: usize) -> [f64; 4] {
        [self.value[place - 1], self.value[place], self.pull[place - 1], self.pull[place]]
    }
    /// V and −r dV/dr at both ends of a cell of the grid; NaN of what is none.
    #[inline]
    pub(super) fn ends(&self, [low, high]: [f64; 2]) -> [f64; 4] {
        let (from, to) = (place(low), place(high));
        if radius(from) != low || radius(to) != high || to != from + 1 {
            return [f64::NAN; 4];
        }
        self.around(to)
    }
    /// A distance of the grid from which on |V|/r is at most that, or |r² dV/dr| if `all`; infinite if it is nowhere.
    #[inline(always)]
    pub(super) fn faint(&self, most: f64, all: bool) -> f64 {
        let at = usize::from(self.faint[usize::from(all)][(most.to_bits() >> 52) as usize & 2047]);
        if at < POINTS { radius(at) } else { f64::INFINITY }
    }
}

/// For every 2^`SHIFT`-th number, by its bits, the first place at which numbers that fall are at most that.
fn falls_to<const SHIFT: u32>(numbers: &[f64], least: usize) -> Vec<u16> {
    let mut at = numbers.len();
    let levels = 0..1_u64 << (63 - SHIFT);
    let place = |level: u64| {
        let most = f64::from_bits(level << SHIFT);
        while at > least && numbers[at - 1] <= most {
            at -= 1;
        }
        at as u16
    };
    levels.map(place).collect()
}
