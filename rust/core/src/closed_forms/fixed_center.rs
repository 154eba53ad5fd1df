//! The potential energy k/r of a fixed center, which nothing else acts beside.

use super::parabola::Parabola;
use super::{ClosedForm, ExactState, Path, Paths, sum};
use crate::error::{Error, Result};
use crate::nbody::kepler::KeplerOrbit;
use crate::numerics::double_double::DoubleDouble;
use nalgebra::Vector3;

/// Kepler orbits about a point.
pub static FORM: ClosedForm = ClosedForm {
    name: "Kepler orbits",
    reason: "the only force is an inverse-distance center",
    applies: |member| {
        // Beyond the range of numbers k/m has lost digits, or all of them; the units of an integration have it.
        let has_digits = |k: f64| k == 0.0 || member.mass.iter().all(|mass| (k / mass).is_normal());
        matches!(&member.forces[..], [force] if force.as_inverse_distance_center().is_some_and(|(k, _)| has_digits(k)))
    },
    motion: |member, _, ticker| {
        let center = member.forces.iter().find_map(|force| force.as_inverse_distance_center());
        let Some((k, center)) = center else {
            return Err(Error::Internal("a center that is none".to_owned()));
        };
        Paths::motion(member, ticker, |i| {
            Orbit::new(-k / member.mass[i], (center, [0.0; 3]), (member.position[i], member.velocity[i]))
        })
    },
};

/// A Kepler orbit about a point that moves uniformly.
pub(super) struct Orbit {
    orbit: KeplerOrbit,
    center: Parabola,
}

impl Orbit {
    /// From the gravitational parameter and the states of the center and the particle.
    pub(super) fn new(mu: f64, center: ([f64; 3], [f64; 3]), particle: ([f64; 3], [f64; 3])) -> Result<Self> {
        let difference = |a: [f64; 3], b: [f64; 3]| Vector3::from_fn(|c, _| b[c] - a[c]);
        let orbit = KeplerOrbit::new(mu, difference(center.0, particle.0), difference(center.1, particle.1))?;
        Ok(Self { orbit, center: Parabola::line(center.0, center.1) })
    }
}

impl Path for Orbit {
    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        let (position, velocity) = self.center.state(elapsed);
        let (relative, rate) = self.orbit.state(elapsed.to_f64());
        (
            core::array::from_fn(|c| sum(position[c], relative[c])),
            core::array::from_fn(|c| sum(velocity[c], rate[c])),
        )
    }
}
