//! Collisions with a Q-value, and both bodies at once: m₁ on m₂ at rest, m₃ and m₄ away.
//!
//! The one idea: momentum and energy as the laboratory sees them, p₁ = p₃ + p₄ and E₁ + Q = E₃ + E₄, for any masses.
//! With M = m₃ + m₄ the energy of relative motion afterwards is E₁ (M - m₁)/M + Q, and the frame of no momentum moves
//! with p₁/M. Speeds are in units of √(2E₁/m) of each body, so that their squares are parts of the beam energy; there
//! (V + w)(V - w) is (m₁ - m₄ - m₄ Q/E₁)/M for the projectile and (m₁ - m₃ - m₃ Q/E₁)/M for the target. These
//! differences and the one at the threshold are taken in double-double: no digit of what is given is lost.

use super::{Circle, Collision, HalfAngle};
use crate::numerics::angles::atan2;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, scale};
use crate::words::number;
use crate::{Error, Result};
use core::f64::consts::FRAC_PI_2;

/// What goes in and out, and the energy that is released (Q > 0) or taken up (Q < 0) between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction {
    projectile: f64,
    target: f64,
    products: [f64; 2],
    /// m₃ + m₄.
    total: DoubleDouble,
    /// m₃ + m₄ - m₁.
    rest: DoubleDouble,
    q_value: f64,
}

/// One body after the collision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Product {
    circle: Circle,
    /// Its part of the beam energy where it goes ahead in the centre-of-mass frame, and where it goes back.
    ahead: f64,
    back: f64,
}

/// A collision at one energy: what becomes of projectile and target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encounter {
    projectile: Product,
    target: Product,
}

impl Reaction {
    /// Masses of projectile and target, of what they become, and Q.
    ///
    /// # Errors
    /// `InvalidInput` naming `masses`, `products` or `q_value`.
    pub fn new(masses: (f64, f64), products: (f64, f64), q_value: f64) -> Result<Self> {
        let _checked = Collision::new(masses.0, masses.1)?;
        let finite = products.0 > 0.0 && products.1 > 0.0 && products.0.is_finite() && products.1.is_finite();
        let refused = |message: String| Err(Error::invalid("products", message));
        if !finite {
            return refused(format!(
                "expected two positive finite masses, got {} and {}",
                number(products.0),
                number(products.1)
            ));
        }
        if !q_value.is_finite() {
            return Err(Error::invalid(
                "q_value",
                format!("expected a finite number, got {}", number(q_value)),
            ));
        }
        let all = [masses.0, masses.1, products.0, products.1];
        let unit = exponent(all.into_iter().fold(0.0, f64::max));
        let [projectile, target, third, fourth] = all.map(|mass| scale(mass, -unit));
        let least = projectile.min(target).min(third).min(fourth);
        if least < f64::MIN_POSITIVE {
            return refused("expected masses within 307 decades of each other".to_owned());
        }
        let total = DoubleDouble::sum(third, fourth);
        let unchanged = (third, fourth) == (projectile, target);
        let rest =
            if unchanged { DoubleDouble::from(target) } else { total - DoubleDouble::from(projectile) };
        if rest.high() <= 0.0 {
            return refused(format!(
                "expected together more mass than the projectile's, {}, got {} and {}",
                number(masses.0),
                number(products.0),
                number(products.1)
            ));
        }
        Ok(Self { projectile, target, products: [third, fourth], total, rest, q_value })
    }
    /// The least beam energy: -Q (m₃+m₄)/(m₃+m₄-m₁), or 0 for Q ≥ 0.
    pub fn threshold(&self) -> f64 {
        let unit = exponent(self.q_value);
        let taken = DoubleDouble::from(scale(-self.q_value, -unit).max(0.0));
        scale((taken * (self.total / self.rest)).to_f64(), unit)
    }
    /// The beam energy at which the projectile no longer goes back, or no longer stops going back:
    /// Q m₄/(m₁ - m₄), where V = w. None if there is none above the threshold.
    pub fn turning_energy(&self) -> Option<f64> {
        let difference = self.projectile - self.products[1];
        let unit = exponent(self.q_value);
        let energy = scale(scale(self.q_value, -unit) * (self.products[1] / difference), unit);
        (energy > 0.0 && energy.is_finite() && energy >= self.threshold()).then_some(energy)
    }
    /// At a beam energy.
    ///
    /// # Errors
    /// `InvalidInput` naming `beam_energy` below the threshold.
    pub fn at(&self, beam_energy: f64) -> Result<Encounter> {
        let refused = |message: String| Err(Error::invalid("beam_energy", message));
        if !(beam_energy > 0.0 && beam_energy.is_finite()) {
            return refused(format!("expected a positive finite number, got {}", number(beam_energy)));
        }
        let threshold = self.threshold();
        if beam_energy < threshold {
            return refused(format!(
                "expected at least the threshold, {}, that Q = {} sets, got {}",
                number(threshold),
                number(self.q_value),
                number(beam_energy)
            ));
        }
        if self.is_elastic() {
            return Ok(Encounter::elastic(Collision::new(self.projectile, self.target)?));
        }
        let released = self.q_value / beam_energy;
        if released.abs() > 1e300 {
            return refused(format!(
                "expected at least 1e-300 of |Q| = {}, got {}",
                number(self.q_value.abs()),
                number(beam_energy)
            ));
        }
        Ok(self.encounter(beam_energy))
    }
    /// Whether masses stay what they are, without a Q-value.
    pub fn is_elastic(&self) -> bool {
        self.products == [self.projectile, self.target] && self.q_value == 0.0
    }
    /// What is released or taken up.
    pub fn q_value(&self) -> f64 {
        self.q_value
    }
    /// At a beam energy that is known to be one: of those between two that [`at`](Self::at) takes. It is not checked
    /// again, and at a rounding below the threshold it is as at the threshold.
    pub(in crate::scattering) fn encounter(&self, beam_energy: f64) -> Encounter {
        // Q/E₁, both of order one, and put back by a power of two.
        let (taken, given) = (exponent(self.q_value), exponent(beam_energy));
        let ratio =
            DoubleDouble::from(scale(self.q_value, -taken)) / DoubleDouble::from(scale(beam_energy, -given));
        let (high, low) = ratio.parts();
        let ratio = DoubleDouble::new(scale(high, taken - given), scale(low, taken - given));
        // The rounded threshold may be below the exact one.
        let relative = (self.rest / self.total + ratio).high().max(0.0);
        let [third, fourth] = self.products;
        let product = |own: f64, other: f64| {
            let total = self.total.high();
            let frame = self.projectile.sqrt() * own.sqrt() / total;
            let speed = relative.sqrt() * (other / total).sqrt(); // of both: the product may be below all numbers
            let fast = frame + speed;
            let [projectile, other] = [self.projectile, other].map(DoubleDouble::from);
            let difference = projectile - other - other * ratio;
            let slow = if speed == 0.0 { frame } else { difference.high() / total / fast };
            Product {
                circle: Circle { frame, own: speed, slow, fast },
                ahead: fast * fast,
                back: slow * slow,
            }
        };
        Encounter { projectile: product(third, fourth), target: product(fourth, third) }
    }
}

impl Product {
    /// Its velocities in the laboratory.
    pub fn circle(&self) -> Circle {
        self.circle
    }
    /// Its part of the beam energy, where it goes off by that half angle in the centre-of-mass frame.
    pub fn energy(&self, half: HalfAngle) -> f64 {
        let (square, complement) = half.squares();
        let size = square + complement;
        self.ahead * (complement / size) + self.back * (square / size)
    }
    /// Its part of the beam energy at a laboratory angle: of the faster branch, and of the slower where there is one.
    ///
    /// # Errors
    /// `InvalidInput` naming `lab_angle` beyond the greatest angle.
    pub fn energies(&self, lab_angle: f64) -> Result<[Option<f64>; 2]> {
        let greatest = self.circle.greatest_angle();
        if !(0.0..=greatest).contains(&lab_angle) {
            return Err(Error::invalid(
                "lab_angle",
                format!("expected angles in [0, {}], got {}", number(greatest), number(lab_angle)),
            ));
        }
        Ok(self.circle.squared_speeds(lab_angle).map(|part| part.map(|part| self.ahead * part)))
    }
}

impl Encounter {
    /// Without a Q-value, at any energy.
    pub fn elastic(collision: Collision) -> Self {
        Self {
            projectile: Product { circle: collision.circle(), ahead: 1.0, back: collision.kept_head_on() },
            target: Product {
                circle: collision.recoil_circle(),
                ahead: collision.greatest_transfer(),
                back: 0.0,
            },
        }
    }
    /// The projectile, or what it became; by the half angle of ψ.
    pub fn projectile(&self) -> &Product {
        &self.projectile
    }
    /// The target, or what it became; by the half angle of π - ψ ([`HalfAngle::mirrored`]).
    pub fn target(&self) -> &Product {
        &self.target
    }
    /// The angle between the two in the laboratory, θ₁ + θ₂ in [0, π].
    pub fn opening_angle(&self, half: HalfAngle) -> f64 {
        let (first, second) = (self.projectile.circle, self.target.circle);
        let (sine, cosine) = (half.sine, half.cosine);
        let across = 2.0 * (first.frame * second.own + first.own * second.frame);
        // v₃·v₄ at ψ = 0 and at ψ = π; between them it is linear in cos ψ. A factor that both components have is
        // left out: it may be 0.
        let (ahead, back) = (first.fast * second.slow, first.slow * second.fast);
        match (ahead == 0.0, back == 0.0) {
            (true, true) => FRAC_PI_2,
            (true, false) => atan2(across * cosine, back * sine),
            (false, true) => atan2(across * sine, ahead * cosine),
            (false, false) => atan2(across * (sine * cosine), ahead * cosine * cosine + back * sine * sine),
        }
    }
}

#[cfg(test)]
mod tests;
