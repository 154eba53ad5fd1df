//! One unit under watch along its steps: eight of them are come to the end of in one pass, and only those in which there may be
//! zeros are looked into.

use super::super::super::events::{Event, Sight};
use super::super::super::unit::Prepared;
use super::clear::{cubic, keeps_clear, keeps_clear_after_all};
use super::expressions_in_lanes::ExpressionAlong;
use super::spheres::{Spheres, eight};
use super::{Bodies, Watch};
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Mask;
use crate::ode::state::State;
use crate::scene::frame::{Moved, Origin};
use crate::tiered;

/// The events of a unit, and what they are functions of at nine nodes: steps lie in the lanes.
pub(in super::super) struct Along<'a> {
    events: Vec<Seen<'a>>,
    expressions: Vec<ExpressionAlong>,
    /// The spheres that may touch.
    spheres: Option<Spheres>,
    bodies: Bodies,
    /// A step, in the plan's units.
    step: f64,
    unit_of_time: i32,
}

/// An event along the steps.
struct Seen<'a> {
    event: &'a Event,
    /// Its bodies, among those that are looked at.
    bodies: [usize; 2],
    /// Its distance vector and its velocity, node after node.
    vectors: [[[f64; WIDTH + 1]; 3]; 2],
    /// Whether it looks at where a body is in the scene.
    asks_where: bool,
}

impl Seen<'_> {
    /// A function of its own: the room that it takes would burden the others.
    #[inline(never)]
    fn note_where(
        &mut self,
        place: usize,
        (origin, step, node, unit_of_time): (&Origin, f64, u64, i32),
        bodies: &Bodies,
        state: &State<Lanes>,
    ) {
        let origin = origin.at(scale(step * node as f64, unit_of_time));
        let body = bodies.one(self.bodies[0], state);
        for (vectors, numbers) in self.vectors.iter_mut().zip(self.event.vectors([&body, &body], &origin)) {
            for (vector, number) in vectors.iter_mut().zip(numbers) {
                vector[place] = number;
            }
        }
    }
}

impl<'a> Along<'a> {
    /// Of a unit under this watch, if what its events see follows from how its bodies move.
    pub(in super::super) fn of(watch: &Watch<'a>, step: f64) -> Option<Self> {
        let spheres = match &watch.contacts {
            Some(contacts) => Some(Spheres::of(contacts, watch.bodies.factors[0])?),
            None => None,
        };
        let mut events = Vec::with_capacity(watch.events.len());
        let mut expressions = Vec::new();
        for index in 0..watch.events.len() {
            let (event, bodies) = watch.own_event(index);
            if let Some(expression) = ExpressionAlong::of(event, bodies) {
                expressions.push(expression);
                continue;
            }
            if !event.has_rates() {
                return None;
            }
            let bodies = [*bodies.first()?, *bodies.last()?];
            let vectors = [[[0.0; WIDTH + 1]; 3]; 2];
            events.push(Seen { event, bodies, vectors, asks_where: event.asks_where() });
        }
        let unit_of_time = watch.job.plan.units.time;
        Some(Self { events, expressions, spheres, bodies: watch.bodies.clone(), step, unit_of_time })
    }

    /// Takes note in one of nine places of how the bodies move at a node, to which so many steps have led.
    #[inline(always)]
    pub(in super::super) fn note(&mut self, place: usize, unit: &Prepared, node: u64, state: &State<Lanes>) {
        if let Some(spheres) = &mut self.spheres {
            spheres.note(place, &self.bodies, state);
        }
        if !self.expressions.is_empty() {
            self.note_expressions(place, unit, node, state);
        }
        for seen in &mut self.events {
            if seen.asks_where {
                seen.note_where(
                    place,
                    (&unit.origin, self.step, node, self.unit_of_time),
                    &self.bodies,
                    state,
                );
                continue;
            }
            let [distances, velocities] = &mut seen.vectors;
            self.bodies.apart(seen.bodies, state, |c, [distance, velocity]| {
                (distances[c][place], velocities[c][place]) = (distance, velocity);
            });
        }
    }

    /// A function of its own, as [`Seen::note_where`].
    #[inline(never)]
    fn note_expressions(&mut self, place: usize, unit: &Prepared, node: u64, state: &State<Lanes>) {
        for expression in &mut self.expressions {
            let origin = if expression.asks_where {
                unit.origin.at(scale(self.step * node as f64, self.unit_of_time))
            } else {
                Moved::NOWHERE
            };
            expression.note(place, &origin, &self.bodies, state);
        }
    }

    /// The steps, of so many between those nodes, in which there may be zeros.
    pub(in super::super) fn suspects(&mut self, steps: usize) -> Bits {
        let h = scale(self.step, self.unit_of_time);
        let mut suspects = self.spheres.as_ref().map_or(Bits(0), |spheres| spheres.suspects(self.step));
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
        for expression in &mut self.expressions {
            suspects = suspects.or(expression.suspects(steps, h));
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
    let Seen { event, vectors, .. } = &along.events[event];
    let mut ends = [Sight::<V>::default(), Sight::default()];
    for (end, sight) in ends.iter_mut().enumerate() {
        let mut at_end = [[V::zero(); 3]; 2];
        for (into, numbers) in at_end.iter_mut().flatten().zip(vectors.iter().flatten()) {
            *into = eight(numbers, end);
        }
        *sight = event.seen(at_end);
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
