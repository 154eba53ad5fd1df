//! The orbits on which bodies are at the start, each about the one that pulls it most, and moons about the one whose pull
//! changes most on the way; the turns of charges in magnetic fields; and steps that are too long for them.

use super::super::{Scene, distance};
use super::passage;
use crate::forces::ForceTerm;
use crate::ode::{FEWEST_STEPS, Method, Scheme};
use core::f64::consts::TAU;
use std::sync::Arc;

/// Bodies with at most this part of the mass that they are about change energies by less than anybody looks at.
const LIGHT: f64 = 1e-3;

/// So many orbits are looked at as they pass their pericenters, the most suspicious first.
const PASSAGES: usize = 8;

/// To look at so many pairs takes less than a hundredth of a run of so many steps for each.
const PAIRS: usize = 4_096;
const STEPS: f64 = 100.0;
const MOST_PAIRS: usize = 1 << 18;

/// Orbits that come as near as this many softening lengths are no conics.
const SOFT: f64 = 100.0;

/// An orbit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// The body that it is about.
    pub(super) about: usize,
    pub(super) eccentricity: f64,
    pericenter: f64,
    pub(super) period: f64,
    /// The period of a circle through the pericenter.
    pub(super) at_pericenter: f64,
}

/// The orbit of a body of a copy about the one that pulls it most: `Some(None)` of one that is pulled by none more than it
/// pulls, nothing if it is not bound.
pub(super) fn turn(scene: &Scene, copy: usize, constant: f64, body: usize) -> Option<Option<Turn>> {
    let mass = scene.masses(copy);
    let [Some(about), _] = strongest(scene, copy, body) else { return Some(None) };
    if mass[about] < mass[body] {
        return Some(None);
    }
    turn_about(scene, copy, constant, (body, about)).map(Some)
}

/// The orbit of a body about the heavier one whose pull changes most from place to place, as that of a planet at its moon.
fn turn_of_moon(scene: &Scene, copy: usize, constant: f64, body: usize) -> Option<Turn> {
    let [_, about] = strongest(scene, copy, body);
    turn_about(scene, copy, constant, (body, about?))
}

/// The one that pulls a body of a copy most, and of those at least as heavy the one whose pull changes most from place to
/// place there.
fn strongest(scene: &Scene, copy: usize, body: usize) -> [Option<usize>; 2] {
    let (mass, places) = (scene.masses(copy), scene.positions(copy));
    let (mut strongest, mut most) = ([None; 2], [f64::NEG_INFINITY; 2]);
    for (other, (&mass_there, &there)) in mass.iter().zip(places).enumerate() {
        if other == body || mass_there <= 0.0 {
            continue;
        }
        let r = apart(places[body], there);
        let pull = mass_there / r / r;
        let tide = if mass_there >= mass[body] { pull / r } else { f64::NEG_INFINITY };
        for (which, strength) in [pull, tide].into_iter().enumerate() {
            if strength >= most[which] && strength >= 0.0 {
                (strongest[which], most[which]) = (Some(other), strength);
            }
        }
    }
    strongest
}

/// The distance of two points: there are many pairs of them, few of which are so far or near that squares are out of range.
#[inline]
fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let square = x * x + y * y + z * z;
    if (1e-280..1e280).contains(&square) { square.sqrt() } else { distance(a, b) }
}

/// The orbit of one body about another, if it is bound.
fn turn_about(scene: &Scene, copy: usize, constant: f64, (body, about): (usize, usize)) -> Option<Turn> {
    let (mass, places, velocities) = (scene.masses(copy), scene.positions(copy), scene.velocities(copy));
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
    // Of a pull beyond all numbers no time is known.
    (axis > 0.0 && strength < f64::INFINITY).then_some(Turn {
        about,
        eccentricity,
        pericenter,
        period,
        at_pericenter,
    })
}

/// A step that is too long for an orbit at the start, or for a turn in a magnetic field.
#[derive(Clone, Copy, Debug)]
pub struct TooLong {
    /// The copy.
    pub copy: usize,
    /// The body that turns.
    pub body: usize,
    /// The one that it is about, unless it turns in a magnetic field.
    pub about: Option<usize>,
    /// Steps in a turn, or in one on a circle through the pericenter.
    pub steps: f64,
    /// How many the method needs to tell anything of it.
    pub fewest: f64,
    /// Whether it is that circle.
    pub at_pericenter: bool,
}

impl TooLong {
    /// About what the body turns.
    pub fn place(&self) -> String {
        self.about.map_or_else(|| "in the magnetic field".to_owned(), |about| format!("about body {about}"))
    }
}

/// The turn with the fewest steps, if a method with equal steps tells nothing of it.
pub(super) fn too_long(
    scene: &Scene,
    forces: &[Arc<dyn ForceTerm>],
    method: &'static Method,
    (dt, span): (Option<f64>, f64),
    touching: bool,
) -> Option<TooLong> {
    let dt = dt?.abs();
    let orbit = orbit_too_long(scene, forces, method, (dt, span), touching);
    let gyration = gyration_too_long(scene, method, dt.min(span));
    let fewer = |a: TooLong, b: TooLong| if b.steps < a.steps { b } else { a };
    orbit.into_iter().chain(gyration).reduce(fewer)
}

/// The turn of a charge in magnetic fields with the fewest steps, for a method that turns velocities exactly: no energy
/// knows that bodies are carried past their circles. Fields add.
fn gyration_too_long(scene: &Scene, method: &Method, dt: f64) -> Option<TooLong> {
    if !matches!(method.scheme, Scheme::Boris(_)) {
        return None;
    }
    let mut worst: Option<TooLong> = None;
    for copy in 0..scene.copies {
        let fields: Vec<_> = scene.forces_of(copy).iter().filter_map(|force| force.as_magnetic()).collect();
        for (body, &mass) in scene.masses(copy).iter().enumerate() {
            let push =
                |c: usize| fields.iter().map(|field| field.charge_of(body) * field.field[c]).sum::<f64>();
            let rate = distance([push(0), push(1), push(2)], [0.0; 3]) / mass;
            let steps = TAU / (rate * dt);
            if steps < FEWEST_STEPS && worst.is_none_or(|worst| steps < worst.steps) {
                let fewest = FEWEST_STEPS;
                worst = Some(TooLong { copy, body, about: None, steps, fewest, at_pericenter: false });
            }
        }
    }
    worst
}

/// The orbit with the fewest steps, if a method with equal steps tells nothing of it: total energies hardly know of a light
/// body that is lost.
fn orbit_too_long(
    scene: &Scene,
    forces: &[Arc<dyn ForceTerm>],
    method: &'static Method,
    (dt, span): (f64, f64),
    touching: bool,
) -> Option<TooLong> {
    let newtonian = |forces: &[Arc<dyn ForceTerm>]| forces.iter().find_map(|force| force.as_newtonian());
    let told = newtonian(forces);
    if method.adaptive() || (told.is_none() && scene.own_forces.is_none()) {
        return None;
    }
    let massive = scene.masses(0).iter().filter(|&&mass| mass > 0.0).count();
    let pairs = scene.particles * massive;
    if pairs > MOST_PAIRS || (pairs > PAIRS && span < STEPS * dt) {
        return None;
    }
    let fewest = method.fewest_steps();
    let mut worst: Option<TooLong> = None;
    let mut passages = Vec::new();
    for copy in 0..scene.copies {
        let own = if scene.own_forces.is_some() { newtonian(scene.forces_of(copy)) } else { told };
        let Some((constant, softening)) = own else { continue };
        let orbits = (0..scene.particles).flat_map(|body| {
            let of_planet = turn(scene, copy, constant, body).flatten();
            let of_moon = turn_of_moon(scene, copy, constant, body);
            let other = of_moon.filter(|moon| of_planet.is_none_or(|planet| planet.about != moon.about));
            [of_planet, other].into_iter().flatten().map(move |turn| (body, turn))
        });
        for (body, Turn { about, eccentricity, pericenter, period, at_pericenter }) in orbits {
            if pericenter < SOFT * softening {
                continue;
            }
            // What is wrong at the pericenter of a heavier one the energy tells; where spheres touch, none may come there.
            let light = !touching && scene.masses(copy)[body] <= LIGHT * scene.masses(copy)[about];
            // Of less than a turn nothing is said.
            if period > span {
                continue;
            }
            let turns = [(period, fewest, false), (at_pericenter, FEWEST_STEPS, true)];
            for (turn, fewest, at_pericenter) in turns.into_iter().take(if light { 2 } else { 1 }) {
                let steps = turn / dt;
                if steps < fewest && worst.is_none_or(|worst| steps < worst.steps) {
                    worst = Some(TooLong { copy, body, about: Some(about), steps, fewest, at_pericenter });
                }
            }
            let steps = at_pericenter / dt;
            if let Some(suspicion) = passage::suspicion(method, eccentricity, steps).filter(|_| light) {
                let passing = TooLong { copy, body, about: Some(about), steps, fewest, at_pericenter: true };
                passages.push((suspicion, (eccentricity, span / period), passing));
            }
        }
    }
    if worst.is_some() {
        return worst;
    }
    passages.sort_by(|(one, ..), (other, ..)| other.total_cmp(one));
    passages.into_iter().take(PASSAGES).find_map(|(_, (eccentricity, times), passing)| {
        let fewest = passage::fewest_steps(method, eccentricity, passing.steps, times)?;
        Some(TooLong { fewest, ..passing })
    })
}
