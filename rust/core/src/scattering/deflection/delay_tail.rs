//! The far end of a delay: where its integral stops, and what is beyond.
//!
//! The one idea: far out the delay's integrand goes as r V, long after that of the angle, as V/r, is gone; of V = k/rⁿ with
//! n near 1 it hardly falls at all. So it is followed by ever longer intervals until it counts no more, or until V is a
//! power of r and small, of which the integral to infinity is known.

use super::adaptive::Pair;
use super::nodes::Node;
use super::profile::Profile;

/// What may be off at the far end, as a part of the tolerance.
const OFF: f64 = 1e-2;
/// The first step outward; longer ones where V is a power.
const STEP: f64 = 1.5;
/// Where it is followed to at most: cosh² w is a number still.
const FARTHEST: f64 = 350.0;
/// Nearer to 1/r than this a delay has no end, as `Profile` has it.
const ENDLESS: f64 = 1.0 + 1e-9;
/// Where what is left is nothing its power is not asked for its integral if it is below this, as it may be but rounding:
/// what falls as slowly has not come to nothing anywhere.
const ROUNDED: f64 = 1.05;

/// The way on from where the angle needs no more.
#[derive(Clone, Debug)]
pub(super) struct DelayTail {
    /// Places w beyond, ascending.
    pub(super) marks: Vec<f64>,
    /// The integral beyond the last of them.
    pub(super) rest: f64,
}

impl DelayTail {
    /// From a place on, to a tolerance.
    pub(super) fn follow(profile: &Profile, pair: &Pair, from: f64, tolerance: f64) -> Self {
        let mut tail = Self { marks: Vec::new(), rest: 0.0 };
        if profile.endless_delay() != 0.0 || from >= FARTHEST {
            return tail;
        }
        let allowed = OFF * tolerance * pair.value.abs().min(1.0);
        let (mut w, mut step) = (from, STEP);
        loop {
            let node = Node::at(w);
            let r = pair.turning * node.cosh;
            let value = profile.value(r) / pair.energy;
            let power = r * profile.force(r) / pair.energy / value;
            // 1 − 1/√(1 − V/E) is −V/2E, and its integral with dr that of a power.
            let rest = -0.5 * node.cosh * value / (power - 1.0);
            let nothing = node.cosh * profile.largest_from(r) / pair.energy <= allowed;
            let is_power = r >= profile.power_from();
            if nothing || !rest.is_finite() {
                tail.rest = if power > ROUNDED && rest.is_finite() { rest } else { 0.0 };
                return tail;
            }
            if w >= FARTHEST {
                tail.rest = if power > ENDLESS { rest } else { -f64::INFINITY.copysign(value) };
                return tail;
            }
            if is_power && rest.abs() * (value.abs() + node.ratio * node.ratio) <= allowed {
                tail.rest = rest;
                return tail;
            }
            w = (w + step).min(FARTHEST);
            step = if is_power { 2.0 * step } else { STEP };
            tail.marks.push(w);
        }
    }
}
