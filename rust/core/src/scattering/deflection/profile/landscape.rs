//! The extrema of U(r) = V + r V′/2, and what is inward of them.
//!
//! The one idea: U is looked at on the grid and where features of V lie between its places; each extremum of what is seen is
//! found between its neighbors, and what is less than rounding is none.

use super::super::grid::radius;
use super::super::search::highest;
use super::{Center, Profile};
use crate::numerics::power_of_two::{exponent, power_of_two};

/// How far below an energy U is taken to touch it, as a part of what it is the sum of. By so little it makes no difference
/// to any b: the next to the orbit are a part of 2⁻⁵³ away, the depth of what passes goes as (E − U)^(3/2) of b.
const TOUCHES: f64 = 16.0 * f64::EPSILON;

/// The power of two of the farthest distance, or the nearest.
const FARTHEST: i32 = 1000;

/// By how much of V and r dV/dr U must change to have an extremum.
const SAME_U: f64 = 1e-9;

impl Profile {
    /// U(r) = V + r V′/2.
    pub(super) fn circular_energy(&self, r: f64) -> f64 {
        (-0.5 * r).mul_add(self.force(r), self.value(r))
    }
    /// How far U may be off as it is rounded.
    pub(super) fn slack(&self, r: f64) -> f64 {
        TOUCHES * (self.value(r).abs() + (0.5 * r * self.force(r)).abs())
    }

    /// The extrema of U on the grid and between its places, each refined, and the ends; of a V that ends, its rim.
    pub(super) fn find_extrema(&self, between: &[[f64; 3]]) -> Vec<[f64; 2]> {
        let [first, last] = self.grid.inside;
        let circular = |[r, value, pull]: [f64; 3]| {
            [r, (-0.5_f64).mul_add(pull, value), SAME_U * (value.abs() + pull.abs())]
        };
        let of_grid = (first..=last).map(|i| [radius(i), self.grid.value[i], self.grid.pull[i]]);
        let mut places: Vec<[f64; 3]> = of_grid.map(circular).collect();
        if let (Some(&[low, ..]), Some(&[high, ..])) = (places.first(), places.last()) {
            places.extend(between.iter().copied().filter(|[r, ..]| *r > low && *r < high).map(circular));
            places.sort_by(|a, b| a[0].total_cmp(&b[0]));
            places.dedup_by(|a, b| a[0] == b[0]);
        }
        let rim = self.domain[1];
        if rim < f64::INFINITY && places.last().is_some_and(|[high, ..]| *high < rim) {
            places.push(circular([rim, self.value(rim), rim * self.force(rim)]));
        }
        places.retain(|[_, u, _]| u.is_finite());
        let Some(&[low, below, _]) = places.first() else { return Vec::new() };
        let mut found = vec![[low, below]];
        // U rises (1) or falls (−1) to the farthest that it has come to; by less than it is rounded it does neither.
        let (mut sign, mut farthest) = (0.0, 0);
        for (at, [_, here, _]) in places.iter().enumerate() {
            let [_, most, rounding] = places[farthest];
            let back = most - here;
            if sign == 0.0 {
                if back.abs() > rounding {
                    (sign, farthest) = (-back.signum(), at);
                }
            } else if sign * back < 0.0 {
                farthest = at;
            } else if sign * back > rounding {
                let (a, c) = (places[farthest.max(1) - 1][0], places[farthest + 1][0]);
                let r = highest(a, c, |r| sign * self.circular_energy(r));
                found.push([r, self.circular_energy(r)]);
                (sign, farthest) = (-sign, at);
            }
        }
        if let Some(&[high, above, _]) = places.last().filter(|_| places.len() > 1) {
            found.push([high, above]);
        }
        // Energies far from those on the grid orbit, and turn, far from it: from its ends on U goes as far as numbers do.
        if self.domain[0] == 0.0 && self.potential.singular() {
            found[0] = self.farthest(found[0], -FARTHEST);
        }
        if let Some(last) = found.last_mut().filter(|_| rim == f64::INFINITY) {
            *last = self.farthest(*last, FARTHEST);
        }
        found
    }
    /// The place farthest from one, on the way to a power of two, at which U is a number, and U there.
    fn farthest(&self, from: [f64; 2], towards: i32) -> [f64; 2] {
        let at = |power: i32| [power_of_two(power), self.circular_energy(power_of_two(power))];
        let (mut near, mut far) = (exponent(from[0]), towards);
        if at(far)[1].is_finite() {
            return at(far);
        }
        while (far - near).abs() > 1 {
            let middle = near + (far - near) / 2;
            if at(middle)[1].is_finite() { near = middle } else { far = middle }
        }
        if near == exponent(from[0]) { from } else { at(near) }
    }
    /// How V goes on inward of the grid.
    pub(super) fn find_center(&self) -> Center {
        let [first, _] = self.grid.inside;
        let (v, slope) = (self.grid.value[first], self.grid.pull[first]);
        if !self.potential.singular() || self.domain[0] > 0.0 {
            return if self.domain[0] > 0.0 { Center::Repulsive } else { Center::Open(self.value(0.0)) };
        }
        if v > 0.0 { Center::Repulsive } else { Center::Attractive((slope / v).round_to(1e-9)) }
    }
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
