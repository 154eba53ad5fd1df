//! A fixed center: the force −dV/dr along the line to it, on every particle.

use super::approach::{self, Moving};
use super::bodies::{Of, PreciseBodies, Vector};
use super::context::{Arrangement, Context, System};
use super::derivative::Derivative;
use super::limits::{check_force, outside};
use super::lines::AroundPoint;
use super::term::{About, Bodies, Conserves, ForceDeclaration, ForceTerm};
use super::{Adds, Force, Phase};
use crate::error::{Error, Result};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::Lanes;
use crate::numerics::points::distance;
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::potentials::kernels::Around;
use crate::potentials::parameters::{Declaration, Kind, Parameter};
use crate::potentials::{Potential, near_one};
use crate::units::Units;
use crate::words::{number, numbers};
use std::sync::Arc;

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "central_field",
    class_name: "CentralField",
    summary: "A potential V(r) around a fixed point, felt by every body",
    formula: "F = −dV/dr r̂",
    notes: "It acts by its force, so every mass must be positive.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 3.1",
    example: ">>> vv.CentralField(vv.potentials.Coulomb(k=-1.0))\n\
              CentralField(potential=Coulomb(k=-1.0), center=(0.0, 0.0, 0.0))",
    at_rest: "center",
    one_way: "",
    parameters: &[
        Parameter::new("potential", Kind::Potential, "The potential energy of one body at the distance r"),
        Parameter::new("center", Kind::Point, "The fixed point").of([1, 0, 0]).or(0.0),
    ],
    make: |values| {
        Ok(Arc::new(CentralField { potential: values[0].potential()?, center: values[1].vector() }))
    },
};

/// A fixed center with a potential energy `V(r)`.
#[derive(Debug)]
pub struct CentralField {
    potential: Arc<dyn Potential>,
    center: [f64; 3],
}

impl CentralField {
    /// What acts on the bodies of a context, in its units.
    fn field(&self, context: &Context<'_>) -> (Arc<dyn Potential>, Around) {
        let potential = self.potential.scaled(context.units);
        let center = |system: &System<'_>, c: usize| {
            context.units.take(context.own(self, system).center[c], [1, 0, 0])
        };
        let centers = [0, 1, 2].map(|c| context.per_system(|system| center(system, c)));
        let field = Around {
            shape: context.shape,
            center: (0..centers[0].len()).map(|block| [0, 1, 2].map(|c| centers[c][block])).collect(),
            numbers: context.potentials(&*potential, |system| &context.own(self, system).potential),
            inverse_mass: context.per_body(|system, slot| 1.0 / system.mass[slot]),
        };
        (potential, field)
    }
}

impl ForceTerm for CentralField {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        let (potential, field) = self.field(context);
        let length2 = approach::lengths2(context, |system| &context.own(self, system).potential);
        let together = context.arrangement == Arrangement::Packed;
        Box::new(Kernel { potential, field, length2, together })
    }
    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        let (potential, field) = self.field(context);
        Some(AroundPoint::boxed(potential, field))
    }
    fn potential_and_virial(
        &self,
        bodies: &PreciseBodies,
        _: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        let (mut energy, mut work) = (Scaled::ZERO, Scaled::ZERO);
        let units = bodies.units;
        let (potential, unit) = near_one(&self.potential, units.length);
        for body in 0..bodies.len() {
            let place = bodies.vector(Of::Position, body);
            let d: Vector =
                core::array::from_fn(|c| place[c] - DoubleDouble::from(scale(self.center[c], -units.length)));
            let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            let (value, force) = potential.precise(r);
            energy = energy.plus(Scaled::new(value, unit));
            // At the center of what is not singular there is no pull.
            if r.to_f64() != 0.0 {
                // The pull along d, and what of it the place sees.
                let along = d[0] * place[0] + d[1] * place[1] + d[2] * place[2];
                let pull = Scaled::new(force, unit);
                work = work.plus(pull.by(Scaled::new(along, 0).over(Scaled::new(r, 0))));
            }
            ticker.tick()?;
        }
        Ok((energy, work))
    }

    fn validate(&self, bodies: &Bodies<'_>) -> Result<()> {
        check_force("CentralField", &*self.potential)?;
        if let Some(domain) = self.domain() {
            let from = |position: [f64; 3]| distance(position, self.center);
            let beyond = |position: &[f64; 3]| !(domain.0..=domain.1).contains(&from(*position));
            if let Some(index) = bodies.position.iter().position(beyond) {
                let apart = number(from(bodies.position[index]));
                let body = format!("{} is {apart} from the center", bodies.name("position", index));
                return Err(outside("CentralField", &*self.potential, domain, &body));
            }
        }
        if !self.potential.singular() {
            return Ok(());
        }
        match bodies.position.iter().position(|&position| position == self.center) {
            None => Ok(()),
            Some(index) => Err(Error::invalid(
                "position",
                format!(
                    "{} = {} is the singular center of CentralField; move one of the two",
                    bodies.name("position", index),
                    numbers(&self.center)
                ),
            )),
        }
    }
    fn needs_mass(&self, _: usize) -> bool {
        true
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.potential.inverse_distance_strength() != Some(0.0)
    }
    fn conserves(&self) -> Conserves {
        Conserves { momentum: false, angular_momentum: About::Point(self.center), spin: false, energy: true }
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        self.potential.in_every_lane()
    }
    fn keeps_plane(&self) -> bool {
        self.center[2] == 0.0
    }
    fn domain(&self) -> Option<(f64, f64)> {
        self.potential.domain()
    }
    fn center(&self) -> Option<[f64; 3]> {
        Some(self.center)
    }
    fn softening(&self) -> f64 {
        if self.potential.singular() { 0.0 } else { self.potential.own_length().unwrap_or(0.0) }
    }
    fn strongest(
        &self,
        bodies: &[(usize, f64, [f64; 3])],
        units: Units,
        _: [f64; 3],
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let (potential, center) = (self.potential.scaled(units), units.take_vector(self.center, [1, 0, 0]));
        let mut strongest = 0.0_f64;
        for &(_, mass, position) in bodies {
            let [_, force, _] = potential.evaluate(&[distance(position, center)]);
            strongest = strongest.max(force[0].abs() / mass);
            ticker.tick()?;
        }
        Ok(strongest)
    }
    fn as_inverse_distance_center(&self) -> Option<(f64, [f64; 3])> {
        self.potential.inverse_distance_strength().map(|k| (k, self.center))
    }
}

/// The force of a potential fixed at a point.
#[derive(Debug)]
struct Kernel {
    potential: Arc<dyn Potential>,
    field: Around,
    /// The squared lengths of the potentials of the systems in the lanes, if they have lengths.
    length2: Option<Lanes>,
    /// Whether the lanes are bodies of one system.
    together: bool,
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        self.potential.around(&self.field, phase.q, a, first);
        Ok(())
    }
    fn longest_step(&self, (q, v): (&[Lanes], &[Lanes]), a: &[Lanes]) -> Option<Lanes> {
        let (length2, center) = (self.length2.as_ref()?, self.field.center.first()?);
        let steps = approach::to_point(&Moving { shape: self.field.shape, q, v, a }, center, length2);
        Some(if self.together { approach::shortest(steps) } else { steps })
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}
