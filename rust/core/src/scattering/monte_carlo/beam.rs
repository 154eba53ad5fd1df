//! A beam on a disc around one target: what an impact parameter leads to.

mod beyond;
mod direct;
mod range;
mod turning;

use super::abreast::Meeting;
use super::channels::{Channels, Exit};
use super::draws::{CHANNEL, Draws, PLACE};
use super::profile::{Direction, Profile};
use super::quantity::Quantity;
use super::strata::Strata;
use crate::numerics::philox::DRAW_BITS;
use crate::parallel::Ticker;
use crate::potentials::Potential;
use crate::scattering::deflection::Deflector;
use crate::scattering::event_table::{Energies, EnergiesAbreast, EventTable, TOLERANCE, TableAbreast};
use crate::scattering::kinematics::{Collision, HalfAngle};
use crate::scattering::rutherford::half_distance;
use crate::words::number;
use crate::{Error, Result};
use beyond::largest_beyond;
use core::f64::consts::PI;
use direct::Direct;
use std::sync::Arc;

/// A draw as a fraction: 2^-53.
pub(super) const UNIT: f64 = 1.0 / (1_u64 << DRAW_BITS) as f64;

/// What a projectile meets.
#[derive(Clone, Debug, PartialEq)]
enum Target {
    /// V = k/r: b_max/|κ|, the largest cot(ψ/2), and whether ψ is negative.
    Coulomb { reach: f64, attracts: bool },
    /// Anything else: its table, and the largest |ψ| in [0, π] beyond the disc.
    Table(Arc<EventTable>, f64),
    /// The same of a spread of energies, and the largest of both ends and the middle.
    Tables(Arc<Energies>, f64),
    /// Where ψ is not smooth in those: found for each event.
    Direct(Direct, f64),
}

/// How one projectile comes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arrival {
    pub(super) energy: f64,
    /// b²/b_max².
    pub(super) share: f64,
    /// Its stratum of the disc: 0 where there are none.
    pub(super) stratum: usize,
    pub(super) direction: Direction,
    /// Which of the channels that have events.
    pub(super) exit: usize,
}

/// A beam on a disc around a centre that is free to recoil.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    pub(super) collision: Collision,
    energy: f64,
    pub(super) b_max: f64,
    target: Target,
    pub(in crate::scattering) profile: Profile,
    strata: Option<Arc<Strata>>,
    channels: Arc<Channels>,
    /// What is left by each channel that has events.
    exits: Arc<[Exit]>,
    /// Whether the disc is just what turns anything: it ends where V does.
    whole: bool,
}

impl Beam {
    /// On any potential; `energy` is the projectile's in the laboratory, `masses` projectile and target. Of V = k/r as
    /// [`coulomb`](Self::coulomb), of any other the table is built, or those of a spread of energies if they tell its deflections.
    ///
    /// # Errors
    /// `InvalidInput` naming what is not positive and finite, a profile that cannot be, and as [`EventTable::build`] and
    /// [`Energies::build`]; `Interrupted`.
    pub fn new(
        potential: &Arc<dyn Potential>,
        energy: f64,
        masses: (f64, f64),
        b_max: f64,
        profile: Profile,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let collision = checked(energy, masses, b_max)?;
        profile.check(energy, b_max)?;
        if let Some(k) = potential.inverse_distance_strength() {
            return Ok(Self { profile, ..Self::coulomb(k, energy, masses, b_max)? });
        }
        let share = collision.relative_share();
        let relative = profile.energies(energy).map(|energy| energy * share);
        if relative[0] <= 0.0 || relative[0].is_nan() {
            return Err(Error::invalid(
                "masses",
                "expected a target that takes part in the motion, got too light a one",
            ));
        }
        let deflector = Deflector::for_table(potential, TOLERANCE)?;
        let range = deflector.range();
        let target = if profile.energy_spread.is_none() {
            let relative = energy * share;
            let table = EventTable::build(&deflector, relative, b_max, threads, ticker)?;
            Target::Table(Arc::new(table), largest_beyond(&deflector, relative, b_max, threads, ticker)?)
        } else {
            let mut beyond = 0.0_f64;
            for energy in [relative[0], energy * share, relative[1]] {
                beyond = beyond.max(largest_beyond(&deflector, energy, b_max, threads, ticker)?);
            }
            match Energies::build(&deflector, relative, b_max, threads, ticker)? {
                Some(tables) => Target::Tables(Arc::new(tables), beyond),
                None => {
                    let deflector = Deflector::new(potential, TOLERANCE)?;
                    Target::Direct(Direct::new(deflector, relative, b_max, threads, ticker)?, beyond)
                }
            }
        };
        // Where V ends as it is rounded is where the disc does.
        let whole = (range - b_max).abs() <= 2.0 * f64::EPSILON * b_max;
        Ok(Self { target, profile, whole, ..Self::bare(collision, energy, b_max) })
    }
    /// On V = k/r.
    ///
    /// # Errors
    /// `InvalidInput` naming what is not positive and finite, or `b_max` if the distance k/2E is not
    /// within 150 decades of it.
    pub fn coulomb(k: f64, energy: f64, masses: (f64, f64), b_max: f64) -> Result<Self> {
        if !(k.is_finite() && k != 0.0) {
            return Err(Error::invalid(
                "potential",
                format!("expected a finite k other than 0, got k = {}", number(k)),
            ));
        }
        let collision = checked(energy, masses, b_max)?;
        let half_distance = half_distance(k, energy * collision.relative_share()).abs();
        let reach = b_max / half_distance;
        if !(1e-150..=1e150).contains(&reach) {
            return Err(Error::invalid(
                "b_max",
                format!(
                    "expected a length within 150 decades of |k|/(2 E) = {}, E the energy of \
                     relative motion, got {}",
                    number(half_distance),
                    number(b_max)
                ),
            ));
        }
        let target = Target::Coulomb { reach, attracts: k < 0.0 };
        Ok(Self { target, ..Self::bare(collision, energy, b_max) })
    }
    /// On a target that is still to be told, in one elastic channel.
    fn bare(collision: Collision, energy: f64, b_max: f64) -> Self {
        Self {
            collision,
            energy,
            b_max,
            target: Target::Coulomb { reach: 1.0, attracts: false },
            profile: Profile::default(),
            strata: None,
            channels: Arc::new(Channels::elastic()),
            exits: Arc::new([Exit::Elastic(collision)]),
            whole: false,
        }
    }
    /// Of the projectile, in the laboratory.
    pub fn energy(&self) -> f64 {
        self.energy
    }
    /// The greatest energy of a projectile.
    pub fn highest(&self) -> f64 {
        self.profile.energies(self.energy)[1]
    }
    /// The same beam with events in each stratum of the disc as it says.
    ///
    /// # Errors
    /// `InvalidInput` naming `importance` that ends elsewhere than the disc, or that a spot leaves no place.
    pub(super) fn stratified(self, strata: &Arc<Strata>) -> Result<Self> {
        if self.profile.spot.is_some() {
            let message =
                "expected none beside a spot, which says itself where projectiles come; leave either out";
            return Err(Error::invalid("importance", message));
        }
        if strata.b_max() != self.b_max {
            let (end, b_max) = (number(strata.b_max()), number(self.b_max));
            return Err(Error::invalid(
                "importance",
                format!("expected strata that end at b_max = {b_max}, got some that end at {end}"),
            ));
        }
        Ok(Self { strata: Some(strata.clone()), ..self })
    }
    /// Refuses channels that a beam cannot have, before its table is built.
    ///
    /// # Errors
    /// As [`new`](Self::new) and [`through`](Self::through).
    pub(super) fn check(
        channels: &Channels,
        energy: f64,
        masses: (f64, f64),
        b_max: f64,
        profile: &Profile,
    ) -> Result<()> {
        let collision = checked(energy, masses, b_max)?;
        profile.check(energy, b_max)?;
        Self::told(channels, energy, profile).exits(collision, energy, profile.energies(energy)).map(|_| ())
    }
    /// The same beam whose events go through channels.
    ///
    /// # Errors
    /// `InvalidInput` naming `channels` of which one is closed at its least energy.
    pub(super) fn through(self, channels: &Channels) -> Result<Self> {
        let channels = Self::told(channels, self.energy, &self.profile);
        let exits = channels.exits(self.collision, self.energy, self.profile.energies(self.energy))?;
        Ok(Self { channels: Arc::new(channels), exits, ..self })
    }
    /// Channels with the energy told, if all events have one.
    fn told(channels: &Channels, energy: f64, profile: &Profile) -> Channels {
        if profile.energy_spread.is_some() { channels.clone() } else { channels.at_energy(energy) }
    }
    /// Its channels.
    pub(super) fn channels(&self) -> &Channels {
        &self.channels
    }
    /// Its strata, if it has any.
    pub(super) fn strata(&self) -> Option<&Strata> {
        self.strata.as_deref()
    }
    /// b²/b_max² of a draw of the place.
    pub(super) fn share(&self, draw: u64) -> f64 {
        self.strata()
            .map_or_else(|| self.profile.share(self.b_max, draw as f64 * UNIT), |strata| strata.share(draw))
    }
    /// The draw of the place at that b²/b_max².
    pub(super) fn draw(&self, share: f64) -> u64 {
        self.strata().map_or_else(
            || (self.profile.part(self.b_max, share) * UNIT.recip()) as u64,
            |strata| strata.draw(share),
        )
    }
    /// The stratum of a draw of the place.
    pub(super) fn stratum(&self, draw: u64) -> usize {
        self.strata().map_or(0, |strata| strata.stratum(draw))
    }
    /// How an event comes.
    pub(super) fn arrival(&self, draws: Draws) -> Arrival {
        let place = draws.bits(PLACE);
        let share = self.share(place);
        let (b, energy) = (self.b_max * share.sqrt(), self.profile.energy(self.energy, draws));
        Arrival {
            energy,
            share,
            stratum: self.stratum(place),
            direction: self.profile.direction(draws),
            exit: if self.exits.len() > 1 { self.channels.find(draws.bits(CHANNEL), b, energy) } else { 0 },
        }
    }
    /// One of the middle energy along the axis.
    pub(super) fn straight(&self, exit: usize, share: f64) -> Arrival {
        let direction = Direction { tilt: 0.0, azimuth: 0.0 };
        Arrival { energy: self.energy, share, stratum: 0, direction, exit }
    }
    /// Whether deflections are found event by event.
    pub(super) fn is_direct(&self) -> bool {
        matches!(self.target, Target::Direct(..))
    }
    /// ψ of events: signed and not folded; nothing of captured ones.
    ///
    /// # Errors
    /// As [`Deflector::deflect`].
    pub(super) fn deflections(
        &self,
        arrivals: &[Arrival],
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Option<f64>>> {
        let Target::Direct(direct, _) = &self.target else {
            return Ok(arrivals.iter().map(|arrival| self.deflection(arrival)).collect());
        };
        let share = self.collision.relative_share();
        let energies: Vec<f64> = arrivals.iter().map(|arrival| arrival.energy * share).collect();
        direct.angles(&energies, arrivals.iter().map(|arrival| arrival.share.sqrt()), ticker)
    }
    /// ψ of an event: signed and not folded; nothing if captured, or if only [`deflections`](Self::deflections) tells it.
    fn deflection(&self, arrival: &Arrival) -> Option<f64> {
        let (part, energy) = (arrival.share.sqrt(), arrival.energy);
        match &self.target {
            Target::Coulomb { reach, attracts } => {
                let size = HalfAngle::from_cotangent(reach * (energy / self.energy) * part).cm_angle();
                Some(if *attracts { -size } else { size })
            }
            Target::Table(table, _) => table.angle(part),
            Target::Tables(tables, _) => tables.angle(energy * self.collision.relative_share(), part),
            Target::Direct(..) => None,
        }
    }
    /// The tables of a target that has some.
    pub fn tables(&self) -> Vec<&EventTable> {
        match &self.target {
            Target::Coulomb { .. } | Target::Direct(..) => Vec::new(),
            Target::Table(table, _) => vec![table],
            Target::Tables(tables, _) => tables.tables().collect(),
        }
    }
    /// Half the angle of an event; nothing if captured.
    pub(super) fn half_angle(&self, arrival: &Arrival) -> Option<HalfAngle> {
        let angle = if self.is_coulomb() { None } else { self.deflection(arrival) };
        self.half_of(arrival, angle)
    }
    /// Half the angle of an event with that ψ.
    pub(super) fn half_of(&self, arrival: &Arrival, angle: Option<f64>) -> Option<HalfAngle> {
        if let Target::Coulomb { reach, .. } = &self.target {
            let cotangent = reach * (arrival.energy / self.energy) * arrival.share.sqrt();
            return Some(HalfAngle::from_cotangent(cotangent));
        }
        angle.map(|angle| HalfAngle::of(folded(angle)))
    }
    fn is_coulomb(&self) -> bool {
        matches!(self.target, Target::Coulomb { .. })
    }
    /// The value of a quantity of an event with that half of an angle; nothing of a captured one but where it came.
    pub(super) fn value_at(
        &self,
        quantity: Quantity,
        arrival: &Arrival,
        half: Option<HalfAngle>,
    ) -> Option<f64> {
        if quantity == Quantity::ImpactParameter {
            return Some(self.b_max * arrival.share.sqrt());
        }
        let half = half?;
        let value = self.exits.get(arrival.exit)?.value(quantity, arrival.energy, half);
        Some(match quantity {
            Quantity::LabAngle => arrival.direction.turned(value, false),
            Quantity::RecoilAngle => arrival.direction.turned(value, true),
            _ => value,
        })
    }
    /// Its collision, if it has no channel but the elastic one.
    pub(super) fn elastic(&self) -> Option<Collision> {
        if let [Exit::Elastic(collision)] = *self.exits { Some(collision) } else { None }
    }
    /// What eight of its events meet at once; nothing where deflections are found one by one.
    pub(super) fn meeting(&self) -> Option<Meeting> {
        match &self.target {
            Target::Coulomb { reach, .. } => Some(Meeting::Coulomb(reach / self.energy)),
            Target::Table(table, _) => Some(Meeting::Table(TableAbreast::new(table))),
            Target::Tables(tables, _) => Some(Meeting::Tables(EnergiesAbreast::new(tables))),
            Target::Direct(..) => None,
        }
    }
    /// Whether a quantity is a function of one draw.
    pub(super) fn is_of_one_draw(&self, quantity: Quantity) -> bool {
        let turned = quantity.is_of_directions();
        match quantity {
            Quantity::ImpactParameter => true,
            _ if quantity.is_of_channel() && self.channels.vary() => false,
            _ => self.profile.energy_spread.is_none() && !(turned && self.profile.divergence.is_some()),
        }
    }
}

/// |ψ| of a signed angle with any number of whole turns, in [0, π].
pub(super) fn folded(angle: f64) -> f64 {
    let size = angle.abs();
    if size <= PI {
        return size;
    }
    let rest = size % (2.0 * PI);
    if rest > PI { 2.0 * PI - rest } else { rest }
}

fn checked(energy: f64, masses: (f64, f64), b_max: f64) -> Result<Collision> {
    for (name, value) in [("beam_energy", energy), ("b_max", b_max)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::invalid(
                name,
                format!("expected a positive finite number, got {}", number(value)),
            ));
        }
    }
    Collision::new(masses.0, masses.1)
}
