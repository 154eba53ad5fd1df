//! Light spheres between heavy ones that come together: infinitely many bounces in a finite time.
//!
//! The one idea: each bounce adds twice the speed of a wall, so that the times between them shrink to nothing. A sphere with
//! a mass turns the walls back in the end, after π √(M/m) bounces or so (G. Galperin, Regul. Chaotic Dyn. 8 (2003) 375); one
//! whose mass they do not feel never does.

use super::super::{Collision, Impact};
use std::collections::BTreeMap;

/// A sphere with this part of the mass of another does not change its motion.
const UNFELT: f64 = 0.5 * f64::EPSILON;

/// Bounces, each of them harder and sooner than the one before, after which it is not waited for their end. Balls that are
/// not quite in line with the walls have slipped out from between them by then, …
const BOUNCES: u32 = 4096;
/// … if the time between them has fallen to this part: that between a fast ball and slow walls has not.
const SHRUNK: f64 = 1e-6;

/// The last bounces of light spheres off heavy ones.
#[derive(Default)]
pub(super) struct Squeezed(BTreeMap<usize, Last>);

#[derive(Clone, Copy)]
struct Last {
    /// How long after the start.
    elapsed: f64,
    /// How fast it was met.
    speed: f64,
    /// How long after the one before, and that of the first in succession.
    after: f64,
    first_after: f64,
    /// How many were harder and sooner in succession.
    bounces: u32,
}

impl Squeezed {
    /// Takes note of a bounce so long after the start; whether it is one of infinitely many.
    pub(super) fn note(&mut self, bodies: &Impact, collision: &Collision, elapsed: f64) -> bool {
        let (i, j) = collision.bodies;
        let (light, heavy) = if bodies.mass[i] < bodies.mass[j] { (i, j) } else { (j, i) };
        if bodies.mass[light] >= UNFELT * bodies.mass[heavy] {
            // Who feels it is turned back by it.
            let _ = self.0.remove(&light);
            return false;
        }
        let speed = collision.speed;
        let first = Last { elapsed, speed, after: f64::INFINITY, first_after: f64::INFINITY, bounces: 0 };
        let last = self.0.entry(light).or_insert(first);
        let after = (elapsed - last.elapsed).abs();
        let bounces = if speed > last.speed && after < last.after { last.bounces + 1 } else { 0 };
        *last = match bounces {
            0 => first,
            1 => Last { after, first_after: after, bounces, ..first },
            _ => Last { after, first_after: last.first_after, bounces, ..first },
        };
        bounces >= BOUNCES && after <= SHRUNK * last.first_after
    }
}
