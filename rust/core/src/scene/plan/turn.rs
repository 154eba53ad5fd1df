//! The orbits on which bodies are at the start, each about the one that pulls it most; and steps that are too long for them.

use super::super::{Scene, distance};
use crate::forces::ForceTerm;
use crate::ode::{FEWEST_STEPS, Method};
use core::f64::consts::TAU;
use std::sync::Arc;

/// Bodies with at most this part of the mass that they are about change energies by less than anybody looks at.
const LIGHT: f64 = 1e-3;

/// Beyond these looking at all pairs would take as long as a step.
const BODIES: usize = 64;

/// An orbit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// The body that it is about.
    pub(super) about: usize,
    pub(super) eccentricity: f64,
    pub(super) period: f64,
    /// The period of a circle through the pericenter.
    pub(super) at_pericenter: f64,
}

/// The orbit of a body of a copy about the one that pulls it most: `Some(None)` of one that is pulled by none more than it
/// pulls, nothing if it is not bound.
pub(super) fn turn(scene: &Scene, copy: usize, constant: f64, body: usize) -> Option<Option<Turn>> {
    let (mass, places, velocities) = (scene.masses(copy), scene.positions(copy), scene.velocities(copy));
    let pull = |other: &usize| {
        let apart = distance(places[body], places[*other]);
        constant * mass[*other] / apart / apart
    };
    let others = (0..scene.particles).filter(|&other| other != body);
    let about = others.max_by(|a, b| pull(a).total_cmp(&pull(b)))?;
    if mass[about] < mass[body] {
        return Some(None);
    }
    let strength = constant * (mass[about] + mass[body]);
    let r = distance(places[body], places[about]);
    let [x, v] =
        [places, velocities].map(|of| -> [f64; 3] { core::array::from_fn(|c| of[body][c] - of[about][c]) });
    let speed = distance(velocities[body], velocities[about]);
    let axis = 1.0 / (2.0 / r - speed * speed / strength);
    let radial = x[0] * v[0] + x[1] * v[1] + x[2] * v[2];
    // e cos E and e sin E.
    let (along, across) = (1.0 - r / axis, radial / (strength * axis).sqrt());
    let eccentricity = (along * along + across * across).sqrt();
    let pericenter = axis * (1.0 - eccentricity);
    let circle = |radius: f64| TAU * radius * (radius / strength).sqrt();
    let (period, at_pericenter) = (circle(axis), circle(pericenter));
    (axis > 0.0).then_some(Some(Turn { about, eccentricity, period, at_pericenter }))
}

/// A step that is too long for an orbit at the start.
#[derive(Clone, Copy, Debug)]
pub struct TooLong {
    /// The copy.
    pub copy: usize,
    /// The body on the orbit, and the one that it is about.
    pub bodies: (usize, usize),
    /// Steps in a turn, or in one on a circle through the pericenter.
    pub steps: f64,
    /// How many the method needs to tell anything of it.
    pub fewest: f64,
    /// Whether it is that circle.
    pub at_pericenter: bool,
}

/// The orbit with the fewest steps, if a method with equal steps tells nothing of it: total energies hardly know of a light
/// body that is lost.
pub(super) fn too_long(
    scene: &Scene,
    forces: &[Arc<dyn ForceTerm>],
    method: &Method,
    (dt, span): (Option<f64>, f64),
    touching: bool,
) -> Option<TooLong> {
    let dt = dt?.abs();
    let (constant, 0.0) = forces.iter().find_map(|force| force.as_newtonian())? else { return None };
    // Copies whose forces are their own have constants of their own.
    if scene.particles > BODIES || scene.own_forces.is_some() || method.adaptive() {
        return None;
    }
    let fewest = method.fewest_steps();
    let mut worst: Option<TooLong> = None;
    for copy in 0..scene.copies {
        for body in 0..scene.particles {
            let Some(Some(Turn { about, period, at_pericenter, .. })) = turn(scene, copy, constant, body)
            else {
                continue;
            };
            // What is wrong at the pericenter of a heavier one the energy tells; where spheres touch, none may come there.
            let light = !touching && scene.masses(copy)[body] <= LIGHT * scene.masses(copy)[about];
            let turns = [(period, fewest, false), (at_pericenter, FEWEST_STEPS, true)];
            for (turn, fewest, at_pericenter) in turns.into_iter().take(if light { 2 } else { 1 }) {
                let steps = turn / dt;
                // Of less than a turn nothing is said.
                if steps < fewest && period <= span && worst.is_none_or(|worst| steps < worst.steps) {
                    worst = Some(TooLong { copy, bodies: (body, about), steps, fewest, at_pericenter });
                }
            }
        }
    }
    worst
}
