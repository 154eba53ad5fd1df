//! What 1/√G is compared with, so that what is left falls fast, and the angle from what is left.

use crate::numerics::real::Real;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Where V(r₀)/E is less, the attraction is strong.
pub(super) const STRONG: f64 = -0.5;

/// What 1/√G is compared with, and the integral of that.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comparison {
    /// Whether that is 1/√(1 + (bu/r₀)²); else 1 − c₁u² − c₂u⁴ − c₃u⁶, which is 1/√G where V is gone, and more.
    pub(super) strong: bool,
    pub(super) series: [f64; 3],
    /// ∫ u times it, less π/2 if it is the series.
    pub(super) closed: f64,
}

impl Comparison {
    /// Of V(r₀)/E and b/r₀.
    pub(super) fn of(x: f64, root: f64) -> Self {
        if x < STRONG {
            return Self { strong: true, series: [0.0; 3], closed: Self::strongly(root) };
        }
        let series = Self::series(x, root * root);
        let closed = -(series[2].mul_add(5.0 / 6.0, series[1]) * 0.75 + series[0]) * FRAC_PI_4;
        Self { strong: false, series, closed }
    }
    /// The coefficients, of V(r₀)/E and (b/r₀)².
    #[inline(always)]
    pub(super) fn series<S: Real>(x: S, square: S) -> [S; 3] {
        let c2 = S::splat(3.0).multiply_add(square, S::one()) * S::splat(0.125);
        let c3 = S::splat(5.0).multiply_add(square, S::splat(2.0)).multiply_add(square, S::one());
        [S::splat(0.5) * x, x * c2, x * (c3 * S::splat(0.0625))]
    }
    /// ∫ u/√(1 + (bu/r₀)²).
    pub(super) fn strongly(root: f64) -> f64 {
        FRAC_PI_2 / arithmetic_geometric_mean(1.0, root.mul_add(root, 1.0).sqrt())
    }
    /// The integral that goes into dψ/db, with the part in closed form.
    pub(super) fn slope(&self, force: f64, integral: f64) -> f64 {
        let known = if self.strong { self.closed } else { FRAC_PI_2 };
        force.mul_add(known, integral)
    }
}

/// ψ and π − |ψ| from V(r₀)/E, r₀F(r₀)/E, b/r₀ and `whole` = ∫ u/√G, less π/2 if it is compared with the series.
#[inline(always)]
pub(super) fn angle(strong: bool, [x, y]: [f64; 2], root: f64, whole: f64) -> (f64, f64) {
    if strong {
        let angle = PI - 2.0 * root * whole;
        return (angle, if angle > 0.0 { 2.0 * root * whole } else { PI + angle });
    }
    // Of r₀ rounded V(r₀) knows less than b/r₀ where it is steep, and b/r₀ less of small differences.
    let short = if y.abs() < 1.0 { x / (1.0 + root) } else { 1.0 - root };
    let angle = PI * short - 2.0 * root * whole;
    (angle, if angle > 1.0 { root * (PI + 2.0 * whole) } else { PI - angle.abs() })
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
