//! Coulomb's law between charges.
//!
//! On the kernels of gravity, charges in the place of gravitational parameters: what they give, times −k qᵢ/mᵢ, is the
//! acceleration. So the order in which a body's terms are added is theirs ([`gravity`](super::gravity)).

use super::bodies::PreciseBodies;
use super::context::{Context, System, of_body};
use super::derivative::{Along, Derivative};
use super::gravity::beside::{Beside, Seen, beside};
use super::gravity::ring::{Turns, Weight};
use super::gravity::{derivative, energy, newton, series};
use super::remaining::{OfRemaining, Remaining};
use super::series::Series;
use super::term::{Bodies, Conserves, Coupling, ForceDeclaration, ForceTerm};
use super::{Adds, Force, Phase};
use crate::error::{Error, Result};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::points::distance;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::ode::series::Jet;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign, Value};
use crate::tiered;
use crate::units::Units;
use crate::words::numbers;
use std::sync::Arc;

/// The exponents of length, mass and time in an energy times a length.
const CONSTANT: [i32; 3] = [3, 1, -2];

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "coulomb_force",
    class_name: "Coulomb",
    summary: "Coulomb's law between every two charges",
    formula: "V = Σ k chargeᵢ chargeⱼ / √(r² + softening²)",
    notes: "Masses are inertia alone; a charged body must have mass. The unit of charge is that in which k times the \
            square of a charge over a length is an energy; in SI, k = 8.9875517862e9. Without softening, coincident \
            bodies are refused.",
    source: "Jackson, Classical Electrodynamics, 3rd ed., section 1.1",
    example: ">>> ions = vv.Scene(vv.Particles([1.0, 2.0], [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), \
              vv.Coulomb([2.0, -1.0], k=4.0))\n>>> ions.acceleration().tolist()\n\
              [[2.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::new(
            "charge",
            Kind::Numbers(Sign::Any),
            "The charge of every body, or shape (N,): of each",
        ),
        Parameter::number("k", CONSTANT, "Coulomb's constant"),
        Parameter::new("softening", Kind::Number(Sign::NotNegative), "Plummer softening length")
            .of([1, 0, 0])
            .or(0.0),
    ],
    make: |values| match values {
        [charge, k, softening] => {
            let charge = charge.numbers();
            let largest = charge.iter().fold(0.0, |most: f64, q| most.max(q.abs()));
            Ok(Arc::new(Coulomb { charge, largest, k: k.number(), softening: softening.number() }))
        }
        _ => Err(Error::Internal("Coulomb takes three parameters".to_owned())),
    },
};

/// Charges.
#[derive(Debug)]
struct Coulomb {
    charge: Vec<f64>,
    /// The largest without its sign.
    largest: f64,
    k: f64,
    softening: f64,
}

impl Coulomb {
    fn charge(&self, particle: usize) -> f64 {
        of_body(&self.charge, particle)
    }
    /// The exponent of the largest charge, by which all are brought near one: its square must not overflow.
    fn unit(&self) -> i32 {
        exponent(self.largest)
    }
    /// A charge in that unit.
    fn near(&self, particle: usize) -> f64 {
        scale(self.charge(particle), -self.unit())
    }
    /// −k qᵢ/mᵢ, of k in that unit squared.
    fn factors(&self, context: &Context<'_>) -> Vec<Lanes> {
        context.per_body(|system, slot| {
            let own = context.own(self, system);
            match own.near(system.bodies[slot]) {
                0.0 => 0.0,
                charge => {
                    -scale(own.k, 2 * own.unit() - context.units.exponent(CONSTANT)) * charge
                        / system.mass[slot]
                }
            }
        })
    }
}

impl ForceTerm for Coulomb {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        let near = |system: &System<'_>, slot: usize| context.own(self, system).near(system.bodies[slot]);
        Box::new(Kernel {
            field: newton::attraction(context, near, |system| context.own(self, system).softening),
            scratch: vec![Lanes::zero(); context.shape.len()],
            factor: self.factors(context),
        })
    }
    /// Gravity has the distances, if it is softened alike.
    fn kernel_after(&self, other: &dyn ForceTerm, context: &Context<'_>) -> Option<Box<dyn Force<Lanes>>> {
        beside(other, Some(self.softening), context, || {
            let bodies = context.first().bodies;
            let charges: Vec<f64> = bodies.iter().map(|&body| self.near(body)).collect();
            Charges { weights: Weight::of_turns(&charges), factor: self.factors(context)[0] }
        })
    }
    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        let near = |system: &System<'_>, slot: usize| context.own(self, system).near(system.bodies[slot]);
        let softening = |system: &System<'_>| context.own(self, system).softening;
        Some(Box::new(Change {
            field: derivative::attraction(context, near, softening),
            scratch: vec![Lanes::zero(); context.shape.len()],
            factor: self.factors(context),
        }))
    }
    fn series(&self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        Some(Box::new(CoulombSeries {
            field: series::attraction(context, |system, slot| self.near(system.bodies[slot]), self.softening),
            scratch: vec![Lanes::zero(); context.shape.len()],
            factor: self.factors(context),
        }))
    }
    fn has_series(&self) -> bool {
        true
    }
    fn potential_and_virial(
        &self,
        bodies: &PreciseBodies,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        let charges = bodies.with_masses(|body| self.charge(body));
        energy::potential_and_virial(&charges, -self.k, self.softening, threads, ticker)
    }
    fn validate(&self, view: &Bodies<'_>) -> Result<()> {
        view.check_count("charge", self.charge.len())?;
        if self.softening > 0.0 {
            return Ok(());
        }
        match view.coincident(|m, n| m > 0.0 && n > 0.0) {
            None => Ok(()),
            Some((i, j)) => Err(Error::invalid(
                "position",
                format!(
                    "expected distinct positions for bodies with Coulomb, got {} = {} = {}; move one of them or give \
                     Coulomb a softening",
                    view.name("position", i),
                    view.name("position", j),
                    numbers(&view.position[i])
                ),
            )),
        }
    }
    fn needs_mass(&self, particle: usize) -> bool {
        self.charge(particle) != 0.0
    }
    fn acts(&self, view: &Bodies<'_>) -> bool {
        let charged = (0..view.particles).filter(|&particle| self.charge(particle) != 0.0);
        self.k != 0.0 && charged.take(2).count() == 2
    }
    fn coupling(&self) -> Coupling {
        Coupling::AllPairs
    }
    fn names_bodies(&self) -> bool {
        self.charge.len() > 1
    }
    fn of_remaining(&self, remaining: &Remaining) -> OfRemaining {
        let values =
            |charges| vec![Value::Numbers(charges), Value::Number(self.k), Value::Number(self.softening)];
        OfRemaining::values(remaining.sums(&self.charge).map(values))
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
    /// In which the force of the largest charges at that distance moves the mass over it.
    fn unit_of_time(&self, length: i32, mass: i32) -> Option<i32> {
        let largest = self.largest;
        let strong = self.k != 0.0 && largest != 0.0;
        strong.then(|| (3 * length + mass - exponent(self.k) - 2 * exponent(largest)).div_euclid(2))
    }
    fn strongest(
        &self,
        bodies: &[(usize, f64, [f64; 3])],
        units: Units,
        _: [f64; 3],
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let largest = self.largest;
        let softening = units.take(self.softening, [1, 0, 0]);
        let mut strongest = 0.0_f64;
        for (at, &(body, mass, position)) in bodies.iter().enumerate() {
            let charge = self.charge(body);
            if charge == 0.0 {
                continue;
            }
            // The nearest in the list is enough for an estimate.
            let others = bodies.iter().enumerate().filter(|(other, _)| *other != at);
            let nearest = others.map(|(_, other)| distance(position, other.2)).fold(f64::MAX, f64::min);
            let k = Scaled::from(self.k.abs()).times(charge.abs()).times(largest);
            let k = Scaled::new(k.value(), k.exponent() - units.exponent(CONSTANT)).to_f64();
            let square = nearest * nearest + softening * softening;
            strongest = strongest.max(k / square / mass);
            ticker.tick()?;
        }
        Ok(strongest)
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(vec![u64::from(self.softening > 0.0)])
    }
    fn as_coulomb(&self, [i, j]: [usize; 2]) -> Option<(Scaled, f64)> {
        Some((Scaled::from(self.k).times(self.charge(i)).times(self.charge(j)), self.softening))
    }
}

/// As [`Kernel`].
struct CoulombSeries {
    field: Box<dyn Series<Lanes>>,
    scratch: Vec<Lanes>,
    factor: Vec<Lanes>,
}

impl Series<Lanes> for CoulombSeries {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.field.coefficient(n, jet, &mut self.scratch, true, ticker)?;
        kernel_tier(&self.scratch, &self.factor, a, first);
        Ok(())
    }
}

/// The charges of few bodies, beside gravity.
struct Charges {
    /// In the place of `G·m`.
    weights: Vec<Weight>,
    /// −k qᵢ/mᵢ.
    factor: Lanes,
}

impl Beside for Charges {
    const VELOCITY: bool = false;

    #[inline(always)]
    fn term<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
        &self,
        _: &Seen<'_, V>,
        found: &Turns<V, TURNS>,
    ) -> [V; 3] {
        let mut term = found.sum::<PLANAR, EVEN>(&self.weights);
        let factor = V::load(self.factor);
        let neutral = factor.abs().less_equal(V::zero());
        for c in 0..3 {
            term[c] = V::select(neutral, V::zero(), factor * term[c]);
        }
        term
    }
}

struct Kernel {
    /// Σ qⱼ (rⱼ − rᵢ)/r³.
    field: Box<dyn Force<Lanes>>,
    scratch: Vec<Lanes>,
    /// −k qᵢ/mᵢ.
    factor: Vec<Lanes>,
}

#[inline(always)]
fn kernel<V: Vector8>(field: &[Lanes], factor: &[Lanes], a: &mut [Lanes], first: bool) {
    let rows = factor.len();
    let (field, factor, a) = (V::view(field), V::view(factor), V::view_mut(a));
    for (a, field) in a.chunks_exact_mut(rows).zip(field.chunks_exact(rows)) {
        for row in 0..rows {
            // A neutral body may be where a charge is.
            let neutral = factor[row].abs().less_equal(V::zero());
            let term = V::select(neutral, V::zero(), factor[row] * field[row]);
            a[row] = if first { term } else { a[row] + term };
        }
    }
}

tiered! {
    fn kernel_tier[][](field: &[Lanes], factor: &[Lanes], a: &mut [Lanes], first: bool) = kernel;
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.field.apply(phase, &mut self.scratch, true, ticker)?;
        kernel_tier(&self.scratch, &self.factor, a, first);
        Ok(())
    }
    fn stops_midway(&self) -> bool {
        self.field.stops_midway()
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}

/// How that changes along a direction.
struct Change {
    field: Box<dyn Derivative<Lanes>>,
    scratch: Vec<Lanes>,
    factor: Vec<Lanes>,
}

impl Derivative<Lanes> for Change {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        along: Along<'_, Lanes>,
        change: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.field.apply(phase, along, &mut self.scratch, ticker)?;
        kernel_tier(&self.scratch, &self.factor, change, true);
        Ok(())
    }
    fn stops_midway(&self) -> bool {
        self.field.stops_midway()
    }
}
