//! Strata of the impact parameter: rings of the disc, each with a part of the events of its own.
//!
//! The one idea: the draw of the place is mapped to b²/b_max² piecewise linearly and rises with it, so an event stays one
//! draw and every tally a step function of it. All events of a stratum have one weight, so counts stay whole numbers, one
//! histogram for each stratum, and are weighted when they are read.

use super::beam::UNIT;
use crate::numerics::philox::DRAW_BITS;
use crate::words::number;
use crate::{Error, Result};

/// The most strata.
const MOST_STRATA: usize = 1 << 10;
/// The least part of the events of a stratum: its draws divide it 2^33 times or finer.
const LEAST: f64 = 1e-6;

/// One ring.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stratum {
    /// Its first draw, and how many draws are its own.
    start: u64,
    draws: f64,
    /// b²/b_max² where it begins, its part of the disc, and where it ends.
    share: f64,
    width: f64,
    end: f64,
}

/// Rings of a disc, from its center to its edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Strata {
    rings: Vec<Stratum>,
    b_max: f64,
}

impl Strata {
    /// Between impact parameters, the first of them 0 and the last the disc's radius, with parts of the events of which
    /// only the ratios count.
    ///
    /// # Errors
    /// `InvalidInput` naming `edges` that do not rise from 0 or divide the disc into parts that are no numbers, and
    /// `fractions` that are not positive, or less than 1e-6 of all.
    pub fn new(edges: &[f64], fractions: &[f64]) -> Result<Self> {
        let refused = |message: String| Err(Error::invalid("edges", message));
        let (Some(0.0), Some(b_max), 2..) = (edges.first(), edges.last(), edges.len()) else {
            let first = edges.first().map_or_else(|| "none".to_owned(), |first| number(*first));
            return refused(format!(
                "expected 2 or more impact parameters, the first of them 0, got {first}"
            ));
        };
        if edges.len() > MOST_STRATA + 1 {
            return refused(format!("expected at most {MOST_STRATA} strata, got {}", edges.len() - 1));
        }
        if !b_max.is_finite() {
            return refused(format!("expected finite impact parameters, the last is {}", number(*b_max)));
        }
        if fractions.len() + 1 != edges.len() {
            let (strata, got) = (edges.len() - 1, fractions.len());
            return Err(Error::invalid(
                "fractions",
                format!("expected one for each of {strata} strata, got {got}"),
            ));
        }
        let total: f64 = fractions.iter().sum();
        let least =
            fractions.iter().fold(f64::INFINITY, |least, part| if *part >= least { least } else { *part });
        if !(total.is_finite() && least / total >= LEAST) {
            let least = number(least);
            return Err(Error::invalid(
                "fractions",
                format!("expected positive numbers, each at least 1e-6 of their sum, got {least}"),
            ));
        }
        let (mut sum, mut start, mut rings) = (0.0, 0, Vec::with_capacity(fractions.len()));
        for (index, (pair, fraction)) in edges.windows(2).zip(fractions).enumerate() {
            let [from, to] = [pair[0] / b_max, pair[1] / b_max];
            // Of the difference of squares no digit is lost.
            let (share, width) = (from * from, (to - from) * (to + from));
            if !(pair[0] < pair[1] && width >= f64::MIN_POSITIVE) {
                return refused(format!(
                    "expected impact parameters that rise, by ratios of squares that are numbers, but {} is followed by {}",
                    number(pair[0]),
                    number(pair[1])
                ));
            }
            sum += fraction;
            let end = if index + 1 == fractions.len() {
                1 << DRAW_BITS
            } else {
                (sum / total / UNIT).round() as u64
            };
            rings.push(Stratum { start, draws: (end - start) as f64, share, width, end: to * to });
            start = end;
        }
        Ok(Self { rings, b_max: *b_max })
    }
    /// The radius of the disc.
    pub fn b_max(&self) -> f64 {
        self.b_max
    }
    /// How many.
    pub fn count(&self) -> usize {
        self.rings.len()
    }
    /// What an event of each stands for: the part of the disc by the part of the draws.
    pub fn weights(&self) -> Vec<f64> {
        self.rings.iter().map(|ring| ring.width / (ring.draws * UNIT)).collect()
    }
    /// The first draws of all but the first.
    pub(super) fn boundaries(&self) -> impl Iterator<Item = u64> {
        self.rings.iter().skip(1).map(|ring| ring.start)
    }
    /// The stratum of a draw.
    pub(super) fn stratum(&self, draw: u64) -> usize {
        self.rings.partition_point(|ring| ring.start <= draw).saturating_sub(1)
    }
    /// b²/b_max² of a draw.
    pub(super) fn share(&self, draw: u64) -> f64 {
        self.rings.get(self.stratum(draw)).map_or(0.0, |ring| {
            (ring.share + ring.width * (draw.saturating_sub(ring.start) as f64 / ring.draws)).min(ring.end)
        })
    }
    /// The draw at that b²/b_max².
    pub(super) fn draw(&self, share: f64) -> u64 {
        let index = self.rings.partition_point(|ring| ring.share <= share).saturating_sub(1);
        self.rings.get(index).map_or(0, |ring| {
            ring.start + ((share - ring.share) / ring.width * ring.draws).clamp(0.0, ring.draws) as u64
        })
    }
}

#[cfg(test)]
mod tests;
