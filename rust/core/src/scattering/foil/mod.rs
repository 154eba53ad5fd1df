//! Ions through amorphous matter: a Monte Carlo of binary collisions, with what electrons take between them.
//!
//! An ion is followed, collision after collision (`walk`), through what was prepared for it (`medium`): what electrons take
//! (`stopping`, `slowing`), how it is turned at every energy and impact parameter (`angles`), how far out that counts.
//! Where large angles are wanted that are rare, each ion is made to have one hard collision and stands for as many as
//! that is likely. Units: eV, Å, u.
//!
//! What an event uses of the numbers of [`philox`](crate::numerics::philox), all in stream 1, so that it shares none with an
//! event of [`monte_carlo`](super::monte_carlo) of the same seed (`draws`):
//! - draws 0 to 3: where on its way the forced collision is, its b², its azimuth, its element;
//! - draws 4 + 4i to 7 + 4i: of step i how far it is, b², azimuth and element of the collision at its end.
//!
//! A draw that is not needed (the element, where there is but one; those of a step that ends without a collision) is left
//! out and used for nothing else. Counts and weights are whole numbers: the bits of a result depend on the seed and on
//! which events were run, and on nothing else.
//! Source: J. F. Ziegler, J. P. Biersack, U. Littmark, *The Stopping and Range of Ions in Solids* (1985), chapter 4; a
//! minimum angle in place of an energy: M. H. Mendenhall, R. A. Weller, Nucl. Instrum. Methods B 227 (2005) 420.

mod angles;
mod draws;
mod medium;
mod octaves;
mod slowing;
mod stopping;
mod tally;
mod walk;

pub use medium::number_densities;
pub use stopping::{Atoms, Model, Projectile, Stopping};
pub use tally::{Counts, MOST_EVENTS, Quantity, Slot, Weights};
pub use walk::{Ended, Fate, Met};

use super::bins::Bins;
use super::histogram::Edges;
use super::reach::Limits;
use crate::parallel::{Ticker, for_chunks};
use crate::potentials::Potential;
use crate::words::number;
use crate::{Error, Result};
use core::f64::consts::{FRAC_PI_2, PI};
use draws::Draws;
use medium::Medium;
use std::sync::Arc;

/// Events of a chunk: an interrupted run loses at most as many of each thread, behind the first that is not done. They are
/// long, from half a microsecond to milliseconds, so few of them are worth being handed out.
const EVENTS_PER_CHUNK: u64 = 64;
/// Chunks to each thread and round.
const CHUNKS_PER_THREAD: u64 = 1024;

/// The least energy of a beam in eV. Slower ions meet several atoms at once: W. Eckstein, *Computer Simulation of Ion-Solid
/// Interactions* (1991), puts the end of collisions of two at some ten eV.
const SLOWEST: f64 = 30.0;
/// The largest energy, as a part of the ion's rest energy.
const FASTEST: f64 = 0.1;

/// One element of a foil.
#[derive(Clone, Debug)]
pub struct Element {
    /// Its atomic number.
    pub atomic_number: f64,
    /// Its mass in u.
    pub mass: f64,
    /// How many of its atoms are in an Å³.
    pub density: f64,
    /// Its mean excitation energy in eV; NaN if it is not known.
    pub excitation: f64,
    /// V(r) between an ion and one of its atoms, in eV and Å.
    pub potential: Arc<dyn Potential>,
}

/// A foil.
#[derive(Clone, Debug)]
pub struct Foil {
    /// Its elements, at least one.
    pub elements: Vec<Element>,
    /// In Å.
    pub thickness: f64,
    /// What electrons take.
    pub stopping: Stopping,
    /// Collisions that turn by less, in the frame of the center of mass, are left out.
    pub minimum_angle: f64,
}

/// What comes to it.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// The ion.
    pub ion: Projectile,
    /// Its energy in eV.
    pub energy: f64,
    /// An ion of less energy has stopped.
    pub lowest: f64,
    /// The angle between the beam and the foil's normal.
    pub incidence: f64,
    /// Whether each ion has one collision and no other.
    pub single: bool,
    /// By how much the collision turns that each ion is made to have.
    pub forced_angle: Option<f64>,
}

/// A foil with an ion, ready to run.
#[derive(Clone, Debug)]
pub struct Beam {
    medium: Medium,
}

/// What was counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counted {
    /// How many events, from the first on and without a gap: all of them unless the run was cancelled.
    pub events: u64,
    /// What was counted of them.
    pub counts: Counts,
}

fn positive(name: &str, value: f64) -> Result<()> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Error::invalid(name, format!("expected a positive finite number, got {}", number(value))))
}

fn between(name: &str, value: f64, range: core::ops::Range<f64>, words: &str) -> Result<()> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(Error::invalid(name, format!("expected {words}, got {}", number(value))))
}

impl Foil {
    /// Refuses what is no foil, by the names of the numbers.
    ///
    /// # Errors
    /// `InvalidInput`.
    pub fn check(&self) -> Result<()> {
        for element in &self.elements {
            positive("atomic_number", element.atomic_number)?;
            positive("mass", element.mass)?;
            positive("density", element.density)?;
            if !element.excitation.is_nan() {
                positive("mean_excitation_energy", element.excitation)?;
            }
        }
        positive("thickness", self.thickness)?;
        self.stopping.check()?;
        between("minimum_angle", self.minimum_angle, 1e-12..0.5, "an angle from 1e-12 to 0.5")
    }
}

impl Run {
    fn check(&self) -> Result<()> {
        positive("atomic_number", self.ion.atomic_number)?;
        positive("mass", self.ion.mass)?;
        positive("beam_energy", self.energy)?;
        if self.energy < SLOWEST {
            let message = format!(
                "expected at least {} eV, below which ions meet several atoms at once, which collisions of two do not \
                 describe; got {} eV. Energies are in eV: 1 MeV is 1e6",
                number(SLOWEST),
                number(self.energy)
            );
            return Err(Error::invalid("beam_energy", message));
        }
        positive("lowest_energy", self.lowest)?;
        if !(self.lowest < self.energy && self.energy / self.lowest <= 1e9) {
            let message = format!(
                "expected less than beam_energy, {}, and at least 1e-9 of it, got {}",
                number(self.energy),
                number(self.lowest)
            );
            return Err(Error::invalid("lowest_energy", message));
        }
        if self.energy > FASTEST * self.ion.rest_energy() {
            let message = format!(
                "expected at most a tenth of the ion's rest energy, {}: collisions are not relativistic; got {}",
                number(self.ion.rest_energy()),
                number(self.energy)
            );
            return Err(Error::invalid("beam_energy", message));
        }
        between("incidence", self.incidence, 0.0..1.55, "an angle from 0 to 1.55 between beam and normal")?;
        match self.forced_angle {
            Some(angle) => between("forced_angle", angle, 0.01..PI, "an angle from 0.01 to below π"),
            None if self.single => Err(Error::invalid(
                "forced_angle",
                "expected the least angle of the collision that collisions='single' leaves each ion, got None",
            )),
            None => Ok(()),
        }
    }
}

impl Beam {
    /// Tabulates what the run takes.
    ///
    /// # Errors
    /// `InvalidInput` naming what is out of range, or a potential that captures or that no table can hold; `Interrupted`.
    pub fn new(foil: &Foil, run: &Run, threads: usize, ticker: &mut Ticker<'_>) -> Result<Self> {
        foil.check()?;
        run.check()?;
        Ok(Self { medium: Medium::new(foil, run, threads, ticker)? })
    }
    /// What events weigh.
    pub fn weights(&self) -> Weights {
        Weights { largest: self.medium.largest_weight(), forced: self.medium.forced.is_some() }
    }
    /// Collisions on a straight way through, the error of the tables in sin²(ψ/2), and their bytes.
    pub fn told(&self) -> (f64, f64, usize) {
        self.medium.told()
    }
    /// Bins of a quantity.
    ///
    /// # Errors
    /// `InvalidInput` naming the quantity or `bins`, or `tally` for one that this run does not have.
    pub fn edges(&self, quantity: Quantity, bins: &Bins) -> Result<Edges> {
        let (limits, high) = self.limits(quantity)?;
        let edges = bins.edges(quantity.name(), quantity.is_angle(), high)?;
        limits.check(quantity.name(), edges.values())?;
        Ok(edges)
    }
    fn limits(&self, quantity: Quantity) -> Result<(Limits, f64)> {
        let Medium { energy, thickness, .. } = self.medium;
        Ok(match quantity {
            Quantity::CmAngle if self.medium.forced.is_none() => {
                return Err(Error::invalid(
                    "tally",
                    "expected a forced_angle with 'cm_angle', which is that of the forced collision, got None",
                ));
            }
            Quantity::TransmittedAngle if self.medium.beam[0] == 0.0 => (Limits::angles("π", PI), FRAC_PI_2),
            Quantity::CmAngle
            | Quantity::LabAngle
            | Quantity::TransmittedAngle
            | Quantity::ReflectedAngle => (Limits::angles("π", PI), PI),
            Quantity::TransmittedEnergy | Quantity::ReflectedEnergy => {
                (Limits::upto("beam_energy", energy), energy)
            }
            Quantity::StoppedDepth => {
                let end = thickness / tally::MICROMETER;
                (Limits::upto("thickness", end), end)
            }
        })
    }

    /// Runs the events `first_event..first_event + n_events`: the same counts for any number of threads, on any machine;
    /// a cancelled run gives the events it counted.
    ///
    /// # Errors
    /// `InvalidInput` if there is no event, or too many; `Interrupted` if nothing was counted yet.
    pub fn run(
        &self,
        tallies: &[(Quantity, Edges)],
        seed: u64,
        (first_event, n_events): (u64, u64),
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Counted> {
        let end = first_event.checked_add(n_events).filter(|end| n_events > 0 && *end <= 1 << 63);
        let (Some(end), true) = (end, n_events <= MOST_EVENTS) else {
            return Err(Error::invalid("n_events", "expected from 1 to 2**39 events, none beyond 2**63"));
        };
        let weights = self.weights();
        let mut counted = Counted { events: 0, counts: Counts::new(tallies) };
        let mut first = first_event;
        while first < end {
            let events = (EVENTS_PER_CHUNK * CHUNKS_PER_THREAD * threads as u64).min(end - first);
            let bound = |chunk: u64| first + (EVENTS_PER_CHUNK * chunk).min(events);
            let chunks = events.div_ceil(EVENTS_PER_CHUNK);
            let parts = for_chunks(threads, chunks as usize, ticker, |chunk, ticker| {
                let mut ends = Vec::new();
                for event in bound(chunk as u64)..bound(chunk as u64 + 1) {
                    match self.medium.follow(Draws::new(seed, event), &mut |_| (), ticker) {
                        Ok(ended) => ends.push(ended),
                        Err(Error::Interrupted) => break,
                        Err(error) => return Err(error),
                    }
                    ticker.control().count(1);
                }
                Ok(ends)
            })?;
            for (chunk, ends) in parts.into_iter().enumerate() {
                ends.iter().for_each(|ended| counted.counts.count(tallies, ended, weights));
                counted.events += ends.len() as u64;
                // Behind the first chunk that is not whole nothing is adjacent any more.
                if (ends.len() as u64) < bound(chunk as u64 + 1) - bound(chunk as u64) {
                    return if counted.events == 0 { Err(Error::Interrupted) } else { Ok(counted) };
                }
            }
            first += events;
        }
        Ok(counted)
    }

    /// The collisions of one event, and how it ended.
    ///
    /// # Errors
    /// `Interrupted`.
    pub fn history(&self, seed: u64, event: u64, ticker: &mut Ticker<'_>) -> Result<(Vec<Met>, Ended)> {
        let mut all = Vec::new();
        let ended = self.medium.follow(Draws::new(seed, event), &mut |met| all.push(*met), ticker)?;
        Ok((all, ended))
    }
}
