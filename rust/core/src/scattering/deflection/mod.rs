//! The deflection function ψ(E, b) of any central potential, and what comes with it.
//!
//! The one idea: ψ is an integral over the way out from the outermost turning point, which a bracketed method finds
//! (`profile`, `turning`) and which is divided out of the integrand, so that equal steps in w, r = r₀ cosh w, converge
//! as powers of their number, small angles keep their digits, and so does what is missing to π head-on (`trapezoid`,
//! eight pairs side by side). Beside barriers, at edges of V, and where what is left is small against what cancels,
//! intervals are halved where they must be (`adaptive`). Some potentials have closed forms (`closed`).
//! Sources: Landau & Lifshitz, *Mechanics*, §18; L. N. Trefethen, J. A. C. Weideman, SIAM Rev. 56 (2014) 385.

mod adaptive;
mod closed;
mod comparison;
mod delay_tail;
mod grid;
mod head_on;
mod integrands;
mod moved;
mod nodes;
mod pack;
mod pairs;
mod precise;
mod profile;
mod refine;
mod rim;
mod search;
mod spectrum;
mod trapezoid;
mod turning;

use crate::parallel::{Ticker, for_chunks};
use crate::potentials::Potential;
use crate::words::number;
use crate::{Error, Result};
use closed::Closed;
use core::f64::consts::FRAC_PI_2;
use pairs::Quadrature;
use profile::Profile;
use std::sync::Arc;

/// The tolerance if none is asked for: of an angle, relative to what was added up to it.
pub const TOLERANCE: f64 = 1e-12;
/// What can be asked for.
pub const TOLERANCES: core::ops::RangeInclusive<f64> = 1e-16..=1e-3;
/// What sums in float64 come to: whoever asks for less is given this, and told so by [`Deflection::error`].
const FINEST: f64 = 1e-14;
/// Pairs of a chunk.
const CHUNK: usize = 512;
/// What became of a projectile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It left.
    Scattered,
    /// It fell into the center.
    Captured,
    /// It left, after turning near a circular orbit: b is within 1e-4 of where it would stay.
    NearOrbiting,
}

impl Status {
    /// All of them, with their names.
    pub const ALL: [(&'static str, Self); 3] =
        [("scattered", Self::Scattered), ("captured", Self::Captured), ("near_orbiting", Self::NearOrbiting)];
}

/// Of one pair of an energy and an impact parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deflection {
    /// ψ, positive for repulsion, not folded; NaN if captured.
    pub angle: f64,
    /// π − |ψ|, with its own digits where ψ is near π.
    pub complement: f64,
    /// The distance of closest approach; 0 if captured.
    pub closest_approach: f64,
    /// dψ/db.
    pub derivative: f64,
    /// The time lost against free motion, times the speed far out; infinite for V that falls no faster than 1/r.
    pub delay: f64,
    /// How far the angle may be off, but for what rounding of E and b makes of it.
    pub error: f64,
    /// How many turning points radial motion with this energy and angular momentum has, inner ones too.
    pub turning_points: u32,
    /// What became of it.
    pub status: Status,
}

impl Deflection {
    fn captured() -> Self {
        Self {
            angle: f64::NAN,
            complement: f64::NAN,
            closest_approach: 0.0,
            derivative: f64::NAN,
            delay: f64::NAN,
            error: f64::NAN,
            turning_points: 0,
            status: Status::Captured,
        }
    }
    /// Comes to the top of a hill at the center with nothing left, to the last digit of its energy: on its way down from there
    /// it may be anywhere from 0 to π.
    fn rest_on_top(&mut self) {
        (self.angle, self.complement, self.error) = (FRAC_PI_2, FRAC_PI_2, FRAC_PI_2);
        (self.derivative, self.delay) = (f64::NEG_INFINITY, f64::INFINITY);
        self.status = Status::NearOrbiting;
    }
    fn is_unknown(&self) -> bool {
        self.error >= FRAC_PI_2
    }
    fn forget_angle(&mut self) {
        (self.angle, self.complement, self.error) = (f64::NAN, f64::NAN, f64::INFINITY);
    }
}

/// An impact parameter at which the deflection function is not smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Where.
    pub impact_parameter: f64,
    /// The radius of the circular orbit that is approached there; None where V ends or has an edge itself.
    pub orbit: Option<f64>,
    /// Whether what comes with less is captured.
    pub captures: bool,
}

/// The deflection function of a potential.
#[derive(Debug)]
pub struct Deflector {
    profile: Option<Profile>,
    closed: Option<Closed>,
    tolerance: f64,
    /// Whether angles beside a barrier are as certain as E and b.
    refined: bool,
}

impl Deflector {
    /// Of a potential, to a tolerance.
    ///
    /// # Errors
    /// `InvalidInput` naming a potential that does not vanish far out, or a tolerance out of range.
    pub fn new(potential: &Arc<dyn Potential>, tolerance: f64) -> Result<Self> {
        if !TOLERANCES.contains(&tolerance) {
            let (least, most) = (number(*TOLERANCES.start()), number(*TOLERANCES.end()));
            let message = format!("expected a number from {least} to {most}, got {}", number(tolerance));
            return Err(Error::invalid("tolerance", message));
        }
        let closed = Closed::of(potential.as_ref());
        let profile = closed.is_none_or(Closed::angle_only).then(|| Profile::new(potential));
        if let Some(profile) = &profile {
            profile.check_far()?;
        }
        Ok(Self { profile, closed, tolerance: tolerance.max(FINEST), refined: true })
    }
    /// The same for one energy.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn at_energy(potential: &Arc<dyn Potential>, tolerance: f64, energy: f64) -> Result<Self> {
        let made = Self::new(potential, tolerance)?;
        Ok(made.near(energy).unwrap_or(made))
    }
    /// The same for the places of a table, which need no more beside a barrier than rounding leaves.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn for_table(potential: &Arc<dyn Potential>, tolerance: f64) -> Result<Self> {
        Ok(Self { refined: false, ..Self::new(potential, tolerance)? })
    }
    /// Where the deflection function is not smooth at an energy, ascending.
    pub fn edges(&self, energy: f64) -> Vec<Edge> {
        let known = self.closed.map(|closed| closed.edges(energy)).unwrap_or_default();
        let found = self.profile.as_ref().map(|profile| turning::edges(profile, energy)).unwrap_or_default();
        [known, found].concat()
    }
    /// Impact parameters, ascending, between which the deflection function of an energy is smooth where V has features that
    /// are narrow against their distance; none of most potentials.
    pub(in crate::scattering) fn bends(&self, energy: f64) -> Vec<f64> {
        self.profile.as_ref().map(|profile| profile.bends(energy)).unwrap_or_default()
    }
    /// Whether the angle falls so slowly with the impact parameter that even momentum transfer has no end.
    pub fn falls_as_inverse_distance(&self) -> bool {
        matches!(self.closed, Some(Closed::Coulomb(_)))
            || self.profile.as_ref().is_some_and(|profile| profile.endless_delay() != 0.0)
    }
    /// Beyond which there is no deflection; infinite for most.
    pub fn range(&self) -> f64 {
        let known = self.closed.map_or(f64::INFINITY, Closed::range);
        self.profile.as_ref().map_or(known, |profile| profile.range().min(known))
    }
    /// Whether V repels everywhere and is smooth, so that ψ falls with b all the way.
    pub(in crate::scattering) fn repels(&self) -> bool {
        self.profile.as_ref().is_some_and(Profile::repels)
    }
    /// Far out, the power n of V = k/rⁿ at a distance; NaN where nothing is left of V, or where another sum does without.
    pub(in crate::scattering) fn power_at(&self, r: f64) -> f64 {
        self.profile.as_ref().map_or(f64::NAN, |profile| profile.power_at(profile.take_length(r)))
    }
    /// Of what comes head-on, what part of its energy is left on the top of a hill at the center; none where there is no hill
    /// that can be passed.
    pub(in crate::scattering) fn left_on_top(&self, energy: f64) -> Option<f64> {
        let profile = self.profile.as_ref().filter(|_| self.closed.is_none())?;
        profile.top().map(|top| 1.0 - top / profile.take_energy(energy))
    }
    /// Refuses a table that begins beyond where what comes head-on with an energy turns.
    ///
    /// # Errors
    /// `InvalidInput` naming `potential`.
    pub(in crate::scattering) fn check_begins(&self, energy: f64) -> Result<()> {
        let check = |profile: &Profile| profile.check_start(profile.take_energy(energy), 0.0, [0.0; 2]);
        self.profile.as_ref().map_or(Ok(()), check)
    }
    /// How steeply 1 − b²/r² − V/E rises at a turning point, by the logarithm of r: by what part of itself a rounding of V
    /// moves that.
    pub(in crate::scattering) fn steepness(&self, energy: f64, b: f64, turning: f64) -> f64 {
        self.profile.as_ref().map_or(f64::NAN, |profile| profile.steepness(energy, b, turning))
    }
    /// The energies at which orbits begin or end to be: the extrema of V + r V′/2.
    pub fn critical_energies(&self) -> Vec<f64> {
        self.profile.as_ref().map(Profile::critical_energies).unwrap_or_default()
    }
    /// C/E of V = −C/r²: the square of the impact parameter below which all are captured, and just above which ψ grows as
    /// a power, so that the turns that lead to an angle have a sum of their own.
    pub(in crate::scattering) fn winds(&self, energy: f64) -> Option<f64> {
        self.closed.and_then(|closed| closed.winds(energy))
    }
    /// A length of which the impact parameters of an energy are multiples or parts: the potential's own or, if it has none
    /// (k/rⁿ), the one that it has at that energy.
    pub fn length(&self, energy: f64) -> f64 {
        let known = self.closed.map(|closed| closed.length(energy));
        let length =
            known.or_else(|| self.profile.as_ref().map(|profile| profile.length_at(energy))).unwrap_or(1.0);
        // Of no potential at all, and where a quotient leaves the range of numbers.
        if length.is_normal() { length } else { 1.0 }
    }
    /// Between which lengths the impact parameters of an energy matter: the one within which |V| is more than it, or that of
    /// [`length`](Self::length), and the one from which on V is a power of the distance, if that is farther.
    pub(in crate::scattering) fn lengths(&self, energy: f64) -> [f64; 2] {
        let length = self.length(energy);
        let normal = |r: f64| if r.is_normal() { r } else { length };
        let found = self.profile.as_ref().filter(|_| self.closed.is_none());
        found.map_or([length; 2], |profile| {
            let (reach, settled) = (normal(profile.reach_at(energy)), normal(profile.power_begins()));
            [reach.min(length), settled.max(length)]
        })
    }
    /// The deflections of pairs; derivatives and delays (else NaN) only if `all`. The bits of a pair do not depend on
    /// the others, nor on the number of threads.
    ///
    /// # Errors
    /// `InvalidInput` naming `potential` where a table ends before the motion does; `Interrupted`.
    pub fn deflect(
        &self,
        energy: &[f64],
        b: &[f64],
        all: bool,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Deflection>> {
        self.collected(energy, b, (all, true), |found| *found, threads, ticker)
    }
    /// As [`deflect`](Self::deflect), but what cannot be told, as what comes exactly onto the flat top of a barrier, is no
    /// number whose error is infinite.
    ///
    /// # Errors
    /// As [`deflect`](Self::deflect), but for a potential that changes too fast.
    pub(in crate::scattering) fn deflect_what_can_be_told(
        &self,
        (energy, b): (&[f64], &[f64]),
        all: bool,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Deflection>> {
        self.collected(energy, b, (all, false), |found| *found, threads, ticker)
    }
    /// Their angles; NaN if captured.
    ///
    /// # Errors
    /// As [`deflect`](Self::deflect).
    pub fn angles(
        &self,
        energy: &[f64],
        b: &[f64],
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<f64>> {
        self.collected(energy, b, (false, true), |found| found.angle, threads, ticker)
    }

    fn collected<T: Send + Copy>(
        &self,
        energy: &[f64],
        b: &[f64],
        how: (bool, bool),
        take: fn(&Deflection) -> T,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<T>> {
        let by = |deflector: &Self, energy: &[f64], b: &[f64], ticker: &mut Ticker<'_>| {
            deflector.collected_here(energy, b, how, take, threads, ticker)
        };
        match self.by_near_ones((energy, b), by, ticker)? {
            Some(found) => Ok(found),
            None => by(self, energy, b, ticker),
        }
    }

    fn collected_here<T: Send>(
        &self,
        energy: &[f64],
        b: &[f64],
        (all, strict): (bool, bool),
        take: fn(&Deflection) -> T,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<T>> {
        let pairs = energy.len().min(b.len());
        let chunks = pairs.div_ceil(CHUNK);
        let parts = for_chunks(threads, chunks, ticker, |chunk, ticker| {
            let range = chunk * CHUNK..pairs.min((chunk + 1) * CHUNK);
            let found = self.chunk(&energy[range.clone()], &b[range.clone()], (all, strict), ticker)?;
            ticker.advance(range.len() as u64);
            Ok(found.iter().map(take).collect::<Vec<T>>())
        })?;
        let mut all = Vec::with_capacity(pairs);
        all.extend(parts.into_iter().flatten());
        Ok(all)
    }

    fn chunk(
        &self,
        energy: &[f64],
        b: &[f64],
        (all, strict): (bool, bool),
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Deflection>> {
        let known = |closed: Closed| -> Vec<Deflection> {
            energy.iter().zip(b).map(|(energy, b)| closed.deflection(*energy, *b)).collect()
        };
        let (Some(profile), false) = (&self.profile, self.closed.is_some() && !all) else {
            return Ok(self.closed.map(known).unwrap_or_default());
        };
        let mut found = Quadrature { profile, tolerance: self.tolerance, refined: self.refined, all, strict }
            .deflections(energy, b, ticker)?;
        if let Some(closed) = self.closed {
            for (found, known) in found.iter_mut().zip(known(closed)) {
                *found = Deflection { derivative: found.derivative, delay: found.delay, ..known };
            }
        }
        Ok(found)
    }
}
