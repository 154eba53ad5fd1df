//! What a potential does not tell of a deflection: beyond the ends of a table, and where it changes too fast.
//!
//! The one idea: no number comes of what is not known. Each question costs a comparison; words are made when it is refused.

use super::super::Deflection;
use super::Profile;
use crate::numerics::power_of_two::scale;
use crate::words::number;
use crate::{Error, Result};

impl Profile {
    /// Refuses a table that ends before V does.
    ///
    /// # Errors
    /// `InvalidInput` naming `potential`.
    #[inline]
    pub(in super::super) fn check_end(&self, energy: f64, tolerance: f64) -> Result<()> {
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
    pub(in super::super) fn check_start(&self, energy: f64, b: f64, [low, _]: [f64; 2]) -> Result<()> {
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

    /// Refuses what passes where V changes too fast to be told, and what is no number.
    ///
    /// # Errors
    /// `InvalidInput` naming `potential`.
    #[inline]
    pub(in super::super) fn check_resolved(
        &self,
        energy: f64,
        tolerance: f64,
        found: &Deflection,
    ) -> Result<()> {
        let passed = |[_, to, most]: &&[f64; 3]| *to > found.closest_approach && *most > tolerance * energy;
        let unresolved = self.unresolved.iter().find(passed);
        if unresolved.is_none() && found.angle.is_finite() && found.error.is_finite() {
            return Ok(());
        }
        Err(self.is_not_resolved(energy, unresolved.map_or(found.closest_approach, |[from, ..]| *from)))
    }
    #[cold]
    fn is_not_resolved(&self, energy: f64, r: f64) -> Error {
        let message = format!(
            "expected one that can be resolved, but about r = {} it changes too fast for what comes with energy {}; \
             let it be smoother there",
            number(self.give_length(r)),
            number(scale(energy, self.energy))
        );
        Error::invalid("potential", message)
    }
}
