//! ∫ from −π/2 to π/2 of integrands that are periodic and smooth, or nearly so.
//!
//! The one idea: of a smooth periodic function equal steps square their error with every doubling. What is narrower than
//! they are is looked for on a finer grid that shares no node with them, and where there is a kink, panels are halved
//! towards it.

use super::gauss;
use crate::error::{Error, Result};
use core::f64::consts::{FRAC_PI_2, PI};

/// Nodes that are begun with, and the most there are.
const NODES: (usize, usize) = (16, 1 << 15);
/// Nodes of the grid that looks for what is narrow.
const LOOKING: usize = 2039;
/// Sums that agree to this are exact.
const AGREEMENT: f64 = 4e-15;
/// As often a panel is halved, how many there may be, and which part of the whole is nothing.
const HALVINGS: u32 = 60;
const MOST_PANELS: usize = 20_000;
const NOTHING: f64 = 1e-15;

/// ∫ of two integrands that are known to a part `noise` of themselves.
///
/// # Errors
/// Integrands that are no numbers somewhere, or that no halving makes smooth.
pub(super) fn integral(of: &mut impl FnMut(f64) -> [f64; 2], noise: f64) -> Result<[f64; 2]> {
    let (mut nodes, mut last, mut looked) = (NODES.0, [f64::NAN; 2], false);
    while nodes <= NODES.1 {
        let found = equal_steps(of, nodes)?;
        if agree(found, last, nodes, noise) {
            if looked || agree(equal_steps(of, LOOKING)?, found, LOOKING, noise) {
                return Ok(found);
            }
            (nodes, looked) = (LOOKING, true);
        }
        last = found;
        nodes *= 2;
    }
    halved(of, last, noise)
}

fn agree(a: [f64; 2], b: [f64; 2], nodes: usize, noise: f64) -> bool {
    let rounding = AGREEMENT * (1.0 + (nodes as f64).sqrt() / 8.0) + 4.0 * noise;
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= rounding * a.abs())
}

/// The sum through the middles of equal steps, compensated.
fn equal_steps(of: &mut impl FnMut(f64) -> [f64; 2], nodes: usize) -> Result<[f64; 2]> {
    let h = PI / nodes as f64;
    let mut sum = Compensated::default();
    for k in 0..nodes {
        sum.add(of(-FRAC_PI_2 + (k as f64 + 0.5) * h));
    }
    let found = sum.value.map(|sum| sum * h);
    if found.iter().all(|x| x.is_finite()) {
        Ok(found)
    } else {
        Err(Error::invalid(
            "position",
            "the motion turns back on the way, or stops there: its speed is no number",
        ))
    }
}

/// By panels that are halved until both halves together change nothing of the whole, which is about `whole`.
fn halved(of: &mut impl FnMut(f64) -> [f64; 2], whole: [f64; 2], noise: f64) -> Result<[f64; 2]> {
    let (nodes, weights) = gauss::quadrature();
    let mut panel = |from: f64, width: f64| {
        let mut sum = [0.0; 2];
        for (x, w) in nodes.iter().zip(weights) {
            let values = of(from + x * width);
            sum = [sum[0] + w * values[0], sum[1] + w * values[1]];
        }
        sum.map(|sum| sum * width)
    };
    let mut sum = Compensated::default();
    let mut open = vec![(-FRAC_PI_2, PI, panel(-FRAC_PI_2, PI), 0)];
    let mut closed = 0;
    while let Some((from, width, value, depth)) = open.pop() {
        let half = 0.5 * width;
        let parts = [panel(from, half), panel(from + half, half)];
        let change = |i: usize| (parts[0][i] + parts[1][i] - value[i]).abs();
        let settled = (0..2).all(|i| change(i) <= NOTHING * whole[i].abs() + 4.0 * noise * value[i].abs());
        if settled || depth == HALVINGS {
            sum.add(parts[0]);
            sum.add(parts[1]);
            closed += 1;
        } else {
            open.push((from, half, parts[0], depth + 1));
            open.push((from + half, half, parts[1], depth + 1));
        }
        if closed + open.len() > MOST_PANELS {
            return Err(Error::invalid(
                "position",
                "the quadrature does not converge: the speed along the motion has more kinks or steeper slopes than it \
                 can follow",
            ));
        }
    }
    if sum.value.iter().all(|x| x.is_finite()) {
        Ok(sum.value)
    } else {
        Err(Error::invalid(
            "position",
            "the motion turns back on the way, or stops there: its speed is no number",
        ))
    }
}

/// Two sums, and what rounding has left out of them.
#[derive(Default)]
struct Compensated {
    value: [f64; 2],
    rest: [f64; 2],
}

impl Compensated {
    fn add(&mut self, values: [f64; 2]) {
        for index in 0..2 {
            let change = values[index] + self.rest[index];
            let sum = self.value[index] + change;
            self.rest[index] = change - (sum - self.value[index]);
            self.value[index] = sum;
        }
    }
}
