//! Oblate bodies: the field of a body that is flattened along an axis, beside that of its mass.

use super::Force;
use super::bodies::{Of, PreciseBodies, Vector};
use super::context::Context;
use super::following::{Following, Leaders};
use super::links::{check_counts, of_link};
use super::remaining::{OfRemaining, Remaining};
use super::series::Series;
use super::sources::{Kernel, Law, NUMBERS, OfSource, Pull, Relative, Written, WrittenLaw, following};
use super::term::{About, Bodies, Conserves, Coupling, ForceDeclaration, ForceTerm};
use crate::error::{Error, Result};
use crate::expressions::graph::{Graph, Id};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::Lanes;
use crate::numerics::points::distance;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign, Value};
use crate::units::Units;
use crate::words::numbers;
use std::sync::Arc;

/// The exponents of length, mass and time in the gravitational constant.
pub(super) const CONSTANT: [i32; 3] = [3, -1, -2];

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "oblate",
    class_name: "Oblate",
    summary: "What the flattening of a body, or of each of several, adds to its pull on all others",
    formula: "V = Σ G M mᵢ/r (J2 (radius/r)² P₂(s) + J4 (radius/r)⁴ P₄(s)), s = axis·(rᵢ − r_body)/r",
    notes: "Gravity gives the rest. The others pull back, so momentum is conserved; the axis stays as it is, so angular \
            momentum is not: the torque on the body is left out of the motion. Numbers are for all bodies that are listed, \
            arrays of shape (M,) for each of M. Energy holds outside of the radius, inside the series means nothing.",
    source: "Murray & Dermott, Solar System Dynamics, section 4.5",
    example: ">>> earth = vv.Particles([5.9722e24, 0.0], [[0.0, 0.0, 0.0], [7e6, 0.0, 0.0]])\n\
              >>> flat = vv.Oblate(0, G=6.6743e-11, J2=1.08263e-3, radius=6.3781e6, axis=[0.0, 0.0, 1.0])\n\
              >>> vv.Scene(earth, flat).acceleration()[1].round(5).tolist()\n[-0.01097, 0.0, 0.0]",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::new("body", Kind::Indices, "The oblate body, or bodies"),
        Parameter::number("G", CONSTANT, "The gravitational constant"),
        Parameter::new(
            "J2",
            Kind::Numbers(Sign::Any),
            "The second zonal harmonic, or shape (M,): of each of M bodies",
        ),
        Parameter::new(
            "radius",
            Kind::Numbers(Sign::Positive),
            "The equatorial radius that J2 and J4 refer to, or shape (M,): of each of M bodies",
        )
        .of([1, 0, 0]),
        Parameter::new("axis", Kind::Direction, "The direction of the axis of symmetry, of any length"),
        Parameter::new(
            "J4",
            Kind::Numbers(Sign::Any),
            "The fourth zonal harmonic, or shape (M,): of each of M bodies",
        )
        .or(0.0),
    ],
    make: |values| Ok(Arc::new(Oblate::new(values)?)),
};

/// One flattened body.
#[derive(Clone, Copy, Debug)]
struct Shape {
    j2: f64,
    j4: f64,
    radius: f64,
}

/// Flattened bodies.
#[derive(Debug)]
struct Oblate {
    bodies: Vec<usize>,
    shapes: Vec<Shape>,
    constant: f64,
    axis: [f64; 3],
}

impl Oblate {
    fn new(values: &[Value]) -> Result<Self> {
        let [body, constant, j2, radius, axis, j4] = values else {
            return Err(Error::Internal("Oblate takes six parameters".to_owned()));
        };
        let (body, j2, radius, j4) = (body.indices(), j2.numbers(), radius.numbers(), j4.numbers());
        let lengths = [("J2", j2.len()), ("radius", radius.len()), ("J4", j4.len()), ("body", body.len())];
        let count = check_counts("bodies", &lengths)?;
        if body.len() != count {
            let message = format!("expected one index for each of {count} bodies, got {}", body.len());
            return Err(Error::invalid("body", message));
        }
        let axis = axis.vector();
        let size = axis.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let near = axis.map(|x| scale(x, -exponent(size)));
        let length = distance(near, [0.0; 3]);
        let shape =
            |at: usize| Shape { j2: of_link(&j2, at), j4: of_link(&j4, at), radius: of_link(&radius, at) };
        Ok(Self {
            shapes: (0..count).map(shape).collect(),
            bodies: body,
            constant: constant.number(),
            axis: near.map(|x| x / length),
        })
    }

    fn law(&self) -> Flattening {
        Flattening { fourth: self.shapes.iter().map(|shape| shape.j4 != 0.0).collect() }
    }

    fn sources(&self, context: &Context<'_>) -> Kernel<Flattening> {
        Kernel::new(self.law(), self, &self.bodies, context)
    }
}

impl ForceTerm for Oblate {
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
        Some(following(self.law(), &self.bodies, leaders))
    }
    fn potential_and_virial(
        &self,
        bodies: &PreciseBodies,
        _: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        let (mut energy, mut work) = (Scaled::ZERO, Scaled::ZERO);
        let unit = bodies.units.length;
        let number = DoubleDouble::from;
        let axis = self.axis.map(number);
        for (shape, &body) in
            self.shapes.iter().zip(&self.bodies).filter(|&(_, &body)| body < bodies.massive())
        {
            let from = bodies.vector(Of::Position, body);
            let radius = number(scale(shape.radius, -unit));
            let heavy = number(bodies.mass()[body]);
            for other in (0..bodies.massive()).filter(|&other| other != body && bodies.mass()[other] != 0.0) {
                let to = bodies.vector(Of::Position, other);
                let d: Vector = core::array::from_fn(|c| to[c] - from[c]);
                let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
                let s = (d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2]) / r;
                let (square, share) = (s * s, radius * radius / (r * r));
                let second = share * number(0.5 * shape.j2) * (number(3.0) * square - number(1.0));
                let fourth = share
                    * share
                    * number(0.125 * shape.j4)
                    * ((number(35.0) * square - number(30.0)) * square + number(3.0));
                let product = Scaled::new(heavy, 2 * bodies.units.mass - unit)
                    .times(bodies.mass()[other])
                    .times(self.constant)
                    .over(Scaled::new(r, 0));
                energy = energy.plus(product.by(Scaled::new(second + fourth, 0)));
                // Terms as r⁻³ and r⁻⁵: Σ r·F = 3 V₂ + 5 V₄.
                let virial = number(3.0) * second + number(5.0) * fourth;
                work = work.plus(product.by(Scaled::new(virial, 0)));
            }
            ticker.tick()?;
        }
        Ok((energy, work))
    }
    fn validate(&self, view: &Bodies<'_>) -> Result<()> {
        check_sources(&self.bodies, view, "Oblate")
    }
    fn acts(&self, view: &Bodies<'_>) -> bool {
        let flat = self.shapes.iter().any(|shape| shape.j2 != 0.0 || shape.j4 != 0.0);
        flat && self.constant != 0.0 && sources_act(&self.bodies, view)
    }
    fn coupling(&self) -> Coupling {
        Coupling::AllPairs
    }
    fn names_bodies(&self) -> bool {
        true
    }
    fn of_remaining(&self, remaining: &Remaining) -> OfRemaining {
        if self.bodies.iter().any(|&body| body >= remaining.places.len()) {
            return OfRemaining::Unknown;
        }
        let place = |(&body, &shape)| Some((remaining.place_if_there(body)?, shape));
        let there: Vec<(usize, Shape)> = self.bodies.iter().zip(&self.shapes).filter_map(place).collect();
        if there.is_empty() {
            return OfRemaining::Nothing;
        }
        let number =
            |of: fn(&Shape) -> f64| Value::Numbers(there.iter().map(|(_, shape)| of(shape)).collect());
        OfRemaining::Values(vec![
            Value::Indices(there.iter().map(|&(place, _)| place).collect()),
            Value::Number(self.constant),
            number(|shape| shape.j2),
            number(|shape| shape.radius),
            Value::Vector(self.axis),
            number(|shape| shape.j4),
        ])
    }
    /// Which bodies they are, and what is left out of their kernel.
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        let bodies = self.bodies.iter().map(|&body| body as u64);
        Some(bodies.chain(self.shapes.iter().map(|shape| u64::from(shape.j4 != 0.0))).collect())
    }
    fn conserves(&self) -> Conserves {
        Conserves { momentum: true, angular_momentum: About::Nowhere, spin: false, energy: true }
    }
    fn keeps_plane(&self) -> bool {
        self.axis[2] == 0.0 || (self.axis[0] == 0.0 && self.axis[1] == 0.0)
    }
    fn strongest(
        &self,
        bodies: &[(usize, f64, [f64; 3])],
        units: Units,
        _: [f64; 3],
        _: &mut Ticker<'_>,
    ) -> Result<f64> {
        let constant = units.take(self.constant, CONSTANT).abs();
        let mut strongest = 0.0_f64;
        for (shape, source) in self.shapes.iter().zip(&self.bodies) {
            let Some(&(_, mass, place)) = bodies.iter().find(|(body, ..)| body == source) else { continue };
            let radius = units.take(shape.radius, [1, 0, 0]);
            for &(_, _, other) in bodies.iter().filter(|(body, ..)| body != source) {
                let r = distance(place, other);
                let share = radius * radius / (r * r);
                let bound = share * (3.0 * shape.j2.abs() + 5.0 * shape.j4.abs() * share);
                strongest = strongest.max(constant * mass / (r * r) * bound);
            }
        }
        Ok(strongest)
    }
}

/// Refuses sources that are no bodies, and others in their places.
///
/// # Errors
/// By name.
pub(super) fn check_sources(sources: &[usize], view: &Bodies<'_>, class: &str) -> Result<()> {
    for &body in sources {
        if body >= view.particles {
            let message = format!("expected a body from 0 to {}, got {body}", view.particles.max(1) - 1);
            return Err(Error::invalid("body", message));
        }
        for copy in 0..view.copies {
            let (_, place) = view.copy(copy);
            let meets = |&other: &usize| other != body && place[other] == place[body];
            if let Some(other) = (0..view.particles).find(meets) {
                let [first, second] = [body, other].map(|b| view.name("position", copy * view.particles + b));
                return Err(Error::invalid(
                    "position",
                    format!(
                        "expected no body in the place of one of {class}, got {first} = {second} = {}; move one of them",
                        numbers(&place[body])
                    ),
                ));
            }
        }
    }
    Ok(())
}

/// Whether a source has mass and somebody to act on.
pub(super) fn sources_act(sources: &[usize], view: &Bodies<'_>) -> bool {
    let massive = |&body: &usize| {
        (0..view.copies).any(|copy| view.copy(copy).0.get(body).is_some_and(|&mass| mass > 0.0))
    };
    view.particles > 1 && sources.iter().any(massive)
}

/// The pull of flattened bodies, whose numbers are their axis; 5, −1 and −2 times 3/2 J2 radius²; and 5/8 J4 radius⁴.
#[derive(Debug)]
struct Flattening {
    /// Whether each has a J4.
    fourth: Vec<bool>,
}

impl Law for Flattening {
    type Term = Oblate;
    const VELOCITY: bool = false;

    fn constant(term: &Oblate, units: Units) -> f64 {
        units.take(term.constant, CONSTANT)
    }

    fn numbers(term: &Oblate, source: usize, _: f64, units: Units) -> [f64; NUMBERS] {
        let (shape, [x, y, z]) = (term.shapes[source], term.axis);
        let radius = units.take(shape.radius, [1, 0, 0]);
        let square = radius * radius;
        let second = 1.5 * shape.j2 * square;
        [x, y, z, 5.0 * second, -second, -2.0 * second, 0.625 * shape.j4 * square * square]
    }

    /// With z = axis·d and s = z/r: GM r⁻⁵ 3/2 J2 R² ((5 s² − 1) d − 2 z axis), and
    /// GM r⁻⁷ 5/8 J4 R⁴ ((63 s⁴ − 42 s² + 3) d − (28 s² − 12) z axis).
    #[inline(always)]
    fn pull<S: Real>(&self, source: usize, of: &OfSource<S>, relative: &Relative<S>) -> Pull<S> {
        let Relative { d, square: r2, inverse_cube: w, .. } = *relative;
        let [x, y, z, five, minus_one, minus_two, fourth] = of.numbers;
        let along = d[2].multiply_add(z, d[1].multiply_add(y, d[0] * x));
        // As few operations as can be wait for r⁻³ one after another.
        let inverse = w * r2;
        let sine = along * inverse;
        let inverse2 = inverse * inverse;
        let mut radial = (five * along * inverse).multiply_add(sine, minus_one);
        let mut axial = minus_two;
        if self.fourth[source] {
            let (square, share) = (sine * sine, fourth * inverse2);
            let polynomial = S::splat(63.0).multiply_add(square, S::splat(-42.0));
            radial = share.multiply_add(S::splat(3.0), radial);
            radial = (share * square).multiply_add(polynomial, radial);
            axial = share.multiply_add(S::splat(-28.0).multiply_add(square, S::splat(12.0)), axial);
        }
        let axial = axial * along;
        let vector = [
            radial.multiply_add(d[0], axial * x),
            radial.multiply_add(d[1], axial * y),
            radial.multiply_add(d[2], axial * z),
        ];
        Pull { factor: of.strength * w * inverse2, vector }
    }
}

impl WrittenLaw for Flattening {
    fn written(&self, source: usize, of: &Written, graph: &mut Graph) -> [Id; 3] {
        let [x, y, z, five, minus_one, minus_two, fourth] = of.numbers;
        let axis = [x, y, z];
        let r2 = graph.dot(of.d, of.d);
        let along = graph.dot(axis, of.d);
        let [inverse2, fifth] = [-1.0, -2.5].map(|exponent| graph.power(r2, exponent));
        let squared = graph.multiply(along, along);
        let square = graph.multiply(squared, inverse2);
        let steep = graph.multiply(five, square);
        let mut radial = graph.add(steep, minus_one);
        let mut axial = minus_two;
        if self.fourth[source] {
            let inner = graph.sum(-42.0, &[(63.0, square)]);
            let polynomial = graph.multiply(inner, square);
            let polynomial = graph.sum(3.0, &[(1.0, polynomial)]);
            let of_axis = graph.sum(12.0, &[(-28.0, square)]);
            let share = graph.multiply(fourth, inverse2);
            let [more, more_axial] = [polynomial, of_axis].map(|factor| graph.multiply(share, factor));
            radial = graph.add(radial, more);
            axial = graph.add(axial, more_axial);
        }
        let fifth = graph.multiply(of.strength, fifth);
        let axial = graph.multiply(axial, along);
        [0, 1, 2].map(|c| {
            let (along, aside) = (graph.multiply(radial, of.d[c]), graph.multiply(axis[c], axial));
            let sum = graph.add(along, aside);
            graph.multiply(fifth, sum)
        })
    }
}
