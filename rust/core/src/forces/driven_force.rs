//! A periodic drive: the same force on every body, a cosine of time.

use super::bodies::PreciseBodies;
use super::context::{Context, System};
use super::derivative::{Derivative, OfLinear};
use super::series::{ONE, Scale, Series};
use super::term::{Bodies, ForceDeclaration, ForceTerm};
use super::{Adds, Force, Phase};
use crate::error::Result;
use crate::numerics::cosine::cosine;
use crate::numerics::double_double::{DoubleDouble, two_product, two_sum};
use crate::numerics::element::{Element, Shape};
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::ode::series::Jet;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter};
use crate::tiered;
use crate::units::Units;
use std::sync::Arc;

/// The exponents of length, mass and time in a force.
const FORCE: [i32; 3] = [1, 1, -2];
const FREQUENCY: [i32; 3] = [0, 0, -1];

/// The force amplitude·cos(frequency·t + phase), t being the scene's own time.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// The largest force.
    pub amplitude: [f64; 3],
    /// The angular frequency.
    pub frequency: f64,
    /// The phase at time 0.
    pub phase: f64,
}

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "driven_force",
    class_name: "DrivenForce",
    summary: "A periodic force, the same on every body",
    formula: "F = amplitude cos(frequency t + phase)",
    notes: "t is the scene's own time, also far from 0, where no digit of the phase is lost. It acts by its force, so \
            every mass must be positive; it does work and conserves nothing.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 6.5",
    example: ">>> vv.DrivenForce([1.0, 0.0, 0.0], frequency=2.0)\n\
              DrivenForce(amplitude=(1.0, 0.0, 0.0), frequency=2.0, phase=0.0)",
    at_rest: "",
    one_way: "its phase goes on with time",
    parameters: &[
        Parameter::new("amplitude", Kind::Vector, "The largest force").of(FORCE),
        Parameter::number("frequency", FREQUENCY, "The angular frequency, in radians per time"),
        Parameter::number("phase", [0; 3], "The phase at time 0, in radians").or(0.0),
    ],
    make: |values| {
        let [amplitude, frequency, phase] = values else {
            return Err(crate::Error::Internal("DrivenForce takes three parameters".to_owned()));
        };
        Ok(Arc::new(DrivenForce {
            amplitude: amplitude.vector(),
            frequency: frequency.number(),
            phase: phase.number(),
        }))
    },
};

/// A drive.
#[derive(Debug)]
struct DrivenForce {
    amplitude: [f64; 3],
    frequency: f64,
    phase: f64,
}

/// What π/2 leaves out as a double.
const FRAC_PI_2_REST: f64 = 6.123_233_995_736_766e-17;

impl DrivenForce {
    /// With another angle added to the phase.
    fn kernel_turned(&self, context: &Context<'_>, turned: DoubleDouble) -> Kernel {
        let start = |system: &System<'_>| {
            let own = context.own(self, system);
            let phase = DoubleDouble::product(own.frequency, context.t0) + DoubleDouble::from(own.phase);
            (phase + turned).parts()
        };
        let amplitude =
            |system: &System<'_>, c: usize| context.units.take(context.own(self, system).amplitude[c], FORCE);
        let frequency =
            |system: &System<'_>| context.units.take(context.own(self, system).frequency, FREQUENCY);
        Kernel {
            shape: context.shape,
            amplitude: [0, 1, 2].map(|c| context.per_system(|system| amplitude(system, c))),
            frequency: context.per_system(frequency),
            start: [
                context.per_system(|system| start(system).0),
                context.per_system(|system| start(system).1),
            ],
            inverse_mass: context.per_body(|system, slot| 1.0 / system.mass[slot]),
        }
    }
}

/// The n-th derivative of a cosine is that of a phase n quarters of a turn ahead.
struct WaveSeries {
    quarters: [Kernel; 4],
    /// (frequency · unit of time)ⁿ/n!.
    power: Lanes,
    a: Vec<Lanes>,
}

impl Series<Lanes> for WaveSeries {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        let turn = jet.unit * self.quarters[0].frequency[0];
        self.power = if n == 0 { jet.unit * jet.unit } else { self.power * turn * jet.inverse[n].0 };
        self.a.resize(jet.len, Lanes::zero());
        kernel_tier(&self.quarters[n % 4], &jet.t, &mut self.a, true);
        Lanes::pass(Scale { from: &self.a, factors: [&self.power, &ONE], into: a, first });
        Ok(())
    }
}

impl ForceTerm for DrivenForce {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        Box::new(self.kernel_turned(context, DoubleDouble::from(0.0)))
    }

    fn derivative(&self, _: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        OfLinear::boxed(None)
    }
    fn series(&self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        let quarters = [0.0, 1.0, 2.0, 3.0].map(|quarters| {
            let turned = DoubleDouble::new(core::f64::consts::FRAC_PI_2, FRAC_PI_2_REST)
                * DoubleDouble::from(quarters);
            self.kernel_turned(context, turned)
        });
        Some(Box::new(WaveSeries { quarters, power: Lanes::one(), a: Vec::new() }))
    }
    fn has_series(&self) -> bool {
        true
    }
    fn potential_and_virial(
        &self,
        _: &PreciseBodies,
        _: usize,
        _: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        Ok((Scaled::ZERO, Scaled::from(f64::NAN)))
    }
    fn needs_mass(&self, _: usize) -> bool {
        true
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.amplitude.iter().any(|&f| f != 0.0)
    }
    fn needs(&self) -> Needs {
        Needs { time: true, ..Needs::default() }
    }
    fn translation_invariant(&self) -> bool {
        true
    }
    fn keeps_plane(&self) -> bool {
        self.amplitude[2] == 0.0
    }
    fn strongest(
        &self,
        bodies: &[(usize, f64, [f64; 3])],
        units: Units,
        _: [f64; 3],
        _: &mut Ticker<'_>,
    ) -> Result<f64> {
        let largest =
            units.take_vector(self.amplitude, FORCE).into_iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        Ok(bodies.iter().map(|&(_, mass, _)| largest / mass).fold(0.0, f64::max))
    }
    fn rate(&self, _: &[(usize, f64, [f64; 3])], units: Units) -> f64 {
        units.take(self.frequency, FREQUENCY).abs()
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(Vec::new())
    }
    fn as_driven(&self) -> Option<Drive> {
        let Self { amplitude, frequency, phase } = *self;
        Some(Drive { amplitude, frequency, phase })
    }
}

#[derive(Debug)]
struct Kernel {
    shape: Shape,
    /// Of each block, as what follows.
    amplitude: [Vec<Lanes>; 3],
    frequency: Vec<Lanes>,
    /// The phase at the start of the run, as an unevaluated sum.
    start: [Vec<Lanes>; 2],
    inverse_mass: Vec<Lanes>,
}

#[inline(always)]
fn kernel<V: Vector8>(force: &Kernel, t: &Lanes, a: &mut [Lanes], first: bool) {
    let Shape { rows, components } = force.shape;
    let (a, inverse_mass) = (V::view_mut(a), V::view(&force.inverse_mass));
    let bodies = rows / force.frequency.len();
    for block in 0..force.frequency.len() {
        let (turned, error) = two_product(V::load(force.frequency[block]), V::load(*t));
        let (high, rest) = two_sum(turned, V::load(force.start[0][block]));
        let (high, low) = two_sum(high, rest + (error + V::load(force.start[1][block])));
        let wave = cosine(high, low);
        for c in 0..components {
            let push = V::load(force.amplitude[c][block]) * wave;
            for row in block * bodies..(block + 1) * bodies {
                let term = push * inverse_mass[row];
                let a = &mut a[c * rows + row];
                *a = if first { term } else { *a + term };
            }
        }
    }
}

tiered! {
    fn kernel_tier[][](force: &Kernel, t: &Lanes, a: &mut [Lanes], first: bool) = kernel;
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        kernel_tier(self, phase.t, a, first);
        Ok(())
    }
    fn needs(&self) -> Needs {
        Needs { time: true, ..Needs::default() }
    }
    fn adds(&self) -> Adds {
        Adds::Once
    }
}
