//! Batches whose copies differ in how their motion is found, in what their forces are, in which bodies are massless, in how
//! rigid bodies turn, or by far in size: each such pattern is a run of its own.

use super::super::Scene;
use super::super::frame::Units;
use super::super::plan::{Plan, are_series_poor};
use crate::error::Result;
use crate::parallel::Ticker;
use std::collections::BTreeMap;

/// Some copies, by their places among all, and the scene that they make.
pub(super) type Pattern = (Vec<usize>, Scene);

/// Which bodies have mass and how rigid ones turn, the kind of the forces, the units, and whether the motion is known.
type Key = ((Vec<bool>, Turning), (usize, Units, bool));

/// What of rigid bodies says by which method and in which of the formulas they turn: how many pairs of moments of each agree,
/// and whether it is a rod; of each load whether it looks at velocities, and whether it has a length; whether
/// series are poor.
type Turning = (Vec<(u8, bool)>, Vec<(bool, bool)>, bool);

/// That of the rigid bodies of a copy.
fn turning(scene: &Scene, copy: usize, rtol: f64) -> Turning {
    let Some(bodies) = &scene.rigid else { return Turning::default() };
    let own = copy * bodies.count..(copy + 1) * bodies.count;
    let agree = |[a, b, c]: [f64; 3]| u8::from(a == b) + u8::from(b == c) + u8::from(c == a);
    let symmetry = bodies.moments[own].iter().map(|&moments| (agree(moments), moments.contains(&0.0)));
    let loads = bodies.loads_of(copy).iter().map(|load| (load.needs_velocity(), load.length() > 0.0));
    (symmetry.collect(), loads.collect(), are_series_poor(scene, copy, rtol))
}

/// Copies that have closed forms, and copies that are integrated with forces of one kind, the same set of massless bodies,
/// rigid ones that turn alike and the same units, and their scenes; `None` if that is all of them.
///
/// They are run apart, so that each has the bits it has alone, and a wild one spoils no other.
///
/// # Errors
/// When the caller asks to stop.
pub(super) fn patterns(
    scene: &Scene,
    (plan, rtol): (&Plan, f64),
    ticker: &mut Ticker<'_>,
) -> Result<Option<Vec<Pattern>>> {
    if !plan.solutions.integrates() {
        return Ok(None);
    }
    let massive = |copy: usize| scene.masses(copy).iter().map(|&mass| mass > 0.0);
    let units = |copy| ticker.tick().map(|()| plan.units_of(scene, copy));
    let units: Vec<Units> = (0..scene.copies).map(units).collect::<Result<_>>()?;
    let kind = |copy: usize| (plan.kinds.get(copy).copied().unwrap_or(0), units[copy], plan.knows(copy));
    let alike = |copy: usize| {
        kind(copy) == kind(0)
            && massive(copy).eq(massive(0))
            && turning(scene, copy, rtol) == turning(scene, 0, rtol)
    };
    if plan.solutions.integrates_all() && (1..scene.copies).all(alike) {
        return Ok(None);
    }
    let mut groups: BTreeMap<Option<Key>, Vec<usize>> = BTreeMap::new();
    for copy in 0..scene.copies {
        let integrated = plan.solutions.of_member(copy).is_none();
        let key = integrated.then(|| ((massive(copy).collect(), turning(scene, copy, rtol)), kind(copy)));
        groups.entry(key).or_default().push(copy);
    }
    Ok(Some(groups.into_values().map(|members| (members.clone(), part(scene, &members))).collect()))
}

/// Some copies of a scene.
fn part(scene: &Scene, members: &[usize]) -> Scene {
    let pick = |of: fn(&Scene, usize) -> &[[f64; 3]]| {
        members.iter().flat_map(|&copy| of(scene, copy)).copied().collect()
    };
    Scene {
        copies: members.len(),
        particles: scene.particles,
        mass: members.iter().flat_map(|&copy| scene.masses(copy)).copied().collect(),
        position: pick(|scene, copy| scene.positions(copy)),
        velocity: pick(|scene, copy| scene.velocities(copy)),
        forces: scene.forces_of(members.first().copied().unwrap_or(0)).to_vec(),
        own_forces: scene.own_forces.as_ref().and_then(|own| own.of(members)),
        radius: members.iter().flat_map(|&copy| scene.radii(copy)).copied().collect(),
        rigid: scene.rigid.as_ref().map(|rigid| rigid.of(members)),
        t0: scene.t0,
        t0_rest: scene.t0_rest,
        continuation: None,
    }
}
