//! Collisions of spheres: what is asked for, which touch, and what becomes of them.
//!
//! The one idea: a run with collisions is a chain of runs. Each ends where two spheres come to touch, as with a terminal
//! event (`integrate/events/contacts.rs` finds the place); then they merge, bounce or stop, and the next one begins there.

mod at_rest;
mod impact;
mod run;
mod sweep;
mod table;
#[cfg(test)]
mod tests;
mod together;

pub use impact::Impact;
pub use run::{absorbed, plan, run};
pub use sweep::swept;
pub use table::{Collision, Table};

use super::Scene;
use super::events::{Event, What};
use super::plan::member;
use super::request::Request;
use crate::error::{Error, Result};
use crate::forces::remaining::{OfRemaining, Remaining};
use crate::words::{number, unknown};
use core::fmt;
use std::sync::Arc;

/// By how much (d/R)² - 1 of spheres in contact may fall before they touch again: 64 roundings.
pub const TOUCH: f64 = 1.0 / (1_u64 << 46) as f64;

/// Below what (d/R)² - 1 spheres are in contact, for all that the time at which they came there can tell.
const CONTACT: f64 = 1.0 / (1_u64 << 40) as f64;

/// What spheres do that touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Collisions {
    /// They become one.
    Merge,
    /// They part with this part of the speed with which they met along the line of their centers.
    Bounce(f64),
    /// The run ends.
    Stop,
}

impl fmt::Display for Collisions {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Merge => write!(formatter, "merge"),
            Self::Bounce(restitution) => {
                write!(formatter, "bounce with restitution {}", number(*restitution))
            }
            Self::Stop => write!(formatter, "stop"),
        }
    }
}

impl Collisions {
    /// By name.
    ///
    /// # Errors
    /// An unknown name, or a coefficient of restitution that is none or belongs to no bounce.
    pub fn named(name: &str, restitution: Option<f64>) -> Result<Self> {
        let refused = |expected: &str, got: f64| {
            Err(Error::invalid("restitution", format!("expected {expected}, got {}", number(got))))
        };
        match (name, restitution) {
            ("bounce", Some(part)) if !(0.0..=1.0).contains(&part) => refused("a number from 0 to 1", part),
            ("bounce", part) => Ok(Self::Bounce(part.unwrap_or(1.0))),
            ("merge" | "stop", Some(part)) => refused("None without collisions=\"bounce\"", part),
            ("merge", None) => Ok(Self::Merge),
            ("stop", None) => Ok(Self::Stop),
            _ => Err(unknown("collisions", name, ["merge", "bounce", "stop"].into_iter())),
        }
    }

    /// Refuses what has no meaning: what was lost does not come back backwards in time, and some forces know no merged
    /// bodies.
    fn check(self, scene: &Scene, direction: f64) -> Result<()> {
        let refused = |message: &str| Err(Error::invalid("collisions", message));
        match self {
            Self::Merge if direction < 0.0 => {
                return refused(
                    "a merger cannot be undone: expected a run forward in time, or collisions=\"stop\"",
                );
            }
            Self::Bounce(part) if part < 1.0 && direction < 0.0 => {
                return refused(
                    "what a bounce has lost does not come back: expected a run forward in time, or restitution=1",
                );
            }
            _ => {}
        }
        if self == Self::Merge { check_mergers(scene) } else { Ok(()) }
    }
}

/// Refuses forces of which nothing says what they do to a merged body.
fn check_mergers(scene: &Scene) -> Result<()> {
    let refused = |message: String| Err(Error::invalid("collisions", message));
    let everybody = Remaining::of(&(0..scene.particles).collect::<Vec<usize>>());
    for force in scene.own_forces.iter().flat_map(|own| &own.sets).flatten().chain(&scene.forces) {
        let class = force.declaration().class_name;
        let of_remaining = force.of_remaining(&everybody);
        if matches!(of_remaining, OfRemaining::Unknown) {
            // Of numbers that fit no bodies it does not know, either.
            force.validate(&scene.bodies_of(0))?;
            return refused(format!(
                "{class} tells bodies apart, and nothing says what one feels that is put together of two; expected \
                 \"bounce\" or \"stop\", or forces that are the same for all bodies, or an acceleration of some"
            ));
        }
        let same = matches!(of_remaining, OfRemaining::Same);
        if same && (0..scene.particles).any(|body| force.needs_mass(body)) {
            return refused(format!(
                "{class} acts on every body alike, whatever its mass, so one that is put together of two would feel half of \
                 what both did; expected \"bounce\" or \"stop\", or forces in proportion to the mass of a body, as \
                 Gravity, UniformField and LinearDrag are"
            ));
        }
    }
    Ok(())
}

/// The event of a contact, where these pairs are in contact at the start.
pub(super) fn contact(touching: Vec<(usize, usize)>) -> Event {
    Event { what: What::Contact(Arc::from(touching)), direction: 0.0, last: Some(1) }
}

/// Whether any two bodies of a copy may touch.
fn may_touch(scene: &Scene, copy: usize) -> bool {
    scene.particles > 1 && scene.radii(copy).iter().any(|&radius| radius > 0.0)
}

/// Whether the bodies of a copy fly straight from one contact to the next, the times of which are known then.
fn flies(scene: &Scene, copy: usize, request: &Request) -> bool {
    request.method == "auto" && member(scene, copy).forces.is_empty()
}

/// What collisions are asked for and may happen.
///
/// # Errors
/// Where nothing is told of radii: points never touch, and whoever asks for collisions has forgotten them. What else is
/// wrong with the request is told first.
pub fn wanted(scene: &Scene, request: &Request) -> Result<Option<Collisions>> {
    let Some(rule) = request.collisions.filter(|_| scene.rigid.is_none()) else { return Ok(None) };
    if scene.radius.is_empty() {
        let _ = request.check(scene)?;
        let message = "expected bodies with a radius, and none has one, so that none can touch: give the radii to \
                       Particles, or leave collisions out";
        return Err(Error::invalid("collisions", message));
    }
    Ok((0..scene.copies).any(|copy| may_touch(scene, copy)).then_some(rule))
}
