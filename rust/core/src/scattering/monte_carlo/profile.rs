//! How the projectiles of a beam differ: in energy, in direction, in place.

use super::draws::{AZIMUTH, Draws, ENERGY, ENERGY_PHASE, TILT};
use crate::numerics::angles::{cos, sin_cos};
use crate::numerics::elementary::{Exponential, ln};
use crate::words::{number, unknown};
use crate::{Error, Result};
use core::f64::consts::{FRAC_PI_2, TAU};

/// Gaussians end at so many standard deviations: beyond are 1.5e-8 of two dimensions.
const CUT: f64 = 6.0;
/// 1 − e^(−CUT²/2).
pub(super) const WITHIN: f64 = 0.999_999_984_770_020_2;
/// Spots between these parts of the disc's radius.
const SPOTS: [f64; 2] = [1e-6, 1e3];

/// A distribution about a middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// With a standard deviation, in each of two dimensions where there are two.
    Gaussian(f64),
    /// Within a half width, or a cone of that half angle.
    Uniform(f64),
}

/// How the projectiles of a beam differ; by default in nothing but that they fill the disc evenly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Profile {
    /// Of the energy.
    pub energy_spread: Option<Spread>,
    /// Of the direction.
    pub divergence: Option<Spread>,
    /// The standard deviation of the place, in each of two dimensions, about the center.
    pub spot: Option<f64>,
}

/// The direction in which a projectile comes, and the plane in which it is scattered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Direction {
    /// From the axis of the beam.
    pub(super) tilt: f64,
    /// Of the plane of scattering.
    pub(super) azimuth: f64,
}

impl Spread {
    /// By name.
    ///
    /// # Errors
    /// `InvalidInput` naming `argument`.
    pub fn named(argument: &str, name: &str, size: f64) -> Result<Self> {
        let positive = size > 0.0 && size.is_finite();
        match name {
            _ if !positive => {
                let size = number(size);
                Err(Error::invalid(argument, format!("expected a positive finite width, got {size}")))
            }
            "gaussian" => Ok(Self::Gaussian(size)),
            "uniform" => Ok(Self::Uniform(size)),
            _ => Err(unknown(argument, name, ["gaussian", "uniform"].into_iter())),
        }
    }
    /// As far as it goes.
    fn reach(self) -> f64 {
        match self {
            Self::Gaussian(sigma) => CUT * sigma,
            Self::Uniform(half_width) => half_width,
        }
    }
}

/// The distance from the middle of a Gaussian of two dimensions within which is that part, in standard deviations.
fn radius(part: f64) -> f64 {
    (-2.0 * ln(1.0 - part)).sqrt()
}

impl Profile {
    /// Refuses what a beam of that energy and radius cannot have.
    pub(super) fn check(&self, energy: f64, b_max: f64) -> Result<()> {
        if let Some(spread) = self.energy_spread
            && spread.reach() >= energy * (1.0 - f64::EPSILON)
        {
            let (reach, energy) = (number(spread.reach()), number(energy));
            return Err(Error::invalid(
                "energy_spread",
                format!(
                    "expected one that ends above 0, got one of {energy} less up to {reach} (a Gaussian ends at 6σ)"
                ),
            ));
        }
        if let Some(spread) = self.divergence
            && spread.reach() > FRAC_PI_2
        {
            let reach = number(spread.reach());
            return Err(Error::invalid(
                "divergence",
                format!(
                    "expected directions within π/2 of the axis, got some at {reach} (a Gaussian ends at 6σ); pass np.radians(…) of degrees"
                ),
            ));
        }
        if let Some(spot) = self.spot
            && !(spot >= SPOTS[0] * b_max && spot <= SPOTS[1] * b_max)
        {
            let (spot, b_max) = (number(spot), number(b_max));
            return Err(Error::invalid(
                "spot",
                format!(
                    "expected 1e-6 to 1000 of b_max = {b_max}, got {spot}; without a spot the disc is filled evenly"
                ),
            ));
        }
        Ok(())
    }
    /// Whether an event is more than its impact parameter and its component.
    pub(super) fn is_drawn(&self) -> bool {
        self.energy_spread.is_some() || self.divergence.is_some()
    }
    /// The least and the greatest energy.
    pub(super) fn energies(&self, middle: f64) -> [f64; 2] {
        let reach = self.energy_spread.map_or(0.0, Spread::reach);
        [middle - reach, middle + reach]
    }
    /// The energy of an event.
    pub(super) fn energy(&self, middle: f64, draws: Draws) -> f64 {
        match self.energy_spread {
            None => middle,
            Some(Spread::Gaussian(sigma)) => {
                middle
                    + sigma
                        * (radius(WITHIN * draws.uniform(ENERGY)) * cos(TAU * draws.uniform(ENERGY_PHASE)))
            }
            Some(Spread::Uniform(half_width)) => middle + half_width * (2.0 * draws.uniform(ENERGY) - 1.0),
        }
    }
    /// The direction of an event.
    pub(super) fn direction(&self, draws: Draws) -> Direction {
        let Some(spread) = self.divergence else { return Direction { tilt: 0.0, azimuth: 0.0 } };
        let part = draws.uniform(TILT);
        let tilt = match spread {
            Spread::Gaussian(sigma) => sigma * radius(WITHIN * part),
            // Evenly over the cone's solid angle, 4π sin²(half of the angle/2).
            Spread::Uniform(half_angle) => {
                let sine = part.sqrt() * sin_cos(0.5 * half_angle).0;
                2.0 * crate::numerics::angles::atan2(sine, (1.0 - sine * sine).sqrt())
            }
        };
        Direction { tilt, azimuth: TAU * draws.uniform(AZIMUTH) }
    }
    /// (b_max/σ)²/2 of a spot, and the part of it that the disc holds.
    fn within(&self, b_max: f64) -> Option<(f64, f64)> {
        let half = self.spot.map(|sigma| 0.5 * (b_max / sigma) * (b_max / sigma))?;
        Some((half, 1.0 - Exponential::exp(-half)))
    }
    /// b²/b_max² within which is that part of the projectiles.
    pub(super) fn share(&self, b_max: f64, part: f64) -> f64 {
        // Of the first draw 0, not −0, whose root would be an angle of −π head-on.
        self.within(b_max).map_or(part, |(half, whole)| (ln(1.0 - part * whole) / half).abs().min(1.0))
    }
    /// The part of the projectiles within that b²/b_max².
    pub(super) fn part(&self, b_max: f64, share: f64) -> f64 {
        self.within(b_max)
            .map_or(share, |(half, whole)| ((1.0 - Exponential::exp(-half * share)) / whole).min(1.0))
    }
}

impl Direction {
    /// The angle from the axis of what goes off at an angle from the direction: in the plane of scattering, or, as a
    /// recoil does, on the other side of it.
    pub(super) fn turned(self, angle: f64, recoil: bool) -> f64 {
        if self.tilt == 0.0 {
            return angle;
        }
        let ((across, along), (sine, cosine)) = (sin_cos(angle), sin_cos(self.tilt));
        let (aside, mut ahead) = sin_cos(self.azimuth);
        if recoil {
            ahead = -ahead;
        }
        let x = across * ahead * cosine + along * sine;
        let y = across * aside;
        crate::numerics::angles::atan2((x * x + y * y).sqrt(), along * cosine - across * ahead * sine)
    }
}

#[cfg(test)]
mod tests;
