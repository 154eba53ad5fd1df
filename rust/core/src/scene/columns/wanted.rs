//! What a run is to record.
//!
//! The one idea: what it takes is known before anything runs.

use crate::conservation::columns::Column;

/// What is recorded, and how.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// Positions.
    pub position: bool,
    /// Velocities.
    pub velocity: bool,
    /// What is derived from both.
    pub derived: Vec<&'static Column>,
    /// Whether the states must be kept for it.
    pub keep_states: bool,
    /// How many rigid bodies there are, whose orientations and angular velocities are recorded.
    pub rigid: usize,
}

impl Wanted {
    /// Which arrays of three numbers for each particle there are: positions, velocities, and what they leave out.
    pub(super) fn vectors(&self) -> [bool; 4] {
        let keep = self.keep_states;
        [self.position || keep, self.velocity || keep, keep, keep]
    }

    /// The bytes of all arrays; `None` if nobody could count them.
    pub fn bytes(&self, copies: usize, times: usize, particles: usize) -> Option<usize> {
        let vectors = self.vectors().into_iter().filter(|&wanted| wanted).count();
        let numbers: usize = self.derived.iter().map(|column| column.width).sum();
        let each = particles.checked_mul(3 * vectors)?.checked_add(numbers)?.checked_add(7 * self.rigid)?;
        copies.checked_mul(times)?.checked_mul(each)?.checked_mul(size_of::<f64>())
    }
}
