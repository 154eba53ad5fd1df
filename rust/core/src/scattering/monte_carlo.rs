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
//! An event of a beam whose projectiles differ in energy or direction is no function of one draw: it is followed by
//! itself, with the draws after these. Which draw is for what is written in `draws.rs`.

mod abreast;
mod beam;
mod channels;
mod draws;
mod listed;
mod mixture;
mod probability;
mod profile;
mod quantity;
mod strata;

pub use beam::Beam;
pub use channels::{Channel, Channels};
pub use listed::{Event, events};
pub use mixture::{Mixture, Tally};
pub use probability::{Factor, Probability};
pub use profile::{Profile, Spread};
pub use quantity::Quantity;
pub use strata::Strata;

use super::histogram::{Lookup, Steps};
use crate::numerics::philox::{DRAWS, Draw, fill_draws, key};
use crate::parallel::{Ticker, for_chunks};
use crate::{Error, Result};
use abreast::Abreast;
use core::ops::Range;
use draws::{CHANNEL, COMPONENT, Draws, PLACE};
use mixture::count_one;

/// Events drawn at a time: their draws stay in the first-level cache.
const BATCH: usize = 512;
/// Events between two looks at the ticker, about a tenth of a millisecond.
const EVENTS_PER_TICK: u64 = 1 << 16;
/// Events worth handing to another thread.
const EVENTS_PER_CHUNK: u64 = 1 << 19;
/// The same of events whose deflections are found one by one.
const DIRECT_PER_CHUNK: u64 = 1 << 13;
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
    /// One histogram per tally: its slots, see [`Tally::slots`]; of a mixture with strata one for each of them, one after
    /// the other.
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

/// Refuses more histograms than memory is meant for.
fn check_size(mixture: &Mixture, tallies: &[Tally]) -> Result<()> {
    let strata = mixture.histograms();
    match tallies.iter().map(Tally::slots).max() {
        Some(slots) if strata > 1 && slots.saturating_mul(strata) > MOST_SLOTS => Err(Error::invalid(
            "importance",
            format!(
                "expected at most 2**24 bins of all strata together, got {strata} strata of {slots} bins"
            ),
        )),
        _ => Ok(()),
    }
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
    check_size(mixture, tallies)?;
    let program = Program::new(mixture, tallies, threads, ticker)?;
    let counts = tallies.iter().map(|tally| vec![0; tally.slots() * mixture.histograms()]).collect();
    let mut counted = Counted { events: 0, counts };
    let most_per_round = MOST_PER_CHUNK * CHUNKS_PER_THREAD * threads as u64;
    let mut first = first_event;
    while first < end {
        let events = most_per_round.min(end - first);
        let per_chunk = if mixture.is_direct() { DIRECT_PER_CHUNK } else { EVENTS_PER_CHUNK };
        let chunks = events.div_ceil(per_chunk).min(CHUNKS_PER_THREAD * threads as u64);
        let bound = |chunk: usize| first + (u128::from(events) * chunk as u128 / u128::from(chunks)) as u64;
        let parts = for_chunks(threads, chunks as usize, ticker, |chunk, ticker| {
            program.count(seed, bound(chunk)..bound(chunk + 1), ticker)
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
/// `InvalidInput` naming the spread or divergence for a quantity that is no function of one draw; `Interrupted`.
pub fn expected(
    mixture: &Mixture,
    tallies: &[Tally],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Vec<f64>>> {
    for (quantity, beam) in tallies
        .iter()
        .flat_map(Tally::axes)
        .flat_map(|(quantity, _)| mixture.beams().map(move |beam| (*quantity, beam)))
    {
        if !beam.is_of_one_draw(quantity) {
            let (blamed, expected) = match &beam.profile {
                profile if profile.energy_spread.is_some() => ("energy_spread", "none"),
                profile if profile.divergence.is_some() && quantity.is_of_directions() => {
                    ("divergence", "none")
                }
                _ => ("channels", "probabilities that do not hang on the impact parameter"),
            };
            let name = quantity.name();
            return Err(Error::invalid(
                blamed,
                format!(
                    "expected {expected} where the mean counts of {name} are asked for: the area of impact parameters does not tell them"
                ),
            ));
        }
    }
    check_size(mixture, tallies)?;
    let differ = differ(tallies);
    let steps = steps(mixture, tallies, (differ, false), threads, ticker)?;
    let of_beam = |(line, beam): (f64, &Beam)| -> Vec<f64> {
        if differ { beam.channels().parts().map(|exit| line * exit).collect() } else { vec![line] }
    };
    let parts: Vec<f64> = mixture.parts().zip(mixture.beams()).flat_map(of_beam).collect();
    let weights = mixture.strata().map_or_else(|| vec![1.0], Strata::weights);
    let of_tally = |(tally, steps): (&Tally, &Vec<Steps>)| {
        let mut drawn = vec![0.0; tally.slots() * weights.len()];
        steps.iter().zip(&parts).for_each(|(steps, part)| steps.collect_parts(*part, &mut drawn));
        let mut slots = vec![0.0; tally.slots()];
        for (histogram, weight) in drawn.chunks(tally.slots()).zip(&weights) {
            slots.iter_mut().zip(histogram).for_each(|(slot, part)| *slot += weight * part);
        }
        slots
    };
    Ok(tallies.iter().zip(&steps).map(of_tally).collect())
}

/// Bins of a tally in all strata, at most.
const MOST_SLOTS: usize = 1 << 24;

/// Draws of a batch, sixteen events to each.
type Batch = [[Draw; DRAWS]; BATCH / DRAWS];

/// How events are counted.
enum Program<'a> {
    /// By looking up their draws.
    Steps(Stepped),
    /// One by one, or eight side by side where that is faster.
    Drawn(&'a Mixture, &'a [Tally], Option<Abreast<'a>>),
    /// One by one, with the deflections of a batch together.
    Direct(&'a Mixture, &'a [Tally]),
}

/// Events as step functions of their draws.
struct Stepped {
    /// Which component of the mixture one is, if there are several.
    component: Option<Lookup>,
    /// Through which channel it goes, if that matters.
    channel: Option<Lookup>,
    /// How many channels there are of each component.
    channels: usize,
    /// Of each tally, for each component and each channel of it.
    steps: Vec<Vec<Steps>>,
}

/// Of each tally, for each component and channel; of events that are counted one by one for all of them together.
type Counters = Vec<Vec<Vec<u64>>>;

/// Whether anything is counted in which channels differ: if not, nobody looks at which one an event goes through.
fn differ(tallies: &[Tally]) -> bool {
    tallies.iter().flat_map(Tally::axes).any(|(quantity, _)| quantity.is_of_channel())
}

/// Of each tally, for each component and each channel of it, or all channels as one where they do not differ; looked at
/// alone, or by turns.
fn steps(
    mixture: &Mixture,
    tallies: &[Tally],
    (differ, alone): (bool, bool),
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Vec<Steps>>> {
    let exits = |beam: &Beam| if differ { beam.channels().count() } else { 1 };
    let of: Vec<(&Beam, usize)> =
        mixture.beams().flat_map(|beam| (0..exits(beam)).map(move |exit| (beam, exit))).collect();
    let of_tally = |tally: &Tally| {
        for_chunks(threads, of.len(), ticker, |index, ticker| tally.steps(of[index], alone, ticker))
    };
    tallies.iter().map(of_tally).collect()
}

impl<'a> Program<'a> {
    fn new(
        mixture: &'a Mixture,
        tallies: &'a [Tally],
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let differ = differ(tallies);
        let told = mixture.channels();
        if mixture.is_drawn() || (differ && told.is_none()) {
            if mixture.is_direct() {
                return Ok(Self::Direct(mixture, tallies));
            }
            return Ok(Self::Drawn(mixture, tallies, Abreast::of(mixture, tallies)));
        }
        let (channel, channels) =
            told.filter(|_| differ).map_or((None, 1), |channels| (channels.lookup(), channels.count()));
        let component = mixture.lookup();
        let alone = component.is_none() && channel.is_none();
        let steps = steps(mixture, tallies, (differ, alone), threads, ticker)?;
        Ok(Self::Steps(Stepped { component, channel, channels, steps }))
    }
    fn counters(&self) -> Counters {
        match self {
            Self::Steps(Stepped { steps, .. }) => {
                steps.iter().map(|steps| steps.iter().map(Steps::counters).collect()).collect()
            }
            Self::Drawn(mixture, tallies, _) | Self::Direct(mixture, tallies) => {
                let strata = mixture.histograms();
                tallies.iter().map(|tally| vec![vec![0; tally.slots() * strata]]).collect()
            }
        }
    }
    /// Counts events in their order until they end or the run is cancelled.
    ///
    /// # Errors
    /// As [`Mixture::met`], but for `Interrupted`.
    fn count(&self, seed: u64, events: Range<u64>, ticker: &mut Ticker<'_>) -> Result<(u64, Counters)> {
        if ticker.tick().is_err() {
            return Ok((0, Vec::new()));
        }
        let most = if matches!(self, Self::Direct(..)) { BATCH as u64 } else { EVENTS_PER_TICK };
        let mut counters = self.counters();
        let mut event = events.start;
        while event < events.end && ticker.tick().is_ok() {
            let stop = events.end.min(event + most);
            match self {
                Self::Steps(stepped) => stepped.look_up(seed, event..stop, &mut counters),
                Self::Drawn(mixture, tallies, abreast) => {
                    let alone =
                        |event: u64, counters: &mut [_]| follow(mixture, tallies, (seed, event), counters);
                    match abreast {
                        Some(abreast) => abreast.count(key(seed), event..stop, &mut counters, alone),
                        None => (event..stop).for_each(|event| alone(event, &mut counters)),
                    }
                }
                Self::Direct(mixture, tallies) => match mixture.met(seed, event..stop, ticker) {
                    Ok(met) => {
                        met.iter().for_each(|met| {
                            count_one(tallies, (met.beam, &met.arrival, met.half()), &mut counters);
                        });
                    }
                    Err(Error::Interrupted) => break,
                    Err(error) => return Err(error),
                },
            }
            ticker.control().count(stop - event);
            event = stop;
        }
        Ok((event - events.start, counters))
    }
    /// Adds what was counted to the slots of each tally.
    fn collect(&self, counters: &Counters, counts: &mut [Vec<u64>]) {
        match self {
            Self::Steps(Stepped { steps, .. }) => {
                for ((steps, counters), counts) in steps.iter().zip(counters).zip(counts) {
                    for (steps, counters) in steps.iter().zip(counters) {
                        steps.collect(counters, counts);
                    }
                }
            }
            Self::Drawn(..) | Self::Direct(..) => {
                for (counters, counts) in counters.iter().zip(counts) {
                    for (counter, count) in counters.iter().flatten().zip(counts) {
                        *count += counter;
                    }
                }
            }
        }
    }
}

impl Stepped {
    /// Counts events by the step functions of their draws.
    fn look_up(&self, seed: u64, events: Range<u64>, counters: &mut Counters) {
        let (mut event, stop) = (events.start, events.end);
        while event < stop {
            let mut draws: Batch = Default::default();
            fill_draws(key(seed), event >> 1, PLACE, &mut draws);
            // A block serves two events: an odd beginning leaves out its first.
            let skipped = (event & 1) as usize;
            let length = (stop - event).min((BATCH - skipped) as u64);
            let used = skipped..skipped + length as usize;
            let shares = &draws.as_flattened()[used.clone()];
            if self.component.is_some() || self.channel.is_some() {
                let mut which = [0; BATCH];
                for (lookup, number, times) in
                    [(&self.component, COMPONENT, self.channels as u32), (&self.channel, CHANNEL, 1)]
                {
                    let Some(lookup) = lookup else { continue };
                    let mut draws: Batch = Default::default();
                    fill_draws(key(seed), event >> 1, number, &mut draws);
                    let mut found = [0; BATCH];
                    lookup.find_all(&draws.as_flattened()[used.clone()], &mut found);
                    which.iter_mut().zip(found).for_each(|(which, found)| *which += times * found);
                }
                for (steps, counters) in self.steps.iter().zip(counters.iter_mut()) {
                    Steps::count_mixed(steps, &which, shares, counters);
                }
            } else {
                for (steps, counters) in self.steps.iter().flatten().zip(counters.iter_mut().flatten()) {
                    steps.count(shares, counters);
                }
            }
            event += length;
        }
    }
}

/// Counts an event by itself.
fn follow(mixture: &Mixture, tallies: &[Tally], (seed, event): (u64, u64), counters: &mut [Vec<Vec<u64>>]) {
    let draws = Draws::new(seed, event);
    let Some((_, beam)) = mixture.component(draws.bits(COMPONENT)) else { return };
    let arrival = beam.arrival(draws);
    count_one(tallies, (beam, &arrival, beam.half_angle(&arrival)), counters);
}

#[cfg(test)]
mod tests;
