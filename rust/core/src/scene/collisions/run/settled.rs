//! What a contact does to a copy: its spheres bounce, merge or stop, and so do all others in contact at the same time.

use super::super::{Collision, Collisions};
use super::member::Member;
use crate::scene::integrate::Ending;

/// Spheres rest on each other that part by less than this part of their radii,
const REST: f64 = 1.0 / (1_u64 << 40) as f64;

/// so many times in succession.
const RESTS: u32 = 16;

/// Impulses at one time after which bodies are pressed together, for each pair in contact.
const IMPULSES: usize = 1000;

/// How two spheres met last.
#[derive(Clone, Copy)]
pub(super) struct Met {
    /// How long after the start.
    elapsed: f64,
    /// How fast they parted.
    speed: f64,
    rests: u32,
}

impl Member {
    /// Settles a contact, and all others at the same time; whether the run goes on.
    pub(super) fn collide(&mut self, pair: Option<(usize, usize)>) -> bool {
        // What was held at a node is of before.
        self.kept = None;
        self.from = 0;
        match self.rule {
            Collisions::Stop => self.stop(pair),
            Collisions::Bounce(restitution) => self.bounce(pair, restitution),
            Collisions::Merge => self.merge(pair),
        }
    }

    fn put(&mut self, collision: Collision) {
        self.lines.push(Collision { copy: self.copy, ..collision });
    }

    fn stop(&mut self, pair: Option<(usize, usize)>) -> bool {
        let first = || {
            let touching = self.bodies.touching().into_iter();
            touching.filter(|&pair| self.bodies.approach(pair).is_some()).min()
        };
        if let Some(pair) = pair.or_else(first) {
            self.put(self.bodies.touch(pair, self.outcome.time));
        }
        self.outcome.ending = Ending::Stopped;
        false
    }

    /// Lets spheres bounce that touch, the fastest first, until none approach: whatever was found, so that it does not
    /// matter how bodies are numbered.
    fn bounce(&mut self, mut found: Option<(usize, usize)>, restitution: f64) -> bool {
        let (t, elapsed) = (self.outcome.time, self.elapsed());
        let touching = self.touching(found);
        // Spheres that graze each other may be parting already, by rounding.
        let mut grazing = found.filter(|&pair| self.bodies.approach(pair).is_none());
        for _ in 0..IMPULSES * (1 + touching.len()) {
            let pairs = grazing.take().map_or_else(|| self.bodies.fastest(&touching), |pair| vec![pair]);
            if pairs.is_empty() {
                return true;
            }
            for (collision, speed) in self.bodies.bounce_together(&pairs, restitution, t) {
                let (pair, met_with) = (collision.bodies, collision.speed);
                let squeezed = self.squeezed.note(&self.bodies, &collision, elapsed);
                self.put(collision);
                if squeezed {
                    self.outcome.ending = Ending::Squeezed { bodies: pair };
                    return false;
                }
                if found.take_if(|found| *found == pair).is_none() {
                    let rests = self.met.get(&pair).map_or(0, |met| met.rests);
                    let _ = self.met.insert(pair, Met { elapsed, speed, rests });
                } else if self.rests(pair, met_with, speed) {
                    self.outcome.ending = Ending::Resting { bodies: pair };
                    return false;
                }
            }
        }
        let bodies = touching.first().copied().unwrap_or_default();
        self.outcome.ending = Ending::Resting { bodies };
        false
    }

    /// Takes note of a bounce; whether the two have come to rest on each other.
    fn rests(&mut self, pair: (usize, usize), met_with: f64, parted_with: f64) -> bool {
        let elapsed = self.elapsed();
        let sum = self.bodies.radius[pair.0] + self.bodies.radius[pair.1];
        let rests = self.met.get(&pair).map_or(0, |met| {
            // What rises and falls freely comes that far, from the speed and the time that it takes.
            let apart = 0.25 * met.speed.max(met_with) * (elapsed - met.elapsed).abs();
            if apart <= REST * sum { met.rests + 1 } else { 0 }
        });
        let _ = self.met.insert(pair, Met { elapsed, speed: parted_with, rests });
        rests >= RESTS
    }

    fn merge(&mut self, pair: Option<(usize, usize)>) -> bool {
        let t = self.outcome.time;
        let mut meeting = self.bodies.meeting_pairs(self.touching(pair));
        let mut next = pair.or_else(|| meeting.first().copied());
        while let Some(pair) = next {
            let collision = self.bodies.merge(pair, t);
            self.put(collision);
            // A body that has grown may have reached others.
            self.bodies.update(&mut meeting, pair);
            next = meeting.first().copied();
        }
        true
    }
}
