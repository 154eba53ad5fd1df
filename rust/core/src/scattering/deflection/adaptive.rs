//! The deflection of one pair by intervals that are halved where they must be: beside barriers, where V is not smooth, and
//! where what is asked for is a small rest.
//!
//! The one idea: intervals in w, r = r₀ cosh w, ending wherever h is stationary or V has an edge, so that none hides a
//! peak; the one with the largest error is halved until all are within the tolerance. Near w = 0, where V(r₀) − V(r)
//! would cancel, it is the mean of the force in between.

use super::comparison::Comparison;
use super::delay_tail::DelayTail;
use super::integrands::{self, Subject};
use super::nodes::Node;
use super::profile::Profile;
use super::trapezoid::INTEGRALS;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH, as_numbers, as_numbers_mut};
use crate::scattering::kronrod;
use crate::tiered;

/// Intervals at most, or twice those that there are at first.
const MOST: usize = 600;
/// Halvings in a row that made nothing better, …
const STUCK: u8 = 3;
/// … and did not change an integral by more than this part of its size.
const UNCHANGED: f64 = 1e-8;
/// What is asked of ψ, of dψ/db and of the delay, as parts of the tolerance.
const LOOSER: [f64; INTEGRALS] = [1.0, 10.0, 100.0];
/// An interval is no longer than this at first.
const LONGEST: f64 = 1.5;
/// So many pieces of V at most are together in an interval at first, none longer than this: of eight, each has a point.
const GROUP: usize = 8;
const TOGETHER: f64 = 0.25;
/// Up to this w at most the mean force is taken.
const NEAR: f64 = 0.25;
/// What is left out at the far end, as a part of the tolerance.
const LEFT_OUT: f64 = 1e-3;
/// Of a sum of so many terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// By what part of b the distance to a barrier is uncertain: as b is, …
const UNCERTAIN: f64 = f64::EPSILON;
/// … or by what rounding leaves of it where V has no more digits than that.
const BLURRED: f64 = 64.0 * f64::EPSILON;
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
    pub(super) impact_parameter: f64,
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
    /// How near b is to where a barrier has its top, as a part of it.
    pub(super) nearness: f64,
}

impl Pair {
    /// What the terms of G are rounded by.
    pub(super) fn rounding(&self) -> f64 {
        ROUNDING * (self.value.abs() + 0.5 * self.force.abs())
    }
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

/// How far out the mean of four forces has all digits: to where the force has changed little, and V has no edge and no
/// feature begins.
pub(super) fn near(turning: f64, steepness: f64, edges: &[f64], mark: f64) -> f64 {
    let smooth = NEAR.min((0.2 / steepness).sqrt());
    // Not one that is the turning point but for rounding.
    let beyond = turning * (1.0 + 16.0 * f64::EPSILON);
    let edge = edges.iter().filter(|r| **r > beyond).fold(mark, |least, r| r.min(least));
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
    /// What a rounding of V makes of the first, twice that.
    rounded: f64,
    /// How often in a row halving has not made less of each error, nor changed the integral: it is rounding.
    stuck: [u8; INTEGRALS],
}

impl Interval {
    /// Whether halving may mend the error of an integral.
    fn is_loose(&self, i: usize) -> bool {
        self.stuck[i] < STUCK
    }
    /// Tells its halves whether they are any better.
    fn is_cut_into(&self, first: &mut Self, second: &mut Self) {
        for i in 0..INTEGRALS {
            let changed = (first.integral[i] + second.integral[i] - self.integral[i]).abs();
            let no_less = first.error[i] + second.error[i] >= 0.5 * self.error[i];
            if no_less && changed <= UNCHANGED * self.size[i] {
                (first.stuck[i], second.stuck[i]) = (self.stuck[i] + 1, self.stuck[i] + 1);
            }
        }
    }
}

/// The integrals over all w ≥ 0 with intervals that end at the given distances; at those where V is no more than not smooth,
/// where that matters.
pub(super) fn integrate(
    profile: &Profile,
    pair: &Pair,
    integrand: Integrand,
    ends: &[f64],
    (tolerance, refined): (f64, bool),
    wanted: usize,
) -> Whole {
    let tolerance = tolerance.max(UNCERTAIN / pair.nearness);
    let subject = Subject::new(profile, pair, (tolerance, refined));
    let blurred = BLURRED / pair.nearness;
    let tolerance = if blurred > tolerance && subject.precise().is_none() { blurred } else { tolerance };
    let mut known = [0.0; INTEGRALS];
    if integrand == Integrand::Deflection {
        known[0] = subject.comparison.closed;
    }
    let farthest = farthest(profile, pair, integrand, LEFT_OUT * tolerance);
    let mut marks = vec![0.0, farthest];
    if wanted == INTEGRALS {
        let tail = DelayTail::follow(profile, pair, farthest, tolerance);
        marks.extend(tail.marks);
        known[INTEGRALS - 1] = tail.rest;
    }
    let end = marks[marks.len() - 1];
    let whole = |totals: &Totals| Whole {
        integral: core::array::from_fn(|i| known[i] + totals.integral[i]),
        error: totals.error[0].max(ROUNDING * (totals.size[0] + 0.5 * totals.rounded)),
    };
    let places = |ends: &[f64]| -> Vec<f64> {
        ends.iter().filter(|r| **r > pair.turning).map(|r| inverse_cosh(r / pair.turning)).collect()
    };
    marks.extend(places(ends));
    let breaks: Vec<f64> = places(profile.breaks()).into_iter().filter(|w| *w < end).collect();
    marks.extend(grouped(&breaks));
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
            intervals.push(rule(&subject, (integrand, wanted), [from, to]));
        }
    }
    let least = tolerance / intervals.len() as f64;
    let most = MOST.max(2 * (intervals.len() + breaks.len()));
    let sizes = totals(&intervals).size;
    let rough = |interval: &Interval| {
        (0..wanted).any(|i| interval.error[i] > (least * LOOSER[i] * sizes[i]).max(noise[i]))
    };
    for at in 0..intervals.len() {
        let [from, to] = intervals[at].ends;
        let within = &breaks[breaks.partition_point(|w| *w <= from)..breaks.partition_point(|w| *w < to)];
        if !within.is_empty() && rough(&intervals[at]) {
            let ends: Vec<f64> = [from].into_iter().chain(within.iter().copied()).chain([to]).collect();
            let mut parts =
                ends.windows(2).map(|ends| rule(&subject, (integrand, wanted), [ends[0], ends[1]]));
            if let Some(first) = parts.next() {
                intervals[at] = first;
                let rest: Vec<Interval> = parts.collect();
                intervals.extend(rest);
            }
        }
    }
    loop {
        let totals = totals(&intervals);
        let Totals { error, loose, size, .. } = &totals;
        let share = |i: usize| {
            let settled = error[i] <= noise[i] || size[i] <= 0.0;
            if settled { 0.0 } else { loose[i] / size[i] }
        };
        // The angle first: what is far out in the others is rounded, and would take all intervals.
        let open = |i: &usize| share(*i) > tolerance * LOOSER[*i];
        let cut = (0..wanted).find(open).filter(|_| intervals.len() < most).and_then(|worst| {
            let places = (0..intervals.len()).filter(|at| intervals[*at].is_loose(worst));
            places.max_by(|a, b| intervals[*a].error[worst].total_cmp(&intervals[*b].error[worst]))
        });
        let Some(at) = cut else { return whole(&totals) };
        let cut = intervals[at];
        let [from, to] = cut.ends;
        let middle = 0.5 * (from + to);
        if middle <= from || middle >= to {
            return whole(&totals);
        }
        let [mut first, mut second] =
            [[from, middle], [middle, to]].map(|ends| rule(&subject, (integrand, wanted), ends));
        cut.is_cut_into(&mut first, &mut second);
        intervals[at] = first;
        intervals.push(second);
    }
}

/// Of places at which V is not smooth those between which there are so many as a rule sees each of: the first, where what is
/// beside the turning point ends, and others.
fn grouped(breaks: &[f64]) -> Vec<f64> {
    let mut kept: Vec<f64> = Vec::new();
    let mut since = 0;
    for (at, &w) in breaks.iter().enumerate() {
        let next = breaks.get(at + 1).copied().unwrap_or(f64::INFINITY);
        let far = kept.last().is_none_or(|last| next - last > TOGETHER);
        since += 1;
        if at == 0 || since == GROUP || far {
            kept.push(w);
            since = 0;
        }
    }
    kept
}

/// Sums over intervals, in the order of the line.
struct Totals {
    integral: [f64; INTEGRALS],
    error: [f64; INTEGRALS],
    /// Of those errors that halving may mend.
    loose: [f64; INTEGRALS],
    size: [f64; INTEGRALS],
    rounded: f64,
}

fn totals(intervals: &[Interval]) -> Totals {
    let zero = [0.0; INTEGRALS];
    let mut all = Totals { integral: zero, error: zero, loose: zero, size: zero, rounded: 0.0 };
    for interval in intervals {
        all.rounded += interval.rounded;
        for i in 0..INTEGRALS {
            all.integral[i] += interval.integral[i];
            all.error[i] += interval.error[i];
            all.loose[i] += if interval.is_loose(i) { interval.error[i] } else { 0.0 };
            all.size[i] += interval.size[i];
        }
    }
    all
}

/// Both rules over one interval.
fn rule(subject: &Subject<'_>, wanted: (Integrand, usize), ends: [f64; 2]) -> Interval {
    let mut places: integrands::Rows = [Lanes([0.0; WIDTH]); integrands::ROWS];
    place_tier(ends, &mut places);
    let (values, rounded) = integrands::at(subject, wanted, places);
    let rounded = as_numbers(&rounded);
    let rounded = kronrod::estimate(ends, |k| rounded[k]).integral;
    let nothing = [0.0; INTEGRALS];
    let mut interval =
        Interval { ends, integral: nothing, error: nothing, size: nothing, rounded, stuck: [0; INTEGRALS] };
    for i in 0..wanted.1 {
        let values = as_numbers(&values[i]);
        let found = kronrod::estimate(ends, |k| values[k]);
        interval.integral[i] = found.integral;
        interval.error[i] = found.error;
        interval.size[i] = found.size;
    }
    interval
}

/// The points of a rule, and once more the last, to fill the rows.
#[inline(always)]
#[expect(
    clippy::extra_unused_type_parameters,
    reason = "a tier calls its body by its vectors; the compiler makes these"
)]
fn place<V: Vector8>(ends: [f64; 2], places: &mut integrands::Rows) {
    for (k, place) in as_numbers_mut(places).iter_mut().enumerate() {
        *place = kronrod::place(ends, k.min(kronrod::POINTS - 1));
    }
}

tiered! {
    fn place_tier[][](ends: [f64; 2], places: &mut integrands::Rows) = place;
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
