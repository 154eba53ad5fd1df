//! Where a body is at a time or at an angle: integrals inverted by Newton's method, with a bracket.

use super::{Form, Motion, refused};
use crate::central::quadrature::Pair;
use crate::error::{Error, Result};
use crate::numerics::angles::sin_cos;
use crate::numerics::elementary;
use crate::numerics::power_of_two::scale;
use crate::words::number;
use core::f64::consts::PI;

/// A place on the way.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Distance.
    pub radius: f64,
    /// Angle from the start.
    pub angle: f64,
    /// Radial velocity.
    pub radial_velocity: f64,
}

/// A circle and a small oscillation about it.
#[derive(Clone, Copy, Debug)]
struct Epicycle {
    guide: f64,
    /// Frequencies of the oscillation, and of the revolution.
    radial: f64,
    angular: f64,
    /// How far out the start is, and its radial velocity over the frequency.
    offset: f64,
    speed: f64,
}

impl Epicycle {
    fn at(&self, t: f64) -> Place {
        let (sine, cosine) = sin_cos(self.radial * t);
        let lag = 2.0 * self.angular / (self.radial * self.guide);
        Place {
            radius: self.guide + (self.offset * cosine + self.speed * sine),
            angle: self.angular * t - lag * (self.offset * sine + self.speed * (1.0 - cosine)),
            radial_velocity: self.radial * (self.speed * cosine - self.offset * sine),
        }
    }
    /// The time of an angle; what it lags by is of the first order, so a second step is exact.
    fn time(&self, angle: f64) -> f64 {
        let first = angle / self.angular;
        (0..2).fold(first, |t, _| t + (angle - self.at(t).angle) / self.angular)
    }
}

impl Motion<'_> {
    /// Places at times since a state: r, dr/dt.
    ///
    /// # Errors
    /// A time after the body has reached the center or the end of a table, a motion that turns nowhere, and as
    /// [`half_period`](Self::half_period).
    pub fn places(&self, state: (f64, f64), times: &[f64]) -> Result<Vec<Place>> {
        if let Some(epicycle) = self.epicycle(state) {
            return Ok(times.iter().map(|t| epicycle.at(*t)).collect());
        }
        let unit = scale((0.5 * self.mass).sqrt(), self.length - self.speed);
        self.inverted(self.start(state.0, state.1), times.iter().map(|t| t / unit), 0, times)
    }

    /// Places at angles since a state.
    ///
    /// # Errors
    /// As [`places`](Self::places).
    pub fn at_angles(&self, state: (f64, f64), angles: &[f64]) -> Result<Vec<Place>> {
        if let Some(epicycle) = self.epicycle(state) {
            return Ok(angles.iter().map(|angle| epicycle.at(epicycle.time(*angle))).collect());
        }
        self.inverted(self.start(state.0, state.1), angles.iter().copied(), 1, angles)
    }

    /// Of a range that is no wider than the root of rounding, the motion to first order in its width.
    fn epicycle(&self, (radius, radial_velocity): (f64, f64)) -> Option<Epicycle> {
        if !self.range.circle || matches!(self.form, Form::Open(_)) {
            return None;
        }
        let guide = 0.5 * (self.range.inner.radius() + self.range.outer.radius());
        let r = scale(guide, -self.length);
        let [_, force, curvature] = self.radial.field.at(r);
        let square = (curvature - 3.0 * force / r) / self.mass;
        let radial = scale(square.sqrt(), self.speed - self.length);
        let angular = self.turning * (2.0 / self.mass).sqrt() / r / r;
        let angular = scale(angular, self.speed - self.length);
        Some(Epicycle { guide, radial, angular, offset: radius - guide, speed: radial_velocity / radial })
    }

    fn inverted(
        &self,
        start: f64,
        values: impl Iterator<Item = f64>,
        which: usize,
        asked: &[f64],
    ) -> Result<Vec<Place>> {
        if matches!(self.form, Form::Open(_)) {
            let message = "expected a motion that turns somewhere; of one from the center to infinity ask for the \
                           time_of_flight between two distances";
            return Err(Error::invalid("position", message));
        }
        let began = self.since(start)?;
        let end = self.end()?;
        let name = ["t", "angle"][which];
        let mut places = Vec::with_capacity(asked.len());
        for (value, asked) in values.zip(asked) {
            let wanted = began[which] + value;
            let p = self.solve(wanted, which, end)?.ok_or_else(|| {
                let message = format!("expected one before the motion ends, got {}", number(*asked));
                Error::invalid(name, message)
            })?;
            let there = self.since(p)?;
            let r = self.radius(p);
            let kinetic = self.radial.kinetic(r).0.high().max(0.0).sqrt();
            let outward = match self.form {
                Form::Between(..) => sin_cos(p).0.signum(),
                Form::Within(_) => -p.signum(),
                Form::Beyond(_) => p.signum(),
                Form::Open(_) => 1.0,
            };
            places.push(Place {
                radius: scale(r.high(), self.length),
                angle: there[1] - began[1],
                radial_velocity: outward * scale((2.0 / self.mass).sqrt() * kinetic, self.speed),
            });
        }
        Ok(places)
    }

    /// The largest value of the variable, and time and angle there; nothing of a period.
    fn end(&self) -> Result<Option<(f64, Pair)>> {
        if matches!(self.form, Form::Between(..)) {
            return Ok(None);
        }
        let (_, reach) = self.reach();
        Ok(Some((reach, self.since(reach)?)))
    }

    /// The variable at which time or angle has a value; nothing beyond the end.
    fn solve(&self, wanted: f64, which: usize, end: Option<(f64, Pair)>) -> Result<Option<f64>> {
        let size = wanted.abs();
        let (turns, rest, reach) = match (end, self.whole) {
            (Some((reach, most)), _) if size <= most[which] => (0.0, size, reach),
            (Some(_), _) => return Ok(None),
            (None, Some(whole)) => {
                let period = 2.0 * whole.value[which];
                ((size / period).round(), size - period * (size / period).round(), PI)
            }
            (None, None) => return Err(refused()),
        };
        let aim = rest.abs();
        let (mut low, mut high) = (0.0, reach);
        let most = end.map_or_else(|| self.whole.map_or(0.0, |w| w.value[which]), |(_, most)| most[which]);
        let mut p =
            if end.is_some() { reach.min(aim / self.rates(0.0)[which]).min(1.0) } else { PI * aim / most };
        let mut at = self.since(p)?[which];
        for _ in 0..STEPS {
            if at < aim {
                low = p;
            } else {
                high = p;
            }
            let rate = self.rates(p)[which];
            // Beyond a turning point time grows as an exponential, so its logarithm is taken.
            let far = which == 0 && at > 2.0 * aim && aim > 0.0;
            let step = if far { elementary::ln(at / aim) * at / rate } else { (at - aim) / rate };
            let next = p - step;
            let next = if next > low && next < high { next } else { 0.5 * (low + high) };
            let moved = (next - p).abs();
            if moved <= 4e-16 * next.abs() || at == aim {
                return Ok(Some((2.0 * PI * turns + p.copysign(rest)).copysign(wanted)));
            }
            at = self.since(next)?[which];
            p = next;
        }
        Err(refused())
    }
}

/// Steps of Newton's method, and halvings.
const STEPS: usize = 80;

/// The coefficients of the cosine series through samples over half a period.
pub(super) fn cosines(samples: &[Pair], which: usize) -> Vec<f64> {
    let count = samples.len() - 1;
    let table: Vec<f64> = (0..2 * count).map(|k| sin_cos(PI * k as f64 / count as f64).1).collect();
    let of = |k: usize| {
        let mut sum = 0.0;
        for (j, sample) in samples.iter().enumerate() {
            let weight = if j == 0 || j == count { 0.5 } else { 1.0 };
            sum += weight * sample[which] * table[j * k % (2 * count)];
        }
        2.0 * sum / count as f64
    };
    let mut coefficients: Vec<f64> = (0..count).map(of).collect();
    let first = coefficients.first().map_or(0.0, |c| c.abs());
    while coefficients.last().is_some_and(|c| c.abs() < 1e-18 * first) {
        let _: Option<f64> = coefficients.pop();
    }
    coefficients
}

/// The integral of a cosine series from zero.
pub(super) fn sines(coefficients: &[f64], p: f64) -> f64 {
    let (sine, cosine) = sin_cos(p);
    let (mut one, mut two) = (0.0, 0.0);
    for (k, c) in coefficients.iter().enumerate().skip(1).rev() {
        (one, two) = (c / k as f64 + 2.0 * cosine * one - two, one);
    }
    0.5 * coefficients.first().copied().unwrap_or(0.0) * p + sine * one
}
