//! Integrals with an estimate of what they lack.
//!
//! Of an even periodic function the trapezoid rule converges as fast as its Fourier series; of any other, Gauss–Legendre
//! on panels that are halved until a panel and its halves agree.

use crate::numerics::angles::cos;
use core::f64::consts::PI;
use std::sync::OnceLock;

/// Two integrals at once, of the time and of the angle.
pub(super) type Pair = [f64; 2];

/// Integrals and the largest error of each that is left, as estimated.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Integral {
    pub(super) value: Pair,
    pub(super) error: Pair,
}

/// Points of a panel.
const POINTS: usize = 16;
/// Halvings of a panel at most.
const DEPTH: u32 = 48;
/// Panels at most.
const PANELS: usize = 20_000;
/// Rounding of a sum.
const ROUNDING: f64 = 2e-16;

/// Nodes in [−1, 1] and weights.
fn rule() -> &'static [(f64, f64); POINTS] {
    static RULE: OnceLock<[(f64, f64); POINTS]> = OnceLock::new();
    RULE.get_or_init(|| {
        core::array::from_fn(|i| {
            let mut x = cos(PI * (i as f64 + 0.75) / (POINTS as f64 + 0.5));
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut before, mut here) = (1.0, x);
                for k in 2..=POINTS {
                    let k = k as f64;
                    (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
                }
                slope = POINTS as f64 * (x * here - before) / (x * x - 1.0);
                x -= here / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
    })
}

fn panel(f: &dyn Fn(f64) -> Pair, a: f64, b: f64) -> Pair {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let mut sum = [0.0; 2];
    for (x, weight) in rule() {
        let y = f(middle + half * x);
        sum[0] += weight * y[0];
        sum[1] += weight * y[1];
    }
    sum.map(|s| s * half)
}

/// The integral of positive functions between places, which ascend; nothing if the tolerance cannot be met.
pub(super) fn between(f: &dyn Fn(f64) -> Pair, places: &[f64], tolerance: f64) -> Option<Integral> {
    let mut open: Vec<(f64, f64, Pair, u32)> =
        places.windows(2).rev().map(|ends| (ends[0], ends[1], panel(f, ends[0], ends[1]), 0)).collect();
    let mut size = [0.0; 2];
    for (_, _, value, _) in &open {
        size = [size[0] + value[0].abs(), size[1] + value[1].abs()];
    }
    let mut total = Integral::default();
    let mut panels = open.len();
    while let Some((a, b, whole, depth)) = open.pop() {
        let middle = 0.5 * (a + b);
        let halves = [panel(f, a, middle), panel(f, middle, b)];
        let sum = [halves[0][0] + halves[1][0], halves[0][1] + halves[1][1]];
        let differ = [(sum[0] - whole[0]).abs(), (sum[1] - whole[1]).abs()];
        if !differ.iter().all(|x| x.is_finite()) {
            return None;
        }
        let met = |at: usize| differ[at] <= SHARE * tolerance * size[at].max(total.value[at].abs());
        if met(0) && met(1) {
            for at in 0..2 {
                total.value[at] += sum[at];
                total.error[at] += differ[at] + ROUNDING * sum[at].abs();
            }
            continue;
        }
        panels += 1;
        if depth >= DEPTH || panels > PANELS {
            return None;
        }
        open.push((middle, b, halves[1], depth + 1));
        open.push((a, middle, halves[0], depth + 1));
    }
    Some(total)
}

/// A panel may lack this part of the tolerance.
const SHARE: f64 = 0.05;

/// The mean over [0, π] of an even function of period 2π, sampled at so many equal steps that it is met; and samples.
pub(super) fn periodic(
    f: &dyn Fn(f64) -> Pair,
    tolerance: f64,
    most: usize,
) -> Option<(Integral, Vec<Pair>)> {
    let at = |k: usize, of: usize| f(PI * k as f64 / of as f64);
    let mut count = 8;
    let mut samples: Vec<Pair> = (0..=count).map(|k| at(k, count)).collect();
    let mean = |samples: &[Pair]| {
        let mut sum = [0.0; 2];
        for (k, sample) in samples.iter().enumerate() {
            let weight = if k == 0 || k + 1 == samples.len() { 0.5 } else { 1.0 };
            sum = [sum[0] + weight * sample[0], sum[1] + weight * sample[1]];
        }
        sum.map(|s| s / (samples.len() - 1) as f64)
    };
    let mut before = mean(&samples);
    while count < most {
        let mut next = Vec::with_capacity(2 * count + 1);
        for k in 0..count {
            next.push(samples[k]);
            next.push(at(2 * k + 1, 2 * count));
        }
        next.push(samples[count]);
        count *= 2;
        samples = next;
        let value = mean(&samples);
        let error: Pair = core::array::from_fn(|i| (value[i] - before[i]).abs() + ROUNDING * value[i].abs());
        if !error.iter().all(|x| x.is_finite()) {
            return None;
        }
        if (0..2).all(|i| error[i] <= tolerance * value[i].abs()) {
            let integral = Integral { value: value.map(|x| x * PI), error: error.map(|x| x * PI) };
            return Some((integral, samples));
        }
        before = value;
    }
    None
}
