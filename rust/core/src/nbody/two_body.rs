//! Two bodies under mutual inverse-square attraction: centre of mass and relative Kepler motion.
//!
//! The one idea: R = (m₁r₁ + m₂r₂)/M moves on a straight line, r = r₁ − r₂ is Kepler's problem with μ = G M, and
//! r₁ = R + (m₂/M) r, r₂ = R − (m₁/M) r. Either mass may be zero (a test particle), not both.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. §3.1.

use super::kepler::KeplerOrbit;
use crate::error::{Error, Result};
use nalgebra::Vector3;

/// Position and velocity.
pub type State = (Vector3<f64>, Vector3<f64>);

/// Two bodies, ready to be asked for their states at any time.
#[derive(Clone, Debug)]
pub struct TwoBody {
    initial: [State; 2],
    centre: CentreOfMass,
    /// m₂/M and m₁/M.
    shares: [f64; 2],
    relative: KeplerOrbit,
}

/// The straight line of the centre of mass.
#[derive(Clone, Debug)]
struct CentreOfMass {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
}

impl TwoBody {
    /// From Newton's constant, two masses and two states at the epoch.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for negative, infinite or two zero masses, for numbers that are not finite, and for
    /// two bodies at one place.
    pub fn new(gravitational_constant: f64, masses: [f64; 2], states: [State; 2]) -> Result<Self> {
        for mass in masses {
            if !(mass.is_finite() && mass >= 0.0) {
                return Err(Error::invalid("mass", format!("expected a finite mass ≥ 0, got {mass}")));
            }
        }
        let total = masses[0] + masses[1];
        if total == 0.0 {
            return Err(Error::invalid("mass", "expected at least one mass above 0, got 0 and 0"));
        }
        let [(r1, v1), (r2, v2)] = states;
        let relative = KeplerOrbit::new(gravitational_constant * total, r1 - r2, v1 - v2)?;
        let shares = [masses[1] / total, masses[0] / total];
        // From the heavier body, so that a massless companion leaves its straight line exact.
        let weighted = |a: Vector3<f64>, b: Vector3<f64>| {
            if masses[0] >= masses[1] { a + (b - a) * shares[0] } else { b + (a - b) * shares[1] }
        };
        let centre = CentreOfMass { position: weighted(r1, r2), velocity: weighted(v1, v2) };
        Ok(Self { initial: states, centre, shares, relative })
    }

    /// The states of both bodies at the time `t` since the epoch; `t = 0` gives the input bits.
    pub fn states(&self, t: f64) -> [State; 2] {
        if t == 0.0 {
            return self.initial;
        }
        let (r, v) = self.relative.state(t);
        let position = self.centre.position + self.centre.velocity * t;
        let velocity = self.centre.velocity;
        [
            (position + r * self.shares[0], velocity + v * self.shares[0]),
            (position - r * self.shares[1], velocity - v * self.shares[1]),
        ]
    }

    /// The relative motion r₁ − r₂.
    pub fn relative(&self) -> &KeplerOrbit {
        &self.relative
    }
}
