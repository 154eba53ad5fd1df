//! Eight pairs side by side: what is known of them before the first node, and at w = 0.

use super::comparison::{Comparison, STRONG};
use super::trapezoid::INTEGRALS;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::Mask;
use crate::tiered;

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
    /// How many nodes of the first level count.
    pub(super) reach: Lanes,
}

impl Default for Pack {
    fn default() -> Self {
        let empty = Lanes([0.0; WIDTH]);
        Self {
            energy: empty,
            turning: empty,
            value: empty,
            force: empty,
            curvature: empty,
            root: empty,
            longest: empty,
            reach: empty,
        }
    }
}

/// The numbers of a pack that do not change from node to node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Constants {
    pub(super) inverse_energy: Lanes,
    pub(super) value: Lanes,
    pub(super) force: Lanes,
    pub(super) square: Lanes,
    pub(super) series: [Lanes; 3],
    pub(super) strong: Bits,
    /// Whether V repels everywhere, so that G is nowhere small.
    pub(super) repels: bool,
    /// Halves of what the integrands are at w = 0.
    pub(super) start: [Lanes; INTEGRALS],
    /// What sums are measured beside themselves.
    pub(super) beside: [Lanes; INTEGRALS],
    /// With what is not a series the first is compared.
    pub(super) closed: Lanes,
}

impl Default for Constants {
    fn default() -> Self {
        let empty = Lanes([0.0; WIDTH]);
        let all = [empty; INTEGRALS];
        Self {
            inverse_energy: empty,
            value: empty,
            force: empty,
            square: empty,
            series: [empty; 3],
            strong: Bits(0),
            repels: false,
            start: all,
            beside: all,
            closed: empty,
        }
    }
}

/// What nodes add, as running sums.
#[derive(Clone, Copy, Debug)]
pub(super) struct Running {
    pub(super) sum: [Lanes; INTEGRALS],
    /// Of the sizes of what is added.
    pub(super) size: [Lanes; INTEGRALS],
    /// The least G.
    pub(super) least: Lanes,
    /// What a rounding of V makes of the integrand of ψ, where V does not repel everywhere.
    pub(super) terms: Lanes,
}

/// What does not change, and what there is at w = 0.
#[inline(always)]
fn begin<V: Vector8>(pack: &Pack, repels: bool, constants: &mut Constants, running: &mut Running) {
    let (one, half) = (V::one(), V::splat(0.5));
    let (x, y, root) = (V::load(pack.value), V::load(pack.force), V::load(pack.root));
    let square = root * root;
    let strong = x.less(V::splat(STRONG));
    let [c1, c2, c3] = Comparison::series(x, square);
    let weak = [
        V::select(strong, V::zero(), c1),
        V::select(strong, V::zero(), c2),
        V::select(strong, V::zero(), c3),
    ];
    let excess = half * y - x;
    let g = one + excess;
    let root = g.sqrt();
    let p = excess / (root * (root + one));
    let stronger = one / root - one / (one + square).sqrt();
    let off = V::select(strong, stronger, c1 + c2 + c3 - p);
    let bend = y + half * (y - V::load(pack.curvature));
    let below = V::select(strong, -off, p);
    let slope = -(y * below) - square * (bend / (g * root));
    let way = p - half * x / (one + square);
    let start = [half * off, half * slope, half * way];
    let mut closed = Lanes([0.0; WIDTH]);
    if strong.any() {
        for lane in 0..WIDTH {
            if strong.lane(lane) {
                closed.0[lane] = Comparison::strongly(pack.root.0[lane]);
            }
        }
    }
    *constants = Constants {
        inverse_energy: (one / V::load(pack.energy)).store(),
        value: pack.value,
        force: pack.force,
        square: square.store(),
        series: [weak[0].store(), weak[1].store(), weak[2].store()],
        strong,
        repels,
        start: [start[0].store(), start[1].store(), start[2].store()],
        beside: [V::select(strong, V::load(closed), x.abs()).store(), y.abs().store(), x.abs().store()],
        closed,
    };
    for i in 0..INTEGRALS {
        running.sum[i] = start[i].store();
        running.size[i] = start[i].abs().store();
    }
    running.least = g.store();
    running.terms = Lanes([0.0; WIDTH]);
}

tiered! {
    pub(super) fn begin_tier[][](pack: &Pack, repels: bool, constants: &mut Constants, running: &mut Running) = begin;
}
