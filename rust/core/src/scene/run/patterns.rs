//! Batches whose copies differ in which bodies are massless, or by far in size: each such pattern is a run of its own.

use super::super::Scene;
use super::super::frame::Units;
use super::super::plan::Plan;
use std::collections::BTreeMap;

/// Copies with the same set of massless bodies and the same units, and their scene; `None` if that is all of them.
///
/// They are run apart, so that each has the bits it has alone, and a wild one spoils no other.
pub(super) fn patterns(scene: &Scene, plan: &Plan) -> Option<Vec<(Vec<usize>, Scene)>> {
    let pattern = |copy: usize| scene.masses(copy).iter().map(|&mass| mass > 0.0);
    let units: Vec<Units> =
        (0..scene.copies).map(|copy| Units::of(scene, copy, &plan.origins[copy])).collect();
    if (1..scene.copies).all(|copy| units[copy] == units[0] && pattern(copy).eq(pattern(0))) {
        return None;
    }
    let mut groups: BTreeMap<(Vec<bool>, Units), Vec<usize>> = BTreeMap::new();
    for copy in 0..scene.copies {
        groups.entry((pattern(copy).collect(), units[copy])).or_default().push(copy);
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
