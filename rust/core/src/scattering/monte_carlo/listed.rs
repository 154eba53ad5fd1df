//! Events one by one, for whoever wants more than counts: the very events that are counted.

use super::{BATCH, Mixture, Quantity, Strata, end_of};
use crate::Result;
use crate::parallel::Ticker;

/// What is known of one event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Which beam of the mixture.
    pub component: u64,
    /// Which channel: 0 is elastic, others count from 1 as they were given.
    pub channel: u64,
    /// Of all quantities, in the order of [`Quantity::ALL`]; NaN of a captured one, but where it came.
    pub values: [f64; Quantity::ALL.len()],
    /// ψ, signed and not folded; NaN if captured.
    pub deflection: f64,
    /// Of the projectile before, in the laboratory.
    pub beam_energy: f64,
    /// How many events of the plain disc it stands for: 1 without strata.
    pub weight: f64,
    /// Between its direction and the axis of the beam.
    pub incidence: f64,
}

/// The events `first_event..first_event + n_events`.
///
/// # Errors
/// `InvalidInput` as [`monte_carlo`](super::monte_carlo); `Interrupted`.
pub fn events(
    mixture: &Mixture,
    seed: u64,
    first_event: u64,
    n_events: u64,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Event>> {
    let end = end_of(first_event, n_events)?;
    let weights = mixture.strata().map_or_else(|| vec![1.0], Strata::weights);
    let mut events = Vec::new();
    let mut next = first_event;
    while next < end {
        ticker.tick()?;
        let stop = end.min(next + BATCH as u64);
        for met in mixture.met(seed, next..stop, ticker)? {
            let (beam, arrival, half) = (met.beam, &met.arrival, met.half());
            let values =
                Quantity::ALL.map(|(_, quantity)| beam.value_at(quantity, arrival, half).unwrap_or(f64::NAN));
            events.push(Event {
                component: met.component as u64,
                channel: beam.channels().label(arrival.exit) as u64,
                values,
                deflection: met.angle.unwrap_or(f64::NAN),
                beam_energy: arrival.energy,
                weight: weights.get(arrival.stratum).copied().unwrap_or(f64::NAN),
                incidence: arrival.direction.tilt,
            });
        }
        ticker.control().count(stop - next);
        next = stop;
    }
    Ok(events)
}
