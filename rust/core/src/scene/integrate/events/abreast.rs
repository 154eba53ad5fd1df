//! Units side by side under watch: eight of them come to the end of a step in one pass, and only those in whose step there
//! may be zeros are looked at one by one.

use super::super::super::events::{Event, Moving, Sight};
use super::clear::{cubic, keeps_clear};
use super::expressions_in_lanes::ExpressionAbreast;
use super::spheres_abreast::SpheresAbreast;
use super::{Bodies, Watch};
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Mask;
use crate::ode::state::State;
use crate::scene::frame::Moved;
use crate::scene::unit::Prepared;
use crate::tiered;

/// The events of eight units of one make-up, one in each lane. Those of the first are told side by side.
pub(in super::super) struct Abreast<'a> {
    events: Vec<Seen<'a>>,
    expressions: Vec<ExpressionAbreast>,
    /// Whether any event asks where a body is in the scene.
    asks_where: bool,
    /// The spheres that may touch.
    spheres: Option<SpheresAbreast>,
    bodies: Bodies,
    /// What each event saw at the last node.
    sights: Vec<Sight<Lanes>>,
    /// The lanes whose units have seen nothing yet.
    fresh: Bits,
    /// The lanes that are always looked at one by one: whose units have other events, bodies on which nothing acts together
    /// being alike without that, or whose origin is elsewhere where an event asks where a body is.
    one_by_one: Bits,
    /// Which events these are, and their bodies.
    watched: Vec<(usize, Vec<usize>)>,
}

/// An event, and where its bodies lie: the first coordinate of each among those of a state.
struct Seen<'a> {
    event: &'a Event,
    places: [usize; 2],
}

impl<'a> Abreast<'a> {
    /// For units like the one under this watch, if what their events see can be told side by side.
    pub(in super::super) fn of(watch: &Watch<'a>) -> Option<Self> {
        let spheres = match &watch.contacts {
            Some(contacts) => Some(SpheresAbreast::of(contacts, &watch.bodies)?),
            None => None,
        };
        let mut events = Vec::with_capacity(watch.events.len());
        let (mut expressions, mut asks_where) = (Vec::new(), false);
        for index in 0..watch.events.len() {
            let (event, bodies) = watch.own_event(index);
            asks_where |= event.asks_where();
            if let Some(expression) = ExpressionAbreast::of(event, bodies, &watch.bodies) {
                expressions.push(expression);
                continue;
            }
            let (&first, &last) = (bodies.first()?, bodies.last()?);
            if !event.has_rates() {
                return None;
            }
            events.push(Seen { event, places: [first, last].map(|body| watch.bodies.row(body)) });
        }
        let sights = vec![Sight::default(); events.len()];
        let (bodies, watched) = (watch.bodies.clone(), watch.events.clone());
        Some(Self {
            events,
            expressions,
            asks_where,
            spheres,
            bodies,
            sights,
            fresh: Bits(0),
            one_by_one: Bits(0xff),
            watched,
        })
    }

    /// A unit begins in a lane.
    pub(in super::super) fn begin(&mut self, lane: usize, unit: &Prepared, watch: &Watch<'_>) {
        let bit = Bits(1 << (lane % WIDTH));
        self.fresh = self.fresh.or(bit);
        self.one_by_one = self.one_by_one.and(bit.not());
        if let (Some(spheres), Some(contacts)) = (&mut self.spheres, &watch.contacts) {
            spheres.begin(lane, contacts, watch.bodies.factors[0]);
        }
        let moved = unit.origin.is_elsewhere() && self.asks_where;
        if moved || watch.events != self.watched {
            self.one_by_one = self.one_by_one.or(bit);
        }
    }

    /// Lanes come to the end of a step `h` (in the scene's units): those whose units must be looked at, and those whose
    /// watches are at the beginning of the step.
    pub(in super::super) fn step(&mut self, lanes: Bits, h: &Lanes, state: &State<Lanes>) -> [Bits; 2] {
        let fresh = self.fresh.and(lanes);
        self.fresh = self.fresh.and(lanes.not());
        let mut suspects = suspects(self, lanes, h, state);
        for expression in &mut self.expressions {
            suspects = suspects.or(expression.suspects(lanes, h, &self.bodies, state));
        }
        // Those that are looked at on every step have seen every node.
        [suspects.or(fresh).or(self.one_by_one).and(lanes), fresh.or(self.one_by_one)]
    }
}

tiered! {
    fn suspects[][](abreast: &mut Abreast<'_>, lanes: Bits, h: &Lanes, state: &State<Lanes>) -> Bits = step_of_eight;
}

#[inline(always)]
fn step_of_eight<V: Vector8>(
    abreast: &mut Abreast<'_>,
    lanes: Bits,
    h: &Lanes,
    state: &State<Lanes>,
) -> Bits {
    let Abreast { events, spheres, bodies, sights, .. } = abreast;
    let mut suspects = match spheres {
        Some(spheres) => spheres.suspects(lanes, V::load(*h), bodies, state),
        None => Bits(0),
    };
    for index in 0..events.len() {
        let Seen { event, places } = &events[index];
        let both = [moving::<V>(bodies, places[0], state), moving::<V>(bodies, places[1], state)];
        let after = event.sight_of(&both, &[0, 1], &Moved::NOWHERE);
        let before = load::<V>(&sights[index]);
        let clear = match event.rates([&before, &after], V::load(*h)) {
            Some(rates) => keeps_clear(cubic([before.value, after.value], rates, V::load(*h))),
            None => Bits(0),
        };
        suspects = suspects.or(clear.not());
        store(after.or(lanes, &before), &mut sights[index]);
    }
    suspects
}

/// A body in every lane, from its first coordinate on.
#[inline(always)]
fn moving<V: Vector8>(bodies: &Bodies, place: usize, state: &State<Lanes>) -> Moving<V> {
    let [length, speed] = [V::splat(bodies.factors[0]), V::splat(bodies.factors[1])];
    let ((q, q_rest), (v, v_rest)) = (state.position(), state.velocity());
    let mut moving = Moving::default();
    for c in 0..bodies.components {
        let at = place + c * (bodies.stride / WIDTH);
        moving.position[c] = V::load(q[at]) * length;
        moving.position_rest[c] = V::load(q_rest[at]) * length;
        moving.velocity[c] = V::load(v[at]) * speed;
        moving.velocity_rest[c] = V::load(v_rest[at]) * speed;
    }
    moving
}

#[inline(always)]
fn load<V: Vector8>(sight: &Sight<Lanes>) -> Sight<V> {
    let mut loaded = Sight { value: V::load(sight.value), ..Sight::default() };
    for c in 0..3 {
        loaded.distance[c] = V::load(sight.distance[c]);
        loaded.velocity[c] = V::load(sight.velocity[c]);
    }
    loaded
}

#[inline(always)]
fn store<V: Vector8>(sight: Sight<V>, into: &mut Sight<Lanes>) {
    into.value = sight.value.store();
    for c in 0..3 {
        into.distance[c] = sight.distance[c].store();
        into.velocity[c] = sight.velocity[c].store();
    }
}
