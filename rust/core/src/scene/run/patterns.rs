//! Batches whose copies differ in how their motion is found, or in which bodies are massless: each such pattern is a run
//! of its own.

use super::super::Scene;
use super::super::plan::Solutions;
use std::collections::BTreeMap;

/// Copies that have closed forms, copies that are integrated with the same set of massless bodies, and their scenes;
/// `None` if that is all of them.
///
/// They are run apart, so that each has the bits it has alone.
pub(super) fn patterns(scene: &Scene, solutions: &Solutions) -> Option<Vec<(Vec<usize>, Scene)>> {
    let pattern = |copy: usize| scene.masses(copy).iter().map(|&mass| mass > 0.0);
    let alike = || (1..scene.copies).all(|copy| pattern(copy).eq(pattern(0)));
    if !solutions.integrates() || (solutions.integrates_all() && alike()) {
        return None;
    }
    let mut groups: BTreeMap<Option<Vec<bool>>, Vec<usize>> = BTreeMap::new();
    for copy in 0..scene.copies {
        let integrated = solutions.of_member(copy).is_none();
        groups.entry(integrated.then(|| pattern(copy).collect())).or_default().push(copy);
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
