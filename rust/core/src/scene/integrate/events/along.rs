//! One unit under watch along its steps: eight of them are come to the end of in one pass, and only those in which there may be
//! zeros are looked into.

use super::super::super::events::{Event, Moving, Sight};
use super::super::super::unit::Prepared;
use super::clear::{cubic, keeps_clear};
use super::{Bodies, Watch};
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers};
use crate::numerics::real::Mask;
use crate::ode::state::State;
use crate::scene::frame::Moved;
use crate::tiered;

/// The events of a unit and where its bodies are at nine nodes: steps lie in the lanes.
pub(in super::super) struct Along<'a> {
    /// Each with the places of its bodies.
    events: Vec<(&'a Event, [usize; 2])>,
    bodies: Bodies,
    /// Position, what it leaves out, velocity and what that leaves out, coordinate after coordinate, node after node.
    numbers: Vec<[[f64; WIDTH + 1]; 4]>,
}

impl<'a> Along<'a> {
    /// Of a unit under this watch, if what its events see follows from how its bodies move.
    pub(in super::super) fn of(watch: &Watch<'a>, unit: &Prepared) -> Option<Self> {
        let mut events = Vec::with_capacity(watch.events.len());
        for index in 0..watch.events.len() {
            let (event, bodies) = watch.event(index);
            if !event.has_rates() || (event.asks_where() && unit.origin.is_elsewhere()) {
                return None;
            }
            events.push((event, [*bodies.first()?, *bodies.last()?]));
        }
        let bodies = watch.bodies.clone();
        let numbers = vec![[[0.0; WIDTH + 1]; 4]; bodies.coordinates().count()];
        Some(Self { events, bodies, numbers })
    }

    /// The steps `h` (in the scene's units) between successive nodes in which there may be zeros.
    pub(in super::super) fn suspects(&mut self, nodes: &[State<Lanes>], h: f64) -> Bits {
        for (node, state) in nodes.iter().enumerate() {
            let ((q, q_rest), (v, v_rest)) = (state.position(), state.velocity());
            let [q, q_rest, v, v_rest] = [q, q_rest, v, v_rest].map(as_numbers);
            for (numbers, at) in self.numbers.iter_mut().zip(self.bodies.coordinates()) {
                numbers[0][node] = q[at];
                numbers[1][node] = q_rest[at];
                numbers[2][node] = v[at];
                numbers[3][node] = v_rest[at];
            }
        }
        // Lanes beyond the last step hold others of before.
        let taken = (1_u16 << (nodes.len() - 1)) - 1;
        suspects(self, h).and(Bits(taken as u8))
    }
}

tiered! {
    fn suspects[][](along: &Along<'_>, h: f64) -> Bits = eight_steps;
}

#[inline(always)]
fn eight_steps<V: Vector8>(along: &Along<'_>, h: f64) -> Bits {
    let mut suspects = Bits(0);
    for (event, places) in &along.events {
        let mut ends = [Sight::<V>::default(), Sight::default()];
        for (end, sight) in ends.iter_mut().enumerate() {
            let both = [moving::<V>(along, places[0], end), moving::<V>(along, places[1], end)];
            *sight = event.sight_of(&both, &[0, 1], &Moved::NOWHERE);
        }
        let [before, after] = &ends;
        let clear = match event.rates([before, after], V::splat(h)) {
            Some(rates) => keeps_clear(cubic([before.value, after.value], rates, V::splat(h))),
            None => Bits(0),
        };
        suspects = suspects.or(clear.not());
    }
    suspects
}

/// A body at the beginnings of the steps (0) or at their ends (1).
#[inline(always)]
fn moving<V: Vector8>(along: &Along<'_>, body: usize, end: usize) -> Moving<V> {
    let Along { bodies, numbers, .. } = along;
    let [length, speed] = [V::splat(bodies.factors[0]), V::splat(bodies.factors[1])];
    let mut moving = Moving::default();
    for c in 0..bodies.components {
        let of = &numbers[body * bodies.components + c];
        moving.position[c] = eight::<V>(&of[0], end) * length;
        moving.position_rest[c] = eight::<V>(&of[1], end) * length;
        moving.velocity[c] = eight::<V>(&of[2], end) * speed;
        moving.velocity_rest[c] = eight::<V>(&of[3], end) * speed;
    }
    moving
}

/// The numbers of eight nodes, from the first or from the second on.
#[inline(always)]
fn eight<V: Vector8>(numbers: &[f64; WIDTH + 1], from: usize) -> V {
    let mut lanes = [0.0; WIDTH];
    lanes.copy_from_slice(&numbers[from..from + WIDTH]);
    V::load(Lanes(lanes))
}
