//! The draws at which a step function of monotone quantities steps.
//!
//! The one idea: one bisection for each step. Where a quantity is an edge to the last bit over many draws, as the energy of what
//! is hardly deflected is that of the beam, its rounding steps there and back: such stretches are looked at in many places.

use crate::Result;
use crate::parallel::Ticker;

/// Of a quantity against an edge: what rounding makes of it.
const ROUNDED: f64 = 8.0 * f64::EPSILON;
/// Stretches of fewer draws, a part of 2⁻²⁷ of all, hold no event that anybody sees.
const WIDE: u64 = 1 << 26;
/// Places at which longer ones are looked at.
const LOOKS: u64 = 1 << 10;

/// A draw, and what is seen there.
#[derive(Clone, Copy, Debug)]
pub struct Seen<V> {
    /// The draw.
    pub draw: u64,
    /// Its slot.
    pub slot: usize,
    /// Whatever tells how far it is from another.
    pub values: V,
}

/// Two draws, the first before the second.
type Pair<V> = (Seen<V>, Seen<V>);

/// A function of the draw with steps, of quantities that are continuous.
pub trait Stepping {
    /// What is known of a draw besides its slot.
    type Values: Copy;
    /// At a draw.
    fn seen(&self, draw: u64) -> Seen<Self::Values>;
    /// Two numbers of different signs, between which the only step between two draws is where the quantity would be zero; if
    /// there is but one.
    fn sides(&self, low: &Seen<Self::Values>, high: &Seen<Self::Values>) -> Option<[f64; 2]>;
    /// By what part of the edge between two draws, of which one comes after the other, the quantity is off it at a third.
    fn apart(&self, step: [&Seen<Self::Values>; 2], of: &Seen<Self::Values>) -> f64;
}

/// How far a guess is moved inward from where a line is zero, so that both ends of a bracket come nearer.
const INWARD: f64 = 0.2;

/// Adds every draw in `from + 1..=to` whose slot differs from that of the draw before. The slot is that of monotone
/// quantities, so where both ends agree there is no step; where they differ by one, it is guessed by a line, and in no case
/// are there many more evaluations than halvings.
/// Source: I. F. D. Oliveira, R. H. C. Takahashi, ACM Trans. Math. Softw. 47 (2020) 5.
pub(super) fn steps_between<F: Stepping>(
    [from, to]: [u64; 2],
    function: &F,
    steps: &mut Vec<u64>,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    let mut found = Vec::new();
    let ends = (function.seen(from), function.seen(to));
    bisect(vec![ends], function, &mut found, ticker)?;
    for (low, high) in found {
        let zone = flat(function, [&low, &high], [from, to]);
        if zone[1] - zone[0] < WIDE {
            steps.push(high.draw);
            continue;
        }
        let place =
            |k: u64| zone[0] + ((u128::from(zone[1] - zone[0]) * u128::from(k)) / u128::from(LOOKS)) as u64;
        let looks: Vec<Seen<F::Values>> = (0..=LOOKS).map(|k| function.seen(place(k))).collect();
        let pairs = looks.windows(2).map(|pair| (pair[0], pair[1])).collect();
        let mut flickers = Vec::new();
        bisect(pairs, function, &mut flickers, ticker)?;
        steps.extend(flickers.iter().map(|(_, high)| high.draw));
    }
    Ok(())
}

/// The draws about a step at which the quantity is the edge but for rounding, as far as they go; nothing but the step where
/// they are few.
fn flat<F: Stepping>(function: &F, step: [&Seen<F::Values>; 2], [from, to]: [u64; 2]) -> [u64; 2] {
    let is_flat = |draw: u64| function.apart(step, &function.seen(draw)) <= ROUNDED;
    let [low, high] = step.map(|end| end.draw);
    let mut zone = [low, high];
    let mut reach = WIDE;
    while low > from && is_flat(low.saturating_sub(reach).max(from)) {
        zone[0] = low.saturating_sub(reach).max(from);
        if zone[0] == from {
            break;
        }
        reach *= 2;
    }
    reach = WIDE;
    while high < to && is_flat((high + reach).min(to)) {
        zone[1] = (high + reach).min(to);
        if zone[1] == to {
            break;
        }
        reach *= 2;
    }
    zone
}

/// Both draws of each step within such pairs.
fn bisect<F: Stepping>(
    mut pending: Vec<Pair<F::Values>>,
    function: &F,
    steps: &mut Vec<Pair<F::Values>>,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    while let Some((mut low, mut high)) = pending.pop() {
        ticker.tick()?;
        if low.slot == high.slot {
            continue;
        }
        let first = (high.draw - low.draw) as f64;
        // What the bracket must not be longer than: twice that of halvings.
        let mut longest = 2.0 * first;
        loop {
            let width = high.draw - low.draw;
            if width == 1 {
                steps.push((low, high));
                break;
            }
            longest *= 0.5;
            let sides = function.sides(&low, &high);
            let part = sides.map_or(width / 2, |sides| guess(width, sides, [first, longest]));
            let middle = function.seen(low.draw + part.clamp(1, width - 1));
            if middle.slot == low.slot {
                low = middle;
            } else if middle.slot == high.slot {
                high = middle;
            } else {
                pending.push((low, middle));
                pending.push((middle, high));
                break;
            }
        }
    }
    Ok(())
}

/// Where in a bracket to look next: where a line is zero, moved inward, and so near to the middle that what is left is no
/// longer than it may be.
fn guess(width: u64, [low, high]: [f64; 2], [first, longest]: [f64; 2]) -> u64 {
    let width = width as f64;
    let half = 0.5 * width;
    let line = width * (low / (low - high));
    let inward = (INWARD * width * (width / first)).min((half - line).abs());
    let moved = line + inward.copysign(half - line);
    let around = (longest - half).max(0.0);
    (moved.clamp(half - around, half + around)).round() as u64
}
