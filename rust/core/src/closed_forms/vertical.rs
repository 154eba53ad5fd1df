//! What is told of a body thrown straight up against a uniform field, with linear or quadratic drag.
//!
//! Linear drag with x = v₀/(gτ): the apex after τ ln(1 + x) at gτ² (x − ln(1 + x)); back at the start after τu, where
//! u = (1 + x)(1 − e⁻ᵘ), which is Lambert's u = s + W₀(−s e⁻ˢ), s = 1 + x, solved without the cancellation that W₀ has at its
//! branch point as φ₂(u) u = x φ₁(u) ([`Decay`]); then the speed is gτ (u − x). Quadratic drag with x = v₀/v_t: the apex
//! after (v_t/g) arctan x at (v_t²/2g) ln(1 + x²), down in (v_t/g) arsinh x, then the speed is v₀/√(1 + x²).
//! Source: Corless et al., Adv. Comput. Math. 5 (1996) 329, for W; the rest by integration.

use crate::numerics::angles::atan;
use crate::numerics::decay::Decay;
use crate::numerics::logarithm::ln_1p;
use crate::numerics::scaled::Scaled;

/// A throw straight up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Throw {
    /// The speed that a long fall approaches.
    pub terminal_speed: f64,
    /// When it stands still, and how high.
    pub apex_time: f64,
    /// The height of the apex over the start.
    pub apex_height: f64,
    /// When it is back.
    pub return_time: f64,
    /// How fast it is then.
    pub return_speed: f64,
}

/// Steps of Newton: from twice the root at most, quadratic from the second on.
const NEWTON: usize = 60;

/// With the speed v₀, the field g > 0 and the time τ of linear drag.
pub fn with_linear_drag(speed: f64, g: f64, tau: f64) -> Throw {
    let terminal = Scaled::from(g).times(tau);
    let x = Scaled::from(speed).over(terminal);
    let (rise, scale) = (ln_1p(x), terminal.times(tau));
    // x − ln(1 + x), by its series where the difference has no digits left.
    let height = if x.to_f64() < 1e-10 {
        let next = x.times(2.0).over(Scaled::from(3.0));
        x.by(x).times(0.5).by(Scaled::from(1.0).minus(next))
    } else {
        x.minus(rise)
    };
    let back = way_back(x);
    Throw {
        terminal_speed: terminal.to_f64(),
        apex_time: rise.times(tau).to_f64(),
        apex_height: height.by(scale).to_f64(),
        return_time: back.times(tau).to_f64(),
        return_speed: back.minus(x).by(terminal).to_f64(),
    }
}

/// u > 0 with φ₂(u) u = x φ₁(u), from above: the function bends one way, so no step goes beyond.
fn way_back(x: Scaled) -> Scaled {
    let one = Scaled::from(1.0);
    let s = one.plus(x);
    let mut u = if x.to_f64() < 1.0 { x.times(2.0) } else { s };
    if u.to_f64() == 0.0 {
        return u;
    }
    for _ in 0..NEWTON {
        let Decay { first, second, .. } = Decay::new(u);
        let value = u.by(second).minus(x.by(first));
        let slope = first.minus(second).by(s);
        let step = value.over(slope);
        u = u.minus(step);
        if step.over(u).to_f64().abs() < 1e-25 {
            break;
        }
    }
    u
}

/// With the speed v₀, the field g > 0 and the terminal speed of quadratic drag.
pub fn with_quadratic_drag(speed: f64, g: f64, terminal: f64) -> Throw {
    let one = Scaled::from(1.0);
    let x = Scaled::from(speed).over(Scaled::from(terminal));
    let square = x.by(x);
    let root = one.plus(square).sqrt();
    let time = Scaled::from(terminal).over(Scaled::from(g));
    let rise = time.times(atan(x.to_f64()));
    let fall = ln_1p(x.plus(square.over(one.plus(root)))).by(time);
    Throw {
        terminal_speed: terminal,
        apex_time: rise.to_f64(),
        apex_height: ln_1p(square).by(time).times(0.5 * terminal).to_f64(),
        return_time: rise.plus(fall).to_f64(),
        return_speed: Scaled::from(speed).over(root).to_f64(),
    }
}
