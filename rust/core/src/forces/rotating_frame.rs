//! A frame that turns: the centrifugal force and the Coriolis force on everything that is described in it.

use super::bodies::{Of, PreciseBodies, Vector};
use super::context::{Context, System};
use super::derivative::{Derivative, OfLinear};
use super::gravity::beside::{Beside, Seen, beside};
use super::gravity::ring::Turns;
use super::linear::{Linear, LinearAcceleration};
use super::series::{LinearSeries, Series};
use super::term::{Bodies, Conserves, ForceDeclaration, ForceTerm};
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
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter};
use crate::tiered;
use crate::units::Units;
use std::sync::Arc;

/// The exponents of length, mass and time in an angular velocity.
const FREQUENCY: [i32; 3] = [0, 0, -1];

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "rotating_frame",
    class_name: "RotatingFrame",
    summary: "Positions and velocities are told in a frame that turns uniformly about an axis",
    formula: "a = −2 ω × v − ω × (ω × (r − center)),   V = −½ Σ mᵢ |ω × (rᵢ − center)|²",
    notes: "Energy is Jacobi's integral: the kinetic energy in the frame, the centrifugal potential and what the other \
            forces have. Those are as they are in this frame: a field at rest in it turns with it.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 4.10",
    example: ">>> star = vv.Scene(vv.Particles([0.0], [[1.0, 0.0, 0.0]], [[0.0, -2.0, 0.0]]), \
              vv.RotatingFrame([0.0, 0.0, 2.0]))\n\
              >>> star.run(t=np.pi / 4).position[-1, 0].round(12).tolist()  # at rest, seen from the frame\n\
              [0.0, -1.0, 0.0]",
    at_rest: "axis",
    one_way: "",
    parameters: &[
        Parameter::new("omega", Kind::AxialVector, "The angular velocity of the frame").of(FREQUENCY),
        Parameter::new("center", Kind::Point, "A point of the axis").of([1, 0, 0]).or(0.0),
    ],
    make: |values| match values {
        [omega, center] => Ok(Arc::new(RotatingFrame { omega: omega.vector(), center: center.vector() })),
        _ => Err(crate::Error::Internal("RotatingFrame takes two parameters".to_owned())),
    },
};

/// An angular velocity about an axis through a point.
#[derive(Debug)]
struct RotatingFrame {
    omega: [f64; 3],
    center: [f64; 3],
}

impl RotatingFrame {
    fn turning(&self, context: &Context<'_>) -> Kernel {
        let omega =
            |system: &System<'_>, c: usize| context.units.take(context.own(self, system).omega[c], FREQUENCY);
        let center = |system: &System<'_>, c: usize| {
            context.units.take(context.own(self, system).center[c], [1, 0, 0])
        };
        let omega = [0, 1, 2].map(|c| context.per_system(|system| omega(system, c)));
        let squared = |((&x, &y), &z): ((&Lanes, &Lanes), &Lanes)| x * x + y * y + z * z;
        Kernel {
            shape: context.shape,
            twice: [0, 1, 2].map(|c| omega[c].iter().map(|&x| x + x).collect()),
            square: omega[0].iter().zip(&omega[1]).zip(&omega[2]).map(squared).collect(),
            omega,
            center: [0, 1, 2].map(|c| context.per_system(|system| center(system, c))),
            there: context.per_body(|_, _| 1.0),
        }
    }
}

impl ForceTerm for RotatingFrame {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        Box::new(self.turning(context))
    }
    fn kernel_after(&self, other: &dyn ForceTerm, context: &Context<'_>) -> Option<Box<dyn Force<Lanes>>> {
        beside(other, None, context, || OneRow::new(self.turning(context)))
    }
    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        let turning = self.turning(context);
        let center = turning.center.map(|lanes| vec![Lanes::zero(); lanes.len()]);
        OfLinear::boxed(Some(Box::new(Kernel { center, ..turning })))
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
        let unit = bodies.units.length;
        let spin = exponent(self.omega.into_iter().fold(0.0, |most: f64, x| most.max(x.abs())));
        let omega = self.omega.map(|x| DoubleDouble::from(scale(x, -spin)));
        let mut energy = Scaled::ZERO;
        for body in 0..bodies.massive() {
            let place = bodies.vector(Of::Position, body);
            let d: Vector =
                core::array::from_fn(|c| place[c] - DoubleDouble::from(scale(self.center[c], -unit)));
            let speed: Vector = core::array::from_fn(|c| {
                let (e, f) = ((c + 1) % 3, (c + 2) % 3);
                omega[e] * d[f] - omega[f] * d[e]
            });
            let square = speed[0] * speed[0] + speed[1] * speed[1] + speed[2] * speed[2];
            let mass = Scaled::new(DoubleDouble::from(-0.5 * bodies.mass()[body]), bodies.units.mass);
            energy = energy.plus(Scaled::new(square, 2 * (unit + spin)).by(mass));
            ticker.tick()?;
        }
        Ok((energy, Scaled::from(f64::NAN)))
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.omega.iter().any(|&x| x != 0.0)
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, ..Needs::default() }
    }
    fn conserves(&self) -> Conserves {
        Conserves { energy: true, ..Conserves::NOTHING }
    }
    fn keeps_plane(&self) -> bool {
        self.omega[0] == 0.0 && self.omega[1] == 0.0
    }
    fn strongest(
        &self,
        bodies: &[(usize, f64, [f64; 3])],
        units: Units,
        _: [f64; 3],
        _: &mut Ticker<'_>,
    ) -> Result<f64> {
        let omega = distance(units.take_vector(self.omega, FREQUENCY), [0.0; 3]);
        let center = units.take_vector(self.center, [1, 0, 0]);
        Ok(bodies.iter().map(|&(_, _, place)| omega * omega * distance(place, center)).fold(0.0, f64::max))
    }
    fn rate(&self, _: &[(usize, f64, [f64; 3])], units: Units) -> f64 {
        2.0 * distance(units.take_vector(self.omega, FREQUENCY), [0.0; 3])
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }
    fn fixed_point(&self) -> Option<[f64; 3]> {
        Some(self.center)
    }
    fn as_rotating(&self) -> Option<([f64; 3], [f64; 3])> {
        Some((self.omega, self.center))
    }
}

impl Linear for RotatingFrame {
    fn add_to(&self, acceleration: &mut LinearAcceleration, _: usize, _: Scaled) {
        let omega = self.omega.map(Scaled::from);
        let square = omega.iter().fold(Scaled::ZERO, |sum, part| sum.plus(part.by(*part)));
        for c in 0..3 {
            let (next, last) = ((c + 1) % 3, (c + 2) % 3);
            // −2 ω × v and ω² d − (ω·d) ω, with d from the axis.
            acceleration.add_by_velocity(c, next, omega[last].times(2.0));
            acceleration.add_by_velocity(c, last, omega[next].times(-2.0));
            for of in 0..3 {
                let outward = if of == c { square } else { Scaled::ZERO };
                let rate = outward.minus(omega[c].by(omega[of]));
                acceleration.add_by_distance(c, (of, self.center[of]), rate);
            }
        }
    }
}

#[derive(Debug)]
struct Kernel {
    shape: Shape,
    /// Of each block ω, twice that, and its square.
    omega: [Vec<Lanes>; 3],
    twice: [Vec<Lanes>; 3],
    square: Vec<Lanes>,
    center: [Vec<Lanes>; 3],
    /// One in the lanes of bodies, zero in the others, which stay at rest: the error of a step is measured over all.
    there: Vec<Lanes>,
}

#[inline(always)]
fn kernel<V: Vector8>(force: &Kernel, q: &[Lanes], v: &[Lanes], a: &mut [Lanes], first: bool) {
    if force.shape.components == 2 {
        rotate::<V, 2>(force, q, v, a, first);
    } else {
        rotate::<V, 3>(force, q, v, a, first);
    }
}

#[inline(always)]
fn rotate<V: Vector8, const COMPONENTS: usize>(
    force: &Kernel,
    q: &[Lanes],
    v: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    let rows = force.shape.rows;
    let (q, v, a) = (V::view(q), V::view(v), V::view_mut(a));
    let blocks = force.center[0].len();
    let bodies = rows / blocks;
    for block in 0..blocks {
        for row in block * bodies..(block + 1) * bodies {
            let (mut place, mut velocity) = ([V::zero(); 3], [V::zero(); 3]);
            for c in 0..COMPONENTS {
                place[c] = q[c * rows + row];
                velocity[c] = v[c * rows + row];
            }
            let term = turned::<V, COMPONENTS>(force, block, place, velocity);
            let there = V::load(force.there[row]);
            for c in 0..COMPONENTS {
                let (a, term) = (&mut a[c * rows + row], there * term[c]);
                *a = if first { term } else { *a + term };
            }
        }
    }
}

/// 2 v × ω + (ω² d − (ω·d) ω) of a row, d from the center. In the plane z = 0 the axis is across it, and d_z is not seen.
#[inline(always)]
fn turned<V: Vector8, const COMPONENTS: usize>(
    force: &Kernel,
    block: usize,
    place: [V; 3],
    velocity: [V; 3],
) -> [V; 3] {
    let (mut omega, mut twice, mut d) = ([V::zero(); 3], [V::zero(); 3], [V::zero(); 3]);
    for c in 0..3 {
        (omega[c], twice[c]) = (V::load(force.omega[c][block]), V::load(force.twice[c][block]));
    }
    for c in 0..COMPONENTS {
        d[c] = place[c] - V::load(force.center[c][block]);
    }
    let square = V::load(force.square[block]);
    let along = omega[2].multiply_add(d[2], omega[1].multiply_add(d[1], omega[0] * d[0]));
    let mut term = [V::zero(); 3];
    for c in 0..COMPONENTS {
        let (e, f) = ((c + 1) % 3, (c + 2) % 3);
        let turning = velocity[f].multiply_subtract_from(twice[e], velocity[e] * twice[f]);
        term[c] = along.multiply_subtract_from(omega[c], square.multiply_add(d[c], turning));
    }
    term
}

/// Of one row: nothing turns in the lanes without a body, so that nothing is left to take out there.
struct OneRow(Kernel);

impl OneRow {
    fn new(mut kernel: Kernel) -> Self {
        for numbers in kernel.omega.iter_mut().chain(&mut kernel.twice).chain([&mut kernel.square]) {
            for (number, there) in numbers.iter_mut().zip(&kernel.there) {
                *number = *number * *there;
            }
        }
        Self(kernel)
    }
}

impl Beside for OneRow {
    const VELOCITY: bool = true;

    #[inline(always)]
    fn term<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
        &self,
        seen: &Seen<'_, V>,
        _: &Turns<V, TURNS>,
    ) -> [V; 3] {
        if PLANAR {
            turned::<V, 2>(&self.0, 0, seen.place, seen.velocity)
        } else {
            turned::<V, 3>(&self.0, 0, seen.place, seen.velocity)
        }
    }
}

tiered! {
    fn kernel_tier[][](force: &Kernel, q: &[Lanes], v: &[Lanes], a: &mut [Lanes], first: bool) = kernel;
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        kernel_tier(self, phase.q, phase.v, a, first);
        Ok(())
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, ..Needs::default() }
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}
