//! Events one by one, for whoever wants more than counts: the very events that are counted.

use super::beam::UNIT;
use super::{Mixture, Quantity, end_of};
use crate::Result;
use crate::numerics::philox::{draw_of, key};
use crate::parallel::Ticker;

/// What is known of one event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Which beam of the mixture.
    pub component: u64,
    /// Of all quantities, in the order of [`Quantity::ALL`]; NaN of a captured one, but where it came.
    pub values: [f64; Quantity::ALL.len()],
    /// ψ, signed and not folded; NaN if captured.
    pub deflection: f64,
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
    let mut events = Vec::new();
    for event in first_event..end {
        ticker.tick()?;
        ticker.control().count(1);
        let share = draw_of(key(seed), event, 0).number() as f64 * UNIT;
        let Some((component, beam)) = mixture.component(draw_of(key(seed), event, 1).number()) else {
            continue;
        };
        let values = Quantity::ALL.map(|(_, quantity)| beam.value(quantity, share).unwrap_or(f64::NAN));
        let deflection = beam.deflection(share).unwrap_or(f64::NAN);
        events.push(Event { component: component as u64, values, deflection });
    }
    Ok(events)
}
