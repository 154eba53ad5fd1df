//! The deflection by the trapezoidal rule in w, r = r₀ cosh w, eight pairs side by side.
//!
//! The one idea: with the turning point divided out of the integrand, F(u) = 1 − V/E − b²/r² = G tanh² w, u = r₀/r, and
//!
//! ψ/2 = (π/2)(1 − b/r₀) + (b/r₀) ∫₀^∞ u p dw,   p = 1 − 1/√G,   G − 1 = ((V₀/E) u² − V/E)/tanh² w
//!
//! is even and analytic in w within |Im w| < π/2 but for other zeros of G, so equal steps square their error when they
//! are halved; and both terms are of the order of V₀/E, so that small angles keep their digits. What is left of p where V
//! is gone, c₁u² + c₂u⁴ + c₃u⁶ + …, is integrated in closed form. Each pair stops by itself, so its bits are its own.
//! The derivative by b and the way that is lost or won come from the same nodes.

use super::nodes::{COARSEST, LEVELS, Node, levels};
use super::profile::Profile;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Mask;
use crate::tiered;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Nodes between two looks at whether the rest counts.
const BLOCK: usize = 4;
/// What is left out, as a part of the tolerance.
const LEFT_OUT: f64 = 0.01;
/// Where V(r₀)/E is less, the attraction is strong.
const STRONG: f64 = -0.5;
/// Halvings at least. The error's sign changes with b, so two sums may agree by accident; three do not.
const LEAST_LEVEL: usize = 2;
/// Of a sum of so many terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Where G comes nearer to zero, a barrier is near.
const NEAR_ZERO: f64 = 0.004;

/// How many integrals: ψ, dψ/db, delay.
pub(super) const INTEGRALS: usize = 3;

/// Eight pairs and their turning points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pack {
    pub(super) energy: Lanes,
    /// r₀, V(r₀)/E, r₀F(r₀)/E, r₀²V″(r₀)/E.
    pub(super) turning: Lanes,
    pub(super) value: Lanes,
    pub(super) force: Lanes,
    pub(super) curvature: Lanes,
    /// b/r₀.
    pub(super) root: Lanes,
    /// The longest distance of nodes that sees every barrier.
    pub(super) longest: Lanes,
}

/// The integrals of eight pairs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sums {
    pub(super) integral: [Lanes; INTEGRALS],
    /// How far the first may be off.
    pub(super) error: Lanes,
    /// Whether the tolerance is met.
    pub(super) met: Bits,
}

/// What one node adds, as running sums.
#[derive(Clone, Copy, Debug)]
struct Running {
    sum: [Lanes; INTEGRALS],
    /// Of the sizes of what is added.
    size: [Lanes; INTEGRALS],
    /// The last of them.
    last: [Lanes; INTEGRALS],
    least: Lanes,
}

/// What 1/√G is compared with in each lane, and the integral of that.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comparison {
    /// Whether that is 1/√(1 + (bu/r₀)²); else 1 − c₁u² − c₂u⁴ − c₃u⁶.
    pub(super) strong: bool,
    pub(super) series: [f64; 3],
    /// ∫ u times it, less π/2 if it is the series.
    pub(super) closed: f64,
}

impl Comparison {
    /// Of V(r₀)/E and b/r₀.
    pub(super) fn of(x: f64, root: f64) -> Self {
        let b = root * root;
        if x < STRONG {
            let closed = FRAC_PI_2 / arithmetic_geometric_mean(1.0, (1.0 + b).sqrt());
            return Self { strong: true, series: [0.0; 3], closed };
        }
        let series = [0.5 * x, x * (1.0 + 3.0 * b) / 8.0, x * (1.0 + 2.0 * b + 5.0 * b * b) / 16.0];
        let closed = -(series[2].mul_add(5.0 / 6.0, series[1]) * 0.75 + series[0]) * FRAC_PI_4;
        Self { strong: false, series, closed }
    }
    /// ψ and π − |ψ| from ∫ u (1/√G − what it is compared with).
    pub(super) fn angle(&self, x: f64, root: f64, integral: f64) -> (f64, f64) {
        let whole = integral + self.closed;
        if self.strong {
            let angle = PI - 2.0 * root * whole;
            return (angle, if angle > 0.0 { 2.0 * root * whole } else { PI + angle });
        }
        // Of r₀ rounded V(r₀) knows less than b/r₀ where it is steep, and b/r₀ less of small differences.
        let short = if x.abs() < 0.5 { x / (1.0 + root) } else { 1.0 - root };
        let angle = PI * short - 2.0 * root * whole;
        (angle, if angle > 1.0 { root * (PI + 2.0 * whole) } else { PI - angle.abs() })
    }
    /// The integral that goes into dψ/db, with the part in closed form.
    pub(super) fn slope(&self, force: f64, integral: f64) -> f64 {
        let known = if self.strong { self.closed } else { FRAC_PI_2 };
        force.mul_add(known, integral)
    }
}

/// The integral of ½(V₀/E)u²/(1 + (bu/r₀)²) cosh w, which the delay's integrand goes without.
pub(super) fn closed_delay(x: f64, root: f64) -> f64 {
    0.5 * x * FRAC_PI_2 / root.mul_add(root, 1.0).sqrt()
}

/// Of two positive numbers, in a few roundings.
fn arithmetic_geometric_mean(mut a: f64, mut b: f64) -> f64 {
    while (a - b).abs() > 1e-8 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * (a + b)
}

/// The numbers of a pack that do not change from node to node.
#[derive(Clone, Copy, Debug)]
struct Constants {
    inverse_energy: Lanes,
    value: Lanes,
    force: Lanes,
    square: Lanes,
    series: [Lanes; 3],
    strong: Bits,
}

impl Constants {
    fn of(pack: &Pack, comparisons: &[Comparison; WIDTH]) -> Self {
        let mut strong = 0;
        for (lane, comparison) in comparisons.iter().enumerate() {
            strong |= u8::from(comparison.strong) << lane;
        }
        Self {
            inverse_energy: pack.energy.map(|e| 1.0 / e),
            value: pack.value,
            force: pack.force,
            square: pack.root.map(|root| root * root),
            series: core::array::from_fn(|i| Lanes(core::array::from_fn(|lane| comparisons[lane].series[i]))),
            strong: Bits(strong),
        }
    }
}

/// One node after another: `reach` is how many of them count in each lane.
#[inline(always)]
fn add_nodes<V: Vector8>(
    constants: &Constants,
    nodes: &[Node],
    place: usize,
    reach: &Lanes,
    rows: (&[Lanes], &[Lanes], &[Lanes]),
    running: &mut Running,
) {
    let (one, half, reach) = (V::one(), V::splat(0.5), V::load(*reach));
    let (inverse_energy, value, square) =
        (V::load(constants.inverse_energy), V::load(constants.value), V::load(constants.square));
    let turn = V::load(constants.force);
    let [c1, c2, c3] = constants.series;
    let (c1, c2, c3) = (V::load(c1), V::load(c2), V::load(c3));
    let mut sum = [V::load(running.sum[0]), V::load(running.sum[1]), V::load(running.sum[2])];
    let mut size = [V::load(running.size[0]), V::load(running.size[1]), V::load(running.size[2])];
    let mut last = [V::load(running.last[0]), V::load(running.last[1]), V::load(running.last[2])];
    let mut least = V::load(running.least);
    let (distances, values, forces) = (V::view(rows.0), V::view(rows.1), V::view(rows.2));
    let all = !forces.is_empty();
    for k in 0..nodes.len() {
        let node = nodes[k];
        let (u, weight) = (V::splat(node.ratio), V::splat(node.weight));
        let squared = V::splat(node.ratio * node.ratio);
        let counts = V::splat((place + k) as f64).less(reach);
        let excess = value.multiply_add(squared, -(values[k] * inverse_energy)) * weight;
        let g = one + excess;
        let root = g.sqrt();
        let p = excess / (root * (root + one));
        let series = c3.multiply_add(squared, c2).multiply_add(squared, c1) * squared;
        let mut off = series - p;
        // Less than what the slope is compared with.
        let mut below = p;
        if constants.strong.any() {
            let inverse = one / square.multiply_add(squared, one).sqrt();
            off = V::select(constants.strong, one / root - inverse, off);
            below = V::select(constants.strong, -off, p);
        }
        let angle = V::select(counts, off * u, V::zero());
        sum[0] += angle;
        size[0] += angle.abs();
        last[0] = angle.abs();
        least = V::select(counts, least.min(g), least);
        if all {
            let pull = forces[k] * distances[k] * inverse_energy;
            let bend = turn.multiply_subtract_from(squared, pull) * weight;
            let slope = -(turn * below) - square * (bend / (g * root));
            let slope = V::select(counts, slope * u, V::zero());
            sum[1] += slope;
            size[1] += slope.abs();
            last[1] = slope.abs();
            let far = half * value * squared / square.multiply_add(squared, one);
            let way = V::select(counts, (p - far) * V::splat(node.cosh), V::zero());
            sum[2] += way;
            size[2] += way.abs();
            last[2] = way.abs();
        }
    }
    for i in 0..INTEGRALS {
        running.sum[i] = sum[i].store();
        running.size[i] = size[i].store();
        running.last[i] = last[i].store();
    }
    running.least = least.store();
}

tiered! {
    fn add_nodes_tier[][](constants: &Constants, nodes: &[Node], place: usize, reach: &Lanes, rows: (&[Lanes], &[Lanes], &[Lanes]), running: &mut Running) = add_nodes;
}

/// What the integrands are at w = 0, and G.
fn at_turning_point(pack: &Pack, comparison: &Comparison, lane: usize) -> ([f64; INTEGRALS], f64) {
    let (x, y, square) = (pack.value.0[lane], pack.force.0[lane], pack.root.0[lane] * pack.root.0[lane]);
    let excess = 0.5 * y - x;
    let g = 1.0 + excess;
    let root = g.sqrt();
    let p = excess / (root * (root + 1.0));
    let [c1, c2, c3] = comparison.series;
    let off = if comparison.strong { 1.0 / root - 1.0 / (1.0 + square).sqrt() } else { c1 + c2 + c3 - p };
    let bend = y + 0.5 * (y - pack.curvature.0[lane]);
    let below = if comparison.strong { -off } else { p };
    let slope = -(y * below) - square * (bend / (g * root));
    ([off, slope, p - 0.5 * x / (1.0 + square)], g)
}

/// Rows of distances, V and −dV/dr at the nodes of a block.
struct Rows {
    distance: Vec<Lanes>,
    value: Vec<Lanes>,
    force: Vec<Lanes>,
}

impl Rows {
    fn fill(&mut self, profile: &Profile, turning: &Lanes, nodes: &[Node], all: bool) {
        let empty = Lanes([0.0; WIDTH]);
        self.distance.clear();
        self.distance.extend(nodes.iter().map(|node| turning.map(|r| r * node.cosh)));
        self.value.clear();
        self.value.resize(nodes.len(), empty);
        profile.values(&self.distance, &mut self.value);
        self.force.clear();
        if all {
            self.force.resize(nodes.len(), empty);
            profile.forces(&self.distance, &mut self.force);
        }
    }
}

/// The integrals of eight pairs, the last two only if `all`.
pub(super) fn integrate(profile: &Profile, pack: &Pack, tolerance: f64, all: bool) -> Sums {
    let comparisons: [Comparison; WIDTH] =
        core::array::from_fn(|lane| Comparison::of(pack.value.0[lane], pack.root.0[lane]));
    let constants = Constants::of(pack, &comparisons);
    let empty = Lanes([0.0; WIDTH]);
    let wanted = if all { INTEGRALS } else { 1 };
    let mut running = Running {
        sum: [empty; INTEGRALS],
        size: [empty; INTEGRALS],
        last: [empty; INTEGRALS],
        least: Lanes([1.0; WIDTH]),
    };
    for lane in 0..WIDTH {
        let (start, g) = at_turning_point(pack, &comparisons[lane], lane);
        for i in 0..INTEGRALS {
            running.sum[i].0[lane] = 0.5 * start[i];
            running.size[i].0[lane] = 0.5 * start[i].abs();
        }
        running.least.0[lane] = g;
    }
    let mut rows = Rows { distance: Vec::new(), value: Vec::new(), force: Vec::new() };
    let first = &levels()[0];
    let cut = LEFT_OUT * tolerance;
    let mut reach = Lanes([f64::INFINITY; WIDTH]);
    let mut place = 0;
    while place < first.len() && reach.0.contains(&f64::INFINITY) {
        let nodes = &first[place..first.len().min(place + BLOCK)];
        rows.fill(profile, &pack.turning, nodes, all);
        add_nodes_tier(
            &constants,
            nodes,
            place,
            &reach,
            (&rows.distance, &rows.value, &rows.force),
            &mut running,
        );
        place += nodes.len();
        let node = nodes[nodes.len() - 1];
        for lane in 0..WIDTH {
            if reach.0[lane] == f64::INFINITY {
                let small = (0..wanted).all(|i| running.last[i].0[lane] <= cut * running.size[i].0[lane]);
                if small && gone(profile, pack, lane, node, cut * running.size[0].0[lane], all) {
                    reach.0[lane] = place as f64;
                }
            }
        }
    }
    let ended = reach.map(|reach| if reach < f64::INFINITY { 1.0 } else { 0.0 });
    let mut means = running.sum.map(|sum| sum.map(|sum| sum * COARSEST));
    let mut done = Sums { integral: [empty; INTEGRALS], error: empty, met: Bits(0) };
    let mut open: [bool; WIDTH] = core::array::from_fn(|lane| ended.0[lane] > 0.0);
    let mut h = COARSEST;
    for level in 1..=LEVELS {
        if open == [false; WIDTH] {
            break;
        }
        h *= 0.5;
        let per_reach = if level == 1 { 1.0 } else { f64::from(1_u32 << (level - 1)) };
        let farthest =
            (0..WIDTH).filter(|lane| open[*lane]).fold(0.0, |far: f64, lane| far.max(reach.0[lane]));
        let nodes = &levels()[level][..((farthest * per_reach) as usize).min(levels()[level].len())];
        let counted = reach.map(|reach| reach * per_reach);
        for (block, nodes) in nodes.chunks(4 * BLOCK).enumerate() {
            rows.fill(profile, &pack.turning, nodes, all);
            let at = block * 4 * BLOCK;
            add_nodes_tier(
                &constants,
                nodes,
                at,
                &counted,
                (&rows.distance, &rows.value, &rows.force),
                &mut running,
            );
        }
        let finer = running.sum.map(|sum| sum.map(|sum| sum * h));
        for lane in 0..WIDTH {
            if !open[lane] {
                continue;
            }
            let agree = |i: usize| {
                let size = running.size[i].0[lane] * h + scale(pack, &comparisons[lane], i, lane);
                let off = (finer[i].0[lane] - means[i].0[lane]).abs() / size;
                off <= tolerance || size == 0.0
            };
            let fine = running.least.0[lane] > NEAR_ZERO;
            if level >= LEAST_LEVEL && (0..wanted).all(agree) && fine && h <= pack.longest.0[lane] {
                done.met = done.met.or(Bits(1 << lane));
            }
            if done.met.lane(lane) || !fine || running.least.0[lane].is_nan() {
                open[lane] = false;
                let size = running.size[0].0[lane] * h + scale(pack, &comparisons[lane], 0, lane);
                let off = (finer[0].0[lane] - means[0].0[lane]).abs();
                done.error.0[lane] = off.max(ROUNDING * size);
                for i in 0..INTEGRALS {
                    done.integral[i].0[lane] = finer[i].0[lane];
                }
            }
        }
        means = finer;
    }
    done
}

/// What integrals are measured beside themselves.
fn scale(pack: &Pack, comparison: &Comparison, which: usize, lane: usize) -> f64 {
    match which {
        0 if comparison.strong => comparison.closed,
        1 => pack.force.0[lane].abs(),
        _ => pack.value.0[lane].abs(),
    }
}

/// Whether from a node on V adds less than `rest` to the integrals.
fn gone(profile: &Profile, pack: &Pack, lane: usize, node: Node, rest: f64, all: bool) -> bool {
    let (r, e) = (pack.turning.0[lane] * node.cosh, pack.energy.0[lane]);
    // The delay's integrand falls as r V, not as V/r.
    let lever = if all { node.cosh } else { node.ratio };
    profile.beyond(r, usize::from(all)) / e * lever <= rest.max(f64::MIN_POSITIVE)
}
