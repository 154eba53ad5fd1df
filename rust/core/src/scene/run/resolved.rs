//! Whether a run has resolved anything: the energy at the end against that at the start, which it may not exceed where
//! forces only take energy; and against what steps of another length make of it, where it has changed.
//!
//! Looked at where it costs next to nothing beside the run, so that a result that is wrong by orders of magnitude does
//! not go out without a word.

use super::super::Scene;
use super::super::integrate::Ending;
use super::super::plan::Plan;
use super::super::request::Request;
use super::{Outcome, Part, Reached, half_steps};
use crate::conservation::kinetic_energy;
use crate::error::Result;
use crate::forces::ForceTerm;
use crate::forces::bodies::PreciseBodies;
use crate::forces::term::Coupling;
use crate::forces::together::{Energy, potential_and_virial};
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::units::Units;
use std::sync::Arc;

/// A sum over so few pairs is nothing beside a run.
const FEW_PAIRS: u64 = 500;
/// The sums over pairs at both ends take as long as five evaluations of the forces: a few hundredths of so many.
const MANY_EVALUATIONS: u64 = 200;
/// More massive bodies are not looked at.
const MOST: usize = 2_000;

/// Smaller energies may be products with masses that are not normal numbers, and have no digits to be off by.
const LEAST: f64 = 1e-290;

/// From this error on of equal steps, and from `rtol` on of others, it is asked what of it is the rounding of the state, …
const WORTH_A_LOOK: f64 = 1e-2;
/// … and so many times what a last digit makes of the energy is that.
const ROUNDINGS: f64 = 8.0;

/// Forces that may change the energy by anything seldom change it by more than this part of what there was; …
const ALL_THERE_WAS: f64 = 1.0;
/// … where bodies may come close to each other, or to a center, a passage between two steps changes it by this part or more.
const BY_A_PASSAGE: f64 = 0.01;
/// By so much steps of another length may change the energy at the end, as they do where motions are chaotic.
const BY_OTHER_STEPS: f64 = 0.02;

/// On the way bodies may be so many times faster, in the mean, than the energies at both ends tell.
const FASTER: f64 = 3.0;

/// Fills in the errors of the energies.
///
/// # Errors
/// None but those of the library itself.
pub(super) fn look(
    part: &Part<'_>,
    request: &Request,
    outcomes: &mut [Outcome],
    reached: &Reached,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    let (scene, plan) = (part.scene, part.plan);
    if plan.active.len() > MOST || request.times.is_empty() {
        return Ok(());
    }
    let span = (request.times[request.times.len() - 1] - scene.t0).abs();
    let pairs = plan.pairs_per_evaluation();
    let mut bodies = PreciseBodies::default();
    for copy in 0..scene.copies {
        let member = part.member(copy);
        let outcome = &mut outcomes[member];
        let many = outcome.counts.evaluations >= MANY_EVALUATIONS;
        // Who asks for energies pays for such sums.
        let cheap = pairs <= FEW_PAIRS || many || request.records("energy");
        let tells = plan.energy != Energy::Unknown || half_steps::pays(part, outcome.counts.evaluations);
        if outcome.ending != Ending::Finished || !cheap || !tells {
            continue;
        }
        let places = member * scene.particles..(member + 1) * scene.particles;
        let states = [
            (scene.positions(copy), scene.velocities(copy)),
            (&reached.position[places.clone()], &reached.velocity[places]),
        ];
        let mut energies = [(Scaled::ZERO, Scaled::ZERO); 2];
        for (state, energies) in states.into_iter().zip(&mut energies) {
            let Ok(found) = energy_of(scene, copy, state, &mut bodies, ticker) else { return Ok(()) };
            *energies = found;
        }
        let [(kinetic, potential), (kinetic_end, potential_end)] = energies;
        let change = kinetic_end.plus(potential_end).minus(kinetic.plus(potential));
        // Of the two potential energies the larger: what falls from rest where the potential is zero begins with nothing.
        let size = larger(absolute(potential), absolute(potential_end));
        // What drives give may be all that there is at the end.
        let driven = plan.energy == Energy::Driven;
        let mut whole = if driven { larger(kinetic, kinetic_end) } else { kinetic }.plus(size);
        if driven {
            // Bodies that rest at both ends, where potentials are zero, were as fast on the way as all forces make them.
            whole = whole.plus(gained_from_rest(scene, copy, (plan, span), ticker)?);
        }
        if whole.to_f64() >= LEAST {
            let error = |whole: Scaled| {
                let change = change.over(whole).to_f64();
                match plan.energy {
                    Energy::Driven => (change.abs() - given_by_drives(scene, copy, span, whole)).max(0.0),
                    // Backward in time what is taken comes back.
                    Energy::NeverGrows => (plan.direction * change).max(0.0),
                    Energy::Constant => change.abs(),
                    Energy::Unknown => 0.0,
                }
            };
            outcome.energy_error = error(whole);
            let (begun_with, told) = (kinetic.plus(size), outcome.energy_error > WORTH_A_LOOK);
            let usual = if passages_matter(scene, copy) { BY_A_PASSAGE } else { ALL_THERE_WAS };
            if plan.energy != Energy::Constant
                && !told
                && outcome.unresolved.is_none()
                && begun_with.to_f64() >= LEAST
                && change.over(begun_with).to_f64().abs() > usual
                && half_steps::pays(part, outcome.counts.evaluations)
            {
                let size = larger(kinetic, kinetic_end).plus(size);
                let mut change = |times_as_long| {
                    let other = half_steps::energy_at_end(part, request, times_as_long, ticker).ok()??;
                    let off = other.minus(kinetic_end.plus(potential_end));
                    Some(off.over(size).to_f64().abs())
                };
                // Where twice the steps lead to the same energy, half of them need not be taken.
                let stays = |change: f64| change <= BY_OTHER_STEPS;
                let error = if change(2.0).is_some_and(stays) { None } else { change(0.5) };
                outcome.energy_error = error.filter(|&error| !stays(error)).unwrap_or(0.0);
                continue;
            }
            let begins_with_nothing = kinetic.plus(absolute(potential)).value().high() == 0.0;
            if begins_with_nothing && outcome.energy_error > 0.0 && outcome.counts.steps > 0 {
                let step = plan.dt.map_or(plan.span / outcome.counts.steps as f64, f64::abs);
                let gained = gained_from_rest(scene, copy, (plan, step), ticker)?;
                outcome.energy_error = error(whole.plus(gained));
            }
            // Far from the origin places have few digits left, and energies no more.
            if outcome.energy_error > if plan.dt.is_some() { WORTH_A_LOOK } else { request.rtol } {
                let [_, (position, velocity)] = states;
                let (position, velocity) = (nudged(position), nudged(velocity));
                let Ok(beside) = energy_of(scene, copy, (&position, &velocity), &mut bodies, ticker) else {
                    return Ok(());
                };
                let rounding = beside.0.plus(beside.1).minus(kinetic_end.plus(potential_end));
                let rounding = ROUNDINGS * rounding.over(whole).to_f64().abs();
                if rounding.is_finite() {
                    outcome.energy_error = (outcome.energy_error - rounding).max(0.0);
                }
            }
        }
    }
    Ok(())
}

/// Kinetic and potential energy.
pub(in crate::scene) fn energy_of(
    scene: &Scene,
    copy: usize,
    (position, velocity): (&[[f64; 3]], &[[f64; 3]]),
    bodies: &mut PreciseBodies,
    ticker: &mut Ticker<'_>,
) -> Result<(Scaled, Scaled)> {
    bodies.clear(scene.particles);
    for (particle, &mass) in scene.masses(copy).iter().enumerate() {
        let exact = |x: [f64; 3]| [x, [0.0; 3]];
        bodies.set(particle, mass, exact(position[particle]), exact(velocity[particle]));
    }
    bodies.settle();
    let (potential, _) = potential_and_virial(scene.forces_of(copy), bodies, 1, ticker)?;
    Ok((kinetic_energy(bodies), potential))
}

/// Whether a force of a copy may be the stronger the closer bodies come, to each other or to a center.
fn passages_matter(scene: &Scene, copy: usize) -> bool {
    let grows =
        |force: &Arc<dyn ForceTerm>| force.coupling() == Coupling::AllPairs || force.center().is_some();
    scene.forces_of(copy).iter().any(grows)
}

/// What drives may give to a copy in a span of time, as a part of its energies: their forces times the ways of all bodies, at
/// the speeds that these energies allow.
fn given_by_drives(scene: &Scene, copy: usize, span: f64, whole: Scaled) -> f64 {
    let size = |[x, y, z]: [f64; 3]| x.hypot(y).hypot(z);
    let drives = scene.forces_of(copy).iter().filter_map(|force| force.as_driven());
    let force: f64 = drives.map(|drive| size(drive.amplitude)).sum();
    let masses = scene.masses(copy).iter().filter(|&&mass| mass > 0.0);
    let ways: f64 = masses.map(|mass| (2.0 / mass).sqrt() * span).sum();
    Scaled::from(FASTER * force).times(ways).over(whole.sqrt()).to_f64()
}

/// Vectors whose coordinates are a last digit larger and smaller in turns.
fn nudged(vectors: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut nudged = vectors.to_vec();
    for (index, x) in nudged.iter_mut().enumerate() {
        for (c, x) in x.iter_mut().enumerate() {
            *x = if (index + c) % 2 == 0 { x.next_up() } else { x.next_down() };
        }
    }
    nudged
}

/// What forces give to bodies at rest in a step. Of a motion that begins at rest, where potential energies vanish, and comes
/// back there, nothing else tells how large its energies are.
fn gained_from_rest(
    scene: &Scene,
    copy: usize,
    (plan, step): (&Plan, f64),
    ticker: &mut Ticker<'_>,
) -> Result<Scaled> {
    let bodies = scene.masses(copy).iter().zip(scene.positions(copy)).enumerate();
    let bodies =
        bodies.filter(|&(_, (&mass, _))| mass > 0.0).map(|(body, (&mass, &place))| (body, mass, place));
    let bodies: Vec<_> = bodies.collect();
    let times = [0.0, 0.5, 1.0].map(|share| plan.t0 + share * plan.direction * plan.span);
    let mut strongest = 0.0_f64;
    for force in scene.forces_of(copy) {
        strongest = strongest.max(force.strongest(&bodies, Units::default(), times, ticker)?);
    }
    let speed = strongest * step;
    let mass: f64 = bodies.iter().map(|&(_, mass, _)| mass).sum();
    let gained = Scaled::from(speed).times(speed).times(0.5 * mass);
    Ok(if speed.is_finite() && mass.is_finite() { gained } else { Scaled::ZERO })
}

fn absolute(energy: Scaled) -> Scaled {
    if energy.value().high() < 0.0 { energy.negative() } else { energy }
}

fn larger(a: Scaled, b: Scaled) -> Scaled {
    if a.minus(b).value().high() < 0.0 { b } else { a }
}
