//! The forces of a scene over lanes: each described force becomes the kernel for the layout and the size.

use super::super::ForceSpec;
use super::{Layout, Plan, Prepared, scale};
use crate::forces::gravity::{FewBodies, RING_MAX, Ring, Tiles};
use crate::forces::uniform_field::UniformField;
use crate::forces::{Dynamics, Force};
use crate::numerics::lanes::{Lanes, WIDTH, as_numbers_mut};
use crate::numerics::real::Real;
use crate::potentials::Potential;

/// The forces on `units` of the same make-up: one if packed, up to eight if batched.
pub fn dynamics(plan: &Plan, units: &[&Prepared], threads: usize) -> Dynamics<Lanes> {
    let shape = units[0].shape;
    let kernel = |force: &ForceSpec| -> Box<dyn Force<Lanes>> {
        match force {
            ForceSpec::UniformField { g } => {
                Box::new(UniformField::new(shape, g.map(|g| scale(g, plan.units.acceleration()))))
            }
            ForceSpec::CentralField { potential, center } => {
                central_field(&**potential, center.map(|x| scale(x, -plan.units.length)), units)
            }
            ForceSpec::Gravity { softening, .. } => {
                gravity(scale(*softening, -plan.units.length), units, threads)
            }
        }
    };
    Dynamics::new(shape, plan.forces.iter().map(kernel).collect())
}

/// A number of each unit, in its lane; lanes without a unit repeat the last.
fn in_lanes(units: &[&Prepared], of: impl Fn(&Prepared) -> f64) -> Lanes {
    Lanes(core::array::from_fn(|lane| of(units[lane.min(units.len() - 1)])))
}

fn central_field(potential: &dyn Potential, center: [f64; 3], units: &[&Prepared]) -> Box<dyn Force<Lanes>> {
    let first = units[0];
    let mut inverse_mass = vec![Lanes::zero(); first.shape.rows];
    for slot in 0..first.mass.len() {
        match first.layout {
            Layout::Packed => {
                let (row, lane) = first.locate(slot, 0);
                inverse_mass[row].0[lane] = 1.0 / first.mass[slot];
            }
            Layout::Batched => inverse_mass[slot] = in_lanes(units, |unit| 1.0 / unit.mass[slot]),
        }
    }
    let scaled = potential.scaled(first.units.length, first.units.energy());
    scaled.central_force(first.shape, center, inverse_mass)
}

fn gravity(softening: f64, units: &[&Prepared], threads: usize) -> Box<dyn Force<Lanes>> {
    let first = units[0];
    let (shape, active) = (first.shape, first.unit.active);
    match first.layout {
        Layout::Batched => {
            let strength = (0..active).map(|slot| in_lanes(units, |unit| unit.strength[slot])).collect();
            Box::new(FewBodies::new(shape, strength, softening))
        }
        Layout::Packed if active <= RING_MAX => Box::new(Ring::new(shape, first.strength.clone(), softening)),
        Layout::Packed => {
            let mut strength = vec![Lanes::zero(); active.div_ceil(WIDTH)];
            as_numbers_mut(&mut strength)[..active].copy_from_slice(&first.strength);
            Box::new(Tiles::new(shape, strength, active, softening, threads))
        }
    }
}
