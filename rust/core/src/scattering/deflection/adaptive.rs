//! The deflection of one pair by intervals that are halved where they must be: beside barriers, where V is not smooth, and
//! where what is asked for is a small rest.
//!
//! The one idea: intervals in w, r = r₀ cosh w, ending wherever h is stationary or V has an edge, so that none hides a
//! peak; the one with the largest error is halved until all are within the tolerance. Near w = 0, where V(r₀) − V(r)
//! would cancel, it is the mean of the force in between.

use super::comparison::Comparison;
use super::delay_tail::DelayTail;
use super::nodes::{Node, sinh};
use super::profile::Profile;
use super::trapezoid::INTEGRALS;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::scattering::kronrod;

/// Points of a rule, filled up to whole rows.
const POINTS: usize = 2 * WIDTH;
/// Intervals at most.
const MOST: usize = 600;
/// What is asked of ψ, of dψ/db and of the delay, as parts of the tolerance.
const LOOSER: [f64; INTEGRALS] = [1.0, 10.0, 100.0];
/// An interval is no longer than this at first.
const LONGEST: f64 = 1.5;
/// Up to this w at most the mean force is taken, by four points.
const NEAR: f64 = 0.25;
/// Of Gauss and Legendre between 0 and 1: places and weights.
const MEAN: [[f64; 2]; 4] = [
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
];
/// What is left out at the far end, as a part of the tolerance.
const LEFT_OUT: f64 = 1e-3;
/// Of a sum of so many terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// What halving cannot mend, in units of what the rounding of distances does.
const NOISE: f64 = 4.0 * f64::EPSILON;
/// Where V ends softly beside the turning point, what it lost there falls as 1/w² from a peak that no point of a long interval
/// meets: intervals beyond are no longer than this many times their beginning.
const GRADED: f64 = 8.0;
/// So near is the nearest of them.
const NEAREST: f64 = 1e-12;
/// So near is beside it.
const BESIDE: f64 = 1e-2;
/// Where it is at most.
const FARTHEST: f64 = 750.0;

/// A pair and its turning point; lengths and energies in units of the profile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) energy: f64,
    pub(super) turning: f64,
    /// V(r₀)/E and r₀F(r₀)/E.
    pub(super) value: f64,
    pub(super) force: f64,
    /// b/r₀.
    pub(super) root: f64,
    /// r₀² V″(r₀)/E.
    pub(super) curvature: f64,
    /// Up to this w the mean of the force tells what V loses.
    pub(super) near: f64,
}

impl Pair {
    /// What the rounding of distances leaves of each integral, however fine the intervals: each r is off by half a unit, so
    /// that V/E is by that times rF/E, and rF/E by that times r²V″/E. Where V ends softly both are large against V.
    fn noise(&self, integrand: Integrand) -> [f64; INTEGRALS] {
        if integrand == Integrand::Turning {
            return [0.0; INTEGRALS];
        }
        // Of 1/√G, G as large as (b/r₀)² where that is large.
        let most = self.root.max(1.0);
        // A difference at w is divided by w² from where it is no mean any more: ∫ dw/w².
        let share = NOISE / (most * most * most * self.near);
        let (pull, bend) = (self.force.abs(), self.curvature.abs());
        let of_value = share * pull;
        [of_value, share * (pull * pull + self.root * self.root * (bend + pull)), of_value]
    }
}

/// How far out the mean of four forces has all digits: to where the force has changed little, and V has no edge.
pub(super) fn near(turning: f64, steepness: f64, edges: &[f64]) -> f64 {
    let smooth = NEAR.min((0.2 / steepness).sqrt());
    let edge = edges.iter().filter(|r| **r > turning).fold(f64::INFINITY, |least, r| r.min(least));
    if edge == f64::INFINITY { smooth } else { smooth.min(inverse_cosh(edge / turning)) }
}

/// What is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Integrand {
    /// As the trapezoidal rule does.
    Deflection,
    /// The turning of the velocity, F sin α/p: ψ = ∫ bF/(E − V)/√G dw, which is small where ψ is, b → 0 at a soft center.
    Turning,
}

/// Integrals, the first with what it is compared with, and how far that may be off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whole {
    pub(super) integral: [f64; INTEGRALS],
    pub(super) error: f64,
}

#[derive(Clone, Copy, Debug)]
struct Interval {
    ends: [f64; 2],
    integral: [f64; INTEGRALS],
    error: [f64; INTEGRALS],
    size: [f64; INTEGRALS],
}

/// The integrals over all w ≥ 0 with intervals that end at the given distances.
pub(super) fn integrate(
    profile: &Profile,
    pair: &Pair,
    integrand: Integrand,
    ends: &[f64],
    (tolerance, wanted): (f64, usize),
) -> Whole {
    let mut known = [0.0; INTEGRALS];
    if integrand == Integrand::Deflection {
        known[0] = Comparison::of(pair.value, pair.root).closed;
    }
    let farthest = farthest(profile, pair, integrand, LEFT_OUT * tolerance);
    let mut marks = vec![0.0, farthest];
    if wanted == INTEGRALS {
        let tail = DelayTail::follow(profile, pair, farthest, tolerance);
        marks.extend(tail.marks);
        known[INTEGRALS - 1] = tail.rest;
    }
    let end = marks[marks.len() - 1];
    let whole = |sum: [f64; INTEGRALS], error: f64, size: f64| Whole {
        integral: core::array::from_fn(|i| known[i] + sum[i]),
        error: error.max(ROUNDING * size),
    };
    marks.extend(ends.iter().filter(|r| **r > pair.turning).map(|r| inverse_cosh(r / pair.turning)));
    if pair.near < BESIDE {
        // What is steep without measure would begin at nothing, which no factor makes more of.
        let first = pair.near.max(NEAREST);
        marks.extend(core::iter::successors(Some(first), |w| Some(GRADED * w)).take_while(|w| *w < 1.0));
    }
    marks.retain(|w| *w <= end);
    marks.sort_by(f64::total_cmp);
    marks.dedup();
    let noise = pair.noise(integrand);
    let mut intervals = Vec::new();
    for pair_of_marks in marks.windows(2) {
        // What is left there of a delay is smooth.
        let longest = if pair_of_marks[0] < farthest { LONGEST } else { f64::INFINITY };
        let parts = ((pair_of_marks[1] - pair_of_marks[0]) / longest).ceil().max(1.0);
        let length = (pair_of_marks[1] - pair_of_marks[0]) / parts;
        for part in 0..parts as usize {
            let from = length.mul_add(part as f64, pair_of_marks[0]);
            let to = if part + 1 == parts as usize { pair_of_marks[1] } else { from + length };
            intervals.push(rule(profile, pair, integrand, [from, to]));
        }
    }
    loop {
        let (sum, error, size) = totals(&intervals);
        let share = |i: usize| {
            let settled = error[i] <= noise[i] || size[i] <= 0.0;
            if settled { 0.0 } else { error[i] / size[i] }
        };
        // The angle first: what is far out in the others is rounded, and would take all intervals.
        let open = |i: &usize| share(*i) > tolerance * LOOSER[*i];
        let Some(worst) = (0..wanted).find(open).filter(|_| intervals.len() < MOST) else {
            return whole(sum, error[0], size[0]);
        };
        let largest = |a: &Interval, b: &Interval| a.error[worst].total_cmp(&b.error[worst]);
        let at = (0..intervals.len()).max_by(|a, b| largest(&intervals[*a], &intervals[*b])).unwrap_or(0);
        let [from, to] = intervals[at].ends;
        let middle = 0.5 * (from + to);
        if middle <= from || middle >= to {
            return whole(sum, error[0], size[0]);
        }
        intervals[at] = rule(profile, pair, integrand, [from, middle]);
        intervals.push(rule(profile, pair, integrand, [middle, to]));
    }
}

/// Sums of integrals, errors and sizes, in the order of the line.
fn totals(intervals: &[Interval]) -> ([f64; INTEGRALS], [f64; INTEGRALS], [f64; INTEGRALS]) {
    let mut all = ([0.0; INTEGRALS], [0.0; INTEGRALS], [0.0; INTEGRALS]);
    for interval in intervals {
        for i in 0..INTEGRALS {
            all.0[i] += interval.integral[i];
            all.1[i] += interval.error[i];
            all.2[i] += interval.size[i];
        }
    }
    all
}

/// Both rules over one interval.
fn rule(profile: &Profile, pair: &Pair, integrand: Integrand, ends: [f64; 2]) -> Interval {
    // One more, to fill the row.
    let places = core::array::from_fn(|k| kronrod::place(ends, k.min(kronrod::POINTS - 1)));
    let values = integrands(profile, pair, integrand, &places);
    let mut interval =
        Interval { ends, integral: [0.0; INTEGRALS], error: [0.0; INTEGRALS], size: [0.0; INTEGRALS] };
    for i in 0..INTEGRALS {
        let found = kronrod::estimate(ends, |k| values[k][i]);
        interval.integral[i] = found.integral;
        interval.error[i] = found.error;
        interval.size[i] = found.size;
    }
    interval
}

/// The integrands at places w.
fn integrands(
    profile: &Profile,
    pair: &Pair,
    integrand: Integrand,
    places: &[f64; POINTS],
) -> [[f64; INTEGRALS]; POINTS] {
    let nodes = places.map(Node::at);
    let rows = |of: &dyn Fn(usize) -> f64| -> [Lanes; 2] {
        core::array::from_fn(|row| Lanes(core::array::from_fn(|lane| of(row * WIDTH + lane))))
    };
    let distance = rows(&|k| pair.turning * nodes[k].cosh);
    let (mut value, mut force) = (distance, distance);
    profile.values(&distance, &mut value);
    profile.forces(&distance, &mut force);
    let mean = mean_forces(profile, pair, places);
    let (x, y, square) = (pair.value, pair.force, pair.root * pair.root);
    let comparison = Comparison::of(x, pair.root);
    core::array::from_fn(|k| {
        let (row, lane) = (k / WIDTH, k % WIDTH);
        let node = nodes[k];
        let (v, u) = (value[row].0[lane] / pair.energy, node.ratio);
        let pull = distance[row].0[lane] * force[row].0[lane] / pair.energy;
        let squared = u * u;
        let excess = mean[k].map_or((x * squared - v) * node.weight, |[mean, _]| {
            // (V₀ − V)/tanh² w is the mean force times r₀ cosh² w/(1 + cosh w).
            mean * (node.cosh * node.cosh / (1.0 + node.cosh)) - x
        });
        // Near a barrier, and near b = 0, 1 − V₀/E is (b/r₀)² with more digits.
        let g = mean[k].map_or(1.0 + excess, |_| square + (excess + x));
        let root = g.sqrt();
        if integrand == Integrand::Turning {
            // b/r times r F/E over (1 − V/E).
            return [pair.root * u * pull / (1.0 - v) / root, 0.0, 0.0];
        }
        let p = excess / (root * (root + 1.0));
        let compared = (1.0 + square * squared).sqrt();
        let [c1, c2, c3] = comparison.series;
        let off = if comparison.strong {
            1.0 / root - 1.0 / compared
        } else {
            c3.mul_add(squared, c2).mul_add(squared, c1) * squared - p
        };
        let below = if comparison.strong { -off } else { p };
        let bent = mean[k].map_or_else(
            || bend(pair, places[k], pull, node),
            |[_, turn]| turn * (node.cosh * node.cosh / (1.0 + node.cosh)) + y,
        );
        let slope = -(y * below) - square * (bent / (g * root));
        [off * u, slope * u, (p - 0.5 * x * squared / (compared * compared)) * node.cosh]
    })
}

/// (r F(r) − r₀F(r₀) u²)/E/tanh² w.
fn bend(pair: &Pair, w: f64, pull: f64, node: Node) -> f64 {
    if w > 0.0 { (pull - pair.force * node.ratio * node.ratio) * node.weight } else { 0.0 }
}

/// r₀/E times the means of F and of d(rF)/dr between r₀ and each near place; nothing for others.
fn mean_forces(profile: &Profile, pair: &Pair, places: &[f64; POINTS]) -> [Option<[f64; 2]>; POINTS] {
    let mut means = [None; POINTS];
    if places[0] >= pair.near {
        return means;
    }
    let mut rows = [Lanes([pair.turning; WIDTH]); POINTS * 4 / WIDTH];
    let (mut value, mut force, mut curvature) = (rows, rows, rows);
    for (k, w) in places.iter().enumerate() {
        let half = sinh(0.5 * w);
        let way = 2.0 * half * half;
        for (i, [place, _]) in MEAN.iter().enumerate() {
            let at = 4 * k + i;
            rows[at / WIDTH].0[at % WIDTH] = (pair.turning * place).mul_add(way, pair.turning);
        }
    }
    profile.rows(&rows, &mut value, &mut force, &mut curvature);
    for (k, w) in places.iter().enumerate() {
        let of = |all: &[Lanes], i: usize| all[(4 * k + i) / WIDTH].0[(4 * k + i) % WIDTH];
        let one = |i: usize| MEAN[i][1] * of(&force, i);
        let turn = |i: usize| MEAN[i][1] * (of(&force, i) - of(&rows, i) * of(&curvature, i));
        if *w < pair.near {
            let scale = pair.turning / pair.energy;
            means[k] = Some([
                scale * ((one(0) + one(3)) + (one(1) + one(2))),
                scale * ((turn(0) + turn(3)) + (turn(1) + turn(2))),
            ]);
        }
    }
    means
}

/// Where the rest no longer counts: neither what V adds, nor what is left of the comparison, which falls as u³.
fn farthest(profile: &Profile, pair: &Pair, integrand: Integrand, rest: f64) -> f64 {
    let comparison = Comparison::of(pair.value, pair.root);
    let turning = integrand == Integrand::Turning;
    let mut scale = match (turning, comparison.strong) {
        (true, _) => 0.0,
        (_, true) => comparison.closed,
        _ => pair.value.abs(),
    };
    let left =
        if turning { 0.0 } else { pair.root.max(1.0) * pair.root.max(1.0) * pair.value.abs().min(1.0) };
    let mut w = 0.5;
    while w < FARTHEST {
        let u = Node::at(w).ratio;
        let r = pair.turning / u;
        if turning {
            let rate = profile.force(r) * r / pair.energy / (1.0 - profile.value(r) / pair.energy);
            scale = scale.max(u * rate.abs());
        } else if !comparison.strong {
            scale = scale.max((u * profile.value(r) / pair.energy).abs().min(1.0));
        }
        if profile.grid().beyond(r, 1) / pair.energy * u <= rest * scale && left * u * u * u <= rest * scale {
            return w;
        }
        w += 0.5;
    }
    FARTHEST
}

/// The w ≥ 0 of a cosh w ≥ 1.
fn inverse_cosh(x: f64) -> f64 {
    let excess = x - 1.0;
    crate::numerics::elementary::ln(x + (excess * (x + 1.0)).sqrt())
}
