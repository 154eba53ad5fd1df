//! Places on the way out from a turning point: r = r₀ cosh w, and what the integrand takes of w.

use crate::numerics::elementary::Exponential;
use std::sync::OnceLock;

/// The first distance of nodes, and how often it is halved at most.
pub(super) const COARSEST: f64 = 0.5;
pub(super) const LEVELS: usize = 5;
/// How far nodes go at most: e^−w is then below all that counts.
const FARTHEST: usize = 40;

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
pub(super) fn sinh(w: f64) -> f64 {
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

/// The nodes that each level adds: w = k/2 of level 0, k = 1, 2, …; of level j the odd multiples of 2^−j/2.
pub(super) fn levels() -> &'static [Vec<Node>; LEVELS + 1] {
    static LEVELS_OF_NODES: OnceLock<[Vec<Node>; LEVELS + 1]> = OnceLock::new();
    LEVELS_OF_NODES.get_or_init(|| {
        core::array::from_fn(|level| {
            let h = COARSEST / f64::from(1_u32 << level);
            let count = (FARTHEST as f64 / COARSEST) as usize;
            let multiples = |k: usize| if level == 0 { k + 1 } else { 2 * k + 1 };
            let nodes = if level == 0 { count } else { count << (level - 1) };
            (0..nodes).map(|k| Node::at(h * multiples(k) as f64)).collect()
        })
    })
}
