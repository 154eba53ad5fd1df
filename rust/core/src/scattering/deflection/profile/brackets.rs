//! Between which distances h(r) = r²(1 − V/E) passes b², and where it is stationary.
//!
//! The one idea: the extrema of U are known, so where h turns is a bracketed root; where it rises, the place on the grid is
//! found by halving, and beyond the grid by octaves.

use super::super::grid::{POINTS, place, radius};
use super::super::search::bisected_far;
use super::Profile;

impl Profile {
    /// The distances where h of this energy is stationary, from the outermost inward, and before them the rim of a V that
    /// pulls there, beyond which h rises again. Where U but touches the energy from below, h is level and goes on as it did:
    /// that distance counts twice.
    pub(in super::super) fn critical_radii(&self, energy: f64) -> Vec<f64> {
        // Whoever finds the place taken does not wait.
        if let Ok(last) = self.last_critical.try_lock()
            && let Some((_, radii)) = last.as_ref().filter(|(known, _)| *known == energy)
        {
            return radii.clone();
        }
        let found = self.find_critical_radii(energy);
        if let Ok(mut last) = self.last_critical.try_lock() {
            *last = Some((energy, found.clone()));
        }
        found
    }
    fn find_critical_radii(&self, energy: f64) -> Vec<f64> {
        let mut found: Vec<f64> = self.pulling_rim(energy).into_iter().collect();
        for (at, pair) in self.extrema.windows(2).enumerate().rev() {
            let ([low, below], [high, above]) = (pair[0], pair[1]);
            if (below < energy) != (above < energy) {
                found.push(bisected_far(low, high, |r| {
                    (self.circular_energy(r) < energy) == (below < energy)
                }));
            }
            // Of three neighbours the middle is a top or a bottom.
            let top = at > 0 && above < below && below < energy;
            if top && energy - below <= self.slack(low) {
                found.extend([low, low]);
            }
        }
        found
    }
    /// The energy from which on h rises wherever it is positive, so that there is one turning point.
    pub(in super::super) fn one_turning_point_from(&self) -> f64 {
        self.one_turning_point_from
    }
    /// Whether h has come to b² at a distance.
    pub(in super::super) fn reached(r: f64, value: f64, energy: f64, b: f64) -> bool {
        let rest = 1.0 - value / energy;
        rest > 0.0 && r * rest.sqrt() >= b
    }
    /// Two distances with one turning point between them, of an h that rises from one to the other through b².
    pub(in super::super) fn bracket(
        &self,
        energy: f64,
        b: f64,
        [mut low, mut high]: [f64; 2],
    ) -> Option<[f64; 2]> {
        let [first, last] = self.grid.inside;
        let (mut from, mut to) = (first.max(place(low) + 1), last.min(place(high)) + 1);
        if low < radius(0) {
            from = first;
        }
        // The first place from which on h is at least b²; as a rule the sixteenth of an octave is found by halving.
        while from < to {
            let middle = usize::midpoint(from, to);
            if Self::reached(radius(middle), self.grid.value[middle], energy, b) {
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
        // Far from the grid both may be known, many octaves apart.
        if low < radius(0) || high > radius(POINTS - 1) {
            while low > 0.0 && high > 4.0 * low && high < f64::INFINITY {
                let middle = low.sqrt() * high.sqrt();
                if Self::reached(middle, self.value(middle), energy, b) {
                    high = middle
                } else {
                    low = middle
                }
            }
        }
        (low > 0.0 && high < f64::INFINITY).then_some([low, high])
    }
}
