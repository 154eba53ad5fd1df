//! Accelerations that are linear in the place and the velocity of a particle, but for a constant.
//!
//! The one idea: they add up as the rows of one matrix, whose flow is then that of all of them
//! ([`linear_forces`](crate::closed_forms::linear_forces)).

use crate::numerics::scaled::Scaled;

/// The place, the velocity, and a 1.
pub const NUMBERS: usize = 7;
/// The place of the 1.
const ONE: usize = NUMBERS - 1;

/// The acceleration of a particle by these numbers.
#[derive(Clone, Debug)]
pub struct LinearAcceleration([[Scaled; NUMBERS]; 3]);

impl Default for LinearAcceleration {
    fn default() -> Self {
        Self([[Scaled::ZERO; NUMBERS]; 3])
    }
}

impl LinearAcceleration {
    /// Adds a component that does not depend on the state.
    pub fn add_constant(&mut self, component: usize, value: Scaled) {
        self.add(component, ONE, value);
    }

    /// Adds a component by one of the distance from a center.
    pub fn add_by_distance(&mut self, component: usize, (of, center): (usize, f64), rate: Scaled) {
        self.add(component, of, rate);
        self.add(component, ONE, rate.times(-center));
    }

    /// Adds a component by one of the velocity.
    pub fn add_by_velocity(&mut self, component: usize, of: usize, rate: Scaled) {
        self.add(component, 3 + of, rate);
    }

    fn add(&mut self, component: usize, number: usize, rate: Scaled) {
        let entry = &mut self.0[component][number];
        *entry = entry.plus(rate);
    }

    /// The rates, one component after another.
    pub fn rows(&self) -> &[[Scaled; NUMBERS]; 3] {
        &self.0
    }
}

/// A force that makes such accelerations of each particle by itself.
pub trait Linear {
    /// Adds that of a particle of some mass; one without mass may be there if the force does nothing to it.
    fn add_to(&self, acceleration: &mut LinearAcceleration, particle: usize, mass: Scaled);
}
