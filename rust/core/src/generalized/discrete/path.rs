//! The discrete action of a path that is given by its places, and how far it is from stationary.
//!
//! The one idea: where momenta that two segments have at the place between them are the same, the sum of their actions does not
//! change with it; that is the discrete Euler–Lagrange equation. J. E. Marsden & M. West, Acta Numerica 10 (2001) 357, (1.3.3).

use super::Equations;
use super::step::Solver;
use crate::error::Result;
use crate::expressions::{Code, Machine};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::parallel::Ticker;
use std::sync::Arc;

/// What the segments of a path have, one after another.
#[derive(Clone, Debug, Default)]
pub struct Segments {
    /// Their actions.
    pub actions: Vec<f64>,
    /// Momenta at their beginnings.
    pub before: Vec<f64>,
    /// Momenta at their ends.
    pub after: Vec<f64>,
    /// Sizes of what those are made of.
    pub sizes: Vec<f64>,
}

/// The segments of a path through places (n numbers each) at times; `function` is L.
///
/// # Errors
/// Inner points that Newton's method does not find; an interrupt.
pub fn segments(
    equations: &Arc<Equations>,
    function: Code,
    parameters: &[f64],
    (t, places): (&[f64], &[f64]),
    ticker: &mut Ticker<'_>,
) -> Result<Segments> {
    let n = equations.coordinates;
    let mut solver = Solver::new(equations, parameters, true);
    let wide: Vec<Lanes> = parameters.iter().map(|&value| Lanes([value; WIDTH])).collect();
    let mut machine = Machine::new(Arc::new(function), &wide);
    let mut found = Segments::default();
    for (times, ends) in t.windows(2).zip(places.windows(2 * n).step_by(n)) {
        ticker.tick()?;
        let h = times[1] - times[0];
        let segment = solver.segment(ends.split_at(n), (times[0], h))?;
        let mut values = [Lanes([0.0; WIDTH])];
        machine.evaluate(segment.t, &segment.states, &mut values);
        let weighted = values[0].0.iter().zip(&solver.table.weights);
        // Lanes without a point have no weight.
        found.actions.push(h * weighted.map(|(value, weight)| value * weight).sum::<f64>());
        found.before.extend(segment.before);
        found.after.extend(segment.after);
        found.sizes.extend(segment.sizes);
    }
    Ok(found)
}
