//! The electrons' toll along a straight way, without straggling: dE/ds = −S(E), S from a table.

use super::octaves::Octaves;
use super::stopping::{Atoms, Projectile, Stopping};
use crate::numerics::angles::cos;
use core::f64::consts::PI;

/// Numbers of a cell of S: cubes in the energy, to 1e-7 and better where S is as smooth as it is.
const DEGREE: usize = 4;
/// At most this part of its energy is lost in a step: the midpoint rule is then right to 1e-5 of what is lost.
pub(super) const MOST_LOST: f64 = 1.0 / 256.0;
/// Parts of an octave, as a power of two.
pub(super) const PARTS: u32 = 4;

/// S(E) between two energies.
#[derive(Clone, Debug)]
pub(super) struct Slowing {
    octaves: Octaves,
    series: Vec<[f64; DEGREE]>,
    nothing: bool,
}

impl Slowing {
    /// S is known from half the lowest energy on: a step may end below it.
    pub(super) fn new(
        stopping: &Stopping,
        ion: Projectile,
        atoms: &[Atoms],
        lowest: f64,
        highest: f64,
    ) -> Self {
        let octaves = Octaves::new(0.5 * lowest, highest, PARTS);
        let series = (0..octaves.cells()).map(|cell| {
            let (from, to) = octaves.bounds(cell);
            let node = |k: usize| cos(PI * (k as f64 + 0.5) / DEGREE as f64);
            let values: [f64; DEGREE] = core::array::from_fn(|k| {
                stopping.loss(ion, atoms, from + 0.5 * (1.0 + node(k)) * (to - from))
            });
            core::array::from_fn(|degree| {
                let term = |k: usize| values[k] * cos(PI * degree as f64 * (k as f64 + 0.5) / DEGREE as f64);
                (0..DEGREE).map(term).sum::<f64>() * if degree == 0 { 1.0 } else { 2.0 } / DEGREE as f64
            })
        });
        Self { octaves, series: series.collect(), nothing: stopping.is_nothing() }
    }
    /// S(E) in eV/Å.
    #[inline]
    pub(super) fn loss(&self, energy: f64) -> f64 {
        let cell = self.octaves.cell(energy);
        let x = self.octaves.place(cell, energy);
        let [a, b, c, d] = self.series[cell];
        // T₂ = 2x² − 1, T₃ = (4x² − 3)x.
        let square = x * x;
        a + b * x + c * (2.0 * square - 1.0) + d * (4.0 * square - 3.0) * x
    }
    /// How far an ion may go in one step, given its loss.
    #[inline]
    pub(super) fn reach(&self, energy: f64, loss: f64) -> f64 {
        if self.nothing { f64::INFINITY } else { energy * MOST_LOST / loss }
    }
    /// The energy after a step that is not longer.
    #[inline]
    pub(super) fn after(&self, energy: f64, loss: f64, length: f64) -> f64 {
        if self.nothing {
            return energy;
        }
        energy - self.loss(energy - 0.5 * loss * length) * length
    }
    /// The energy after a straight way of any length, and what is left of the way when it falls below `lowest`.
    pub(super) fn along(&self, energy: f64, length: f64, lowest: f64) -> (f64, f64) {
        let (mut energy, mut left) = (energy, length);
        while left > 0.0 && energy >= lowest {
            let loss = self.loss(energy);
            let step = self.reach(energy, loss).min(left);
            energy = self.after(energy, loss, step);
            left -= step;
        }
        (energy, left)
    }
}

#[cfg(test)]
mod tests {
    use super::super::stopping::Model;
    use super::*;

    const ALPHA: Projectile = Projectile { atomic_number: 2.0, mass: 4.001_506_179 };
    const GOLD: [Atoms; 1] = [Atoms { atomic_number: 79.0, density: 0.059_07, excitation: 790.0 }];

    #[test]
    fn the_table_has_the_digits_of_the_formula() {
        for model in [Model::Joined, Model::LindhardScharff, Model::Bethe] {
            let stopping = Stopping::Formula(model);
            let table = Slowing::new(&stopping, ALPHA, &GOLD, 7e3, 7.7e6);
            for i in 0..4000 {
                let energy = 7e3 * (1e3_f64).powf(f64::from(i) / 4000.0);
                let (found, expected) = (table.loss(energy), stopping.loss(ALPHA, &GOLD, energy));
                // Measured 4e-8; Bethe's has an edge at its peak, 1e-4 in that cell.
                let tolerance = if model == Model::Bethe { 5e-4 } else { 2e-7 };
                assert!((found / expected - 1.0).abs() < tolerance, "{model:?} {energy} {found} {expected}");
            }
        }
    }
}
