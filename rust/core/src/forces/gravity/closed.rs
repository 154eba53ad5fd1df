//! Two or three bodies that nothing else acts on, under a multistep method: accelerations and step in one pass.
//!
//! The one idea: a step of such a method costs little more than reading and writing what it holds. So the first body
//! of a system is left out (its centre of mass tells where it is), and the coordinates of the others, relative to it,
//! are weighed while they are in registers.

use super::few::sums;
use super::{CLOSED_MAX, FewBodies};
use crate::forces::ClosedSystems;
use crate::numerics::element::batch::view_nodes;
use crate::numerics::element::multistep::step_group;
use crate::numerics::element::{Element, Nodes, Shape};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::tiered;

/// The systems, if they are small enough and there are no massless bodies.
pub(super) fn systems<S: Element>(few: &FewBodies<S>) -> Option<ClosedSystems<'_, S>> {
    let massive = few.strength.len() / few.systems;
    (massive == few.bodies() && (2..=CLOSED_MAX).contains(&massive))
        .then_some(ClosedSystems { count: few.systems, strength: &few.strength })
}

/// Accelerations relative to the first of `N` bodies, from coordinates relative to it: `G` numbers of the others.
#[inline(always)]
fn accelerations<
    S: InverseCube,
    const N: usize,
    const HALF: usize,
    const G: usize,
    const PLANAR: bool,
    const SOFT: bool,
>(
    q: &[S],
    strength: &[S],
    softening2: S,
) -> [S; G] {
    let components = G / (N - 1);
    let mut position = [[S::zero(); 3]; N];
    for g in 0..G {
        position[1 + g / components][g % components] = q[g];
    }
    let sum = sums::<S, N, N, HALF, PLANAR, SOFT>(&position, strength, softening2);
    let mut a = [S::zero(); G];
    for g in 0..G {
        let c = g % components;
        a[g] = sum[1 + g / components][c] - sum[0][c];
    }
    a
}

#[inline(always)]
fn kernel<
    S: InverseCube,
    const N: usize,
    const HALF: usize,
    const G: usize,
    const PLANAR: bool,
    const SOFT: bool,
>(
    strength: &[S],
    softening2: f64,
    mut nodes: Nodes<'_, S>,
    steps: u64,
) {
    let (systems, softening2) = (strength.len() / N, S::splat(softening2));
    for step in 0..steps {
        for system in 0..systems {
            let (start, strength) = (system * G, &strength[system * N..][..N]);
            let (mut place, mut a) = ([S::zero(); G], [S::zero(); G]);
            place.copy_from_slice(&nodes.q.0[start..][..G]);
            if step == 0 {
                a.copy_from_slice(&nodes.a[start..][..G]);
            } else {
                a = accelerations::<S, N, HALF, G, PLANAR, SOFT>(&place, strength, softening2);
            }
            step_group(&mut nodes, start, a, place);
        }
        nodes.past.newest =
            if nodes.past.newest + 1 == nodes.weights.len() { 0 } else { nodes.past.newest + 1 };
    }
    for system in 0..systems {
        let (start, strength) = (system * G, &strength[system * N..][..N]);
        let a = accelerations::<S, N, HALF, G, PLANAR, SOFT>(&nodes.q.0[start..][..G], strength, softening2);
        nodes.a[start..][..G].copy_from_slice(&a);
    }
}

/// The kernel for so many bodies, in the plane or in space, softened or not.
#[inline(always)]
fn select_kernel<S: InverseCube>(
    bodies: usize,
    shape: Shape,
    strength: &[S],
    softening2: f64,
    nodes: Nodes<'_, S>,
    steps: u64,
) {
    macro_rules! select {
        ($bodies:literal, $half:literal, $group:literal, $planar:literal) => {
            if softening2 > 0.0 {
                kernel::<S, $bodies, $half, $group, $planar, true>(strength, softening2, nodes, steps)
            } else {
                kernel::<S, $bodies, $half, $group, $planar, false>(strength, softening2, nodes, steps)
            }
        };
    }
    match (bodies, shape.components) {
        (2, 2) => select!(2, 1, 2, true),
        (2, 3) => select!(2, 1, 3, false),
        (3, 2) => select!(3, 1, 4, true),
        (3, 3) => select!(3, 1, 6, false),
        // Others are not offered by `systems`.
        _ => {}
    }
}

#[inline(always)]
fn lanes_kernel<V: Vector8 + InverseCube>(few: &FewBodies<Lanes>, nodes: Nodes<'_, Lanes>, steps: u64) {
    let h2 = V::load(*nodes.h2);
    let (nodes, strength) = (view_nodes(&h2, nodes), V::view(&few.strength));
    select_kernel::<V>(few.bodies(), few.shape, strength, few.softening2, nodes, steps);
}

tiered! {
    /// [`Force::multistep`](crate::forces::Force::multistep) for trajectories in lanes.
    pub(super) fn lanes_multistep[][](few: &FewBodies<Lanes>, nodes: Nodes<'_, Lanes>, steps: u64) = lanes_kernel;
}

/// As [`lanes_multistep`], for one trajectory.
pub(super) fn multistep<S: Element>(few: &FewBodies<S>, nodes: Nodes<'_, S>, steps: u64) {
    select_kernel(few.bodies(), few.shape, &few.strength, few.softening2, nodes, steps);
}
