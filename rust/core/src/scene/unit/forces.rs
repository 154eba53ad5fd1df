//! The forces of a scene over lanes: each described force becomes the kernel for the layout and the size.

use super::super::ForceSpec;
use super::{Layout, Plan, Prepared, scale};
use crate::forces::gravity::{FewBodies, RING_MAX, Ring, Tiles};
use crate::forces::uniform_field::UniformField;
use crate::forces::{Dynamics, Force};
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Lanes, WIDTH, as_numbers_mut};
use crate::numerics::real::Real;
use crate::potentials::Potential;

/// The forces on `units` of the same make-up: one if packed, up to eight for each block of rows if batched.
pub fn dynamics(plan: &Plan, units: &[&Prepared], threads: usize) -> Dynamics<Lanes> {
    let shape = units[0].state_shape(units.len());
    if let (true, [ForceSpec::Gravity { softening, .. }]) = (plan.relative, &plan.forces[..]) {
        return Dynamics::closed(few_bodies(shape, scale(*softening, -plan.units.length), units));
    }
    let kernel = |force: &ForceSpec| -> Box<dyn Force<Lanes>> {
        match force {
            ForceSpec::UniformField { g } => {
                Box::new(UniformField::new(shape, g.map(|g| scale(g, plan.units.acceleration()))))
            }
            ForceSpec::CentralField { potential, center } => {
                central_field(shape, &**potential, center.map(|x| scale(x, -plan.units.length)), units)
            }
            ForceSpec::Gravity { softening, .. } => {
                gravity(shape, scale(*softening, -plan.units.length), units, threads)
            }
        }
    };
    Dynamics::new(shape, plan.forces.iter().map(kernel).collect())
}

/// A number of each of the first bodies of each unit, in its lane, block of units after block; lanes without a unit
/// repeat the last.
fn in_rows(units: &[&Prepared], bodies: usize, of: impl Fn(&Prepared, usize) -> f64) -> Vec<Lanes> {
    let row = |block: usize, slot: usize| {
        Lanes(core::array::from_fn(|lane| of(units[(block * WIDTH + lane).min(units.len() - 1)], slot)))
    };
    let blocks = 0..units.len().div_ceil(WIDTH);
    blocks
        .flat_map(|block| (0..bodies).map(move |slot| (block, slot)))
        .map(|(block, slot)| row(block, slot))
        .collect()
}

fn central_field(
    shape: Shape,
    potential: &dyn Potential,
    center: [f64; 3],
    units: &[&Prepared],
) -> Box<dyn Force<Lanes>> {
    let first = units[0];
    let inverse_mass = match first.layout {
        Layout::Packed => {
            let mut inverse_mass = vec![Lanes::zero(); shape.rows];
            for slot in 0..first.mass.len() {
                let (row, lane) = first.locate(slot, 0);
                inverse_mass[row].0[lane] = 1.0 / first.mass[slot];
            }
            inverse_mass
        }
        Layout::Batched => in_rows(units, first.mass.len(), |unit, slot| 1.0 / unit.mass[slot]),
    };
    let scaled = potential.scaled(first.units.length, first.units.energy());
    scaled.central_force(shape, center, inverse_mass)
}

fn few_bodies(shape: Shape, softening: f64, units: &[&Prepared]) -> FewBodies<Lanes> {
    let strength = in_rows(units, units[0].unit.active, |unit, slot| unit.strength[slot]);
    FewBodies::new(shape, units.len().div_ceil(WIDTH), strength, softening)
}

fn gravity(shape: Shape, softening: f64, units: &[&Prepared], threads: usize) -> Box<dyn Force<Lanes>> {
    let first = units[0];
    let active = first.unit.active;
    match first.layout {
        Layout::Batched => Box::new(few_bodies(shape, softening, units)),
        Layout::Packed if active <= RING_MAX => Box::new(Ring::new(shape, first.strength.clone(), softening)),
        Layout::Packed => {
            let mut strength = vec![Lanes::zero(); active.div_ceil(WIDTH)];
            as_numbers_mut(&mut strength)[..active].copy_from_slice(&first.strength);
            Box::new(Tiles::new(shape, strength, active, softening, threads))
        }
    }
}
