//! Whether a run has resolved anything: the energy at the end against that at the start, which it may not exceed where
//! forces only take energy.
//!
//! Looked at where it costs next to nothing beside the run, so that a result that is wrong by orders of magnitude does
//! not go out without a word.

use super::super::integrate::Ending;
use super::super::request::Request;
use super::{Outcome, Part, Reached};
use crate::conservation::kinetic_energy;
use crate::error::Result;
use crate::forces::bodies::PreciseBodies;
use crate::forces::term::{conserved_by, never_give_energy, potential_and_virial};
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;

/// A sum over so few pairs is nothing beside a run.
const FEW_PAIRS: u64 = 100;
/// A sum over pairs takes less than a hundredth of so many evaluations of the forces.
const MANY_EVALUATIONS: u64 = 2_000;
/// More massive bodies are not looked at.
const MOST: usize = 2_000;

/// Smaller energies may be products with masses that are not normal numbers, and have no digits to be off by.
const LEAST: f64 = 1e-290;

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
    // Members that run together have forces of one kind.
    let conserved = conserved_by(&scene.forces, &scene.bodies()).energy;
    let told = conserved || never_give_energy(&scene.forces, &scene.bodies());
    if !told || plan.active.len() > MOST || request.times.is_empty() {
        return Ok(());
    }
    let pairs = plan.pairs_per_evaluation();
    let mut bodies = PreciseBodies::default();
    for copy in 0..scene.copies {
        let member = part.member(copy);
        let outcome = &mut outcomes[member];
        let cheap = pairs <= FEW_PAIRS || outcome.counts.evaluations >= MANY_EVALUATIONS;
        if outcome.ending != Ending::Finished || !cheap {
            continue;
        }
        let places = member * scene.particles..(member + 1) * scene.particles;
        let states = [
            (scene.positions(copy), scene.velocities(copy)),
            (&reached.position[places.clone()], &reached.velocity[places]),
        ];
        let mut energies = [(Scaled::ZERO, Scaled::ZERO); 2];
        for ((position, velocity), energies) in states.into_iter().zip(&mut energies) {
            bodies.clear(scene.particles);
            for (particle, &mass) in scene.masses(copy).iter().enumerate() {
                let exact = |x: [f64; 3]| [x, [0.0; 3]];
                bodies.set(particle, mass, exact(position[particle]), exact(velocity[particle]));
            }
            bodies.settle();
            let Ok((potential, _)) = potential_and_virial(scene.forces_of(copy), &bodies, 1, ticker) else {
                return Ok(());
            };
            *energies = (kinetic_energy(&bodies), potential);
        }
        let [(kinetic, potential), (kinetic_end, potential_end)] = energies;
        let change = kinetic_end.plus(potential_end).plus(kinetic.plus(potential).times(-1.0));
        // Of the two potential energies the larger: what falls from rest where the potential is zero begins with nothing.
        let size = larger(absolute(potential), absolute(potential_end));
        let whole = kinetic.plus(size);
        if whole.to_f64() >= LEAST {
            let change = change.over(whole).to_f64();
            // Backward in time what is taken comes back.
            outcome.energy_error = if conserved { change.abs() } else { (plan.direction * change).max(0.0) };
        }
    }
    Ok(())
}

fn absolute(energy: Scaled) -> Scaled {
    if energy.value().high() < 0.0 { energy.times(-1.0) } else { energy }
}

fn larger(a: Scaled, b: Scaled) -> Scaled {
    if a.plus(b.times(-1.0)).value().high() < 0.0 { b } else { a }
}
