//! Massless bodies in the field of massive ones: no third law, no pairs among themselves.

use crate::numerics::real::Real;

/// A massive body as a passive one sees it: position and `G·m`, each the same in all its lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<S> {
    pub(super) position: [S; 3],
    pub(super) strength: S,
}

/// The acceleration at `position` from all sources, in their order.
#[inline(always)]
pub(super) fn attraction<S: Real, const PLANAR: bool, const SOFT: bool>(
    position: [S; 3],
    sources: impl Iterator<Item = Source<S>>,
    softening2: S,
) -> [S; 3] {
    let mut a = [S::zero(); 3];
    for source in sources {
        let dx = source.position[0] - position[0];
        let dy = source.position[1] - position[1];
        let dz = source.position[2] - position[2];
        let mut r2 = dx * dx;
        if SOFT {
            r2 += softening2;
        }
        r2 += dy * dy;
        if !PLANAR {
            r2 += dz * dz;
        }
        let w = source.strength / (r2 * r2.sqrt());
        a[0] += w * dx;
        a[1] += w * dy;
        if !PLANAR {
            a[2] += w * dz;
        }
    }
    a
}
