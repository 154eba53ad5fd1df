//! Omelyan, Mryglod and Folk's extended Forest–Ruth method, position first: four evaluations, one number free to
//! make its error small.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, ZERO, dd};

/// The position extended Forest–Ruth-like method.
pub static METHOD: Method = Method {
    name: "pefrl4",
    summary: "Symplectic, order 4, four force evaluations per step: molecular dynamics and long runs at moderate accuracy.",
    order: 4,
    stages: 4,
    symplectic: true,
    reversible: true,
    dense_order: 4,
    reference: "Omelyan, Mryglod & Folk, Comput. Phys. Commun. 146 (2002) 188",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    ZERO, dd(0.7123418310626054, 2.0843010183039885e-18), dd(-0.2123418310626054, -2.0843010183039885e-18),
    dd(-0.2123418310626054, -2.0843010183039885e-18), dd(0.7123418310626054, 2.0843010183039885e-18), ZERO,
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.17861789584480905, 1.226488221477244e-17), dd(-0.0662645826698185, -1.5135024602655496e-18),
    dd(0.7752933736500188, 3.4008391722244047e-17), dd(-0.0662645826698185, -1.5135024602655496e-18),
    dd(0.17861789584480905, 1.226488221477244e-17),
];
// </coefficients>
