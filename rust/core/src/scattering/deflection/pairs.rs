//! Pairs by quadrature, a chunk at a time: where they turn, how far their integrands reach, and what the sums make.

use super::adaptive::{self, Integrand, Pair};
use super::comparison::{self, Comparison, STRONG};
use super::nodes::Ladder;
use super::pack::Pack;
use super::profile::{Center, Profile};
use super::refine::Turned;
use super::trapezoid::{self, INTEGRALS, Sums, Work};
use super::turning::{self, Critical, Way};
use super::{Deflection, Status};
use crate::Result;
use crate::numerics::elementary::{Exponential, ln};
use crate::numerics::lanes::{Lanes, WIDTH, as_numbers};
use crate::parallel::Ticker;
use core::f64::consts::PI;

/// As a part of b: nearer to orbiting, four digits and more of b or E are lost in the angle.
pub(super) const NEAR_ORBITING: f64 = 1e-4;
/// What rises by no more than this part of the energy on a way of r is level for all that its rounding tells.
const LEVEL: f64 = 64.0 * f64::EPSILON;
/// And here equal steps would be many.
const NEAR_BARRIER: f64 = 0.003;
/// An angle of less than this part of what cancels in it is found as a sum of small turns.
const CANCELLED: f64 = 0.05;
/// What nodes leave out, as a part of the tolerance.
const LEFT_OUT: f64 = 0.05;

/// Pairs by quadrature.
pub(super) struct Quadrature<'a> {
    pub(super) profile: &'a Profile,
    pub(super) tolerance: f64,
    /// Whether angles beside a barrier are as certain as E and b.
    pub(super) refined: bool,
    pub(super) all: bool,
    /// Whether what cannot be told is refused; else it is no number.
    pub(super) strict: bool,
}

/// What else there is to know of pairs that turn.
#[derive(Debug, Default)]
struct Turning {
    /// Their places among all.
    places: Vec<u16>,
    /// How near b is to where a barrier has its top, as a part of it.
    nearness: Vec<f64>,
    /// Of those that have some, the barriers that were passed or nearly so.
    barriers: Vec<(u16, Vec<f64>)>,
}

impl Turning {
    fn barriers(&self, at: usize) -> &[f64] {
        let found = self.barriers.binary_search_by_key(&(at as u16), |(at, _)| *at);
        found.map_or(&[], |found| self.barriers[found].1.as_slice())
    }
}

impl Quadrature<'_> {
    pub(super) fn deflections(
        &self,
        energy: &[f64],
        b: &[f64],
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Deflection>> {
        let profile = self.profile;
        let mut found = vec![Deflection::captured(); energy.len()];
        let mut turned = Turned::default();
        let turning = self.turning(energy, b, (&mut turned, &mut found), ticker)?;
        if !turning.places.is_empty() {
            turned.refine(profile);
            self.integrate(&turned, &turning, &mut found, ticker)?;
        }
        for (place, found) in found.iter_mut().enumerate() {
            let (e, b) = (profile.take_energy(energy[place]), profile.take_length(b[place]));
            if b <= self.as_head_on(e).0 && found.status != Status::Captured && found.error.is_finite() {
                self.head_on(e, b, found);
            }
            found.closest_approach = profile.give_length(found.closest_approach);
            if self.all {
                found.delay = profile.give_length(found.delay);
                // 1/length: the inverse of the unit.
                found.derivative = profile.take_length(found.derivative);
            }
        }
        if self.all {
            self.beside_head_on(energy, b, &mut found, ticker)?;
        }
        Ok(found)
    }

    /// Those that turn, and between which distances.
    fn turning(
        &self,
        energy: &[f64],
        b: &[f64],
        (turned, found): (&mut Turned, &mut [Deflection]),
        ticker: &mut Ticker<'_>,
    ) -> Result<Turning> {
        let profile = self.profile;
        let mut critical = Critical::default();
        let mut turning = Turning::default();
        turning.places.reserve(energy.len());
        turning.nearness.reserve(energy.len());
        turned.resize(energy.len().div_ceil(WIDTH));
        let simple_from = match profile.center() {
            Center::Attractive(power) if power >= 2.0 => f64::INFINITY,
            _ => profile.one_turning_point_from(),
        };
        for from in (0..energy.len()).step_by(WIDTH) {
            ticker.tick()?;
            let (mut energies, mut impacts) = ([0.0; WIDTH], [0.0; WIDTH]);
            for at in 0..WIDTH {
                let place = (from + at).min(energy.len() - 1);
                energies[at] = profile.take_energy(energy[place]);
                impacts[at] = profile.take_length(b[place]);
            }
            let cells = profile.grid().places(&energies, &impacts);
            for at in 0..WIDTH.min(energy.len() - from) {
                let (place, e, b) = (from + at, energies[at], impacts[at]);
                profile.check_end(e, self.tolerance)?;
                if let Some(known) = profile.rim().and_then(|rim| rim.deflection(e, b))
                    && matches!(critical.way(profile, e, b), Way::Turns { .. })
                {
                    let turning_points = critical.turning_points(profile, e, b);
                    found[place] = Deflection { turning_points, ..known };
                    continue;
                }
                let next = turning.places.len();
                let (head_on, tiny) = self.as_head_on(e);
                if cells[at] > 0 && b > head_on && e >= simple_from {
                    let cell = profile.grid().cell(cells[at]);
                    profile.check_start(e, b, cell)?;
                    turned.put(next, e, b, cell, profile.grid().around(cells[at]));
                    found[place].turning_points = 1;
                    turning.places.push(place as u16);
                    turning.nearness.push(f64::INFINITY);
                    continue;
                }
                let mut b = b;
                let mut way = critical.way(profile, e, b);
                if b > 0.0 && b <= head_on {
                    let straight = critical.way(profile, e, 0.0);
                    way = if matches!(straight, Way::Bounces(_)) { straight } else { way };
                }
                found[place].turning_points = critical.turning_points(profile, e, b);
                if matches!(way, Way::Through | Way::Bounces(_)) {
                    b = tiny;
                    way = critical.way(profile, e, b);
                }
                if let Way::Turns { bracket, barriers } = way {
                    profile.check_start(e, b, bracket)?;
                    turned.put(next, e, b, bracket, profile.grid().ends(bracket));
                    turning.places.push(place as u16);
                    turning.nearness.push(turning::nearness(profile, e, b, &barriers));
                    if !barriers.is_empty() {
                        turning.barriers.push((next as u16, barriers));
                    }
                }
            }
        }
        if !turning.places.is_empty() {
            turned.close(turning.places.len());
        }
        Ok(turning)
    }

    fn integrate(
        &self,
        turned: &Turned,
        turning: &Turning,
        found: &mut [Deflection],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let profile = self.profile;
        let ladder = Ladder::of(self.tolerance);
        let reach = self.reaches(turned, turning, ladder);
        let mut work = Work::default();
        let columns = [
            as_numbers(&turned.energy),
            as_numbers(&turned.r),
            as_numbers(&turned.value),
            as_numbers(&turned.force),
            as_numbers(&turned.curvature),
            as_numbers(&turned.root),
        ];
        // Those that reach as far side by side.
        let order = by_reach(&reach);
        for group in order.chunks(WIDTH) {
            ticker.tick()?;
            let mut places = [usize::from(group[group.len() - 1]); WIDTH];
            for (lane, place) in group.iter().enumerate() {
                places[lane] = usize::from(*place);
            }
            let mut gathered = [Lanes([0.0; WIDTH]); 6];
            for (column, gathered) in columns.iter().zip(&mut gathered) {
                for lane in 0..WIDTH {
                    gathered.0[lane] = column[places[lane]];
                }
            }
            let [energy, r, value, force, curvature, root] = gathered;
            let (mut longest, mut reaches) = (Lanes([0.0; WIDTH]), Lanes([0.0; WIDTH]));
            for lane in 0..WIDTH {
                // The peak of 1/√G at a barrier is about √(2 × nearness) wide.
                longest.0[lane] = turning.nearness[places[lane]].sqrt();
                reaches.0[lane] = f64::from(reach[places[lane]]);
            }
            let pack = Pack { energy, turning: r, value, force, curvature, root, longest, reach: reaches };
            if self.all {
                trapezoid::integrate::<INTEGRALS>(profile, ladder, &pack, self.tolerance, &mut work);
            } else {
                trapezoid::integrate::<1>(profile, ladder, &pack, self.tolerance, &mut work);
            }
            for (lane, at) in group.iter().enumerate() {
                let at = usize::from(*at);
                let found = &mut found[usize::from(turning.places[at])];
                let impact_parameter = as_numbers(&turned.b)[at];
                self.finish((turning, at, impact_parameter), &pack, &work.sums, lane, found);
                match profile.check_resolved(pack.energy.0[lane], self.tolerance, found) {
                    Err(error) if self.strict => return Err(error),
                    Err(_) => found.forget_angle(),
                    Ok(()) => {}
                }
            }
        }
        Ok(())
    }

    /// How many nodes of the first level count; none where equal steps are not what is wanted.
    fn reaches(&self, turned: &Turned, turning: &Turning, ladder: &Ladder) -> Vec<u8> {
        let profile = self.profile;
        let rest = LEFT_OUT * self.tolerance;
        // What is left of the series falls as u⁹ with less than these factors, of what it is compared with else as u³.
        let ninth = |factor: f64| Exponential::exp(ln(rest / factor) / 9.0);
        let third = |factor: f64| Exponential::exp(ln(rest / factor) / 3.0);
        let (weak, bound) = (1.0 / ninth(0.5), 1.0 / ninth(1.7));
        let (r, x) = (as_numbers(&turned.r), as_numbers(&turned.value));
        let (root, energy) = (as_numbers(&turned.root), as_numbers(&turned.energy));
        let (scale, inverse) = (as_numbers(&turned.scale), as_numbers(&turned.inverse));
        let last_edge = profile.breaks().last().copied().unwrap_or(0.0);
        let mut reaches = Vec::with_capacity(turning.places.len());
        for (at, nearness) in turning.nearness.iter().enumerate() {
            let (r, x, root) = (r[at], x[at], root[at]);
            if last_edge > r || *nearness <= NEAR_BARRIER {
                reaches.push(0);
                continue;
            }
            let square = root * root;
            let (scale, series) = if x < STRONG {
                let closed = Comparison::strongly(root);
                (energy[at] * closed.min(0.5) * inverse[at], 1.0 / third(square / closed))
            } else if self.all {
                (scale[at], 1.0 / third(square.max(1.0) * square.max(1.0)))
            } else {
                (scale[at], if square <= 1.0 { weak } else { bound })
            };
            let most = rest * if self.all { scale * r * r } else { scale };
            let faint = profile.grid().faint(most, self.all);
            if profile.next_mark(r) < faint {
                reaches.push(0);
                continue;
            }
            reaches.push(ladder.count((faint * inverse[at]).max(series)));
        }
        reaches
    }

    /// What the sums of a lane make, or if they are not good enough its intervals.
    fn finish(
        &self,
        (turning, at, impact_parameter): (&Turning, usize, f64),
        pack: &Pack,
        sums: &Sums,
        lane: usize,
        found: &mut Deflection,
    ) {
        let profile = self.profile;
        let nearness = turning.nearness[at];
        let (r, x, y, root) =
            (pack.turning.0[lane], pack.value.0[lane], pack.force.0[lane], pack.root.0[lane]);
        found.closest_approach = r;
        found.status = if nearness < NEAR_ORBITING { Status::NearOrbiting } else { Status::Scattered };
        // G rises from its turning point as this; there is nothing of it on the top of a hill that the energy just reaches.
        let steep = 2.0_f64.mul_add(root * root, y);
        if matches!(profile.center(), Center::Open(_)) && steep.abs() <= LEVEL {
            found.rest_on_top();
            return;
        }
        let strong = x < STRONG;
        let single = || {
            // Measured against V where that is small: on the last of a soft edge the force is far below E/r₀, and all of it is
            // lost in a short way.
            let steepness = pack.curvature.0[lane].abs() / (0.01 * x.abs().min(1.0) + y.abs());
            let mark = profile.next_mark(r * (1.0 + 16.0 * f64::EPSILON));
            let near = adaptive::near(r, steepness.max(1.0), profile.breaks(), mark);
            let curvature = pack.curvature.0[lane];
            let energy = pack.energy.0[lane];
            Pair { energy, impact_parameter, turning: r, value: x, force: y, root, curvature, near, nearness }
        };
        let (integral, mut error) = if sums.met.lane(lane) {
            let integral = &sums.integral;
            ([integral[0].0[lane], integral[1].0[lane], integral[2].0[lane]], sums.error.0[lane])
        } else {
            self.by_intervals(&single(), Integrand::Deflection, turning.barriers(at))
        };
        (found.angle, found.complement) = comparison::angle(strong, [x, y], root, integral[0]);
        // Where a center can be passed, small b turn little; elsewhere a small angle is one that crosses zero.
        let passes = matches!(profile.center(), Center::Open(_));
        let short = CANCELLED * PI * (x / (1.0 + root)).abs().min(1.0);
        if passes && found.angle.abs() < short {
            let (turns, off) = self.by_intervals(&single(), Integrand::Turning, turning.barriers(at));
            (found.angle, found.complement) = (turns[0], PI - turns[0].abs());
            error = 0.5 * off / root;
        }
        found.error = 2.0 * root * error + f64::EPSILON * found.angle.abs();
        if self.all {
            let lost = integral[2] + comparison::closed_delay(x, root);
            found.derivative = -2.0 / (r * steep) * Comparison::of(x, root).slope(y, integral[1]);
            found.delay = -2.0 * r * lost + profile.endless_delay();
        }
    }

    /// The integrals, and how far the first may be off.
    fn by_intervals(&self, pair: &Pair, integrand: Integrand, barriers: &[f64]) -> ([f64; INTEGRALS], f64) {
        let ends = [barriers, self.profile.marks()].concat();
        let wanted = if self.all && integrand == Integrand::Deflection { INTEGRALS } else { 1 };
        let whole =
            adaptive::integrate(self.profile, pair, integrand, &ends, (self.tolerance, self.refined), wanted);
        (whole.integral, whole.error)
    }
}

/// Places in the order of their reaches.
fn by_reach(reach: &[u8]) -> Vec<u16> {
    let mut starts = [0_u16; 257];
    for reach in reach {
        starts[usize::from(*reach) + 1] += 1;
    }
    for at in 1..starts.len() {
        starts[at] += starts[at - 1];
    }
    let mut order = vec![0; reach.len()];
    for (place, reach) in reach.iter().enumerate() {
        let start = &mut starts[usize::from(*reach)];
        order[usize::from(*start)] = place as u16;
        *start += 1;
    }
    order
}
