//! Newton's law between all pairs: what a scene describes.

use super::passive::Leading;
use super::{FewBodies, ManyBodies, RING_MAX, Ring, Tiles, TwoRows, derivative, energy, series};
use crate::error::{Error, Result};
use crate::forces::Force;
use crate::forces::bodies::PreciseBodies;
use crate::forces::context::{Arrangement, Context, System};
use crate::forces::derivative::Derivative;
use crate::forces::following::{Following, Leaders};
use crate::forces::series::Series;
use crate::forces::term::{Bodies, Conserves, Coupling, ForceDeclaration, ForceTerm};
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::exponent;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign};
use crate::words::numbers;
use std::sync::Arc;

/// The exponents of length, mass and time in the gravitational constant.
pub(in crate::forces) const CONSTANT: [i32; 3] = [3, -1, -2];

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "gravity",
    class_name: "Gravity",
    summary: "Newton's law between every two bodies",
    formula: "V = −Σ G mᵢ mⱼ / √(r² + softening²)",
    notes: "Massless bodies feel the others and exert nothing. Without softening, coincident bodies are refused.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 3.7; \
             softening: H. C. Plummer, MNRAS 71 (1911) 460",
    example: ">>> vv.Gravity(G=1.0)\nGravity(G=1.0, softening=0.0)",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::number("G", CONSTANT, "The gravitational constant"),
        Parameter::new("softening", Kind::Number(Sign::NotNegative), "Plummer softening length")
            .of([1, 0, 0])
            .or(0.0),
    ],
    make: |values| Ok(Arc::new(Gravity::new(values[0].number(), values[1].number()))),
};

/// Newtonian gravity between all pairs.
#[derive(Debug)]
pub struct Gravity {
    constant: f64,
    softening: f64,
}

impl Gravity {
    /// From the gravitational constant and the softening length.
    pub fn new(constant: f64, softening: f64) -> Self {
        Self { constant, softening }
    }

    /// `G·m` of a body of a system.
    fn strength<'s>(&'s self, context: &'s Context<'_>) -> impl Fn(&System<'_>, usize) -> f64 + 's {
        |system, slot| context.units.take(context.own(self, system).constant, CONSTANT) * system.mass[slot]
    }
}

/// Gravity among the few bodies of each system, batched, if it is the first of the forces.
pub fn few_bodies(context: &Context<'_>) -> Option<FewBodies<Lanes>> {
    let newtonian = |system: &System<'_>| system.forces.first().and_then(|force| force.as_newtonian());
    let _ = newtonian(&context.first())?;
    let of = |system: &System<'_>| newtonian(system).unwrap_or_default();
    let strength =
        |system: &System<'_>, slot: usize| context.units.take(of(system).0, CONSTANT) * system.mass[slot];
    Some(few(context, strength, |system| of(system).1))
}

fn few(
    context: &Context<'_>,
    strength: impl Fn(&System<'_>, usize) -> f64,
    softening: impl Fn(&System<'_>) -> f64,
) -> FewBodies<Lanes> {
    let strength = context.in_rows(context.active, strength);
    let softening = context.per_system(|system| context.units.take(softening(system), [1, 0, 0]));
    FewBodies::new(context.shape, strength, softening)
}

/// The ring of the bodies of one system, if it has few and all attract.
pub fn ring(context: &Context<'_>, constant: f64, softening: f64) -> Option<Ring> {
    let system = context.first();
    let few = context.active <= RING_MAX && context.active == system.bodies.len();
    (few && context.arrangement == Arrangement::Packed).then(|| {
        let constant = context.units.take(constant, CONSTANT);
        let strength = system.mass.iter().map(|mass| constant * mass).collect();
        Ring::new(context.shape, strength, context.units.take(softening, [1, 0, 0]))
    })
}

/// The kernel of Σ strengthⱼ (rⱼ − rᵢ)/(r² + softening²)^{3/2} on every body, from those of all that come first.
pub fn attraction(
    context: &Context<'_>,
    strength: impl Fn(&System<'_>, usize) -> f64,
    softening: impl Fn(&System<'_>) -> f64,
) -> Box<dyn Force<Lanes>> {
    let (shape, active) = (context.shape, context.active);
    if context.arrangement == Arrangement::Batched {
        let bodies = few(context, strength, softening);
        return if active <= RING_MAX { Box::new(bodies) } else { Box::new(ManyBodies(bodies)) };
    }
    let system = context.first();
    let softening = context.units.take(softening(&system), [1, 0, 0]);
    let numbers: Vec<f64> = (0..active).map(|slot| strength(&system, slot)).collect();
    if active <= RING_MAX {
        return Box::new(Ring::new(shape, numbers, softening));
    }
    match TwoRows::new(&numbers, softening, shape.components).filter(|_| shape.rows == 2) {
        Some(rows) => Box::new(rows),
        None => Box::new(Tiles::new(shape, &numbers, softening, context.threads)),
    }
}

impl ForceTerm for Gravity {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }

    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        attraction(context, self.strength(context), |system| context.own(self, system).softening)
    }

    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        let softening = |system: &System<'_>| context.own(self, system).softening;
        Some(derivative::attraction(context, self.strength(context), softening))
    }

    fn series(&self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        let constant = context.units.take(self.constant, CONSTANT);
        Some(series::attraction(context, |system, slot| constant * system.mass[slot], self.softening))
    }

    fn has_series(&self) -> bool {
        true
    }

    fn following(&self, leaders: &Leaders<'_>) -> Option<Box<dyn Following>> {
        Some(Box::new(Leading::new(self.softening, leaders)))
    }

    fn potential_and_virial(
        &self,
        bodies: &PreciseBodies,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        energy::potential_and_virial(bodies, self.constant, self.softening, threads, ticker)
    }

    fn validate(&self, bodies: &Bodies<'_>) -> Result<()> {
        if self.softening > 0.0 {
            return Ok(());
        }
        match bodies.coincident(|m, n| m > 0.0 || n > 0.0) {
            None => Ok(()),
            Some((i, j)) => Err(Error::invalid(
                "position",
                format!(
                    "expected distinct positions for bodies that attract each other, got {} = {} = {}; move one of \
                     them or give Gravity a softening",
                    bodies.name("position", i),
                    bodies.name("position", j),
                    numbers(&bodies.position[i])
                ),
            )),
        }
    }

    fn acts(&self, bodies: &Bodies<'_>) -> bool {
        self.constant != 0.0 && bodies.particles > 1 && bodies.mass.iter().any(|&mass| mass > 0.0)
    }
    fn coupling(&self) -> Coupling {
        Coupling::AllPairs
    }
    fn conserves(&self) -> Conserves {
        Conserves::EVERYTHING
    }
    fn keeps_plane(&self) -> bool {
        true
    }
    fn length(&self) -> f64 {
        self.softening
    }
    /// The free-fall time of the mass from that length.
    fn unit_of_time(&self, length: i32, mass: i32) -> Option<i32> {
        (self.constant != 0.0).then(|| (3 * length - exponent(self.constant) - mass).div_euclid(2))
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(vec![u64::from(self.softening > 0.0)])
    }
    fn skipped(&self) -> Option<(&'static str, &'static str)> {
        (self.softening == 0.0).then_some(("softening terms", "softening is 0"))
    }
    fn as_newtonian(&self) -> Option<(f64, f64)> {
        Some((self.constant, self.softening))
    }
}
