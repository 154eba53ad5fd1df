//! The integrands of one pair at the points of an interval, side by side, and what the rules of an interval make of them.
//!
//! The one idea: beside a barrier, or a turning point at one, 1/√G has a peak as narrow as b is near to orbiting. There w is
//! measured in s, w = place ± width × sinh s: the logarithm that the peak makes is a straight line in s, and a few intervals
//! of s do what would be many of w.

use super::adaptive::{Integrand, Pair};
use super::comparison::Comparison;
use super::profile::Profile;
use super::trapezoid::INTEGRALS;
use crate::numerics::elementary::Exponential;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH, as_numbers};
use crate::numerics::real::Mask;
use crate::scattering::kronrod;
use crate::tiered;

/// Points of a rule, filled up to whole rows.
const ROWS: usize = 2;
/// Of Gauss and Legendre between 0 and 1: places and weights.
const MEAN: [[f64; 2]; 4] = [
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
];
/// Up to here sinh is a series, to w²¹/21!, below 1e-24 of the whole.
const SMALL: f64 = 0.6;

type Rows = [Lanes; ROWS];
/// The points of the rule between −1 and 1, and the last one again, to fill the row.
static ABSCISSAS: Rows = {
    let mut rows = EMPTY;
    let mut k = 0;
    while k < ROWS * WIDTH {
        rows[k / WIDTH].0[k % WIDTH] = kronrod::abscissa(if k < kronrod::POINTS { k } else { k - 1 });
        k += 1;
    }
    rows
};
const EMPTY: Rows = [Lanes([0.0; WIDTH]); ROWS];

/// How an interval is measured: w = s if the width is 0, else w = `from` + `width` × sinh s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Measure {
    pub(super) from: f64,
    pub(super) width: f64,
}

/// What is integrated of which pair.
#[derive(Clone, Copy, Debug)]
pub(super) struct Task<'a> {
    pub(super) profile: &'a Profile,
    pub(super) pair: &'a Pair,
    pub(super) comparison: Comparison,
    pub(super) integrand: Integrand,
    /// How many integrals are asked for.
    pub(super) wanted: usize,
}

/// Both rules over one interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    pub(super) measure: Measure,
    /// Of s.
    pub(super) ends: [f64; 2],
    pub(super) integral: [f64; INTEGRALS],
    pub(super) error: [f64; INTEGRALS],
    pub(super) size: [f64; INTEGRALS],
}

/// Places on the way out, and dw/ds there.
#[derive(Clone, Copy, Debug)]
struct Places {
    w: Rows,
    scale: Rows,
    cosh: Rows,
    ratio: Rows,
    weight: Rows,
    distance: Rows,
}

impl Interval {
    /// Over those s.
    pub(super) fn new(task: &Task<'_>, measure: Measure, ends: [f64; 2]) -> Self {
        let pair = task.pair;
        let mut places =
            Places { w: EMPTY, scale: EMPTY, cosh: EMPTY, ratio: EMPTY, weight: EMPTY, distance: EMPTY };
        spread_tier(pair.turning, measure, ends, &mut places);
        let (mut value, mut force, mut mean) = (EMPTY, EMPTY, EMPTY);
        task.profile.values(&places.distance, &mut value);
        if task.integrand == Integrand::Turning || task.wanted > 1 {
            task.profile.forces(&places.distance, &mut force);
        }
        if as_numbers(&places.w).iter().any(|w| *w < pair.near) {
            let mut rows = [Lanes([0.0; WIDTH]); ROWS * MEAN.len()];
            let mut forces = rows;
            between_tier(pair.turning, &places.w, &mut rows);
            task.profile.forces(&rows, &mut forces);
            means_tier(pair.turning / pair.energy, &forces, &mut mean);
        }
        let mut values = [EMPTY; INTEGRALS];
        integrands_tier(task, &places, [&value, &force, &mean], &mut values);
        let none = [0.0; INTEGRALS];
        let mut interval = Self { measure, ends, integral: none, error: none, size: none };
        for i in 0..task.wanted.min(INTEGRALS) {
            let values = as_numbers(&values[i]);
            let found = kronrod::estimate(ends, |k| values[k]);
            interval.integral[i] = found.integral;
            interval.error[i] = found.error;
            interval.size[i] = found.size;
        }
        interval
    }
}

/// sinh w of w that are not negative, without the difference of exponentials near zero.
#[inline(always)]
fn sinh<V: Vector8 + Exponential>(w: V) -> V {
    let (one, square) = (V::one(), w * w);
    let mut series = one;
    for k in (1..=10).rev() {
        let k = f64::from(k);
        series = (series * square).multiply_add(V::splat(1.0 / (2.0 * k * (2.0 * k + 1.0))), one);
    }
    let grown = w.exp();
    V::select(w.less(V::splat(SMALL)), w * series, V::splat(0.5) * (grown - one / grown))
}

#[inline(always)]
fn spread<V: Vector8 + Exponential>(turning: f64, measure: Measure, ends: [f64; 2], places: &mut Places) {
    let one = V::one();
    let [from, to] = ends;
    let (middle, half) = (V::splat(0.5 * (from + to)), V::splat(0.5 * (to - from)));
    for row in 0..ROWS {
        let (mut w, mut scale) = (half.multiply_add(V::load(ABSCISSAS[row]), middle), one);
        if measure.width != 0.0 {
            let sinh = sinh(w);
            scale = V::splat(measure.width.abs()) * sinh.multiply_add(sinh, one).sqrt();
            w = sinh.multiply_add(V::splat(measure.width), V::splat(measure.from));
        }
        let sinh = sinh(w);
        let cosh = sinh.multiply_add(sinh, one).sqrt();
        let inverse = cosh / sinh;
        places.w[row] = w.store();
        places.scale[row] = scale.store();
        places.cosh[row] = cosh.store();
        places.ratio[row] = (one / cosh).store();
        places.weight[row] = (inverse * inverse).store();
        places.distance[row] = (V::splat(turning) * cosh).store();
    }
}

/// Places between r₀ and r₀ cosh w, for the mean of the force there.
#[inline(always)]
fn between<V: Vector8 + Exponential>(turning: f64, w: &Rows, rows: &mut [Lanes; ROWS * MEAN.len()]) {
    let turning = V::splat(turning);
    for row in 0..ROWS {
        let half = sinh(V::splat(0.5) * V::load(w[row]));
        let way = V::splat(2.0) * half * half;
        for i in 0..MEAN.len() {
            let place = turning * V::splat(MEAN[i][0]);
            rows[i * ROWS + row] = place.multiply_add(way, turning).store();
        }
    }
}

/// The mean force, times r₀/E.
#[inline(always)]
fn means<V: Vector8>(factor: f64, forces: &[Lanes; ROWS * MEAN.len()], mean: &mut Rows) {
    for row in 0..ROWS {
        let mut parts = [V::zero(); MEAN.len()];
        for i in 0..MEAN.len() {
            parts[i] = V::splat(MEAN[i][1]) * V::load(forces[i * ROWS + row]);
        }
        let [a, b, c, d] = parts;
        mean[row] = (V::splat(factor) * ((a + d) + (b + c))).store();
    }
}

/// What is integrated over s.
#[inline(always)]
fn integrands<V: Vector8>(
    task: &Task<'_>,
    places: &Places,
    [value, force, mean]: [&Rows; 3],
    out: &mut [Rows; INTEGRALS],
) {
    let (pair, comparison) = (task.pair, &task.comparison);
    let (zero, one, half) = (V::zero(), V::one(), V::splat(0.5));
    let (x, y, root0) = (V::splat(pair.value), V::splat(pair.force), V::splat(pair.root));
    let (energy, square) = (V::splat(pair.energy), V::splat(pair.root * pair.root));
    for row in 0..ROWS {
        let (w, scale) = (V::load(places.w[row]), V::load(places.scale[row]));
        let (u, cosh, weight) =
            (V::load(places.ratio[row]), V::load(places.cosh[row]), V::load(places.weight[row]));
        let v = V::load(value[row]) / energy;
        let pull = V::load(places.distance[row]) * V::load(force[row]) / energy;
        let squared = u * u;
        let near = w.less(V::splat(pair.near));
        // (V₀ − V)/tanh² w is the mean force times r₀ cosh² w/(1 + cosh w).
        let meant = V::load(mean[row]) * (cosh * cosh / (one + cosh));
        let excess = V::select(near, meant - x, (x * squared - v) * weight);
        // Near a barrier, and near b = 0, 1 − V₀/E is (b/r₀)² with more digits.
        let g = V::select(near, square + meant, one + excess);
        let root = g.sqrt();
        if task.integrand == Integrand::Turning {
            // b/r times r F/E over (1 − V/E).
            out[0][row] = (scale * (root0 * u * pull / (one - v) / root)).store();
            continue;
        }
        let p = excess / (root * (root + one));
        let compared = square.multiply_add(squared, one);
        let [c1, c2, c3] = comparison.series;
        let (off, below) = if comparison.strong {
            let off = one / root - one / compared.sqrt();
            (off, -off)
        } else {
            let series = V::splat(c3).multiply_add(squared, V::splat(c2)).multiply_add(squared, V::splat(c1))
                * squared;
            (series - p, p)
        };
        out[0][row] = (scale * (off * u)).store();
        if task.wanted > 1 {
            // (r F(r) − r₀F(r₀) u²)/E/tanh² w.
            let bend = V::select(zero.less(w), (pull - y * squared) * weight, zero);
            let slope = -(y * below) - square * (bend / (g * root));
            out[1][row] = (scale * (slope * u)).store();
            out[2][row] = (scale * ((p - half * x * squared / compared) * cosh)).store();
        }
    }
}

tiered! {
    fn spread_tier[][](turning: f64, measure: Measure, ends: [f64; 2], places: &mut Places) = spread;
    fn between_tier[][](turning: f64, w: &Rows, rows: &mut [Lanes; ROWS * MEAN.len()]) = between;
    fn means_tier[][](factor: f64, forces: &[Lanes; ROWS * MEAN.len()], mean: &mut Rows) = means;
    fn integrands_tier[][](task: &Task<'_>, places: &Places, found: [&Rows; 3], out: &mut [Rows; INTEGRALS]) = integrands;
}
