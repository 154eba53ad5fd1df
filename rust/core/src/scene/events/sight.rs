//! What events see of bodies: a value and its rate, of one unit or of eight side by side.
//!
//! The one idea: written once, over the scalar, so that a unit in a lane sees what it sees alone, to the bit.

use super::super::frame::{Moved, restored};
use super::{Event, Focus, What};
use crate::numerics::real::Real;

/// How a body moves about the origin of its unit, in the scene's units.
#[derive(Clone, Copy, Debug)]
pub struct Moving<S = f64> {
    /// Its position.
    pub position: [S; 3],
    /// What that leaves out.
    pub position_rest: [S; 3],
    /// Its velocity.
    pub velocity: [S; 3],
    /// What that leaves out.
    pub velocity_rest: [S; 3],
}

impl<S: Real> Default for Moving<S> {
    #[inline(always)]
    fn default() -> Self {
        let zero = [S::zero(); 3];
        Self { position: zero, position_rest: zero, velocity: zero, velocity_rest: zero }
    }
}

/// What an event sees of the bodies at one time.
#[derive(Clone, Copy, Debug)]
pub struct Sight<S = f64> {
    /// Its value.
    pub value: S,
    /// The distance vector and the velocity that it is a function of, if it is; of two bodies that come to a distance, as
    /// parts of it.
    pub distance: [S; 3],
    /// The same.
    pub velocity: [S; 3],
}

impl<S: Real> Default for Sight<S> {
    #[inline(always)]
    fn default() -> Self {
        Self { value: S::zero(), distance: [S::zero(); 3], velocity: [S::zero(); 3] }
    }
}

impl<S: Real> Sight<S> {
    /// This where the mask holds, else another.
    #[inline(always)]
    #[must_use]
    pub fn or(&self, mask: S::Mask, other: &Self) -> Self {
        let mut sight = *self;
        sight.value = S::select(mask, self.value, other.value);
        for c in 0..3 {
            sight.distance[c] = S::select(mask, self.distance[c], other.distance[c]);
            sight.velocity[c] = S::select(mask, self.velocity[c], other.velocity[c]);
        }
        sight
    }
}

// No closures here: vectors of a SIMD tier come by.

#[inline(always)]
pub(crate) fn dot<S: Real>(a: [S; 3], b: [S; 3]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn splat<S: Real>(x: [f64; 3]) -> [S; 3] {
    [S::splat(x[0]), S::splat(x[1]), S::splat(x[2])]
}

/// How far numbers are apart, each with what it leaves out.
#[inline(always)]
pub fn apart<S: Real>(a: (S, S), b: (S, S)) -> S {
    (a.0 - b.0) + (a.1 - b.1)
}

/// Distance vector and relative velocity of two bodies.
#[inline(always)]
fn relative<S: Real>(a: &Moving<S>, b: &Moving<S>) -> [[S; 3]; 2] {
    let [mut distance, mut velocity] = [[S::zero(); 3]; 2];
    for c in 0..3 {
        distance[c] = apart((a.position[c], a.position_rest[c]), (b.position[c], b.position_rest[c]));
        velocity[c] = apart((a.velocity[c], a.velocity_rest[c]), (b.velocity[c], b.velocity_rest[c]));
    }
    [distance, velocity]
}

/// Distance vector from a point at rest, and velocity.
#[inline(always)]
fn about_point<S: Real>(body: &Moving<S>, point: [f64; 3], origin: &Moved) -> [[S; 3]; 2] {
    let [mut distance, mut velocity] = [[S::zero(); 3]; 2];
    for c in 0..3 {
        let [place, speed] = [origin.position[c], origin.velocity[c]];
        let [place, speed] = [(S::splat(place.0), S::splat(place.1)), (S::splat(speed.0), S::splat(speed.1))];
        let x = restored(place, (body.position[c], body.position_rest[c]));
        let v = restored(speed, (body.velocity[c], body.velocity_rest[c]));
        distance[c] = (x.0 - S::splat(point[c])) + x.1;
        velocity[c] = v.0 + v.1;
    }
    [distance, velocity]
}

impl Event {
    /// Whether it looks at where a body is in the scene, and not by another body.
    pub fn asks_where(&self) -> bool {
        match &self.what {
            What::Expression(expression) => expression.asks_where(),
            what => matches!(what, What::Plane { .. } | What::Apsis { about: Focus::Point(_), .. }),
        }
    }

    /// Whether its rate follows from what it sees.
    pub fn has_rates(&self) -> bool {
        matches!(self.what, What::Distance { .. } | What::Plane { .. } | What::Apsis { .. })
    }

    /// What it sees of bodies that move about this origin; nothing if it looks at whole states.
    #[inline(always)]
    pub fn sight_of<S: Real>(&self, bodies: &[Moving<S>], places: &[usize], origin: &Moved) -> Sight<S> {
        if self.has_rates() {
            // A single body is the first and the last.
            let [first, last] = [places[0], places[places.len() - 1]];
            self.seen(self.vectors([&bodies[first], &bodies[last]], origin))
        } else {
            Sight::default()
        }
    }

    /// The distance vector and the velocity that it is a function of, of the body or the two that it looks at.
    #[inline(always)]
    pub fn vectors<S: Real>(&self, [first, last]: [&Moving<S>; 2], origin: &Moved) -> [[S; 3]; 2] {
        match &self.what {
            What::Plane { point, .. } | What::Apsis { about: Focus::Point(point), .. } => {
                about_point(first, *point, origin)
            }
            _ => relative(first, last),
        }
    }

    /// What it sees, from those vectors.
    #[inline(always)]
    pub fn seen<S: Real>(&self, [mut distance, mut velocity]: [[S; 3]; 2]) -> Sight<S> {
        let value = match &self.what {
            What::Distance { length, .. } => {
                let length = S::splat(*length);
                for c in 0..3 {
                    (distance[c], velocity[c]) = (distance[c] / length, velocity[c] / length);
                }
                // A parabola in time for bodies that move uniformly: a short approach on a long step is not lost.
                dot(distance, distance) - S::one()
            }
            What::Plane { normal, .. } => dot(splat(*normal), distance),
            _ => dot(distance, velocity),
        };
        Sight { value, distance, velocity }
    }

    /// The rate of its value, where it follows from what is seen at one time.
    #[inline(always)]
    pub fn rate<S: Real>(&self, Sight { distance, velocity, .. }: &Sight<S>) -> Option<S> {
        match &self.what {
            What::Distance { .. } => Some(S::splat(2.0) * dot(*distance, *velocity)),
            What::Plane { normal, .. } => Some(dot(splat(*normal), *velocity)),
            What::Apsis { .. }
            | What::Energy(_)
            | What::Contact(_)
            | What::Expression(_)
            | What::Function(_) => None,
        }
    }

    /// The rates of its value at both ends of a step `h`, where they follow from what is seen there.
    #[inline(always)]
    pub fn rates<S: Real>(&self, [start, end]: [&Sight<S>; 2], h: S) -> Option<[S; 2]> {
        let [(x0, v0), (x1, v1)] = [(start.distance, start.velocity), (end.distance, end.velocity)];
        match &self.what {
            What::Distance { .. } | What::Plane { .. } => Some([self.rate(start)?, self.rate(end)?]),
            What::Apsis { .. } => {
                // Accelerations of the cubic through both ends.
                let per_h = S::one() / h;
                let [mut a0, mut a1] = [[S::zero(); 3]; 2];
                let (two, four, six) = (S::splat(2.0), S::splat(4.0), S::splat(6.0));
                for c in 0..3 {
                    let mean = six * (x1[c] - x0[c]) * per_h;
                    a0[c] = (mean - four * v0[c] - two * v1[c]) * per_h;
                    a1[c] = (two * v0[c] + four * v1[c] - mean) * per_h;
                }
                Some([dot(v0, v0) + dot(x0, a0), dot(v1, v1) + dot(x1, a1)])
            }
            What::Energy(_) | What::Contact(_) | What::Expression(_) | What::Function(_) => None,
        }
    }
}
