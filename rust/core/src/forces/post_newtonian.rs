//! The first post-Newtonian correction to the pull of dominant bodies: Schwarzschild's field.

use super::Force;
use super::bodies::PreciseBodies;
use super::context::Context;
use super::following::{Following, Leaders};
use super::oblate::{CONSTANT, check_sources, sources_act};
use super::remaining::{OfRemaining, Remaining};
use super::series::Series;
use super::sources::{Kernel, Law, NUMBERS, OfSource, Pull, Relative, Written, WrittenLaw, following};
use super::term::{About, Bodies, Conserves, Coupling, ForceDeclaration, ForceTerm};
use crate::error::{Error, Result};
use crate::expressions::graph::{Graph, Id};
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Value};
use crate::units::Units;
use std::sync::Arc;

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "post_newtonian",
    class_name: "PostNewtonian",
    summary: "What general relativity adds, to first order in 1/c², to the pull of a dominant body, or of several, on all others",
    formula: "a = G M/(c² r³) ((4 G M/r − v²) r + 4 (r·v) v), r and v relative to the body",
    notes: "Gravity gives the rest. Right for bodies that are light beside the one that is named: it is the field of \
            Schwarzschild in harmonic coordinates, by which an orbit advances by 6πGM/(c² a (1 − e²)) a turn. The others \
            pull back, so momentum is conserved; the energies and angular momenta of Newton are not.",
    source: "Anderson et al., Astrophys. J. 200 (1975) 221, equation 1; Soffel, Relativity in Astrometry, Celestial \
             Mechanics and Geodesy, section 4.2",
    example: ">>> vv.PostNewtonian(0, G=1.0, c=1e4)\nPostNewtonian(body=0, G=1.0, c=10000.0)",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::new("body", Kind::Indices, "The dominant body, or bodies"),
        Parameter::number("G", CONSTANT, "The gravitational constant"),
        Parameter::positive("c", [1, 0, -1], "The speed of light"),
    ],
    make: |values| match values {
        [body, constant, c] => {
            Ok(Arc::new(PostNewtonian { bodies: body.indices(), constant: constant.number(), c: c.number() }))
        }
        _ => Err(Error::Internal("PostNewtonian takes three parameters".to_owned())),
    },
};

/// Dominant bodies.
#[derive(Debug)]
struct PostNewtonian {
    bodies: Vec<usize>,
    constant: f64,
    c: f64,
}

impl PostNewtonian {
    fn sources(&self, context: &Context<'_>) -> Kernel<Schwarzschild> {
        Kernel::new(Schwarzschild, self, &self.bodies, context)
    }
}

impl ForceTerm for PostNewtonian {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        Box::new(self.sources(context))
    }
    fn kernel_after(&self, other: &dyn ForceTerm, context: &Context<'_>) -> Option<Box<dyn Force<Lanes>>> {
        self.sources(context).beside(other, context)
    }
    fn series(&self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        self.sources(context).series(context)
    }
    fn has_series(&self) -> bool {
        true
    }
    fn following(&self, leaders: &Leaders<'_>) -> Option<Box<dyn Following>> {
        Some(following(Schwarzschild, &self.bodies, leaders))
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
        check_sources(&self.bodies, view, "PostNewtonian")
    }
    fn acts(&self, view: &Bodies<'_>) -> bool {
        self.constant != 0.0 && sources_act(&self.bodies, view)
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, ..Needs::default() }
    }
    fn coupling(&self) -> Coupling {
        Coupling::AllPairs
    }
    fn names_bodies(&self) -> bool {
        true
    }
    /// The mass of a dominant body goes on to pull in that of which it is a part.
    fn of_remaining(&self, remaining: &Remaining) -> OfRemaining {
        let place = |&body: &usize| remaining.places.get(body).copied();
        let Some(mut places) = self.bodies.iter().map(place).collect::<Option<Vec<usize>>>() else {
            return OfRemaining::Unknown;
        };
        places.sort_unstable();
        places.dedup();
        OfRemaining::Values(vec![Value::Indices(places), Value::Number(self.constant), Value::Number(self.c)])
    }
    /// Which bodies they are.
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(self.bodies.iter().map(|&body| body as u64).collect())
    }
    fn conserves(&self) -> Conserves {
        Conserves { momentum: true, angular_momentum: About::Nowhere, spin: false, energy: false }
    }
    fn keeps_plane(&self) -> bool {
        true
    }
}

/// The correction to first order; its numbers are 1/c², 4 GM and GM/c².
#[derive(Debug)]
struct Schwarzschild;

impl Law for Schwarzschild {
    type Term = PostNewtonian;
    const VELOCITY: bool = true;

    fn constant(term: &PostNewtonian, units: Units) -> f64 {
        units.take(term.constant, CONSTANT)
    }

    fn numbers(term: &PostNewtonian, _: usize, strength: f64, units: Units) -> [f64; NUMBERS] {
        let c = units.take(term.c, [1, 0, -1]);
        let inverse = 1.0 / c / c;
        let mut numbers = [0.0; NUMBERS];
        [numbers[0], numbers[1], numbers[2]] = [inverse, 4.0 * strength, strength * inverse];
        numbers
    }

    #[inline(always)]
    fn pull<S: Real>(&self, _: usize, of: &OfSource<S>, relative: &Relative<S>) -> Pull<S> {
        let Relative { d, velocity: v, square: r2, inverse_cube: w } = *relative;
        let v2 = v[2].multiply_add(v[2], v[1].multiply_add(v[1], v[0] * v[0]));
        let product = d[2].multiply_add(v[2], d[1].multiply_add(v[1], d[0] * v[0]));
        let [_, four, over, ..] = of.numbers;
        // 4 GM/r − v², 1/r being r² r⁻³.
        let radial = four.multiply_add(w * r2, -v2);
        let moving = S::splat(4.0) * product;
        let vector = [
            radial.multiply_add(d[0], moving * v[0]),
            radial.multiply_add(d[1], moving * v[1]),
            radial.multiply_add(d[2], moving * v[2]),
        ];
        Pull { factor: over * w, vector }
    }
}

impl WrittenLaw for Schwarzschild {
    fn written(&self, _: usize, of: &Written, graph: &mut Graph) -> [Id; 3] {
        let [r2, v2, product] =
            [(of.d, of.d), (of.velocity, of.velocity), (of.d, of.velocity)].map(|(a, b)| graph.dot(a, b));
        let inverse = graph.power(r2, -0.5);
        let cube = graph.power(r2, -1.5);
        let strength = graph.product(&[of.strength, cube]);
        let factor = graph.multiply(of.numbers[0], strength);
        let depth = graph.multiply(of.strength, inverse);
        let radial = graph.sum(0.0, &[(4.0, depth), (-1.0, v2)]);
        let moving = graph.scale(4.0, product);
        [0, 1, 2].map(|c| {
            let [along, with] =
                [(radial, of.d[c]), (moving, of.velocity[c])].map(|(a, b)| graph.multiply(a, b));
            let sum = graph.add(along, with);
            graph.multiply(factor, sum)
        })
    }
}
