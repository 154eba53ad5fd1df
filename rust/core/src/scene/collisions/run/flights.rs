//! Spheres on which no force acts: straight lines from one contact to the next, whose time is known.
//!
//! The one idea: each body keeps the first contact that it will have if nobody disturbs it. A collision changes the
//! velocities of a few, so that only what these will meet is to be found anew: N bodies cost N for each collision.
//! B. J. Alder and T. E. Wainwright, J. Chem. Phys. 31 (1959) 459.

use super::super::{CONTACT, Impact, TOUCH, swept};
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, scale};
use crate::parallel::Ticker;

/// Pairs that are looked at between two questions whether to go on.
const PER_TICK: usize = 1024;

/// Places that are farther apart than so many powers of two times the radii are told in a unit between both.
const WIDE: i32 = 400;

/// The longest span, in units in which speeds are about 1: what is beyond is beyond all numbers.
const LONGEST: f64 = 1e290;

/// Squares of speeds below which nothing is left of their products with squares of small radii.
const SLOW: f64 = 1e-200;
/// By which such speeds are multiplied.
const HASTE: i32 = 500;

/// A body on its way, in the units of its flight.
#[derive(Clone, Copy)]
struct Body {
    /// Its index in the scene.
    index: usize,
    /// NaN for one that is a part of another: it meets nobody.
    radius: f64,
    /// Where it is now.
    position: [f64; 3],
    /// How fast it goes along the run, whichever way that is in time.
    velocity: [f64; 3],
    /// Where it was disturbed last, and when: what is computed from there gathers no rounding on the way.
    from: [f64; 3],
    since: DoubleDouble,
}

/// The first contact of a body.
#[derive(Clone, Copy)]
struct Next {
    /// When.
    at: DoubleDouble,
    /// When it is a contact for all that rounding can tell.
    near: DoubleDouble,
    /// The place of the other.
    other: usize,
}

const NEVER: DoubleDouble = DoubleDouble::new(f64::INFINITY, 0.0);

impl Next {
    const NONE: Self = Self { at: NEVER, near: NEVER, other: usize::MAX };
}

/// Bodies on their way.
pub(super) struct Flights {
    /// Spheres first, points after them.
    bodies: Vec<Body>,
    spheres: usize,
    next: Vec<Next>,
    /// How long after the start, along the run.
    now: DoubleDouble,
    direction: f64,
    /// The exponents of two of a length and of a time, in those of the scene.
    units: (i32, i32),
}

impl Flights {
    /// Bodies at a time after the start of the run, of which the contacts within a span are wanted.
    pub(super) fn new(
        impact: &Impact,
        (elapsed, span): (DoubleDouble, f64),
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let largest =
            |of: &mut dyn Iterator<Item = &f64>| exponent(of.fold(0.0, |most, x| x.abs().max(most)));
        let (radius, far) =
            (largest(&mut impact.radius.iter()), largest(&mut impact.position.iter().flatten()));
        // Squares of both stay within the range of numbers.
        let length = if far - radius > WIDE { radius + (far - radius) / 2 } else { radius };
        let speed = largest(&mut impact.velocity.iter().flatten());
        let mut order: Vec<usize> =
            (0..impact.mass.len()).filter(|&body| impact.host[body] == body).collect();
        order.sort_by_key(|&body| impact.radius[body] <= 0.0);
        let mut flights = Self {
            bodies: Vec::with_capacity(order.len()),
            spheres: order.iter().filter(|&&body| impact.radius[body] > 0.0).count(),
            next: vec![Next::NONE; order.len()],
            now: DoubleDouble::from(0.0),
            direction: impact.direction,
            units: (length, length - speed),
        };
        flights.now = flights.time(elapsed);
        for index in order {
            let body = flights.body(impact, index);
            flights.bodies.push(body);
        }
        flights.look_at_all(scale(span, -flights.units.1).min(LONGEST), ticker)?;
        Ok(flights)
    }

    fn time(&self, elapsed: DoubleDouble) -> DoubleDouble {
        scaled(elapsed, -self.units.1)
    }

    fn body(&self, impact: &Impact, index: usize) -> Body {
        let (length, time) = self.units;
        let position = impact.position[index].map(|x| scale(x, -length));
        Body {
            index,
            radius: if impact.host[index] == index { scale(impact.radius[index], -length) } else { f64::NAN },
            position,
            velocity: impact.velocity[index].map(|v| self.direction * scale(v, time - length)),
            from: position,
            since: self.now,
        }
    }

    /// The first contact of all, how long after the start it is and whose.
    pub(super) fn first(&self) -> Option<(DoubleDouble, (usize, usize))> {
        let pair = |(place, next): (usize, &Next)| {
            let (i, j) = (self.bodies[place].index, self.bodies[next.other].index);
            (next.at, (i.min(j), i.max(j)))
        };
        let some = self.next.iter().enumerate().filter(|(_, next)| next.other != usize::MAX).map(pair);
        let first = some.reduce(|first, other| {
            let sooner = other.0 < first.0 || (other.0 == first.0 && other.1 < first.1);
            if sooner { other } else { first }
        });
        first.map(|(at, pair)| (scaled(at, self.units.1), pair))
    }

    /// All go on to a time after the start.
    pub(super) fn go_to(&mut self, elapsed: DoubleDouble, impact: &mut Impact) {
        self.now = self.time(elapsed);
        for body in self.bodies.iter_mut().filter(|body| !body.radius.is_nan()) {
            let after = (self.now - body.since).to_f64();
            for c in 0..3 {
                body.position[c] = body.from[c] + body.velocity[c] * after;
            }
            impact.position[body.index] = body.position.map(|x| scale(x, self.units.0));
        }
        impact.follow();
    }

    /// The pairs in contact of those that meet now, and of those that they touch, and so on.
    pub(super) fn touching(&self, impact: &Impact) -> Vec<(usize, usize)> {
        let mut met: Vec<bool> = self.next.iter().map(|next| next.near <= self.now).collect();
        let mut places: Vec<usize> = (0..met.len()).filter(|&place| met[place]).collect();
        let mut pairs = Vec::new();
        while let Some(place) = places.pop() {
            let own = self.bodies[place].index;
            for other in self.others(place) {
                if !near(&self.bodies[place], &self.bodies[other]) {
                    continue;
                }
                let index = self.bodies[other].index;
                let pair = (own.min(index), own.max(index));
                if index != own && impact.is_whole(pair) && impact.is_contact(pair) {
                    pairs.push(pair);
                    if !core::mem::replace(&mut met[other], true) {
                        places.push(other);
                    }
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// The places of those that a body may meet: points meet no points.
    fn others(&self, place: usize) -> core::ops::Range<usize> {
        if place < self.spheres { 0..self.bodies.len() } else { 0..self.spheres }
    }

    /// Takes in what a collision now has made of the bodies.
    pub(super) fn disturb(&mut self, impact: &Impact, ticker: &mut Ticker<'_>) -> Result<()> {
        let mut lost = vec![false; self.bodies.len()];
        for place in 0..self.bodies.len() {
            let old = self.bodies[place];
            let new = self.body(impact, old.index);
            let same =
                new.position == old.position && new.velocity == old.velocity && new.radius == old.radius;
            if !same && !old.radius.is_nan() {
                self.bodies[place] = new;
                lost[place] = true;
            }
        }
        let disturbed = lost.clone();
        for (place, next) in self.next.iter().enumerate() {
            // Those that were in contact have been settled, whether or not that has changed anything.
            let settled = next.near <= self.now;
            lost[place] |= settled || disturbed.get(next.other).is_some_and(|&disturbed| disturbed);
        }
        for place in (0..lost.len()).filter(|&place| lost[place]) {
            ticker.tick()?;
            self.next[place] = Next::NONE;
            for other in self.others(place).filter(|&other| other != place) {
                self.look_at(place, other);
            }
        }
        Ok(())
    }

    /// Finds the first contacts of all bodies within a span.
    fn look_at_all(&mut self, span: f64, ticker: &mut Ticker<'_>) -> Result<()> {
        let passed = |body: &Body| -> [[f64; 2]; 3] {
            core::array::from_fn(|c| {
                let (x, by) = (body.position[c], body.velocity[c] * span);
                let room = body.radius * (1.0 + CONTACT) + 64.0 * f64::EPSILON * (x.abs() + by.abs());
                [x.min(x + by) - room, x.max(x + by) + room]
            })
        };
        let boxes: Vec<_> = self.bodies.iter().map(passed).collect();
        let spheres = self.spheres;
        let mut goes_on = Ok(());
        let mut looked = 0;
        swept(
            &boxes,
            |place| place < spheres,
            |i, j| {
                looked += 1;
                if looked % PER_TICK == 0 && goes_on.is_ok() {
                    goes_on = ticker.tick();
                }
                if goes_on.is_ok() {
                    self.look_at(i, j);
                }
            },
        );
        goes_on
    }

    /// Keeps the contact of two, if it is the first of either.
    fn look_at(&mut self, i: usize, j: usize) {
        let Some([near, at]) = meet(&self.bodies[i], &self.bodies[j]) else { return };
        let [near, at] = [near, at].map(|after| self.now + DoubleDouble::from(after));
        for (place, other) in [(i, j), (j, i)] {
            if at < self.next[place].at {
                self.next[place] = Next { at, near, other };
            }
        }
    }
}

fn scaled(time: DoubleDouble, exponent: i32) -> DoubleDouble {
    DoubleDouble::new(scale(time.high(), exponent), scale(time.low(), exponent))
}

/// What two are farther apart than their radii, squared, if they are in contact for all that rounding of places can tell; and
/// what rounding it is.
fn contact(a: &Body, b: &Body) -> (f64, f64) {
    let far = a.position.iter().chain(&b.position).fold(0.0_f64, |far, x| far.max(x.abs()));
    let radius = a.radius + b.radius;
    let rounding = radius * (64.0 * f64::EPSILON * far);
    (radius * radius * (2.0 * CONTACT) + rounding, rounding.max(radius * radius * TOUCH))
}

/// Whether two may be in contact: most are far from it, and told at once.
fn near(a: &Body, b: &Body) -> bool {
    let square: f64 = a.position.iter().zip(&b.position).map(|(a, b)| (a - b) * (a - b)).sum();
    let radius = a.radius + b.radius;
    square - radius * radius <= contact(a, b).0
}

/// How long it takes until two are in contact for all that rounding can tell, and until they touch, if they will: the
/// first root of |d + w t| = R. Spheres in contact that approach must come some roundings nearer before they touch again.
fn meet(a: &Body, b: &Body) -> Option<[f64; 2]> {
    let apart: [f64; 3] = core::array::from_fn(|c| b.position[c] - a.position[c]);
    let mut faster: [f64; 3] = core::array::from_fn(|c| b.velocity[c] - a.velocity[c]);
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    if dot(&apart, &faster) >= 0.0 {
        return None;
    }
    let mut hasted = 0;
    if dot(&faster, &faster) < SLOW {
        faster = faster.map(|w| scale(w, HASTE));
        hasted = HASTE;
    }
    let square = (a.radius + b.radius) * (a.radius + b.radius);
    let (approach, speed) = (-dot(&apart, &faster), dot(&faster, &faster));
    let left = dot(&apart, &apart) - square;
    let (in_contact, least) = contact(a, b);
    if left <= in_contact {
        // b² - w² c: they come nearer by so much, if they do at all.
        let discriminant = approach * approach - speed * least;
        let at = (discriminant >= 0.0).then(|| least / (approach + discriminant.sqrt()))?;
        return Some([0.0, at].map(|after| scale(after, hasted)));
    }
    // R²w² - |d × w|²: without the squares of distances, which cancel.
    let moment: [f64; 3] = core::array::from_fn(|c| {
        let (c1, c2) = ((c + 1) % 3, (c + 2) % 3);
        apart[c1] * faster[c2] - apart[c2] * faster[c1]
    });
    let moment = dot(&moment, &moment);
    let after = |square: f64| {
        let discriminant = square * speed - moment;
        let left = dot(&apart, &apart) - square;
        (discriminant >= 0.0).then(|| left / (approach + discriminant.sqrt()))
    };
    let at = after(square)?;
    let near = after(square * (1.0 + CONTACT)).map_or(at, |near| near.max(0.0).min(at));
    Some([near, at].map(|after| scale(after, hasted)))
}
