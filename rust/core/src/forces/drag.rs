//! Drag of spheres as a function of the Reynolds number: the force and its kernel. Which functions there are is told in
//! [`named`], and what is made of one's own in [`sampled`].
//!
//! A law is what drag is over that of Stokes, 6πμav, as a function of R = ρav/μ with the radius a: the factor
//! f = R F(R)/(6π) of D = F(R) ρ a² v², which is 1 in a creeping flow, a constant times R where drag is quadratic, and
//! finite everywhere between. A body at rest needs no exception.

pub mod named;
pub mod sampled;

use super::bodies::PreciseBodies;
use super::context::{Context, System, of_body};
use super::term::{Bodies, ForceDeclaration, ForceTerm};
use super::{Adds, Force, Phase};
use crate::error::{Error, Result};
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::points::distance;
use crate::numerics::scaled::Scaled;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::Analytic;
use crate::potentials::parameters::{Kind, Parameter, Sign};
use crate::tiered;
use crate::units::{Dimension, Units};
use crate::words::number;
use core::f64::consts::PI;
use core::fmt::Debug;
use std::sync::Arc;

/// The exponents of length, mass and time in a density and in a viscosity.
const DENSITY: Dimension = [-3, 1, 0];
const VISCOSITY: Dimension = [-1, 1, -1];

/// What is the same for all laws.
const DENSITY_PARAMETER: Parameter = Parameter::positive("density", DENSITY, "The density of the fluid");
const VISCOSITY_PARAMETER: Parameter =
    Parameter::positive("viscosity", VISCOSITY, "The viscosity of the fluid");
const RADIUS_PARAMETER: Parameter = Parameter::new(
    "radius",
    Kind::Numbers(Sign::NotNegative),
    "The radius of every body, or shape (N,): of each; 0 of one that feels nothing",
)
.of([1, 0, 0]);
/// Of all of them.
const AT_REST: &str = "medium";
const ONE_WAY: &str = "drag slows bodies down, run backward it would speed them up";

/// Drag over that of Stokes as a function of the Reynolds number.
trait Law: Clone + Debug + Send + Sync + 'static {
    /// What the force of it declares.
    const DECLARATION: &'static ForceDeclaration;

    /// As [`ForceTerm::in_every_lane`].
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        None
    }
    /// The largest Reynolds number at which it is known.
    fn last(&self) -> f64;
    /// At a Reynolds number up to that. Inlined, and without closures: it is compiled for each tier.
    fn factor<S: Analytic>(&self, reynolds: S) -> S;
}

/// Spheres in a fluid at rest.
#[derive(Debug)]
struct Spheres<L> {
    law: L,
    density: f64,
    viscosity: f64,
    radius: Vec<f64>,
}

impl<L: Law> Spheres<L> {
    fn radius(&self, particle: usize) -> f64 {
        of_body(&self.radius, particle)
    }
}

/// The force of a law.
fn spheres<L: Law>(law: L, density: f64, viscosity: f64, radius: Vec<f64>) -> Arc<dyn ForceTerm> {
    Arc::new(Spheres { law, density, viscosity, radius })
}

impl<L: Law> ForceTerm for Spheres<L> {
    fn declaration(&self) -> &'static ForceDeclaration {
        L::DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        let units = context.units;
        let viscosity = |system: &System<'_>| units.take(context.own(self, system).viscosity, VISCOSITY);
        let density = |system: &System<'_>| units.take(context.own(self, system).density, DENSITY);
        let radius = |system: &System<'_>, slot: usize| {
            units.take(context.own(self, system).radius(system.bodies[slot]), [1, 0, 0])
        };
        let rate = context.per_body(|system, slot| match radius(system, slot) {
            0.0 => 0.0,
            radius => -6.0 * PI * viscosity(system) * radius / system.mass[slot],
        });
        let reynolds =
            context.per_body(|system, slot| radius(system, slot) / (viscosity(system) / density(system)));
        Box::new(Kernel { law: self.law.clone(), shape: context.shape, rate, reynolds })
    }
    fn potential_and_virial(
        &self,
        _: &PreciseBodies,
        _: usize,
        _: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        Ok((Scaled::ZERO, Scaled::from(f64::NAN)))
    }
    fn validate(&self, view: &Bodies<'_>) -> Result<()> {
        view.check_count("radius", self.radius.len())?;
        for (index, &velocity) in view.velocity.iter().enumerate() {
            let Some(limit) = self.speed_limit(index % view.particles) else { continue };
            let speed = distance(velocity, [0.0; 3]);
            if speed > limit {
                return Err(Error::invalid(
                    "velocity",
                    format!(
                        "{} is known up to the Reynolds number {}, a speed of {} of this body, and the speed of {} is {}",
                        L::DECLARATION.class_name,
                        number(self.law.last()),
                        number(limit),
                        view.name("velocity", index),
                        number(speed)
                    ),
                ));
            }
        }
        Ok(())
    }
    fn needs_mass(&self, particle: usize) -> bool {
        self.radius(particle) != 0.0
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.radius.iter().any(|&radius| radius != 0.0)
    }
    fn names_bodies(&self) -> bool {
        self.radius.len() > 1
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, ..Needs::default() }
    }
    fn never_gives_energy(&self) -> bool {
        true
    }
    fn translation_invariant(&self) -> bool {
        true
    }
    fn keeps_plane(&self) -> bool {
        true
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        self.law.in_every_lane()
    }
    fn speed_limit(&self, particle: usize) -> Option<f64> {
        let limit = self.law.last() * (self.viscosity / self.density) / self.radius(particle);
        limit.is_finite().then_some(limit)
    }
    /// Of a creeping flow, whose drag is the least over the speed.
    fn rate(&self, bodies: &[(usize, f64, [f64; 3])], units: Units) -> f64 {
        let viscosity = units.take(self.viscosity, VISCOSITY);
        let of = |&(body, mass, _): &(usize, f64, [f64; 3])| match self.radius(body) {
            0.0 => 0.0,
            radius => 6.0 * PI * viscosity * units.take(radius, [1, 0, 0]) / mass,
        };
        bodies.iter().map(of).fold(0.0, f64::max)
    }
}

#[derive(Debug)]
struct Kernel<L> {
    law: L,
    shape: Shape,
    /// −6πμa/m.
    rate: Vec<Lanes>,
    /// ρa/μ.
    reynolds: Vec<Lanes>,
}

#[inline(always)]
fn kernel<V: Vector8 + Analytic, L: Law>(of: &Kernel<L>, v: &[Lanes], a: &mut [Lanes], first: bool) {
    let Shape { rows, components } = of.shape;
    let (v, a) = (V::view(v), V::view_mut(a));
    let (rate, reynolds) = (V::view(&of.rate), V::view(&of.reynolds));
    let last = V::splat(of.law.last());
    for row in 0..rows {
        let mut square = v[row] * v[row];
        for c in 1..components {
            square = v[c * rows + row].multiply_add(v[c * rows + row], square);
        }
        let number = reynolds[row] * square.sqrt();
        let factor = V::select(number.less_equal(last), of.law.factor(number), V::splat(f64::NAN));
        let slowing = rate[row] * factor;
        for c in 0..components {
            let at = c * rows + row;
            let term = slowing * v[at];
            a[at] = if first { term } else { a[at] + term };
        }
    }
}

tiered! {
    fn kernel_tier[L: Law][L](of: &Kernel<L>, v: &[Lanes], a: &mut [Lanes], first: bool) = kernel;
}

impl<L: Law> Force<Lanes> for Kernel<L> {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        kernel_tier(self, phase.v, a, first);
        Ok(())
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, ..Needs::default() }
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}
