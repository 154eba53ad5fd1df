//! What is left of G beside a barrier, with all digits of a float64.
//!
//! The one idea: where G nearly vanishes it is the rest of numbers near one, and what the rounding of those leaves of it
//! goes into 1/√G many thousand times. In double-double arithmetic, from a turning point that has thirty digits, the
//! rest is exact.

use super::adaptive::Pair;
use super::profile::Profile;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// Newton's steps to a turning point at most, from one with the digits of a float64.
const STEPS: usize = 6;
/// A step that is a smaller part of the turning point was the last, or one from where no more is left of 1 − V/E − b²/r², as
/// rounding leaves, …
const LAST: f64 = 1.0 / (1_u128 << 80) as f64;
const ROUNDED: f64 = 1.0 / (1_u128 << 96) as f64;
/// … and one that is a larger part of it leads elsewhere.
const FARTHEST: f64 = 1.0 / (1 << 16) as f64;
/// So near two values of V still differ by what the force says, …
const BESIDE: f64 = 1.0 / (1_u64 << 60) as f64;
/// … but for this part, if they have more digits than a float64.
const AGREES: f64 = 1e-3;

/// A pair whose turning point has thirty digits.
#[derive(Debug)]
pub(super) struct Precise<'a> {
    profile: &'a Profile,
    /// 1/E.
    inverse_energy: DoubleDouble,
    turning: DoubleDouble,
    /// V(r₀)/E = 1 − (b/r₀)².
    value: DoubleDouble,
}

impl<'a> Precise<'a> {
    /// Of a pair, if its turning point is a simple one and its potential has the digits: tables and fits have not.
    pub(super) fn of(profile: &'a Profile, pair: &Pair) -> Option<Self> {
        let impact = DoubleDouble::from(pair.impact_parameter);
        let one = DoubleDouble::from(1.0);
        let inverse_energy = one / DoubleDouble::from(pair.energy);
        let mut turning = DoubleDouble::from(pair.turning);
        for _ in 0..STEPS {
            let ratio = impact / turning;
            let (value, force) = profile.precise(turning);
            let rest = one - value * inverse_energy - ratio * ratio;
            let slope = (turning * force * inverse_energy).high() + 2.0 * (ratio * ratio).high();
            let part = rest / DoubleDouble::from(slope);
            if part.high().is_nan() || part.high().abs() >= FARTHEST {
                return None;
            }
            turning = turning * (one - part);
            if part.high().abs() < LAST || rest.high().abs() < ROUNDED {
                let ratio = impact / turning;
                let found = Self { profile, inverse_energy, turning, value: one - ratio * ratio };
                return found.has_digits().then_some(found);
            }
        }
        None
    }
    /// Whether V has more digits than a float64.
    fn has_digits(&self) -> bool {
        let step = self.turning.scale(BESIDE);
        let (value, force) = self.profile.precise(self.turning);
        let (beside, _) = self.profile.precise(self.turning + step);
        let told = (step * force).high();
        ((value - beside).high() - told).abs() <= AGREES * told.abs()
    }
    /// G − 1 and G at r = r₀ cosh w, from sinh w: what is divided by sinh² w is V(r₀)/E − V(r) cosh² w/E.
    pub(super) fn excess(&self, sinh: f64) -> [f64; 2] {
        let square = DoubleDouble::product(sinh, sinh);
        let grown = DoubleDouble::from(1.0) + square;
        let value = self.profile.precise_value(self.turning * grown.sqrt());
        let lost = self.value - value * self.inverse_energy * grown;
        [lost, square + lost].map(|part| part.high() / square.high())
    }
}
