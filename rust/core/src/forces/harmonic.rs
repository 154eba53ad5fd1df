//! An isotropic oscillator: the pull −k (r − center) on every body.

use super::bodies::{Of, PreciseBodies, Vector};
use super::context::{Context, System};
use super::derivative::{Derivative, OfLinear};
use super::gravity::beside::{Beside, Seen, beside};
use super::gravity::ring::Turns;
use super::linear::{Linear, LinearAcceleration};
use super::series::{LinearSeries, Series};
use super::term::{About, Bodies, Conserves, ForceDeclaration, ForceTerm};
use super::{Adds, Force, Phase};
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::points::distance;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign};
use crate::tiered;
use crate::units::Units;
use std::sync::Arc;

/// The exponents of length, mass and time in a stiffness.
const STIFFNESS: [i32; 3] = [0, 1, -2];

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "harmonic",
    class_name: "Harmonic",
    summary: "A pull to a fixed point in proportion to the distance, on every body: an isotropic oscillator",
    formula: "V = Σ ½ k |rᵢ − center|²",
    notes: "It acts by its force, so every mass must be positive.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 3.6",
    example: ">>> bob = vv.Scene(vv.Particles([1.0], [[3.0, 0.0, 0.0]]), vv.Harmonic(k=4.0))\n\
              >>> bob.acceleration().tolist()\n[[-12.0, 0.0, 0.0]]",
    at_rest: "center",
    one_way: "",
    parameters: &[
        Parameter::new("k", Kind::Number(Sign::NotNegative), "The stiffness, force over distance")
            .of(STIFFNESS),
        Parameter::new("center", Kind::Point, "The fixed point").of([1, 0, 0]).or(0.0),
    ],
    make: |values| match values {
        [k, center] => Ok(Arc::new(Harmonic { k: k.number(), center: center.vector() })),
        _ => Err(crate::Error::Internal("Harmonic takes two parameters".to_owned())),
    },
};

/// A stiffness and a center.
#[derive(Debug)]
struct Harmonic {
    k: f64,
    center: [f64; 3],
}

impl Harmonic {
    fn pulls(&self, context: &Context<'_>) -> Kernel {
        let k = |system: &System<'_>| context.units.take(context.own(self, system).k, STIFFNESS);
        let center = |system: &System<'_>, c: usize| {
            context.units.take(context.own(self, system).center[c], [1, 0, 0])
        };
        Kernel {
            shape: context.shape,
            center: [0, 1, 2].map(|c| context.per_system(|system| center(system, c))),
            square: context.per_body(|system, slot| k(system) / system.mass[slot]),
        }
    }
}

impl ForceTerm for Harmonic {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        Box::new(self.pulls(context))
    }
    fn kernel_after(&self, other: &dyn ForceTerm, context: &Context<'_>) -> Option<Box<dyn Force<Lanes>>> {
        beside(other, None, context, || self.pulls(context))
    }
    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        let pulls = self.pulls(context);
        let center = pulls.center.map(|lanes| vec![Lanes::zero(); lanes.len()]);
        OfLinear::boxed(Some(Box::new(Kernel { center, ..pulls })))
    }
    fn series(&self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        let linear = Self { center: [0.0; 3], ..*self };
        LinearSeries::boxed(self.kernel(context), Some(linear.kernel(context)))
    }
    fn has_series(&self) -> bool {
        true
    }
    fn as_linear(&self) -> Option<&dyn Linear> {
        Some(self)
    }
    fn potential_and_virial(
        &self,
        bodies: &PreciseBodies,
        _: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        let (mut squares, mut along) = (Scaled::ZERO, Scaled::ZERO);
        let unit = bodies.units.length;
        for body in 0..bodies.len() {
            let place = bodies.vector(Of::Position, body);
            let d: Vector =
                core::array::from_fn(|c| place[c] - DoubleDouble::from(scale(self.center[c], -unit)));
            squares = squares.plus(Scaled::new(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], 2 * unit));
            along = along.plus(Scaled::new(d[0] * place[0] + d[1] * place[1] + d[2] * place[2], 2 * unit));
            ticker.tick()?;
        }
        Ok((squares.times(0.5 * self.k), along.times(-self.k)))
    }
    fn needs_mass(&self, _: usize) -> bool {
        true
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.k != 0.0
    }
    fn conserves(&self) -> Conserves {
        Conserves { momentum: false, angular_momentum: About::Point(self.center), spin: false, energy: true }
    }
    fn keeps_plane(&self) -> bool {
        self.center[2] == 0.0
    }
    /// 1/ω of the mass.
    fn unit_of_time(&self, _: i32, mass: i32) -> Option<i32> {
        (self.k > 0.0).then(|| (mass - exponent(self.k)).div_euclid(2))
    }
    fn strongest(
        &self,
        bodies: &[(usize, f64, [f64; 3])],
        units: Units,
        _: [f64; 3],
        _: &mut Ticker<'_>,
    ) -> Result<f64> {
        let (k, center) = (units.take(self.k, STIFFNESS), units.take_vector(self.center, [1, 0, 0]));
        Ok(bodies.iter().map(|&(_, mass, place)| k / mass * distance(place, center)).fold(0.0, f64::max))
    }
    /// The angular frequency.
    fn rate(&self, bodies: &[(usize, f64, [f64; 3])], units: Units) -> f64 {
        let k = units.take(self.k, STIFFNESS);
        bodies.iter().map(|&(_, mass, _)| (k / mass).sqrt()).fold(0.0, f64::max)
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }
    fn fixed_point(&self) -> Option<[f64; 3]> {
        Some(self.center)
    }
    fn as_harmonic(&self) -> Option<(f64, [f64; 3])> {
        Some((self.k, self.center))
    }
}

impl Linear for Harmonic {
    fn add_to(&self, acceleration: &mut LinearAcceleration, _: usize, mass: Scaled) {
        let rate = Scaled::from(-self.k).over(mass);
        if self.k != 0.0 {
            (0..3).for_each(|c| acceleration.add_by_distance(c, (c, self.center[c]), rate));
        }
    }
}

#[derive(Debug)]
struct Kernel {
    shape: Shape,
    /// Of each block.
    center: [Vec<Lanes>; 3],
    /// The squares of the angular frequencies.
    square: Vec<Lanes>,
}

#[inline(always)]
fn kernel<V: Vector8>(force: &Kernel, q: &[Lanes], a: &mut [Lanes], first: bool) {
    let Shape { rows, components } = force.shape;
    let (q, a, square) = (V::view(q), V::view_mut(a), V::view(&force.square));
    for c in 0..components {
        let centers = V::view(&force.center[c]);
        let bodies = rows / centers.len();
        for (block, &center) in centers.iter().enumerate() {
            for row in block * bodies..(block + 1) * bodies {
                let at = c * rows + row;
                let term = square[row] * (center - q[at]);
                a[at] = if first { term } else { a[at] + term };
            }
        }
    }
}

impl Beside for Kernel {
    const VELOCITY: bool = false;

    #[inline(always)]
    fn term<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
        &self,
        seen: &Seen<'_, V>,
        _: &Turns<V, TURNS>,
    ) -> [V; 3] {
        let square = V::load(self.square[0]);
        let mut term = [V::zero(); 3];
        for c in 0..if PLANAR { 2 } else { 3 } {
            term[c] = square * (V::load(self.center[c][0]) - seen.place[c]);
        }
        term
    }
}

tiered! {
    fn kernel_tier[][](force: &Kernel, q: &[Lanes], a: &mut [Lanes], first: bool) = kernel;
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        kernel_tier(self, phase.q, a, first);
        Ok(())
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}
