//! Deflections of events that no table holds: of a spread of energies across which something orbits or is captured.
//!
//! The one idea: the bits of a deflection depend on nothing but its energy and impact parameter, so those of many events are
//! found side by side, and each is what it would be alone.

use crate::Result;
use crate::numerics::philox::{draw_of, key};
use crate::parallel::Ticker;
use crate::scattering::deflection::{Deflector, Status};
use std::sync::Arc;

use super::UNIT;

/// Places at which it is tried whether the potential tells what it is asked.
const TRIED: u64 = 768;

/// A deflector of a disc; equal to none but itself.
#[derive(Clone, Debug)]
pub(super) struct Direct {
    deflector: Arc<Deflector>,
    b_max: f64,
}

impl PartialEq for Direct {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.deflector, &other.deflector) && self.b_max == other.b_max
    }
}

impl Direct {
    /// Of energies of relative motion from the first to the second.
    ///
    /// # Errors
    /// As [`Deflector::deflect`], before there is an event.
    pub(super) fn new(
        deflector: Deflector,
        [low, high]: [f64; 2],
        b_max: f64,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let random = |i: u64, number| draw_of(key(0x6469_7265), i, number).number() as f64 * UNIT;
        let ends = [low, high].into_iter().flat_map(|energy| [(energy, 0.0), (energy, b_max)]);
        let inside = (0..TRIED)
            .map(|i| ((low + (high - low) * random(i, 0)).clamp(low, high), random(i, 1).sqrt() * b_max));
        let (energies, b): (Vec<f64>, Vec<f64>) = ends.chain(inside).unzip();
        let _ = deflector.deflect(&energies, &b, false, threads, ticker)?;
        Ok(Self { deflector: Arc::new(deflector), b_max })
    }

    /// ψ of energies of relative motion and parts of the disc's radius; nothing if captured.
    ///
    /// # Errors
    /// As [`Deflector::deflect`].
    pub(super) fn angles(
        &self,
        energies: &[f64],
        parts: impl Iterator<Item = f64>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Option<f64>>> {
        let b: Vec<f64> = parts.map(|part| part * self.b_max).collect();
        let found = self.deflector.deflect(energies, &b, false, 1, ticker)?;
        Ok(found.iter().map(|found| (found.status != Status::Captured).then_some(found.angle)).collect())
    }
}
