//! The units of an integration, as powers of two: dividing by them is exact and keeps 1e±100 from overflowing.

use crate::numerics::power_of_two::scale;

/// Exponents of length, mass and time in a quantity: an acceleration is `[1, 0, -2]`.
pub type Dimension = [i32; 3];

/// Units, as exponents of two.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Units {
    /// Of length.
    pub length: i32,
    /// Of time.
    pub time: i32,
    /// Of mass.
    pub mass: i32,
}

impl Units {
    /// The exponent of the unit of a quantity.
    pub fn exponent(self, [length, mass, time]: Dimension) -> i32 {
        length * self.length + mass * self.mass + time * self.time
    }
    /// A quantity of the scene in these units.
    pub fn take(self, value: f64, dimension: Dimension) -> f64 {
        scale(value, -self.exponent(dimension))
    }
    /// As [`take`](Self::take), of three components.
    pub fn take_vector(self, values: [f64; 3], dimension: Dimension) -> [f64; 3] {
        values.map(|value| self.take(value, dimension))
    }
    /// The exponent that turns a velocity of the scene into one of these units.
    pub fn velocity(self) -> i32 {
        self.time - self.length
    }
    /// As [`velocity`](Self::velocity), of an acceleration.
    pub fn acceleration(self) -> i32 {
        2 * self.time - self.length
    }
}
