//! A uniform magnetic field: the Lorentz force on charges.

use super::bodies::PreciseBodies;
use super::context::{Context, System, of_body};
use super::derivative::{Derivative, OfLinear};
use super::linear::{Linear, LinearAcceleration};
use super::remaining::{OfRemaining, Remaining};
use super::series::{LinearSeries, Series};
use super::term::{Bodies, Conserves, ForceDeclaration, ForceTerm};
use super::{Force, Phase};
use crate::error::Result;
use crate::numerics::angles::sin_cos;
use crate::numerics::element::{Element, PairMut, Pass, Shape, View};
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::points::distance;
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::ode::passes::updates::add_compensated;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign, Value};
use crate::tiered;
use crate::units::Units;
use core::iter;
use std::sync::Arc;

/// The exponents of length, mass and time in charge times field.
const FIELD: [i32; 3] = [0, 1, -1];

/// A uniform magnetic field, which acts by the force charge v × field.
#[derive(Clone, Copy, Debug)]
pub struct MagneticField<'a> {
    /// The field.
    pub field: [f64; 3],
    /// One charge for all bodies, or one for each.
    pub charge: &'a [f64],
}

impl MagneticField<'_> {
    /// The charge of a body.
    pub fn charge_of(&self, particle: usize) -> f64 {
        if let [all] = self.charge { *all } else { self.charge.get(particle).copied().unwrap_or(0.0) }
    }
}

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "uniform_magnetic_field",
    class_name: "UniformMagneticField",
    summary: "The Lorentz force of a magnetic field that is the same everywhere",
    formula: "F = charge v × B",
    notes: "It does no work: the kinetic energy is conserved, momentum and angular momentum are not. \
            The unit of charge is that in which charge times velocity times B is a force.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 1.5",
    example: ">>> vv.UniformMagneticField([0.0, 0.0, 2.0])\n\
              UniformMagneticField(B=(0.0, 0.0, 2.0), charge=1.0)",
    at_rest: "magnetic field without an electric one",
    one_way: "",
    parameters: &[
        Parameter::new("B", Kind::AxialVector, "The field").of(FIELD),
        Parameter::new(
            "charge",
            Kind::Numbers(Sign::Any),
            "The charge of every body, or shape (N,): of each",
        )
        .or(1.0),
    ],
    make: |values| {
        Ok(Arc::new(UniformMagneticField { field: values[0].vector(), charge: values[1].numbers() }))
    },
};

/// A field and the charges that feel it.
#[derive(Debug)]
struct UniformMagneticField {
    field: [f64; 3],
    charge: Vec<f64>,
}

impl UniformMagneticField {
    fn charge(&self, particle: usize) -> f64 {
        MagneticField { field: self.field, charge: &self.charge }.charge_of(particle)
    }
}

impl ForceTerm for UniformMagneticField {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        let ratio = context.per_body(|system, slot| {
            let charge = context.own(self, system).charge(system.bodies[slot]);
            if charge == 0.0 { 0.0 } else { charge / system.mass[slot] }
        });
        let field = |system: &System<'_>| context.units.take_vector(context.own(self, system).field, FIELD);
        // The strength of the field, and its direction.
        let size = |system: &System<'_>| distance(field(system), [0.0; 3]);
        let axis = [0, 1, 2].map(|c| context.per_system(|system| field(system)[c] / size(system)));
        let size = context.per_system(size);
        let field = [0, 1, 2].map(|c| context.per_system(|system| field(system)[c]));
        Box::new(Kernel { shape: context.shape, field, size, axis, ratio, turns: Vec::new() })
    }
    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        OfLinear::boxed(Some(self.kernel(context)))
    }
    fn series(&self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        LinearSeries::boxed(self.kernel(context), Some(self.kernel(context)))
    }
    fn series_in_every_lane(&self) -> bool {
        true
    }
    fn has_series(&self) -> bool {
        true
    }
    fn as_linear(&self) -> Option<&dyn Linear> {
        Some(self)
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
        view.check_count("charge", self.charge.len())
    }
    fn needs_mass(&self, particle: usize) -> bool {
        self.charge(particle) != 0.0
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.field.iter().any(|&b| b != 0.0) && self.charge.iter().any(|&q| q != 0.0)
    }
    fn needs(&self) -> Needs {
        Needs { rotation: true, ..Needs::default() }
    }
    fn of_remaining(&self, remaining: &Remaining) -> OfRemaining {
        let values = |charges| vec![Value::Vector(self.field), Value::Numbers(charges)];
        OfRemaining::values(remaining.sums(&self.charge).map(values))
    }
    fn conserves(&self) -> Conserves {
        Conserves { energy: true, ..Conserves::NOTHING }
    }
    fn translation_invariant(&self) -> bool {
        true
    }
    fn keeps_plane(&self) -> bool {
        self.field[0] == 0.0 && self.field[1] == 0.0
    }
    /// The cyclotron frequency.
    fn rate(&self, bodies: &[(usize, f64, [f64; 3])], units: Units) -> f64 {
        let field = distance(units.take_vector(self.field, FIELD), [0.0; 3]);
        let of = |&(body, mass, _): &(usize, f64, [f64; 3])| match self.charge(body) {
            0.0 => 0.0,
            charge => charge.abs() / mass * field,
        };
        bodies.iter().map(of).fold(0.0, f64::max)
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }
    fn as_magnetic(&self) -> Option<MagneticField<'_>> {
        Some(MagneticField { field: self.field, charge: &self.charge })
    }
}

impl Linear for UniformMagneticField {
    fn add_to(&self, acceleration: &mut LinearAcceleration, particle: usize, mass: Scaled) {
        let charge = of_body(&self.charge, particle);
        if charge != 0.0 {
            let field = self.field.map(|b| Scaled::from(charge).times(b).over(mass));
            for c in 0..3 {
                let (next, last) = ((c + 1) % 3, (c + 2) % 3);
                acceleration.add_by_velocity(c, next, field[last]);
                acceleration.add_by_velocity(c, last, field[next].negative());
            }
        }
    }
}

#[derive(Debug)]
struct Kernel {
    shape: Shape,
    /// Of each block, with its strength and its direction.
    field: [Vec<Lanes>; 3],
    size: Vec<Lanes>,
    axis: [Vec<Lanes>; 3],
    /// Charge over mass.
    ratio: Vec<Lanes>,
    /// By what velocities turn, for the times asked for so far.
    turns: Vec<Turns>,
}

/// Rotations about the field, a body to a row and lane.
#[derive(Debug)]
struct Turns {
    h: f64,
    /// Sines of the angles.
    sine: Vec<Lanes>,
    /// One minus their cosines.
    versine: Vec<Lanes>,
}

impl Kernel {
    fn turns(&mut self, h: f64) -> usize {
        let known = self.turns.iter().position(|turns| turns.h == h);
        known.unwrap_or_else(|| {
            let bodies = self.ratio.len() / self.size.len();
            let rows = self.ratio.iter().zip(self.size.iter().flat_map(|size| iter::repeat_n(size, bodies)));
            let angles: Vec<Lanes> = rows.map(|(&ratio, &size)| ratio * size * Lanes::splat(h)).collect();
            let sine = angles.iter().map(|angle| angle.map(|angle| sin_cos(angle).0)).collect();
            // 1 - cos x = 2 sin²(x/2), without the cancellation.
            let versine = |angle: f64| {
                let half = sin_cos(0.5 * angle).0;
                2.0 * half * half
            };
            let versine = angles.iter().map(|angle| angle.map(versine)).collect();
            // Steps to times between nodes are all of different lengths.
            if self.turns.len() == MOST_TURNS {
                let _: Turns = self.turns.remove(MOST_TURNS - 1);
            }
            self.turns.push(Turns { h, sine, versine });
            self.turns.len() - 1
        })
    }
}

/// Rotations that are kept: as many as a step has, and one for a step to a time between nodes.
const MOST_TURNS: usize = 64;

/// `v += sin φ (v × b) + (1 - cos φ) ((v × b) × b)`, compensated.
struct Rotate<'a> {
    shape: Shape,
    axis: &'a [Vec<Lanes>; 3],
    turns: &'a Turns,
    v: PairMut<'a, Lanes>,
}

impl Pass<Lanes> for Rotate<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let Shape { rows, components } = self.shape;
        let (v, rest) = V::pair_mut(self.v);
        let (sine, versine) = (V::view(&self.turns.sine), V::view(&self.turns.versine));
        let bodies = rows / self.axis[0].len();
        for block in 0..self.axis[0].len() {
            let mut axis = [V::zero(); 3];
            for c in 0..3 {
                axis[c] = V::load(self.axis[c][block]);
            }
            for row in block * bodies..(block + 1) * bodies {
                let mut speed = [V::zero(); 3];
                for c in 0..components {
                    speed[c] = v[c * rows + row];
                }
                let across = cross(speed, axis);
                let back = cross(across, axis);
                for c in 0..components {
                    let change = sine[row].multiply_add(across[c], versine[row] * back[c]);
                    let at = c * rows + row;
                    (v[at], rest[at]) = add_compensated(v[at], rest[at], change);
                }
            }
        }
    }
}

#[inline(always)]
fn cross<S: Real>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn kernel<V: Vector8>(force: &Kernel, v: &[Lanes], a: &mut [Lanes], first: bool) {
    let Shape { rows, components } = force.shape;
    let (v, a, ratio) = (V::view(v), V::view_mut(a), V::view(&force.ratio));
    let bodies = rows / force.size.len();
    for block in 0..force.size.len() {
        let mut field = [V::zero(); 3];
        for c in 0..3 {
            field[c] = V::load(force.field[c][block]);
        }
        for row in block * bodies..(block + 1) * bodies {
            let mut speed = [V::zero(); 3];
            for c in 0..components {
                speed[c] = v[c * rows + row];
            }
            for c in 0..components {
                let (d, e) = ((c + 1) % 3, (c + 2) % 3);
                let term = ratio[row] * (speed[d] * field[e] - speed[e] * field[d]);
                let a = &mut a[c * rows + row];
                *a = if first { term } else { *a + term };
            }
        }
    }
}

tiered! {
    fn kernel_tier[][](force: &Kernel, v: &[Lanes], a: &mut [Lanes], first: bool) = kernel;
}

impl Force<Lanes> for Kernel {
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
    fn rotate(&mut self, h: f64, v: PairMut<'_, Lanes>) {
        let index = self.turns(h);
        Lanes::pass(Rotate { shape: self.shape, axis: &self.axis, turns: &self.turns[index], v });
    }
    fn needs(&self) -> Needs {
        Needs { rotation: true, ..Needs::default() }
    }
}
