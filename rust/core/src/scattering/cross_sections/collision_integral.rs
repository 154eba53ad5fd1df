//! Means of transport cross sections over energies: collision integrals Ω^(l,s)(T).
//!
//! The one idea: in the logarithm of the energy the weight falls as fast as an exponential on both sides, and the cross section
//! is smooth but where orbits begin to be. So intervals end there, and are halved where two rules differ. They are the same
//! for all temperatures, which share the cross sections in them: each has the bits that it has alone.

use super::super::deflection::Deflector;
use super::super::kronrod::{self, POINTS};
use super::transport::{LONGEST, both_rules, transport_to};
use crate::Result;
use crate::numerics::elementary::{Exponential, ln};
use crate::parallel::{Ticker, for_chunks};
use core::f64::consts::PI;
use std::collections::HashMap;

/// The tolerance of cross sections that are averaged, relative.
const IN_MEAN: f64 = 3e-9;
/// And of the angles in them.
pub const OF_ANGLES_IN_MEAN: f64 = 1e-10;
/// And of the average.
const MEAN: f64 = 1e-9;
/// Rounds of halving of intervals of energy: each costs fifteen cross sections an interval. Where orbits begin to be the
/// mean bends sharply, and what is left of it there is half as much each time.
const MOST_ROUNDS: usize = 14;

/// What a weight is to be less than, as a logarithm: 2e-12.
const NEGLIGIBLE: f64 = 27.0;

/// Ω^(l,s) of a potential, at any temperatures.
#[derive(Debug)]
pub struct CollisionIntegrals<'a> {
    deflector: &'a Deflector,
    orders: (u32, u32),
    threads: usize,
    /// Logarithms of energies at which orbits begin or end to be.
    critical: Vec<f64>,
    /// Q^(l) by the logarithms of the energies.
    known: HashMap<u64, f64>,
}

impl<'a> CollisionIntegrals<'a> {
    /// Of the orders l and s.
    pub fn new(deflector: &'a Deflector, orders: (u32, u32), threads: usize) -> Self {
        let mut critical: Vec<f64> = deflector.critical_energies().into_iter().map(ln).collect();
        critical.sort_by(f64::total_cmp);
        critical.dedup();
        Self { deflector, orders, threads, critical, known: HashMap::new() }
    }

    /// Ω^(l,s)*(T) = ∫ Q^(l)(E) e^(−E/T) E^(s+1) dE / ((s + 1)! T^(s+2) π d² (1 − (1 + (−1)^l)/(2(1 + l)))): in units of what
    /// hard spheres of diameter `d` have. T is k_B times the temperature, an energy.
    ///
    /// # Errors
    /// As [`transport`](super::transport).
    pub fn at(&mut self, temperature: f64, diameter: f64, ticker: &mut Ticker<'_>) -> Result<f64> {
        let (l, s) = self.orders;
        let weight = Weight { power: f64::from(s + 2), origin: ln(temperature) };
        let most = weight.most();
        self.check_begins(weight.largest(), most)?;
        let least = self.least(&weight, ticker)?;
        let mut pending = self.intervals(least, most);
        let factorial: f64 = (1..=s + 1).map(f64::from).product();
        let mut done: Vec<f64> = Vec::new();
        for round in 0..MOST_ROUNDS {
            let points: Vec<f64> =
                pending.iter().flat_map(|ends| (0..POINTS).map(|k| kronrod::place(*ends, k))).collect();
            // Beyond the ends, where there may be none, nothing counts.
            let counts = |y: &f64| (least..=most).contains(y);
            self.find(points.iter().copied().filter(counts).collect(), ticker)?;
            let value =
                |y: &f64| self.known.get(&y.to_bits()).map_or(0.0, |found| weight.at(*y) / factorial * found);
            let values: Vec<f64> = points.iter().map(|y| if counts(y) { value(y) } else { 0.0 }).collect();
            let found: Vec<[f64; 2]> = pending
                .iter()
                .zip(values.chunks(POINTS))
                .map(|(ends, values)| both_rules(*ends, values))
                .collect();
            let whole: f64 = done.iter().sum::<f64>() + found.iter().map(|[value, _]| value).sum::<f64>();
            let mut next = Vec::new();
            for (ends, [value, off]) in pending.iter().zip(&found) {
                if *off <= MEAN * whole || round + 1 == MOST_ROUNDS {
                    done.push(*value);
                } else {
                    let middle = 0.5 * (ends[0] + ends[1]);
                    next.extend([[ends[0], middle], [middle, ends[1]]]);
                }
            }
            pending = next;
            if pending.is_empty() {
                break;
            }
        }
        let sphere = 1.0 - f64::from(1 + if l % 2 == 0 { 1 } else { -1 }) / (2.0 * f64::from(1 + l));
        Ok(done.iter().sum::<f64>() / (PI * diameter * diameter * sphere))
    }

    /// Refuses a table that begins too far out for the fastest that will be looked at, before slow ones take their time.
    ///
    /// # Errors
    /// As [`transport`](super::transport).
    fn check_begins(&self, largest: f64, most: f64) -> Result<()> {
        let intervals = self.intervals(largest, most);
        let points = intervals.iter().flat_map(|ends| (0..POINTS).map(|k| kronrod::place(*ends, k)));
        let fastest = points.filter(|y| *y <= most).fold(largest, f64::max);
        self.deflector.check_begins(Exponential::exp(fastest))
    }

    /// The least logarithm of an energy at which the weight is no less than 1e-11 of its largest.
    fn least(&mut self, weight: &Weight, ticker: &mut Ticker<'_>) -> Result<f64> {
        let largest = weight.largest();
        // Cross sections that grow towards slow collisions, at most as 1/E², put more there.
        let lowest = weight.origin - 26.0 / (weight.power - 2.0);
        let mut least = weight.origin - 26.0 / weight.power;
        let most_of_all = weight.logarithm(largest) + ln(self.one(largest, ticker)?);
        while least > lowest
            && weight.logarithm(least) + ln(self.one(least, ticker)?) > most_of_all - NEGLIGIBLE
        {
            least -= LONGEST;
        }
        Ok(least)
    }

    /// Intervals of one grid, cut where orbits begin or end to be, which reach from one end to the other.
    fn intervals(&self, least: f64, most: f64) -> Vec<[f64; 2]> {
        let origin = self.critical.first().copied().unwrap_or(0.0);
        let line = |k: f64| LONGEST.mul_add(k, origin);
        let (first, last) = (((least - origin) / LONGEST).floor(), ((most - origin) / LONGEST).ceil());
        let mut marks: Vec<f64> = (0..=(last - first) as usize).map(|k| line(first + k as f64)).collect();
        marks.extend(self.critical.iter().filter(|y| (line(first)..=line(last)).contains(y)));
        marks.sort_by(f64::total_cmp);
        marks.dedup();
        marks.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// Finds cross sections that are not known yet, side by side: each takes its time.
    fn find(&mut self, mut places: Vec<f64>, ticker: &mut Ticker<'_>) -> Result<()> {
        places.retain(|y| !self.known.contains_key(&y.to_bits()));
        let (deflector, l) = (self.deflector, self.orders.0);
        let found = for_chunks(self.threads, places.len(), ticker, |at, ticker| {
            transport_to(IN_MEAN, deflector, Exponential::exp(places[at]), l, 1, ticker)
        })?;
        self.known.extend(places.iter().map(|y| y.to_bits()).zip(found));
        Ok(())
    }

    fn one(&mut self, y: f64, ticker: &mut Ticker<'_>) -> Result<f64> {
        self.find(vec![y], ticker)?;
        Ok(self.known.get(&y.to_bits()).copied().unwrap_or(f64::NAN))
    }
}

/// e^(−E/T) (E/T)^(s+2) of y = ln E: what dE/T^(s+2) E^(s+1) e^(−E/T) is per dy.
struct Weight {
    power: f64,
    /// ln T.
    origin: f64,
}

impl Weight {
    fn logarithm(&self, y: f64) -> f64 {
        let x = y - self.origin;
        self.power * x - Exponential::exp(x)
    }
    fn at(&self, y: f64) -> f64 {
        Exponential::exp(self.logarithm(y))
    }
    /// Where it is largest.
    fn largest(&self) -> f64 {
        self.origin + ln(self.power)
    }
    /// Up to where it is no less than 1e-11 of that.
    fn most(&self) -> f64 {
        let largest = self.largest();
        let mut most = largest;
        // No further: what is faster may be captured, of which nothing counts.
        while self.logarithm(most) > self.logarithm(largest) - NEGLIGIBLE {
            most += 0.1;
        }
        most
    }
}
