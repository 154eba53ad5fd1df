//! A sum of potentials about one center, in units in which its numbers are near one.

use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::Exponential;
use crate::numerics::power_of_two::{exponent, scale};
use crate::potentials::features::Features;
use crate::potentials::{Potential, near_one};
use crate::units::Units;
use std::sync::Arc;

/// V(r) of one potential or several.
#[derive(Clone, Debug)]
pub struct Field {
    terms: Vec<Arc<dyn Potential>>,
    /// Exponents of its units of length and energy.
    length: i32,
    energy: i32,
    /// Whether a formula among them has differences of near values, of which numbers keep too few digits.
    cancels: bool,
}

impl Field {
    /// Of potentials that are added.
    pub fn new(potentials: &[Arc<dyn Potential>]) -> Self {
        let largest = potentials.iter().find_map(|potential| potential.lengths().last().copied());
        let length = largest.map_or(0, exponent);
        // Even, so that the unit of velocity is a power of two, too.
        let energy = potentials.first().map_or(0, |potential| near_one(potential, length).1) & !1;
        let units = Units { length, mass: energy - 2 * length, time: 0 };
        let terms = potentials.iter().map(|potential| potential.scaled(units)).collect();
        Self { terms, length, energy, cancels: false }
    }

    /// A length in its units, from one of the caller's.
    pub fn take_length(&self, value: f64) -> f64 {
        scale(value, -self.length)
    }
    /// As [`take_length`](Self::take_length), of an energy.
    pub fn take_energy(&self, value: f64) -> f64 {
        scale(value, -self.energy)
    }
    /// As [`take_length`](Self::take_length), of an energy times the square of a length, as l²/2m is one.
    pub fn take_centrifugal(&self, value: DoubleDouble) -> DoubleDouble {
        let by = -(self.energy + 2 * self.length);
        DoubleDouble::new(scale(value.high(), by), scale(value.low(), by))
    }
    /// A length in the caller's units.
    pub fn give_length(&self, value: f64) -> f64 {
        scale(value, self.length)
    }
    /// As [`give_length`](Self::give_length), of an energy.
    pub fn give_energy(&self, value: f64) -> f64 {
        scale(value, self.energy)
    }
    /// As [`give_length`](Self::give_length), of an energy times the square of a length.
    pub fn give_centrifugal(&self, value: f64) -> f64 {
        scale(value, self.energy + 2 * self.length)
    }
    /// The exponents of its units of length and of energy.
    pub fn units(&self) -> (i32, i32) {
        (self.length, self.energy)
    }

    /// V(r), in the field's units like everything below.
    pub fn value(&self, r: f64) -> f64 {
        if self.cancels { self.precise(DoubleDouble::from(r)).0.to_f64() } else { self.rounded(r) }
    }
    fn rounded(&self, r: f64) -> f64 {
        self.terms.iter().map(|term| term.at(r)[0]).sum()
    }
    /// V, −dV/dr and d²V/dr²; where V jumps, those between the jumps.
    pub fn at(&self, r: f64) -> [f64; 3] {
        self.terms.iter().fold([0.0; 3], |[v, f, c], term| {
            let [value, force, curvature] = term.at(r);
            if term.jumps() { [v + value, f, c] } else { [v + value, f + force, c + curvature] }
        })
    }
    /// V and −dV/dr to about thirty digits.
    pub fn precise(&self, r: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
        let zero = DoubleDouble::default();
        self.terms.iter().fold((zero, zero), |(v, f), term| {
            let (value, force) = term.precise(r);
            if term.jumps() { (v + value, f) } else { (v + value, f + force) }
        })
    }
    /// V and −dV/dr as numbers.
    fn value_and_force(&self, r: f64) -> [f64; 2] {
        if self.cancels {
            let (value, force) = self.precise(DoubleDouble::from(r));
            return [value.to_f64(), force.to_f64()];
        }
        let [value, force, _] = self.at(r);
        [value, force]
    }
    /// The energy U = V + r V′/2 of a circle.
    pub fn circular_energy(&self, r: f64) -> f64 {
        let [value, force] = self.value_and_force(r);
        value - 0.5 * (r * force)
    }
    /// r V′, which is l²/mr² of a circle.
    pub(super) fn circular_momentum(&self, r: f64) -> f64 {
        -(r * self.value_and_force(r)[1])
    }
    /// 3 V′ + r V″, which has the sign of dU/dr and of d(r³V′)/dr; zero where rounding hides it.
    pub(super) fn slope(&self, r: f64) -> f64 {
        let (mut sum, mut size, mut hidden) = (DoubleDouble::default(), 0.0, 0.0);
        let (mut first, mut second) = (0.0, 0.0);
        for term in self.terms.iter().filter(|term| !term.jumps()) {
            if let Some([_, (force, force_off), (curvature, curvature_off)]) = term.told(r) {
                let (first, second) = (force * DoubleDouble::from(-3.0), curvature * DoubleDouble::from(r));
                sum = sum + first + second;
                size += first.high().abs() + second.high().abs();
                hidden += 3.0 * force_off + r * curvature_off;
            } else {
                let [_, force, curvature] = term.at(r);
                first += -3.0 * force;
                second += r * curvature;
            }
        }
        let rounded = f64::abs(first) + f64::abs(second);
        let sum = (sum + DoubleDouble::from(first + second)).to_f64();
        let (size, hidden) = (size + rounded, hidden + HIDDEN * rounded);
        if sum.is_finite() && sum.abs() > hidden && size > LEAST { sum / size } else { 0.0 }
    }
    /// Of places those at which rounding leaves something of V; how much it takes decides how V is found from now on.
    pub(super) fn known(&mut self, places: &mut Vec<f64>) {
        let told = |r: f64| -> Option<(DoubleDouble, f64)> {
            let of = |term: &Arc<dyn Potential>| {
                term.told(r).map_or_else(|| (DoubleDouble::from(term.at(r)[0]), 0.0), |[value, ..]| value)
            };
            self.terms.iter().map(of).reduce(|(sum, all), (value, off)| (sum + value, all + off))
        };
        if !self.terms.iter().any(|term| term.hidden().is_some()) {
            return;
        }
        let mut cancels = false;
        places.retain(|&r| {
            let Some((value, off)) = told(r) else { return false };
            let known = off <= KNOWN * value.high().abs() + FAINT;
            cancels |= known && (value.high() - self.rounded(r)).abs() > CANCELS * value.high().abs() + FAINT;
            known
        });
        self.cancels = cancels;
    }
    /// Where it jumps, ascending.
    pub fn jumps(&self) -> Vec<f64> {
        let mut jumps: Vec<f64> =
            self.terms.iter().filter(|term| term.jumps()).flat_map(|term| term.lengths()).collect();
        jumps.sort_by(f64::total_cmp);
        jumps.dedup();
        jumps
    }
    /// The distances between which all terms are.
    pub fn domain(&self) -> Option<(f64, f64)> {
        let domains = self.terms.iter().filter_map(|term| term.domain());
        domains.reduce(|(low, high), (from, to)| (low.max(from), high.min(to)))
    }
    /// Whether one of its terms diverges in the middle.
    pub fn singular(&self) -> bool {
        self.terms.iter().any(|term| term.singular())
    }
    /// Where a derivative may jump: jumps, and what its terms say.
    pub(super) fn breaks(&self) -> Vec<f64> {
        let mut breaks = self.jumps();
        breaks.extend(self.terms.iter().flat_map(|term| term.breaks()));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
    /// Places at which slopes are looked at: dense about every declared length, and in every piece of a table.
    pub(super) fn places(&self) -> Vec<f64> {
        let domain = self.domain();
        let (low, high) = domain.unwrap_or((0.0, f64::INFINITY));
        // So many to an octave, over that many octaves to either side.
        let about = |length: f64, octaves: i32, per: i32| {
            let step = move |k: i32| {
                Exponential::exp(core::f64::consts::LN_2 * f64::from(k.rem_euclid(per)) / f64::from(per))
            };
            (-octaves * per..=octaves * per).map(move |k| scale(length * step(k), k.div_euclid(per)))
        };
        let mut places: Vec<f64> = about(1.0, OCTAVES, 4).collect();
        for term in &self.terms {
            let lengths = term.lengths();
            if term.hidden().is_some() {
                places.extend(Features::of(term.as_ref()).places);
            }
            if term.domain().is_some() {
                for pair in lengths.windows(2) {
                    let part = |k: i32| pair[0] + (pair[1] - pair[0]) * f64::from(k) / f64::from(PARTS);
                    places.extend((0..=PARTS).map(part));
                }
                continue;
            }
            for &length in &lengths {
                places.extend(about(length, 10, 32));
                // A well far out is as narrow as another length says.
                for &other in lengths.iter().filter(|other| **other < 0.5 * length) {
                    places.extend((-256..=256).map(|k| length + other * f64::from(k) / 8.0));
                }
            }
        }
        places.retain(|r| *r > 0.0 && *r >= low && *r <= high);
        places.extend([low, high].into_iter().filter(|r| *r > 0.0 && r.is_finite()));
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    }
}

/// Parts of each piece of a table.
const PARTS: i32 = 8;
/// How far distances reach, in powers of two, from the unit.
const OCTAVES: i32 = 400;
/// A sum of two that is a smaller part of them is rounding.
const HIDDEN: f64 = 1e-13;
/// V that is off by less than this part of it is known; and so is one that is off by less than the second, in units in which
/// energies are near one.
const KNOWN: f64 = 1e-6;
const FAINT: f64 = 1e-24;
/// By so much of it V as a number may be off.
const CANCELS: f64 = 1e-12;
/// Below this numbers have not their digits.
const LEAST: f64 = 1e-280;
