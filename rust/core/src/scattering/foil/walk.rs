//! The way of one ion: straight flights on which electrons slow it down, collisions that turn it.
//!
//! Matter is amorphous: the way to the next collision is exponential, b² uniform on a disc, the azimuth uniform. The disc is
//! that of all collisions that turn by the minimum angle or more at the energy of the cell that the ion is in, and where
//! it would be wider than atoms are apart, as wide as that. A disc is a choice of which collisions to leave out and no
//! approximation to those that are in: it may change from flight to flight.

use super::angles::captures;
use super::draws::{Draws, FORCED, MOST_STEPS};
use super::medium::{Atom, Medium};
use crate::numerics::angles::atan2;
use crate::numerics::elementary::{Exponential, ln};
use crate::parallel::Ticker;
use crate::{Error, Result};
use core::f64::consts::FRAC_PI_2;

/// A flight without an end, in Å.
const FAR: f64 = 1e30;

/// Factorials of 15, 13, … with the signs of the sine's series, and of 16, 14, … with those of the cosine's.
const ODD: [f64; 8] =
    [-1_307_674_368_000.0, 6_227_020_800.0, -39_916_800.0, 362_880.0, -5_040.0, 120.0, -6.0, 1.0];
const EVEN: [f64; 9] =
    [20_922_789_888_000.0, -87_178_291_200.0, 479_001_600.0, -3_628_800.0, 40_320.0, -720.0, 24.0, -2.0, 1.0];

/// What became of an ion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It left on the far side.
    Transmitted,
    /// It left where it came from.
    Reflected,
    /// Its energy fell below the lowest.
    Stopped,
    /// It had no such collision as was to be forced.
    Missed,
}

/// How the way of an ion ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// How.
    pub fate: Fate,
    /// Its direction, measured from the beam's.
    pub angle: f64,
    /// Its energy in eV.
    pub energy: f64,
    /// Where, in Å.
    pub depth: f64,
    /// The angle of the forced collision in the frame of its center of mass.
    pub cm_angle: f64,
    /// How many ions it stands for.
    pub weight: f64,
}

/// A collision on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Where, in Å.
    pub depth: f64,
    /// The length of the way until then, in Å.
    pub path: f64,
    /// With which of the elements.
    pub element: usize,
    /// In Å.
    pub impact_parameter: f64,
    /// Sine and cosine of half the angle in the frame of the center of mass.
    pub half: [f64; 2],
    /// Of the ion, in eV: before and after.
    pub energy: [f64; 2],
    /// Of the ion: before and after.
    pub direction: [[f64; 3]; 2],
}

impl Met {
    /// The angle in the frame of the center of mass.
    pub fn cm_angle(&self) -> f64 {
        2.0 * atan2(self.half[0], self.half[1])
    }
}

/// An ion on its way.
struct Ion {
    depth: f64,
    path: f64,
    direction: [f64; 3],
    energy: f64,
    cm_angle: f64,
}

impl Ion {
    fn ended(&self, medium: &Medium, fate: Fate, weight: f64) -> Ended {
        let (u, beam) = (self.direction, medium.beam);
        let cross = [
            u[1] * beam[2] - u[2] * beam[1],
            u[2] * beam[0] - u[0] * beam[2],
            u[0] * beam[1] - u[1] * beam[0],
        ];
        let size = |v: [f64; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        let along = u[0] * beam[0] + u[1] * beam[1] + u[2] * beam[2];
        Ended {
            fate,
            angle: atan2(size(cross), along),
            energy: self.energy,
            depth: self.depth,
            cm_angle: self.cm_angle,
            weight,
        }
    }
    /// Meets an atom; gives what there is to tell of it.
    fn meet(&mut self, atom: &Atom, element: usize, b: f64, azimuth: f64) -> Result<Met> {
        let (sine, cosine) = atom.angles.half(self.energy * atom.share, b);
        if sine.is_nan() {
            return Err(captures(self.energy * atom.share));
        }
        let (square, complement) = (sine * sine, cosine * cosine);
        // Of velocities in units of the speed: along, across; p − q = (m₁ − m₂)/(m₁ + m₂).
        let excess = 1.0 - 2.0 * atom.share;
        let (along, across) = (complement + excess * square, 2.0 * atom.share * sine * cosine);
        let before = (self.energy, self.direction);
        self.energy *= complement + excess * excess * square;
        self.direction = turned(self.direction, along, across, azimuth);
        Ok(Met {
            depth: self.depth,
            path: self.path,
            element,
            impact_parameter: b,
            half: [sine, cosine],
            energy: [before.0, self.energy],
            direction: [before.1, self.direction],
        })
    }
}

/// Sine and cosine of a part of a whole turn, in [0, 1), to two units of 2⁻⁵³: without the care that an angle of any size
/// takes, since a draw divides into quarters exactly.
fn around(part: f64) -> (f64, f64) {
    let quarters = (4.0 * part).round();
    let x = (4.0 * part - quarters) * FRAC_PI_2;
    let z = x * x;
    // Taylor's series for |x| ≤ π/4: what is left out is below 2⁻⁵⁶.
    let (mut odd, mut even) = (0.0, 0.0);
    for factorial in ODD {
        odd = odd * z + 1.0 / factorial;
    }
    for factorial in EVEN {
        even = even * z + 1.0 / factorial;
    }
    let (sine, cosine) = (x * odd, even);
    match quarters as u8 % 4 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// A direction that has been turned: so much is along it, so much across.
fn turned(u: [f64; 3], along: f64, across: f64, azimuth: f64) -> [f64; 3] {
    let (sine, cosine) = around(azimuth);
    // Two directions across (Duff et al., J. Comput. Graph. Tech. 6 (2017) 1): no digits are lost for any u.
    let sign = 1.0_f64.copysign(u[2]);
    let a = -1.0 / (sign + u[2]);
    let b = u[0] * u[1] * a;
    let first = [1.0 + sign * u[0] * u[0] * a, sign * b, -sign * u[0]];
    let second = [b, sign + u[1] * u[1] * a, -u[1]];
    let v: [f64; 3] =
        core::array::from_fn(|i| along * u[i] + across * (cosine * first[i] + sine * second[i]));
    let size = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    // Equal masses head-on: at rest, and without a direction.
    if size > 0.0 { v.map(|x| x / size) } else { u }
}

impl Medium {
    /// Follows one ion to its end, told of every collision.
    pub(super) fn follow(
        &self,
        draws: Draws,
        watch: &mut impl FnMut(&Met),
        ticker: &mut Ticker<'_>,
    ) -> Result<Ended> {
        let ion =
            Ion { depth: 0.0, path: 0.0, direction: self.beam, energy: self.energy, cm_angle: f64::NAN };
        match (self.forced, self.single) {
            (Some(forced), true) => {
                ticker.tick()?;
                self.once(ion, forced, draws, watch)
            }
            (forced, _) => self.often(ion, forced, draws, watch, ticker),
        }
    }
    /// The forced collision.
    fn force(&self, ion: &mut Ion, forced: (f64, f64), draws: Draws) -> Result<(Met, f64)> {
        let share = draws.uniform(FORCED + 1);
        // One element needs no draw.
        let which = if self.atoms.len() > 1 { draws.uniform(FORCED + 3) } else { 0.0 };
        let (atom, at, b, weight) = self.met_forced(forced, which, share);
        let met = ion.meet(atom, at, b, draws.uniform(FORCED + 2))?;
        ion.cm_angle = met.cm_angle();
        Ok((met, weight))
    }
    /// One collision between two straight ways.
    fn once(
        &self,
        mut ion: Ion,
        forced: (f64, f64),
        draws: Draws,
        watch: &mut impl FnMut(&Met),
    ) -> Result<Ended> {
        let way = draws.uniform(FORCED) * forced.0;
        let (energy, left) = self.slowing.along(ion.energy, way, self.lowest);
        (ion.energy, ion.path) = (energy, way - left);
        ion.depth = ion.path * ion.direction[2];
        if energy < self.lowest {
            return Ok(ion.ended(self, Fate::Missed, 0.0));
        }
        let (met, weight) = self.force(&mut ion, forced, draws)?;
        watch(&met);
        let slope = ion.direction[2];
        let way = if slope > 0.0 { self.thickness - ion.depth } else { ion.depth } / slope.abs();
        let (energy, left) = self.slowing.along(ion.energy, way.min(FAR), self.lowest);
        ion.energy = energy;
        if energy < self.lowest || slope == 0.0 {
            ion.depth = (ion.depth + (way.min(FAR) - left) * slope).clamp(0.0, self.thickness);
            return Ok(ion.ended(self, Fate::Stopped, weight));
        }
        let fate = if slope > 0.0 { Fate::Transmitted } else { Fate::Reflected };
        ion.depth = if slope > 0.0 { self.thickness } else { 0.0 };
        Ok(ion.ended(self, fate, weight))
    }
    /// As many collisions as there are, one of them forced or none.
    fn often(
        &self,
        mut ion: Ion,
        forced: Option<(f64, f64)>,
        draws: Draws,
        watch: &mut impl FnMut(&Met),
        ticker: &mut Ticker<'_>,
    ) -> Result<Ended> {
        let mut pending = forced.map(|forced| (draws.uniform(FORCED) * forced.0, forced));
        let mut weight = 1.0;
        // What was to be forced and has not happened when the way ends.
        let ended = |ion: &Ion, fate, weight, pending: bool| {
            if pending { ion.ended(self, Fate::Missed, 0.0) } else { ion.ended(self, fate, weight) }
        };
        for step in 0..MOST_STEPS {
            ticker.tick()?;
            if ion.energy < self.lowest {
                return Ok(ended(&ion, Fate::Stopped, weight, pending.is_some()));
            }
            let (cell, rate) = self.rate(ion.energy);
            let loss = self.slowing.loss(ion.energy);
            let first = Draws::of_step(step);
            let free = if rate > 0.0 { -ln(1.0 - draws.uniform(first)) / rate } else { FAR };
            let to_forced = pending.map_or(FAR, |(place, _)| (place - ion.path).max(0.0));
            let length = free.min(self.slowing.reach(ion.energy, loss)).min(to_forced).min(FAR);
            let slope = ion.direction[2];
            let depth = ion.depth + slope * length;
            if !(0.0..=self.thickness).contains(&depth) {
                let edge = if slope > 0.0 { self.thickness } else { 0.0 };
                let length = ((edge - ion.depth) / slope).clamp(0.0, length);
                ion.energy = self.slowing.after(ion.energy, loss, length);
                (ion.depth, ion.path) = (edge, ion.path + length);
                let fate = match (ion.energy < self.lowest, slope > 0.0) {
                    (true, _) => Fate::Stopped,
                    (_, true) => Fate::Transmitted,
                    _ => Fate::Reflected,
                };
                return Ok(ended(&ion, fate, weight, pending.is_some()));
            }
            ion.energy = self.slowing.after(ion.energy, loss, length);
            (ion.depth, ion.path) = (depth, ion.path + length);
            if let Some((_, forced)) = pending.filter(|_| length == to_forced) {
                pending = None;
                let (met, of_this) = self.force(&mut ion, forced, draws)?;
                // None before it.
                weight = of_this * Exponential::exp(-forced.1 * ion.path);
                watch(&met);
            } else if length == free {
                let which = if self.atoms.len() > 1 { draws.uniform(first + 3) } else { 0.0 };
                let (atom, at, b) = self.met(cell, which, draws.uniform(first + 1));
                if pending.is_none() || b >= atom.forced {
                    watch(&ion.meet(atom, at, b, draws.uniform(first + 2))?);
                }
            } else if length == FAR {
                // Along the surface for ever.
                return Ok(ended(&ion, Fate::Stopped, weight, pending.is_some()));
            }
        }
        Err(Error::Internal("an ion with more collisions than draws".to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::angles::sin_cos;

    #[test]
    fn a_part_of_a_turn() {
        for i in 0..100_000 {
            let part = f64::from(i) / 100_000.0;
            let (found, expected) = (around(part), sin_cos(part * core::f64::consts::TAU));
            // The angle on the right is rounded, by 4e-16 near a whole turn.
            assert!((found.0 - expected.0).abs() < 8e-16 && (found.1 - expected.1).abs() < 8e-16, "{part}");
        }
        assert_eq!([0.0, 0.25, 0.5, 0.75].map(around), [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)]);
    }
}
