//! Kepler's equation t = r s + η G₂ + ζ G₃ in the universal variable s, counted from any point of the orbit.
//!
//! r, η = r·v and ζ = μ − βr belong to that point (r G₁ + η G₂ + μ G₃ written without the cancellation in G₁).
//! The one idea: a bracketed fourth-order Newton step finds s; the last step moves the functions G, not s, so that
//! the rounding of s (which an exponential would magnify) never reaches the answer.
//! Source: Stiefel & Scheifele (1971) §11; Danby, *Fundamentals of Celestial Mechanics* (1988) §6.6 (the step).

use crate::numerics::elementary::{cbrt, ln};
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
    pub(super) s: f64,
    /// The distance there.
    pub(super) r: f64,
}

/// Solve for the time `high + low` > 0 after the anchor; the root and `guess` lie in (0, `upper`).
///
/// Always ends, and never without the root: a step that leaves the bracket, and every step beyond the twentieth,
/// halves it, down to two neighbouring numbers if need be.
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
        let reached = |functions: UniversalFunctions<f64>, s: f64| Reached {
            functions,
            s,
            r: r + (eta * functions.g1 + zeta * functions.g2),
        };
        if delta.abs() <= NEAR * s && delta * delta * beta.abs() <= NEAR * NEAR {
            return reached(g.shifted(beta, delta), s + delta);
        }
        // What is no number has overflowed, which only happens beyond the root.
        if residual <= 0.0 {
            lower = s;
        } else {
            upper = s;
        }
        let middle = lower + 0.5 * (upper - lower);
        if !(lower < middle && middle < upper) {
            return reached(UniversalFunctions::<f64>::new(beta, lower), lower);
        }
        let next = s + delta;
        s = if next > lower && next < upper && steps < 20 { next } else { middle };
        steps += 1;
    }
}

/// Where an ellipse is at the time `high + low` ≥ 0 after its apocenter, up to eccentric anomaly π/2 from there.
pub(super) fn after_apocenter(r: f64, zeta: f64, beta: f64, (high, low): (f64, f64)) -> Reached {
    if high == 0.0 {
        return at_the_apsis(r);
    }
    // Q s − ζ s³/6 = t: the linear solution, then one Newton step; within 3 % up to E = π/2.
    let first = high / r;
    let bend = zeta * first * first;
    let guess = first + first * bend / (6.0 * r - 3.0 * bend);
    solve(Anchor { r, eta: 0.0, zeta: -zeta }, beta, (high, low), guess, 1.7 / beta.sqrt())
}

/// Where a conic is at the time `high + low` ≥ 0 after its pericenter (an ellipse: up to eccentric anomaly π/2).
pub(super) fn after_pericenter(mu: f64, r: f64, zeta: f64, beta: f64, (high, low): (f64, f64)) -> Reached {
    if high == 0.0 {
        return at_the_apsis(r);
    }
    // q s + ζ s³/6 = t by Cardano, without the cancellation: exact for the parabola.
    let mut guess = if zeta > 1e-30 * r {
        let p = 2.0 * r / zeta;
        let k = 3.0 * (high / zeta);
        // Beyond 1e100, p³ < 1e91 is nothing beside k², which would overflow.
        let w = if k > 1e100 { cbrt(2.0 * k) } else { cbrt(k + (k * k + p * p * p).sqrt()) };
        2.0 * k / (w * w + p + (p / w) * (p / w))
    } else {
        high / r
    };
    let rate = beta.abs().sqrt();
    let mut upper = 1.7 / rate;
    if beta <= 0.0 {
        upper = 1.001 * guess;
        if guess * rate > 3.0 {
            // sinh H = (w³ t + μ H)/ζ, w = √−β: three times from H without the second term.
            let flight = rate * rate * rate * high;
            let mut h = 0.0;
            for _ in 0..3 {
                let sine = (flight + mu * h) / zeta;
                h = if sine > 0.0 { inverse_sinh(sine) } else { h };
            }
            if h > 0.0 && h < guess * rate {
                guess = h / rate;
            }
        }
    }
    solve(Anchor { r, eta: 0.0, zeta }, beta, (high, low), guess, upper)
}

/// arsinh x of x > 0, for a guess: small x lose digits.
fn inverse_sinh(x: f64) -> f64 {
    // Beyond 1e100, √(x² + 1) is x, and x² might overflow.
    if x > 1e100 { ln(x) + core::f64::consts::LN_2 } else { ln(x + (x * x + 1.0).sqrt()) }
}

fn at_the_apsis(r: f64) -> Reached {
    Reached { functions: UniversalFunctions { g0: 1.0, g1: 0.0, g2: 0.0, g3: 0.0 }, s: 0.0, r }
}
