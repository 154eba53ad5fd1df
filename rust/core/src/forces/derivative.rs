//! How forces change along a direction: `(∂a/∂q) δ + (∂a/∂v) δ'`, by formulas, for the motion of small differences.
//!
//! The one idea: a force that knows how it changes says so beside its kernel
//! ([`ForceTerm::derivative`](super::ForceTerm::derivative)), with the bits that each copy has alone, as that; the others are
//! compared with themselves at neighboring states.

use super::{Force, Phase};
use crate::error::Result;
use crate::numerics::element::Element;
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::parallel::Ticker;

/// A direction in the space of states.
#[derive(Clone, Copy, Debug)]
pub struct Along<'a, S> {
    /// Of coordinates.
    pub q: &'a [S],
    /// Of velocities; where no force looks at them they may not be there.
    pub v: &'a [S],
}

/// How the accelerations by a force change along directions.
pub trait Derivative<S: Element>: Send {
    /// Writes the change of its accelerations along a direction into `change`.
    ///
    /// # Errors
    /// As [`Force::apply`].
    fn apply(
        &mut self,
        phase: &Phase<'_, S>,
        along: Along<'_, S>,
        change: &mut [S],
        ticker: &mut Ticker<'_>,
    ) -> Result<()>;

    /// As [`Force::stops_midway`].
    fn stops_midway(&self) -> bool {
        false
    }
}

/// Of a force that is linear in coordinates and velocities but for a constant: what is linear in it, if anything is.
pub(super) struct OfLinear(Option<Box<dyn Force<Lanes>>>);

impl OfLinear {
    /// From the kernel of the same force without its constant.
    pub(super) fn boxed(linear: Option<Box<dyn Force<Lanes>>>) -> Option<Box<dyn Derivative<Lanes>>> {
        Some(Box::new(Self(linear)))
    }
}

impl Derivative<Lanes> for OfLinear {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        along: Along<'_, Lanes>,
        change: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Some(linear) = &mut self.0 else {
            change.fill(Lanes::zero());
            return Ok(());
        };
        linear.apply(&Phase { t: phase.t, q: along.q, v: along.v }, change, true, ticker)
    }
}

#[cfg(test)]
mod tests;
