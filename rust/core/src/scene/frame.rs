//! The units and the origin in which a scene is integrated.
//!
//! Lengths, times and masses are divided by powers of two near the scene's own, which is exact and keeps
//! 1e±100 units from overflowing. Bodies on which no force acts that tells one place from another are integrated about
//! their center of mass: a lone body about its own place, a coupled group about one origin. If no force tells
//! velocities apart either, the origin moves with them, and falls with what accelerates all of them alike. So the
//! differences that matter keep their digits, however far the whole may be or go. A center that is far from most bodies
//! would cost them their digits: then a point is taken that is near them.

pub use crate::units::Units;

use super::Scene;
use crate::forces::ForceTerm;
use crate::forces::term::Coupling;
use crate::numerics::double_double::{DoubleDouble, two_sum};
use crate::numerics::power_of_two::exponent;
use crate::numerics::real::Real;
use std::sync::Arc;

/// Units are powers of 2 to the power of multiples of this: members of an ensemble of about the same size share theirs,
/// and what is up to 2^32 larger or smaller than its unit is far from overflowing.
const COARSE: i32 = 64;

/// The largest multiple of which 2 to the power of it is a number.
const LARGEST: i32 = 1023 / COARSE * COARSE;

/// The unit of time is shorter than the time in which a scene moves by its size by 2 to the power of this at most: squares
/// of its velocities must not vanish.
const LONGEST: i32 = 256;

/// The nearest multiple.
fn coarse(exponent: i32) -> i32 {
    (exponent + COARSE / 2).div_euclid(COARSE) * COARSE
}

impl Units {
    /// Units near the own sizes of a copy of a scene, for a run over that span of time.
    pub fn of(scene: &Scene, copy: usize, origin: &Origin, span: f64) -> Self {
        let mut size = 0.0_f64;
        let mut speed = 0.0_f64;
        for (x, v) in scene.positions(copy).iter().zip(scene.velocities(copy)) {
            for c in 0..3 {
                size = size.max((x[c] - origin.center[c]).abs());
                speed = speed.max((v[c] - origin.drift[c]).abs());
            }
        }
        let masses = scene.masses(copy);
        let forces = scene.forces_of(copy);
        let length = exponent(forces.iter().map(|force| force.length()).fold(size, f64::max));
        let mass = exponent(masses.iter().copied().fold(0.0, f64::max));
        // The time in which a force moves the largest mass over that length, else the crossing time.
        let massive = masses.iter().any(|&mass| mass > 0.0);
        let pairs = massive && masses.len() > 1;
        let felt = |force: &&Arc<dyn ForceTerm>| pairs || (massive && force.coupling() != Coupling::AllPairs);
        let given = forces.iter().filter(felt).find_map(|force| force.unit_of_time(length, mass));
        let crossing = (speed > 0.0).then(|| length - exponent(speed));
        let time = given.or(crossing).unwrap_or(0);
        // In a run that is much shorter an acceleration that matters is beyond measure in that time: the run's own is taken.
        let least = crossing.unwrap_or(time) - LONGEST;
        let time = if span > 0.0 { exponent(span).max(least).min(time) } else { time };
        // One factor then takes a length or a velocity back to the scene's units: it must be a number, which 2^1024 is not.
        let length = coarse(length).clamp(-LARGEST, LARGEST);
        Self { length, time: coarse(time).clamp(length - 1000, length + 1000), mass: coarse(mass) }
    }
}

/// About what bodies may be integrated, the forces on them being what they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// The origin of the scene: some force tells one place from another.
    Given,
    /// Any point at rest.
    AtRest,
    /// Any point that moves uniformly, or with the acceleration that all have alike: velocities are not told apart, either.
    Falling([f64; 3]),
}

impl Frame {
    /// What these forces allow.
    pub fn of(forces: &[Arc<dyn ForceTerm>]) -> Self {
        if !forces.iter().all(|force| force.translation_invariant()) {
            return Self::Given;
        }
        if !forces.iter().all(|force| force.galilean_invariant()) {
            return Self::AtRest;
        }
        let mut fall = [0.0; 3];
        for g in forces.iter().filter_map(|force| force.as_uniform()) {
            for c in 0..3 {
                fall[c] += g[c];
            }
        }
        Self::Falling(fall)
    }

    /// The origin for some bodies of a copy.
    pub fn origin(self, scene: &Scene, copy: usize, bodies: impl Iterator<Item = usize> + Clone) -> Origin {
        let mass = scene.masses(copy);
        let (places, velocities) = (scene.positions(copy), scene.velocities(copy));
        let center = || center(mean(mass, places, bodies.clone()), bodies.clone().map(|i| places[i]));
        match self {
            Self::Given => Origin::default(),
            Self::AtRest => Origin { center: center(), ..Origin::default() },
            Self::Falling(fall) => {
                let mean = mean(mass, velocities, bodies.clone());
                Origin { center: center(), drift: drift(mean, bodies.clone().map(|i| velocities[i])), fall }
            }
        }
    }
}

/// Where the origin of the integration lies, and how it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Origin {
    /// Its place at the start.
    pub center: [f64; 3],
    /// Its velocity.
    pub drift: [f64; 3],
    /// Its acceleration.
    pub fall: [f64; 3],
}

/// An origin at some time: place and velocity, with what they leave out.
#[derive(Clone, Copy, Debug)]
pub struct Moved {
    /// Its place, component by component.
    pub position: [(f64, f64); 3],
    /// Its velocity.
    pub velocity: [(f64, f64); 3],
}

impl Moved {
    /// The origin of the scene.
    pub const NOWHERE: Self = Self { position: [(0.0, 0.0); 3], velocity: [(0.0, 0.0); 3] };
}

impl Origin {
    /// Whether it is anywhere but at rest in the origin of the scene.
    pub fn is_elsewhere(&self) -> bool {
        *self != Self::default()
    }

    /// Whether it is accelerated.
    #[inline(always)]
    pub fn falls(&self) -> bool {
        // One by one: arrays are compared by a call.
        let [x, y, z] = self.fall;
        x != 0.0 || y != 0.0 || z != 0.0
    }

    /// Where it is after a time. Inlined, for the fused instructions of the tier: it is asked at every output.
    #[inline(always)]
    pub fn at(&self, elapsed: f64) -> Moved {
        if self.falls() {
            return self.fallen_at(elapsed);
        }
        let mut moved = Moved::NOWHERE;
        for c in 0..3 {
            moved.position[c] = drifted(self.center[c], self.drift[c], elapsed);
            moved.velocity[c] = (self.drift[c], 0.0);
        }
        moved
    }

    /// Where it is after a time, of one that falls.
    #[cold]
    fn fallen_at(&self, elapsed: f64) -> Moved {
        let pair = |x: DoubleDouble| (x.high(), x.low());
        let t = DoubleDouble::from(elapsed);
        let mut moved = Moved::NOWHERE;
        for c in 0..3 {
            let [center, drift, fall] = [self.center[c], self.drift[c], self.fall[c]].map(DoubleDouble::from);
            moved.position[c] = pair(center + t * (drift + fall * t.scale(0.5)));
            moved.velocity[c] = pair(drift + fall * t);
        }
        moved
    }
}

/// A coordinate after a time at a velocity, and what it leaves out.
#[inline(always)]
pub fn drifted<S: Real>(center: S, drift: S, elapsed: S) -> (S, S) {
    let way = elapsed * drift;
    let left_out = elapsed.multiply_add(drift, -way);
    let (sum, error) = two_sum(center, way);
    let rest = error + left_out;
    let place = sum + rest;
    (place, rest - (place - sum))
}

/// A coordinate of the scene from one relative to an origin, each with what it leaves out.
#[inline(always)]
pub fn restored<S: Real>(origin: (S, S), relative: (S, S)) -> (S, S) {
    let (sum, error) = two_sum(origin.0, relative.0);
    let rest = error + (origin.1 + relative.1);
    let value = sum + rest;
    (value, rest - (value - sum))
}

/// Below this share of the extent a center is where it should be, up to rounding, and is left there.
const NEAR: f64 = 8.881_784_197_001_252e-16; // 2^-50

/// The mass-weighted mean of the points of some bodies, or zero where it is as good as that.
fn mean(mass: &[f64], points: &[[f64; 3]], bodies: impl Iterator<Item = usize> + Clone) -> [f64; 3] {
    let total: f64 = bodies.clone().map(|i| mass[i]).sum();
    let count = bodies.clone().count() as f64;
    // Masses are divided first, so that 1e300-kilogram stars do not overflow the sum.
    let weight = |i: usize| if total > 0.0 { mass[i] / total } else { 1.0 / count };
    let mut mean = [0.0; 3];
    for i in bodies.clone() {
        let weight = weight(i);
        for c in 0..3 {
            mean[c] += weight * points[i][c];
        }
    }
    let extent = bodies.fold(0.0, |extent: f64, i| extent.max(apart(points[i], mean)));
    let distance = apart(mean, [0.0; 3]);
    if distance.is_finite() && distance > NEAR * extent { mean } else { [0.0; 3] }
}

/// What places are measured from: their mean, or zero, or one of them, whichever spares the most.
pub fn center(mean: [f64; 3], places: impl Iterator<Item = [f64; 3]> + Clone) -> [f64; 3] {
    let step = places.clone().count().div_ceil(TRIED).max(1);
    let others = core::iter::once([0.0; 3]).chain(places.clone().step_by(step));
    sparing(mean, places, others)
}

/// How what they are measured from moves: with their mean velocity, or not at all. With no body: it turns, and the others
/// would leave it.
pub fn drift(mean: [f64; 3], velocities: impl Iterator<Item = [f64; 3]> + Clone) -> [f64; 3] {
    sparing(mean, velocities, core::iter::once([0.0; 3]))
}

/// The largest of the distances in each coordinate.
fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|c| (a[c] - b[c]).abs());
    Real::max(Real::max(x, y), z)
}

/// So many binary digits each body has to keep more, on average, for another point to be better than the mean.
const WORTH: i64 = 4;
/// So many bodies, at most, are tried as the point.
const TRIED: usize = 64;

/// The mean of some points; or another one that is worth it, if the mean is far from most of them: the difference of two
/// coordinates about a point has no more digits than the larger has beyond it. Two points lose nothing about any.
fn sparing(
    mean: [f64; 3],
    points: impl Iterator<Item = [f64; 3]> + Clone,
    others: impl Iterator<Item = [f64; 3]>,
) -> [f64; 3] {
    let count = points.clone().count() as i64;
    if count < 3 {
        return mean;
    }
    let centers: Vec<[f64; 3]> = core::iter::once(mean).chain(others).collect();
    let kept = places_about(&centers, points);
    match kept.iter().zip(centers).skip(1).min_by_key(|&(places, _)| places) {
        Some((fewest, center)) if kept[0] - fewest > WORTH * count => center,
        _ => mean,
    }
}

/// For each center the binary places before the point of all distances from it, added up. Whole numbers: a choice by them is
/// the same in every unit and mirror. The nearest counts as the next one: it is told apart from no other by what it keeps.
fn places_about(centers: &[[f64; 3]], points: impl Iterator<Item = [f64; 3]>) -> Vec<i64> {
    // Component by component, and without a branch: this is asked for at each contact of thousands of spheres.
    let [x, y, z] = [0, 1, 2].map(|c| centers.iter().map(|center| center[c]).collect::<Vec<f64>>());
    let count = centers.len();
    let (mut sums, mut first, mut second) =
        (vec![0_i64; count], vec![f64::INFINITY; count], vec![f64::INFINITY; count]);
    for point in points {
        let mut odd = false;
        let own = (x.iter().zip(&y).zip(&z)).zip(sums.iter_mut().zip(&mut first).zip(&mut second));
        for (((x, y), z), ((sum, first), second)) in own {
            let distance = apart(point, [*x, *y, *z]);
            let biased = (distance.to_bits() >> 52) as i64;
            odd |= biased == 0 || biased == 0x7ff;
            *sum += biased - 1023;
            *second = Real::min(*second, Real::max(distance, *first));
            *first = Real::min(*first, distance);
        }
        if odd {
            for (sum, center) in sums.iter_mut().zip(centers) {
                let distance = apart(point, *center);
                *sum += place(distance) - ((distance.to_bits() >> 52) as i64 - 1023);
            }
        }
    }
    for (sum, (first, second)) in sums.iter_mut().zip(first.into_iter().zip(second)) {
        *sum += place(second) - place(first);
    }
    sums
}

/// The binary place of a distance; that of none is below all others.
fn place(distance: f64) -> i64 {
    i64::from(if distance > 0.0 { exponent(distance) } else { -2000 })
}
