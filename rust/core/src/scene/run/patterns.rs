//! Batches whose copies differ in which bodies are massless: each such pattern is a run of its own.

use super::super::Scene;
use std::collections::BTreeMap;

/// Copies with the same set of massless bodies, and their scene; `None` if that is all of them.
///
/// They are run apart, so that each has the bits it has alone.
pub(super) fn patterns(scene: &Scene) -> Option<Vec<(Vec<usize>, Scene)>> {
    let pattern = |copy: usize| scene.masses(copy).iter().map(|&mass| mass > 0.0);
    if (1..scene.copies).all(|copy| pattern(copy).eq(pattern(0))) {
        return None;
    }
    let mut groups: BTreeMap<Vec<bool>, Vec<usize>> = BTreeMap::new();
    for copy in 0..scene.copies {
        groups.entry(pattern(copy).collect()).or_default().push(copy);
    }
    Some(groups.into_values().map(|members| (members.clone(), part(scene, &members))).collect())
}

/// Some copies of a scene.
pub(super) fn part(scene: &Scene, members: &[usize]) -> Scene {
    let pick = |of: fn(&Scene, usize) -> &[[f64; 3]]| {
        members.iter().flat_map(|&copy| of(scene, copy)).copied().collect()
    };
    Scene {
        copies: members.len(),
        particles: scene.particles,
        mass: members.iter().flat_map(|&copy| scene.masses(copy)).copied().collect(),
        position: pick(|scene, copy| scene.positions(copy)),
        velocity: pick(|scene, copy| scene.velocities(copy)),
        forces: scene.forces.clone(),
        t0: scene.t0,
    }
}
