//! What is counted of ions: how many, and how many they stand for.
//!
//! Weights are whole numbers of a unit that is fixed before the run, so that sums of them do not depend on the order.

use super::walk::{Ended, Fate};
use crate::Result;
use crate::scattering::histogram::Edges;
use crate::words::unknown;

/// The largest weight, in units.
const UNITS: f64 = (1_u64 << 24) as f64;
/// So many events at most, that no sum of units passes 2^63.
pub const MOST_EVENTS: u64 = 1 << 39;

/// In Å.
pub(super) const MICROMETER: f64 = 1e4;

/// What is tallied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The direction of those that leave, measured from the beam's.
    LabAngle,
    /// The same of those that come through.
    TransmittedAngle,
    /// Their energy.
    TransmittedEnergy,
    /// The direction of those that come back, measured from the beam's.
    ReflectedAngle,
    /// Their energy.
    ReflectedEnergy,
    /// Where the others ended, in µm.
    StoppedDepth,
    /// The angle of the forced collision in the frame of its center of mass.
    CmAngle,
}

impl Quantity {
    /// All of them, with their names.
    pub const ALL: [(&'static str, Self); 7] = [
        ("lab_angle", Self::LabAngle),
        ("transmitted_angle", Self::TransmittedAngle),
        ("transmitted_energy", Self::TransmittedEnergy),
        ("reflected_angle", Self::ReflectedAngle),
        ("reflected_energy", Self::ReflectedEnergy),
        ("stopped_depth", Self::StoppedDepth),
        ("cm_angle", Self::CmAngle),
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
    /// Whether a bin of it is a ring of directions.
    pub fn is_angle(self) -> bool {
        matches!(self, Self::LabAngle | Self::TransmittedAngle | Self::ReflectedAngle | Self::CmAngle)
    }
    /// Of an ion that has it.
    fn of(self, ended: &Ended) -> Option<f64> {
        let (through, back) = (ended.fate == Fate::Transmitted, ended.fate == Fate::Reflected);
        let (has, value) = match self {
            Self::LabAngle => (through || back, ended.angle),
            Self::TransmittedAngle => (through, ended.angle),
            Self::TransmittedEnergy => (through, ended.energy),
            Self::ReflectedAngle => (back, ended.angle),
            Self::ReflectedEnergy => (back, ended.energy),
            Self::StoppedDepth => (ended.fate == Fate::Stopped, ended.depth / MICROMETER),
            Self::CmAngle => (ended.fate != Fate::Missed, ended.cm_angle),
        };
        has.then_some(value)
    }
}

/// Ions, what they stand for, and the sum of its squares: in units, of which the result knows the size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Slot {
    /// How many ions.
    pub count: u64,
    /// Their weights.
    pub weight: u64,
    /// The squares of these.
    pub square: u64,
}

impl Slot {
    fn add(&mut self, other: Self) {
        self.count += other.count;
        self.weight += other.weight;
        self.square += other.square;
    }
}

/// What an ion adds where it is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// The largest weight; without a forced collision every weight is 1, and a unit as well.
    pub largest: f64,
    /// Whether weights differ.
    pub forced: bool,
}

impl Weights {
    /// The size of a unit, and of one of a square.
    pub fn units(self) -> (f64, f64) {
        if self.forced { (self.largest / UNITS, self.largest * self.largest / UNITS) } else { (1.0, 1.0) }
    }
    fn slot(self, weight: f64) -> Slot {
        if !self.forced {
            return Slot { count: 1, weight: 1, square: 1 };
        }
        let part = (weight / self.largest).min(1.0);
        let units = |part: f64| (part * UNITS).round() as u64;
        Slot { count: 1, weight: units(part), square: units(part * part) }
    }
}

/// What was counted: of each tally the slots below, in and above its edges, and of each fate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Of each tally.
    pub tallies: Vec<Vec<Slot>>,
    /// Of the four fates, in their order.
    pub fates: [Slot; 4],
}

impl Counts {
    /// Nothing yet.
    pub(super) fn new(tallies: &[(Quantity, Edges)]) -> Self {
        let of = |(_, edges): &(Quantity, Edges)| vec![Slot::default(); edges.bins() + 2];
        Self { tallies: tallies.iter().map(of).collect(), fates: [Slot::default(); 4] }
    }
    /// Counts one ion.
    pub(super) fn count(&mut self, tallies: &[(Quantity, Edges)], ended: &Ended, weights: Weights) {
        let slot = weights.slot(ended.weight);
        self.fates[ended.fate as usize].add(slot);
        for ((quantity, edges), slots) in tallies.iter().zip(&mut self.tallies) {
            if let Some(value) = quantity.of(ended) {
                slots[edges.slot(value)].add(slot);
            }
        }
    }
}
