//! What a potential does not tell of a deflection: beyond the ends of a table, and where it changes too fast.
//!
//! The one idea: no number comes of what is not known. Each question costs a comparison; words are made when it is refused.

use super::super::Deflection;
use super::super::grid::POINTS;
use super::Profile;
use crate::numerics::power_of_two::{power_of_two, scale};
use crate::words::number;
use crate::{Error, Result};

/// Of |V| farther out, what is less than this part of it falls.
const FALLS: f64 = 0.99;
/// What V comes to far out is nothing if it is this part of what it is nearer, as sums of larger terms leave it that end in
/// zero.
const ROUNDING: f64 = 1.0 / (1_u64 << 43) as f64;
/// Powers of two beyond the grid, the farthest first: squares and higher powers in V may leave the range of numbers.
const BEYOND: [i32; 6] = [900, 450, 300, 200, 150, 100];

/// Tolerances to choose from.
const ENOUGH: [f64; 9] = [1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3];

impl Profile {
    /// Refuses what does not go to zero far out.
    ///
    /// # Errors
    /// `InvalidInput` naming `potential`, with what V goes to if it settles.
    pub(in super::super) fn check_far(&self) -> Result<()> {
        let (last, nearby) = (self.grid.value[POINTS - 1].abs(), self.grid.beyond(1.0, 0));
        if last <= ROUNDING * nearby || (self.domain[1] < f64::INFINITY && last < FALLS * nearby) {
            return Ok(());
        }
        let mut beyond = BEYOND.iter().map(|&power| self.value(power_of_two(power)));
        let farther = beyond.find(|value| value.is_finite()).unwrap_or(0.0);
        if last < FALLS * nearby && farther.abs() < FALLS * last {
            return Ok(());
        }
        let settles = farther.abs() * FALLS <= last && last * FALLS <= farther.abs();
        let advice = if settles {
            format!("this one goes to {}; subtract that", number(scale(farther, self.energy)))
        } else {
            "nothing scatters off one that does not".to_owned()
        };
        Err(Error::invalid(
            "potential",
            format!("expected one that goes to 0 as r goes to infinity; {advice}"),
        ))
    }

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
        let [from, _, most] = unresolved.copied().unwrap_or([found.closest_approach, 0.0, f64::NAN]);
        Err(self.is_not_resolved(energy, from, most / energy))
    }
    #[cold]
    fn is_not_resolved(&self, energy: f64, r: f64, part: f64) -> Error {
        // What is so small a part of the energy may be left as it is.
        let goes_on =
            ENOUGH.into_iter().find(|tolerance| part <= *tolerance).map_or_else(String::new, |tolerance| {
                format!(", or give deflect() or deflection_angle() a larger tolerance={}", number(tolerance))
            });
        let message = format!(
            "expected one that can be resolved, but about r = {} it changes too fast for what comes with energy {}; \
             let it be smoother there{goes_on}",
            number(self.give_length(r)),
            number(scale(energy, self.energy))
        );
        Error::invalid("potential", message)
    }
}
