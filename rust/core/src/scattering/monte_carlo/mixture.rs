//! Beams of several energies side by side, and what is counted of their events.

use super::beam::{Arrival, Beam, UNIT};
use super::channels::{Channel, Channels};
use super::draws::{COMPONENT, Draws};
use super::profile::Profile;
use super::quantity::Quantity;
use super::strata::Strata;
use crate::numerics::philox::DRAW_BITS;
use crate::parallel::{Ticker, for_chunks};
use crate::potentials::Potential;
use crate::scattering::bins::Bins;
use crate::scattering::histogram::{Edges, Lookup, Seen, Stepping, Steps};
use crate::scattering::kinematics::HalfAngle;
use crate::words::number;
use crate::{Error, Result};
use core::ops::Range;
use std::sync::Arc;

/// Beams, each with its part of the events.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    /// Each with the first draw that is its own.
    components: Vec<(u64, Beam)>,
}

impl Mixture {
    /// All events of one beam.
    pub fn of(beam: Beam) -> Self {
        Self { components: vec![(0, beam)] }
    }
    /// Beams in parts as their weights: draws are divided at the rounded running sums of the weights.
    ///
    /// # Errors
    /// `InvalidInput` naming `weights` that are not positive or add up to nothing that is a number, or of which one is so
    /// small a part that no draw is its own.
    pub fn new(beams: Vec<Beam>, weights: &[f64]) -> Result<Self> {
        let total: f64 = weights.iter().sum();
        if beams.is_empty() || beams.len() != weights.len() || !total.is_finite() {
            return Err(Error::invalid("weights", "expected a finite weight for each energy"));
        }
        let (mut sum, mut components) = (0.0, Vec::with_capacity(beams.len()));
        for (beam, weight) in beams.into_iter().zip(weights) {
            let start = (sum / total / UNIT) as u64;
            sum += weight;
            if weight.is_nan() || *weight <= 0.0 || (sum / total / UNIT) as u64 <= start {
                let message =
                    format!("expected positive weights, each at least 1e-15 of all, got {}", number(*weight));
                return Err(Error::invalid("weights", message));
            }
            components.push((start, beam));
        }
        Ok(Self { components })
    }
    /// On any potential, energies in parts as their weights, through channels with their probabilities, what is left of
    /// those being elastic: as [`Beam::new`], on several threads.
    ///
    /// # Errors
    /// As [`Beam::new`], [`new`](Self::new) and [`Channels::new`]; `InvalidInput` naming `channels` of which one is closed
    /// at the least energy of a beam.
    pub fn of_energies(
        potential: &Arc<dyn Potential>,
        (energies, weights): (&[f64], &[f64]),
        masses: (f64, f64),
        b_max: f64,
        profile: Profile,
        channels: &[Channel],
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let channels = Channels::new(channels, masses)?;
        for energy in energies {
            Beam::check(&channels, *energy, masses, b_max, &profile)?;
        }
        let beams = if let [energy] = energies {
            vec![Beam::new(potential, *energy, masses, b_max, profile, threads, ticker)?]
        } else {
            for_chunks(threads, energies.len(), ticker, |index, ticker| {
                Beam::new(potential, energies[index], masses, b_max, profile, 1, ticker)
            })?
        };
        Self::new(beams, weights)?.through(&channels)
    }
    /// The same beams with events in each stratum of the disc as it says.
    ///
    /// # Errors
    /// `InvalidInput` naming `importance` that ends elsewhere than the disc, or beside a spot.
    pub fn stratified(self, strata: Strata) -> Result<Self> {
        let strata = Arc::new(strata);
        let of_component = |(start, beam): (u64, Beam)| Ok((start, beam.stratified(&strata)?));
        Ok(Self { components: self.components.into_iter().map(of_component).collect::<Result<_>>()? })
    }
    /// The same beams whose events go through channels.
    ///
    /// # Errors
    /// `InvalidInput` naming `channels` of which one is closed at the least energy of a beam.
    pub(super) fn through(self, channels: &Channels) -> Result<Self> {
        let of_component = |(start, beam): (u64, Beam)| Ok((start, beam.through(channels)?));
        Ok(Self { components: self.components.into_iter().map(of_component).collect::<Result<_>>()? })
    }
    /// The channels of all beams, if an event's draw tells which of them it goes through.
    pub(super) fn channels(&self) -> Option<&Channels> {
        let mut beams = self.beams().map(Beam::channels);
        let first = beams.next()?;
        (!first.vary() && beams.all(|channels| channels == first)).then_some(first)
    }
    /// The strata of its events, if there are any.
    pub fn strata(&self) -> Option<&Strata> {
        self.beams().find_map(Beam::strata)
    }
    /// How many histograms there are of each tally: one for each stratum.
    pub(super) fn histograms(&self) -> usize {
        self.strata().map_or(1, Strata::count)
    }
    /// The beams, in order.
    pub fn beams(&self) -> impl Iterator<Item = &Beam> {
        self.components.iter().map(|(_, beam)| beam)
    }
    /// Bins of a quantity, as far as those of any of the beams go.
    ///
    /// # Errors
    /// As [`Beam::edges`].
    pub fn edges(&self, quantity: Quantity, bins: &Bins) -> Result<Edges> {
        self.beams()
            .max_by(|a, b| a.greatest(quantity).1.total_cmp(&b.greatest(quantity).1))
            .ok_or_else(|| Error::Internal("a mixture of nothing".to_owned()))?
            .edges(quantity, bins)
    }
    /// Whether an event is more than its impact parameter and its component.
    pub(super) fn is_drawn(&self) -> bool {
        self.beams().any(|beam| beam.profile.is_drawn())
    }
    /// Whether deflections of some beam are found event by event.
    pub(super) fn is_direct(&self) -> bool {
        self.beams().any(Beam::is_direct)
    }
    /// How events come that have these draws, each with its component and its ψ, signed and not folded, nothing if captured.
    ///
    /// # Errors
    /// As [`Deflector::deflect`](crate::scattering::deflection::Deflector::deflect).
    pub(super) fn met(&self, seed: u64, events: Range<u64>, ticker: &mut Ticker<'_>) -> Result<Vec<Met<'_>>> {
        let mut met: Vec<Met<'_>> = Vec::new();
        for event in events {
            let draws = Draws::new(seed, event);
            if let Some((component, beam)) = self.component(draws.bits(COMPONENT)) {
                met.push(Met { component, beam, arrival: beam.arrival(draws), angle: None });
            }
        }
        for (component, beam) in self.beams().enumerate() {
            let of_beam = |met: &&mut Met<'_>| met.component == component;
            let arrivals: Vec<Arrival> =
                met.iter().filter(|met| met.component == component).map(|met| met.arrival).collect();
            let angles = beam.deflections(&arrivals, ticker)?;
            met.iter_mut().filter(of_beam).zip(angles).for_each(|(met, angle)| met.angle = angle);
        }
        Ok(met)
    }
    /// The least of the beams' smallest deflections.
    pub fn smallest_angle(&self) -> f64 {
        self.beams().map(Beam::smallest_angle).fold(f64::INFINITY, f64::min)
    }
    /// As [`Beam::reachable`] and [`Beam::covered`]: of several beams what is of all of them, whole bins only.
    pub fn reachable(&self, quantity: Quantity, edges: &[f64]) -> (Vec<f64>, (f64, f64)) {
        let mut beams = self.beams();
        let Some(first) = beams.next() else { return (Vec::new(), (0.0, 0.0)) };
        let (mut parts, mut covered) = (first.reachable(quantity, edges), first.covered(quantity));
        for beam in beams {
            for (part, other) in parts.iter_mut().zip(beam.reachable(quantity, edges)) {
                *part = part.min(other).floor();
            }
            let other = beam.covered(quantity);
            covered = (covered.0.max(other.0), covered.1.min(other.1));
        }
        (parts, covered)
    }
    /// Which component a draw is, if there are several.
    pub(super) fn lookup(&self) -> Option<Lookup> {
        let starts: Vec<u64> = self.components.iter().map(|(start, _)| *start).collect();
        (starts.len() > 1).then(|| Lookup::new(starts, 16))
    }
    /// The part of all draws that is each component's.
    pub(super) fn parts(&self) -> impl Iterator<Item = f64> {
        let ends = self.components.iter().skip(1).map(|(start, _)| *start).chain([1 << DRAW_BITS]);
        self.components.iter().zip(ends).map(|((start, _), end)| (end - start) as f64 * UNIT)
    }
    /// The component of a draw.
    pub(super) fn component(&self, draw: u64) -> Option<(usize, &Beam)> {
        let index = self.components.partition_point(|(start, _)| *start <= draw).checked_sub(1)?;
        self.components.get(index).map(|(_, beam)| (index, beam))
    }
}

/// An event that came.
#[derive(Debug)]
pub(super) struct Met<'a> {
    /// Which beam of the mixture it is of, and that one.
    pub(super) component: usize,
    pub(super) beam: &'a Beam,
    /// How it arrived.
    pub(super) arrival: Arrival,
    /// ψ, where it was found by itself; none where a table has it, or if it was captured.
    pub(super) angle: Option<f64>,
}

impl Met<'_> {
    /// Half its angle; nothing if captured.
    pub(super) fn half(&self) -> Option<HalfAngle> {
        self.beam.half_of(&self.arrival, self.angle)
    }
}

/// A histogram of one quantity, or of two together.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    axes: Vec<(Quantity, Edges)>,
}

impl Tally {
    /// Of those quantities.
    ///
    /// # Errors
    /// `InvalidInput` naming `tally` for none, more than two, or more bins than 2^24.
    pub fn new(axes: Vec<(Quantity, Edges)>) -> Result<Self> {
        let slots = axes.iter().fold(1_usize, |slots, (_, edges)| slots.saturating_mul(edges.bins() + 2));
        if !(1..=2).contains(&axes.len()) || slots > 1 << 24 {
            let message = format!(
                "expected one or two quantities and at most 2**24 bins, got {} and {slots}",
                axes.len()
            );
            return Err(Error::invalid("tally", message));
        }
        Ok(Self { axes })
    }
    /// Its quantities and their edges.
    pub fn axes(&self) -> &[(Quantity, Edges)] {
        &self.axes
    }
    /// How many numbers it has: of each axis what is below, the bins, and what is above, the last axis fastest; and at
    /// the end what was captured.
    pub fn slots(&self) -> usize {
        self.axes.iter().map(|(_, edges)| edges.bins() + 2).product::<usize>() + 1
    }
    /// The slot of an event.
    fn slot(&self, value: impl Fn(Quantity) -> Option<f64>) -> usize {
        let mut slot = 0;
        for (quantity, edges) in &self.axes {
            let Some(value) = value(*quantity) else { return self.slots() - 1 };
            slot = slot * (edges.bins() + 2) + edges.slot(value);
        }
        slot
    }
    /// The slot of an event of several draws, in the histogram of its stratum: histograms follow each other.
    pub(super) fn slot_of(&self, beam: &Beam, arrival: &Arrival, half: Option<HalfAngle>) -> usize {
        arrival.stratum * self.slots() + self.slot(|quantity| beam.value_at(quantity, arrival, half))
    }
    /// The step function of the draw that it is, in one of the channels that have events; alone, or one of many.
    pub(super) fn steps(
        &self,
        (beam, exit): (&Beam, usize),
        alone: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<Steps> {
        let mut turns: Vec<u64> =
            self.axes.iter().flat_map(|(quantity, _)| beam.turning_draws(*quantity, exit)).collect();
        turns.extend(beam.strata().into_iter().flat_map(Strata::boundaries));
        turns.iter_mut().for_each(|draw| *draw = (*draw).clamp(1, (1 << DRAW_BITS) - 1));
        turns.sort_unstable();
        turns.dedup();
        Steps::new(&turns, &OfDraw { tally: self, beam, exit }, alone, ticker)
    }
}

/// Counts an event in each tally.
pub(super) fn count_one(
    tallies: &[Tally],
    (beam, arrival, half): (&Beam, &Arrival, Option<HalfAngle>),
    counters: &mut [Vec<Vec<u64>>],
) {
    for (tally, counters) in tallies.iter().zip(counters.iter_mut()) {
        let slot = tally.slot_of(beam, arrival, half);
        if let Some(counter) = counters.first_mut().and_then(|counters| counters.get_mut(slot)) {
            *counter += 1;
        }
    }
}

/// A tally of a beam in one of its channels, as a function of the draw.
struct OfDraw<'a> {
    tally: &'a Tally,
    beam: &'a Beam,
    exit: usize,
}

impl Stepping for OfDraw<'_> {
    /// Of each axis the slot and the value.
    type Values = [(usize, f64); 2];

    fn seen(&self, draw: u64) -> Seen<Self::Values> {
        let Self { tally, beam, exit } = *self;
        let mut values = [(0, f64::NAN); 2];
        let first = beam.stratum(draw) * tally.slots();
        let arrival = beam.straight(exit, beam.share(draw));
        let turned = tally.axes.iter().any(|(quantity, _)| *quantity != Quantity::ImpactParameter);
        let half = if turned { beam.half_angle(&arrival) } else { None };
        let mut slot = 0;
        for ((quantity, edges), seen) in tally.axes.iter().zip(&mut values) {
            let Some(value) = beam.value_at(*quantity, &arrival, half) else {
                return Seen { draw, slot: first + tally.slots() - 1, values };
            };
            *seen = (edges.slot(value), value);
            slot = slot * (edges.bins() + 2) + seen.0;
        }
        Seen { draw, slot: first + slot, values }
    }
    fn sides(&self, low: &Seen<Self::Values>, high: &Seen<Self::Values>) -> Option<[f64; 2]> {
        let mut apart =
            self.tally.axes.iter().zip(low.values.iter().zip(&high.values)).filter(|(_, (a, b))| a.0 != b.0);
        let ((_, edges), (a, b)) = apart.next()?;
        // Of two quantities that step one after the other halving tells which is which.
        if apart.next().is_some() { None } else { edges.sides([a.0, b.0], [a.1, b.1]) }
    }
    fn apart(&self, [low, high]: [&Seen<Self::Values>; 2], of: &Seen<Self::Values>) -> f64 {
        let axes = self.tally.axes.iter().enumerate();
        let off = |(axis, (_, edges)): (usize, &(Quantity, Edges))| {
            let slots = [low.values[axis].0, high.values[axis].0];
            (slots[0] != slots[1]).then(|| edges.apart(slots, of.values[axis].1))
        };
        axes.filter_map(off).fold(f64::INFINITY, f64::min)
    }
}
