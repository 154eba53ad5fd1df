//! Another force on the bodies of gravity's [ring](super::ring), in one kernel with it.
//!
//! The one idea: each of the two is a long chain in which every operation waits for the one before it. From one reading
//! of the state to one writing, a processor does both chains at once; and what gravity has found serves both.

use super::newton;
use super::pair::components;
use super::ring::{Ring, Turns, turns};
use crate::error::Result;
use crate::forces::context::Context;
use crate::forces::{Force, ForceTerm, Phase};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::tiered;

/// How bodies are and move, each in its lane, component after component.
pub(in crate::forces) struct Seen<'a, V> {
    pub place: [V; 3],
    /// If the force looks at it.
    pub velocity: [V; 3],
    /// Both as they lie in memory, from where a number comes into all lanes without a permutation.
    numbers: [&'a [Lanes]; 2],
}

impl<V: Vector8> Seen<'_, V> {
    /// Where the body of a lane is, in every lane.
    #[inline(always)]
    pub(in crate::forces) fn place_of(&self, lane: usize) -> [V; 3] {
        of_body(self.numbers[0], lane)
    }
    /// How it moves, likewise.
    #[inline(always)]
    pub(in crate::forces) fn velocity_of(&self, lane: usize) -> [V; 3] {
        of_body(self.numbers[1], lane)
    }
}

#[inline(always)]
fn of_body<V: Vector8>(numbers: &[Lanes], lane: usize) -> [V; 3] {
    let mut all = [V::zero(); 3];
    for (all, numbers) in all.iter_mut().zip(numbers) {
        *all = V::splat(numbers.0[lane % WIDTH]);
    }
    all
}

/// A force on up to eight bodies of one system, all of which have mass.
pub(in crate::forces) trait Beside: Send + 'static {
    /// Whether it looks at velocities.
    const VELOCITY: bool;

    /// Its accelerations, each in the lane of the body, from what is seen of the bodies and what gravity has found between
    /// them. In the plane nobody looks at the third component. Inlined, and without closures, with all it calls: it is
    /// compiled for each tier.
    fn term<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
        &self,
        seen: &Seen<'_, V>,
        found: &Turns<V, TURNS>,
    ) -> [V; 3];
}

/// Both forces.
struct BesideRing<B> {
    ring: Ring,
    beside: B,
}

/// In one kernel with the other force, if that is gravity between few bodies, all with mass; and softened so, where that
/// matters.
pub(in crate::forces) fn beside<B: Beside>(
    other: &dyn ForceTerm,
    softening: Option<f64>,
    context: &Context<'_>,
    make: impl FnOnce() -> B,
) -> Option<Box<dyn Force<Lanes>>> {
    let (constant, own) = other.as_newtonian()?;
    let ring = newton::ring(context, constant, own)
        .filter(|_| softening.is_none_or(|softening| own == softening))?;
    Some(Box::new(BesideRing { beside: make(), ring }))
}

#[inline(always)]
fn both<V: Vector8 + InverseCube, B: Beside, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
    of: &BesideRing<B>,
    q: &[Lanes],
    v: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    let components = components::<V, PLANAR>(of.ring.components());
    let (mut place, mut velocity) = ([V::zero(); 3], [V::zero(); 3]);
    place[..components].copy_from_slice(&V::view(q)[..components]);
    if B::VELOCITY {
        velocity[..components].copy_from_slice(&V::view(v)[..components]);
    }
    let numbers = [&q[..components], &v[..if B::VELOCITY { components } else { 0 }]];
    let seen = Seen { place, velocity, numbers };
    let a = &mut V::view_mut(a)[..components];
    let found = turns::<V, PLANAR, TURNS, EVEN>(&of.ring, place);
    let gravity = found.gravity::<PLANAR, EVEN>(&of.ring);
    let term = of.beside.term::<V, PLANAR, TURNS, EVEN>(&seen, &found);
    for c in 0..components {
        let sum = term[c] + gravity[c];
        a[c] = if first { sum } else { a[c] + sum };
    }
}

#[inline(always)]
fn apply<V: Vector8 + InverseCube, B: Beside>(
    of: &BesideRing<B>,
    q: &[Lanes],
    v: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    macro_rules! select {
        ($planar:literal: $($bodies:literal)+) => {
            match of.ring.bodies() {
                $($bodies => both::<V, B, $planar, { $bodies / 2 }, { $bodies % 2 == 0 }>(of, q, v, a, first),)+
                // More than RING_MAX bodies never come here.
                _ => {}
            }
        };
    }
    if of.ring.planar::<V>() {
        select!(true: 1 2 3 4 5 6 7 8);
    } else {
        select!(false: 1 2 3 4 5 6 7 8);
    }
}

tiered! {
    fn apply_tier[B: Beside][B](of: &BesideRing<B>, q: &[Lanes], v: &[Lanes], a: &mut [Lanes], first: bool) = apply;
}

impl<B: Beside> Force<Lanes> for BesideRing<B> {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        apply_tier(self, phase.q, phase.v, a, first);
        Ok(())
    }
    fn needs(&self) -> Needs {
        Needs { velocity: B::VELOCITY, ..Needs::default() }
    }
}
