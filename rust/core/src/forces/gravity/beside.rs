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
use crate::numerics::lanes::{Lanes, Vector8};
use crate::ode::system::Needs;
use crate::parallel::Ticker;
use crate::tiered;

/// A force on up to eight bodies of one system, all of which have mass.
pub(in crate::forces) trait Beside: Send + 'static {
    /// Whether it looks at velocities.
    const VELOCITY: bool;

    /// Its accelerations, each in the lane of the body, from places, velocities and what gravity has found between the
    /// bodies. In the plane nobody looks at the third component. Inlined, and without closures, with all it calls: it is
    /// compiled for each tier.
    fn term<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
        &self,
        place: [V; 3],
        velocity: [V; 3],
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
    let a = &mut V::view_mut(a)[..components];
    let found = turns::<V, PLANAR, TURNS, EVEN>(&of.ring, place);
    let gravity = found.gravity::<PLANAR, EVEN>(&of.ring);
    let term = of.beside.term::<V, PLANAR, TURNS, EVEN>(place, velocity, &found);
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
