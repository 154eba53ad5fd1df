//! Blanes and Moan's Runge–Kutta–Nyström splitting of order 4 with six stages (SRKN6b): for kicks by positions
//! alone.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, dd};

/// Blanes and Moan's SRKN6b.
pub static METHOD: Method = Method {
    name: "blanes_moan_rkn4",
    summary: "Symplectic, order 4, six force evaluations per step, forces of positions alone: small errors at order 4.",
    order: 4,
    stages: 6,
    symplectic: true,
    reversible: true,
    dense_order: 4,
    reference: "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, table 3",
    scheme: Scheme::NystromSplitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    dd(0.08298440641740502, -5.043003221833988e-18), dd(0.3963098014983681, -9.03071169369658e-18),
    dd(-0.039056304922348434, -1.409550922780783e-18), dd(0.11952419401315068, 3.2109560609937915e-18),
    dd(-0.039056304922348434, -1.409550922780783e-18), dd(0.3963098014983681, -9.03071169369658e-18),
    dd(0.08298440641740502, -5.043003221833988e-18),
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.24529895718427117, -3.1950286525065995e-18), dd(0.60487266571108, -2.9275173845301095e-17),
    dd(-0.35017162289535114, 4.714626882178782e-18), dd(-0.35017162289535114, 4.714626882178782e-18),
    dd(0.60487266571108, -2.9275173845301095e-17), dd(0.24529895718427117, -3.1950286525065995e-18),
];
// </coefficients>
