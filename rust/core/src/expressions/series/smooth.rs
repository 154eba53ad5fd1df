//! How far a motion is as smooth as its series say.
//!
//! The one idea: √(x²) turns sharply where x goes through zero, and a series about any other place, which is that of x, goes
//! on as if nothing were there. A root (or a broken power, or an inverse function with a root in its rate) does so only where
//! what stands below it vanishes; as long as Σ|uₖ|hᵏ stays below u₀ it does not, so a step is held to that.

use super::{Coefficient, Expansion};
use crate::numerics::real::Mask;

/// What is below a root keeps at least the rest of itself.
const SHARE: f64 = 0.875;
/// Of a step that is too long so much is tried next, and so often: none is left after.
const SHORTER: f64 = 0.75;
const TRIES: usize = 2560;

impl<S: Coefficient> Expansion<S> {
    /// Whether anything in it may turn sharply.
    pub fn may_turn_sharply(&self) -> bool {
        !self.of.radicands.is_empty()
    }

    /// The longest of steps up to `h`, in units of the coefficients, that nothing on the way makes turn sharply, as `order`
    /// coefficients tell.
    pub fn smooth_until(&self, order: usize, mut h: S) -> S {
        for &radicand in &self.of.radicands {
            let coefficients = &self.numbers[radicand..][..order];
            let limit = coefficients[0] * S::splat(SHARE);
            for _ in 0..TRIES {
                let mut change = S::zero();
                for &coefficient in coefficients[1..].iter().rev() {
                    change = (change + coefficient.abs()) * h;
                }
                let too_long = limit.less(change);
                if !too_long.any() {
                    break;
                }
                h = S::select(too_long, h * S::splat(SHORTER), h);
            }
        }
        h
    }
}
