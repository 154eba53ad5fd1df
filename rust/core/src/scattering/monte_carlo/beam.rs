//! A beam on a disc around one target: what an impact parameter leads to.

use super::draws::{Draws, PLACE};
use super::profile::{Direction, Profile};
use super::quantity::Quantity;
use crate::numerics::lanes::WIDTH;
use crate::numerics::philox::DRAW_BITS;
use crate::parallel::Ticker;
use crate::potentials::Potential;
use crate::scattering::bins::Bins;
use crate::scattering::deflection::{Deflection, Deflector, Status};
use crate::scattering::event_table::{Energies, EventTable, TOLERANCE};
use crate::scattering::histogram::Edges;
use crate::scattering::kinematics::{Collision, HalfAngle};
use crate::scattering::reach::Limits;
use crate::scattering::rutherford::half_distance;
use crate::words::number;
use crate::{Error, Result};
use core::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// A draw as a fraction: 2^-53.
pub(super) const UNIT: f64 = 1.0 / (1_u64 << DRAW_BITS) as f64;
/// Impact parameters beyond the disc that are tried, out to a thousand of its radii.
const BEYOND: i32 = 240;
/// A part of the largest angle that no other is meant to follow.
const NOTHING: f64 = 1e-6;
/// Points of a piece of a table among which turning points are looked for.
const TRIED: u64 = 8;

/// What a projectile meets.
#[derive(Clone, Debug, PartialEq)]
enum Target {
    /// V = k/r: b_max/|κ|, the largest cot(ψ/2), and whether ψ is negative.
    Coulomb { reach: f64, attracts: bool },
    /// Anything else: its table, and the largest |ψ| in [0, π] beyond the disc.
    Table(Arc<EventTable>, f64),
    /// The same of a spread of energies, and the largest of both ends and the middle.
    Tables(Arc<Energies>, f64),
}

/// How one projectile comes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arrival {
    pub(super) energy: f64,
    /// b²/b_max².
    pub(super) share: f64,
    pub(super) direction: Direction,
}

/// A beam on a disc around a centre that is free to recoil.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    pub(super) collision: Collision,
    energy: f64,
    pub(super) b_max: f64,
    target: Target,
    pub(in crate::scattering) profile: Profile,
}

impl Beam {
    /// On any potential; `energy` is the projectile's in the laboratory, `masses` projectile and target. Of V = k/r as
    /// [`coulomb`](Self::coulomb), of any other the table is built, or those of a spread of energies.
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
        let deflector = Deflector::new(potential, TOLERANCE)?;
        let target = if profile.energy_spread.is_none() {
            let relative = energy * share;
            let table = EventTable::build(&deflector, relative, b_max, threads, ticker)?;
            Target::Table(Arc::new(table), largest_beyond(&deflector, relative, b_max, threads, ticker)?)
        } else {
            let tables = Energies::build(&deflector, relative, b_max, threads, ticker)?;
            let mut beyond = 0.0_f64;
            for energy in [relative[0], energy * share, relative[1]] {
                beyond = beyond.max(largest_beyond(&deflector, energy, b_max, threads, ticker)?);
            }
            Target::Tables(Arc::new(tables), beyond)
        };
        Ok(Self { collision, energy, b_max, target, profile })
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
        Ok(Self {
            collision,
            energy,
            b_max,
            target: Target::Coulomb { reach, attracts: k < 0.0 },
            profile: Profile::default(),
        })
    }
    /// Of the projectile, in the laboratory.
    pub fn energy(&self) -> f64 {
        self.energy
    }
    /// The greatest energy of a projectile.
    pub fn highest(&self) -> f64 {
        self.profile.energies(self.energy)[1]
    }
    /// b²/b_max² within which is that part of the projectiles.
    pub(super) fn share(&self, part: f64) -> f64 {
        self.profile.share(self.b_max, part)
    }
    /// How an event comes.
    pub(super) fn arrival(&self, draws: Draws) -> Arrival {
        Arrival {
            energy: self.profile.energy(self.energy, draws),
            share: self.share(draws.uniform(PLACE)),
            direction: self.profile.direction(draws),
        }
    }
    /// One of the middle energy along the axis.
    fn straight(&self, share: f64) -> Arrival {
        Arrival { energy: self.energy, share, direction: Direction { tilt: 0.0, azimuth: 0.0 } }
    }
    /// ψ of an event: signed and not folded; nothing if captured.
    pub(super) fn deflection(&self, arrival: &Arrival) -> Option<f64> {
        let (part, energy) = (arrival.share.sqrt(), arrival.energy);
        match &self.target {
            Target::Coulomb { reach, attracts } => {
                let size = HalfAngle::from_cotangent(reach * (energy / self.energy) * part).cm_angle();
                Some(if *attracts { -size } else { size })
            }
            Target::Table(table, _) => table.angle(part),
            Target::Tables(tables, _) => tables.angle(energy * self.collision.relative_share(), part),
        }
    }
    /// The tables of a target that is no Coulomb center.
    pub fn tables(&self) -> Vec<&EventTable> {
        match &self.target {
            Target::Coulomb { .. } => Vec::new(),
            Target::Table(table, _) => vec![table],
            Target::Tables(tables, _) => tables.tables().collect(),
        }
    }
    /// Half the angle of an event; nothing if captured.
    pub(super) fn half_angle(&self, arrival: &Arrival) -> Option<HalfAngle> {
        if let Target::Coulomb { reach, .. } = &self.target {
            let cotangent = reach * (arrival.energy / self.energy) * arrival.share.sqrt();
            return Some(HalfAngle::from_cotangent(cotangent));
        }
        self.deflection(arrival).map(|angle| HalfAngle::of(folded(angle)))
    }
    /// Of half an angle, along the axis.
    fn value_of(&self, quantity: Quantity, energy: f64, half: HalfAngle) -> f64 {
        match quantity {
            Quantity::CmAngle => half.cm_angle(),
            Quantity::LabAngle => self.collision.lab_angle(half),
            Quantity::RecoilAngle => half.recoil_angle(),
            Quantity::Energy => energy * self.collision.kept(half),
            Quantity::RecoilEnergy => energy * self.collision.transferred(half),
            Quantity::ImpactParameter => f64::NAN,
        }
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
        let value = self.value_of(quantity, arrival.energy, half?);
        Some(match quantity {
            Quantity::LabAngle => arrival.direction.turned(value, false),
            Quantity::RecoilAngle => arrival.direction.turned(value, true),
            _ => value,
        })
    }
    /// The value of a quantity at the middle energy when b² is the fraction `share` of b_max²; nothing of a captured one
    /// but where it came.
    pub fn value(&self, quantity: Quantity, share: f64) -> Option<f64> {
        let arrival = self.straight(share);
        let half = if quantity == Quantity::ImpactParameter { None } else { self.half_angle(&arrival) };
        self.value_at(quantity, &arrival, half)
    }
    /// Whether a quantity is a function of one draw.
    pub(super) fn is_of_one_draw(&self, quantity: Quantity) -> bool {
        let turned = matches!(quantity, Quantity::LabAngle | Quantity::RecoilAngle);
        match quantity {
            Quantity::ImpactParameter => true,
            _ => self.profile.energy_spread.is_none() && !(turned && self.profile.divergence.is_some()),
        }
    }
    /// The numbers that edges of a quantity may be, and what they are called.
    pub(in crate::scattering) fn limits(&self, quantity: Quantity) -> Limits {
        match quantity {
            Quantity::CmAngle | Quantity::LabAngle => Limits::angles("π", PI),
            Quantity::RecoilAngle if self.profile.divergence.is_some() => Limits::angles("π", PI),
            Quantity::RecoilAngle => Limits::angles("π/2", FRAC_PI_2),
            Quantity::Energy | Quantity::RecoilEnergy => Limits::upto("beam_energy", self.highest()),
            // Beyond the disc no bin could count anything.
            Quantity::ImpactParameter => Limits::upto("b_max", self.b_max),
        }
    }
    /// Bins of a quantity.
    ///
    /// # Errors
    /// `InvalidInput` naming the quantity, for what are no bins and for edges that it can never reach; or what makes the
    /// greatest value too small to divide.
    pub fn edges(&self, quantity: Quantity, bins: &Bins) -> Result<Edges> {
        let (blamed, high) = self.greatest(quantity);
        if let Bins::Count(bins) = bins
            && high / (*bins as f64) < f64::MIN_POSITIVE
        {
            return Err(Error::invalid(
                blamed,
                format!(
                    "expected a greatest {} that can be divided into bins, got {}; choose larger units, or \
                     leave this tally out",
                    quantity.name(),
                    number(high)
                ),
            ));
        }
        let edges = bins.edges(quantity.name(), quantity.is_angle(), high)?;
        self.limits(quantity).check(quantity.name(), edges.values())?;
        Ok(edges)
    }
    /// The greatest value that a quantity can have, and what is to blame if it is none.
    fn greatest(&self, quantity: Quantity) -> (&'static str, f64) {
        match quantity {
            Quantity::CmAngle | Quantity::LabAngle => ("bins", PI),
            Quantity::RecoilAngle if self.profile.divergence.is_some() => ("bins", PI),
            Quantity::RecoilAngle => ("bins", FRAC_PI_2),
            Quantity::Energy => ("beam_energy", self.highest()),
            Quantity::RecoilEnergy => {
                ("masses", self.highest() * self.collision.transferred(HalfAngle::from_cotangent(0.0)))
            }
            Quantity::ImpactParameter => ("b_max", self.b_max),
        }
    }
    /// Half of an angle that no impact parameter beyond the disc exceeds, at any energy of the spread.
    pub(super) fn edge(&self) -> HalfAngle {
        let [least, _] = self.profile.energies(self.energy);
        match &self.target {
            Target::Coulomb { reach, .. } => HalfAngle::from_cotangent(reach * (least / self.energy)),
            Target::Table(_, beyond) | Target::Tables(_, beyond) => HalfAngle::of(*beyond),
        }
    }
    /// The deflection at the edge of the disc, or the greatest beyond: of V = k/r no event is scattered by less.
    pub fn smallest_angle(&self) -> f64 {
        if let (Target::Coulomb { reach, .. }, [_, highest]) =
            (&self.target, self.profile.energies(self.energy))
        {
            return HalfAngle::from_cotangent(reach * (highest / self.energy)).cm_angle();
        }
        self.edge().cm_angle()
    }
    /// The values of a quantity that no impact parameter beyond the disc leads to: what this beam counts there
    /// is all that there is. None of an angle that the directions of a beam smear, and none where the disc is not filled
    /// evenly.
    pub fn covered(&self, quantity: Quantity) -> (f64, f64) {
        let smeared = self.profile.divergence.is_some()
            && matches!(quantity, Quantity::LabAngle | Quantity::RecoilAngle);
        if smeared || self.profile.spot.is_some() {
            return (0.0, 0.0);
        }
        let [least, highest] = self.profile.energies(self.energy);
        let half = self.edge();
        match quantity {
            Quantity::CmAngle => (self.value_of(quantity, least, half), PI),
            // Of a heavy projectile the angle first grows with b: a disc that ends before its greatest covers nothing
            // below that.
            Quantity::LabAngle => {
                let reach = half.cotangent();
                let greatest = self.collision.turning_point().filter(|turning| *turning > reach);
                let from = |t| self.collision.lab_angle(HalfAngle::from_cotangent(t));
                (greatest.map_or_else(|| self.collision.lab_angle(half), from), PI)
            }
            Quantity::RecoilAngle | Quantity::Energy => (0.0, self.value_of(quantity, least, half)),
            // The most that is lost beyond the disc, at any energy.
            Quantity::RecoilEnergy => (self.value_of(quantity, highest, half), highest),
            Quantity::ImpactParameter => (0.0, self.b_max),
        }
    }
    /// Whether two impact parameters lead to one value: a heavy projectile's laboratory angle.
    pub fn two_branches(&self, quantity: Quantity) -> bool {
        quantity == Quantity::LabAngle && self.collision.turning_point().is_some()
    }
    /// The draws between which a quantity rises or falls: those at which it may turn.
    pub(super) fn turning_draws(&self, quantity: Quantity) -> Vec<u64> {
        match &self.target {
            Target::Coulomb { reach, .. } => (quantity == Quantity::LabAngle)
                .then(|| self.collision.turning_point())
                .flatten()
                .map(|t| (t / reach) * (t / reach))
                .filter(|share| *share < 1.0)
                .map(|share| (self.profile.part(self.b_max, share) * UNIT.recip()) as u64)
                .into_iter()
                .collect(),
            Target::Table(..) if quantity == Quantity::ImpactParameter => Vec::new(),
            Target::Table(table, _) => self.turns(quantity, table),
            // No step function is made of what has several draws.
            Target::Tables(..) => Vec::new(),
        }
    }
    /// Those of a table: the ends of its pieces, and within a piece where what is tried rises and falls.
    fn turns(&self, quantity: Quantity, table: &EventTable) -> Vec<u64> {
        let at = |draw: u64| self.value(quantity, self.share(draw as f64 * UNIT));
        let draw = |part: &f64| (self.profile.part(self.b_max, part * part) / UNIT) as u64;
        let draws: Vec<u64> = table.starts().iter().map(draw).collect();
        let mut turns = draws.clone();
        for pair in draws.windows(2).filter(|pair| pair[1] - pair[0] > TRIED) {
            let width = pair[1] - pair[0];
            let tried: Vec<u64> = (0..=TRIED)
                .map(|i| pair[0] + (u128::from(width) * u128::from(i) / u128::from(TRIED)) as u64)
                .collect();
            for three in tried.windows(3) {
                let [Some(first), Some(middle), Some(last)] = [at(three[0]), at(three[1]), at(three[2])]
                else {
                    continue;
                };
                if (middle - first) * (last - middle) < 0.0 {
                    turns.push(extremum(&at, three[0], three[2], middle > first));
                }
            }
        }
        turns
    }
}

/// Where a function with one maximum (or minimum) between two draws has it.
fn extremum(at: &impl Fn(u64) -> Option<f64>, from: u64, to: u64, maximum: bool) -> u64 {
    let (mut from, mut to) = (from, to);
    let sign = if maximum { 1.0 } else { -1.0 };
    let value = |draw| at(draw).map_or(f64::NEG_INFINITY, |value| sign * value);
    while to - from > 2 {
        let third = (to - from) / 3;
        let (left, right) = (from + third, to - third);
        if value(left) < value(right) { from = left } else { to = right }
    }
    from + 1
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

/// The largest |ψ| of impact parameters beyond the disc, at most π: a little more where it is not at the disc's edge, as
/// it lies between points that were tried.
fn largest_beyond(
    deflector: &Deflector,
    energy: f64,
    b_max: f64,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<f64> {
    // Steps of 1.0002 at first, of 1.06 at the end.
    let part = |i: i32| 1.0 + (f64::from(i) / f64::from(BEYOND)).powi(3) * 999.0;
    let size = |found: &Deflection| if found.status == Status::Captured { PI } else { found.angle.abs() };
    let (mut edge, mut largest) = (None, 0.0_f64);
    for first in (0..=BEYOND).step_by(WIDTH) {
        let b: Vec<f64> =
            (first..first + WIDTH as i32).map(|i| b_max * part(i)).filter(|b| b.is_finite()).collect();
        let found = deflector.deflect(&vec![energy; b.len()], &b, false, threads, ticker)?;
        let here = found.iter().map(size).fold(0.0, f64::max);
        largest = largest.max(here);
        edge = edge.or(found.first().map(size));
        // So far out that nothing turns any more: of short range it has no other zone beyond.
        if here <= NOTHING * largest {
            break;
        }
    }
    let edge = edge.unwrap_or(PI);
    Ok(if largest <= edge { edge.min(PI) } else { (1.05 * largest).min(PI) })
}
