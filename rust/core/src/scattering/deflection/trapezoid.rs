//! The deflection by the trapezoidal rule in w, r = r₀ cosh w, eight pairs side by side.
//!
//! The one idea: with the turning point divided out of the integrand, F(u) = 1 − V/E − b²/r² = G tanh² w, u = r₀/r, and
//!
//! ψ/2 = (π/2)(1 − b/r₀) + (b/r₀) ∫₀^∞ u p dw,   p = 1 − 1/√G,   G − 1 = ((V₀/E) u² − V/E)/tanh² w
//!
//! is even and analytic in w within |Im w| < π/2 but for other zeros of G, so the error of equal steps falls as e^(−2πa/h),
//! a the distance of the nearest singularity; and both terms are of the order of V₀/E, so that small angles keep their
//! digits. What is left of p where V is gone, c₁u² + c₂u⁴ + c₃u⁶ + …, is summed over all steps, not integrated: its
//! poles at iπ/2, which p has not, would be what errs most.
//! How far the sum is off is told by the integrand's own spectrum (`spectrum`). Each pair stops by itself, so its bits
//! are its own. The derivative by b and the way that is lost or won come from the same nodes.

use super::nodes::{LEVELS, Ladder, Level, Node};
use super::pack::{Constants, Pack, Running, begin_tier};
use super::profile::Profile;
use super::spectrum::{Spectrum, spectrum};
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Mask;
use crate::tiered;

/// Of a sum of so many terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Where G comes nearer to zero, a barrier is near.
const NEAR_ZERO: f64 = 0.004;
/// Of V, which is halved in 1/√G.
const ROUNDED_TERMS: f64 = 2.0 * f64::EPSILON;

/// How many integrals: ψ, dψ/db, delay.
pub(super) const INTEGRALS: usize = 3;

/// The integrals of eight pairs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sums {
    /// The first with what it is compared with.
    pub(super) integral: [Lanes; INTEGRALS],
    /// How far the first may be off.
    pub(super) error: Lanes,
    /// Whether the tolerance is met.
    pub(super) met: Bits,
}

/// Rows that are filled again for every pack: distances, V and −dV/dr at nodes, and the integrands there, of all levels.
#[derive(Debug, Default)]
struct Rows {
    distance: Vec<Lanes>,
    value: Vec<Lanes>,
    force: Vec<Lanes>,
    integrand: [Vec<Lanes>; INTEGRALS],
    /// How many nodes of each level there are, and of all.
    counts: [usize; LEVELS + 1],
    used: usize,
}

impl Rows {
    /// V, and if there is more than one integral −dV/dr, at nodes; and room for the integrands there.
    fn fill(&mut self, profile: &Profile, turning: &Lanes, nodes: &[Node], integrals: usize) {
        let count = nodes.len();
        let room = |rows: &mut Vec<Lanes>, count: usize| {
            if rows.len() < count {
                rows.resize(count, Lanes([0.0; WIDTH]));
            }
        };
        room(&mut self.distance, count);
        room(&mut self.value, count);
        self.used += count;
        for integrand in &mut self.integrand[..integrals] {
            room(integrand, self.used);
        }
        let distance = &mut self.distance[..count];
        distances_tier(turning, nodes, distance);
        if integrals == 1 {
            profile.values(distance, &mut self.value[..count]);
        } else {
            room(&mut self.force, count);
            profile.rows(distance, &mut self.value[..count], &mut self.force[..count], &mut []);
        }
    }
}

/// What is used again for every pack.
#[derive(Debug)]
pub(super) struct Work {
    rows: Rows,
    constants: Constants,
    running: Running,
    spectra: [Spectrum; INTEGRALS],
    /// What was found.
    pub(super) sums: Sums,
}

impl Default for Work {
    fn default() -> Self {
        let empty = Lanes([0.0; WIDTH]);
        let all = [empty; INTEGRALS];
        Self {
            rows: Rows::default(),
            constants: Constants::default(),
            running: Running { sum: all, size: all, least: empty, terms: empty },
            spectra: [Spectrum::default(); INTEGRALS],
            sums: Sums { integral: all, error: empty, met: Bits(0) },
        }
    }
}

#[inline(always)]
fn distances<V: Vector8>(turning: &Lanes, nodes: &[Node], distance: &mut [Lanes]) {
    let r = V::load(*turning);
    for (distance, node) in V::view_mut(distance).iter_mut().zip(nodes) {
        *distance = r * V::splat(node.cosh);
    }
}

/// The integrands at nodes of one level from the `place`-th on: `reach` is how many of them count in each lane.
#[inline(always)]
fn add_nodes<V: Vector8, const N: usize>(
    constants: &Constants,
    nodes: &[Node],
    reach: &Lanes,
    rows: &mut Rows,
    running: &mut Running,
) {
    let (one, half, reach) = (V::one(), V::splat(0.5), V::load(*reach));
    let (inverse_energy, value, square) =
        (V::load(constants.inverse_energy), V::load(constants.value), V::load(constants.square));
    let turn = V::load(constants.force);
    let [c1, c2, c3] = constants.series;
    let (c1, c2, c3) = (V::load(c1), V::load(c2), V::load(c3));
    let (mut sum, mut size) = ([V::zero(); N], [V::zero(); N]);
    for i in 0..N {
        sum[i] = V::load(running.sum[i]);
        size[i] = V::load(running.size[i]);
    }
    let (mut least, mut terms) = (V::load(running.least), V::load(running.terms));
    let repels = constants.repels;
    let (distances, values, forces) = (V::view(&rows.distance), V::view(&rows.value), V::view(&rows.force));
    let [first, second, third] = &mut rows.integrand;
    let range = rows.used - nodes.len()..rows.used;
    let others = if N > 1 { range.clone() } else { 0..0 };
    let angles = V::view_mut(&mut first[range]);
    let slopes = V::view_mut(&mut second[others.clone()]);
    let ways = V::view_mut(&mut third[others]);
    for k in 0..nodes.len() {
        let node = nodes[k];
        let (u, weight) = (V::splat(node.ratio), V::splat(node.weight));
        let squared = V::splat(node.ratio * node.ratio);
        let counts = V::splat(k as f64).less(reach);
        let here = values[k] * inverse_energy;
        let excess = value.multiply_add(squared, -here) * weight;
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
        angles[k] = angle;
        sum[0] += angle;
        size[0] += angle.abs();
        least = V::select(counts, least.min(g), least);
        if !repels {
            // What the rounding of V makes of 1/√G, of which (1 − p)³ is the cube.
            let inverse = one - p;
            let cube = inverse * inverse * inverse;
            terms += V::select(counts, (here * weight).abs() * (cube * u), V::zero());
        }
        if N > 1 {
            let pull = forces[k] * distances[k] * inverse_energy;
            let bend = turn.multiply_subtract_from(squared, pull) * weight;
            let slope = -(turn * below) - square * (bend / (g * root));
            let slope = V::select(counts, slope * u, V::zero());
            slopes[k] = slope;
            sum[1] += slope;
            size[1] += slope.abs();
            let far = half * value * squared / square.multiply_add(squared, one);
            let way = V::select(counts, (p - far) * V::splat(node.cosh), V::zero());
            ways[k] = way;
            sum[2] += way;
            size[2] += way.abs();
        }
    }
    for i in 0..N {
        running.sum[i] = sum[i].store();
        running.size[i] = size[i].store();
    }
    running.least = least.store();
    running.terms = terms.store();
}

/// Takes over what the lanes that are `open` have come to with steps of one length, and says which need shorter ones.
#[inline(always)]
fn judge<V: Vector8, const N: usize>(
    constants: &Constants,
    running: &Running,
    spectra: &[Spectrum; INTEGRALS],
    level: &Level,
    (open, tolerance, longest): (Bits, f64, &Lanes),
    done: &mut Sums,
) -> Bits {
    let (h, tolerance) = (V::splat(level.step), V::splat(tolerance));
    let least = V::load(running.least);
    let rounding = V::splat(ROUNDED_TERMS) * h * V::load(running.terms);
    let fine = V::splat(NEAR_ZERO).less(least);
    let mut met = open.and(fine).and(h.less_equal(V::load(*longest)));
    let sizes: [V; N] =
        core::array::from_fn(|i| V::load(running.size[i]).multiply_add(h, V::load(constants.beside[i])));
    for (i, size) in sizes.into_iter().enumerate() {
        let mut error = spectra[i].error::<V>();
        if i == 0 {
            error = error.max(rounding);
        }
        met = met.and(error.less_equal(tolerance * size));
        if i == 0 {
            done.error = V::select(open, error.max(V::splat(ROUNDING) * size), V::load(done.error)).store();
        }
        let mut sum = h * V::load(running.sum[i]);
        if i == 0 {
            // The series over all nodes, not only those that count.
            let [u3, u5, u7] = level.powers[level.powers.len() - 1];
            let [c1, c2, c3] = constants.series;
            let series = V::load(c1) * V::splat(u3) + V::load(c2) * V::splat(u5) + V::load(c3) * V::splat(u7);
            sum += V::select(constants.strong, V::load(constants.closed), -series);
        }
        done.integral[i] = V::select(open, sum, V::load(done.integral[i])).store();
    }
    done.met = done.met.or(met);
    // Shorter steps make no less of what is rounded.
    let rounded = (tolerance * sizes[0]).less(rounding);
    open.and(met.not()).and(fine).and(rounded.not())
}

tiered! {
    fn distances_tier[][](turning: &Lanes, nodes: &[Node], distance: &mut [Lanes]) = distances;
    fn add_nodes_tier[const N: usize][N](constants: &Constants, nodes: &[Node], reach: &Lanes, rows: &mut Rows, running: &mut Running) = add_nodes;
    fn judge_tier[const N: usize][N](constants: &Constants, running: &Running, spectra: &[Spectrum; INTEGRALS], level: &Level, asked: (Bits, f64, &Lanes), done: &mut Sums) -> Bits = judge;
}

/// The integrals of eight pairs, if `N` is not one with those of derivative and delay.
pub(super) fn integrate<const N: usize>(
    profile: &Profile,
    ladder: &Ladder,
    pack: &Pack,
    tolerance: f64,
    work: &mut Work,
) {
    let Work { rows, constants, running, spectra, sums } = work;
    begin_tier(pack, profile.repels(), constants, running);
    rows.used = 0;
    sums.met = Bits(0);
    let mut open = Bits(0);
    for lane in 0..WIDTH {
        open.0 |= u8::from(pack.reach.0[lane] > 0.0) << lane;
    }
    let nothing = [Lanes([0.0; WIDTH]); 3];
    for at in 0..=LEVELS {
        if !open.any() {
            break;
        }
        let level = ladder.level(at);
        // The nodes of the first level that count, or as many times two as there are odd multiples among them.
        let times = if at == 0 { 1 } else { 1 << (at - 1) };
        let mut reach = pack.reach;
        let mut farthest = 0;
        for lane in 0..WIDTH {
            reach.0[lane] *= f64::from(times);
            if open.lane(lane) {
                farthest = farthest.max(reach.0[lane] as usize);
            }
        }
        let nodes = &level.nodes[..farthest.min(level.nodes.len())];
        rows.counts[at] = nodes.len();
        rows.fill(profile, &pack.turning, nodes, N);
        add_nodes_tier::<N>(constants, nodes, &reach, rows, running);
        let fall = &level.falls[usize::from(!profile.repels())];
        for i in 0..N {
            let series = if i == 0 { &constants.series } else { &nothing };
            let integrand = &rows.integrand[i][..rows.used];
            spectrum(
                integrand,
                &rows.counts[..=at],
                &constants.start[i],
                series,
                level,
                fall,
                &mut spectra[i],
            );
        }
        let asked = (open, tolerance, &pack.longest);
        open = judge_tier::<N>(constants, running, spectra, level, asked, sums);
    }
}
