//! The deflection function ψ(E, b) of any central potential, and what comes with it.
//!
//! The one idea: ψ is an integral over the way out from the outermost turning point, which a bracketed method finds
//! (`profile`, `turning`) and which is divided out of the integrand, so that equal steps in w, r = r₀ cosh w, converge
//! as powers of their number, small angles keep their digits, and so does what is missing to π head-on (`trapezoid`,
//! eight pairs side by side). Beside barriers, at edges of V, and where what is left is small against what cancels,
//! intervals are halved where they must be (`adaptive`). Some potentials have closed forms (`closed`).
//! Sources: Landau & Lifshitz, *Mechanics*, §18; L. N. Trefethen, J. A. C. Weideman, SIAM Rev. 56 (2014) 385.

mod adaptive;
pub(super) use adaptive::RULE as KRONROD;
mod closed;
mod nodes;
mod profile;
mod trapezoid;
mod turning;

use crate::numerics::lanes::{Lanes, WIDTH};
use crate::parallel::{Ticker, for_chunks};
use crate::potentials::Potential;
use crate::words::number;
use crate::{Error, Result};
use adaptive::{Integrand, Pair};
use closed::Closed;
use core::f64::consts::PI;
use profile::Profile;
use std::sync::Arc;
use trapezoid::{Comparison, Pack};
use turning::{Critical, Way};

/// The tolerance if none is asked for: of an angle, relative to what was added up to it.
pub const TOLERANCE: f64 = 1e-12;
/// What can be asked for.
pub const TOLERANCES: core::ops::RangeInclusive<f64> = 1e-13..=1e-3;
/// Pairs of a chunk.
const CHUNK: usize = 256;
/// As a part of b: nearer to orbiting, four digits and more of b or E are lost in the angle.
const NEAR_ORBITING: f64 = 1e-4;
/// What rounding leaves of the distance to a barrier, as a part of b.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// And here equal steps would be many.
const NEAR_BARRIER: f64 = 0.003;
/// An angle of less than this part of what cancels in it is found as a sum of small turns.
const CANCELLED: f64 = 0.05;
/// An impact parameter that stands for zero at an open center, in units of the potential's own length.
const TINY: f64 = 1.0 / (1 << 26) as f64;

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
        if profile.as_ref().is_some_and(|profile| !profile.vanishes()) {
            return Err(Error::invalid(
                "potential",
                "expected one that goes to 0 as r goes to infinity; nothing scatters off one that does not",
            ));
        }
        Ok(Self { profile, closed, tolerance })
    }
    /// Where the deflection function is not smooth at an energy, ascending.
    pub fn edges(&self, energy: f64) -> Vec<Edge> {
        let known = self.closed.map(|closed| closed.edges(energy)).unwrap_or_default();
        let found = self.profile.as_ref().map(|profile| turning::edges(profile, energy)).unwrap_or_default();
        [known, found].concat()
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
    /// The energies at which orbits begin or end to be: the extrema of V + r V′/2.
    pub fn critical_energies(&self) -> Vec<f64> {
        self.profile.as_ref().map(Profile::critical_energies).unwrap_or_default()
    }
    /// A length of the potential's own, of which impact parameters are multiples or parts.
    pub fn length(&self) -> f64 {
        self.profile.as_ref().map_or(1.0, |profile| profile.give_length(1.0))
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
        let pairs = energy.len().min(b.len());
        let chunks = pairs.div_ceil(CHUNK);
        let parts = for_chunks(threads, chunks, ticker, |chunk, ticker| {
            let range = chunk * CHUNK..pairs.min((chunk + 1) * CHUNK);
            let found = self.chunk(&energy[range.clone()], &b[range.clone()], all, ticker)?;
            ticker.advance(range.len() as u64);
            Ok(found)
        })?;
        Ok(parts.into_iter().flatten().collect())
    }

    fn chunk(
        &self,
        energy: &[f64],
        b: &[f64],
        all: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Deflection>> {
        let known = |closed: Closed| -> Vec<Deflection> {
            energy.iter().zip(b).map(|(energy, b)| closed.deflection(*energy, *b)).collect()
        };
        let (Some(profile), false) = (&self.profile, self.closed.is_some() && !all) else {
            return Ok(self.closed.map(known).unwrap_or_default());
        };
        let mut found =
            Quadrature { profile, tolerance: self.tolerance, all }.deflections(energy, b, ticker)?;
        if let Some(closed) = self.closed {
            for (found, known) in found.iter_mut().zip(known(closed)) {
                *found = Deflection { derivative: found.derivative, delay: found.delay, ..known };
            }
        }
        Ok(found)
    }
}

/// Pairs by quadrature.
struct Quadrature<'a> {
    profile: &'a Profile,
    tolerance: f64,
    all: bool,
}

/// A pair that turns, in units of the profile.
struct Turning {
    place: usize,
    energy: f64,
    b: f64,
    bracket: [f64; 2],
    barriers: Vec<f64>,
}

impl Quadrature<'_> {
    fn deflections(&self, energy: &[f64], b: &[f64], ticker: &mut Ticker<'_>) -> Result<Vec<Deflection>> {
        let profile = self.profile;
        let mut critical = Critical::default();
        let mut found = vec![Deflection::captured(); energy.len()];
        let mut turning: Vec<Turning> = Vec::new();
        for place in 0..energy.len() {
            ticker.tick()?;
            let (e, mut b) = (profile.take_energy(energy[place]), profile.take_length(b[place]));
            profile.check_end(e, self.tolerance)?;
            let mut way = critical.way(profile, e, b);
            found[place].turning_points = critical.turning_points(profile, e, b);
            if matches!(way, Way::Through | Way::Bounces(_)) {
                b = TINY;
                way = critical.way(profile, e, b);
            }
            if let Way::Turns { bracket, barriers } = way {
                profile.check_start(e, b, bracket)?;
                turning.push(Turning { place, energy: e, b, bracket, barriers });
            }
        }
        for group in turning.chunks(WIDTH) {
            ticker.tick()?;
            self.group(group, &mut found);
        }
        for (place, found) in found.iter_mut().enumerate() {
            if b[place] == 0.0 && found.status != Status::Captured {
                self.head_on(profile.take_energy(energy[place]), found);
            }
            found.closest_approach = profile.give_length(found.closest_approach);
            found.delay = profile.give_length(found.delay);
            // 1/length: the inverse of the unit.
            found.derivative = profile.take_length(found.derivative);
        }
        Ok(found)
    }

    /// Up to eight pairs.
    fn group(&self, group: &[Turning], found: &mut [Deflection]) {
        let profile = self.profile;
        let lanes = |of: &dyn Fn(&Turning) -> f64| {
            Lanes(core::array::from_fn(|lane| of(&group[lane.min(group.len() - 1)])))
        };
        let (energy, b) = (lanes(&|pair| pair.energy), lanes(&|pair| pair.b));
        let turning = turning::refine(
            profile,
            &energy,
            &b,
            &lanes(&|pair| pair.bracket[0]),
            &lanes(&|pair| pair.bracket[1]),
        );
        let (mut value, mut force) = ([turning], [turning]);
        profile.values(&[turning], &mut value);
        profile.forces(&[turning], &mut force);
        let per_energy =
            |of: &dyn Fn(usize) -> f64| Lanes(core::array::from_fn(|lane| of(lane) / energy.0[lane]));
        let nearness: [f64; WIDTH] = core::array::from_fn(|lane| {
            let pair = &group[lane.min(group.len() - 1)];
            turning::nearness(profile, pair.energy, pair.b, &pair.barriers)
        });
        let pack = Pack {
            energy,
            turning,
            value: per_energy(&|lane| value[0].0[lane]),
            force: per_energy(&|lane| turning.0[lane] * force[0].0[lane]),
            curvature: per_energy(&|lane| {
                let r = turning.0[lane];
                if self.all { r * r * profile.curvature(r) } else { 0.0 }
            }),
            root: Lanes(core::array::from_fn(|lane| b.0[lane] / turning.0[lane])),
            // The peak of 1/√G at a barrier is about √(2 × nearness) wide.
            longest: Lanes(nearness.map(f64::sqrt)),
        };
        let sums = trapezoid::integrate(profile, &pack, self.tolerance, self.all);
        for (lane, pair) in group.iter().enumerate() {
            let mut single = Pair {
                energy: pair.energy,
                turning: turning.0[lane],
                value: pack.value.0[lane],
                force: pack.force.0[lane],
                root: pack.root.0[lane],
                near: 0.0,
            };
            let nearness = nearness[lane];
            let smooth = !profile.breaks().iter().any(|edge| *edge > single.turning);
            let met = sums.met.lane(lane) && nearness > NEAR_BARRIER && smooth;
            if !met {
                let r = single.turning;
                let steepness =
                    r * r * profile.curvature(r).abs() / (0.01 + single.force.abs()) / single.energy;
                single.near = adaptive::near(r, steepness.max(1.0), profile.breaks());
            }
            let (integral, mut error) = if met {
                (sums.integral.map(|integral| integral.0[lane]), sums.error.0[lane])
            } else {
                let tolerance = self.tolerance.max(ROUNDING / nearness);
                self.by_intervals(&single, Integrand::Deflection, &pair.barriers, tolerance)
            };
            let comparison = Comparison::of(single.value, single.root);
            let (mut angle, mut complement) = comparison.angle(single.value, single.root, integral[0]);
            // Where a center can be passed, small b turn little; elsewhere a small angle is one that crosses zero.
            let passes = matches!(profile.center(), profile::Center::Open(_));
            let short = CANCELLED * PI * (single.value / (1.0 + single.root)).abs().min(1.0);
            if passes && angle.abs() < short {
                let (turns, off) =
                    self.by_intervals(&single, Integrand::Turning, &pair.barriers, self.tolerance);
                (angle, complement, error) = (turns[0], PI - turns[0].abs(), 0.5 * off / single.root);
            }
            let steep = 2.0_f64.mul_add(single.root * single.root, single.force);
            found[pair.place] = Deflection {
                angle,
                complement,
                closest_approach: single.turning,
                derivative: self
                    .only_all(-2.0 / (single.turning * steep) * comparison.slope(single.force, integral[1])),
                delay: self.only_all(
                    -2.0 * single.turning
                        * (integral[2] + trapezoid::closed_delay(single.value, single.root))
                        + profile.endless_delay(),
                ),
                error: 2.0 * single.root * error + f64::EPSILON * angle.abs(),
                turning_points: found[pair.place].turning_points,
                status: if nearness < NEAR_ORBITING { Status::NearOrbiting } else { Status::Scattered },
            };
        }
    }

    fn only_all(&self, value: f64) -> f64 {
        if self.all { value } else { f64::NAN }
    }

    /// The integrals, and how far the first may be off.
    fn by_intervals(
        &self,
        pair: &Pair,
        integrand: Integrand,
        barriers: &[f64],
        tolerance: f64,
    ) -> ([f64; trapezoid::INTEGRALS], f64) {
        let ends = [barriers, self.profile.breaks()].concat();
        let wanted = if self.all && integrand == Integrand::Deflection { trapezoid::INTEGRALS } else { 1 };
        let whole = adaptive::integrate(self.profile, pair, integrand, &ends, (tolerance, wanted));
        (whole.integral, whole.error)
    }

    /// b = 0, found at a tiny one where the center is open: through it, or round a point that attracts.
    fn head_on(&self, energy: f64, found: &mut Deflection) {
        let mut critical = Critical::default();
        match critical.way(self.profile, energy, 0.0) {
            Way::Through => {
                found.derivative = self.only_all(found.angle / TINY);
                (found.angle, found.complement, found.closest_approach) = (0.0, PI, 0.0);
            }
            Way::Bounces(power) => {
                found.angle = -PI * power / (2.0 - power);
                (found.complement, found.closest_approach) = (PI - found.angle.abs(), 0.0);
            }
            _ => (found.angle, found.complement) = (PI, 0.0),
        }
    }
}

#[cfg(test)]
mod tests;
