//! What all kernels compute in the same way for a pair.

use crate::numerics::real::Real;

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
