//! One source beside gravity between few bodies, which has found r⁻³ of all pairs.

use super::{Kernel, Law, Relative, Source, difference, squared};
use crate::forces::context::Context;
use crate::forces::gravity::beside::{Beside, beside};
use crate::forces::gravity::ring::Turns;
use crate::forces::{Force, ForceTerm};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};

/// Where a turn of the ring has what is between the source and others.
struct Taken {
    /// The lane to take it from, for the lane of each other.
    lane: [i64; WIDTH],
    /// The lanes of those that this turn has.
    here: Bits,
}

/// The only source.
struct OneSource<L> {
    law: L,
    source: Source,
    mass: Lanes,
    turns: Vec<Taken>,
}

impl<L: Law> Kernel<L> {
    /// In one kernel with the other force, if that is gravity between few bodies and there is one source.
    pub(in crate::forces) fn beside(
        mut self,
        other: &dyn ForceTerm,
        context: &Context<'_>,
    ) -> Option<Box<dyn Force<Lanes>>> {
        let source = self.sources.pop().filter(|_| self.sources.is_empty())?;
        let mass = self.mass.first().copied()?;
        let make = || {
            let (n, own) = (context.active, source.place.1);
            let taken = |turn: usize| {
                let (ahead, behind) = ((own + turn) % n, (own + n - turn) % n);
                // Each lane has the pair with the body ahead of its own.
                let lane = core::array::from_fn(|lane| if lane == behind { behind } else { own } as i64);
                Taken { lane, here: Bits(1 << ahead | 1 << behind) }
            };
            let turns = (1..=n / 2).map(taken).collect();
            OneSource { law: self.law, source, mass, turns }
        };
        beside(other, Some(0.0), context, make)
    }
}

impl<L: Law> Beside for OneSource<L> {
    const VELOCITY: bool = L::VELOCITY;

    #[inline(always)]
    fn term<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
        &self,
        place: [V; 3],
        speed: [V; 3],
        found: &Turns<V, TURNS>,
    ) -> [V; 3] {
        let source = &self.source;
        let (mut own, mut own_speed) = ([V::zero(); 3], [V::zero(); 3]);
        for c in 0..if PLANAR { 2 } else { 3 } {
            own[c] = place[c].permute(&source.lane);
            if L::VELOCITY {
                own_speed[c] = speed[c].permute(&source.lane);
            }
        }
        let d = difference(place, own);
        // Sums of one number and zeros.
        let mut inverse_cube = V::zero();
        for k in (0..TURNS).rev() {
            let taken = &self.turns[k];
            let part = V::select(taken.here, found.weight[k].permute(&taken.lane), V::zero());
            inverse_cube = if k + 1 == TURNS { part } else { part + inverse_cube };
        }
        let velocity = difference(speed, own_speed);
        let relative = Relative { d, velocity, square: squared(d), inverse_cube };
        let mut pull = self.law.pull(source.index, V::load(source.strength[0]), &relative);
        let inverse_mass = V::load(source.alone);
        let itself = V::zero().less(inverse_mass);
        for c in 0..3 {
            let other = V::select(source.others[0], pull[c], V::zero());
            let sum = (V::load(self.mass) * other).sum_in_every_lane();
            // As where both are added to zeros.
            pull[c] = V::select(itself, V::zero() - sum * inverse_mass, V::zero() + other);
        }
        pull
    }
}
