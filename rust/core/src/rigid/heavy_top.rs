//! A symmetric top with a fixed point, in uniform gravity: what its constants of motion tell, and its motion at any
//! time (`heavy_top/motion.rs`).
//!
//! The one idea: the height cos θ = u moves in a cubic, u̇² = F(u); it is written about the height it starts from and
//! solved in double-double, so that neither the roots nor their distances from the poles are small differences of
//! rounded numbers. Steady precessions are the two roots of a quadratic whose leading term has cos θ: neither is
//! divided by what vanishes at the horizontal.
//! Sources: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. § 5.7; Landau & Lifshitz, *Mechanics* § 35.

mod motion;
mod theta;

use super::moments::check;
use crate::error::{Error, Result};
use crate::numerics::angles::atan2;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elliptic::complete_first_kind;
use crate::numerics::real::Real;
use crate::numerics::rotation::Rotation;
use crate::numerics::scaled::Scaled;
use crate::words::number;

pub use motion::{Angles, Motion};

/// Halvings until nothing is left of a bracket in double-double.
const HALVINGS: usize = 220;
/// What is no more than so many roundings of its terms is nothing.
const ROUNDINGS: f64 = 4.0;

/// The top: moments about the fixed point, across (A) and along (C) its axis, and mass · g · distance.
#[derive(Clone, Copy, Debug)]
pub struct HeavyTop {
    across: f64,
    along: f64,
    torque: f64,
}

/// Where it is and how it turns, by Euler's angles and rates.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Angle from the vertical.
    pub theta: f64,
    /// Rates.
    pub theta_dot: f64,
    /// About the vertical.
    pub phi_dot: f64,
    /// About the axis.
    pub psi_dot: f64,
}

/// The nutation.
#[derive(Clone, Copy, Debug)]
pub struct Nutation {
    /// The three roots of F(u), ascending; u stays between the first two.
    pub roots: [f64; 3],
    /// The least and the greatest angle from the vertical.
    pub theta: [f64; 2],
    /// From the least to the greatest and back; infinite if it takes for ever.
    pub period: f64,
    /// The height at which the precession would turn round.
    pub turning: f64,
    /// How the axis draws its line: loop, cusp, wave, plane or steady.
    pub kind: &'static str,
}

fn of(value: f64) -> DoubleDouble {
    DoubleDouble::from(value)
}

impl HeavyTop {
    /// From moments about the fixed point, and how far the center of mass is from it.
    ///
    /// # Errors
    /// `InvalidInput` for what is not positive, moments of no body, or a top that gravity does not turn.
    pub fn new(across: f64, along: f64, mass: f64, g: f64, distance: f64) -> Result<Self> {
        let given = [("A", across), ("C", along), ("mass", mass), ("g", g), ("R", distance)];
        for (name, value) in given {
            if !(value > 0.0 && value.is_finite()) {
                let advice = match (name, value == 0.0) {
                    ("g" | "R", true) => "; without a torque of gravity it turns freely: see free_rotation",
                    ("g" | "R", false) => "; a hanging top has theta beyond pi/2",
                    _ => "",
                };
                let message = format!("expected a positive number, got {}{advice}", number(value));
                return Err(Error::invalid(name, message));
            }
        }
        check("moments", [across, across, along]).map_err(|error| match error {
            Error::InvalidInput { message, .. } => Error::invalid("C", format!("{message} (A, A, C)")),
            other => other,
        })?;
        let torque = mass * g * distance;
        if !(torque > 0.0 && torque.is_finite()) {
            let message = "expected mass · g · R within the range of float64; choose other units";
            return Err(Error::invalid("mass", message));
        }
        Ok(Self { across, along, torque })
    }

    /// The spin above which it sleeps upright: (C ω)² = 4 A M g R.
    pub fn sleeping_threshold(&self) -> f64 {
        2.0 * (self.across * self.torque).sqrt() / self.along
    }

    /// The least spin with which it precesses steadily at an angle: zero from the horizontal down.
    pub fn least_spin(&self, theta: f64) -> f64 {
        let upright = cosine(theta).to_f64().max(0.0);
        self.sleeping_threshold() * upright.sqrt()
    }

    /// The slow and the fast steady precession at an angle, A cos θ Ω² − C ω Ω + M g R = 0.
    ///
    /// # Errors
    /// `InvalidInput` where there is none.
    pub fn steady_precession(&self, theta: f64, spin: f64) -> Result<[f64; 2]> {
        let momentum = DoubleDouble::product(self.along, spin);
        let leading = of(self.across) * cosine(theta);
        let rest = momentum * momentum - (leading * of(self.torque)).scale(4.0);
        if rest.high() < 0.0 {
            let message = format!(
                "expected at least {} for a steady precession at theta = {}, got {}",
                number(self.least_spin(theta)),
                number(theta),
                number(spin)
            );
            return Err(Error::invalid("spin", message));
        }
        let sign = if momentum.high() < 0.0 { -1.0 } else { 1.0 };
        // Of one sign, so nothing cancels.
        let sum = momentum + rest.sqrt().scale(sign);
        let slow = of(self.torque).scale(2.0) / sum;
        Ok([slow.to_f64(), sum.to_f64() / (2.0 * leading.to_f64())])
    }

    /// The frequency of small nutations about a steady precession.
    pub fn nutation_frequency(&self, theta: f64, spin: f64, precession: f64) -> f64 {
        let (u, rate) = (cosine(theta).to_f64(), self.along * spin / self.across);
        // (ω − 2 Ω cos θ)² + Ω² sin² θ, with ω the spin times C/A: a sum of squares.
        let apart = rate - 2.0 * precession * u;
        (apart * apart + precession * precession * (1.0 - u * u)).sqrt()
    }

    /// The cubic about the start.
    fn cubic(&self, start: &Start, gravity: DoubleDouble) -> Result<Cubic> {
        if !(0.0..=core::f64::consts::PI).contains(&start.theta) {
            let message = format!("expected an angle in [0, π], got {}", number(start.theta));
            return Err(Error::invalid("theta", message));
        }
        let half = Rotation::new(Scaled::from(0.5 * start.theta));
        let [s, c] = [half.sine, half.cosine].map(|part| part.to_double_double());
        // 1 − u and 1 + u at the start, and sin² θ.
        let (below, above) = ((s * s).scale(2.0), (c * c).scale(2.0));
        let (u, sine) = (c * c - s * s, below * above);
        let [phi, theta] = [start.phi_dot, start.theta_dot].map(of);
        let spin = (of(start.psi_dot) + phi * u) * of(self.along) / of(self.across);
        let swing = theta * theta + phi * phi * sine;
        // F(x) of x = u − u₀.
        let slope = [phi * sine * spin, -(u * swing), -(gravity * sine)];
        let coefficients = [
            sine * theta * theta,
            (slope[0] + slope[1] + slope[2]).scale(2.0),
            (gravity * u).scale(4.0) - swing - spin * spin,
            gravity.scale(2.0),
        ];
        let terms: f64 = slope.iter().map(|term| 2.0 * term.to_f64().abs()).sum();
        // It neither moves from there nor is pushed, but for the rounding of the rates given, and comes back.
        let rests = theta.high() == 0.0
            && coefficients[1].to_f64().abs() <= ROUNDINGS * f64::EPSILON * terms
            && coefficients[2].to_f64() < 0.0;
        let roots = roots(coefficients, -above, below);
        Ok(Cubic { above, below, u, sine, spin, coefficients, roots, rests })
    }

    /// The nutation from a start.
    ///
    /// # Errors
    /// `InvalidInput` for an angle outside [0, π].
    pub fn nutation(&self, start: Start) -> Result<Nutation> {
        let cubic = self.cubic(&start, of(self.torque) / of(self.across))?;
        let Cubic { above, below, u, sine, spin, roots: [x1, x2, x3], rests, .. } = cubic;
        let phi = of(start.phi_dot);
        let angle = |x: DoubleDouble| {
            let [up, down] = [below - x, above + x].map(|part| part.to_f64().max(0.0).sqrt());
            2.0 * atan2(up, down)
        };
        let complement = ((x3 - x2) / (x3 - x1)).max(of(0.0)).sqrt();
        let rate = (cubic.coefficients[3] * (x3 - x1)).sqrt();
        let period = complete_first_kind(complement).scale(4.0) / rate;
        // Where p_φ = p_ψ u.
        let turning = phi * sine / spin;
        let kind = if x1 == x2 || rests {
            "steady"
        } else if spin.high() == 0.0 {
            if phi.high() == 0.0 || sine.high() == 0.0 { "plane" } else { "wave" }
        } else if turning == x2 {
            "cusp"
        } else if x1 < turning && turning < x2 {
            "loop"
        } else {
            "wave"
        };
        Ok(Nutation {
            roots: [x1, x2, x3].map(|x| (u + x).to_f64()),
            theta: [angle(x2), angle(x1)],
            period: if complement.high() == 0.0 { f64::INFINITY } else { period.to_f64() },
            turning: (u + turning).to_f64(),
            kind,
        })
    }
}

/// F(u) about the start u, and its roots, as distances from there.
struct Cubic {
    /// 1 + u, 1 − u, u and sin² θ.
    above: DoubleDouble,
    below: DoubleDouble,
    u: DoubleDouble,
    sine: DoubleDouble,
    /// p_ψ/A.
    spin: DoubleDouble,
    coefficients: [DoubleDouble; 4],
    roots: [DoubleDouble; 3],
    /// Whether the angle stays what it is.
    rests: bool,
}

impl Cubic {
    /// The roots, none of them lost to another that is near, then u₃ − 1 and 1 − u₂, by (p_φ − p_ψ)/A.
    fn separated(&self, across: DoubleDouble) -> [DoubleDouble; 5] {
        let zero = of(0.0);
        let [a, _, c, d] = self.coefficients;
        let [mut x1, mut x2, mut x3] = self.roots;
        // The two numbers with this difference and this product, both ≥ 0.
        let two = |difference: DoubleDouble, product: DoubleDouble| {
            let rest = (difference * difference + product.scale(4.0)).sqrt();
            let larger = (difference.max(zero) + (-difference).max(zero) + rest).scale(0.5);
            let smaller = if larger.high() == 0.0 { zero } else { product / larger };
            if difference.high() > 0.0 { (larger, smaller) } else { (smaller, larger) }
        };
        let by_lowest = x2 - x1 > x3 - x2;
        if a.high() > 0.0 && !by_lowest {
            let (up, down) = two(-c / d - x3, a / (d * x3));
            (x1, x2) = (-down, up);
        }
        let sum = if a.high() > 0.0 && by_lowest { -c / d - x1 } else { x2 + x3 };
        let (beyond, short) = two(sum - self.below.scale(2.0), across * across / (d * (self.below - x1)));
        if a.high() > 0.0 && by_lowest {
            x3 = self.below + beyond;
            x2 = if -x1 > x2 { a / (d * -x1 * x3) } else { self.below - short };
        }
        [x1, x2, x3, beyond, short]
    }
}

/// cos θ in double-double.
fn cosine(theta: f64) -> DoubleDouble {
    Rotation::new(Scaled::from(theta)).cosine.to_double_double()
}

fn value([a, b, c, d]: [DoubleDouble; 4], x: DoubleDouble) -> DoubleDouble {
    ((d * x + c) * x + b) * x + a
}

/// The roots of a cubic with F(low) ≤ 0 ≤ F(0), F(high) ≤ 0 and a positive leading term, where low ≤ 0 ≤ high.
fn roots(cubic: [DoubleDouble; 4], low: DoubleDouble, high: DoubleDouble) -> [DoubleDouble; 3] {
    let zero = of(0.0);
    let [a, b, c, d] = cubic;
    if a.high() == 0.0 {
        // Zero is one of them; the others' product is b/d, their sum −c/d, and one of them is beyond `high`.
        let rest = (c * c - (b * d).scale(4.0)).max(zero).sqrt();
        let sum = if c.high() > 0.0 { -(c + rest).scale(0.5) } else { (rest - c).scale(0.5) };
        let (one, other) = (sum / d, if sum.high() == 0.0 { zero } else { b / sum });
        let (near, far) = if one < other { (one, other) } else { (other, one) };
        return [near.min(zero), near.max(zero), far];
    }
    let mut beyond = high + of(1.0);
    while value(cubic, beyond).high() <= 0.0 && beyond.is_finite() {
        beyond = beyond.scale(2.0);
    }
    [between(cubic, zero, low), between(cubic, zero, high), between(cubic, beyond, high)]
}

/// The root between a place where the cubic is positive and one where it is not.
fn between(cubic: [DoubleDouble; 4], positive: DoubleDouble, other: DoubleDouble) -> DoubleDouble {
    let (mut positive, mut other) = (positive, other);
    for _ in 0..HALVINGS {
        let middle = (positive + other).scale(0.5);
        if middle == positive || middle == other {
            break;
        }
        if value(cubic, middle).high() > 0.0 {
            positive = middle;
        } else {
            other = middle;
        }
    }
    other
}
