//! One unit under watch along its steps: eight of them are come to the end of in one pass, and only those in which there may be
//! zeros are looked into.

use super::super::super::events::{Event, Moving, Sight};
use super::super::super::unit::Prepared;
use super::clear::{cubic, keeps_clear, keeps_clear_after_all};
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
    /// Where each of their coordinates lies among the numbers of a state.
    coordinates: Vec<usize>,
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
        let coordinates: Vec<usize> = bodies.coordinates().collect();
        let numbers = vec![[[0.0; WIDTH + 1]; 4]; coordinates.len()];
        Some(Self { events, bodies, coordinates, numbers })
    }

    /// Takes note of where the bodies are at a node.
    #[inline(always)]
    pub(in super::super) fn note(&mut self, node: usize, state: &State<Lanes>) {
        let ((q, q_rest), (v, v_rest)) = (state.position(), state.velocity());
        let [q, q_rest, v, v_rest] = [as_numbers(q), as_numbers(q_rest), as_numbers(v), as_numbers(v_rest)];
        // All of one length, to be looked at once.
        let (q_rest, v, v_rest) = (&q_rest[..q.len()], &v[..q.len()], &v_rest[..q.len()]);
        for (numbers, &at) in self.numbers.iter_mut().zip(&self.coordinates) {
            numbers[0][node] = q[at];
            numbers[1][node] = q_rest[at];
            numbers[2][node] = v[at];
            numbers[3][node] = v_rest[at];
        }
    }

    /// The steps `h` (in the scene's units), so many, in which there may be zeros.
    pub(in super::super) fn suspects(&self, steps: usize, h: f64) -> Bits {
        let mut suspects = Bits(0);
        let mut cubics = [Lanes([0.0; WIDTH]); 4];
        for index in 0..self.events.len() {
            let near = near(self, index, h, &mut cubics);
            // Lanes beyond the last step hold others of before.
            for step in (0..steps).filter(|&step| near.lane(step)) {
                if !keeps_clear_after_all(cubics.map(|lanes| lanes.0[step])) {
                    suspects = suspects.or(Bits(1 << step));
                }
            }
        }
        suspects
    }
}

tiered! {
    fn near[][](along: &Along<'_>, event: usize, h: f64, cubics: &mut [Lanes; 4]) -> Bits = eight_steps;
}

/// The steps in which an event may be near zero, and the cubics through their ends.
#[inline(always)]
fn eight_steps<V: Vector8>(along: &Along<'_>, event: usize, h: f64, cubics: &mut [Lanes; 4]) -> Bits {
    let (event, places) = &along.events[event];
    let mut ends = [Sight::<V>::default(), Sight::default()];
    for (end, sight) in ends.iter_mut().enumerate() {
        let both = [moving::<V>(along, places[0], end), moving::<V>(along, places[1], end)];
        *sight = event.sight_of(&both, &[0, 1], &Moved::NOWHERE);
    }
    let [before, after] = &ends;
    let Some(rates) = event.rates([before, after], V::splat(h)) else { return Bits(0xff) };
    let coefficients = cubic([before.value, after.value], rates, V::splat(h));
    let near = keeps_clear(coefficients).not();
    if near.any() {
        for (into, lanes) in cubics.iter_mut().zip(coefficients) {
            *into = lanes.store();
        }
    }
    near
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
