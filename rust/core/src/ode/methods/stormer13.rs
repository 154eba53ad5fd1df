//! Störmer's multistep method of order 13: one force evaluation per step.
//!
//! Long integrations of planets were computed with it. Below 70 steps to the shortest period it is unstable; with 200
//! it is at the round-off floor of the outer Solar System, for a fifth of the evaluations of kahan_li8. Not for
//! close encounters, as the step is one for all times. It starts with steps of dop853: their error, of order 9, is
//! far below its own wherever it is of use.

use super::dop853;
use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Multistep, Scheme, dd};

/// Störmer's method of order 13.
pub static METHOD: Method = Method {
    name: "stormer13",
    summary: "Multistep, order 13, one force evaluation per step: smooth orbits, some 200 steps per period.",
    order: 13,
    stages: 1,
    symplectic: false,
    reversible: false,
    dense_order: 8,
    reference: "Störmer (1907); Grazier, Newman, Hyman, Sharp & Goldstein, ANZIAM J. 46 (2005) C786",
    scheme: Scheme::Multistep(Multistep {
        second_differences: SECOND_DIFFERENCES,
        velocity: VELOCITY,
        start: &dop853::TABLEAU,
        fewest_steps: 75.0,
    }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const SECOND_DIFFERENCES: &[DoubleDouble] = &[
    dd(0.7669366259777449, 1.918181728115796e-17), dd(-3.5258121860541047, -1.3480927963239873e-16),
    dd(10.157528798207277, -6.464374383637898e-16), dd(-19.870968374704734, 4.843650181728097e-16),
    dd(27.440877186647587, -7.2982448483491535e-16), dd(-27.187621159030012, -8.889130529377367e-16),
    dd(19.290481789220937, 1.2677609802784244e-15), dd(-9.5968170399284, 7.952402814952663e-16),
    dd(3.186400889657493, 1.7260917187223044e-16), dd(-0.635276822497908, -2.4834364098998743e-17),
    dd(0.05760362583745313, 2.5375057130472034e-18),
];
#[rustfmt::skip]
const VELOCITY: &[DoubleDouble] = &[
    dd(0.5, 0.0), dd(-0.16666666666666666, -9.25185853854297e-18),
    dd(-0.125111965851234, -6.119713899630489e-18), dd(0.3127991531294586, -4.605621182741203e-18),
    dd(-0.7327406421273144, 4.5015580864747596e-18), dd(1.3018669552311666, -3.75536784279154e-17),
    dd(-1.7024726174914977, -2.5580712778832533e-18), dd(1.629041284670191, -1.6432237349532474e-17),
    dd(-1.1283275260538714, -1.0757275919868548e-16), dd(0.5515074266241181, -2.0973158090829772e-17),
    dd(-0.18066317085657674, 3.4685344759192218e-18), dd(0.03563828951298983, -6.353554907963836e-19),
    dd(-0.003203853454096303, 1.184449224721703e-19),
];
// </coefficients>
