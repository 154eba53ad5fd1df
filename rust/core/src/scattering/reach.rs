//! What a beam on a disc can reach: which edges make sense, and how much of a bin is covered.
//!
//! The one idea: a cross section by bin is the area of all impact parameters that lead into the bin, and a beam
//! knows only those on its disc. What lies beyond the disc leads to a range of values next to the forward
//! direction, so each bin is covered whole, up to that range, or not at all.

use super::kinematics::solid_angle;
use super::monte_carlo::{Beam, Quantity};
use crate::words::number;
use crate::{Error, Result};

/// How far beyond the end of its range an edge may be rounded.
const FORGIVEN: f64 = 1e-12;
/// Edges within so many roundings of the end of the disc are meant to be it.
const MEANT: f64 = 8.0 * f64::EPSILON;

/// The range of a quantity, [0, high], in the words of a refusal.
pub(super) struct Limits {
    pub(super) high: f64,
    name: &'static str,
    angle: bool,
}

impl Limits {
    /// Of angles.
    pub(super) fn angles(name: &'static str, high: f64) -> Self {
        Self { high, name, angle: true }
    }
    /// Of anything else.
    pub(super) fn upto(name: &'static str, high: f64) -> Self {
        Self { high, name, angle: false }
    }
    /// Refuses edges outside.
    pub(super) fn check(&self, argument: &str, edges: &[f64]) -> Result<()> {
        let outside = |edge: &f64| *edge < 0.0 || *edge > self.high * (1.0 + FORGIVEN);
        let Some(index) = edges.iter().position(outside) else { return Ok(()) };
        let (name, edge) = (self.name, number(edges[index]));
        let message = match (self.angle, edges[index] < 0.0) {
            (true, false) => {
                format!(
                    "expected edges in [0, {name}], but edge {index} is {edge}; pass np.radians(edges) if they are in degrees"
                )
            }
            (false, false) => format!(
                "expected edges in [0, {name}] = [0, {}], but edge {index} is {edge}; give them in the unit of {name}",
                number(self.high)
            ),
            _ => format!(
                "expected edges in [0, {name}], but edge {index} is {edge}; leave it out: nothing is below 0"
            ),
        };
        Err(Error::invalid(argument, message))
    }
}

impl Quantity {
    /// Whether a bin of it is a ring of directions.
    pub fn is_angle(self) -> bool {
        matches!(self, Self::CmAngle | Self::LabAngle | Self::RecoilAngle)
    }
    /// What a cross section in a bin is divided by: its solid angle, or its width.
    pub fn measure(self, from: f64, to: f64) -> f64 {
        if self.is_angle() { solid_angle(from, to) } else { to - from }
    }
}

impl Beam {
    /// For each bin the part of it, by solid angle or width, where the disc holds every impact parameter that
    /// leads there: 1 if that is the whole bin, 0 if nothing of it.
    pub fn reachable(&self, quantity: Quantity, edges: &[f64]) -> Vec<f64> {
        let covered = self.covered(quantity);
        if covered.0 == covered.1 {
            return vec![0.0; edges.len() - 1];
        }
        let meant =
            |end: f64| edges.iter().copied().find(|edge| (edge - end).abs() <= MEANT * end).unwrap_or(end);
        let (low, high) = (meant(covered.0), meant(covered.1));
        let part = |pair: &[f64]| {
            let (from, to) = (pair[0], pair[1]);
            let inside = (from.max(low), to.min(high));
            let part = if inside.0 < inside.1 {
                quantity.measure(inside.0, inside.1) / quantity.measure(from, to)
            } else {
                0.0
            };
            // A bin that is cut, or that ends where b = ∞ leads, is never whole, however narrow what is missing.
            let cut = from < low || to > high || self.ends_forward(quantity, from, to);
            let part = if cut { part.min(1.0_f64.next_down()) } else { part };
            // Below the covered values there are events of the disc too, unless the angle falls with b.
            let alone = self.falls();
            if alone || quantity == Quantity::ImpactParameter { part } else { part.floor() }
        };
        edges.windows(2).map(part).collect()
    }
}
