//! Places on the way out from a turning point: r = r₀ cosh w, and what the integrand takes of w.

use super::spectrum::Fall;
use crate::numerics::angles::cos;
use crate::numerics::elementary::{Exponential, ln};
use core::f64::consts::PI;
use std::sync::OnceLock;

/// How often the first step is halved at most.
pub(super) const LEVELS: usize = 5;
/// How far nodes go at most: e^−w is then below all that counts.
const FARTHEST: f64 = 40.0;
/// Tolerances down to which there is a first step, and that step: what potentials that repel need as a rule.
const FIRST: [(f64, f64); 5] = [(1e-5, 0.5), (1e-8, 0.36), (1e-10, 0.28), (1e-12, 0.23), (0.0, 0.2)];

/// A place w.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// r/r₀ = cosh w.
    pub(super) cosh: f64,
    /// u = r₀/r.
    pub(super) ratio: f64,
    /// 1/tanh² w.
    pub(super) weight: f64,
}

impl Node {
    pub(super) fn at(w: f64) -> Self {
        let sinh = sinh(w);
        let cosh = (1.0 + sinh * sinh).sqrt();
        Self { cosh, ratio: 1.0 / cosh, weight: (cosh / sinh) * (cosh / sinh) }
    }
}

/// sinh w, without the difference of exponentials near zero.
fn sinh(w: f64) -> f64 {
    if w < 0.6 {
        let square = w * w;
        // To w²¹/21!, below 1e-24 of the whole.
        let series = (1..=10).rev().fold(1.0, |sum: f64, k| {
            let k = f64::from(k);
            sum * square / (2.0 * k * (2.0 * k + 1.0)) + 1.0
        });
        return w * series;
    }
    let grown = Exponential::exp(w);
    0.5 * (grown - 1.0 / grown)
}

/// Frequencies, as sixteenths of the highest that steps see: those above, from which one looks further up, and those
/// below, from which they must have come down.
pub(super) const FREQUENCIES: [usize; 8] = [16, 15, 14, 13, 12, 9, 8, 7];
/// How many of them are above.
pub(super) const ABOVE: usize = 5;

/// Steps of one length.
#[derive(Debug)]
pub(super) struct Level {
    pub(super) step: f64,
    /// The nodes that it adds: of the first level w = step, 2 step, …; of the others the odd multiples of the step.
    pub(super) nodes: Vec<Node>,
    /// Sums of u³, u⁵, u⁷ times cos(frequency × w) over all steps; of the last row times 1.
    pub(super) powers: [[f64; 3]; FREQUENCIES.len() + 1],
    /// How spectra are taken to fall on: where V repels everywhere, and elsewhere.
    pub(super) falls: [Fall; 2],
}

/// Steps that are halved.
#[derive(Debug)]
pub(super) struct Ladder {
    first: f64,
    levels: [OnceLock<Level>; LEVELS + 1],
    counts: Vec<u8>,
}

impl Ladder {
    /// For a tolerance.
    pub(super) fn of(tolerance: f64) -> &'static Self {
        static LADDERS: [OnceLock<Ladder>; FIRST.len()] = [const { OnceLock::new() }; FIRST.len()];
        let at = FIRST.iter().position(|(least, _)| tolerance >= *least).unwrap_or(FIRST.len() - 1);
        LADDERS[at].get_or_init(|| {
            let (_, first) = FIRST[at];
            Self { first, levels: [const { OnceLock::new() }; LEVELS + 1], counts: counts(first) }
        })
    }
    /// Steps that were halved so often.
    pub(super) fn level(&self, level: usize) -> &Level {
        self.levels[level].get_or_init(|| {
            let step = self.first / f64::from(1_u32 << level);
            let count = (FARTHEST / self.first) as usize;
            let nodes = if level == 0 { count } else { count << (level - 1) };
            let multiple = |k: usize| if level == 0 { k + 1 } else { 2 * k + 1 };
            Level {
                step,
                nodes: (0..nodes).map(|k| Node::at(step * multiple(k) as f64)).collect(),
                powers: powers(step),
                falls: Fall::both(step),
            }
        })
    }
    /// How many nodes of the first level are before r = `cosh` × r₀, or some more; none if there are not so many.
    #[inline(always)]
    pub(super) fn count(&self, cosh: f64) -> u8 {
        let cell = (cosh.to_bits() >> CELLS).saturating_sub(ONE) as usize;
        self.counts.get(cell).copied().unwrap_or(0)
    }
}

/// Sixteen cells to an octave, as bits of a number, and that of 1.
const CELLS: u32 = 48;
const ONE: u64 = 1023 << 4;

/// The numbers of nodes to the end of each cell of cosh w.
fn counts(step: f64) -> Vec<u8> {
    // w ≤ ln 2 cosh w.
    let count = |cell: u64| ln(2.0 * f64::from_bits((ONE + cell + 1) << CELLS)) / step;
    (0..).map(count).take_while(|count| *count * step < FARTHEST - 1.0).map(|count| count as u8 + 1).collect()
}

/// cos(π k m/16) of the frequencies m for k from 0 to 31: all there are.
pub(super) fn cosines() -> &'static [[f64; FREQUENCIES.len()]; 32] {
    static COSINES: OnceLock<[[f64; FREQUENCIES.len()]; 32]> = OnceLock::new();
    COSINES
        .get_or_init(|| core::array::from_fn(|k| FREQUENCIES.map(|m| cos(PI * ((k * m) % 32) as f64 / 16.0))))
}

fn powers(step: f64) -> [[f64; 3]; FREQUENCIES.len() + 1] {
    let mut sums = [[0.0; 3]; FREQUENCIES.len() + 1];
    let nodes = (FARTHEST / step) as usize;
    for k in (0..nodes).rev() {
        let u = if k == 0 { 1.0 } else { Node::at(step * k as f64).ratio };
        let weight = if k == 0 { 0.5 * step } else { step };
        for (row, sum) in sums.iter_mut().enumerate() {
            let cosine = if row < FREQUENCIES.len() { cosines()[k % 32][row] } else { 1.0 };
            let mut power = weight * cosine * u;
            for sum in sum {
                power *= u * u;
                *sum += power;
            }
        }
    }
    sums
}
