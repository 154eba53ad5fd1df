//! One source beside gravity between few bodies, which has found r⁻³ of all pairs.

use super::{Kernel, Law, OfSource, Relative, Source, difference, squared};
use crate::forces::context::Context;
use crate::forces::gravity::beside::{Beside, Seen, beside};
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
        let make = || {
            let (n, own) = (context.active, source.place.1);
            let taken = |turn: usize| {
                let (ahead, behind) = ((own + turn) % n, (own + n - turn) % n);
                // Each lane has the pair with the body ahead of its own.
                let lane = core::array::from_fn(|lane| if lane == behind { behind } else { own } as i64);
                Taken { lane, here: Bits(1 << ahead | 1 << behind) }
            };
            let turns = (1..=n / 2).map(taken).collect();
            OneSource { law: self.law, source, turns }
        };
        beside(other, Some(0.0), context, make)
    }
}

impl<L: Law> Beside for OneSource<L> {
    const VELOCITY: bool = L::VELOCITY;

    #[inline(always)]
    fn term<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
        &self,
        seen: &Seen<'_, V>,
        found: &Turns<V, TURNS>,
    ) -> [V; 3] {
        let source = &self.source;
        let lane = source.place.1;
        let d = difference(seen.place, seen.place_of(lane));
        let mut velocity = [V::zero(); 3];
        if L::VELOCITY {
            velocity = difference(seen.velocity, seen.velocity_of(lane));
        }
        let mut inverse_cube = V::zero();
        for (taken, weight) in self.turns[..TURNS].iter().zip(&found.weight) {
            inverse_cube = V::select(taken.here, weight.permute(&taken.lane), inverse_cube);
        }
        let relative = Relative { d, velocity, square: squared(d), inverse_cube };
        // Where the source itself is, or nobody, r⁻³ is zero.
        let pull = self.law.pull(source.index, &OfSource::told(V::view(&source.of[0])), &relative);
        let reaction = pull.reaction(V::load(source.shares[0]));
        V::sums_in_lanes(source.itself, reaction, pull.acceleration())
    }
}
