//! A potential as deflections ask for it: in units of its own, with V on a grid of distances that brackets every root.
//!
//! The one idea: the turning points of all energies E and impact parameters b are where h(r) = r²(1 − V/E) passes b²,
//! and h is stationary where U(r) = V + r V′/2 passes E. U depends on neither, so between its extrema, found once, every
//! question has one bracketed answer.

use super::grid::{Grid, POINTS, place, radius};
use super::rim::Rim;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::{Exponential, ln};
use crate::numerics::lanes::{Lanes, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::power_of_two::{exponent, scale};
use crate::potentials::Potential;
use crate::potentials::features::Features;
use std::sync::{Arc, Mutex};
use unit::unit_of_length;

mod brackets;
mod checks;
mod landscape;
mod unit;

/// Marks that are farther apart are of different features.
const FAR_APART: f64 = 0.125;
/// Impact parameters that differ by no more of themselves need not be looked at twice.
const ONE_BEND: f64 = 1e-13;

/// Powers of r that differ by no more of themselves are one.
const SAME_POWER: f64 = 1e-13;
/// For so many places, 32 octaves, it must be one: of two powers that are near each other the sum changes its own slowly.
const SETTLED: usize = POINTS / 4;

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
    /// In the caller's units, …
    given: Arc<dyn Potential>,
    /// … and in its own.
    potential: Arc<dyn Potential>,
    /// Exponents of the units of length and energy.
    length: i32,
    /// Whether that is a length of the potential's own.
    has_length: bool,
    energy: i32,
    grid: Grid,
    repels: bool,
    /// Where it begins and ends.
    domain: [f64; 2],
    /// Where it is not smooth.
    breaks: Vec<f64>,
    /// Between which it is smooth where it is narrow.
    marks: Vec<f64>,
    /// Where it was not resolved: from, to, and the largest |V|.
    unresolved: Vec<[f64; 3]>,
    /// The extrema of U within the grid, as pairs (r, U), with its ends: monotone between neighbours.
    extrema: Vec<[f64; 2]>,
    center: Center,
    one_turning_point_from: f64,
    /// V where it ends.
    last_value: f64,
    rim: Option<Rim>,
    endless_delay: f64,
    power_from: f64,
    /// The energy that was last asked for where h is stationary, and those distances: one is often asked for again.
    last_critical: Mutex<Option<(f64, Vec<f64>)>>,
}

impl Profile {
    pub(super) fn new(potential: &Arc<dyn Potential>) -> Self {
        let own = potential.own_length().map(exponent);
        let length = own.unwrap_or_else(|| unit_of_length(potential.as_ref()));
        Self::in_unit(potential, length, own.is_some())
    }
    /// In a unit of length, by its exponent, and whether that is the potential's own.
    fn in_unit(potential: &Arc<dyn Potential>, length: i32, has_length: bool) -> Self {
        let (scaled, energy) = potential.near_one(length).unwrap_or_else(|| (Arc::clone(potential), 0));
        let domain = scaled.domain().map_or([0.0, f64::INFINITY], |(first, last)| [first, last]);
        let inside = [
            if domain[0] > 0.0 { place(domain[0]) + 1 } else { 0 },
            if domain[1] < f64::INFINITY { place(domain[1]) } else { POINTS - 1 },
        ];
        let breaks: Vec<f64> = scaled.breaks().into_iter().filter(|r| *r > 0.0).collect();
        let rows: Vec<Lanes> = (0..POINTS / WIDTH)
            .map(|row| Lanes(core::array::from_fn(|lane| radius(row * WIDTH + lane))))
            .collect();
        let (mut value, mut force) = (rows.clone(), rows.clone());
        scaled.all_rows(&rows, &mut value, &mut force, &mut []);
        for out in [&mut value, &mut force] {
            end(domain[1], &rows, out);
        }
        let force = as_numbers(&force);
        let pull = (0..POINTS).map(|at| radius(at) * force[at]).collect();
        let Features { places, marks, unresolved } = Features::of(scaled.as_ref());
        let between = looked_at(scaled.as_ref(), &places);
        let grid = Grid::new(as_numbers(&value).to_vec(), pull, inside, &between);
        let repels = breaks.is_empty() && grid.repels;
        let mut made = Self {
            given: Arc::clone(potential),
            potential: scaled,
            length,
            has_length,
            energy,
            grid,
            repels,
            domain,
            breaks,
            marks,
            unresolved,
            extrema: Vec::new(),
            center: Center::Repulsive,
            one_turning_point_from: 0.0,
            last_value: 0.0,
            rim: None,
            endless_delay: 0.0,
            power_from: f64::INFINITY,
            last_critical: Mutex::default(),
        };
        if domain[1] < f64::INFINITY {
            made.last_value = made.value(domain[1]);
            made.rim = Rim::of(made.potential.as_ref());
        }
        made.extrema = made.find_extrema(&between);
        made.center = made.find_center();
        let (v, pull) = (made.grid.value[POINTS - 1], made.grid.pull[POINTS - 1]);
        if v != 0.0 && pull / v < 1.0 + 1e-9 {
            made.endless_delay = if v > 0.0 { f64::INFINITY } else { f64::NEG_INFINITY };
        }
        let power = |at: usize| made.grid.pull[at] / made.grid.value[at];
        let last = power(POINTS - 1);
        let same = |at: &usize| (power(*at) - last).abs() <= SAME_POWER * last;
        if let Some(first) =
            (0..POINTS).rev().take_while(same).last().filter(|first| first + SETTLED <= POINTS)
        {
            made.power_from = radius(first);
        }
        // Where everything repels, U passes E only behind V = E.
        if force.iter().skip(inside[0]).any(|f| *f < 0.0) || between.iter().any(|[_, _, pull]| *pull < 0.0) {
            let last = made.extrema.len().saturating_sub(1);
            let touched = made.extrema.iter().enumerate().map(|(at, [r, u])| {
                // Not of the ends of the grid, which are no extrema.
                if at > 0 && at < last { u + made.slack(*r) } else { *u }
            });
            made.one_turning_point_from = touched.fold(0.0, f64::max);
        }
        made
    }
    /// What it is on a grid.
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
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
    /// The length by which impact parameters of an energy are looked for, in the caller's units: the potential's own or, if
    /// it has none, the distance within which |V| is more than the energy.
    pub(super) fn length_at(&self, energy: f64) -> f64 {
        if self.has_length { self.give_length(1.0) } else { self.reach_at(energy) }
    }
    /// The distance within which |V| is more than an energy, in the caller's units; the unit of length where it never is.
    pub(super) fn reach_at(&self, energy: f64) -> f64 {
        let energy = self.take_energy(energy).abs();
        let reach = match (self.grid.outermost(energy), self.center) {
            (Some(last), _) if last == POINTS - 1 => {
                let r = radius(last);
                r * Exponential::exp(ln(self.grid.value[last].abs() / energy) / self.power_at(r))
            }
            (Some(at), _) => radius(at),
            (None, Center::Open(_)) => 1.0,
            (None, _) if self.domain[0] > 0.0 => 1.0,
            (None, _) => self.grid.reach(energy, self.power_at(radius(0))),
        };
        self.give_length(reach)
    }
    /// From where on V is a power of the distance, in the caller's units; the unit of length where it is none, or not on the
    /// grid.
    pub(super) fn power_begins(&self) -> f64 {
        self.give_length(if self.power_from < f64::INFINITY { self.power_from } else { 1.0 })
    }
    /// An energy of these units, from one of the caller's.
    #[inline]
    pub(super) fn take_energy(&self, energy: f64) -> f64 {
        scale(energy, -self.energy)
    }
    pub(super) fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    /// Distances between which it is smooth where it is narrow, ascending.
    pub(super) fn marks(&self) -> &[f64] {
        &self.marks
    }
    /// The first of them beyond a distance; infinite if there is none.
    #[inline]
    pub(super) fn next_mark(&self, r: f64) -> f64 {
        let at = self.marks.partition_point(|mark| *mark <= r);
        self.marks.get(at).copied().unwrap_or(f64::INFINITY)
    }
    pub(super) fn center(&self) -> Center {
        self.center
    }
    /// The height of a hill at a center that can be passed.
    pub(super) fn top(&self) -> Option<f64> {
        match self.center {
            Center::Open(top) if top > 0.0 => Some(top),
            _ => None,
        }
    }
    /// By the logarithm of r, how steeply 1 − b²/r² − V/E rises at a distance; all in the caller's units.
    pub(super) fn steepness(&self, energy: f64, b: f64, r: f64) -> f64 {
        let (own, root) = (self.take_length(r), b / r);
        (2.0 * root).mul_add(root, own * self.force(own) / self.take_energy(energy))
    }

    /// The impact parameters, in the caller's units and ascending, with which what comes with an energy turns or passes where
    /// V has features.
    pub(super) fn bends(&self, energy: f64) -> Vec<f64> {
        let energy = self.take_energy(energy);
        let of = |marks: &[f64]| {
            // Between marks: at one of them a sum would begin anew where it begins.
            let r = 0.5 * (marks[0] + marks[1]);
            let rest = (1.0 - self.value(r) / energy).max(0.0);
            [r, r * rest.sqrt()].map(|b| self.give_length(b))
        };
        let near = |marks: &&[f64]| marks[1] - marks[0] < FAR_APART * marks[1];
        let mut bends: Vec<f64> = self.marks.windows(2).filter(near).flat_map(of).collect();
        bends.retain(|b| *b > 0.0 && b.is_finite());
        bends.sort_by(f64::total_cmp);
        bends.dedup_by(|b, a| *b - *a <= ONE_BEND * *a);
        bends
    }

    /// V at rows of distances; none beyond its range.
    pub(super) fn values(&self, r: &[Lanes], value: &mut [Lanes]) {
        self.potential.value_rows(r, value);
        end(self.domain[1], r, value);
    }
    /// −dV/dr at rows of distances; none beyond its range.
    pub(super) fn forces(&self, r: &[Lanes], force: &mut [Lanes]) {
        self.potential.force_rows(r, force);
        end(self.domain[1], r, force);
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
            end(self.domain[1], r, out);
        }
    }
    /// Whether it repels everywhere, and is smooth.
    pub(super) fn repels(&self) -> bool {
        self.repels
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
    /// V and −dV/dr at one distance, to about thirty digits; none beyond its range.
    pub(super) fn precise(&self, r: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
        if r > DoubleDouble::from(self.domain[1]) {
            return (DoubleDouble::default(), DoubleDouble::default());
        }
        self.potential.precise(r)
    }
    /// The first of them.
    pub(super) fn precise_value(&self, r: DoubleDouble) -> DoubleDouble {
        if r > DoubleDouble::from(self.domain[1]) {
            DoubleDouble::default()
        } else {
            self.potential.precise_value(r)
        }
    }
    /// Beyond which V is zero, in the caller's units.
    pub(super) fn range(&self) -> f64 {
        let edge = self.breaks.last().copied().filter(|r| self.value(r.next_up()) == 0.0);
        self.give_length(edge.unwrap_or(self.domain[1]).min(self.domain[1]))
    }
    /// The positive extrema of U, and U at its rim, in the caller's units.
    pub(super) fn critical_energies(&self) -> Vec<f64> {
        let ends = if self.domain[1] < f64::INFINITY { 1 } else { 2 };
        let inner = self.extrema.iter().skip(1).take(self.extrema.len().saturating_sub(ends));
        inner.map(|[_, u]| scale(*u, self.energy)).filter(|u| *u > 0.0).collect()
    }
    /// Where V ends, if it still pulls there so hard that at this energy h falls up to its rim: it is a barrier without a top.
    pub(super) fn pulling_rim(&self, energy: f64) -> Option<f64> {
        let rim = self.extrema.last().filter(|[r, u]| *r == self.domain[1] && *u >= energy);
        rim.map(|[r, _]| *r)
    }
    /// Where it ends, if it still repels there.
    pub(super) fn rim(&self) -> Option<Rim> {
        self.rim
    }
    /// What a delay is where V falls no faster than 1/r: never over.
    pub(super) fn endless_delay(&self) -> f64 {
        self.endless_delay
    }
    /// The power n of V = k/rⁿ at a distance.
    pub(super) fn power_at(&self, r: f64) -> f64 {
        r * self.force(r) / self.value(r)
    }
    /// From where on V is a power of r, as far as the grid goes; infinite if it is not.
    pub(super) fn power_from(&self) -> f64 {
        self.power_from
    }
    /// The largest |V| at a distance and beyond, or a little more; beyond the grid that at the distance.
    pub(super) fn largest_from(&self, r: f64) -> f64 {
        if r < radius(POINTS - 1) { self.grid.beyond(r, 0) } else { self.value(r).abs() }
    }
}

/// r, V and −r dV/dr at distances.
fn looked_at(potential: &dyn Potential, places: &[f64]) -> Vec<[f64; 3]> {
    let mut rows = vec![Lanes([1.0; WIDTH]); places.len().div_ceil(WIDTH)];
    as_numbers_mut(&mut rows)[..places.len()].copy_from_slice(places);
    let (mut value, mut force) = (rows.clone(), rows.clone());
    potential.all_rows(&rows, &mut value, &mut force, &mut []);
    let (value, force) = (as_numbers(&value), as_numbers(&force));
    let of = |(at, r): (usize, &f64)| [*r, value[at], r * force[at]];
    // Beyond the range of numbers nothing is told apart.
    places.iter().enumerate().map(of).filter(|[_, v, p]| v.is_finite() && p.is_finite()).collect()
}

/// None beyond the last distance.
fn end(last: f64, r: &[Lanes], out: &mut [Lanes]) {
    if last == f64::INFINITY {
        return;
    }
    for (r, out) in as_numbers(r).iter().zip(as_numbers_mut(out)) {
        if *r > last {
            *out = 0.0;
        }
    }
}
