//! Monte Carlo of a beam on a Coulomb target.
//!
//! The one idea: an event is its impact parameter, b² uniform over a disc, and b is one Philox draw of
//! the event's index; counts are integers. So a histogram depends on the seed and on which events were
//! run, not on how they were divided, and ranges of events add.
//!
//! Nothing is computed that no tally needs: the azimuth is not drawn, and no angle is evaluated per
//! event (see [`histogram`](super::histogram)).
//!
//! What an event may use: of the numbers of [`philox`](crate::numerics::philox) draw 0 of stream 0, one per
//! event, is b² / b_max². Whatever else an event will need one day (azimuth, foil, detector) takes draws 1, 2, …
//! and leaves draw 0 as it is, so that counts that were published stay what they are.

use super::histogram::{BinCounts, Edges, Steps};
use super::kinematics::{Collision, HalfAngle};
use super::reach::Limits;
use super::rutherford::half_distance;
use crate::numerics::philox::{DRAW_BITS, DRAWS, Draw, fill_draws, key};
use crate::parallel::{Ticker, for_chunks};
use crate::words::{number, unknown};
use crate::{Error, Result};
use core::f64::consts::{FRAC_PI_2, PI};
use core::ops::Range;

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
    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, quantity)| *quantity == self).map_or("", |(name, _)| name)
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
    /// The numbers that edges of a quantity may be, and what they are called.
    pub(super) fn limits(&self, quantity: Quantity) -> Limits {
        match quantity {
            Quantity::CmAngle | Quantity::LabAngle => Limits::angles("π", PI),
            Quantity::RecoilAngle => Limits::angles("π/2", FRAC_PI_2),
            Quantity::Energy | Quantity::RecoilEnergy => Limits::upto("beam_energy", self.energy),
            // Beyond the disc no bin could count anything.
            Quantity::ImpactParameter => Limits::upto("b_max", self.b_max),
        }
    }
    /// Given edges of a quantity.
    ///
    /// # Errors
    /// `InvalidInput` naming the quantity, for what are no edges and for edges that it can never reach.
    pub fn edges(&self, quantity: Quantity, edges: Vec<f64>) -> Result<Edges> {
        let edges = Edges::new(quantity.name(), edges)?;
        self.limits(quantity).check(quantity.name(), edges.values())?;
        Ok(edges)
    }
    /// `bins` equal bins over all values a quantity can have.
    ///
    /// # Errors
    /// `InvalidInput` naming `bins`, or what makes the greatest value too small to divide.
    pub fn uniform_edges(&self, quantity: Quantity, bins: usize) -> Result<Edges> {
        let (blamed, high) = match quantity {
            Quantity::CmAngle | Quantity::LabAngle => ("bins", PI),
            Quantity::RecoilAngle => ("bins", FRAC_PI_2),
            Quantity::Energy => ("beam_energy", self.energy),
            Quantity::RecoilEnergy => {
                ("masses", self.energy * self.collision.transferred(HalfAngle::from_cotangent(0.0)))
            }
            Quantity::ImpactParameter => ("b_max", self.b_max),
        };
        if high / (bins as f64) < f64::MIN_POSITIVE {
            return Err(Error::invalid(
                blamed,
                format!(
                    "expected a greatest {} that can be divided into bins, got {}; choose larger units, or \
                     leave this tally out",
                    quantity.name(),
                    number(high)
                ),
            ));
        }
        Edges::uniform(bins, 0.0, high)
    }
    /// The deflection at the edge of the disc: no event is scattered by less.
    pub fn smallest_angle(&self) -> f64 {
        self.value(Quantity::CmAngle, 1.0)
    }
    /// The values of a quantity that no impact parameter beyond the disc leads to: what this beam counts there
    /// is all that there is.
    pub fn covered(&self, quantity: Quantity) -> (f64, f64) {
        let edge = self.value(quantity, 1.0);
        match quantity {
            Quantity::CmAngle => (edge, PI),
            // Of a heavy projectile the angle first grows with b: a disc that ends before its greatest covers nothing
            // below that.
            Quantity::LabAngle => {
                let greatest = self.collision.turning_point().filter(|turning| *turning > self.reach);
                let from = |t| self.collision.lab_angle(HalfAngle::from_cotangent(t));
                (greatest.map_or(edge, from), PI)
            }
            Quantity::RecoilAngle => (0.0, edge),
            Quantity::Energy => (0.0, edge),
            Quantity::RecoilEnergy => (edge, self.energy),
            Quantity::ImpactParameter => (0.0, self.b_max),
        }
    }
    /// Whether two impact parameters lead to one value: a heavy projectile's laboratory angle.
    pub fn two_branches(&self, quantity: Quantity) -> bool {
        quantity == Quantity::LabAngle && self.collision.turning_point().is_some()
    }
    /// The step function of the draw that a tally is.
    fn steps(&self, quantity: Quantity, edges: &Edges, ticker: &mut Ticker<'_>) -> Result<Steps> {
        let turning = (quantity == Quantity::LabAngle)
            .then(|| self.collision.turning_point())
            .flatten()
            .map(|t| (t / self.reach) * (t / self.reach))
            .filter(|share| *share < 1.0)
            .map(|share| (share * UNIT.recip()) as u64);
        Steps::new(edges, turning, |draw| self.value(quantity, draw as f64 * UNIT), ticker)
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
/// At most so many in a chunk, a fifth of a second: an interrupted run loses what other threads did beyond the
/// first chunk that is not whole.
const MOST_PER_CHUNK: u64 = 1 << 25;
/// Chunks per thread and round: enough to even out the end, few enough to be nothing in memory.
const CHUNKS_PER_THREAD: u64 = 32;

/// What was counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counted {
    /// How many events, from the first on and without a gap: all of them unless the run was cancelled.
    pub events: u64,
    /// One histogram per tally.
    pub counts: Vec<BinCounts>,
}

/// Runs the events `first_event..first_event + n_events` and gives one histogram per tally.
///
/// The counts are the same for any number of threads, on any machine; those of adjacent ranges add up
/// to those of the union. A cancelled run gives the events it counted, so that another may go on from there.
///
/// # Errors
/// `InvalidInput` if there is no event or the indices pass 2^63; `Interrupted` if nothing was counted yet.
pub fn monte_carlo(
    beam: &Beam,
    tallies: &[(Quantity, Edges)],
    seed: u64,
    first_event: u64,
    n_events: u64,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Counted> {
    if n_events == 0 {
        return Err(Error::invalid("n_events", "expected at least 1 event, got 0"));
    }
    let Some(end) = first_event.checked_add(n_events).filter(|end| *end <= 1 << 63) else {
        return Err(Error::invalid(
            "first_event",
            format!("expected first_event + n_events up to 2**63, got {first_event} + {n_events}"),
        ));
    };
    let steps: Vec<Steps> = tallies
        .iter()
        .map(|(quantity, edges)| beam.steps(*quantity, edges, ticker))
        .collect::<Result<_>>()?;
    let counts = tallies.iter().map(|(_, edges)| BinCounts::none(edges.bins())).collect();
    let mut counted = Counted { events: 0, counts };
    let most_per_round = MOST_PER_CHUNK * CHUNKS_PER_THREAD * threads as u64;
    let mut first = first_event;
    while first < end {
        let events = most_per_round.min(end - first);
        let chunks = events.div_ceil(EVENTS_PER_CHUNK).min(CHUNKS_PER_THREAD * threads as u64);
        let bound = |chunk: usize| first + (u128::from(events) * chunk as u128 / u128::from(chunks)) as u64;
        let parts = for_chunks(threads, chunks as usize, ticker, |chunk, ticker| {
            Ok(count_events(&steps, tallies, seed, bound(chunk)..bound(chunk + 1), ticker))
        })?;
        for (chunk, part) in parts.into_iter().enumerate() {
            for (sum, counts) in counted.counts.iter_mut().zip(&part.counts) {
                sum.add(counts);
            }
            counted.events += part.events;
            // Behind the first chunk that is not whole nothing is adjacent any more.
            if part.events < bound(chunk + 1) - bound(chunk) {
                return if counted.events == 0 { Err(Error::Interrupted) } else { Ok(counted) };
            }
        }
        first += events;
    }
    Ok(counted)
}

/// Counts events in their order until they end or the run is cancelled.
fn count_events(
    steps: &[Steps],
    tallies: &[(Quantity, Edges)],
    seed: u64,
    events: Range<u64>,
    ticker: &mut Ticker<'_>,
) -> Counted {
    if ticker.tick().is_err() {
        return Counted { events: 0, counts: Vec::new() };
    }
    let mut counters: Vec<_> = steps.iter().map(Steps::counters).collect();
    let mut event = events.start;
    while event < events.end && ticker.tick().is_ok() {
        let stop = events.end.min(event + EVENTS_PER_TICK);
        ticker.advance(stop - event);
        while event < stop {
            let mut draws = [[Draw::default(); DRAWS]; BATCH / DRAWS];
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
    let collected = |((_, edges), (steps, counters)): (&(_, Edges), (&Steps, &Vec<_>))| {
        steps.collect(edges.bins(), counters)
    };
    Counted {
        events: event - events.start,
        counts: tallies.iter().zip(steps.iter().zip(&counters)).map(collected).collect(),
    }
}

#[cfg(test)]
mod tests;
