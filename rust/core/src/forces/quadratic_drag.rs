//! Quadratic drag: what a fast body feels in a thin medium at rest.

use super::bodies::PreciseBodies;
use super::context::{Context, of_body};
use super::derivative::{Along, Derivative};
use super::gravity::beside::{Beside, Seen, beside};
use super::gravity::ring::Turns;
use super::remaining::{OfRemaining, Remaining};
use super::term::{Bodies, ForceDeclaration, ForceTerm};
use super::{Adds, Force, Phase};
use crate::error::Result;
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::scaled::Scaled;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign};
use crate::tiered;
use std::sync::Arc;

/// The exponents of length, mass and time in a force over the square of a speed.
const COEFFICIENT: [i32; 3] = [-1, 1, 0];

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "quadratic_drag",
    class_name: "QuadraticDrag",
    summary: "Drag in proportion to the square of the speed, in a medium at rest",
    formula: "F = −coefficient |v| v",
    notes: "It has no potential energy and conserves nothing. A body that feels it must have mass. Beside LinearDrag it \
            is the mixed law.",
    source: "Landau & Lifshitz, Fluid Mechanics, 2nd ed., section 45",
    example: ">>> stone = vv.Scene(vv.Particles([2.0], [[0.0, 0.0, 0.0]], [[8.0, 0.0, 0.0]]), \
              vv.QuadraticDrag(0.5))\n>>> stone.run(t=1.5).velocity[-1, 0].tolist()\n[2.0, 0.0, 0.0]",
    at_rest: "medium",
    one_way: "drag slows bodies down, run backward it would speed them up",
    parameters: &[Parameter::new(
        "coefficient",
        Kind::Numbers(Sign::NotNegative),
        "The force at unit speed, on every body, or shape (N,): on each",
    )
    .of(COEFFICIENT)],
    make: |values| match values {
        [coefficient] => Ok(Arc::new(QuadraticDrag { coefficient: coefficient.numbers() })),
        _ => Err(crate::Error::Internal("QuadraticDrag takes one parameter".to_owned())),
    },
};

/// Drag with the coefficient of each body, or of all.
#[derive(Debug)]
struct QuadraticDrag {
    coefficient: Vec<f64>,
}

impl QuadraticDrag {
    fn coefficient(&self, particle: usize) -> f64 {
        of_body(&self.coefficient, particle)
    }
}

impl QuadraticDrag {
    fn slowing(&self, context: &Context<'_>) -> Kernel {
        let ratio = context.per_body(|system, slot| {
            let coefficient = context.own(self, system).coefficient(system.bodies[slot]);
            let coefficient = context.units.take(coefficient, COEFFICIENT);
            if coefficient == 0.0 { 0.0 } else { -coefficient / system.mass[slot] }
        });
        Kernel { shape: context.shape, ratio }
    }
}

impl ForceTerm for QuadraticDrag {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn of_remaining(&self, _: &Remaining) -> OfRemaining {
        if self.coefficient.len() > 1 { OfRemaining::Unknown } else { OfRemaining::Same }
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        Box::new(self.slowing(context))
    }
    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        Some(Box::new(self.slowing(context)))
    }
    fn kernel_after(&self, other: &dyn ForceTerm, context: &Context<'_>) -> Option<Box<dyn Force<Lanes>>> {
        beside(other, None, context, || self.slowing(context))
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
        view.check_count("coefficient", self.coefficient.len())
    }
    fn needs_mass(&self, particle: usize) -> bool {
        self.coefficient(particle) != 0.0
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.coefficient.iter().any(|&c| c != 0.0)
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
        Some(Vec::new())
    }
    fn as_quadratic_drag(&self, particle: usize) -> Option<f64> {
        Some(self.coefficient(particle))
    }
}

#[derive(Debug)]
struct Kernel {
    shape: Shape,
    /// −coefficient/mass.
    ratio: Vec<Lanes>,
}

#[inline(always)]
fn kernel<V: Vector8>(force: &Kernel, v: &[Lanes], a: &mut [Lanes], first: bool) {
    let Shape { rows, components } = force.shape;
    let (v, a, ratio) = (V::view(v), V::view_mut(a), V::view(&force.ratio));
    for row in 0..rows {
        let mut square = v[row] * v[row];
        for c in 1..components {
            square = v[c * rows + row].multiply_add(v[c * rows + row], square);
        }
        let slowing = ratio[row] * square.sqrt();
        for c in 0..components {
            let at = c * rows + row;
            let term = slowing * v[at];
            a[at] = if first { term } else { a[at] + term };
        }
    }
}

/// −(c/m) (|v| e + (v·e)/|v| v), where velocities change by `e`; at rest nothing.
#[inline(always)]
fn change<V: Vector8>(force: &Kernel, [v, along]: [&[Lanes]; 2], into: &mut [Lanes]) {
    let Shape { rows, components } = force.shape;
    let (v, along, into, ratio) = (V::view(v), V::view(along), V::view_mut(into), V::view(&force.ratio));
    for row in 0..rows {
        let (mut square, mut product) = (V::zero(), V::zero());
        for c in 0..components {
            let at = c * rows + row;
            square = v[at].multiply_add(v[at], square);
            product = v[at].multiply_add(along[at], product);
        }
        let speed = square.sqrt();
        let share = V::select(speed.less_equal(V::zero()), V::zero(), product / speed);
        for c in 0..components {
            let at = c * rows + row;
            into[at] = ratio[row] * speed.multiply_add(along[at], share * v[at]);
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
        let v = seen.velocity;
        let plane = v[1].multiply_add(v[1], v[0] * v[0]);
        let square = if PLANAR { plane } else { v[2].multiply_add(v[2], plane) };
        let slowing = V::load(self.ratio[0]) * square.sqrt();
        [slowing * v[0], slowing * v[1], slowing * v[2]]
    }
}

tiered! {
    fn kernel_tier[][](force: &Kernel, v: &[Lanes], a: &mut [Lanes], first: bool) = kernel;
    fn change_tier[][](force: &Kernel, of: [&[Lanes]; 2], into: &mut [Lanes]) = change;
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

impl Derivative<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        along: Along<'_, Lanes>,
        change: &mut [Lanes],
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        change_tier(self, [phase.v, along.v], change);
        Ok(())
    }
}
