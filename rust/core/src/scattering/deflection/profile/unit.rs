//! The unit of length of a potential that has none of its own.

use super::super::grid::{place, radius};
use super::Profile;
use crate::numerics::power_of_two::{exponent, power_of_two};
use crate::potentials::Potential;

/// Farther from one no length is looked for.
const MOST_OCTAVES: i32 = 1000;

/// So many octaves from the middle of the grid what happens is far from its ends.
const IN_THE_MIDDLE: i32 = 32;

/// The exponent of the unit of length of a potential that has none of its own: where something happens by its other
/// parameters or, of a power of the distance, |V| is one, if that is nowhere near one.
pub(super) fn unit_of_length(potential: &dyn Potential) -> i32 {
    let size = |exponent: i32| potential.at(power_of_two(exponent))[0].abs();
    let place = potential.lengths().first().map_or_else(
        || {
            let (mut from, mut to) = (-MOST_OCTAVES, MOST_OCTAVES);
            while to - from > 1 {
                let middle = from + (to - from) / 2;
                if size(middle) >= 1.0 { from = middle } else { to = middle }
            }
            from
        },
        |length| exponent(*length),
    );
    // What is nowhere one, or everywhere more, has no such place. Energies may be far from one as well: no farther from the
    // caller's unit than it takes.
    let told = place.abs() > IN_THE_MIDDLE && place.abs() < MOST_OCTAVES - IN_THE_MIDDLE;
    if told { place - IN_THE_MIDDLE * place.signum() } else { 0 }
}

/// Energies whose lengths differ by less share a unit.
const SHARED: f64 = 32.0;

impl Profile {
    /// By how many octaves the unit of length is to be moved for an energy: of a power of the distance, which is the same in
    /// any, so that none of its numbers leaves the range where all that happens does not.
    pub(in super::super) fn octaves_to(&self, energy: f64) -> i32 {
        if !self.is_power() {
            return 0;
        }
        let one = place(1.0);
        let (strength, pull) = (self.grid.value[one], self.grid.pull[one]);
        let octaves = exponent(strength) - exponent(self.take_energy(energy));
        let octaves = SHARED * (f64::from(octaves) / (pull / strength) / SHARED).round();
        if octaves.abs() <= f64::from(MOST_OCTAVES) { octaves as i32 } else { 0 }
    }
    /// Whether it is a power of the distance, which has no unit of its own.
    pub(in super::super) fn is_power(&self) -> bool {
        !self.has_length && self.power_from <= radius(0)
    }
    /// The same with a unit of length so many octaves larger.
    pub(in super::super) fn moved(&self, octaves: i32) -> Self {
        Self::in_unit(&self.given, self.length + octaves, false)
    }
}
