//! The deflections of a range of energies: a few tables, and between them a polynomial in the inverse of the energy.
//!
//! The one idea: where nothing orbits and nothing is captured ψ is smooth in the energy, and at one impact parameter the
//! polynomial through Chebyshev points of the range has it. Taken in 1/E, in which ψ falls to zero as a series does, the
//! points crowd where it changes most, towards the energies that orbit. Whether it is smooth enough is not assumed but
//! tried, as it is for one table: directly, at energies and impact parameters between those that it is made of.

use super::{EventTable, MOST_ERROR, Piece};
use crate::Result;
use crate::numerics::angles::{cos, sin};
use crate::numerics::philox::{draw_of, key};
use crate::parallel::{Ticker, for_chunks};
use crate::scattering::deflection::{Deflector, Status};
use core::f64::consts::PI;

/// How many tables: the first that does.
const ORDERS: [usize; 4] = [3, 5, 9, 17];
/// Bytes of all of them.
const MOST_BYTES: usize = 1 << 20;
/// An error may fall so much further than by the rule that the last order is not tried without hope.
const FASTER: f64 = 100.0;
/// Places at which the whole is tried.
const CERTIFYING: u64 = 768;

/// The deflections of a range of energies, b from 0 to b_max.
#[derive(Clone, Debug, PartialEq)]
pub struct Energies {
    /// The lowest energy.
    pub(super) low: f64,
    /// Each with what part of its energy that is, and its weight in the barycentric formula.
    pub(super) tables: Vec<(f64, f64, EventTable)>,
    error: f64,
}

impl Energies {
    /// Of relative motion with energies from the first to the second; nothing if ψ is not smooth enough in that range.
    ///
    /// # Errors
    /// As [`EventTable::build`]; `Interrupted`.
    pub fn build(
        deflector: &Deflector,
        [low, high]: [f64; 2],
        b_max: f64,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<Self>> {
        let mut tables: Vec<EventTable> = Vec::new();
        let mut errors: Vec<f64> = Vec::new();
        for order in ORDERS {
            let last = (order - 1) as f64;
            let least = low / high;
            let shares =
                (0..order).map(|k| 0.5 * (1.0 + least) + 0.5 * (1.0 - least) * cos(PI * k as f64 / last));
            let energies: Vec<f64> = shares.map(|share| (low / share).clamp(low, high)).collect();
            // Every second energy is one of the order before.
            let stride = if tables.is_empty() { 1 } else { 2 };
            let new: Vec<f64> = energies.iter().skip(stride - 1).step_by(stride).copied().collect();
            let built = for_chunks(threads, new.len(), ticker, |k, ticker| {
                EventTable::build(deflector, new[k], b_max, 1, ticker)
            })?;
            if built.iter().any(|table| table.pieces.contains(&Piece::Captured)) {
                return Ok(None);
            }
            tables = alternating(tables, built);
            let bytes: usize = tables.iter().map(EventTable::bytes).sum();
            if bytes > MOST_BYTES {
                return Ok(None);
            }
            // (−1)^k, and half of it at the ends.
            let weight = |k: usize| {
                let size = if k == 0 || k + 1 == order { 0.5 } else { 1.0 };
                if k.is_multiple_of(2) { size } else { -size }
            };
            let weighted =
                tables.into_iter().enumerate().map(|(k, table)| (low / energies[k], weight(k), table));
            let mut made = Self { low, tables: weighted.collect(), error: 0.0 };
            let error = made.tried(deflector, [low, high], b_max, threads, ticker)?;
            if error <= MOST_ERROR {
                made.error = error;
                return Ok(Some(made));
            }
            errors.push(error);
            if is_in_vain(&errors) {
                return Ok(None);
            }
            tables = made.tables.into_iter().map(|(_, _, table)| table).collect();
        }
        Ok(None)
    }
    /// ψ of an energy of the range where b is this part of b_max, signed and not folded.
    pub fn angle(&self, energy: f64, part: f64) -> Option<f64> {
        let share = self.low / energy;
        let (mut over, mut under) = (0.0, 0.0);
        for (node, weight, table) in &self.tables {
            let angle = table.angle(part)?;
            if share == *node {
                return Some(angle);
            }
            let weight = weight / (share - node);
            over += weight * angle;
            under += weight;
        }
        Some(over / under)
    }
    /// The tables, in the order of energies.
    pub fn tables(&self) -> impl Iterator<Item = &EventTable> {
        self.tables.iter().map(|(_, _, table)| table)
    }
    /// The largest difference of sin²(ψ/2) from direct quadrature, of all places that were tried.
    pub fn error(&self) -> f64 {
        self.error
    }
    /// The largest error at random places, and at random energies beside the ends of all pieces.
    fn tried(
        &self,
        deflector: &Deflector,
        [low, high]: [f64; 2],
        b_max: f64,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let random =
            |i: u64, number| draw_of(key(0x656e_6572), i, number).number() as f64 / (1_u64 << 53) as f64;
        let ends = self.tables().flat_map(|table| {
            let wide = table.starts.windows(2).filter(|pair| pair[1] - pair[0] > 1e-6);
            wide.map(|pair| pair[0] + 0.02 * (pair[1] - pair[0]))
        });
        let parts: Vec<f64> = (0..CERTIFYING).map(|i| random(i, 0).sqrt()).chain(ends).collect();
        let energies: Vec<f64> =
            (0..parts.len() as u64).map(|i| (low + (high - low) * random(i, 1)).clamp(low, high)).collect();
        let b: Vec<f64> = parts.iter().map(|part| part * b_max).collect();
        let found = deflector.deflect(&energies, &b, false, threads, ticker)?;
        let square = |angle: f64| sin(0.5 * angle) * sin(0.5 * angle);
        let mut worst = 0.0;
        for (at, found) in found.iter().enumerate() {
            let off = match self.angle(energies[at], parts[at]) {
                Some(angle) if found.status != Status::Captured => {
                    (square(angle) - square(found.angle)).abs()
                }
                _ => 1.0,
            };
            if off.is_nan() || off > worst {
                worst = if off.is_nan() { 1.0 } else { off };
            }
        }
        Ok(worst)
    }
}

/// The tables of an order, in turn of the order before and new ones; the new ones where there are no others.
fn alternating(before: Vec<EventTable>, new: Vec<EventTable>) -> Vec<EventTable> {
    if before.is_empty() {
        return new;
    }
    let mut new = new.into_iter();
    before.into_iter().flat_map(|table| [Some(table), new.next()]).flatten().collect()
}

/// Whether the last order will not do either, after the errors of all but that: falling geometrically, they fall by the square of
/// what they just fell by.
fn is_in_vain(errors: &[f64]) -> bool {
    let [.., before, last] = errors else { return false };
    let fell = last / before;
    errors.len() + 1 == ORDERS.len() && last * fell * fell > FASTER * MOST_ERROR
}

#[cfg(test)]
mod tests;
