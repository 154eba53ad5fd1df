//! Monte Carlo of a beam on a Coulomb target.
//!
//! The one idea: an event is its impact parameter, b² uniform over a disc, and b is one Philox draw of
//! the event's index; counts are integers. So a histogram depends on the seed and on which events were
//! run, not on how they were divided, and ranges of events add.
//!
//! Nothing is computed that no tally needs: the azimuth is not drawn, and no angle is evaluated per
//! event (see [`histogram`](super::histogram)).

use super::histogram::{Counts, Edges, Steps};
use super::kinematics::{Collision, HalfAngle};
use super::rutherford::half_distance;
use crate::numerics::philox::{DRAW_BITS, DRAWS, fill_draws, key};
use crate::parallel::{Ticker, for_chunks};
use crate::words::{number, unknown};
use crate::{Error, Result};
use core::f64::consts::{FRAC_PI_2, PI};

/// What is tallied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The scattering angle in the centre-of-mass frame, |ψ| in [0, π].
    CmAngle,
    /// The laboratory angle of the projectile, in [0, π].
    LabAngle,
    /// The laboratory angle of the target, in [0, π/2].
    RecoilAngle,
    /// The energy of the projectile afterwards.
    Energy,
    /// The energy of the target afterwards.
    RecoilEnergy,
    /// The impact parameter.
    ImpactParameter,
}

impl Quantity {
    /// All of them, with their names.
    pub const ALL: [(&'static str, Self); 6] = [
        ("cm_angle", Self::CmAngle),
        ("lab_angle", Self::LabAngle),
        ("recoil_angle", Self::RecoilAngle),
        ("energy", Self::Energy),
        ("recoil_energy", Self::RecoilEnergy),
        ("impact_parameter", Self::ImpactParameter),
    ];
    /// By name.
    ///
    /// # Errors
    /// `InvalidInput` naming `tally`.
    pub fn named(name: &str) -> Result<Self> {
        Self::ALL
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, quantity)| *quantity)
            .ok_or_else(|| unknown("tally", name, Self::ALL.iter().map(|(known, _)| *known)))
    }
}

/// A parallel beam on a disc around a Coulomb centre that is free to recoil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    collision: Collision,
    energy: f64,
    b_max: f64,
    /// b_max/|κ|: the largest t.
    reach: f64,
}

impl Beam {
    /// V = k/r; `energy` is the projectile's in the laboratory, `masses` projectile and target.
    ///
    /// # Errors
    /// `InvalidInput` naming what is not positive and finite, or `b_max` if the distance k/2E is not
    /// within 150 decades of it.
    pub fn new(k: f64, energy: f64, masses: (f64, f64), b_max: f64) -> Result<Self> {
        if !(k.is_finite() && k != 0.0) {
            return Err(Error::invalid(
                "potential",
                format!("expected a finite k other than 0, got k = {}", number(k)),
            ));
        }
        for (name, value) in [("beam_energy", energy), ("b_max", b_max)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::invalid(
                    name,
                    format!("expected a positive finite number, got {}", number(value)),
                ));
            }
        }
        let collision = Collision::new(masses.0, masses.1)?;
        let half_distance = half_distance(k, energy * collision.relative_share()).abs();
        let reach = b_max / half_distance;
        if !(1e-150..=1e150).contains(&reach) {
            return Err(Error::invalid(
                "b_max",
                format!(
                    "expected a length within 150 decades of |k|/(2 E) = {}, E the energy of \
                     relative motion, got {}",
                    number(half_distance),
                    number(b_max)
                ),
            ));
        }
        Ok(Self { collision, energy, b_max, reach })
    }
    /// The value of a quantity when b² is the fraction `share` of b_max².
    pub fn value(&self, quantity: Quantity, share: f64) -> f64 {
        let root = share.sqrt();
        let half = HalfAngle::from_cotangent(self.reach * root);
        match quantity {
            Quantity::CmAngle => half.cm_angle(),
            Quantity::LabAngle => self.collision.lab_angle(half),
            Quantity::RecoilAngle => half.recoil_angle(),
            Quantity::Energy => self.energy * self.collision.kept(half),
            Quantity::RecoilEnergy => self.energy * self.collision.transferred(half),
            Quantity::ImpactParameter => self.b_max * root,
        }
    }
    /// `bins` equal bins over all values a quantity can have.
    ///
    /// # Errors
    /// `InvalidInput` naming `bins`.
    pub fn uniform_edges(&self, quantity: Quantity, bins: usize) -> Result<Edges> {
        let high = match quantity {
            Quantity::CmAngle | Quantity::LabAngle => PI,
            Quantity::RecoilAngle => FRAC_PI_2,
            Quantity::Energy => self.energy,
            Quantity::RecoilEnergy => {
                self.energy * self.collision.transferred(HalfAngle::from_cotangent(0.0))
            }
            Quantity::ImpactParameter => self.b_max,
        };
        Edges::uniform(bins, 0.0, high)
    }
    /// The step function of the draw that a tally is.
    fn steps(&self, quantity: Quantity, edges: &Edges) -> Steps {
        let turning = (quantity == Quantity::LabAngle)
            .then(|| self.collision.turning_point())
            .flatten()
            .map(|t| (t / self.reach) * (t / self.reach))
            .filter(|share| *share < 1.0)
            .map(|share| (share * UNIT.recip()) as u64);
        Steps::new(edges, turning, |draw| self.value(quantity, draw as f64 * UNIT))
    }
}

/// A draw as a fraction: 2^-53.
const UNIT: f64 = 1.0 / (1_u64 << DRAW_BITS) as f64;

/// Events drawn at a time: their draws stay in the first-level cache.
const BATCH: usize = 512;
/// Events between two looks at the ticker, about a tenth of a millisecond.
const EVENTS_PER_TICK: u64 = 1 << 16;
/// Events worth handing to another thread.
const EVENTS_PER_CHUNK: u64 = 1 << 19;
/// Chunks per thread: enough to even out the end, few enough to be nothing in memory.
const CHUNKS_PER_THREAD: u64 = 32;

/// Runs the events `first_event..first_event + n_events` and gives one histogram per tally.
///
/// The counts are the same for any number of threads, on any machine; those of adjacent ranges add up
/// to those of the union.
///
/// # Errors
/// `InvalidInput` if there is no event or the indices pass 2^63; `Interrupted`.
pub fn monte_carlo(
    beam: &Beam,
    tallies: &[(Quantity, Edges)],
    seed: u64,
    first_event: u64,
    n_events: u64,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Counts>> {
    if n_events == 0 {
        return Err(Error::invalid("n_events", "expected at least 1 event, got 0"));
    }
    if first_event.checked_add(n_events).is_none_or(|end| end > 1 << 63) {
        return Err(Error::invalid(
            "first_event",
            format!("expected first_event + n_events up to 2**63, got {first_event} + {n_events}"),
        ));
    }
    let steps: Vec<Steps> = tallies.iter().map(|(quantity, edges)| beam.steps(*quantity, edges)).collect();
    let chunks = n_events.div_ceil(EVENTS_PER_CHUNK).min(CHUNKS_PER_THREAD * threads as u64);
    let bound =
        |chunk: u64| first_event + (u128::from(n_events) * u128::from(chunk) / u128::from(chunks)) as u64;
    let results = for_chunks(threads, chunks as usize, ticker, |chunk, ticker| {
        let mut counters: Vec<_> = steps.iter().map(Steps::counters).collect();
        let (mut event, end) = (bound(chunk as u64), bound(chunk as u64 + 1));
        while event < end {
            ticker.tick()?;
            let stop = end.min(event + EVENTS_PER_TICK);
            ticker.advance(stop - event);
            while event < stop {
                let mut draws = [[0; DRAWS]; BATCH / DRAWS];
                fill_draws(key(seed), event >> 1, &mut draws);
                // A block serves two events: an odd beginning leaves out its first.
                let skipped = (event & 1) as usize;
                let length = (stop - event).min((BATCH - skipped) as u64);
                let used = &draws.as_flattened()[skipped..skipped + length as usize];
                for (steps, counters) in steps.iter().zip(&mut counters) {
                    steps.count(used, counters);
                }
                event += length;
            }
        }
        Ok(counters)
    })?;
    let collect = |(index, steps): (usize, &Steps)| {
        steps.collect(tallies[index].1.bins(), results.iter().map(|counters| counters[index].as_slice()))
    };
    Ok(steps.iter().enumerate().map(collect).collect())
}

#[cfg(test)]
mod tests;
