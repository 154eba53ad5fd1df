//! What all kernels compute in the same way for a pair.

use crate::numerics::lanes::Vector8;
use crate::numerics::real::Real;

/// How many of the components that bodies have a kernel reads and writes, in the plane if it is written for that. One that is
/// not written for it takes the third to be zero, which changes no bit of the others.
#[inline(always)]
pub(super) fn components<V: Vector8, const PLANAR: bool>(own: usize) -> usize {
    if PLANAR {
        2
    } else if V::APART {
        own
    } else {
        3
    }
}

/// `r² = ((dx² [+ ε²]) + dy²) + dz²`, each sum fused with its product. No closures or iterators: they would be
/// compiled without the tier's instructions.
#[inline(always)]
pub(super) fn squared_distance<S: Real, const PLANAR: bool, const SOFT: bool>(
    [dx, dy, dz]: [S; 3],
    softening2: S,
) -> S {
    let x2 = if SOFT { dx.multiply_add(dx, softening2) } else { dx * dx };
    let xy2 = dy.multiply_add(dy, x2);
    if PLANAR { xy2 } else { dz.multiply_add(dz, xy2) }
}
