//! The deflection of one pair by intervals that are halved where they must be: beside barriers, where V is not smooth, and
//! where what is asked for is a small rest.
//!
//! The one idea: intervals in w, r = r₀ cosh w, ending wherever h is stationary or V has an edge, so that none hides a
//! peak, and stretched beside those that are narrow (`rule`); the one with the largest error is halved until all are within
//! the tolerance. Near w = 0, where V(r₀) − V(r) would cancel, it is the mean of the force in between.

use super::comparison::Comparison;
use super::nodes::Node;
use super::profile::Profile;
use super::rule::{Interval, Measure, Task};
use super::trapezoid::INTEGRALS;
use crate::numerics::elementary::ln;
use crate::numerics::lanes::{Lanes, WIDTH};
use std::sync::OnceLock;

/// Intervals at most.
const MOST: usize = 600;
/// What is asked of ψ, of dψ/db and of the delay, as parts of the tolerance.
const LOOSER: [f64; INTEGRALS] = [1.0, 10.0, 100.0];
/// An interval is no longer than this at first, …
const LONGEST: f64 = 1.5;
/// … and where it is stretched than this.
const LONGEST_STRETCHED: f64 = 3.0;
/// Peaks narrower than this are stretched, …
const NARROW: f64 = 0.1;
/// … up to this far from them.
const STRETCHED: f64 = 1.0;
/// Up to this w at most the mean force is taken, by four points.
const NEAR: f64 = 0.25;
/// What is left out at the far end, as a part of the tolerance.
const LEFT_OUT: f64 = 1e-3;
/// Of a sum of so many terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
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
    /// Up to this w the mean of the force tells what V loses.
    pub(super) near: f64,
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

/// A distance at which an interval ends, and how wide a peak it has in w; 0 for none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    pub(super) distance: f64,
    pub(super) width: f64,
}

/// The integrals over all w ≥ 0 with intervals that end at the given distances.
pub(super) fn integrate(
    profile: &Profile,
    pair: &Pair,
    integrand: Integrand,
    ends: &[Mark],
    (tolerance, wanted): (f64, usize),
) -> Whole {
    let comparison = Comparison::of(pair.value, pair.root);
    let task = Task { profile, pair, comparison, integrand, wanted };
    let mut known = [0.0; INTEGRALS];
    if integrand == Integrand::Deflection {
        known[0] = comparison.closed;
    }
    let whole = |sum: [f64; INTEGRALS], error: f64, size: f64| Whole {
        integral: core::array::from_fn(|i| known[i] + sum[i]),
        error: error.max(ROUNDING * size),
    };
    let farthest = farthest(&task, LEFT_OUT * tolerance);
    // At a turning point G is as small as h is near to stationary.
    let at_start = (1.0 + 0.5 * pair.force - pair.value).max(0.0).sqrt();
    let mut marks = vec![(0.0, at_start), (farthest, 0.0)];
    let outside = ends.iter().filter(|mark| mark.distance > pair.turning);
    marks.extend(outside.map(|mark| (inverse_cosh(mark.distance / pair.turning), mark.width)));
    marks.retain(|(w, _)| *w <= farthest);
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    marks.dedup_by(|later, first| later.0 == first.0);
    let mut intervals = Vec::new();
    for pair_of_marks in marks.windows(2) {
        divide(&task, pair_of_marks[0], pair_of_marks[1], &mut intervals);
    }
    loop {
        let (sum, error, size) = totals(&intervals);
        let share = |i: usize| if size[i] > 0.0 { error[i] / size[i] } else { 0.0 };
        // The angle first: what is far out in the others is rounded, and would take all intervals.
        let open = |i: &usize| share(*i) > tolerance * LOOSER[*i];
        let Some(worst) = (0..wanted).find(open).filter(|_| intervals.len() < MOST) else {
            return whole(sum, error[0], size[0]);
        };
        let largest = |a: &Interval, b: &Interval| a.error[worst].total_cmp(&b.error[worst]);
        let at = (0..intervals.len()).max_by(|a, b| largest(&intervals[*a], &intervals[*b])).unwrap_or(0);
        let Interval { measure, ends: [from, to], .. } = intervals[at];
        let middle = 0.5 * (from + to);
        if middle <= from || middle >= to {
            return whole(sum, error[0], size[0]);
        }
        intervals[at] = Interval::new(&task, measure, [from, middle]);
        intervals.push(Interval::new(&task, measure, [middle, to]));
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

/// The first intervals between two marks, stretched beside peaks.
fn divide(task: &Task<'_>, (from, before): (f64, f64), (to, after): (f64, f64), intervals: &mut Vec<Interval>) {
    let narrow = |width: f64| width > 0.0 && width < NARROW;
    let share = if narrow(before) && narrow(after) { 0.5 } else { 1.0 };
    let most = STRETCHED.min(share * (to - from));
    let stretched = |width: f64| if narrow(width) && 4.0 * width < most { most } else { 0.0 };
    let (left, right) = (stretched(before), stretched(after));
    let mut parts = |measure: Measure, [from, to]: [f64; 2], longest: f64| {
        let parts = ((to - from) / longest).ceil().max(1.0);
        let length = (to - from) / parts;
        for part in 0..parts as usize {
            let start = length.mul_add(part as f64, from);
            let end = if part + 1 == parts as usize { to } else { start + length };
            intervals.push(Interval::new(task, measure, [start, end]));
        }
    };
    for (place, way, width) in [(from, left, before), (to, right, -after)] {
        if way > 0.0 {
            let share = way / width.abs();
            let end = ln(share + share.mul_add(share, 1.0).sqrt());
            parts(Measure { from: place, width }, [0.0, end], LONGEST_STRETCHED);
        }
    }
    let (from, to) = (from + left, to - right);
    if to > from {
        parts(Measure::default(), [from, to], LONGEST);
    }
}

/// cosh w of w = ½, 1, …, eight by eight, as far as intervals go.
fn coarse() -> &'static [Lanes] {
    static COARSE: OnceLock<Vec<Lanes>> = OnceLock::new();
    COARSE.get_or_init(|| {
        let cosh = |at: usize| Node::at(0.5 * (at + 1) as f64).cosh;
        let rows = (2.0 * FARTHEST) as usize / WIDTH;
        (0..rows).map(|row| Lanes(core::array::from_fn(|lane| cosh(row * WIDTH + lane)))).collect()
    })
}

/// Where the rest no longer counts: neither what V adds, nor what is left of the comparison, which falls as u³.
fn farthest(task: &Task<'_>, rest: f64) -> f64 {
    let Task { profile, pair, comparison, .. } = task;
    let turning = task.integrand == Integrand::Turning;
    let mut scale = match (turning, comparison.strong) {
        (true, _) => 0.0,
        (_, true) => comparison.closed,
        _ => pair.value.abs(),
    };
    let left =
        if turning { 0.0 } else { pair.root.max(1.0) * pair.root.max(1.0) * pair.value.abs().min(1.0) };
    for (row, cosh) in coarse().iter().enumerate() {
        let distance = [cosh.map(|cosh| pair.turning * cosh)];
        let (mut value, mut force) = (distance, distance);
        profile.values(&distance, &mut value);
        if turning {
            profile.forces(&distance, &mut force);
        }
        for lane in 0..WIDTH {
            let (u, r) = (1.0 / cosh.0[lane], distance[0].0[lane]);
            let v = value[0].0[lane] / pair.energy;
            if turning {
                let rate = force[0].0[lane] * r / pair.energy / (1.0 - v);
                scale = scale.max(u * rate.abs());
            } else if !comparison.strong {
                scale = scale.max((u * v).abs().min(1.0));
            }
            let over = profile.grid().beyond(r, 1) / pair.energy * u > rest * scale;
            if !over && left * u * u * u <= rest * scale {
                return 0.5 * (row * WIDTH + lane + 1) as f64;
            }
        }
    }
    FARTHEST
}

/// The w ≥ 0 of a cosh w ≥ 1.
fn inverse_cosh(x: f64) -> f64 {
    let excess = x - 1.0;
    ln(x + (excess * (x + 1.0)).sqrt())
}
