//! A potential as deflections ask for it: in units of its own, with V on a grid of distances that brackets every root.
//!
//! The one idea: the turning points of all energies E and impact parameters b are where h(r) = r²(1 − V/E) passes b²,
//! and h is stationary where U(r) = V + r V′/2 passes E. U depends on neither, so between its extrema, found once, every
//! question has one bracketed answer. The grid has sixteen equal distances to an octave, so that the place of a distance
//! is read off its bits.

use crate::numerics::lanes::{Lanes, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::power_of_two::{exponent, scale};
use crate::potentials::Potential;
use crate::words::number;
use crate::{Error, Result};
use std::sync::Arc;

/// Octaves of the grid on either side of the unit of length.
const OCTAVES: usize = 64;
/// Distances to an octave, as bits of a number.
const DIVISIONS: u32 = 4;
/// Distances of the grid.
const POINTS: usize = (2 * OCTAVES) << DIVISIONS;
/// The bits of a distance before those of its place in a cell of the grid.
const SHIFT: u32 = 52 - DIVISIONS;
/// Cells in which most turning points are found, beyond b and where V passes E.
const NEAR_CELLS: usize = 16;
/// The first distance, as such bits.
const BASE: u64 = (1023 - OCTAVES as u64) << DIVISIONS;

/// What is left of a force at the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Center {
    /// V is finite there: one can pass.
    Open(f64),
    /// V → +∞.
    Repulsive,
    /// V → −∞ as −1/rⁿ with this n.
    Attractive(f64),
}

/// A potential and its grid.
#[derive(Debug)]
pub(super) struct Profile {
    potential: Arc<dyn Potential>,
    /// Exponents of the units of length and energy.
    length: i32,
    energy: i32,
    /// V and −r dV/dr on the grid.
    value: Vec<f64>,
    pull: Vec<f64>,
    /// The largest |V| and |r dV/dr| from there on.
    beyond: Vec<[f64; 2]>,
    /// For every power of two the place from which on |V|/r, or |r² dV/dr|, is at most that.
    faint: [Vec<u16>; 2],
    /// For every half octave of energies the first place at which V is not more than what is in it.
    climbed: Vec<u16>,
    repels: bool,
    /// The part of the grid where there is a potential.
    inside: [usize; 2],
    /// Where it begins and ends.
    domain: [f64; 2],
    /// Where it is not smooth.
    breaks: Vec<f64>,
    /// The extrema of U within the grid, as pairs (r, U), with its ends: monotone between neighbours.
    extrema: Vec<[f64; 2]>,
    center: Center,
    one_turning_point_from: f64,
    /// V where it ends.
    last_value: f64,
    endless_delay: f64,
}

/// The distance of a place of the grid.
#[inline(always)]
fn radius(place: usize) -> f64 {
    f64::from_bits((BASE + place as u64) << SHIFT)
}

/// The place of the grid at or before a distance.
#[inline(always)]
fn place(r: f64) -> usize {
    ((r.to_bits() >> SHIFT).saturating_sub(BASE) as usize).min(POINTS - 1)
}

impl Profile {
    pub(super) fn new(potential: &Arc<dyn Potential>) -> Self {
        let length = own_length(potential.as_ref());
        let (scaled, energy) = potential.near_one(length).unwrap_or_else(|| (Arc::clone(potential), 0));
        let domain = scaled.domain().map_or([0.0, f64::INFINITY], |(first, last)| [first, last]);
        let inside = [
            if domain[0] > 0.0 { place(domain[0]) + 1 } else { 0 },
            if domain[1] < f64::INFINITY { place(domain[1]) } else { POINTS - 1 },
        ];
        let breaks = scaled.breaks().into_iter().filter(|r| *r > 0.0).collect();
        let mut made = Self {
            potential: scaled,
            length,
            energy,
            value: Vec::new(),
            pull: Vec::new(),
            faint: [Vec::new(), Vec::new()],
            climbed: Vec::new(),
            repels: false,
            beyond: vec![[0.0; 2]; POINTS + 1],
            inside,
            domain,
            breaks,
            extrema: Vec::new(),
            center: Center::Repulsive,
            one_turning_point_from: 0.0,
            last_value: 0.0,
            endless_delay: 0.0,
        };
        if domain[1] < f64::INFINITY {
            made.last_value = made.value(domain[1]);
        }
        let rows: Vec<Lanes> = (0..POINTS / WIDTH)
            .map(|row| Lanes(core::array::from_fn(|lane| radius(row * WIDTH + lane))))
            .collect();
        let (mut value, mut force) = (rows.clone(), rows.clone());
        made.rows(&rows, &mut value, &mut force, &mut []);
        made.value = as_numbers(&value).to_vec();
        let force = as_numbers(&force);
        made.pull = (0..POINTS).map(|at| radius(at) * force[at]).collect();
        let mut tail = [vec![0.0; POINTS + 1], vec![0.0; POINTS + 1]];
        for at in (0..POINTS).rev() {
            let [v, f] = made.beyond[at + 1];
            let larger = |old: f64, new: f64| if new.abs() > old { new.abs() } else { old };
            made.beyond[at] = [larger(v, made.value[at]), larger(f, made.pull[at])];
            let [value, force] = made.beyond[at];
            tail[0][at] = value / radius(at);
            tail[1][at] = larger(tail[1][at + 1], force * radius(at));
        }
        made.faint = tail.map(|tail| falls_to::<52>(&tail[..POINTS], 0));
        // One more, as energies are up to twice the root of two that number.
        made.climbed = falls_to::<51>(&made.value, inside[0]);
        made.climbed.rotate_left(1);
        made.repels = made.breaks.is_empty() && force[inside[0]..=inside[1]].iter().all(|f| *f >= 0.0);
        made.extrema = made.find_extrema(force);
        made.center = made.find_center(force);
        let (v, slope) = (made.value[POINTS - 1], radius(POINTS - 1) * force[POINTS - 1]);
        if v != 0.0 && slope / v < 1.0 + 1e-9 {
            made.endless_delay = if v > 0.0 { f64::NEG_INFINITY } else { f64::INFINITY };
        }
        // Where everything repels, U passes E only behind V = E.
        if force.iter().skip(inside[0]).any(|f| *f < 0.0) {
            made.one_turning_point_from = made.extrema.iter().fold(0.0, |most, [_, u]| u.max(most));
        }
        made
    }
    /// A length of these units, from one of the caller's.
    #[inline]
    pub(super) fn take_length(&self, r: f64) -> f64 {
        scale(r, -self.length)
    }
    /// And back.
    #[inline]
    pub(super) fn give_length(&self, r: f64) -> f64 {
        scale(r, self.length)
    }
    /// An energy of these units, from one of the caller's.
    #[inline]
    pub(super) fn take_energy(&self, energy: f64) -> f64 {
        scale(energy, -self.energy)
    }
    pub(super) fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    pub(super) fn center(&self) -> Center {
        self.center
    }

    /// V at rows of distances; none beyond its range.
    pub(super) fn values(&self, r: &[Lanes], value: &mut [Lanes]) {
        self.potential.value_rows(r, value);
        self.end(r, value);
    }
    /// −dV/dr at rows of distances; none beyond its range.
    pub(super) fn forces(&self, r: &[Lanes], force: &mut [Lanes]) {
        self.potential.force_rows(r, force);
        self.end(r, force);
    }
    /// V, −dV/dr and, as far as there is room, d²V/dr² at rows of distances; none beyond its range.
    pub(super) fn rows(
        &self,
        r: &[Lanes],
        value: &mut [Lanes],
        force: &mut [Lanes],
        curvature: &mut [Lanes],
    ) {
        self.potential.all_rows(r, value, force, curvature);
        for out in [value, force, curvature] {
            self.end(r, out);
        }
    }
    /// Whether it repels everywhere, and is smooth.
    pub(super) fn repels(&self) -> bool {
        self.repels
    }
    fn end(&self, r: &[Lanes], out: &mut [Lanes]) {
        if self.domain[1] == f64::INFINITY {
            return;
        }
        for (r, out) in as_numbers(r).iter().zip(as_numbers_mut(out)) {
            if *r > self.domain[1] {
                *out = 0.0;
            }
        }
    }
    /// V at one distance.
    pub(super) fn value(&self, r: f64) -> f64 {
        let mut value = [Lanes([0.0; WIDTH])];
        self.values(&[Lanes([r; WIDTH])], &mut value);
        value[0].0[0]
    }
    /// −dV/dr at one distance.
    pub(super) fn force(&self, r: f64) -> f64 {
        let mut force = [Lanes([0.0; WIDTH])];
        self.forces(&[Lanes([r; WIDTH])], &mut force);
        force[0].0[0]
    }
    /// The largest |V| (0) or |r dV/dr| (1) at this distance and beyond, or a little more.
    pub(super) fn beyond(&self, r: f64, which: usize) -> f64 {
        self.beyond[if r < radius(0) { 0 } else { place(r) }][which]
    }

    /// Beyond which V is zero, in the caller's units.
    pub(super) fn range(&self) -> f64 {
        let edge = self.breaks.last().copied().filter(|r| self.value(r.next_up()) == 0.0);
        self.give_length(edge.unwrap_or(self.domain[1]).min(self.domain[1]))
    }
    /// The positive extrema of U, in the caller's units.
    pub(super) fn critical_energies(&self) -> Vec<f64> {
        let inner = self.extrema.iter().skip(1).take(self.extrema.len().saturating_sub(2));
        inner.map(|[_, u]| scale(*u, self.energy)).filter(|u| *u > 0.0).collect()
    }
    /// Whether V goes to zero far out.
    pub(super) fn vanishes(&self) -> bool {
        let far = self.value[POINTS - 1].abs();
        far == 0.0 || far < 0.99 * self.beyond[POINTS / 2][0]
    }
    /// What a delay is where V falls no faster than 1/r: never over.
    pub(super) fn endless_delay(&self) -> f64 {
        self.endless_delay
    }
    /// Refuses a table that ends before V does.
    ///
    /// # Errors
    /// `InvalidInput` naming `potential`.
    #[inline]
    pub(super) fn check_end(&self, energy: f64, tolerance: f64) -> Result<()> {
        if self.domain[1] == f64::INFINITY || self.last_value.abs() <= tolerance * energy {
            return Ok(());
        }
        Err(self.ends_early(energy))
    }
    #[cold]
    fn ends_early(&self, energy: f64) -> Error {
        let message = format!(
            "expected one that has come to 0 where it ends, but at r = {} it is {} of the energy; let it go on \
             further out, or subtract its last value, if that is what is meant",
            number(self.give_length(self.domain[1])),
            number(self.last_value / energy)
        );
        Error::invalid("potential", message)
    }
    /// Refuses a motion to where a table has not begun.
    ///
    /// # Errors
    /// `InvalidInput` naming `potential`.
    pub(super) fn check_start(&self, energy: f64, b: f64, [low, _]: [f64; 2]) -> Result<()> {
        if self.domain[0] == 0.0 || low > self.domain[0] {
            return Ok(());
        }
        if !Self::reached(self.domain[0], self.value(self.domain[0]), energy, b) {
            return Ok(());
        }
        let message = format!(
            "expected one that begins before the turning point, but at r = {}, where it begins, what comes with \
             energy {} and impact parameter {} still moves inward; let it begin further in",
            number(self.give_length(self.domain[0])),
            number(scale(energy, self.energy)),
            number(self.give_length(b))
        );
        Err(Error::invalid("potential", message))
    }

    /// U(r) = V + r V′/2.
    fn circular_energy(&self, r: f64) -> f64 {
        (-0.5 * r).mul_add(self.force(r), self.value(r))
    }
    /// The distances where h of this energy is stationary, from the outermost inward.
    pub(super) fn critical_radii(&self, energy: f64) -> Vec<f64> {
        let crossing = |pair: &[[f64; 2]]| {
            let ([low, below], [high, above]) = (pair[0], pair[1]);
            ((below < energy) != (above < energy))
                .then(|| bisected(low, high, |r| (self.circular_energy(r) < energy) == (below < energy)))
        };
        self.extrema.windows(2).rev().filter_map(crossing).collect()
    }
    /// The energy from which on h rises wherever it is positive, so that there is one turning point.
    pub(super) fn one_turning_point_from(&self) -> f64 {
        self.one_turning_point_from
    }
    /// Whether h has come to b² at a distance.
    pub(super) fn reached(r: f64, value: f64, energy: f64, b: f64) -> bool {
        let rest = 1.0 - value / energy;
        rest > 0.0 && r * rest.sqrt() >= b
    }
    /// Two distances with one turning point between them, of an h that rises from one to the other through b².
    pub(super) fn bracket(&self, energy: f64, b: f64, [mut low, mut high]: [f64; 2]) -> Option<[f64; 2]> {
        let [first, last] = self.inside;
        let (mut from, mut to) = (first.max(place(low) + 1), last.min(place(high)) + 1);
        if low < radius(0) {
            from = first;
        }
        // The first place from which on h is at least b²; as a rule the sixteenth of an octave is found by halving.
        while from < to {
            let middle = usize::midpoint(from, to);
            if Self::reached(radius(middle), self.value[middle], energy, b) {
                high = radius(middle);
                to = middle;
            } else {
                low = radius(middle);
                from = middle + 1;
            }
        }
        // Beyond the grid by octaves.
        let mut steps = 0;
        while low == 0.0 && high < f64::INFINITY && steps < 1200 {
            let half = 0.5 * high;
            if half <= self.domain[0] || half < f64::MIN_POSITIVE {
                return (self.domain[0] > 0.0).then_some([self.domain[0], high]);
            }
            if Self::reached(half, self.value(half), energy, b) {
                high = half
            } else {
                low = half
            }
            steps += 1;
        }
        while high == f64::INFINITY && steps < 1200 {
            let twice = 2.0 * low.max(0.5 * b).max(f64::MIN_POSITIVE);
            if Self::reached(twice, self.value(twice), energy, b) {
                high = twice
            } else {
                low = twice
            }
            steps += 1;
        }
        (low > 0.0 && high < f64::INFINITY).then_some([low, high])
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
        at.map(|at| if at > first && at <= last { at } else { 0 })
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

    /// The extrema of U on the grid, each refined, and the ends.
    fn find_extrema(&self, force: &[f64]) -> Vec<[f64; 2]> {
        let [first, last] = self.inside;
        let at = |i: usize| [radius(i), (-0.5 * radius(i)).mul_add(force[i], self.value[i])];
        let places: Vec<usize> = (first..=last).filter(|i| at(*i)[1].is_finite()).collect();
        let (Some(&low), Some(&high)) = (places.first(), places.last()) else { return Vec::new() };
        let mut found = vec![at(low)];
        for i in low + 1..high {
            let [[a, before], [_, here], [c, after]] = [at(i - 1), at(i), at(i + 1)];
            if (here > before && here >= after) || (here < before && here <= after) {
                let sign = if here > before { 1.0 } else { -1.0 };
                let r = highest(a, c, |r| sign * self.circular_energy(r));
                found.push([r, self.circular_energy(r)]);
            }
        }
        found.push(at(high));
        found
    }
    /// How V goes on inward of the grid.
    fn find_center(&self, force: &[f64]) -> Center {
        let [first, _] = self.inside;
        let (v, slope) = (self.value[first], radius(first) * force[first]);
        if !self.potential.singular() || self.domain[0] > 0.0 {
            return if self.domain[0] > 0.0 { Center::Repulsive } else { Center::Open(self.value(0.0)) };
        }
        if v > 0.0 { Center::Repulsive } else { Center::Attractive((slope / v).round_to(1e-9)) }
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

trait Rounded {
    fn round_to(self, unit: f64) -> f64;
}

impl Rounded for f64 {
    /// To a multiple, which the exponents of power laws are.
    fn round_to(self, unit: f64) -> f64 {
        (self / unit).round() * unit
    }
}

/// The exponent of the first length among the parameters; 0 for a power law, which has none.
fn own_length(potential: &dyn Potential) -> i32 {
    let parameters = potential.parameters();
    let dimensions = potential.declaration().exponents(parameters);
    let mut lengths =
        parameters.iter().zip(dimensions).filter(|(_, dimension)| *dimension == [1.0, 0.0, 0.0]);
    lengths.next().map_or(0, |(length, _)| exponent(length.size()))
}

/// Where a condition that holds at `low` and not at `high` ceases to, to the last digit.
fn bisected(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if holds(middle) { low = middle } else { high = middle }
    }
}

/// The highest place of a function with one maximum between two distances, to half the digits, as it has no more.
fn highest(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.618_033_988_749_894_9;
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (function(left), function(right));
    while high - low > 1e-8 * high {
        if at_left >= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = function(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = function(right);
        }
    }
    0.5 * (low + high)
}
