//! When the iteration of stages ends.
//!
//! The one idea: changes fall geometrically, so two of them tell what is still to come; and what falls no longer is rounding, if
//! it is small enough for that.

use super::step::{LEAST_SCALE, ROUNDED_SCALE};

/// What is still to change is nothing, in units of what a number is measured by: four times as much in every step is a drift of
/// energies that hundreds of copies show.
const NEGLIGIBLE: f64 = f64::EPSILON / 256.0;
/// Below this, in units of what a number is measured by, a change that no longer falls may be round-off …
pub(super) const ROUND_OFF: f64 = 1e-13;
/// … and below this it is.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;
/// Changes fall fast if each is at most the last over this.
const FAST: f64 = 8.0;
/// As above, where the right-hand side itself has lost digits.
const STAGNATION: f64 = 1e-9;
/// What rounding adds to a change like this tells nothing of how changes fall.
const ABOVE_ROUNDING: f64 = 1e-12;
/// So many changes in a row that are none of them smaller than all before: those of a spiral fall, but not one by one.
const NO_LONGER_FALLING: u32 = 5;

/// How stages changed, iteration after iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Changes {
    last: f64,
    least: f64,
    in_vain: u32,
    /// The change before the last; none is taken for nothing.
    before: f64,
    /// How many did not fall fast.
    slow: u32,
    /// The most that a change is measured by, inverted.
    pub(super) limit: f64,
    /// The most that is left of a change by the next one, of those above rounding.
    pub(super) left: f64,
}

impl Default for Changes {
    fn default() -> Self {
        Self {
            last: f64::INFINITY,
            least: f64::INFINITY,
            in_vain: 0,
            before: 0.0,
            slow: 0,
            limit: f64::INFINITY,
            left: 0.0,
        }
    }
}

impl Changes {
    /// Whether the stages have converged, or never will; nothing while that is open. What is still to come is told by how the last
    /// two changes fell. Where changes no longer fall that may be rounding, they are measured by the `limit` from there on.
    #[inline(always)]
    pub(super) fn judged(&mut self, change: f64, limit: impl FnOnce() -> f64) -> Option<bool> {
        // What is to come is to this change as that is to the last, or the last to the one before it.
        let last = self.last;
        if change > ABOVE_ROUNDING && change > self.left * last {
            self.left = change / last;
        }
        if change * change <= NEGLIGIBLE * last && change * last <= NEGLIGIBLE * self.before {
            return Some(true);
        }
        let stands = change >= last;
        self.before = if last < f64::INFINITY { last } else { 0.0 };
        self.in_vain = if change < self.least { 0 } else { self.in_vain + 1 };
        self.least = if change < self.least { change } else { self.least };
        self.last = change;
        let for_long = self.in_vain == NO_LONGER_FALLING;
        let fast = change * FAST <= last;
        // What fell fast until then, and does no longer, is rounding; what fell slowly may have turned around while it did, and
        // grow once.
        let rounding = match self.slow {
            0 => !fast && change < 4.0 * ROUNDINGS,
            1 => stands && change < ROUND_OFF,
            _ => stands && (change < ROUNDINGS || (self.in_vain > 1 && change < ROUND_OFF)),
        };
        self.slow += u32::from(!fast);
        if change == 0.0 || rounding || (for_long && change < STAGNATION) {
            return Some(true);
        }
        if for_long && change < STAGNATION * (ROUNDED_SCALE / LEAST_SCALE) && self.limit == f64::INFINITY {
            *self = Self { limit: limit(), left: self.left, ..Self::default() };
            return None;
        }
        (!change.is_finite() || for_long).then_some(false)
    }
}
