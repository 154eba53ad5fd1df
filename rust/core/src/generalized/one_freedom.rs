//! One degree of freedom at constant energy: where it turns back, its period and its action, by quadrature.
//!
//! The one idea: with q = (q₂ + q₁)/2 + (q₂ − q₁)/2 · sin φ the turning points are divided out of the integrand, which is
//! then periodic and analytic in φ, so equal steps square their error with every doubling.
//! L. D. Landau & E. M. Lifshitz, *Mechanics*, (11.5), (49.7).

use super::gauss;
use super::model::{Kind, Model};
use crate::error::{Error, Result};
use crate::expressions::{Code, Machine};
use core::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use crate::numerics::angles;

/// The first steps to find a turning point, in units of the place.
const SMALLEST_STEP: f64 = 1e-2;
/// Steps that are alike, and all of them: the others grow, to 10^20.
const STEPS_ALIKE: u32 = 3000;
const MOST_STEPS: u32 = 8000;
/// As often a length is halved until two numbers are neighbours, whatever its unit.
const HALVINGS: u32 = 2200;
/// The last digit of a place may be this part of a swing.
const COARSEST: f64 = 2.3e-7;
/// Nodes that are begun with, and the most there are.
const NODES: (usize, usize) = (16, 1 << 20);
/// Squared cosines below this are near a turning point.
const NEAR_AN_END: f64 = 0.25;
/// Where potentials differ by less than this part of them, they are not subtracted.
const CANCELLATION: f64 = 0.1;
/// The most panels for the integral of a slope, and how well two of them agree that are exact.
const PANELS: u32 = 32;
const EXACT: f64 = 1e-15;
/// Sums that agree to this are exact.
const AGREEMENT: f64 = 4e-15;

/// Energy at rest and mass: what a motion of one coordinate depends on.
#[derive(Clone, Debug)]
pub struct OneFreedom {
    machine: Machine<f64>,
    /// The kinetic energy at the start, and what the energy would be at rest there.
    kinetic: f64,
    at_rest: f64,
    start: f64,
    t: f64,
}

/// An oscillation.
#[derive(Clone, Copy, Debug)]
pub struct Oscillation {
    /// Where it turns back.
    pub turning: (f64, f64),
    /// The time of a whole swing.
    pub period: f64,
    /// ∮ p dq / 2π.
    pub action: f64,
}

impl OneFreedom {
    /// Of a Lagrangian of one coordinate that conserves energy and has T = m(q) q̇²/2.
    ///
    /// # Errors
    /// Another system.
    pub fn new(model: &mut Model, state: &[f64], parameters: &[f64], t: f64) -> Result<Self> {
        let refused = |why: &str| Err(Error::invalid("L", format!("a period is that of {why}")));
        if model.source.kind != Kind::Lagrangian
            || model.source.coordinates != 1
            || !model.multipliers.is_empty()
        {
            return refused("a Lagrangian of one coordinate; reduce the others by routhian");
        }
        let (_, v) = model.source.halves();
        let mass = model.mass[0][0];
        if model.source.graph.reachable(&[mass]).contains(&v[0]) {
            return refused("a Lagrangian that is quadratic in the velocity");
        }
        let (q, _) = model.source.halves();
        let slope = model.source.graph.gradient(model.energy, &q)[0];
        let code: Arc<Code> = Arc::new(model.function(&[model.energy, mass, slope])?);
        let machine = Machine::new(code, parameters);
        let mut of = Self { machine, kinetic: 0.0, at_rest: 0.0, start: state[0], t };
        let [at_rest, mass, _] = of.values(state[0], 0.0);
        of.at_rest = at_rest;
        of.kinetic = 0.5 * mass * state[1] * state[1];
        Ok(of)
    }

    fn values(&mut self, q: f64, v: f64) -> [f64; 3] {
        let mut found = [0.0; 3];
        self.machine.evaluate(self.t, &[q, v], &mut found);
        found
    }

    /// What is left of the energy for motion.
    fn left(&mut self, q: f64) -> f64 {
        let at_rest = self.values(q, 0.0)[0];
        let fallen = self.at_rest - at_rest;
        if fallen.abs() >= CANCELLATION * self.at_rest.abs() {
            return self.kinetic + fallen;
        }
        // The difference of a short way would have few digits: the integral of the slope has all.
        let (nodes, weights) = gauss::quadrature();
        let (mut panels, mut last) = (1, f64::NAN);
        while panels <= PANELS {
            let width = (q - self.start) / f64::from(panels);
            let (mut sum, mut size) = (0.0, 0.0);
            for panel in 0..panels {
                for (x, w) in nodes.iter().zip(weights) {
                    let slope = w * self.values(self.start + (f64::from(panel) + x) * width, 0.0)[2];
                    sum += slope;
                    size += slope.abs();
                }
            }
            if (sum * width - last).abs() <= EXACT * size * width.abs() {
                return self.kinetic - sum * width;
            }
            last = sum * width;
            panels *= 2;
        }
        self.kinetic + fallen
    }

    /// The first turning point on one side, `None` if there is none within reach.
    fn turning(&mut self, direction: f64, scale: f64) -> Option<f64> {
        // At rest at the start it is one side's turning point itself.
        let (mut inside, mut step) = (self.start, SMALLEST_STEP * scale);
        for taken in 0..MOST_STEPS {
            let mut outside = inside + direction * step;
            let slope = |of: &mut Self, q: f64| direction * of.values(q, 0.0)[2];
            // A barrier that is narrower than a step has its top between them.
            if self.left(outside) >= 0.0 && slope(self, inside) > 0.0 && slope(self, outside) < 0.0 {
                let (mut rising, mut falling) = (inside, outside);
                for _ in 0..60 {
                    let middle = 0.5 * (rising + falling);
                    if slope(self, middle) > 0.0 { rising = middle } else { falling = middle }
                }
                if self.left(rising) < 0.0 {
                    outside = rising;
                }
            }
            if self.left(outside) < 0.0 {
                // Halved to neighbouring numbers.
                for _ in 0..HALVINGS {
                    let middle = inside + 0.5 * (outside - inside);
                    if middle == inside || middle == outside {
                        break;
                    }
                    if self.left(middle) < 0.0 { outside = middle } else { inside = middle }
                }
                return Some(outside);
            }
            inside = outside;
            if taken > STEPS_ALIKE {
                step *= 1.01;
            }
        }
        None
    }

    /// The oscillation through the start.
    ///
    /// # Errors
    /// A motion that does not turn back, or stands still.
    pub fn oscillation(&mut self) -> Result<Oscillation> {
        let stands_still = || {
            Error::invalid(
                "position",
                "the motion stands still, or swings by less than its place tells apart: an equilibrium; see linearize()",
            )
        };
        if self.kinetic == 0.0 && self.values(self.start, 0.0)[2] == 0.0 {
            return Err(stands_still());
        }
        let scale = if self.start.abs() > 1.0 { self.start.abs() } else { 1.0 };
        let (Some(low), Some(high)) = (self.turning(-1.0, scale), self.turning(1.0, scale)) else {
            return Err(Error::invalid(
                "position",
                "the motion does not turn back; the period of a rotation is period(turn=2π)",
            ));
        };
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        // How much of the swing the last digit of a place is.
        let digit = f64::EPSILON * low.abs().max(high.abs()) / half.abs();
        if digit.is_nan() || digit > COARSEST {
            return Err(stands_still());
        }
        let (nodes, weights) = gauss::quadrature();
        let mut of = |phi: f64| {
            let (sine, cosine) = angles::sin_cos(phi);
            let square = cosine * cosine;
            let place = middle + half * sine;
            let mass = self.values(place, 0.0)[1];
            let left = if square > NEAR_AN_END {
                self.left(place)
            } else {
                // Next to an end the difference would have lost its digits: it is the slope's integral from there.
                let far = half * square / (1.0 + sine.abs());
                let to_the_end = if sine > 0.0 { far } else { -far };
                let slopes =
                    nodes.iter().zip(weights).map(|(x, w)| w * self.values(place + x * to_the_end, 0.0)[2]);
                to_the_end * slopes.sum::<f64>()
            };
            // (E − U)/cos² has no zero at the ends.
            let speed = (2.0 * left / (mass * square)).sqrt();
            [half / speed, half * square * speed * mass]
        };
        let [period, action] = trapezoid(&mut of)?;
        Ok(Oscillation { turning: (low, high), period: 2.0 * period, action: action / PI })
    }

    /// The time in which the coordinate goes on by `turn`, and ∫ p dq / 2π over it, of a motion that never turns back.
    ///
    /// # Errors
    /// A motion that turns back on the way.
    pub fn rotation(&mut self, turn: f64) -> Result<[f64; 2]> {
        let start = self.start;
        let mut of = |phi: f64| {
            let place = start + turn * (0.5 + phi / PI);
            let mass = self.values(place, 0.0)[1];
            let speed = (2.0 * self.left(place) / mass).sqrt();
            [turn.abs() / (PI * speed), turn.abs() / PI * speed * mass]
        };
        let [period, action] = trapezoid(&mut of)?;
        Ok([period, action / (2.0 * PI)])
    }
}

/// ∫ of two integrands from −π/2 to π/2 through the middles of equal steps, halved (by three) until nothing changes.
fn trapezoid(of: &mut impl FnMut(f64) -> [f64; 2]) -> Result<[f64; 2]> {
    let (mut nodes, mut last) = (NODES.0, [f64::NAN; 2]);
    while nodes <= NODES.1 {
        let h = PI / nodes as f64;
        let (mut sums, mut rests) = ([0.0; 2], [0.0; 2]);
        for k in 0..nodes {
            let values = of(-FRAC_PI_2 + (k as f64 + 0.5) * h);
            for index in 0..2 {
                let change = values[index] + rests[index];
                let sum = sums[index] + change;
                rests[index] = change - (sum - sums[index]);
                sums[index] = sum;
            }
        }
        let found = sums.map(|sum| sum * h);
        if found.iter().any(|x| !x.is_finite()) {
            break;
        }
        if (0..2).all(|index| {
            (found[index] - last[index]).abs()
                <= AGREEMENT * found[index].abs() * (1.0 + (nodes as f64).sqrt() / 8.0)
        }) {
            return Ok(found);
        }
        last = found;
        nodes *= 2;
    }
    Err(Error::invalid(
        "position",
        "the quadrature does not converge: the motion is next to a separatrix, or turns back",
    ))
}
