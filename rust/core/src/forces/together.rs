//! What all forces of a scene do together: what they leave constant, and the energies that they add up to.

use super::bodies::PreciseBodies;
use super::term::{About, Bodies, Conserves, ForceTerm};
use crate::error::Result;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use std::sync::Arc;

/// What all the forces together leave constant of these bodies.
pub fn conserved_by(terms: &[Arc<dyn ForceTerm>], bodies: &Bodies<'_>) -> Conserves {
    let mut all = Conserves::EVERYTHING;
    for term in terms.iter().filter(|term| term.acts(bodies)) {
        let own = term.conserves();
        all.momentum &= own.momentum;
        all.spin &= own.spin;
        all.energy &= own.energy;
        all.angular_momentum = match (all.angular_momentum, own.angular_momentum) {
            (About::Everywhere, other) | (other, About::Everywhere) => other,
            (About::Point(a), About::Point(b)) if a == b => About::Point(a),
            _ => About::Nowhere,
        };
    }
    all
}

/// What becomes of the energy of bodies by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Energy {
    /// It is constant.
    Constant,
    /// It never grows.
    NeverGrows,
    /// It changes by what drives do, which is bounded.
    Driven,
    /// Forces give and take.
    Unknown,
}

impl Energy {
    /// Of these bodies under all the forces together.
    pub fn under(terms: &[Arc<dyn ForceTerm>], bodies: &Bodies<'_>) -> Self {
        let acting = || terms.iter().filter(|term| term.acts(bodies));
        if conserved_by(terms, bodies).energy {
            Self::Constant
        } else if acting().all(|term| term.never_gives_energy()) {
            Self::NeverGrows
        } else if acting().all(|term| term.conserves().energy || term.as_driven().is_some()) {
            Self::Driven
        } else {
            Self::Unknown
        }
    }
}

/// Potential energy and Σ r·F of all the forces.
///
/// # Errors
/// [`Error::Interrupted`].
pub fn potential_and_virial(
    terms: &[Arc<dyn ForceTerm>],
    bodies: &PreciseBodies,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<(Scaled, Scaled)> {
    let (mut potential, mut virial) = (Scaled::ZERO, Scaled::ZERO);
    for term in terms {
        let (energy, work) = term.potential_and_virial(bodies, threads, ticker)?;
        (potential, virial) = (potential.plus(energy), virial.plus(work));
    }
    Ok((potential, virial))
}
