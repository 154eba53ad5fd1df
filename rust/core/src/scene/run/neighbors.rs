//! What neighbors of all copies of a scene do.

use super::super::Scene;
use super::super::columns::{Columns, Wanted};
pub use super::super::integrate::neighbors::{Directions, Toward};
use super::super::integrate::{Ending, neighbors};
use super::super::request::Request;
use super::begun::Begun;
use crate::error::{Error, Result};
use crate::ode::Scheme;
use crate::parallel::Ticker;

/// What became of a copy and its neighbor.
#[derive(Clone, Debug)]
pub struct Grown {
    /// The logarithm of what the distance between them has grown, at each output time; NaN after an end.
    pub growth: Vec<f64>,
    /// What has become of the difference, of the place and the velocity of each body at each output time; nothing where that was
    /// not asked.
    pub differences: Vec<[[f64; 3]; 2]>,
    /// How it ended.
    pub ending: Ending,
}

/// Follows copies of a scene and neighbors of them.
///
/// # Errors
/// Bad input, before anything runs: what `Plan::new` refuses, rigid bodies, methods that know no neighbors; errors of the library itself; [`Error::Interrupted`].
pub fn follow(
    scene: &Scene,
    request: &Request,
    toward: &Toward<'_>,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Grown>> {
    if scene.rigid.is_some() {
        let message = "expected none: neighbors of rigid bodies are not followed; a Lagrangian has exponents";
        return Err(Error::invalid("rigid_bodies", message));
    }
    let begun = Begun::planned(scene, request, true, ticker)?;
    let method = begun.plan.method;
    if matches!(method.scheme, Scheme::Taylor(_) | Scheme::Boris { .. }) {
        let message = format!("{} follows no neighbors; use auto, or another method", method.name);
        return Err(Error::invalid("method", message));
    }
    let wanted =
        Wanted { position: false, velocity: false, rigid: 0, keep_states: false, derived: Vec::new() };
    let mut columns = Columns::new(scene.copies, 0, scene.particles, &wanted)?;
    let ended = Grown { growth: Vec::new(), differences: Vec::new(), ending: Ending::Interrupted };
    let mut grown = vec![ended; scene.copies];
    for part in begun.parts(scene) {
        let sizes: Vec<[f64; 2]> =
            (0..part.scene.copies).map(|copy| toward.sizes[part.member(copy)]).collect();
        let bodies = scene.particles;
        let own: Vec<[[f64; 3]; 2]> = match toward.directions {
            Directions::OfAll(_) => Vec::new(),
            Directions::OfEach(all) => (0..part.scene.copies)
                .flat_map(|copy| all[part.member(copy) * bodies..][..bodies].iter().copied())
                .collect(),
        };
        let directions = match toward.directions {
            Directions::OfAll(directions) => Directions::OfAll(directions),
            Directions::OfEach(_) => Directions::OfEach(&own),
        };
        let toward = Toward { directions, sizes: &sizes };
        let writer = columns.writer(part.scene, part.members, 1);
        for followed in neighbors::run(&part.job(request, &writer), &toward, ticker)? {
            let neighbors::Followed { copy, growth, differences, ending } = followed;
            grown[part.member(copy)] = Grown { growth, differences, ending };
        }
    }
    Ok(grown)
}
