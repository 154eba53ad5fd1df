//! Spheres that may touch in a step: which pairs, told from the boxes through which each body passes.
//!
//! The one idea: a sweep along one axis finds the pairs whose boxes meet, so that N bodies cost N log N and not N²; each of
//! these is then looked at as two bodies that come to the distance of their radii.

use super::super::super::collisions::{TOUCH, swept};
use super::super::super::events::{Event, Moving, What};
use super::super::super::frame::Moved;
use super::Watch;
use super::clear::{cubic, keeps_clear, keeps_clear_after_all};

/// Of more bodies a sweep along their boxes, step by step, takes less time than all pairs eight steps at a time.
const FEW: usize = 24;

/// A pair under watch in the step at hand: their places among the bodies that are looked at.
pub(super) struct Pair {
    pub(super) event: Event,
    pub(super) places: [usize; 2],
    /// What is added to its value: of spheres in contact at the start, so that it starts above zero.
    pub(super) shift: f64,
}

/// Spheres under watch.
pub(super) struct Contacts {
    /// Which event they are.
    pub(super) which: usize,
    /// Radius and index in the scene of each body, by its place.
    bodies: Vec<(f64, usize)>,
    /// Those that touched when this began, and what is added to their values.
    touching: Vec<([usize; 2], f64)>,
    /// Room for the boxes.
    boxes: Vec<[[f64; 2]; 3]>,
}

impl Contacts {
    /// Of the radii of all bodies and the pairs in contact, the indices of those that are looked at, and how they move at the
    /// start.
    pub(super) fn new(
        which: usize,
        (radius, touching): (&[f64], &[(usize, usize)]),
        indices: &[usize],
        before: &[Moving],
    ) -> Self {
        let radius = |&body: &usize| (radius[body], body);
        let mut contacts = Self {
            which,
            bodies: indices.iter().map(radius).collect(),
            touching: Vec::new(),
            boxes: Vec::new(),
        };
        for &(i, j) in touching {
            let place = |body: usize| indices.iter().position(|&own| own == body);
            if let (Some(i), Some(j)) = (place(i), place(j)) {
                let value = contacts.value([i, j], before);
                contacts.touching.push(([i, j], TOUCH - value));
            }
        }
        contacts
    }

    /// How many bodies there are, if they are few.
    pub(super) fn few(&self) -> Option<usize> {
        Some(self.bodies.len()).filter(|count| *count <= FEW)
    }

    /// All pairs, and the sums of their radii.
    pub(super) fn pairs_of_all(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        let pairs = (0..self.bodies.len()).flat_map(|j| (0..j).map(move |i| [i, j]));
        pairs.map(|[i, j]| ([i, j], self.bodies[i].0 + self.bodies[j].0))
    }

    fn event(&self, [i, j]: [usize; 2], forward: bool) -> Event {
        let (a, b) = (self.bodies[i], self.bodies[j]);
        let what = What::Distance { bodies: (a.1, b.1), length: a.0 + b.0 };
        // They come together along the run, whichever way that is in time.
        Event { what, direction: if forward { -1.0 } else { 1.0 }, last: None }
    }

    /// (d/R)² - 1.
    fn value(&self, places: [usize; 2], bodies: &[Moving]) -> f64 {
        let origin = super::super::super::frame::Moved::NOWHERE;
        self.event(places, true).sight_of(bodies, &places, &origin).value
    }

    /// The pairs that may touch in a step `h`, in the order of their indices.
    pub(super) fn pairs(&mut self, before: &[Moving], after: &[Moving], h: f64) -> Vec<Pair> {
        self.boxes.clear();
        for ((start, end), &(radius, _)) in before.iter().zip(after).zip(&self.bodies) {
            self.boxes.push(core::array::from_fn(|c| {
                let (x0, x1) = (start.position[c], end.position[c]);
                passed([x0, x1], [start.velocity[c], end.velocity[c]], h, radius)
            }));
        }
        let bodies = &self.bodies;
        let mut near: Vec<[usize; 2]> = Vec::new();
        swept(&self.boxes, |i| bodies[i].0 > 0.0, |i, j| near.push([i, j]));
        for pair in &mut near {
            pair.sort_by_key(|&place| bodies[place].1);
        }
        near.sort_by_key(|pair| pair.map(|place| bodies[place].1));
        let shift = |places: [usize; 2]| {
            let same = |other: &[usize; 2]| *other == places || *other == [places[1], places[0]];
            self.touching.iter().find(|(other, _)| same(other)).map_or(0.0, |(_, shift)| *shift)
        };
        let pair =
            |places: [usize; 2]| Pair { event: self.event(places, h >= 0.0), places, shift: shift(places) };
        near.into_iter().map(pair).collect()
    }

    /// Forgets the spheres that have come apart by the end of a step.
    pub(super) fn go_on(&mut self, after: &[Moving]) {
        let mut touching = core::mem::take(&mut self.touching);
        touching.retain(|&(places, _)| self.value(places, after) < APART);
        self.touching = touching;
    }
}

/// Spheres that are farther apart, relative to the sum of their radii and twice, touch no more.
const APART: f64 = 1.0 / (1_u64 << 30) as f64;

/// Between which numbers a coordinate is in a step, with the radius and what it may differ by from the cubic through its ends.
fn passed([x0, x1]: [f64; 2], [v0, v1]: [f64; 2], h: f64, radius: f64) -> [f64; 2] {
    let third = (x1 - x0) / 3.0;
    let (a, b) = (x0 + h * v0 / 3.0, x1 - h * v1 / 3.0);
    let bend = (a - x0 - third).abs().max((x1 - b - third).abs());
    let room = radius + bend + 4.0 * f64::EPSILON * x0.abs().max(x1.abs());
    let (low, high) = (x0.min(x1).min(a).min(b), x0.max(x1).max(a).max(b));
    [low - room, high + room]
}

impl Watch<'_> {
    /// Adds the pairs of spheres that may touch in a step `h`.
    pub(super) fn suspect_spheres(&mut self, h: f64) {
        let Some(contacts) = &mut self.contacts else { return };
        for pair in contacts.pairs(&self.before, &self.after, h) {
            let [start, end] = [&self.before, &self.after]
                .map(|bodies| pair.event.sight_of(bodies, &pair.places, &Moved::NOWHERE));
            let ends = [&start, &end];
            let clear = pair.event.rates(ends, h).is_some_and(|rates| {
                let cubic = cubic(ends.map(|end| end.value + pair.shift), rates, h);
                keeps_clear(cubic) || keeps_clear_after_all(cubic)
            });
            if !clear {
                self.suspects.push(self.events.len() + self.pairs.len());
                self.pairs.push(pair);
                self.sights.push(start);
                self.next.push(end);
            }
        }
        if self.pairs.is_empty() {
            contacts.go_on(&self.after);
        }
    }
}
