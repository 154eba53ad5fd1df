//! Pairs by quadrature, a chunk at a time: where they turn, how far their integrands reach, and what the sums make.

use super::adaptive::{self, Integrand, Pair};
use super::comparison::{self, Comparison, STRONG};
use super::nodes::Ladder;
use super::profile::{Center, Profile};
use super::refine::Turned;
use super::trapezoid::{self, INTEGRALS, Pack, Rows, Sums};
use super::turning::{self, Critical, Way};
use super::{Deflection, Status};
use crate::Result;
use crate::numerics::elementary::{Exponential, ln};
use crate::numerics::lanes::{Lanes, WIDTH, as_numbers};
use crate::parallel::Ticker;
use core::f64::consts::PI;

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
/// What nodes leave out, as a part of the tolerance.
const LEFT_OUT: f64 = 0.02;

/// Pairs by quadrature.
pub(super) struct Quadrature<'a> {
    pub(super) profile: &'a Profile,
    pub(super) tolerance: f64,
    pub(super) all: bool,
}

/// A pair that turns, in units of the profile.
struct Turning {
    place: usize,
    energy: f64,
    b: f64,
    bracket: [f64; 2],
    barriers: Vec<f64>,
    /// How near b is to where one of them has its top, as a part of it.
    nearness: f64,
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
        let turning = self.turning(energy, b, &mut found, ticker)?;
        if !turning.is_empty() {
            self.integrate(&turning, &mut found, ticker)?;
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

    /// Those that turn, and between which distances.
    fn turning(
        &self,
        energy: &[f64],
        b: &[f64],
        found: &mut [Deflection],
        ticker: &mut Ticker<'_>,
    ) -> Result<Vec<Turning>> {
        let profile = self.profile;
        let mut critical = Critical::default();
        let mut turning: Vec<Turning> = Vec::with_capacity(energy.len());
        let simple = match profile.center() {
            Center::Attractive(power) => power < 2.0,
            _ => true,
        };
        for from in (0..energy.len()).step_by(WIDTH) {
            ticker.tick()?;
            let (mut energies, mut impacts) = ([0.0; WIDTH], [0.0; WIDTH]);
            for at in 0..WIDTH {
                let place = (from + at).min(energy.len() - 1);
                energies[at] = profile.take_energy(energy[place]);
                impacts[at] = profile.take_length(b[place]);
            }
            let cells = profile.cells(&energies, &impacts);
            for at in 0..WIDTH.min(energy.len() - from) {
                let (place, e, mut b) = (from + at, energies[at], impacts[at]);
                profile.check_end(e, self.tolerance)?;
                let way = if let (Some(bracket), true) =
                    (cells[at], simple && b > 0.0 && e >= profile.one_turning_point_from())
                {
                    found[place].turning_points = 1;
                    Way::Turns { bracket, barriers: Vec::new() }
                } else {
                    let way = critical.way(profile, e, b);
                    found[place].turning_points = critical.turning_points(profile, e, b);
                    if matches!(way, Way::Through | Way::Bounces(_)) {
                        b = TINY;
                        critical.way(profile, e, b)
                    } else {
                        way
                    }
                };
                if let Way::Turns { bracket, barriers } = way {
                    profile.check_start(e, b, bracket)?;
                    let nearness = turning::nearness(profile, e, b, &barriers);
                    turning.push(Turning { place, energy: e, b, bracket, barriers, nearness });
                }
            }
        }
        Ok(turning)
    }

    fn integrate(
        &self,
        turning: &[Turning],
        found: &mut [Deflection],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let profile = self.profile;
        let ladder = Ladder::of(self.tolerance);
        let turned = self.turned(turning);
        let reach = self.reaches(&turned, turning, ladder);
        let mut rows = Rows::default();
        // Those that reach as far side by side.
        let order = by_reach(&reach);
        for group in order.chunks(WIDTH) {
            ticker.tick()?;
            let mut places = [usize::from(group[group.len() - 1]); WIDTH];
            let mut pack = Pack::default();
            for (lane, place) in group.iter().enumerate() {
                places[lane] = usize::from(*place);
            }
            for (lane, place) in places.into_iter().enumerate() {
                let at = |rows: &[Lanes]| as_numbers(rows)[place];
                pack.energy.0[lane] = at(&turned.energy);
                pack.turning.0[lane] = at(&turned.r);
                pack.value.0[lane] = at(&turned.value);
                pack.force.0[lane] = at(&turned.force);
                pack.curvature.0[lane] = at(&turned.curvature);
                pack.root.0[lane] = at(&turned.root);
                // The peak of 1/√G at a barrier is about √(2 × nearness) wide.
                pack.longest.0[lane] = turning[place].nearness.sqrt();
                pack.reach.0[lane] = f64::from(reach[place]);
            }
            let sums = if self.all {
                trapezoid::integrate::<INTEGRALS>(profile, ladder, &pack, self.tolerance, &mut rows)
            } else {
                trapezoid::integrate::<1>(profile, ladder, &pack, self.tolerance, &mut rows)
            };
            for (lane, place) in group.iter().enumerate() {
                let pair = &turning[usize::from(*place)];
                self.finish(pair, &pack, &sums, lane, &mut found[pair.place]);
            }
        }
        Ok(())
    }

    /// Their turning points.
    fn turned(&self, turning: &[Turning]) -> Turned {
        let mut turned = Turned::default();
        turned.resize(turning.len().div_ceil(WIDTH));
        for (row, group) in turning.chunks(WIDTH).enumerate() {
            for lane in 0..WIDTH {
                let pair = &group[lane.min(group.len() - 1)];
                turned.energy[row].0[lane] = pair.energy;
                turned.b[row].0[lane] = pair.b;
                turned.low[row].0[lane] = pair.bracket[0];
                turned.high[row].0[lane] = pair.bracket[1];
                for (end, known) in turned.ends[row].iter_mut().zip(self.profile.ends(pair.bracket)) {
                    end.0[lane] = known;
                }
            }
        }
        turned.refine(self.profile);
        turned
    }

    /// How many nodes of the first level count; none where equal steps are not what is wanted.
    fn reaches(&self, turned: &Turned, turning: &[Turning], ladder: &Ladder) -> Vec<u8> {
        let profile = self.profile;
        let rest = LEFT_OUT * self.tolerance;
        // What is left of the series falls as u⁹ with less than these factors, of what it is compared with else as u³.
        let ninth = |factor: f64| Exponential::exp(ln(rest / factor) / 9.0);
        let third = |factor: f64| Exponential::exp(ln(rest / factor) / 3.0);
        let (weak, bound) = (1.0 / ninth(0.5), 1.0 / ninth(1.7));
        let (r, x) = (as_numbers(&turned.r), as_numbers(&turned.value));
        let (root, energy) = (as_numbers(&turned.root), as_numbers(&turned.energy));
        let last_edge = profile.breaks().last().copied().unwrap_or(0.0);
        let mut reaches = Vec::with_capacity(turning.len());
        for (place, pair) in turning.iter().enumerate() {
            let (r, x, root) = (r[place], x[place], root[place]);
            if last_edge > r || pair.nearness <= NEAR_BARRIER {
                reaches.push(0);
                continue;
            }
            let square = root * root;
            let (scale, series) = if x < STRONG {
                let closed = Comparison::strongly(root);
                (closed, 1.0 / third(square / closed))
            } else if self.all {
                (x.abs(), 1.0 / third(square.max(1.0) * square.max(1.0)))
            } else {
                (x.abs(), if square <= 1.0 { weak } else { bound })
            };
            let most = rest * energy[place] * scale.min(0.5);
            let faint = profile.faint(if self.all { most * r } else { most / r }, self.all);
            reaches.push(ladder.count((faint / r).max(series)));
        }
        reaches
    }

    /// What the sums of a lane make, or if they are not good enough its intervals.
    fn finish(&self, turning: &Turning, pack: &Pack, sums: &Sums, lane: usize, found: &mut Deflection) {
        let profile = self.profile;
        let (r, x, y, root) =
            (pack.turning.0[lane], pack.value.0[lane], pack.force.0[lane], pack.root.0[lane]);
        found.closest_approach = r;
        found.status =
            if turning.nearness < NEAR_ORBITING { Status::NearOrbiting } else { Status::Scattered };
        let strong = x < STRONG;
        let single = || {
            let steepness = pack.curvature.0[lane].abs() / (0.01 + y.abs());
            let near = adaptive::near(r, steepness.max(1.0), profile.breaks());
            Pair { energy: turning.energy, turning: r, value: x, force: y, root, near }
        };
        let (integral, mut error) = if sums.met.lane(lane) {
            let integral = &sums.integral;
            ([integral[0].0[lane], integral[1].0[lane], integral[2].0[lane]], sums.error.0[lane])
        } else {
            let tolerance = self.tolerance.max(ROUNDING / turning.nearness);
            self.by_intervals(&single(), Integrand::Deflection, &turning.barriers, tolerance)
        };
        (found.angle, found.complement) = comparison::angle(strong, [x, y], root, integral[0]);
        // Where a center can be passed, small b turn little; elsewhere a small angle is one that crosses zero.
        let passes = matches!(profile.center(), Center::Open(_));
        let short = CANCELLED * PI * (x / (1.0 + root)).abs().min(1.0);
        if passes && found.angle.abs() < short {
            let (turns, off) =
                self.by_intervals(&single(), Integrand::Turning, &turning.barriers, self.tolerance);
            (found.angle, found.complement) = (turns[0], PI - turns[0].abs());
            error = 0.5 * off / root;
        }
        found.error = 2.0 * root * error + f64::EPSILON * found.angle.abs();
        if self.all {
            let steep = 2.0_f64.mul_add(root * root, y);
            let lost = integral[2] + comparison::closed_delay(x, root);
            found.derivative = -2.0 / (r * steep) * Comparison::of(x, root).slope(y, integral[1]);
            found.delay = -2.0 * r * lost + profile.endless_delay();
        }
    }

    /// The integrals, and how far the first may be off.
    fn by_intervals(
        &self,
        pair: &Pair,
        integrand: Integrand,
        barriers: &[f64],
        tolerance: f64,
    ) -> ([f64; INTEGRALS], f64) {
        let ends = [barriers, self.profile.breaks()].concat();
        let wanted = if self.all && integrand == Integrand::Deflection { INTEGRALS } else { 1 };
        let whole = adaptive::integrate(self.profile, pair, integrand, &ends, (tolerance, wanted));
        (whole.integral, whole.error)
    }

    /// b = 0, found at a tiny one where the center is open: through it, or round a point that attracts.
    fn head_on(&self, energy: f64, found: &mut Deflection) {
        let mut critical = Critical::default();
        match critical.way(self.profile, energy, 0.0) {
            Way::Through => {
                found.derivative = found.angle / TINY;
                (found.angle, found.complement, found.closest_approach) = (0.0, PI, 0.0);
            }
            Way::Bounces(power) => {
                found.angle = -PI * power / (2.0 - power);
                (found.complement, found.closest_approach) = (PI - found.angle.abs(), 0.0);
            }
            _ => (found.angle, found.complement) = (PI, 0.0),
        }
        if !self.all {
            found.derivative = f64::NAN;
        }
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
