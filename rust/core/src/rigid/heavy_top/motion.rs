//! Where a heavy top is at any time.
//!
//! The rotation is α = cos(θ/2) e^{i(φ+ψ)/2} and β = sin(θ/2) e^{i(φ−ψ)/2} (Cayley and Klein). With cos θ = u =
//! u₁ + (u₂ − u₁) sn²(λt + w₀), 1 + u is zero at ±iη with sc²(η, k') = (1 + u₁)/(u₂ − u₁), and 1 − u at K ± iη' with
//! sd²(η', k') = (1 − u₂)/(k'² (u₂ − u₁)): so α is ϑ₁(ζ ± iη) and β is ϑ₂(ζ ± iη') over ϑ₄(ζ), times phases that grow
//! with time. Their rates follow from those of φ ± ψ where |α| and |β| are largest. Nothing is singular at the poles.
//! Distances from the poles come from F(−1) = −(p_φ + p_ψ)²/A² and F(1) = −(p_φ − p_ψ)²/A², not from subtractions.
//! Sources: Klein & Sommerfeld, *Über die Theorie des Kreisels* ch. VI; Whittaker, *Analytical Dynamics* § 73; derived
//! anew.

use super::theta::{Lattice, Place, Theta};
use super::{Cubic, HeavyTop, Start, of};
use crate::error::{Error, Result};
use crate::numerics::angles::atan2;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elliptic::{complete_first_kind, incomplete_first_kind};
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;
use crate::words::number;

/// Below it, gravity beside the square of the rates is lost in the roots.
const WEAKEST: f64 = 1e-60;
/// How near to upright a start may be whose squares are still told from none.
const UPRIGHT: f64 = 1e-60;
/// Nutations smaller than this are none.
const STEADY: f64 = 1e-200;

/// Euler's angles and their rates.
#[derive(Clone, Copy, Debug)]
pub struct Angles {
    /// θ in [0, π], φ and ψ without jumps of 2π.
    pub angles: [f64; 3],
    /// Of θ, φ, ψ.
    pub rates: [f64; 3],
}

/// The motion from a start.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    start: Start,
    /// φ and ψ at the start.
    offset: [f64; 2],
    /// Times are multiplied by this power of two.
    time_exponent: i32,
    /// Without it the top precesses steadily.
    nodding: Option<Nodding>,
}

/// α or β.
#[derive(Clone, Copy, Debug)]
struct Part {
    theta: Theta,
    /// The sense of its phase, and its rate.
    sense: f64,
    rate: DoubleDouble,
    /// (p_φ ± p_ψ)/A.
    momentum: f64,
}

#[derive(Clone, Copy, Debug)]
struct Nodding {
    /// Half periods of the theta functions per time and at the start; on the separatrix, y.
    halves: [DoubleDouble; 2],
    separatrix: bool,
    /// From r to y; and −ln q'.
    stretch: f64,
    whole: f64,
    /// Of what slopes are by.
    rate: f64,
    parts: [Part; 2],
    /// |β| over |α| as the series have them.
    ratio: f64,
    /// ω₃ (1 − C/A).
    spin: f64,
    /// What the phases are less at the start.
    before: [DoubleDouble; 2],
}

/// Half of θ as sine and cosine, beside a factor; halves of φ + ψ and φ − ψ; the rate of θ.
struct Found {
    size: [f64; 2],
    phase: [DoubleDouble; 2],
    theta_dot: f64,
}

impl HeavyTop {
    /// The motion from a start, and φ and ψ there.
    ///
    /// # Errors
    /// `InvalidInput` for an angle outside [0, π], or gravity too weak beside the rates.
    pub fn motion(&self, start: Start, offset: [f64; 2]) -> Result<Motion> {
        let rates = [start.theta_dot, start.phi_dot, start.psi_dot];
        let gravity = of(self.torque) / of(self.across);
        let own = gravity.to_f64().sqrt();
        let most = rates.iter().fold(own, |most: f64, rate| most.max(rate.abs()));
        let time_exponent = exponent(most);
        let [theta_dot, phi_dot, psi_dot] = rates.map(|rate| scale(rate, -time_exponent));
        let near = Start { theta: start.theta, theta_dot, phi_dot, psi_dot };
        let own = scale(own, -time_exponent);
        if !(own * own >= WEAKEST && gravity.is_finite()) {
            let message = format!(
                "expected rates below 1e30 √(M g R/A), got {}; without gravity, see free_rotation",
                number(most)
            );
            return Err(Error::invalid("psi_dot", message));
        }
        let off = start.theta.max(theta_dot.abs());
        if 0.0 < off && off < UPRIGHT {
            let message = format!(
                "expected a start at rest upright or at least 1e-60 off, got theta = {} and theta_dot = {}",
                number(start.theta),
                number(start.theta_dot)
            );
            return Err(Error::invalid("theta", message));
        }
        let less = |value: f64| scale(value, -2 * time_exponent);
        let (high, low) = gravity.parts();
        let cubic = self.cubic(&near, DoubleDouble::sum(less(high), less(low)))?;
        let mut nodding = Nodding::new(&cubic, &near, of(self.along) / of(self.across));
        if let Some(nodding) = &mut nodding {
            let first = nodding.found(of(0.0)).phase;
            // From upright the axis leaves along or against the line of nodes. (π of float64 is not quite below.)
            let back = if start.theta == 0.0 && theta_dot < 0.0 { DoubleDouble::PI } else { of(0.0) };
            nodding.before = [-first[0], back - first[1]];
        }
        Ok(Motion { start, offset, time_exponent, nodding })
    }
}

impl Motion {
    /// Checks that the turns until a time are a number, as they then are at any nearer to the start.
    ///
    /// # Errors
    /// `InvalidInput` where the top turns more often than can be counted.
    pub fn check_time(&self, time: f64) -> Result<()> {
        let at = self.at(time);
        if at.angles.iter().chain(&at.rates).all(|part| part.is_finite()) {
            return Ok(());
        }
        let message = format!("expected a time until which the turns can be counted, got {}", number(time));
        Err(Error::invalid("t", message))
    }

    /// Where it is at a time, before the start or after.
    pub fn at(&self, time: f64) -> Angles {
        let Start { theta, phi_dot, psi_dot, .. } = self.start;
        let [phi, psi] = self.offset;
        let Some(nodding) = &self.nodding else {
            let turned = |first: f64, rate: f64| (of(first) + DoubleDouble::product(rate, time)).to_f64();
            return Angles {
                angles: [theta, turned(phi, phi_dot), turned(psi, psi_dot)],
                rates: [0.0, phi_dot, psi_dot],
            };
        };
        let Found { size, phase, theta_dot } = nodding.found(of(scale(time, self.time_exponent)));
        let [up, down] = [0, 1].map(|at| phase[at] + nodding.before[at]);
        let [cosine, sine] = size;
        let square = cosine * cosine + sine * sine;
        let half = |at: usize| {
            let momentum = nodding.parts[at].momentum;
            // Through the pole itself this part of the phase only jumps.
            if momentum == 0.0 { 0.0 } else { momentum * square / (size[at] * size[at]) * 0.25 }
        };
        let (both, apart) = (half(0), half(1));
        let rates = [theta_dot, both + apart, both - apart + nodding.spin];
        Angles {
            angles: [
                2.0 * atan2(sine, cosine),
                (of(phi) + up + down).to_f64(),
                (of(psi) + up - down).to_f64(),
            ],
            rates: rates.map(|rate| scale(rate, self.time_exponent)),
        }
    }
}

impl Nodding {
    /// None if it does not nod.
    fn new(cubic: &Cubic, start: &Start, along: DoubleDouble) -> Option<Self> {
        let Cubic { above, below, spin: momentum, .. } = *cubic;
        let [a, b, _, d] = cubic.coefficients;
        let phi = of(start.phi_dot);
        // (p_φ ± p_ψ)/A.
        let momenta = [above * (phi * below + momentum), below * (phi * above - momentum)];
        let [x1, x2, x3, beyond, short] = cubic.separated(momenta[1]);
        let range = x2 - x1;
        if (a.high() == 0.0 && b.high() == 0.0) || range.high() <= STEADY {
            return None;
        }
        // 1 + u₃, 1 + u₂, 1 − u₁, u₃ − u₁ and u₃ − u₂.
        let (above3, above2, below1, span, gap) =
            (above + x3, above + x2, below - x1, x3 - x1, beyond + short);
        let lowest = momenta[0] * momenta[0] / (d * above2 * above3);
        let root = |value: DoubleDouble| value.max(of(0.0)).sqrt();
        let (complement, modulus) = (root(gap / span), root(range / span));
        let lattice =
            Lattice { quarter: complete_first_kind(complement), other: complete_first_kind(modulus) };
        let rate = root(d * span).scale(0.5);
        let separatrix = !lattice.quarter.is_finite();

        let sines = [root(-x1 / range), root(x2 / range)];
        let argument = if sines[1].high() == 0.0 {
            lattice.quarter
        } else {
            incomplete_first_kind(sines[0], sines[1], root(x3 / span))
        };
        if !argument.is_finite() {
            return None;
        }
        let argument = if start.theta_dot > 0.0 { -argument } else { argument };
        let per_argument = lattice.per_argument();
        let halves = if separatrix {
            [rate * per_argument, argument * per_argument]
        } else {
            [rate, argument].map(|part| part / lattice.quarter.scale(2.0))
        };

        let poles = [
            [root(lowest / above2), root(range / above2), root(range * above3 / (span * above2))],
            if gap.high() == 0.0 {
                [of(0.0), of(1.0), of(1.0)]
            } else {
                let under = gap * below1;
                [root(short * span / under), root(range * beyond / under), root(range / below1)]
            },
        ];
        let spin = momentum / along - momentum;
        // Rates of half of φ ± ψ where u is u₂ and u₁.
        let middle = [momenta[0] / above2 + spin, momenta[1] / below1 - spin];
        let parts = [0, 1].map(|at| {
            let [s, c, delta] = poles[at];
            let pole = incomplete_first_kind(s, c, delta);
            let rest = incomplete_first_kind(c / delta, modulus * s / delta, modulus / delta);
            let theta = Theta::new(&lattice, pole, rest, rate);
            let sense = if momenta[at].high() > 0.0 { -1.0 } else { 1.0 };
            let rate = middle[at].scale(0.5) + theta.falling.scale(sense);
            Part { theta, sense, rate, momentum: momenta[at].to_f64() }
        });
        let nome = lattice.nome();
        let (ratio, stretch, whole) = if lattice.trigonometric() {
            (root(below1 / above2 * complement), 1.0, 0.0)
        } else {
            // √k' = 2 q'^¼ Σ q'^{n(n+1)}/(1 + 2 Σ q'^{n²}).
            let (mut up, mut down, mut power) = (of(1.0), of(1.0), nome);
            for odd in [3, 5, 7, 9] {
                down += power.scale(2.0);
                // From q'^{n²} to q'^{n(n+1)} and q'^{(n+1)²}.
                let n = (odd - 1) / 2;
                let more = (0..n).fold(of(1.0), |product, _| product * nome);
                up += power * more;
                power = power * more * more * nome;
            }
            let whole = (DoubleDouble::PI * lattice.quarter / lattice.other).to_f64();
            (
                (root(below1 / above2) * up / down).scale(2.0),
                (lattice.quarter / lattice.other).to_f64(),
                whole,
            )
        };
        Some(Self {
            halves,
            separatrix,
            stretch,
            whole,
            rate: (rate * per_argument).to_f64(),
            parts,
            ratio: ratio.to_f64(),
            spin: spin.to_f64(),
            before: [of(0.0); 2],
        })
    }

    fn found(&self, time: DoubleDouble) -> Found {
        let argument = self.halves[0] * time + self.halves[1];
        let (quarters, place) = if self.separatrix {
            (of(0.0), Place::new(0.0, argument.to_f64(), self.whole))
        } else {
            let quarters = argument.scale(2.0).round();
            let r = (DoubleDouble::PI * (argument - quarters.scale(0.5))).to_f64();
            (quarters, Place::new(r, r * self.stretch, self.whole))
        };
        let halves = quarters.scale(0.5).round();
        let apart = (quarters.scale(0.5) - halves).high();
        let at_lowest = apart == 0.0;
        let before = if at_lowest { halves } else { quarters.scale(0.5) - of(0.5) };
        let [up, down] = &self.parts;
        let [[up_odd, up_even], [down_odd, down_even]] = [up, down].map(|part| part.theta.at(&place));
        let (alpha, beta, after, factor) = if at_lowest {
            (up_odd, down_even, before, place.fall)
        } else {
            (up_even, down_odd, before + of(1.0), place.ahead)
        };
        let factor = if up.theta.is_trigonometric() { self.ratio } else { self.ratio * factor.sqrt() };
        let turned = |part: &Part, argument: f64, halves: DoubleDouble| {
            let fallen = of(argument - part.theta.linear * place.angle) - DoubleDouble::PI * halves;
            part.rate * time + fallen.scale(part.sense)
        };
        let phase = [turned(up, alpha.argument(), before), turned(down, beta.argument(), after)];
        let (along, across) = (down.theta.middle, factor * up.theta.middle);
        let [(a, a_dot), (b, b_dot)] = [alpha.size(), beta.size()];
        let (a, a_dot, b, b_dot) = (along * a, along * a_dot, across * b, across * b_dot);
        let theta_dot = 2.0 * self.rate * (a * b_dot - b * a_dot) / (a * a + b * b);
        Found { size: [a, b], phase, theta_dot }
    }
}
