//! Kepler's equation t = r s + η G₂ + ζ G₃ in the universal variable s, counted from any point of the orbit.
//!
//! r, η = r·v and ζ = μ − βr belong to that point (r G₁ + η G₂ + μ G₃ written without the cancellation in G₁).
//! The one idea: a bracketed fourth-order Newton step finds s; the last step moves the functions G, not s, so that
//! the rounding of s (which an exponential would magnify) never reaches the answer.
//! Source: Stiefel & Scheifele (1971) §11; Danby, *Fundamentals of Celestial Mechanics* (1988) §6.6 (the step).

use crate::numerics::stumpff::UniversalFunctions;

/// The point from which time and s are counted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Anchor {
    /// Distance there.
    pub(super) r: f64,
    /// r·v there.
    pub(super) eta: f64,
    /// μ − βr there.
    pub(super) zeta: f64,
}

/// Where the motion is at a time after the anchor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reached {
    pub(super) functions: UniversalFunctions<f64>,
    /// The distance there.
    pub(super) r: f64,
}

/// Solve for the time `high + low` > 0 after the anchor; the root lies in (`lower`, `upper`), `guess` too.
///
/// Always ends: a step that leaves the bracket, and every step beyond the twentieth, halves it.
pub(super) fn solve(
    anchor: Anchor,
    beta: f64,
    (high, low): (f64, f64),
    guess: f64,
    mut upper: f64,
) -> Reached {
    let Anchor { r, eta, zeta } = anchor;
    // Within this reach of the root the addition theorem to third order is exact to rounding.
    const NEAR: f64 = 1.0 / 32768.0;
    let reach_squared = NEAR * NEAR;
    let mut lower = 0.0;
    let mut s = guess;
    let mut steps = 0;
    loop {
        let g = UniversalFunctions::<f64>::new(beta, s);
        let residual = ((r * s + (eta * g.g2 + zeta * g.g3)) - high) - low;
        let first = r + (eta * g.g1 + zeta * g.g2);
        let second = eta * g.g0 + zeta * g.g1;
        let third = zeta * g.g0 - beta * eta * g.g1;
        let halley = -residual * first / (first * first - 0.5 * residual * second);
        let delta = -residual / (first + halley * (0.5 * second + halley * third / 6.0));
        let square = delta * delta;
        if (square <= reach_squared * s * s && square * beta.abs() <= reach_squared) || steps >= 120 {
            let functions = if delta.is_finite() { g.shifted(beta, delta) } else { g };
            return Reached { functions, r: r + (eta * functions.g1 + zeta * functions.g2) };
        }
        if residual > 0.0 {
            upper = s;
        } else {
            lower = s;
        }
        let next = s + delta;
        s = if next > lower && next < upper && steps < 20 { next } else { lower + 0.5 * (upper - lower) };
        steps += 1;
    }
}
