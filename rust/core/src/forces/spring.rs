//! Springs between listed pairs of bodies.
//!
//! Canonical order: springs act one after another, in the order in which they are listed, whatever the lanes are.
//! Products and sums are not fused, so that one number has the bits of a lane.

use super::bodies::{Of, PreciseBodies, Vector};
use super::context::{Context, System};
use super::derivative::{Along, Derivative};
use super::links::series::{LinkLaw, LinkSeries, Numbers};
use super::links::{Linked, Links, OfLinks, check_counts, of_link};
use super::remaining::{OfRemaining, Remaining};
use super::series::{LinearSeries, Series};
use super::term::{Bodies, Conserves, Coupling, ForceDeclaration, ForceTerm};
use super::{Force, Phase};
use crate::error::{Error, Result};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::points::distance;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::potentials::parameters::{Declaration, Kind, Parameter, Sign, Value};
use crate::tiered;
use crate::units::Units;
use std::sync::Arc;

/// The exponents of length, mass and time in a stiffness.
const STIFFNESS: [i32; 3] = [0, 1, -2];

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "spring",
    class_name: "Spring",
    summary: "A spring between two bodies, or one for each of several pairs",
    formula: "V = ½ k (|rⱼ − rᵢ| − length)²",
    notes: "Numbers are for all pairs, arrays of shape (M,) for each of M pairs. Ends must have mass, and must not \
            coincide if the spring has a length: its direction would not be known.",
    source: "Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 6.2",
    example: ">>> chain = vv.Spring(i=[0, 1], j=[1, 2], k=4.0, length=1.0)\n>>> chain\n\
              Spring(i=[0, 1], j=[1, 2], k=4.0, length=1.0)",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::new("i", Kind::Indices, "The body at one end"),
        Parameter::new("j", Kind::Indices, "The body at the other end"),
        Parameter::new(
            "k",
            Kind::Numbers(Sign::NotNegative),
            "The stiffness, force over extension, or shape (M,): of each of M pairs",
        )
        .of(STIFFNESS),
        Parameter::new(
            "length",
            Kind::Numbers(Sign::NotNegative),
            "The length at rest, or shape (M,): of each of M pairs",
        )
        .of([1, 0, 0])
        .or(0.0),
    ],
    make: |values| Ok(Arc::new(Springs::new(values)?)),
};

/// One spring.
#[derive(Clone, Copy, Debug)]
struct Spring {
    k: f64,
    length: f64,
}

/// Springs, in the order in which they act.
#[derive(Debug)]
struct Springs {
    links: Links,
    springs: Vec<Spring>,
}

impl Springs {
    fn new(values: &[Value]) -> Result<Self> {
        let [i, j, k, length] = values else {
            return Err(Error::Internal("Spring takes four parameters".to_owned()));
        };
        let (i, j, k, length) = (i.indices(), j.indices(), k.numbers(), length.numbers());
        let lengths = [("i", i.len()), ("j", j.len()), ("k", k.len()), ("length", length.len())];
        let count = check_counts("springs", &lengths)?;
        let spring = |at: usize| Spring { k: of_link(&k, at), length: of_link(&length, at) };
        Ok(Self { springs: (0..count).map(spring).collect(), links: Links::new(count, &i, &j) })
    }

    fn acting(&self, context: &Context<'_>) -> Kernel {
        let linked = Linked::new(&self.links, context);
        let number = |system: &System<'_>, at: usize| context.own(self, system).springs[at];
        Kernel {
            k: linked.numbers(context, |system, at| context.units.take(number(system, at).k, STIFFNESS)),
            length: linked
                .numbers(context, |system, at| context.units.take(number(system, at).length, [1, 0, 0])),
            long: linked.links.iter().map(|&(at, _)| self.springs[at].length != 0.0).collect(),
            linked,
        }
    }
}

/// How the force on the first end changes where the ends, `d` from each other, move apart by `e`.
#[inline(always)]
fn change<S: Real>(d: [S; 3], e: [S; 3], k: S, length: Option<S>) -> [S; 3] {
    let (pull, mut along) = (pull(d, k, length), S::zero());
    if let Some(length) = length {
        let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        along = k * length * (d[0] * e[0] + d[1] * e[1] + d[2] * e[2]) / (square * square.sqrt());
    }
    let mut change = [S::zero(); 3];
    for c in 0..3 {
        change[c] = pull * e[c] + along * d[c];
    }
    change
}

/// How much of the vector from one end to the other is the force on the first.
#[inline(always)]
fn pull<S: Real>(d: [S; 3], k: S, length: Option<S>) -> S {
    let Some(length) = length else { return k };
    let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    k * (r - length) / r
}

impl ForceTerm for Springs {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        Box::new(self.acting(context))
    }
    fn derivative(&self, context: &Context<'_>) -> Option<Box<dyn Derivative<Lanes>>> {
        Some(Box::new(self.acting(context)))
    }
    /// Without lengths springs are linear.
    fn series(&self, context: &Context<'_>) -> Option<Box<dyn Series<Lanes>>> {
        let kernel = self.acting(context);
        if kernel.long.contains(&true) {
            let Kernel { linked, k, length, .. } = kernel;
            return Some(Box::new(LinkSeries::<Law>::new(linked, [k, length])));
        }
        LinearSeries::between_bodies(Box::new(kernel), Some(self.kernel(context)))
    }
    fn series_in_every_lane(&self) -> bool {
        true
    }
    fn has_series(&self) -> bool {
        true
    }
    fn holds(&self, particle: usize) -> bool {
        self.links.at(particle).any(|at| self.springs[at].k != 0.0)
    }
    fn potential_and_virial(
        &self,
        bodies: &PreciseBodies,
        _: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        let (mut energy, mut work) = (Scaled::ZERO, Scaled::ZERO);
        let unit = bodies.units.length;
        for (spring, &(i, j)) in self.springs.iter().zip(self.links.pairs()) {
            let [from, to] = [i, j].map(|body| bodies.vector(Of::Position, body));
            let d: Vector = core::array::from_fn(|c| to[c] - from[c]);
            let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
            let extension = r - DoubleDouble::from(scale(spring.length, -unit));
            energy = energy.plus(Scaled::new(extension * extension, 2 * unit).times(0.5 * spring.k));
            work = work.plus(Scaled::new(extension * r, 2 * unit).times(-spring.k));
            ticker.tick()?;
        }
        Ok((energy, work))
    }

    fn validate(&self, view: &Bodies<'_>) -> Result<()> {
        self.links.validate(view)?;
        self.links.refuse_coincident(view, "a Spring that has a length", |at| self.springs[at].length > 0.0)
    }
    fn needs_mass(&self, particle: usize) -> bool {
        self.links.at(particle).next().is_some()
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.springs.iter().any(|spring| spring.k != 0.0)
    }
    fn coupling(&self) -> Coupling {
        Coupling::Listed(self.links.pairs().to_vec())
    }
    fn of_remaining(&self, remaining: &Remaining) -> OfRemaining {
        let Some([i, j, links]) = remaining.links(self.links.pairs()) else { return OfRemaining::Unknown };
        if links.is_empty() {
            return OfRemaining::Nothing;
        }
        let number =
            |of: fn(&Spring) -> f64| Value::Numbers(links.iter().map(|&at| of(&self.springs[at])).collect());
        let (k, length) = (number(|spring| spring.k), number(|spring| spring.length));
        OfRemaining::Values(vec![Value::Indices(i), Value::Indices(j), k, length])
    }
    fn conserves(&self) -> Conserves {
        Conserves::EVERYTHING
    }
    fn keeps_plane(&self) -> bool {
        true
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(self.springs.iter().map(|spring| u64::from(spring.length != 0.0)).collect())
    }
    /// 1/ω of the stiffest spring on the mass.
    fn unit_of_time(&self, _: i32, mass: i32) -> Option<i32> {
        let stiffest = self.springs.iter().map(|spring| spring.k).fold(0.0, f64::max);
        (stiffest > 0.0).then(|| (mass - exponent(stiffest)).div_euclid(2))
    }
    fn strongest(
        &self,
        bodies: &[(usize, f64, [f64; 3])],
        units: Units,
        _: [f64; 3],
        _: &mut Ticker<'_>,
    ) -> Result<f64> {
        let of = |(at, (i, j)): (usize, (usize, usize))| {
            let spring = self.springs[at];
            let (&(_, m, x), &(_, n, y)) = (bodies.get(i)?, bodies.get(j)?);
            let extension = distance(x, y) - units.take(spring.length, [1, 0, 0]);
            Some(units.take(spring.k, STIFFNESS) * extension.abs() / m.min(n))
        };
        Ok(self.links.between(bodies.iter().map(|&(body, ..)| body)).filter_map(of).fold(0.0, f64::max))
    }
}

/// `k (1 - length s^(-1/2))` of the squared distance `s`, for the recurrences of its series.
struct Law;

/// Ends that are so small a part of its length apart as good as meet.
const NOTHING: f64 = 64.0 * f64::EPSILON;

impl LinkLaw for Law {
    const EXPONENT: f64 = -0.5;
    fn may_meet([_, length]: Numbers<f64>) -> bool {
        length == 0.0
    }
    fn near([_, length]: Numbers<f64>) -> f64 {
        NOTHING * length
    }
    #[inline(always)]
    fn begin<V: Real>([k, length]: Numbers<V>, [square, inverse]: [V; 2], unit2: V) -> [V; 2] {
        let (k, r) = (unit2 * k, square.sqrt());
        let per_r = r * inverse;
        let stretched = V::select(length.less_equal(V::zero()), V::one(), (r - length) * per_r);
        [-(k * length) * per_r, k * stretched]
    }
}

#[derive(Debug)]
struct Kernel {
    linked: Linked,
    k: OfLinks,
    length: OfLinks,
    /// Which of them have a length.
    long: Vec<bool>,
}

/// Adds the pull of a spring to the accelerations of its ends, whose numbers are at these places; or what it changes by along
/// a direction.
#[inline(always)]
fn act<S: Real>(
    (k, length): (S, Option<S>),
    (i, j): (usize, usize),
    (stride, components): (usize, usize),
    inverse_mass: &[S],
    (q, along): (&[S], Option<&[S]>),
    a: &mut [S],
) {
    let mut force = [S::zero(); 3];
    for c in 0..components {
        force[c] = q[c * stride + j] - q[c * stride + i];
    }
    if let Some(along) = along {
        let mut apart = [S::zero(); 3];
        for c in 0..components {
            apart[c] = along[c * stride + j] - along[c * stride + i];
        }
        force = change(force, apart, k, length);
    } else {
        let pull = pull(force, k, length);
        for c in 0..components {
            force[c] = pull * force[c];
        }
    }
    for c in 0..components {
        let force = force[c];
        a[c * stride + i] += force * inverse_mass[i];
        a[c * stride + j] += -force * inverse_mass[j];
    }
}

#[inline(always)]
fn kernel<V: Vector8>(
    force: &Kernel,
    (q, along): (&[Lanes], Option<&[Lanes]>),
    a: &mut [Lanes],
    first: bool,
) {
    let Shape { rows, components } = force.linked.shape;
    if first {
        a.fill(Lanes::zero());
    }
    if force.linked.packed {
        let stride = rows * WIDTH;
        let (q, a, inverse_mass) = (as_numbers(q), as_numbers_mut(a), as_numbers(&force.linked.inverse_mass));
        let along = along.map(as_numbers);
        for (at, &(_, ends)) in force.linked.links.iter().enumerate() {
            let spring = (force.k[at].0[0], force.long[at].then_some(force.length[at].0[0]));
            act::<f64>(spring, ends, (stride, components), inverse_mass, (q, along), a);
        }
        return;
    }
    let (q, a, inverse_mass) = (V::view(q), V::view_mut(a), V::view(&force.linked.inverse_mass));
    let along = along.map(V::view);
    let bodies = rows / force.linked.blocks.max(1);
    let springs = force.linked.links.len();
    let (k, length) = (V::view(&force.k), V::view(&force.length));
    for block in 0..force.linked.blocks {
        for (at, &(_, (i, j))) in force.linked.links.iter().enumerate() {
            let ends = (block * bodies + i, block * bodies + j);
            let own = block * springs + at;
            let spring = (k[own], force.long[at].then_some(length[own]));
            act::<V>(spring, ends, (rows, components), inverse_mass, (q, along), a);
        }
    }
}

tiered! {
    fn kernel_tier[][](force: &Kernel, of: (&[Lanes], Option<&[Lanes]>), a: &mut [Lanes], first: bool) = kernel;
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        kernel_tier(self, (phase.q, None), a, first);
        Ok(())
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
        kernel_tier(self, (phase.q, Some(along.q)), change, true);
        Ok(())
    }
}
