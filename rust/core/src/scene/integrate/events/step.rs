//! A step in which events are looked for: from where to where it leads, and what may be asked about its inside.

use crate::error::Result;
use crate::numerics::lanes::Lanes;
use crate::ode::state::State;
use crate::parallel::Ticker;

/// A step of a unit, in the plan's units, and what may be asked about its inside.
pub(in crate::scene::integrate) trait Interpolant {
    /// The state at a fraction of the step.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn at(&mut self, theta: f64, ticker: &mut Ticker<'_>) -> Result<&State<Lanes>>;

    /// As [`at`](Self::at), for who looks at positions: velocities are about those.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn positions_at(&mut self, theta: f64, ticker: &mut Ticker<'_>) -> Result<&State<Lanes>> {
        self.at(theta, ticker)
    }

    /// How one coordinate moves in a lane: the terms of [`polynomial`](crate::ode::trial::Trial::polynomial). None are
    /// added by who has no polynomial.
    ///
    /// # Errors
    /// Those of an evaluation.
    fn polynomial(
        &mut self,
        coordinate: usize,
        lane: usize,
        into: &mut Vec<[f64; 2]>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()>;
}

/// From where to where a step leads, as elapsed time in the plan's units.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene::integrate) struct Span {
    pub(in crate::scene::integrate) from: f64,
    pub(in crate::scene::integrate) to: f64,
}

impl Span {
    pub(super) fn at(self, theta: f64) -> f64 {
        if theta == 1.0 { self.to } else { self.from + theta * (self.to - self.from) }
    }
}
