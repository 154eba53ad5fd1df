//! Monte Carlo of a beam on one target.
//!
//! The one idea: an event is its impact parameter, b² uniform over a disc, and b is one Philox draw of
//! the event's index; counts are integers. So a histogram depends on the seed and on which events were
//! run, not on how they were divided, and ranges of events add. A beam of several energies is a mixture of beams,
//! and which one an event belongs to is its next draw.
//!
//! Nothing is computed that no tally needs: the azimuth is not drawn, and no angle is evaluated per
//! event (see [`histogram`](super::histogram)).
//!
//! What an event uses of the numbers of [`philox`](crate::numerics::philox), all in stream 0, one per event each:
//! - draw 0 is b² / b_max²;
//! - draw 1 is the component of the mixture, in the order given; a beam of one energy does not look at it.
//!
//! Whatever else an event will need one day (azimuth, foil, detector) takes draws 2, 3, … and leaves these as they are,
//! so that counts that were published stay what they are.

mod beam;
mod listed;
mod mixture;
mod quantity;

pub use beam::Beam;
pub use listed::{Event, events};
pub use mixture::{Mixture, Tally};
pub use quantity::Quantity;

use super::histogram::{Lookup, Steps};
use crate::numerics::philox::{DRAWS, Draw, fill_draws, key};
use crate::parallel::{Ticker, for_chunks};
use crate::{Error, Result};
use core::ops::Range;

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
    /// One histogram per tally: its slots, see [`Tally::slots`].
    pub counts: Vec<Vec<u64>>,
}

/// The index after the last of so many events.
///
/// # Errors
/// `InvalidInput` if there is no event or the indices pass 2^63.
fn end_of(first_event: u64, n_events: u64) -> Result<u64> {
    if n_events == 0 {
        return Err(Error::invalid("n_events", "expected at least 1 event, got 0"));
    }
    first_event.checked_add(n_events).filter(|end| *end <= 1 << 63).ok_or_else(|| {
        Error::invalid(
            "first_event",
            format!("expected first_event + n_events up to 2**63, got {first_event} + {n_events}"),
        )
    })
}

/// Runs the events `first_event..first_event + n_events` and gives one histogram per tally.
///
/// The counts are the same for any number of threads, on any machine; those of adjacent ranges add up
/// to those of the union. A cancelled run gives the events it counted, so that another may go on from there.
///
/// # Errors
/// `InvalidInput` if there is no event or the indices pass 2^63; `Interrupted` if nothing was counted yet.
pub fn monte_carlo(
    mixture: &Mixture,
    tallies: &[Tally],
    seed: u64,
    first_event: u64,
    n_events: u64,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Counted> {
    let end = end_of(first_event, n_events)?;
    let program = Program::new(mixture, tallies, threads, ticker)?;
    let counts = tallies.iter().map(|tally| vec![0; tally.slots()]).collect();
    let mut counted = Counted { events: 0, counts };
    let most_per_round = MOST_PER_CHUNK * CHUNKS_PER_THREAD * threads as u64;
    let mut first = first_event;
    while first < end {
        let events = most_per_round.min(end - first);
        let chunks = events.div_ceil(EVENTS_PER_CHUNK).min(CHUNKS_PER_THREAD * threads as u64);
        let bound = |chunk: usize| first + (u128::from(events) * chunk as u128 / u128::from(chunks)) as u64;
        let parts = for_chunks(threads, chunks as usize, ticker, |chunk, ticker| {
            Ok(program.count(seed, bound(chunk)..bound(chunk + 1), ticker))
        })?;
        for (chunk, (events, counters)) in parts.into_iter().enumerate() {
            program.collect(&counters, &mut counted.counts);
            counted.events += events;
            // Behind the first chunk that is not whole nothing is adjacent any more.
            if events < bound(chunk + 1) - bound(chunk) {
                return if counted.events == 0 { Err(Error::Interrupted) } else { Ok(counted) };
            }
        }
        first += events;
    }
    Ok(counted)
}

/// What part of all events falls into each slot of each tally, on the average: the area of the disc that leads there, of
/// the very function by which events are counted.
///
/// # Errors
/// `Interrupted`.
pub fn expected(
    mixture: &Mixture,
    tallies: &[Tally],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Vec<f64>>> {
    let program = Program::new(mixture, tallies, threads, ticker)?;
    let of_tally = |(tally, steps): (&Tally, &Vec<Steps>)| {
        let mut slots = vec![0.0; tally.slots()];
        steps.iter().zip(mixture.parts()).for_each(|(steps, part)| steps.collect_parts(part, &mut slots));
        slots
    };
    Ok(tallies.iter().zip(&program.steps).map(of_tally).collect())
}

/// Draws of a batch, sixteen events to each.
type Batch = [[Draw; DRAWS]; BATCH / DRAWS];

/// What counting looks up.
struct Program {
    /// Which component of the mixture a draw is, if there are several.
    component: Option<Lookup>,
    /// Of each tally, for each component.
    steps: Vec<Vec<Steps>>,
}

/// Of each tally, for each component.
type Counters = Vec<Vec<Vec<[u64; Steps::BANKS]>>>;

impl Program {
    fn new(mixture: &Mixture, tallies: &[Tally], threads: usize, ticker: &mut Ticker<'_>) -> Result<Self> {
        let beams: Vec<&Beam> = mixture.beams().collect();
        let steps = |tally: &Tally| {
            for_chunks(threads, beams.len(), ticker, |beam, ticker| tally.steps(beams[beam], ticker))
        };
        let steps = tallies.iter().map(steps).collect::<Result<_>>()?;
        Ok(Self { component: mixture.lookup(), steps })
    }
    /// Counts events in their order until they end or the run is cancelled.
    fn count(&self, seed: u64, events: Range<u64>, ticker: &mut Ticker<'_>) -> (u64, Counters) {
        if ticker.tick().is_err() {
            return (0, Vec::new());
        }
        let of_tally = |steps: &Vec<Steps>| steps.iter().map(Steps::counters).collect();
        let mut counters: Counters = self.steps.iter().map(of_tally).collect();
        let mut event = events.start;
        while event < events.end && ticker.tick().is_ok() {
            let stop = events.end.min(event + EVENTS_PER_TICK);
            ticker.control().count(stop - event);
            while event < stop {
                let mut draws: Batch = Default::default();
                fill_draws(key(seed), event >> 1, 0, &mut draws);
                // A block serves two events: an odd beginning leaves out its first.
                let skipped = (event & 1) as usize;
                let length = (stop - event).min((BATCH - skipped) as u64);
                let used = skipped..skipped + length as usize;
                let shares = &draws.as_flattened()[used.clone()];
                if let Some(component) = &self.component {
                    let mut draws: Batch = Default::default();
                    fill_draws(key(seed), event >> 1, 1, &mut draws);
                    let mut components = [0; BATCH];
                    component.find_all(&draws.as_flattened()[used], &mut components);
                    for (steps, counters) in self.steps.iter().zip(&mut counters) {
                        Steps::count_mixed(steps, &components, shares, counters);
                    }
                } else {
                    for (steps, counters) in self.steps.iter().flatten().zip(counters.iter_mut().flatten()) {
                        steps.count(shares, counters);
                    }
                }
                event += length;
            }
        }
        (event - events.start, counters)
    }
    /// Adds what was counted to the slots of each tally.
    fn collect(&self, counters: &Counters, counts: &mut [Vec<u64>]) {
        for ((steps, counters), counts) in self.steps.iter().zip(counters).zip(counts) {
            for (steps, counters) in steps.iter().zip(counters) {
                steps.collect(counters, counts);
            }
        }
    }
}

#[cfg(test)]
mod tests;
