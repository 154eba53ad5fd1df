//! Which impact parameters lead to an angle, and the differential cross section that they make together.

use super::{MOST_STEPS, Sample, Structure, range, winding};
use crate::Result;
use crate::numerics::angles::sin;
use crate::parallel::Ticker;
use crate::scattering::kinematics::Collision;
use core::f64::consts::PI;

/// Each place of a tail is so many times as far as the one before.
const FURTHER: f64 = 4.0;
/// Where V ends at a wall, ψ falls as √(R − b): how much the power of the outermost sample may be off.
const SQUARE_ROOT: f64 = 0.05;
/// Where ψ is not met to this part of its sine, as b has no more digits, dψ/db is that of the angle asked for …
const TOLD: f64 = f64::EPSILON;
/// … by another so many times as far away, and no nearer than this part of b: no farther, as a slope may vanish beside it.
const AROUND: f64 = 16.0;
const LEAST: f64 = 64.0 * f64::EPSILON;
/// An angle that stands for 0 where the cross section does not vanish there.
const FORWARD: f64 = 1e-150;

/// One way to an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// Its impact parameter.
    pub impact_parameter: f64,
    /// ψ, signed and not folded.
    pub angle: f64,
    /// dψ/db.
    pub derivative: f64,
}

impl Branch {
    /// dσ/dΩ = b/(|sin ψ| |dψ/db|) at the angle θ that it leads to, and its limit head-on.
    ///
    /// The sine is that of the angle asked for: near a glory that of the branch has no digits, as its ψ is off by what a
    /// quadrature leaves.
    pub fn cross_section(&self, angle: f64) -> f64 {
        if self.impact_parameter == 0.0 {
            return 1.0 / (self.derivative * self.derivative);
        }
        (self.impact_parameter / sine(angle)) / self.derivative.abs()
    }
}

/// sin θ of an angle in [0, π], with what is missing to π.
fn sine(angle: f64) -> f64 {
    sin(if angle > 1.0 { PI - angle } else { angle }).abs()
}

impl Structure<'_> {
    /// All impact parameters that lead to an angle θ in [0, π] from the beam: |ψ| = θ but for whole turns, from the
    /// smallest on.
    ///
    /// # Errors
    /// As [`Deflector::deflect`](super::Deflector::deflect).
    pub fn branches(&self, angle: f64, ticker: &mut Ticker<'_>) -> Result<Vec<Branch>> {
        if let Some(square) = self.deflector.winds(self.energy) {
            // 2n and both 2n ± θ/π.
            let part = angle / PI;
            let parts = (0_u32..).flat_map(|n| [2.0 * f64::from(n) + part, 2.0 * f64::from(n + 1) - part]);
            return Ok(winding(square, parts));
        }
        // What it leads to, and where.
        let mut found: Vec<(f64, Sample)> = Vec::new();
        for stretch in &self.stretches {
            let (low, high) = range(stretch);
            let most = ((low.abs().max(high.abs()) + angle) / (2.0 * PI)).ceil() as i64;
            for turns in -most..=most {
                let whole = 2.0 * PI * turns as f64;
                for target in [whole + angle, whole - angle] {
                    // Both are one at 0 and at π.
                    let twice =
                        target == whole + angle && (angle == 0.0 || angle == PI) && target != whole - angle;
                    if !twice && target >= low && target <= high {
                        found.extend(self.solve(stretch, target, ticker)?.map(|sample| (target, sample)));
                    }
                }
            }
        }
        for target in [angle, -angle] {
            if let Some(beyond) = self.tail(target, ticker)? {
                found.extend(self.solve(&beyond, target, ticker)?.map(|sample| (target, sample)));
            }
        }
        for target in [angle, -angle] {
            found.extend(self.grazing(target).map(|sample| (target, sample)));
        }
        found.sort_by(|(a, one), (b, other)| one.b.total_cmp(&other.b).then(a.total_cmp(b)));
        // Where two stretches meet both have it; beside a glory two angles may have the same b, as it is rounded.
        found.dedup_by(|(a, one), (b, other)| a == b && one.b == other.b);
        let branch = |(_, sample): &(f64, Sample)| Branch {
            impact_parameter: sample.b,
            angle: sample.angle,
            derivative: sample.derivative,
        };
        Ok(found.iter().map(branch).collect())
    }
    /// dσ/dΩ in the centre-of-mass frame, all branches together.
    ///
    /// # Errors
    /// As [`branches`](Self::branches).
    pub fn cross_section(&self, angle: f64, ticker: &mut Ticker<'_>) -> Result<f64> {
        if let Some(square) = self.deflector.winds(self.energy) {
            // b db = −¼ C/E (1/x² − 1/(x + 2)²) dx, x = |ψ|/π: of x = 2n + θ/π, and of 2n + 2 − θ/π, but the first terms cancel.
            let around = 2.0 * PI - angle;
            return Ok(0.25 * PI * square * (1.0 / (angle * angle) + 1.0 / (around * around)) / sine(angle));
        }
        if angle == 0.0 && (self.outermost().is_some() || self.ends_softly()) {
            return Ok(f64::INFINITY);
        }
        let angle = if angle == 0.0 && self.grazing(FORWARD).or(self.grazing(-FORWARD)).is_some() {
            FORWARD
        } else {
            angle
        };
        // From +0 on: an empty sum of floats is −0.
        let branches = self.branches(angle, ticker)?;
        Ok(branches.iter().map(|branch| branch.cross_section(angle)).fold(0.0, |sum, part| sum + part))
    }
    /// dσ/dΩ of the projectile in the laboratory, all branches of either kind together; 0 where none leads.
    ///
    /// # Errors
    /// As [`branches`](Self::branches).
    pub fn lab_cross_section(
        &self,
        collision: Collision,
        angle: f64,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        let mut sum = 0.0;
        for (cm_angle, jacobian) in collision.branches(angle).into_iter().flatten() {
            // A jacobian of 0 (equal masses across the beam) meets a finite cross section.
            if jacobian != 0.0 {
                sum += jacobian * self.cross_section(cm_angle.min(PI), ticker)?;
            }
        }
        Ok(sum)
    }
    /// dσ/dΩ of the target in the laboratory.
    ///
    /// # Errors
    /// As [`branches`](Self::branches).
    pub fn recoil_cross_section(&self, angle: f64, ticker: &mut Ticker<'_>) -> Result<f64> {
        let cm_angle = (PI - 2.0 * angle).max(0.0);
        Ok(Collision::recoil_jacobian(angle) * self.cross_section(cm_angle, ticker)?)
    }
    /// The area of all impact parameters with an angle of at least that from the beam, captured ones too.
    ///
    /// # Errors
    /// As [`branches`](Self::branches).
    pub fn beyond(&self, angle: f64, ticker: &mut Ticker<'_>) -> Result<f64> {
        if angle == 0.0 && self.outermost().is_some() {
            return Ok(f64::INFINITY);
        }
        let branches = self.branches(angle, ticker)?;
        let mut places = vec![self.capture()];
        places.extend(self.edges.iter().map(|edge| edge.impact_parameter));
        places.extend(branches.iter().map(|branch| branch.impact_parameter));
        places.retain(|b| *b >= self.capture());
        places.sort_by(f64::total_cmp);
        places.dedup();
        let mut area = PI * self.capture() * self.capture();
        for pair in places.windows(2) {
            let middle = self.sample(0.5 * (pair[0] + pair[1]), ticker)?;
            let folded = middle.angle - 2.0 * PI * (middle.angle / (2.0 * PI)).round();
            if folded.abs() >= angle {
                area += PI * (pair[1] - pair[0]) * (pair[1] + pair[0]);
            }
        }
        Ok(area)
    }

    /// The last sample before an infinite distance, up to where some deflection is left.
    fn outermost(&self) -> Option<Sample> {
        let last = *self.stretches.last()?.last()?;
        (self.deflector.range() == f64::INFINITY && last.angle != 0.0).then_some(last)
    }

    /// The last sample before the edge of V, and the power of the distance from there with which ψ goes to 0; `None` of a V
    /// without an edge.
    fn at_the_edge(&self) -> Option<(Sample, f64)> {
        let last = *self.stretches.last()?.iter().rfind(|sample| sample.angle != 0.0)?;
        let range = self.deflector.range();
        range.is_finite().then(|| (last, -last.derivative * (range - last.b) / last.angle))
    }

    /// Whether V ends at an edge that is no wall: so many graze it that the cross section has no end at angle 0.
    fn ends_softly(&self) -> bool {
        self.at_the_edge().is_some_and(|(_, power)| power > 0.5 + SQUARE_ROOT)
    }

    /// The sample with that ψ nearer to the edge of V than b can tell, where V ends at a wall; `None` if it is not there.
    fn grazing(&self, target: f64) -> Option<Sample> {
        let (last, power) = self.at_the_edge()?;
        let range = self.deflector.range();
        if target == 0.0 || target.signum() != last.angle.signum() {
            return None;
        }
        let at_wall = (power - 0.5).abs() < SQUARE_ROOT && target.abs() < last.angle.abs();
        at_wall.then(|| Sample {
            b: range,
            angle: target,
            complement: PI - target.abs(),
            derivative: last.derivative * (last.angle / target),
            ..last
        })
    }

    /// From there on, up to less than that ψ; `None` if it is not beyond. Far out ψ falls to zero, whatever the potential.
    fn tail(&self, target: f64, ticker: &mut Ticker<'_>) -> Result<Option<Vec<Sample>>> {
        let Some(last) = self.outermost() else { return Ok(None) };
        if target == 0.0 || target.signum() != last.angle.signum() || target.abs() >= last.angle.abs() {
            return Ok(None);
        }
        let mut beyond = vec![last];
        let mut b = last.b;
        loop {
            b *= FURTHER;
            let next = self.sample(b, ticker)?;
            beyond.push(next);
            // A deflection that cannot be told is no bracket.
            if !next.angle.is_finite() {
                return Ok(None);
            }
            if next.angle.abs() <= target.abs() {
                return Ok(Some(beyond));
            }
        }
    }

    /// The sample of a monotone stretch with that ψ, if it has one.
    pub(super) fn solve(
        &self,
        stretch: &[Sample],
        target: f64,
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<Sample>> {
        // Near ±π what is missing to it has the digits, on this side of zero.
        let near = target.abs() > 1.0 && target.abs() <= PI;
        let sign = |sample: &Sample| {
            if near && sample.angle * target > 0.0 {
                target.signum() * ((PI - target.abs()) - sample.complement)
            } else {
                sample.angle - target
            }
        };
        if let Some(exact) = stretch.iter().find(|sample| sign(sample) == 0.0) {
            return Ok(Some(*exact));
        }
        let Some(at) = stretch.windows(2).position(|pair| sign(&pair[0]) * sign(&pair[1]) < 0.0) else {
            return Ok(None);
        };
        let (mut low, mut high) = (stretch[at], stretch[at + 1]);
        let mut here = if sign(&low).abs() < sign(&high).abs() { low } else { high };
        for _ in 0..MOST_STEPS {
            let newton = here.b - sign(&here) / here.derivative;
            let middle = if low.b > 0.0 { (low.b * high.b).sqrt() } else { 0.5 * (low.b + high.b) };
            let b = if newton > low.b && newton < high.b { newton } else { middle };
            if b == here.b || b <= low.b || b >= high.b {
                break;
            }
            let step = (b - here.b).abs();
            here = self.sample(b, ticker)?;
            // On a top that is just reached no more can be told.
            if !here.angle.is_finite() {
                here = low;
                break;
            }
            if sign(&here) == 0.0 {
                break;
            }
            if sign(&here) * sign(&low) > 0.0 {
                low = here
            } else {
                high = here
            }
            // A halving that short is no sign of an end: beside an orbit ψ goes by whole turns from one b to the next.
            if b == newton && step <= 1e-15 * b {
                break;
            }
        }
        let mut nearest = [low, high]
            .into_iter()
            .fold(here, |best, other| if sign(&other).abs() < sign(&best).abs() { other } else { best });
        let missed = sign(&nearest);
        let sine = sin(if near { PI - target.abs() } else { target }).abs();
        if missed.abs() > TOLD * sine {
            let way = f64::max(AROUND * missed.abs() / nearest.derivative.abs(), LEAST * nearest.b);
            let (first, last) = (stretch[0].b, stretch[stretch.len() - 1].b);
            let beside = if nearest.b - first > last - nearest.b { nearest.b - way } else { nearest.b + way };
            let other = self.sample(beside.clamp(first, last), ticker)?;
            // Beside a wall it is the inverse of dψ/db that goes evenly with ψ.
            let [here, there] = [nearest, other].map(|sample| 1.0 / sample.derivative);
            let inverse = here - missed * (there - here) / (sign(&other) - missed);
            if inverse * here > 0.0 && inverse.is_finite() {
                nearest.derivative = 1.0 / inverse;
            }
        }
        Ok(Some(nearest))
    }
}
