//! Sofroniou and Spaletta's composition of order 6: thirteen leapfrogs of small lengths.

use crate::numerics::double_double::DoubleDouble;
use crate::ode::{Method, Scheme, Splitting, dd};

/// Sofroniou and Spaletta's composition of order 6.
pub static METHOD: Method = Method {
    name: "sofroniou_spaletta6",
    summary: "Symplectic, order 6, 13 force evaluations per step: small errors with long steps.",
    order: 6,
    stages: 13,
    symplectic: true,
    reversible: true,
    dense_order: 6,
    reference: "Sofroniou & Spaletta, Optim. Methods Softw. 20 (2005) 597; Hairer, Lubich & Wanner, Geometric Numerical Integration, V.3.2",
    scheme: Scheme::Splitting(Splitting { kicks: KICKS, drifts: DRIFTS }),
};

// <coefficients> written by tools/coefficients.py; do not edit
#[rustfmt::skip]
const KICKS: &[DoubleDouble] = &[
    dd(0.06930965427025848, -4.3504740057829564e-18), dd(0.1360424685256323, -9.159557808031462e-18),
    dd(0.13208546931261994, -1.2852443945713199e-17), dd(0.1301621238417813, -2.1986018801499105e-18),
    dd(-0.1101921556850693, -1.915290640185531e-18), dd(-0.11597397120459255, -3.493459437705268e-19),
    dd(0.2585664109393699, -1.0807649199809785e-17), dd(0.2585664109393699, -1.0807649199809785e-17),
    dd(-0.11597397120459255, -3.493459437705268e-19), dd(-0.1101921556850693, -1.915290640185531e-18),
    dd(0.1301621238417813, -2.1986018801499105e-18), dd(0.13208546931261994, -1.2852443945713199e-17),
    dd(0.1360424685256323, -9.159557808031462e-18), dd(0.06930965427025848, -4.3504740057829564e-18),
];
#[rustfmt::skip]
const DRIFTS: &[DoubleDouble] = &[
    dd(0.13861930854051696, -8.700948011565913e-18), dd(0.1334656285107476, -9.618167604497011e-18),
    dd(0.13070531011449224, 1.1668855328699528e-17), dd(0.12961893756907034, 1.1689516526629565e-17),
    dd(-0.350003248939209, 1.2235477808628286e-17), dd(0.11805530653002387, 9.436181116451168e-19),
    dd(0.3990775153487159, -8.681128703450229e-18), dd(0.11805530653002387, 9.436181116451168e-19),
    dd(-0.350003248939209, 1.2235477808628286e-17), dd(0.12961893756907034, 1.1689516526629565e-17),
    dd(0.13070531011449224, 1.1668855328699528e-17), dd(0.1334656285107476, -9.618167604497011e-18),
    dd(0.13861930854051696, -8.700948011565913e-18),
];
// </coefficients>
