//! What a kernel is made for: bodies in lanes, in the units of the integration.

use super::ForceTerm;
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::potentials::{Numbers, Potential};
use crate::units::Units;
use core::any::Any;
use std::sync::Arc;

/// What the lanes are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrangement {
    /// The bodies of one system: those that attract first, each kind from the beginning of a row.
    Packed,
    /// Systems of the same make-up, a row for each body; those beyond eight in further blocks of rows.
    Batched,
}

/// The bodies of a system that is integrated by itself.
#[derive(Clone, Copy, Debug)]
pub struct System<'a> {
    /// Their places in the scene.
    pub bodies: &'a [usize],
    /// Their masses, in the units of the integration.
    pub mass: &'a [f64],
    /// The forces on them: kernels that are made for several systems look at each one's own.
    pub forces: &'a [Arc<dyn ForceTerm>],
}

/// What a kernel is made for.
#[derive(Debug)]
pub struct Context<'a> {
    /// What the lanes are.
    pub arrangement: Arrangement,
    /// How coordinates lie.
    pub shape: Shape,
    /// How many bodies of each system attract; they come first.
    pub active: usize,
    /// The systems: one if packed.
    pub systems: &'a [System<'a>],
    /// The place of the force among those on each system.
    pub term: usize,
    /// The units of the integration.
    pub units: Units,
    /// The time at the start of the run, in the scene's units.
    pub t0: f64,
    /// Threads that one evaluation may use.
    pub threads: usize,
    /// Whether steps are equal, and cannot be shorter where something lies unseen in them.
    pub equal_steps: bool,
}

/// Row and lane of a body of a packed system.
pub fn packed_place(slot: usize, active: usize) -> (usize, usize) {
    if slot < active {
        (slot / WIDTH, slot % WIDTH)
    } else {
        (active.div_ceil(WIDTH) + (slot - active) / WIDTH, (slot - active) % WIDTH)
    }
}

/// The number of a body, of one for all or one for each.
pub(super) fn of_body(numbers: &[f64], particle: usize) -> f64 {
    if let [all] = numbers { *all } else { numbers.get(particle).copied().unwrap_or(0.0) }
}

impl<'a> Context<'a> {
    /// The first system, by whose make-up all go.
    pub fn first(&self) -> System<'a> {
        self.systems.first().copied().unwrap_or(System { bodies: &[], mass: &[], forces: &[] })
    }
    /// Blocks of rows, each with the bodies of a system for every lane.
    pub fn blocks(&self) -> usize {
        match self.arrangement {
            Arrangement::Packed => 1,
            Arrangement::Batched => self.systems.len().div_ceil(WIDTH),
        }
    }

    /// The force on a system in the place of the one that makes a kernel for all.
    pub fn own<'t, T: ForceTerm>(&self, term: &'t T, system: &System<'t>) -> &'t T {
        let own = system.forces.get(self.term);
        own.and_then(|own| (&**own as &dyn Any).downcast_ref()).unwrap_or(term)
    }

    /// A number of each system: in its lane of each block, or if packed in all lanes.
    pub fn per_system(&self, of: impl Fn(&System<'a>) -> f64) -> Vec<Lanes> {
        match self.arrangement {
            Arrangement::Batched => self.in_rows(1, |system, _| of(system)),
            Arrangement::Packed => vec![Lanes::splat(of(&self.first()))],
        }
    }

    /// The numbers of the potentials of the systems' forces, block after block; `first` is that of the first, in the units
    /// of the integration.
    pub fn potentials(
        &self,
        first: &dyn Potential,
        of: impl Fn(&System<'a>) -> &'a Arc<dyn Potential>,
    ) -> Vec<Numbers<Lanes>> {
        let same = of(&self.first());
        let own = self.systems.iter().map(|system| match of(system) {
            potential if Arc::ptr_eq(potential, same) => first.numbers(),
            potential => potential.scaled(self.units).numbers(),
        });
        let own: Vec<Numbers<f64>> = own.collect();
        let abreast = |eight: &[Numbers<f64>]| -> Numbers<Lanes> {
            let of = |lane: usize, number: usize| eight[lane.min(eight.len() - 1)][number];
            core::array::from_fn(|number| Lanes(core::array::from_fn(|lane| of(lane, number))))
        };
        own.chunks(WIDTH).map(abreast).collect()
    }

    /// A number of each body (of a system, by its place there) in its row and lane. Lanes without a body have zero,
    /// those without a system repeat the last.
    pub fn per_body(&self, of: impl Fn(&System<'a>, usize) -> f64) -> Vec<Lanes> {
        match self.arrangement {
            Arrangement::Batched => self.in_rows(self.first().bodies.len(), of),
            Arrangement::Packed => {
                let mut values = vec![Lanes::zero(); self.shape.rows];
                let system = self.first();
                for slot in 0..system.bodies.len() {
                    let (row, lane) = packed_place(slot, self.active);
                    values[row].0[lane] = of(&system, slot);
                }
                values
            }
        }
    }

    /// As [`per_body`](Self::per_body), of the first bodies of each system, batched.
    pub fn in_rows(&self, bodies: usize, of: impl Fn(&System<'a>, usize) -> f64) -> Vec<Lanes> {
        let system =
            |block: usize, lane: usize| &self.systems[(block * WIDTH + lane).min(self.systems.len() - 1)];
        let of = &of;
        let row =
            |block: usize, slot: usize| Lanes(core::array::from_fn(|lane| of(system(block, lane), slot)));
        let blocks = 0..self.systems.len().div_ceil(WIDTH);
        blocks
            .flat_map(|block| (0..bodies).map(move |slot| (block, slot)))
            .map(|(block, slot)| row(block, slot))
            .collect()
    }
}
