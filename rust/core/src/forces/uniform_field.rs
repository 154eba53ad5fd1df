//! A uniform field: the same acceleration everywhere.

use super::bodies::{Of, PreciseBodies, joined, vector_sum};
use super::context::{Context, System};
use super::derivative::{Derivative, OfLinear};
use super::linear::{Linear, LinearAcceleration};
use super::series::{LinearSeries, Series};
use super::term::{About, Bodies, Conserves, ForceDeclaration, ForceTerm};
use super::{Adds, Force, Phase};
use crate::error::Result;
use crate::numerics::lanes::Lanes;
use crate::numerics::points::distance;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter};
use crate::units::Units;
use std::sync::Arc;

/// The exponents of length, mass and time in an acceleration.
const ACCELERATION: [i32; 3] = [1, 0, -2];

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "uniform_field",
    class_name: "UniformField",
    summary: "The same acceleration everywhere",
    formula: "V = −Σ mᵢ g·rᵢ",
    notes: "",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 1.1",
    example: ">>> ball = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 2.0]]), \
              vv.UniformField([0, 0, -8]))\n>>> ball.run(t=0.5).position[-1, 0]\narray([0.5, 0. , 0. ])",
    at_rest: "",
    one_way: "",
    parameters: &[Parameter::new("g", Kind::Vector, "The acceleration").of(ACCELERATION)],
    make: |values| Ok(Arc::new(Uniform { g: values[0].vector() })),
};

/// The acceleration `g` of a scene.
#[derive(Debug)]
pub struct Uniform {
    g: [f64; 3],
}

impl ForceTerm for Uniform {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        let g =
            |system: &System<'_>, c: usize| context.units.take(context.own(self, system).g[c], ACCELERATION);
        let acceleration = (0..3).flat_map(|c| context.per_body(|system, _| g(system, c)));
        Box::new(Kernel { acceleration: acceleration.collect() })
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
        _: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        let moments = vector_sum(bodies, Of::Position, true);
        let unit = bodies.units.mass + bodies.units.length;
        let mut work = Scaled::ZERO;
        for c in 0..3 {
            work = work.plus(Scaled::new(joined(moments[c]), unit).times(self.g[c]));
        }
        Ok((work.negative(), work))
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.g.iter().any(|&g| g != 0.0)
    }
    fn conserves(&self) -> Conserves {
        // The torque about a fixed point a is M (R − a) × g, about the centre of mass none.
        Conserves { momentum: false, angular_momentum: About::Nowhere, spin: true, energy: true }
    }
    fn keeps_plane(&self) -> bool {
        self.g[2] == 0.0
    }
    fn strongest(
        &self,
        _: &[(usize, f64, [f64; 3])],
        units: Units,
        _: [f64; 3],
        _: &mut Ticker<'_>,
    ) -> Result<f64> {
        Ok(distance(units.take_vector(self.g, ACCELERATION), [0.0; 3]))
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }
    fn as_uniform(&self) -> Option<[f64; 3]> {
        Some(self.g)
    }
}

impl Linear for Uniform {
    fn add_to(&self, acceleration: &mut LinearAcceleration, _: usize, _: Scaled) {
        (0..3).for_each(|c| acceleration.add_constant(c, Scaled::from(self.g[c])));
    }
}

/// The acceleration `g` on every particle; lanes without one stay at rest, as the error of a step is measured over all.
struct Kernel {
    acceleration: Vec<Lanes>,
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        _: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        for (a, &g) in a.iter_mut().zip(&self.acceleration) {
            *a = if first { g } else { *a + g };
        }
        Ok(())
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}
