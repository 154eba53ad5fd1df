//! The integrands of one pair at the points of a rule, eight side by side.
//!
//! The one idea: as the trapezoidal rule has them, with the turning point divided out; near it, where V(r₀) − V(r) would
//! cancel, that is the mean of the force in between.

use super::adaptive::{Integrand, Pair};
use super::comparison::Comparison;
use super::profile::Profile;
use super::trapezoid::INTEGRALS;
use crate::numerics::elementary::Exponential;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::real::Mask;
use crate::tiered;

/// Rows of points.
pub(super) const ROWS: usize = 2;
/// Of Gauss and Legendre between 0 and 1: places and weights.
const MEAN: [[f64; 2]; 4] = [
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
];
/// From here on sinh w is taken from exponentials, before by its series.
const LARGE: f64 = 0.6;

/// Rows of one number at all points.
pub(super) type Rows = [Lanes; ROWS];

/// Rows of the mean's points.
type MeanRows = [Lanes; ROWS * MEAN.len()];

const EMPTY: Rows = [Lanes([0.0; WIDTH]); ROWS];

/// Points w: r/r₀ = cosh w, its inverse, 1/tanh² w, r itself; and, if any are near, the distances of their means.
struct Points {
    place: Rows,
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

/// The integrands at places w, of which the first is the least: as many as are wanted.
pub(super) fn at(
    profile: &Profile,
    (pair, comparison): (&Pair, &Comparison),
    (integrand, wanted): (Integrand, usize),
    place: Rows,
) -> [Rows; INTEGRALS] {
    let mut points =
        Points { place, cosh: EMPTY, ratio: EMPTY, weight: EMPTY, distance: EMPTY, between: None };
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
    let mut found = [EMPTY; INTEGRALS];
    if integrand == Integrand::Turning {
        turning_tier(pair, &points, &forces, &mut found);
    } else if all {
        deflection_tier::<true>(pair, comparison, &points, &forces, &mut found);
    } else {
        deflection_tier::<false>(pair, comparison, &points, &forces, &mut found);
    }
    found
}

/// sinh w, without the difference of exponentials near zero.
#[inline(always)]
fn sinh<V: Vector8 + Exponential>(w: V) -> V {
    let small = w.less(V::splat(LARGE));
    let (one, mut series) = (V::one(), V::one());
    if small.any() {
        let square = w * w;
        // To w²¹/21!, below 1e-24 of the whole.
        let mut k = 10.0;
        while k > 0.0 {
            series = series * square / V::splat(2.0 * k * (2.0 * k + 1.0)) + one;
            k -= 1.0;
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

/// What 1/√G is made of in one row: G − 1, G, and cosh² w/(1 + cosh w).
#[inline(always)]
fn excess<V: Vector8>(pair: &Pair, points: &Points, forces: &Forces, row: usize) -> [V; 4] {
    let (x, square) = (V::splat(pair.value), V::splat(pair.root * pair.root));
    let (cosh, u) = (V::load(points.cosh[row]), V::load(points.ratio[row]));
    let v = V::load(forces.value[row]) / V::splat(pair.energy);
    let far = (x * (u * u) - v) * V::load(points.weight[row]);
    if points.between.is_none() {
        return [far, V::one() + far, v, cosh];
    }
    // (V₀ − V)/tanh² w is the mean force times r₀ cosh² w/(1 + cosh w).
    let grown = cosh * cosh / (V::one() + cosh);
    let mut of = [V::zero(); MEAN.len()];
    for i in 0..MEAN.len() {
        of[i] = V::load(forces.between[row * MEAN.len() + i]);
    }
    let near = V::load(points.place[row]).less(V::splat(pair.near));
    let excess = V::select(near, mean(pair, of) * grown - x, far);
    // Near a barrier, and near b = 0, 1 − V₀/E is (b/r₀)² with more digits.
    [excess, V::select(near, square + (excess + x), V::one() + excess), v, grown]
}

/// The turning of the velocity: b/r times r F/E over (1 − V/E).
#[inline(always)]
fn turning<V: Vector8>(pair: &Pair, points: &Points, forces: &Forces, found: &mut [Rows; INTEGRALS]) {
    for row in 0..ROWS {
        let [_, g, v, _] = excess::<V>(pair, points, forces, row);
        let pull = V::load(points.distance[row]) * V::load(forces.force[row]) / V::splat(pair.energy);
        let u = V::load(points.ratio[row]);
        found[0][row] = (V::splat(pair.root) * u * pull / (V::one() - v) / g.sqrt()).store();
    }
}

#[inline(always)]
fn deflection<V: Vector8, const ALL: bool>(
    pair: &Pair,
    comparison: &Comparison,
    points: &Points,
    forces: &Forces,
    found: &mut [Rows; INTEGRALS],
) {
    let one = V::one();
    let (y, square) = (V::splat(pair.force), V::splat(pair.root * pair.root));
    let [c1, c2, c3] = comparison.series;
    for row in 0..ROWS {
        let [excess, g, _, grown] = excess::<V>(pair, points, forces, row);
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
            bent = V::select(near, mean(pair, of) * grown + y, bent);
        }
        let slope = -(y * below) - square * (bent / (g * root));
        found[1][row] = (slope * u).store();
        let far = V::splat(0.5 * pair.value) * squared / (compared * compared);
        found[2][row] = ((p - far) * V::load(points.cosh[row])).store();
    }
}

tiered! {
    fn place_tier[][](pair: &Pair, points: &mut Points) = place;
    fn turning_tier[][](pair: &Pair, points: &Points, forces: &Forces, found: &mut [Rows; INTEGRALS]) = turning;
    fn deflection_tier[const ALL: bool][ALL](pair: &Pair, comparison: &Comparison, points: &Points, forces: &Forces, found: &mut [Rows; INTEGRALS]) = deflection;
}
