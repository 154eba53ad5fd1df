//! The start of a copy: which of its bodies are parts of others, which spheres overlap, what it goes on with.

use super::super::{Collisions, Impact, check_mergers};
use crate::error::{Error, Result};
use crate::forces::ForceTerm;
use crate::forces::remaining::{OfRemaining, Remaining};
use crate::scene::continuation::{Continuation, Held};
use crate::scene::{Scene, distance};
use crate::words::number;
use std::collections::HashMap;
use std::sync::Arc;

/// The bodies of a copy.
pub(super) fn bodies_of(scene: &Scene, copy: usize, rule: Collisions, direction: f64) -> Impact {
    let (mass, radius) = (scene.masses(copy), scene.radii(copy));
    let (position, velocity) = (scene.positions(copy), scene.velocities(copy));
    let radius = if radius.is_empty() { vec![0.0; scene.particles] } else { radius.to_vec() };
    let mut host: Vec<usize> = (0..scene.particles).collect();
    let merges = rule == Collisions::Merge;
    for (body, other) in parts(scene, copy) {
        // Points that nobody has merged may be together, too.
        host[body] = if merges || radius[other] > 0.0 { other } else { body };
    }
    let remaining = Remaining::of(&host);
    let unknown = |force: &Arc<dyn ForceTerm>| matches!(force.of_remaining(&remaining), OfRemaining::Unknown);
    // What tells bodies apart cannot do without any; a merger refuses it.
    if !merges && scene.forces_of(copy).iter().any(unknown) {
        host = (0..scene.particles).collect();
    }
    let (mass, position, velocity) = (mass.to_vec(), position.to_vec(), velocity.to_vec());
    Impact { mass, radius, position, velocity, host, direction }
}

/// The bodies of a copy that are parts of others, each with that one: what an earlier run has merged is nothing by itself, in
/// the place of another and moving with it.
fn parts(scene: &Scene, copy: usize) -> Vec<(usize, usize)> {
    let (mass, radius) = (scene.masses(copy), scene.radii(copy));
    let (position, velocity) = (scene.positions(copy), scene.velocities(copy));
    let key = |body: usize| [position[body], velocity[body]].map(|x| x.map(|x| (x + 0.0).to_bits()));
    let whole = |&body: &usize| mass[body] > 0.0 || radius.get(body).is_some_and(|&radius| radius > 0.0);
    let (wholes, nothing): (Vec<usize>, Vec<usize>) = (0..scene.particles).partition(whole);
    if nothing.is_empty() {
        return Vec::new();
    }
    let there: HashMap<_, usize> = wholes.into_iter().map(|body| (key(body), body)).collect();
    nothing.into_iter().filter_map(|body| Some((body, *there.get(&key(body))?))).collect()
}

/// A body that is a part of a sphere, as a merger leaves it, and that sphere.
pub fn absorbed(scene: &Scene) -> Option<(usize, usize)> {
    let of = |copy| parts(scene, copy).into_iter().map(move |pair| (copy, pair));
    let is_sphere = |copy, other| scene.radii(copy).get(other).is_some_and(|&radius: &f64| radius > 0.0);
    let mut all = (0..scene.copies).flat_map(of);
    all.find(|&(copy, (_, other))| is_sphere(copy, other)).map(|(_, pair)| pair)
}

/// A copy without those of its bodies that are parts of others, if some are.
pub(super) fn whole_of(scene: &Scene, copy: usize, rule: Collisions) -> Result<Option<Scene>> {
    let bodies = bodies_of(scene, copy, rule, 1.0);
    let leg = Remaining::of(&bodies.host);
    if !leg.some_have_gone() {
        return Ok(None);
    }
    if rule == Collisions::Merge {
        check_mergers(scene)?;
    }
    leg.scene(scene, copy, &bodies, (scene.t0, scene.t0_rest)).map(Some)
}

/// Refuses spheres that overlap at the start, unless they merge, which they do there.
///
/// # Errors
/// By their indices, with how far they do.
pub(super) fn check_overlaps(scene: &Scene, copy: usize, rule: Collisions) -> Result<()> {
    if rule == Collisions::Merge {
        return Ok(());
    }
    let bodies = bodies_of(scene, copy, rule, 1.0);
    let touching = bodies.touching();
    let Some(&(i, j)) = touching.iter().find(|&&pair| bodies.overlap(pair)) else { return Ok(()) };
    let sum = bodies.radius[i] + bodies.radius[j];
    let apart = distance(bodies.position[i], bodies.position[j]);
    let whose = if scene.copies > 1 { format!(" of copy {copy}") } else { String::new() };
    Err(Error::invalid(
        "radius",
        format!(
            "bodies {i} and {j}{whose} overlap by {} at the start: they are {} apart, and their radii add up to {}; \
             move them apart, make them smaller, or let them merge with collisions=\"merge\"",
            number(sum - apart),
            number(apart),
            number(sum)
        ),
    ))
}

/// Of what a scene goes on with, that of the bodies of a leg.
pub(super) fn part_of(from: &Continuation, whole: &Scene, copy: usize, leg: &Remaining) -> Continuation {
    let own = copy * whole.particles;
    let pick = |of: &[[f64; 3]]| leg.bodies.iter().filter_map(|body| of.get(own + body).copied()).collect();
    let fits = from.held.numbers.len() == 3 * whole.copies * from.held.blocks * from.held.slots
        && from.held.slots >= whole.particles;
    let held = if fits { from.held.of_copy(copy).of_bodies(&leg.bodies) } else { Held::default() };
    Continuation {
        method: from.method.clone(),
        position: pick(&from.position),
        velocity: pick(&from.velocity),
        turned: Vec::new(),
        held,
        ..*from
    }
}
