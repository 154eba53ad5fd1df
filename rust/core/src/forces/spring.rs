//! Springs between listed pairs of bodies.
//!
//! Canonical order: springs act one after another, in the order in which they are listed, whatever the lanes are.
//! Products and sums are not fused, so that one number has the bits of a lane.

use super::bodies::{Of, PreciseBodies, Vector};
use super::context::{Arrangement, Context, packed_place};
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
        Parameter::new("k", Kind::Numbers(Sign::NotNegative), "The stiffness, force over extension")
            .of(STIFFNESS),
        Parameter::new("length", Kind::Numbers(Sign::NotNegative), "The length at rest")
            .of([1, 0, 0])
            .or(0.0),
    ],
    make: |values| Ok(Arc::new(Springs::new(values)?)),
};

/// One spring.
#[derive(Clone, Copy, Debug)]
struct Spring {
    ends: (usize, usize),
    k: f64,
    length: f64,
}

/// Springs, in the order in which they act.
#[derive(Debug)]
struct Springs {
    springs: Vec<Spring>,
    /// Each end and the place of its spring in the list, in the order of the bodies: there may be as many springs as
    /// bodies, and units as springs.
    ends: Vec<(usize, usize)>,
}

impl Springs {
    fn new(values: &[Value]) -> Result<Self> {
        let [i, j, k, length] = values else {
            return Err(Error::Internal("Spring takes four parameters".to_owned()));
        };
        let (i, j, k, length) = (i.indices(), j.indices(), k.numbers(), length.numbers());
        let count = i.len().max(j.len()).max(k.len()).max(length.len());
        for (name, found) in [("i", i.len()), ("j", j.len()), ("k", k.len()), ("length", length.len())] {
            if found != 1 && found != count {
                let message = format!("expected one value or one for each of {count} springs, got {found}");
                return Err(Error::invalid(name, message));
            }
        }
        let springs = (0..count).map(|at| Spring {
            ends: (i[at.min(i.len() - 1)], j[at.min(j.len() - 1)]),
            k: k[at.min(k.len() - 1)],
            length: length[at.min(length.len() - 1)],
        });
        let springs: Vec<Spring> = springs.collect();
        let each = springs.iter().enumerate();
        let mut ends: Vec<(usize, usize)> =
            each.flat_map(|(at, spring)| [(spring.ends.0, at), (spring.ends.1, at)]).collect();
        ends.sort_unstable();
        Ok(Self { springs, ends })
    }

    /// The springs at a body, by their places in the list.
    fn at(&self, body: usize) -> impl Iterator<Item = usize> {
        let from = self.ends.partition_point(|&(other, _)| other < body);
        self.ends.iter().skip(from).take_while(move |&&(other, _)| other == body).map(|&(_, at)| at)
    }

    /// The springs between some of these bodies, in the order in which they act, and the places of their ends among them.
    fn between(&self, bodies: impl Iterator<Item = usize>) -> impl Iterator<Item = (Spring, (usize, usize))> {
        let mut places: Vec<(usize, usize)> = bodies.enumerate().map(|(place, body)| (body, place)).collect();
        places.sort_unstable();
        let mut own: Vec<usize> = places.iter().flat_map(|&(body, _)| self.at(body)).collect();
        own.sort_unstable();
        own.dedup();
        own.into_iter().filter_map(move |at| {
            let spring = *self.springs.get(at)?;
            let place = |end: usize| {
                let found = places.binary_search_by_key(&end, |&(body, _)| body).ok()?;
                places.get(found).map(|&(_, place)| place)
            };
            // Those between bodies of other systems act there.
            Some((spring, (place(spring.ends.0)?, place(spring.ends.1)?)))
        })
    }
}

/// How much of the vector from one end to the other is the force on the first.
#[inline(always)]
fn pull<S: Real>(d: [S; 3], k: f64, length: f64) -> S {
    if length == 0.0 {
        return S::splat(k);
    }
    let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    S::splat(k) * (r - S::splat(length)) / r
}

impl ForceTerm for Springs {
    fn declaration(&self) -> &'static ForceDeclaration {
        &DECLARATION
    }
    fn kernel(&self, context: &Context<'_>) -> Box<dyn Force<Lanes>> {
        let bodies = context.first().bodies;
        let packed = context.arrangement == Arrangement::Packed;
        let place = |slot: usize| {
            let (row, lane) = packed_place(slot, context.active);
            if packed { row * WIDTH + lane } else { slot }
        };
        let own = self.between(bodies.iter().copied()).map(|(spring, (i, j))| {
            let (k, length) =
                (context.units.take(spring.k, STIFFNESS), context.units.take(spring.length, [1, 0, 0]));
            Spring { ends: (place(i), place(j)), k, length }
        });
        let inverse_mass = context.per_body(|system, slot| 1.0 / system.mass[slot]);
        Box::new(Kernel {
            shape: context.shape,
            packed,
            blocks: context.blocks(),
            springs: own.collect(),
            inverse_mass,
        })
    }
    fn potential_and_virial(
        &self,
        bodies: &PreciseBodies,
        _: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<(Scaled, Scaled)> {
        let (mut energy, mut work) = (Scaled::ZERO, Scaled::ZERO);
        let unit = bodies.units.length;
        for spring in &self.springs {
            let [from, to] = [spring.ends.0, spring.ends.1].map(|body| bodies.vector(Of::Position, body));
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
        for spring in &self.springs {
            let (i, j) = spring.ends;
            for (name, body) in [("i", i), ("j", j)] {
                if body >= view.particles {
                    let message =
                        format!("expected a body from 0 to {}, got {body}", view.particles.max(1) - 1);
                    return Err(Error::invalid(name, message));
                }
            }
            if i == j {
                return Err(Error::invalid("j", format!("expected another body than i, got {j} for both")));
            }
            let meet = |copy: &usize| view.copy(*copy).1[i] == view.copy(*copy).1[j];
            if spring.length > 0.0
                && let Some(copy) = (0..view.copies).find(meet)
            {
                let [first, second] = [i, j].map(|body| view.name("position", copy * view.particles + body));
                let message = format!(
                    "expected distinct ends of a Spring that has a length, got {first} = {second}; move one of them"
                );
                return Err(Error::invalid("position", message));
            }
        }
        Ok(())
    }
    fn needs_mass(&self, particle: usize) -> bool {
        self.at(particle).next().is_some()
    }
    fn acts(&self, _: &Bodies<'_>) -> bool {
        self.springs.iter().any(|spring| spring.k != 0.0)
    }
    fn coupling(&self) -> Coupling {
        Coupling::Listed(self.springs.iter().map(|spring| spring.ends).collect())
    }
    fn conserves(&self) -> Conserves {
        Conserves::EVERYTHING
    }
    fn keeps_plane(&self) -> bool {
        true
    }
    /// 1/ω of the stiffest spring on the mass.
    fn unit_of_time(&self, _: i32, mass: i32) -> Option<i32> {
        let stiffest = self.springs.iter().map(|spring| spring.k).fold(0.0, f64::max);
        (stiffest > 0.0).then(|| (mass - exponent(stiffest)).div_euclid(2))
    }
    fn strongest(&self, bodies: &[(usize, f64, [f64; 3])], units: Units, _: &mut Ticker<'_>) -> Result<f64> {
        let of = |(spring, (i, j)): (Spring, (usize, usize))| {
            let (&(_, m, x), &(_, n, y)) = (bodies.get(i)?, bodies.get(j)?);
            let extension = distance(x, y) - units.take(spring.length, [1, 0, 0]);
            Some(units.take(spring.k, STIFFNESS) * extension.abs() / m.min(n))
        };
        Ok(self.between(bodies.iter().map(|&(body, ..)| body)).filter_map(of).fold(0.0, f64::max))
    }
}

#[derive(Debug)]
struct Kernel {
    shape: Shape,
    packed: bool,
    blocks: usize,
    /// With ends by their row in a block, or if packed by their place among all numbers of a component.
    springs: Vec<Spring>,
    inverse_mass: Vec<Lanes>,
}

/// Adds the pull of a spring to the accelerations of its ends, whose numbers are at these places.
#[inline(always)]
fn act<S: Real>(
    spring: &Spring,
    (i, j): (usize, usize),
    (stride, components): (usize, usize),
    inverse_mass: &[S],
    q: &[S],
    a: &mut [S],
) {
    let mut d = [S::zero(); 3];
    for c in 0..components {
        d[c] = q[c * stride + j] - q[c * stride + i];
    }
    let pull = pull(d, spring.k, spring.length);
    for c in 0..components {
        let force = pull * d[c];
        a[c * stride + i] += force * inverse_mass[i];
        a[c * stride + j] += -force * inverse_mass[j];
    }
}

#[inline(always)]
fn kernel<V: Vector8>(force: &Kernel, q: &[Lanes], a: &mut [Lanes], first: bool) {
    let Shape { rows, components } = force.shape;
    if first {
        a.fill(Lanes::zero());
    }
    if force.packed {
        let stride = rows * WIDTH;
        let (q, a, inverse_mass) = (as_numbers(q), as_numbers_mut(a), as_numbers(&force.inverse_mass));
        for spring in &force.springs {
            act::<f64>(spring, spring.ends, (stride, components), inverse_mass, q, a);
        }
        return;
    }
    let (q, a, inverse_mass) = (V::view(q), V::view_mut(a), V::view(&force.inverse_mass));
    let bodies = rows / force.blocks.max(1);
    for block in 0..force.blocks {
        for spring in &force.springs {
            let ends = (block * bodies + spring.ends.0, block * bodies + spring.ends.1);
            act::<V>(spring, ends, (rows, components), inverse_mass, q, a);
        }
    }
}

tiered! {
    fn kernel_tier[][](force: &Kernel, q: &[Lanes], a: &mut [Lanes], first: bool) = kernel;
}

impl Force<Lanes> for Kernel {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        kernel_tier(self, phase.q, a, first);
        Ok(())
    }
}
