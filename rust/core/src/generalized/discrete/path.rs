//! The discrete action of a path that is given by its places, and how far it is from stationary.
//!
//! The one idea: where momenta that two segments have at the place between them are the same, the sum of their actions does not
//! change with it; that is the discrete Euler–Lagrange equation. J. E. Marsden & M. West, Acta Numerica 10 (2001) 357, (1.3.3).

use super::Equations;
use super::balance::{place, times};
use super::node::Node;
use super::step::Solver;
use crate::error::Result;
use crate::expressions::{Code, Machine};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::parallel::Ticker;
use std::sync::Arc;

/// What a segment between two places has.
struct Segment {
    /// Momenta at its ends, −∂L_d/∂q₀ and ∂L_d/∂q₁, less the impulses of further forces.
    before: Vec<f64>,
    after: Vec<f64>,
    /// What those are made of.
    sizes: Vec<f64>,
    /// The states and times of the quadrature.
    states: Vec<Lanes>,
    t: Lanes,
}

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

impl Solver {
    /// Finds the inner points of the segment between two places, of a solver whose ends are given.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    fn segment(&mut self, (from, to): (&[f64], &[f64]), (t, h): (f64, f64)) -> Result<Segment> {
        let (n, s) = (self.equations.coordinates, self.table.degree);
        let zeros = vec![0.0; n];
        let node = Node::new(from, &zeros, &zeros);
        for j in 1..=s {
            for a in 0..n {
                self.unknowns[(j - 1) * n + a] = self.table.control[j] * ((to[a] - from[a]) / h);
            }
        }
        self.displace(&node, t, h)?;
        self.balance(&node, t, h);
        let before: Vec<f64> = self.residuals[..n].iter().map(|rest| -rest).collect();
        let mut after = before.clone();
        let mut sizes = zeros.clone();
        let straight: Vec<f64> = from.iter().zip(to).map(|(from, to)| (to - from) / h).collect();
        self.evaluate_momenta(from, &straight, t);
        for a in 0..n {
            let (force, momentum) = (self.rates.output(a).0, self.rates.output(n + a).0);
            for i in 0..self.table.count {
                let (weight, change) = (self.table.weights[i], h * force[i]);
                after[a] += weight * change;
                sizes[a] += weight * ((self.table.slopes[0][i] * momentum[i]).abs() + change.abs());
            }
            for b in 0..n {
                // A velocity is the difference of two places, over that of two times.
                let inertia = self.momenta.output(n + a * n + b);
                let times = straight[b].abs() * (t.abs() + (t + h).abs());
                sizes[a] += (inertia * ((from[b].abs() + to[b].abs() + times) / h)).abs();
            }
        }
        let mut states = vec![Lanes([0.0; WIDTH]); 2 * n];
        place(&self.table, &self.unknowns, &node, h, &mut states);
        Ok(Segment { before, after, sizes, states, t: times(&self.table, t, h) })
    }
}
