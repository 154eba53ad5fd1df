//! A uniform magnetic field: the Lorentz force on charges.

use super::bodies::PreciseBodies;
use super::context::Context;
use super::term::{Bodies, Conserves, ForceDeclaration, ForceTerm, MagneticField};
use super::{Force, Phase};
use crate::error::Result;
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::scaled::Scaled;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign};
use crate::tiered;
use std::sync::Arc;

/// The exponents of length, mass and time in charge times field.
const FIELD: [i32; 3] = [0, 1, -1];

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
            let charge = self.charge(system.bodies[slot]);
            if charge == 0.0 { 0.0 } else { charge / system.mass[slot] }
        });
        Box::new(Kernel { shape: context.shape, field: context.units.take_vector(self.field, FIELD), ratio })
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
        Needs { velocity: true, time: false }
    }
    fn conserves(&self) -> Conserves {
        Conserves { energy: true, ..Conserves::NOTHING }
    }
    fn keeps_plane(&self) -> bool {
        self.field[0] == 0.0 && self.field[1] == 0.0
    }
    fn as_magnetic(&self) -> Option<MagneticField<'_>> {
        Some(MagneticField { field: self.field, charge: &self.charge })
    }
}

#[derive(Debug)]
struct Kernel {
    shape: Shape,
    field: [f64; 3],
    /// Charge over mass.
    ratio: Vec<Lanes>,
}

#[inline(always)]
fn kernel<V: Vector8>(force: &Kernel, v: &[Lanes], a: &mut [Lanes], first: bool) {
    let Shape { rows, components } = force.shape;
    let (v, a, ratio) = (V::view(v), V::view_mut(a), V::view(&force.ratio));
    let mut field = [V::zero(); 3];
    for c in 0..3 {
        field[c] = V::splat(force.field[c]);
    }
    for row in 0..rows {
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
    fn needs(&self) -> Needs {
        Needs { velocity: true, time: false }
    }
}
