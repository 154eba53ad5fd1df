//! The integrands of one pair at the points of a rule, eight side by side.
//!
//! The one idea: as the trapezoidal rule has them, with the turning point divided out; near it, where V(r₀) − V(r) would
//! cancel, that is the mean of the force in between. Where little is left of G, beside a barrier, it is found with more
//! digits (`precise`).

use super::adaptive::{Integrand, Pair};
use super::comparison::Comparison;
use super::precise::Precise;
use super::profile::Profile;
use super::trapezoid::INTEGRALS;
use crate::numerics::elementary::Exponential;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::real::Mask;
use crate::tiered;
use std::cell::OnceCell;

/// Rows of points.
pub(super) const ROWS: usize = 2;
/// Of Gauss and Legendre between 0 and 1: places and weights.
const MEAN: [[f64; 2]; 4] = [
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
];
/// Where G is less than this at most it is found with more digits than its terms have, …
const LOW: f64 = 0.25;
/// … as far as what they leave of it is more than this part of the tolerance.
const PART: f64 = 0.01;
/// From here on sinh w is taken from exponentials, before by its series.
const LARGE: f64 = 0.6;

/// 1/2k(2k + 1) of k from 10 to 1: to w²¹/21!, below 1e-24 of the whole.
const SINH: [f64; 10] = {
    let mut inverses = [0.0; 10];
    let mut at = 0;
    while at < 10 {
        let k = (10 - at) as f64;
        inverses[at] = 1.0 / (2.0 * k * (2.0 * k + 1.0));
        at += 1;
    }
    inverses
};

/// Rows of one number at all points.
pub(super) type Rows = [Lanes; ROWS];

/// Rows of the mean's points.
type MeanRows = [Lanes; ROWS * MEAN.len()];

const EMPTY: Rows = [Lanes([0.0; WIDTH]); ROWS];

/// Points w: r/r₀ = cosh w, its inverse, 1/tanh² w, r itself; and, if any are near, the distances of their means.
struct Points {
    place: Rows,
    sinh: Rows,
    cosh: Rows,
    ratio: Rows,
    weight: Rows,
    distance: Rows,
    between: Option<MeanRows>,
}

/// V, −dV/dr at the points, and −dV/dr and d²V/dr² between them and r₀.
struct Forces {
    value: Rows,
    force: Rows,
    between: MeanRows,
    curvature: MeanRows,
}

/// What 1/√G is made of: G − 1 and G; and what a rounding of V makes of u/√G, twice that.
struct Excess {
    excess: Rows,
    whole: Rows,
    rounded: Rows,
}

/// A pair, what it is compared with, and its turning point with more digits, once it is asked for, if it has them.
pub(super) struct Subject<'a> {
    pub(super) profile: &'a Profile,
    pub(super) pair: &'a Pair,
    pub(super) comparison: Comparison,
    /// Below which G is found with more digits.
    low: f64,
    precise: OnceCell<Option<Precise<'a>>>,
}

impl<'a> Subject<'a> {
    pub(super) fn new(profile: &'a Profile, pair: &'a Pair, (tolerance, refined): (f64, bool)) -> Self {
        let comparison = Comparison::of(pair.value, pair.root);
        // There the rounding of its terms is that part of the tolerance.
        let low = LOW.min(pair.rounding() / (PART * tolerance));
        let precise = if refined { OnceCell::new() } else { OnceCell::from(None) };
        Self { profile, pair, comparison, low, precise }
    }
    /// The pair with more digits, if it has them.
    pub(super) fn precise(&self) -> Option<&Precise<'a>> {
        self.precise.get_or_init(|| Precise::of(self.profile, self.pair)).as_ref()
    }
    /// Finds anew what little is left of G.
    fn refine(&self, points: &Points, found: &mut Excess) {
        for row in 0..ROWS {
            for lane in 0..WIDTH {
                if found.whole[row].0[lane] < self.low
                    && let Some(precise) = self.precise()
                {
                    let [excess, whole] = precise.excess(points.sinh[row].0[lane]);
                    (found.excess[row].0[lane], found.whole[row].0[lane]) = (excess, whole);
                    found.rounded[row].0[lane] = 0.0;
                }
            }
        }
    }
}

/// The integrands at places w, of which the first is the least: as many as are wanted; and what a rounding of V
/// makes of the first, twice that.
pub(super) fn at(
    subject: &Subject<'_>,
    (integrand, wanted): (Integrand, usize),
    place: Rows,
) -> ([Rows; INTEGRALS], Rows) {
    let Subject { profile, pair, comparison, .. } = subject;
    let mut points = Points {
        place,
        sinh: EMPTY,
        cosh: EMPTY,
        ratio: EMPTY,
        weight: EMPTY,
        distance: EMPTY,
        between: None,
    };
    place_tier(pair, &mut points);
    let empty = [EMPTY[0]; ROWS * MEAN.len()];
    let mut forces = Forces { value: EMPTY, force: EMPTY, between: empty, curvature: empty };
    // Of the angle alone the force is not asked, but for its mean.
    let all = wanted > 1 || integrand == Integrand::Turning;
    if all {
        profile.rows(&points.distance, &mut forces.value, &mut forces.force, &mut []);
    } else {
        profile.values(&points.distance, &mut forces.value);
    }
    if let Some(between) = &points.between {
        if all {
            let mut value = *between;
            profile.rows(between, &mut value, &mut forces.between, &mut forces.curvature);
        } else {
            profile.forces(between, &mut forces.between);
        }
    }
    let mut excess = Excess { excess: EMPTY, whole: EMPTY, rounded: EMPTY };
    excess_tier(pair, &points, &forces, &mut excess);
    subject.refine(&points, &mut excess);
    let mut found = [EMPTY; INTEGRALS];
    if integrand == Integrand::Turning {
        turning_tier(pair, &points, &forces, &excess, &mut found);
    } else if all {
        deflection_tier::<true>((pair, comparison), &points, &forces, &excess, &mut found);
    } else {
        deflection_tier::<false>((pair, comparison), &points, &forces, &excess, &mut found);
    }
    (found, excess.rounded)
}

/// sinh w, without the difference of exponentials near zero.
#[inline(always)]
fn sinh<V: Vector8 + Exponential>(w: V) -> V {
    let small = w.less(V::splat(LARGE));
    let (one, mut series) = (V::one(), V::one());
    if small.any() {
        let square = w * w;
        for inverse in SINH {
            series = series * square * V::splat(inverse) + one;
        }
        series = w * series;
        if small.all() {
            return series;
        }
    }
    let grown = w.exp();
    V::select(small, series, V::splat(0.5) * (grown - one / grown))
}

#[inline(always)]
fn place<V: Vector8 + Exponential>(pair: &Pair, points: &mut Points) {
    let turning = V::splat(pair.turning);
    let mut near = false;
    for row in 0..ROWS {
        let w = V::load(points.place[row]);
        let sinh = sinh(w);
        let cosh = (V::one() + sinh * sinh).sqrt();
        points.sinh[row] = sinh.store();
        points.cosh[row] = cosh.store();
        points.ratio[row] = (V::one() / cosh).store();
        points.weight[row] = ((cosh / sinh) * (cosh / sinh)).store();
        points.distance[row] = (turning * cosh).store();
        near |= w.less(V::splat(pair.near)).any();
    }
    if near {
        let mut between = [EMPTY[0]; ROWS * MEAN.len()];
        for row in 0..ROWS {
            let half = sinh(V::splat(0.5) * V::load(points.place[row]));
            let way = V::splat(2.0) * half * half;
            for i in 0..MEAN.len() {
                let part = V::splat(pair.turning * MEAN[i][0]);
                between[row * MEAN.len() + i] = part.multiply_add(way, turning).store();
            }
        }
        points.between = Some(between);
    }
}

/// r₀/E times the mean of four numbers between r₀ and each point.
#[inline(always)]
fn mean<V: Vector8>(pair: &Pair, of: [V; MEAN.len()]) -> V {
    let one = |i: usize| V::splat(MEAN[i][1]) * of[i];
    V::splat(pair.turning / pair.energy) * ((one(0) + one(3)) + (one(1) + one(2)))
}

/// V/E in one row.
#[inline(always)]
fn value<V: Vector8>(pair: &Pair, forces: &Forces, row: usize) -> V {
    V::load(forces.value[row]) / V::splat(pair.energy)
}

/// The mean force times that and r₀ is (V₀ − V)/tanh² w: cosh² w/(1 + cosh w).
#[inline(always)]
fn grown<V: Vector8>(points: &Points, row: usize) -> V {
    let cosh = V::load(points.cosh[row]);
    cosh * cosh / (V::one() + cosh)
}

/// G − 1 and G, as well as V and the mean of the force tell them.
#[inline(always)]
fn excess<V: Vector8>(pair: &Pair, points: &Points, forces: &Forces, found: &mut Excess) {
    let (x, square) = (V::splat(pair.value), V::splat(pair.root * pair.root));
    for row in 0..ROWS {
        let (u, weight) = (V::load(points.ratio[row]), V::load(points.weight[row]));
        let v = value::<V>(pair, forces, row);
        let far = (x * (u * u) - v) * weight;
        let (mut excess, mut whole, mut terms) = (far, V::one() + far, (v * weight).abs());
        if points.between.is_some() {
            let mut of = [V::zero(); MEAN.len()];
            for i in 0..MEAN.len() {
                of[i] = V::load(forces.between[row * MEAN.len() + i]);
            }
            let near = V::load(points.place[row]).less(V::splat(pair.near));
            let lost = mean(pair, of) * grown::<V>(points, row);
            excess = V::select(near, lost - x, far);
            // Near a barrier, and near b = 0, 1 − V₀/E is (b/r₀)² with more digits.
            whole = V::select(near, square + (excess + x), V::one() + excess);
            terms = V::select(near, lost.abs() + x.abs(), terms);
        }
        found.excess[row] = excess.store();
        found.whole[row] = whole.store();
        found.rounded[row] = (terms * u / (whole * whole.sqrt())).store();
    }
}

/// The turning of the velocity: b/r times r F/E over (1 − V/E).
#[inline(always)]
fn turning<V: Vector8>(
    pair: &Pair,
    points: &Points,
    forces: &Forces,
    excess: &Excess,
    found: &mut [Rows; INTEGRALS],
) {
    for row in 0..ROWS {
        let g = V::load(excess.whole[row]);
        let pull = V::load(points.distance[row]) * V::load(forces.force[row]) / V::splat(pair.energy);
        let u = V::load(points.ratio[row]);
        let kinetic = V::one() - value::<V>(pair, forces, row);
        found[0][row] = (V::splat(pair.root) * u * pull / kinetic / g.sqrt()).store();
    }
}

#[inline(always)]
fn deflection<V: Vector8, const ALL: bool>(
    (pair, comparison): (&Pair, &Comparison),
    points: &Points,
    forces: &Forces,
    excess: &Excess,
    found: &mut [Rows; INTEGRALS],
) {
    let one = V::one();
    let (y, square) = (V::splat(pair.force), V::splat(pair.root * pair.root));
    let [c1, c2, c3] = comparison.series;
    for row in 0..ROWS {
        let (g, excess) = (V::load(excess.whole[row]), V::load(excess.excess[row]));
        let (u, root) = (V::load(points.ratio[row]), g.sqrt());
        let squared = u * u;
        let p = excess / (root * (root + one));
        let compared = (one + square * squared).sqrt();
        let off = if comparison.strong {
            one / root - one / compared
        } else {
            let series = V::splat(c3).multiply_add(squared, V::splat(c2)).multiply_add(squared, V::splat(c1));
            series * squared - p
        };
        found[0][row] = (off * u).store();
        if !ALL {
            continue;
        }
        let below = if comparison.strong { -off } else { p };
        let pull = V::load(points.distance[row]) * V::load(forces.force[row]) / V::splat(pair.energy);
        // (r F(r) − r₀F(r₀) u²)/E/tanh² w.
        let mut bent = (pull - y * u * u) * V::load(points.weight[row]);
        if let Some(between) = &points.between {
            let mut of = [V::zero(); MEAN.len()];
            for i in 0..MEAN.len() {
                let at = row * MEAN.len() + i;
                of[i] = V::load(forces.between[at]) - V::load(between[at]) * V::load(forces.curvature[at]);
            }
            let near = V::load(points.place[row]).less(V::splat(pair.near));
            bent = V::select(near, mean(pair, of) * grown::<V>(points, row) + y, bent);
        }
        let slope = -(y * below) - square * (bent / (g * root));
        found[1][row] = (slope * u).store();
        let far = V::splat(0.5 * pair.value) * squared / (compared * compared);
        found[2][row] = ((p - far) * V::load(points.cosh[row])).store();
    }
}

tiered! {
    fn place_tier[][](pair: &Pair, points: &mut Points) = place;
    fn excess_tier[][](pair: &Pair, points: &Points, forces: &Forces, found: &mut Excess) = excess;
    fn turning_tier[][](pair: &Pair, points: &Points, forces: &Forces, excess: &Excess, found: &mut [Rows; INTEGRALS]) = turning;
    fn deflection_tier[const ALL: bool][ALL](pair: (&Pair, &Comparison), points: &Points, forces: &Forces, excess: &Excess, found: &mut [Rows; INTEGRALS]) = deflection;
}
