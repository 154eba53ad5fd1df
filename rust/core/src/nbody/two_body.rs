//! Two bodies under mutual inverse-square attraction: centre of mass and relative Kepler motion.
//!
//! The one idea: R = (m₁r₁ + m₂r₂)/M moves on a straight line, r = r₁ − r₂ is Kepler's problem with μ = G M, and
//! r₁ = R + (m₂/M) r, r₂ = R − (m₁/M) r. R, the shares and these sums are carried in double-double, so that neither
//! a mass ratio nor a far-off centre of mass costs digits: what is left is the error of r, times each body's share.
//! Either mass may be zero (a test particle), not both.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. §3.1.

use super::kepler::KeplerOrbit;
use crate::error::{Error, Result};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, scale};
use crate::words::number;
use nalgebra::Vector3;

/// Position and velocity.
pub type State = (Vector3<f64>, Vector3<f64>);

/// Position and velocity before they are rounded.
pub type ExactState = ([DoubleDouble; 3], [DoubleDouble; 3]);

/// Two bodies, ready to be asked for their states at any time.
#[derive(Clone, Debug)]
pub struct TwoBody {
    initial: [State; 2],
    /// R and its velocity.
    centre: ExactState,
    /// m₂/M and −m₁/M.
    shares: [DoubleDouble; 2],
    relative: KeplerOrbit,
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
                return Err(Error::invalid(
                    "mass",
                    format!("expected a finite mass ≥ 0, got {}", number(mass)),
                ));
            }
        }
        if masses == [0.0, 0.0] {
            return Err(Error::invalid("mass", "expected at least one mass above 0, got 0.0 and 0.0"));
        }
        // In units of the greater mass, so that the sum cannot overflow.
        let unit = exponent(masses[0].max(masses[1]));
        let masses = masses.map(|mass| scale(mass, -unit));
        let total = DoubleDouble::sum(masses[0], masses[1]);
        let mu = scale((DoubleDouble::from(gravitational_constant) * total).to_f64(), unit);
        if !mu.is_finite() {
            return Err(Error::invalid(
                "G",
                format!(
                    "expected units in which G times the masses is within the range of float64, got G = {} and a mass \
                     of {}",
                    number(gravitational_constant),
                    number(scale(masses[0].max(masses[1]), unit))
                ),
            ));
        }
        let [(r1, v1), (r2, v2)] = states;
        let relative = KeplerOrbit::new(mu, r1 - r2, v1 - v2)?;
        let shares = [DoubleDouble::from(masses[1]) / total, -(DoubleDouble::from(masses[0]) / total)];
        // From the heavier body, so that a massless companion leaves its straight line exact.
        let heavier = usize::from(masses[1] > masses[0]);
        let share = shares[heavier];
        let centre = |values: [Vector3<f64>; 2]| {
            core::array::from_fn(|c| {
                let way = DoubleDouble::sum(values[0][c], -values[1][c]);
                DoubleDouble::from(values[heavier][c]) - share * way
            })
        };
        Ok(Self { initial: states, centre: (centre([r1, r2]), centre([v1, v2])), shares, relative })
    }

    /// The states of both bodies at the time `t` since the epoch; `t = 0` gives the input bits.
    pub fn states(&self, t: f64) -> [State; 2] {
        if t == 0.0 {
            return self.initial;
        }
        let rounded = |values: [DoubleDouble; 3]| Vector3::from(values.map(DoubleDouble::to_f64));
        self.unrounded(DoubleDouble::from(t))
            .map(|(position, velocity)| (rounded(position), rounded(velocity)))
    }

    /// The states of both bodies before rounding; `elapsed` is rounded only for the relative motion.
    pub fn unrounded(&self, elapsed: DoubleDouble) -> [ExactState; 2] {
        let (r, v) = self.relative.state(elapsed.to_f64());
        let (position, velocity) = &self.centre;
        self.shares.map(|share| {
            (
                core::array::from_fn(|c| {
                    (position[c] + velocity[c] * elapsed) + share * DoubleDouble::from(r[c])
                }),
                core::array::from_fn(|c| velocity[c] + share * DoubleDouble::from(v[c])),
            )
        })
    }

    /// The relative motion r₁ − r₂.
    pub fn relative(&self) -> &KeplerOrbit {
        &self.relative
    }
}
