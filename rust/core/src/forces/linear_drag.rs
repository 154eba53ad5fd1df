//! Linear drag: every velocity decays, in the medium that is at rest.

use super::bodies::PreciseBodies;
use super::context::{Context, System};
use super::derivative::{Derivative, OfLinear};
use super::gravity::beside::{Beside, Seen, beside};
use super::gravity::ring::Turns;
use super::linear::{Linear, LinearAcceleration};
use super::series::{LinearSeries, Series};
use super::term::{ForceDeclaration, ForceTerm};
use super::{Adds, Force, Phase};
use crate::error::Result;
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::scaled::Scaled;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Parameter};
use crate::tiered;
use crate::units::Units;
use std::sync::Arc;

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "linear_drag",
    class_name: "LinearDrag",
    summary: "Drag in proportion to the velocity, in a medium at rest",
    formula: "a = −v / tau",
    notes: "It has no potential energy and conserves nothing.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 1.5",
    example: ">>> vv.LinearDrag(tau=2.0)\nLinearDrag(tau=2.0)",
    at_rest: "medium",
    one_way: "drag slows bodies down, run backward it would speed them up",
    parameters: &[Parameter::positive("tau", [0, 0, 1], "The time in which a velocity falls by a factor e")],
    make: |values| Ok(Arc::new(LinearDrag { tau: values[0].number() })),
};

/// Drag with the time of its decay.
#[derive(Debug)]
struct LinearDrag {
    tau: f64,
}

impl LinearDrag {
    fn slowing(&self, context: &Context<'_>) -> Kernel {
        let rate = |system: &System<'_>| -1.0 / context.units.take(context.own(self, system).tau, [0, 0, 1]);
        Kernel { shape: context.shape, rate: context.per_system(rate) }
    }
}

impl ForceTerm for LinearDrag {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        Box::new(self.slowing(context))
    }
    fn kernel_after(&self, other: &dyn ForceTerm, context: &Context<'_>) -> Option<Box<dyn Force<Lanes>>> {
        beside(other, None, context, || self.slowing(context))
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
    fn rate(&self, _: &[(usize, f64, [f64; 3])], units: Units) -> f64 {
        1.0 / units.take(self.tau, [0, 0, 1])
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }
    fn as_linear_drag(&self) -> Option<f64> {
        Some(self.tau)
    }
}

impl Linear for LinearDrag {
    fn add_to(&self, acceleration: &mut LinearAcceleration, _: usize, _: Scaled) {
        let rate = Scaled::from(-1.0).over(Scaled::from(self.tau));
        (0..3).for_each(|c| acceleration.add_by_velocity(c, c, rate));
    }
}

#[derive(Debug)]
struct Kernel {
    shape: Shape,
    /// Of each block.
    rate: Vec<Lanes>,
}

#[inline(always)]
fn kernel<V: Vector8>(force: &Kernel, v: &[Lanes], a: &mut [Lanes], first: bool) {
    let Shape { rows, components } = force.shape;
    let (v, a, rates) = (V::view(v), V::view_mut(a), V::view(&force.rate));
    let bodies = rows / rates.len();
    for (block, &rate) in rates.iter().enumerate() {
        for c in 0..components {
            let start = c * rows + block * bodies;
            for (v, a) in v[start..start + bodies].iter().zip(&mut a[start..start + bodies]) {
                let term = rate * *v;
                *a = if first { term } else { *a + term };
            }
        }
    }
}

impl Beside for Kernel {
    const VELOCITY: bool = true;

    #[inline(always)]
    fn term<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
        &self,
        seen: &Seen<'_, V>,
        _: &Turns<V, TURNS>,
    ) -> [V; 3] {
        let (rate, velocity) = (V::load(self.rate[0]), seen.velocity);
        [rate * velocity[0], rate * velocity[1], rate * velocity[2]]
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
        Needs { velocity: true, ..Needs::default() }
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}
