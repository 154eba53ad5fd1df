//! What becomes of two spheres that touch: impulses and mergers.
//!
//! J. B. Marion and S. T. Thornton, *Classical Dynamics of Particles and Systems*, 5th ed., §9.8 (coefficient of
//! restitution). Smooth spheres: the impulse is along the line of centers, so that angular momentum is kept, too.

use super::{CONTACT, Collision};
use crate::numerics::elementary::cbrt;
use crate::numerics::points::distance;
use crate::scene::run::Reached;
use std::collections::BTreeSet;

/// Spheres at one time, and what is left of them.
#[derive(Clone, Debug)]
pub struct Impact {
    /// Masses.
    pub mass: Vec<f64>,
    /// Radii.
    pub radius: Vec<f64>,
    /// Positions.
    pub position: Vec<[f64; 3]>,
    /// Velocities.
    pub velocity: Vec<[f64; 3]>,
    /// The body of which each is a part: itself, if it is by itself.
    pub host: Vec<usize>,
    /// +1 for a run forward in time, -1 for one backward.
    pub direction: f64,
}

/// How two spheres meet.
pub(super) struct Meeting {
    /// From the first to the second.
    pub(super) normal: [f64; 3],
    /// How fast they approach along the run.
    pub(super) speed: f64,
    /// Shares of a change of their relative motion: how much of it each takes.
    pub(super) shares: [f64; 2],
    /// m₁m₂/(m₁ + m₂).
    pub(super) reduced: f64,
}

/// What part of a relative motion belongs to each of two masses: a massless body has all of it beside a massive one, and
/// half beside its like.
fn shares(first: f64, second: f64) -> [f64; 2] {
    // By the larger, so that no sum overflows.
    let largest = first.max(second);
    if largest == 0.0 {
        return [0.5; 2];
    }
    let (first, second) = (first / largest, second / largest);
    [second / (first + second), first / (first + second)]
}

impl Impact {
    /// Puts those that are parts of others in their places.
    pub fn follow(&mut self) {
        for (body, &host) in self.host.iter().enumerate() {
            (self.position[body], self.velocity[body]) = (self.position[host], self.velocity[host]);
        }
    }

    /// Whether two are no parts of others.
    pub fn is_whole(&self, (i, j): (usize, usize)) -> bool {
        self.host[i] == i && self.host[j] == j
    }

    /// Where they are and how they move.
    pub fn states(&self) -> Reached {
        Reached { position: self.position.clone(), velocity: self.velocity.clone(), ..Reached::default() }
    }

    pub(super) fn meeting(&self, i: usize, j: usize) -> Meeting {
        let between: [f64; 3] = core::array::from_fn(|c| self.position[j][c] - self.position[i][c]);
        let d = distance(self.position[i], self.position[j]);
        let normal = if d > 0.0 { between.map(|x| x / d) } else { [1.0, 0.0, 0.0] };
        let away: f64 = (0..3).map(|c| normal[c] * (self.velocity[j][c] - self.velocity[i][c])).sum();
        let shares = shares(self.mass[i], self.mass[j]);
        Meeting { normal, speed: -self.direction * away, shares, reduced: self.mass[i] * shares[0] }
    }

    /// (d/R)² - 1 of two spheres.
    pub fn gap(&self, i: usize, j: usize) -> f64 {
        let part = distance(self.position[i], self.position[j]) / (self.radius[i] + self.radius[j]);
        (part - 1.0) * (part + 1.0)
    }

    /// Below what that is a contact: what rounding of places can make of one.
    pub fn contact(&self, i: usize, j: usize) -> f64 {
        let farthest = |x: [f64; 3]| x.iter().fold(0.0_f64, |far, x| far.max(x.abs()));
        let far = farthest(self.position[i]).max(farthest(self.position[j]));
        CONTACT + 32.0 * f64::EPSILON * far / (self.radius[i] + self.radius[j])
    }

    /// Whether two spheres are in contact.
    pub fn is_contact(&self, (i, j): (usize, usize)) -> bool {
        self.gap(i, j) <= self.contact(i, j)
    }

    /// Whether two spheres are in each other, by more than rounding.
    pub fn overlap(&self, (i, j): (usize, usize)) -> bool {
        self.gap(i, j) < -self.contact(i, j)
    }

    /// The pairs in contact.
    pub fn touching(&self) -> Vec<(usize, usize)> {
        let boxes: Vec<[[f64; 2]; 3]> = (self.position.iter().zip(&self.radius))
            .map(|(x, radius)| {
                let room = radius * (1.0 + CONTACT);
                x.map(|x| {
                    let room = room + 64.0 * f64::EPSILON * x.abs();
                    [x - room, x + room]
                })
            })
            .collect();
        let mut pairs = Vec::new();
        super::swept(
            &boxes,
            |i| self.radius[i] > 0.0,
            |i, j| {
                let (i, j) = (i.min(j), i.max(j));
                if self.is_whole((i, j)) && self.is_contact((i, j)) {
                    pairs.push((i, j));
                }
            },
        );
        pairs.sort_unstable();
        pairs
    }

    /// Whether two spheres that touch become one if they may: they approach, or are in each other.
    fn meet(&self, pair: (usize, usize)) -> bool {
        self.overlap(pair) || self.approach(pair).is_some()
    }

    /// Of pairs in contact, those that become one if they may.
    pub fn meeting_pairs(&self, touching: Vec<(usize, usize)>) -> BTreeSet<(usize, usize)> {
        touching.into_iter().filter(|&pair| self.is_whole(pair) && self.meet(pair)).collect()
    }

    /// Brings such pairs up to date after two of their bodies have become one: no others have changed.
    pub fn update(&self, pairs: &mut BTreeSet<(usize, usize)>, (i, j): (usize, usize)) {
        pairs.retain(|&(a, b)| a != i && a != j && b != i && b != j);
        let left = self.host[i];
        let with_left = (0..self.mass.len()).map(|other| (left.min(other), left.max(other)));
        pairs.extend(with_left.filter(|&(a, b)| {
            let spheres = a != b && (self.radius[a] > 0.0 || self.radius[b] > 0.0);
            let touch = spheres && self.is_whole((a, b)) && self.is_contact((a, b));
            touch && self.meet((a, b))
        }));
    }

    /// How fast two spheres approach, if they do by more than rounding.
    pub fn approach(&self, (i, j): (usize, usize)) -> Option<f64> {
        let size = |v: [f64; 3]| v.iter().map(|v| v.abs()).sum::<f64>();
        let speed = self.meeting(i, j).speed;
        let rounding = 4.0 * f64::EPSILON * (size(self.velocity[i]) + size(self.velocity[j]));
        (speed > rounding).then_some(speed)
    }

    pub(super) fn collision(&self, (i, j): (usize, usize), t: f64, meeting: &Meeting) -> Collision {
        let part = self.radius[i] / (self.radius[i] + self.radius[j]);
        let position = core::array::from_fn(|c| {
            self.position[i][c] + part * (self.position[j][c] - self.position[i][c])
        });
        let speed = meeting.speed.max(0.0);
        Collision { copy: 0, t, bodies: (i, j), speed, position, energy_lost: 0.0, survivor: None }
    }

    /// They touch, and that is all.
    pub fn touch(&self, pair: (usize, usize), t: f64) -> Collision {
        self.collision(pair, t, &self.meeting(pair.0, pair.1))
    }

    /// They bounce; the collision, and how fast they part.
    pub fn bounce(&mut self, (i, j): (usize, usize), restitution: f64, t: f64) -> (Collision, f64) {
        let mut meeting = self.meeting(i, j);
        // Spheres that graze each other may be parting already, by rounding.
        meeting.speed = meeting.speed.max(0.0);
        let mut collision = self.collision((i, j), t, &meeting);
        let change = (1.0 + restitution) * meeting.speed * self.direction;
        for (body, sign, share) in [(i, -1.0, meeting.shares[0]), (j, 1.0, meeting.shares[1])] {
            for c in 0..3 {
                self.velocity[body][c] += sign * share * change * meeting.normal[c];
            }
        }
        let lost = (1.0 - restitution) * (1.0 + restitution);
        collision.energy_lost = 0.5 * meeting.reduced * meeting.speed * meeting.speed * lost;
        (collision, restitution * meeting.speed)
    }

    /// They become one, in the place of the more massive: mass, momentum, volume and centre of mass are kept.
    pub fn merge(&mut self, (i, j): (usize, usize), t: f64) -> Collision {
        let meeting = self.meeting(i, j);
        let mut collision = self.collision((i, j), t, &meeting);
        let (left, gone) = if self.mass[j] > self.mass[i] { (j, i) } else { (i, j) };
        let share = meeting.shares[usize::from(left == j)];
        let mut square = 0.0;
        for c in 0..3 {
            let [apart, faster] = [&self.position, &self.velocity].map(|of| of[gone][c] - of[left][c]);
            self.position[left][c] += share * apart;
            self.velocity[left][c] += share * faster;
            square += faster * faster;
        }
        self.mass[left] += self.mass[gone];
        let (large, small) =
            (self.radius[left].max(self.radius[gone]), self.radius[left].min(self.radius[gone]));
        let part = small / large;
        self.radius[left] = large * cbrt(1.0 + part * part * part);
        (self.mass[gone], self.radius[gone]) = (0.0, 0.0);
        self.host.iter_mut().filter(|host| **host == gone).for_each(|host| *host = left);
        self.follow();
        collision.energy_lost = 0.5 * meeting.reduced * square;
        collision.survivor = Some(left);
        collision
    }
}
