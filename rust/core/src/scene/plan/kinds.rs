//! Of what kind the forces of ensemble members are, where each member has its own: members of one kind share a plan and
//! lanes, and differ in nothing but numbers that kernels have lane by lane.

use super::super::Scene;
use crate::forces::ForceTerm;
use crate::forces::term::{About, Bodies, Conserves, Coupling};
use crate::ode::system::Needs;
use std::collections::HashMap;
use std::sync::Arc;

/// Who looks at forces besides kernels, and may know those of the first copy alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Looks {
    Nobody,
    Series,
    Transformation,
}

impl Looks {
    /// Whether copies share lanes whose forces of this kind are each their own.
    fn share(self, force: &Arc<dyn ForceTerm>) -> bool {
        match self {
            Self::Nobody => true,
            Self::Series => force.series_in_every_lane(),
            Self::Transformation => false,
        }
    }
}

/// The kind of the forces of each copy, by numbers from 0 on in the order of the copies; nothing if all have the same.
pub(super) fn kinds_of_forces(scene: &Scene, looks: Looks) -> Vec<usize> {
    if scene.own_forces.is_none() {
        return Vec::new();
    }
    let mut known: HashMap<Vec<u64>, usize> = HashMap::new();
    let kind = |copy: usize| {
        let bodies = scene.bodies_of(copy);
        let mut key = Vec::new();
        for force in scene.forces_of(copy).iter().filter(|force| force.acts(&bodies)) {
            describe(force, &bodies, looks, &mut key);
        }
        let next = known.len();
        *known.entry(key).or_insert(next)
    };
    (0..scene.copies).map(kind).collect()
}

/// Tells all that a plan asks of a force but for the numbers that each lane has for itself.
fn describe(force: &Arc<dyn ForceTerm>, bodies: &Bodies<'_>, looks: Looks, key: &mut Vec<u64>) {
    let start = key.len();
    key.extend([0, core::ptr::from_ref(force.declaration()).addr() as u64]);
    match force.in_every_lane().filter(|_| looks.share(force)) {
        Some(numbers) => key.extend(numbers),
        // The same object is the same force.
        None => key.push(Arc::as_ptr(force).addr() as u64),
    }
    let Needs { time, velocity, rotation } = force.needs();
    let Conserves { momentum, angular_momentum, spin, energy } = force.conserves();
    let yes_or_no = [
        time,
        velocity,
        rotation,
        momentum,
        spin,
        energy,
        angular_momentum == About::Nowhere,
        angular_momentum == About::Everywhere,
        force.names_bodies(),
        force.translation_invariant(),
        force.galilean_invariant(),
        force.between(),
        force.keeps_plane(),
        force.center().is_some(),
        force.skipped().is_some(),
        force.as_uniform().is_some(),
        force.as_newtonian().is_some(),
    ];
    let moved = (0..bodies.particles).map(|particle| u64::from(force.needs_mass(particle)));
    key.extend(moved);
    key.extend(yes_or_no.map(u64::from));
    match force.coupling() {
        Coupling::None => key.push(0),
        Coupling::AllPairs => key.push(1),
        Coupling::Listed(pairs) => key.extend(pairs.into_iter().flat_map(|(i, j)| [i as u64, j as u64])),
    }
    let (first, last) = force.domain().unwrap_or((f64::NAN, f64::NAN));
    key.extend([first.to_bits(), last.to_bits()]);
    // Where the next force begins.
    key[start] = key.len() as u64;
}
