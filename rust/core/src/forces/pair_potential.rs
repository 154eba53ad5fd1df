//! A potential between all pairs of bodies.
//!
//! Canonical order of the forces on a body, which are summed before they are divided by its mass:
//!
//! - up to eight bodies: partners in order of index, packed and batched alike;
//! - more: the triangle of tiles of eight is cut into shards by the number of bodies alone; in a shard a body receives
//!   its terms from bodies before it in order of index, then the horizontal sum over those of its row and after; the
//!   shards are added in ascending order. Threads do not enter.

use super::approach::{self, Moving};
use super::bodies::{Of, PreciseBodies, Vector};
use super::context::{Arrangement, Context};
use super::derivative::Derivative;
use super::gravity::RING_MAX;
use super::limits::{check_force, outside};
use super::lines::Between;
use super::term::{Bodies, Conserves, Coupling, ForceDeclaration, ForceTerm};
use super::{Adds, Force, Phase};
use crate::error::{Error, Result};
use crate::numerics::lanes::Lanes;
use crate::numerics::points::distance;
use crate::numerics::power_of_two::{exponent, power_of_two};
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::parallel::{Ticker, for_chunks};
use crate::potentials::kernels::Pairs;
use crate::potentials::parameters::{Declaration, Kind, Parameter};
use crate::potentials::{Potential, near_one};
use crate::words::{number, numbers};
use std::sync::Arc;

/// Rows per shard at least, and the most shards.
const ROWS_PER_SHARD: usize = 16;
const SHARDS_MAX: usize = 32;
/// Rows from which an evaluation ticks.
const LONG_ROWS: usize = 64;

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "pair_potential",
    class_name: "PairPotential",
    summary: "A potential V(r) between every two bodies",
    formula: "V = Σ V(|rⱼ − rᵢ|)",
    notes: "It acts by its force, which does not depend on masses, so every mass must be positive.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 1.2",
    example: ">>> vv.PairPotential(vv.potentials.LennardJones(epsilon=1.0, sigma=1.0))\n\
              PairPotential(potential=LennardJones(epsilon=1.0, sigma=1.0))",
    at_rest: "",
    one_way: "",
    parameters: &[Parameter::new(
        "potential",
        Kind::Potential,
        "The potential energy of a pair at the distance r",
    )],
    make: |values| match values {
        [potential] => Ok(Arc::new(PairPotential { potential: potential.potential()? })),
        _ => Err(Error::Internal("PairPotential takes one parameter".to_owned())),
    },
};

/// A potential between all pairs.
#[derive(Debug)]
struct PairPotential {
    potential: Arc<dyn Potential>,
}

impl ForceTerm for PairPotential {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        let (shape, bodies) = (context.shape, context.first().bodies.len());
        let way = match context.arrangement {
            Arrangement::Batched => Way::Systems,
            Arrangement::Packed if bodies <= RING_MAX => Way::Few,
            Arrangement::Packed => {
                let count = (shape.rows / ROWS_PER_SHARD).clamp(1, SHARDS_MAX);
                let bound = |shard: usize| shape.rows * shard / count;
                Way::Shards((0..count).map(|shard| (bound(shard), bound(shard + 1))).collect())
            }
        };
        let (potential, pairs) = self.pairs(context);
        let length2 = approach::lengths2(context, |system| &context.own(self, system).potential);
        Box::new(Kernel {
            potential,
            length2,
            pairs,
            way,
            inverse_mass: context.per_body(|system, slot| 1.0 / system.mass[slot]),
            force: vec![Lanes::zero(); shape.len()],
            threads: context.threads,
        })
    }
    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        let (potential, pairs) = self.pairs(context);
        let together = context.arrangement == Arrangement::Packed;
        let is_long = together && context.shape.rows >= LONG_ROWS;
        let inverse_mass = context.per_body(|system, slot| 1.0 / system.mass[slot]);
        Some(Between::boxed(potential, pairs, (together, is_long), inverse_mass))
    }
    fn potential_and_virial(
        &self,
        bodies: &PreciseBodies,
        _: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        let (mut energy, mut work) = (Scaled::ZERO, Scaled::ZERO);
        let (potential, unit) = near_one(&self.potential, bodies.units.length);
        for i in 0..bodies.len() {
            let from = bodies.vector(Of::Position, i);
            for j in i + 1..bodies.len() {
                let to = bodies.vector(Of::Position, j);
                let d: Vector = core::array::from_fn(|c| to[c] - from[c]);
                let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
                let (value, force) = potential.precise(r);
                energy = energy.plus(Scaled::new(value, unit));
                work = work.plus(Scaled::new(force * r, unit));
            }
            ticker.tick()?;
        }
        Ok((energy, work))
    }
    fn validate(&self, view: &Bodies<'_>) -> Result<()> {
        check_force("PairPotential", &*self.potential)?;
        self.within(view)?;
        match view.coincident(|_, _| self.potential.singular()) {
            None => Ok(()),
            Some((i, j)) => Err(Error::invalid(
                "position",
                format!(
                    "expected distinct positions for bodies with a singular PairPotential, got {} = {} = {}; move one",
                    view.name("position", i),
                    view.name("position", j),
                    numbers(&view.position[i])
                ),
            )),
        }
    }
    fn needs_mass(&self, _: usize) -> bool {
        true
    }
    fn acts(&self, view: &Bodies<'_>) -> bool {
        view.particles > 1 && self.potential.inverse_distance_strength() != Some(0.0)
    }
    fn coupling(&self) -> Coupling {
        Coupling::AllPairs
    }
    fn softening(&self) -> f64 {
        if self.potential.singular() { 0.0 } else { self.potential.own_length().unwrap_or(0.0) }
    }
    fn conserves(&self) -> Conserves {
        Conserves::EVERYTHING
    }
    fn domain(&self) -> Option<(f64, f64)> {
        self.potential.domain()
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        self.potential.in_every_lane()
    }
    fn keeps_plane(&self) -> bool {
        true
    }
    /// In which the force at that distance moves the mass over it.
    fn unit_of_time(&self, length: i32, mass: i32) -> Option<i32> {
        let (first, last) = self.domain().unwrap_or((0.0, f64::INFINITY));
        let [_, force, _] = self.potential.evaluate(&[power_of_two(length).clamp(first, last)]);
        let fine = |force: &&f64| force.is_finite() && **force != 0.0;
        force.first().filter(fine).map(|&force| (length + mass - exponent(force)).div_euclid(2))
    }
    fn strongest(
        &self,
        bodies: &[(usize, f64, [f64; 3])],
        units: crate::units::Units,
        _: [f64; 3],
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let potential = self.potential.scaled(units);
        let mut strongest = 0.0_f64;
        for (at, &(_, mass, position)) in bodies.iter().enumerate() {
            // The nearest in the list is enough for an estimate.
            let others = bodies.iter().enumerate().filter(|(other, _)| *other != at);
            let distances = others.map(|(_, other)| distance(position, other.2));
            let Some(nearest) = distances.reduce(f64::min) else { continue };
            let [_, force, _] = potential.evaluate(&[nearest]);
            strongest = force.iter().fold(strongest, |m, force| m.max(force.abs() / mass));
            ticker.tick()?;
        }
        Ok(strongest)
    }
}

impl PairPotential {
    /// What acts between the bodies of a context, in its units.
    fn pairs(&self, context: &Context<'_>) -> (Arc<dyn Potential>, Pairs) {
        let potential = self.potential.scaled(context.units);
        let numbers = context.potentials(&*potential, |system| &context.own(self, system).potential);
        let bodies = context.first().bodies.len();
        (potential, Pairs { shape: context.shape, blocks: context.blocks(), bodies, numbers })
    }

    /// Refuses pairs at distances at which the potential is not.
    fn within(&self, view: &Bodies<'_>) -> Result<()> {
        let Some(domain) = self.domain() else { return Ok(()) };
        for copy in 0..view.copies {
            let (_, position) = view.copy(copy);
            for i in 0..position.len() {
                for j in i + 1..position.len() {
                    let apart = distance(position[i], position[j]);
                    if !(domain.0..=domain.1).contains(&apart) {
                        let name = |at: usize| view.name("position", copy * view.particles + at);
                        let bodies = format!("{} and {} are {} apart", name(i), name(j), number(apart));
                        return Err(outside("PairPotential", &*self.potential, domain, &bodies));
                    }
                }
            }
        }
        Ok(())
    }
}

/// How the pairs are gone through.
#[derive(Debug)]
enum Way {
    /// A system in each lane.
    Systems,
    /// Up to eight bodies in one row.
    Few,
    /// Tiles, from row to row.
    Shards(Vec<(usize, usize)>),
}

#[derive(Debug)]
struct Kernel {
    potential: Arc<dyn Potential>,
    pairs: Pairs,
    way: Way,
    inverse_mass: Vec<Lanes>,
    force: Vec<Lanes>,
    threads: usize,
    /// The squared lengths of the potentials of the systems in the lanes, if they have lengths.
    length2: Option<Lanes>,
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let (rows, components) = (self.pairs.shape.rows, self.pairs.shape.components);
        let stops = self.stops_midway();
        self.force.fill(Lanes::zero());
        match &self.way {
            Way::Systems => self.potential.between_systems(&self.pairs, phase.q, &mut self.force),
            Way::Few => self.potential.between_few(&self.pairs, phase.q, &mut self.force),
            Way::Shards(shards) => {
                let (potential, pairs) = (&self.potential, &self.pairs);
                let parts = for_chunks(self.threads, shards.len(), ticker, |index, ticker| {
                    let (start, end) = shards[index];
                    let mut force = vec![Lanes::zero(); components * (rows - start)];
                    for row in start..end {
                        potential.between_rows(pairs, phase.q, &mut force, (row, start));
                        if stops {
                            ticker.tick()?;
                        }
                    }
                    Ok(force)
                })?;
                for (part, &(start, _)) in parts.iter().zip(shards) {
                    for c in 0..components {
                        let into = self.force[c * rows + start..(c + 1) * rows].iter_mut();
                        for (into, part) in into.zip(&part[c * (rows - start)..]) {
                            *into += *part;
                        }
                    }
                }
            }
        }
        for (at, (a, force)) in a.iter_mut().zip(&self.force).enumerate() {
            let term = *force * self.inverse_mass[at % rows];
            *a = if first { term } else { *a + term };
        }
        Ok(())
    }
    fn longest_step(&self, (q, v): (&[Lanes], &[Lanes]), a: &[Lanes]) -> Option<Lanes> {
        let length2 = self.length2.as_ref()?;
        let moving = Moving { shape: self.pairs.shape, q, v, a };
        Some(match self.way {
            Way::Systems => approach::between_systems(&moving, length2),
            Way::Few | Way::Shards(_) => approach::between_bodies(&moving, self.pairs.bodies, length2),
        })
    }
    fn stops_midway(&self) -> bool {
        self.pairs.shape.rows >= LONG_ROWS && matches!(self.way, Way::Shards(_))
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}
