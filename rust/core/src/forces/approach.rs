//! How long a step may be while bodies come to where a force of some length acts: nothing tells from far away that it will.
//!
//! The one idea: a step that leads over at most half of the distance, or of the force's own length where that is more, cannot
//! pass over the place without looking at it. Distances, speeds and accelerations are those at the start of the step.

use super::context::{Context, System};
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers};
use crate::numerics::real::{Mask, Real};
use crate::potentials::Potential;
use crate::tiered;
use std::sync::Arc;

/// The part of a distance over which a step may lead.
const PART: f64 = 0.5;
/// Longer than any step, in whatever unit of time, and so are its roots.
const LONG: f64 = f64::INFINITY;

/// The squares of the shortest lengths of the potentials on the systems in the lanes; nothing of those that have none. A
/// steep power of the distance acts abruptly though it has no length: any distance may be where.
pub(super) fn lengths2<'a>(
    context: &Context<'a>,
    potential: impl Fn(&System<'a>) -> &'a Arc<dyn Potential>,
) -> Option<Lanes> {
    let length = |system: &System<'a>| {
        let potential = potential(system).scaled(context.units);
        potential.lengths().first().copied().or_else(|| is_steep(&*potential).then_some(0.0))
    };
    let _: f64 = length(&context.first())?;
    context.per_system(|system| length(system).map_or(0.0, |length| length * length)).first().copied()
}

/// Of a potential without a length, that is a power law: whether its force falls faster than 1/r³, as what turns by itself
/// near a center does.
fn is_steep(potential: &dyn Potential) -> bool {
    let [_, force, curvature] = potential.at(1.0);
    curvature.abs() > 3.0 * force.abs()
}

/// Where bodies are, how they move and what accelerates them, component after component.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving<'a> {
    pub(super) shape: Shape,
    pub(super) q: &'a [Lanes],
    pub(super) v: &'a [Lanes],
    pub(super) a: &'a [Lanes],
}

/// The least squares of distances over those of speeds, and over those of accelerations.
#[derive(Clone, Copy)]
struct Least<V> {
    speeds: V,
    pulls: V,
}

impl<V: Vector8> Least<V> {
    #[inline(always)]
    fn new() -> Self {
        Self { speeds: V::splat(LONG), pulls: V::splat(LONG) }
    }

    /// Looks at vectors between bodies, or between bodies and a point, in the lanes of a mask.
    #[inline(always)]
    fn look(&mut self, [d, v, a]: [[V; 3]; 3], length2: V, here: Bits) {
        let r2 = squared(d).max(length2);
        self.speeds = self.speeds.min(over(r2, squared(v), here));
        self.pulls = self.pulls.min(over(r2, squared(a), here));
    }

    /// The longest step of each lane.
    #[inline(always)]
    fn step(self) -> V {
        let by_speed = V::splat(PART) * self.speeds.sqrt();
        let by_pull = (V::splat(2.0 * PART) * self.pulls.sqrt()).sqrt();
        by_speed.min(by_pull)
    }
}

/// The quotient where there is one in the lanes of a mask. No closure, which would be compiled without the tier's instructions.
#[inline(always)]
fn over<V: Vector8>(distance2: V, of: V, here: Bits) -> V {
    V::select(here.and(V::zero().less(of)), distance2 / of, V::splat(LONG))
}

#[inline(always)]
fn squared<V: Vector8>(d: [V; 3]) -> V {
    d[2].multiply_add(d[2], d[1].multiply_add(d[1], d[0] * d[0]))
}

/// A row of each of the three, less what is given.
#[inline(always)]
fn row_less<V: Vector8>(moving: &Moving<'_>, row: usize, from: [[V; 3]; 3]) -> [[V; 3]; 3] {
    let Shape { rows, components } = moving.shape;
    let mut all = [[V::zero(); 3]; 3];
    for (which, values) in [moving.q, moving.v, moving.a].into_iter().enumerate() {
        for c in 0..components {
            all[which][c] = V::load(values[c * rows + row]) - from[which][c];
        }
    }
    all
}

/// Of systems in lanes, with a body in each row.
#[inline(always)]
fn systems<V: Vector8>(moving: &Moving<'_>, length2: &Lanes) -> Lanes {
    let (mut least, nowhere) = (Least::<V>::new(), [[V::zero(); 3]; 3]);
    for i in 0..moving.shape.rows {
        let own = row_less(moving, i, nowhere);
        for j in i + 1..moving.shape.rows {
            least.look(row_less(moving, j, own), V::load(*length2), Bits(0xff));
        }
    }
    least.step().store()
}

/// Of so many bodies of one system in rows; the shortest, in every lane.
#[inline(always)]
fn packed<V: Vector8>(moving: &Moving<'_>, bodies: usize, length2: &Lanes) -> Lanes {
    let Shape { rows, components } = moving.shape;
    let mut least = Least::<V>::new();
    for i in 0..bodies {
        let mut own = [[V::zero(); 3]; 3];
        for (which, values) in [moving.q, moving.v, moving.a].into_iter().enumerate() {
            for c in 0..components {
                own[which][c] = V::splat(as_numbers(values)[c * rows * WIDTH + i]);
            }
        }
        for row in i / WIDTH..bodies.div_ceil(WIDTH) {
            let later = if row == i / WIDTH { 0xfe_u32 << (i % WIDTH) } else { 0xff };
            let there = 0xff_u32 >> (WIDTH - (bodies - row * WIDTH).min(WIDTH));
            least.look(row_less(moving, row, own), V::load(*length2), Bits((later & there) as u8));
        }
    }
    shortest(least.step().store())
}

/// Of bodies that come to a point, each in a lane; the shortest of a row, or of all rows.
#[inline(always)]
fn around<V: Vector8>(moving: &Moving<'_>, center: &[Lanes; 3], length2: &Lanes) -> Lanes {
    let mut least = Least::<V>::new();
    let still = [V::zero(); 3];
    let center = [V::load(center[0]), V::load(center[1]), V::load(center[2])];
    for row in 0..moving.shape.rows {
        least.look(row_less(moving, row, [center, still, still]), V::load(*length2), Bits(0xff));
    }
    least.step().store()
}

/// The shortest of all lanes, in every lane.
pub(super) fn shortest(steps: Lanes) -> Lanes {
    Lanes::splat(steps.0.into_iter().fold(LONG, f64::min))
}

tiered! {
    /// The longest steps of systems in lanes, with a body in each row; lengths squared.
    pub(super) fn between_systems[][](moving: &Moving<'_>, length2: &Lanes) -> Lanes = systems;
    /// The longest step of so many bodies of one system, in every lane.
    pub(super) fn between_bodies[][](moving: &Moving<'_>, bodies: usize, length2: &Lanes) -> Lanes = packed;
    /// The longest steps of what comes to a point, of all rows of each lane.
    pub(super) fn to_point[][](moving: &Moving<'_>, center: &[Lanes; 3], length2: &Lanes) -> Lanes = around;
}
