//! Massless bodies on the steps of a few massive ones: these around their ring, those in rows.

use super::{RingPairs, RowPairs};
use crate::error::Result;
use crate::forces::series::Series;
use crate::numerics::element::Shape;
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;

/// The massive bodies pull each other with the bits that they have alone, and then whoever stands beside them.
pub(super) struct WithMassless {
    massive: RingPairs,
    massless: RowPairs,
}

impl WithMassless {
    /// From the `G·m` of the massive bodies, which come first; at most [`RING_MAX`](super::RING_MAX) of them.
    pub(super) fn new(shape: Shape, strength: Vec<f64>, softening: f64) -> Self {
        let massive = RingPairs::new(shape, &strength, softening);
        Self { massive, massless: RowPairs::beside(shape, strength, softening) }
    }
}

impl Series<Lanes> for WithMassless {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        if first {
            // The ring has but one row.
            a.fill(Lanes::zero());
        }
        self.massive.coefficient(n, jet, a, false, ticker)?;
        self.massless.coefficient(n, jet, a, false, ticker)
    }
}
