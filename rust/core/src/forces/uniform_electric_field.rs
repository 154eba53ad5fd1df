//! A uniform electric field: the force charge E on every charge.

use super::bodies::{Of, PreciseBodies, Vector};
use super::context::{Context, System, of_body};
use super::derivative::{Derivative, OfLinear};
use super::gravity::beside::{Beside, Seen, beside};
use super::gravity::ring::Turns;
use super::linear::{Linear, LinearAcceleration};
use super::remaining::{OfRemaining, Remaining};
use super::series::{LinearSeries, Series};
use super::term::{Bodies, Conserves, ForceDeclaration, ForceTerm};
use super::{Adds, Force, Phase};
use crate::error::Result;
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::points::distance;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign, Value};
use crate::tiered;
use crate::units::Units;
use std::sync::Arc;

/// The exponents of length, mass and time in charge times field.
const FORCE: [i32; 3] = [1, 1, -2];

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "uniform_electric_field",
    class_name: "UniformElectricField",
    summary: "The force of an electric field that is the same everywhere",
    formula: "V = −Σ chargeᵢ E·rᵢ",
    notes: "The unit of charge is that in which charge times E is a force. A charged body must have mass. Beside \
            UniformMagneticField it is the Lorentz force of crossed fields.",
    source: "Jackson, Classical Electrodynamics, 3rd ed., section 12.3",
    example: ">>> ion = vv.Scene(vv.Particles([2.0], [[0.0, 0.0, 0.0]]), \
              vv.UniformElectricField([3.0, 0.0, 0.0], charge=4.0))\n\
              >>> ion.run(t=0.5).velocity[-1, 0].tolist()\n[3.0, 0.0, 0.0]",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::new("E", Kind::Vector, "The field").of(FORCE),
        Parameter::new(
            "charge",
            Kind::Numbers(Sign::Any),
            "The charge of every body, or shape (N,): of each",
        )
        .or(1.0),
    ],
    make: |values| match values {
        [field, charge] => {
            Ok(Arc::new(UniformElectricField { field: field.vector(), charge: charge.numbers() }))
        }
        _ => Err(crate::Error::Internal("UniformElectricField takes two parameters".to_owned())),
    },
};

/// A field and the charges that feel it.
#[derive(Debug)]
struct UniformElectricField {
    field: [f64; 3],
    charge: Vec<f64>,
}

impl UniformElectricField {
    fn pushes(&self, context: &Context<'_>) -> Kernel {
        let ratio = context.per_body(|system, slot| {
            let charge = of_body(&context.own(self, system).charge, system.bodies[slot]);
            if charge == 0.0 { 0.0 } else { charge / system.mass[slot] }
        });
        let field =
            |system: &System<'_>, c: usize| context.units.take(context.own(self, system).field[c], FORCE);
        let field = [0, 1, 2].map(|c| context.per_system(|system| field(system, c)));
        Kernel { shape: context.shape, field, ratio }
    }
}

impl ForceTerm for UniformElectricField {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        Box::new(self.pushes(context))
    }
    fn kernel_after(&self, other: &dyn ForceTerm, context: &Context<'_>) -> Option<Box<dyn Force<Lanes>>> {
        beside(other, None, context, || self.pushes(context))
    }
    fn derivative(&self, _: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        OfLinear::boxed(None)
    }
    fn series(&self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        LinearSeries::boxed(self.kernel(context), None)
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
        bodies: &PreciseBodies,
        _: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        let mut work = Scaled::ZERO;
        for body in 0..bodies.len() {
            let charge = of_body(&self.charge, body);
            let place: Vector = bodies.vector(Of::Position, body);
            for c in 0..3 {
                let part = Scaled::new(place[c], bodies.units.length).times(self.field[c]);
                work = work.plus(part.times(charge));
            }
            ticker.tick()?;
        }
        Ok((work.negative(), work))
    }
    fn validate(&self, view: &Bodies<'_>) -> Result<()> {
        view.check_count("charge", self.charge.len())
    }
    fn needs_mass(&self, particle: usize) -> bool {
        of_body(&self.charge, particle) != 0.0
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.field.iter().any(|&e| e != 0.0) && self.charge.iter().any(|&q| q != 0.0)
    }
    fn names_bodies(&self) -> bool {
        self.charge.len() > 1
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
        self.field[2] == 0.0
    }
    fn strongest(
        &self,
        bodies: &[(usize, f64, [f64; 3])],
        units: Units,
        _: [f64; 3],
        _: &mut Ticker<'_>,
    ) -> Result<f64> {
        let field = distance(units.take_vector(self.field, FORCE), [0.0; 3]);
        let of = |&(body, mass, _): &(usize, f64, [f64; 3])| match of_body(&self.charge, body) {
            0.0 => 0.0,
            charge => charge.abs() / mass * field,
        };
        Ok(bodies.iter().map(of).fold(0.0, f64::max))
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }
    fn as_electric(&self, particle: usize) -> Option<([f64; 3], f64)> {
        Some((self.field, of_body(&self.charge, particle)))
    }
}

impl Linear for UniformElectricField {
    fn add_to(&self, acceleration: &mut LinearAcceleration, particle: usize, mass: Scaled) {
        let charge = of_body(&self.charge, particle);
        if charge != 0.0 {
            let of = |c: usize| Scaled::from(charge).times(self.field[c]).over(mass);
            (0..3).for_each(|c| acceleration.add_constant(c, of(c)));
        }
    }
}

#[derive(Debug)]
struct Kernel {
    shape: Shape,
    /// Of each block.
    field: [Vec<Lanes>; 3],
    /// Charge over mass.
    ratio: Vec<Lanes>,
}

#[inline(always)]
fn kernel<V: Vector8>(force: &Kernel, a: &mut [Lanes], first: bool) {
    let Shape { rows, components } = force.shape;
    let (a, ratio) = (V::view_mut(a), V::view(&force.ratio));
    for c in 0..components {
        let fields = V::view(&force.field[c]);
        let bodies = rows / fields.len();
        for (block, &field) in fields.iter().enumerate() {
            for row in block * bodies..(block + 1) * bodies {
                let term = ratio[row] * field;
                let a = &mut a[c * rows + row];
                *a = if first { term } else { *a + term };
            }
        }
    }
}

impl Beside for Kernel {
    const VELOCITY: bool = false;

    #[inline(always)]
    fn term<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
        &self,
        _: &Seen<'_, V>,
        _: &Turns<V, TURNS>,
    ) -> [V; 3] {
        let ratio = V::load(self.ratio[0]);
        let [x, y, z] = &self.field;
        [ratio * V::load(x[0]), ratio * V::load(y[0]), ratio * V::load(z[0])]
    }
}

tiered! {
    fn kernel_tier[][](force: &Kernel, a: &mut [Lanes], first: bool) = kernel;
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        _: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        kernel_tier(self, a, first);
        Ok(())
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}
