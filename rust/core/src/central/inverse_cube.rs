//! F = −γ/r² − κ/r³ in closed form: conics that turn, and spirals.
//!
//! u'' + β²u = mγ/l², β² = 1 − mκ/l². With S(θ) = sin(βθ)/β and C(θ) = (1 − cos βθ)/β², which are sinh and cosh where
//! β² < 0 and θ, θ²/2 where it is 0, u = u₀ + u₀′ S + (mγ/l² − β²u₀) C from any start.

use crate::error::{Error, Result};
use crate::numerics::angles::{atan2, sin};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::Exponential;
use core::f64::consts::PI;

/// An orbit under an inverse-square force and an inverse-cube one.
#[derive(Clone, Copy, Debug)]
pub struct InverseCube {
    /// 1 − mκ/l².
    pub beta_squared: f64,
    /// l = m r²θ̇.
    pub angular_momentum: f64,
    /// m v²/2 − γ/r − κ/2r².
    pub energy: f64,
    /// e of u = (mγ/l²β²)(1 + e cos βθ); NaN where β² ≤ 0 or γ = 0.
    pub eccentricity: f64,
    /// Least and greatest distance.
    pub range: (f64, f64),
    /// π/β; NaN where the pericenter does not come again.
    pub apsidal_angle: f64,
    /// 2π√(ma³/γ), a = γ/2|E|; infinite where the pericenter does not come again.
    pub radial_period: f64,
    /// u, du/dθ and mγ/l² − β²u at the start.
    start: [f64; 3],
}

impl InverseCube {
    /// Through a distance, with a radial velocity and one across, of at least 0.
    ///
    /// # Errors
    /// None across: there is no path r(θ).
    pub fn new(mass: f64, gamma: f64, kappa: f64, r: f64, radial: f64, across: f64) -> Result<Self> {
        if across == 0.0 {
            let message = "expected one that is not along the position: a radial motion has no path r(θ)";
            return Err(Error::invalid("velocity", message));
        }
        // l²/m, from which mκ/l² may take nearly all.
        let square =
            DoubleDouble::product(r, across) * DoubleDouble::product(r, across) * DoubleDouble::from(mass);
        let beta = (square - DoubleDouble::from(kappa)) / square;
        let push = DoubleDouble::from(gamma) / square;
        let u = DoubleDouble::from(1.0) / DoubleDouble::from(r);
        let rate = -(DoubleDouble::from(radial) / (DoubleDouble::from(r) * DoubleDouble::from(across)));
        // u'² + β²u² − 2 c u.
        let constant = rate * rate + beta * u * u - push * u.scale(2.0);
        let under = push * push + constant * beta;
        let (beta_squared, push_f, constant_f) = (beta.to_f64(), push.to_f64(), constant.to_f64());
        let root = under.to_f64().max(0.0).sqrt();
        let q = push_f + root.copysign(push_f);
        let roots = if under.high() < 0.0 && beta_squared < 0.0 {
            None
        } else if beta_squared == 0.0 {
            let only = -0.5 * constant_f / push_f;
            if push_f > 0.0 { Some((f64::NEG_INFINITY, only)) } else { Some((only, f64::INFINITY)) }
        } else {
            let (a, b) = (q / beta_squared, if q == 0.0 { 0.0 } else { -constant_f / q });
            Some((a.min(b), a.max(b)))
        };
        let far = |u: f64| if u > 0.0 { 1.0 / u } else { f64::INFINITY };
        let here = u.to_f64();
        let range = match roots {
            None => (0.0, f64::INFINITY),
            Some((low, high)) if beta_squared > 0.0 => (1.0 / high, far(low)),
            Some((_, only)) if beta_squared == 0.0 && push_f > 0.0 => (0.0, far(only)),
            Some((only, _)) if beta_squared == 0.0 => (1.0 / only, f64::INFINITY),
            Some((low, high)) if here > 0.5 * (low + high) => (0.0, far(high)),
            Some((low, _)) => (1.0 / low, f64::INFINITY),
        };
        let bound = beta_squared > 0.0 && range.1.is_finite();
        let energy = (square * constant).to_f64() * 0.5;
        let a = 0.5 * (range.0 + range.1);
        Ok(Self {
            beta_squared,
            angular_momentum: mass * r * across,
            energy,
            eccentricity: if beta_squared > 0.0 { root / push_f.abs() } else { f64::NAN },
            range,
            apsidal_angle: if bound { PI / beta_squared.sqrt() } else { f64::NAN },
            radial_period: if bound { 2.0 * PI * a * (mass * a / gamma).sqrt() } else { f64::INFINITY },
            start: [here, rate.to_f64(), (push - beta * u).to_f64()],
        })
    }

    /// r at an angle since the start; nothing where the orbit does not come.
    pub fn radius(&self, angle: f64) -> Option<f64> {
        let half = 0.5 * angle;
        let size = self.beta_squared.abs().sqrt();
        let over = |angle: f64| match self.beta_squared {
            b if b * angle * angle == 0.0 => angle,
            b if b > 0.0 => sin(size * angle) / size,
            _ => hyperbolic_sine(size * angle) / size,
        };
        // From the start to the asymptote u stays above zero; beyond, another branch would begin.
        let u = self.start[0] + self.start[1] * over(angle) + 2.0 * self.start[2] * over(half) * over(half);
        let returns = self.range.1.is_finite();
        let reached = returns || !self.passes_infinity(angle);
        (u > 0.0 && reached).then(|| 1.0 / u)
    }

    /// Whether u has a zero between the start and an angle, of an orbit that escapes.
    fn passes_infinity(&self, angle: f64) -> bool {
        // A conic that turns about is above zero on less than a turn of βθ to either side of its pericenter.
        let [_, rate, rest] = self.start;
        if self.beta_squared <= 0.0 {
            return false;
        }
        let size = self.beta_squared.sqrt();
        // u = c/β² + A cos(βθ − δ): from −rest/β² = A cos δ, rate/β = A sin δ.
        let delta = atan2(rate / size, -rest / self.beta_squared);
        (size * angle - delta).abs() >= PI
    }
}

fn hyperbolic_sine(x: f64) -> f64 {
    if x.abs() > 0.5 {
        return 0.5 * (Exponential::exp(x) - Exponential::exp(-x));
    }
    let square = x * x;
    let mut sum = 1.0;
    for k in (1..=8).rev() {
        let k = f64::from(k);
        sum = 1.0 + sum * square / (2.0 * k * (2.0 * k + 1.0));
    }
    x * sum
}
