//! Means of transport cross sections over energies: collision integrals Ω^(l,s)(T).
//!
//! The one idea: in the logarithm of the energy the weight falls as fast as an exponential on both sides, and the cross section
//! is smooth but where orbits begin to be. So intervals end there, and are halved where two rules differ.

use super::super::deflection::Deflector;
use super::super::kronrod::{self, POINTS};
use super::transport::{LONGEST, both_rules, transport_to};
use crate::Result;
use crate::numerics::elementary::{Exponential, ln};
use crate::parallel::{Ticker, for_chunks};
use core::f64::consts::PI;

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

/// Ω^(l,s)*(T) = ∫ Q^(l)(E) e^(−E/T) E^(s+1) dE / ((s + 1)! T^(s+2) π d² (1 − (1 + (−1)^l)/(2(1 + l)))): in units of what
/// hard spheres of diameter `d` have. T is k_B times the temperature, an energy.
///
/// # Errors
/// As [`transport`](super::transport).
pub fn collision_integral(
    deflector: &Deflector,
    temperature: f64,
    orders: (u32, u32),
    diameter: f64,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<f64> {
    let (l, s) = orders;
    // x = ln(E/T): the weight e^(−eˣ + (s+2)x) is below 1e-11 of its largest, at eˣ = s + 2, outside of these.
    let power = f64::from(s + 2);
    let weight = |x: f64| power * x - Exponential::exp(x);
    let mut least = -26.0 / power;
    // No further: what is faster may be captured, of which nothing counts.
    let mut most = ln(power);
    while weight(most) > weight(ln(power)) - NEGLIGIBLE {
        most += 0.1;
    }
    // Cross sections that grow towards slow collisions, at most as 1/E², put more there.
    let of = |x: f64, ticker: &mut Ticker<'_>| {
        let energy = temperature * Exponential::exp(x);
        Ok(weight(x) + ln(transport_to(IN_MEAN, deflector, energy, l, threads, ticker)?))
    };
    let most_of_all = of(ln(power), ticker)?;
    while least > -26.0 / f64::from(s) && of(least, ticker)? > most_of_all - NEGLIGIBLE {
        least -= LONGEST;
    }
    let mut marks = vec![least, most];
    marks.extend(deflector.critical_energies().iter().map(|energy| ln(energy / temperature)));
    marks.retain(|x| (least..=most).contains(x));
    marks.sort_by(f64::total_cmp);
    marks.dedup();
    let mut pending: Vec<[f64; 2]> = Vec::new();
    for pair in marks.windows(2) {
        let parts = ((pair[1] - pair[0]) / LONGEST).ceil().max(1.0);
        let at = |k: f64| (pair[1] - pair[0]).mul_add(k / parts, pair[0]);
        pending.extend((0..parts as usize).map(|part| [at(part as f64), at(part as f64 + 1.0)]));
    }
    let factorial: f64 = (1..=s + 1).map(f64::from).product();
    let mut done: Vec<f64> = Vec::new();
    for round in 0..MOST_ROUNDS {
        let points: Vec<f64> =
            pending.iter().flat_map(|ends| (0..POINTS).map(|k| kronrod::place(*ends, k))).collect();
        // Energies side by side: each takes its time.
        let values = for_chunks(threads, points.len(), ticker, |at, ticker| {
            let share = Exponential::exp(points[at]);
            let weight = Exponential::exp(power * points[at] - share) / factorial;
            let found = transport_to(IN_MEAN, deflector, temperature * share, l, 1, ticker)?;
            Ok(weight * found)
        })?;
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
