//! Spheres of eight units side by side: all pairs of the few bodies of each come to the end of a step in one pass.
//!
//! The one idea: that of [`spheres`](super::spheres), with units in the lanes, each with radii of its own.

use super::Bodies;
use super::clear::{cubic, keeps_clear};
use super::contacts::Contacts;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::ode::state::State;

/// A pair in every lane.
#[derive(Clone, Copy)]
struct Pair {
    /// Where the first coordinates of the two lie.
    rows: [usize; 2],
    /// The sum of their radii, squared, in the plan's units.
    square: Lanes,
    /// d² − R² and its rate at the last node.
    value: Lanes,
    rate: Lanes,
}

/// The spheres of eight units.
pub(super) struct SpheresAbreast {
    pairs: Vec<Pair>,
}

impl SpheresAbreast {
    /// Of units whose bodies lie like these, if they are few; each has still to begin.
    pub(super) fn of(contacts: &Contacts, bodies: &Bodies) -> Option<Self> {
        let _ = contacts.few()?;
        let zero = Lanes::zero();
        let pair = |([i, j], _): ([usize; 2], f64)| Pair {
            rows: [bodies.row(i), bodies.row(j)],
            square: zero,
            value: zero,
            rate: zero,
        };
        Some(Self { pairs: contacts.pairs_of_all().map(pair).collect() })
    }

    /// A unit begins in a lane.
    pub(super) fn begin(&mut self, lane: usize, contacts: &Contacts, unit_of_length: f64) {
        for (pair, (_, length)) in self.pairs.iter_mut().zip(contacts.pairs_of_all()) {
            let length = length / unit_of_length;
            pair.square.0[lane % WIDTH] = length * length;
        }
    }

    /// The units that may have spheres in touch in a step of these lengths, of those that take it.
    #[inline(always)]
    pub(super) fn suspects<V: Vector8>(
        &mut self,
        lanes: Bits,
        h: V,
        bodies: &Bodies,
        state: &State<Lanes>,
    ) -> Bits {
        // From the unit of time of the step to that of the velocities.
        let h = h * V::splat(bodies.factors[1] / bodies.factors[0]);
        let ((q, q_rest), (v, v_rest)) = (state.position(), state.velocity());
        let mut suspects = Bits(0);
        for pair in &mut self.pairs {
            let [i, j] = pair.rows;
            let (mut value, mut rate) = (-V::load(pair.square), V::zero());
            for c in 0..bodies.components {
                let next = c * (bodies.stride / WIDTH);
                let (i, j) = (i + next, j + next);
                let distance = (V::load(q[i]) - V::load(q[j])) + (V::load(q_rest[i]) - V::load(q_rest[j]));
                let velocity = (V::load(v[i]) - V::load(v[j])) + (V::load(v_rest[i]) - V::load(v_rest[j]));
                value = distance.multiply_add(distance, value);
                rate = (distance + distance).multiply_add(velocity, rate);
            }
            let before = [V::load(pair.value), V::load(pair.rate)];
            let clear = keeps_clear(cubic([before[0], value], [before[1], rate], h));
            suspects = suspects.or(clear.not());
            pair.value = V::select(lanes, value, before[0]).store();
            pair.rate = V::select(lanes, rate, before[1]).store();
        }
        suspects
    }
}
