//! Energies that just reach the top of a hill at the center.
//!
//! The one idea: what little of the energy is left on the top, E − V(0), makes a length of its own, within which ψ rises
//! from 0 to what a hill just climbed turns by. So impact parameters go on inward by octaves until ψ is small; and since V
//! is rounded there as a whole, ψ rises or falls only where it does so by more than that makes of it.

use super::{Sample, Structure, sampled};
use crate::Result;
use crate::numerics::elementary::Exponential;
use crate::parallel::Ticker;
use crate::scattering::deflection::{Deflection, Status};
use core::f64::consts::LN_2;

/// As parts of the energy: what may be left on a top whose length is not seen from outside, …
const NEAR_TOP: f64 = 1.0 / (1 << 20) as f64;
/// … and up to which it matters how V is rounded there, …
const LEVEL: f64 = 64.0 * f64::EPSILON;
/// … at impact parameters up to this part of the potential's length.
const WITHIN: f64 = 1.0 / (1 << 12) as f64;
/// What a rounding of V makes of ψ: so many times its part of how steeply G rises.
const NOISE: f64 = 1000.0 * f64::EPSILON;
/// As parts of itself: what is off by more is not told.
const MOST_NOISE: f64 = 0.1;
/// Samples to an octave, further in than others: a hill has but one rainbow there.
const PER_OCTAVE: i32 = 4;
/// Further in than ψ is that small nothing else comes.
const SMALL: f64 = 1e-4;
/// Octaves at most: all there are.
const MOST: i32 = 1100;

impl Structure<'_> {
    /// What is left on the top of a hill, if that is little.
    fn near_top(&self) -> Option<f64> {
        self.deflector.left_on_top(self.energy).filter(|rest| rest.abs() <= NEAR_TOP)
    }

    /// Whether it matters how V is rounded on the top.
    fn is_level(&self) -> bool {
        self.near_top().is_some_and(|rest| rest.abs() <= LEVEL)
    }

    /// Deflections of increasing impact parameters; about a top that is just reached, what can be told of them.
    ///
    /// # Errors
    /// As [`Deflector::deflect`](super::Deflector::deflect).
    pub(super) fn deflections(&self, places: &[f64], ticker: &mut Ticker<'_>) -> Result<Vec<Deflection>> {
        let energies = vec![self.energy; places.len()];
        let within = if self.is_level() { places.partition_point(|b| *b < WITHIN * self.length) } else { 0 };
        let ((inner, places), (energy, energies)) = (places.split_at(within), energies.split_at(within));
        let mut found = self.deflector.deflect_what_can_be_told((energy, inner), true, 1, ticker)?;
        found.extend(self.deflector.deflect(energies, places, true, 1, ticker)?);
        Ok(found)
    }

    /// What is told of samples from b = 0 on where the energy is just that of a hill at the center, and between them more.
    ///
    /// # Errors
    /// As [`Deflector::deflect`](super::Deflector::deflect).
    pub(super) fn about_top(&self, samples: Vec<Sample>, ticker: &mut Ticker<'_>) -> Result<Vec<Sample>> {
        let Some(rest) = self.near_top() else { return Ok(samples) };
        let turns = matches!(samples.as_slice(),
            [head_on, next, ..] if head_on.b == 0.0 && head_on.derivative * next.derivative < 0.0);
        if rest.abs() > LEVEL && !(rest > 0.0 && turns) {
            return Ok(samples);
        }
        let mut all = Vec::with_capacity(samples.len());
        let mut samples = samples.into_iter().peekable();
        // With nothing left it stays on the top: head-on is no limit of what comes beside it.
        all.extend(samples.next_if(|sample| sample.b == 0.0).filter(|_| rest != 0.0));
        if rest > 0.0
            && let Some(first) = samples.peek()
        {
            all.extend(self.further_in(first.b, ticker)?);
        }
        all.extend(samples);
        let within = all.partition_point(|sample| sample.b < WITHIN * self.length);
        let outside = all.split_off(within);
        all.retain(|sample| self.is_told(sample));
        let mut told = self.without_noise(&all);
        told.extend(outside);
        Ok(told)
    }

    /// Samples within an impact parameter, down to where ψ is small or not told.
    fn further_in(&self, first: f64, ticker: &mut Ticker<'_>) -> Result<Vec<Sample>> {
        let mut found: Vec<Sample> = Vec::new();
        for octave in 0..MOST {
            let part =
                |k: i32| Exponential::exp(-f64::from(octave * PER_OCTAVE + k) * LN_2 / f64::from(PER_OCTAVE));
            let b: Vec<f64> = (1..=PER_OCTAVE).map(|k| first * part(k)).filter(|b| b.is_normal()).collect();
            let energies = vec![self.energy; b.len()];
            let deflections = self.deflector.deflect_what_can_be_told((&energies, &b), true, 1, ticker)?;
            let scattered = b.iter().zip(&deflections).filter(|(_, found)| found.status != Status::Captured);
            let samples =
                scattered.map(|(b, found)| sampled(*b, Some(found))).filter(|sample| self.is_told(sample));
            let before = found.len();
            found.extend(samples);
            if found.len() == before || found.last().is_some_and(|sample| sample.angle.abs() < SMALL) {
                break;
            }
        }
        found.reverse();
        Ok(found)
    }

    /// Of a sample, by what part of itself rounding may change ψ.
    fn noise(&self, sample: &Sample) -> f64 {
        if sample.b == 0.0 {
            return 0.0;
        }
        NOISE / self.deflector.steepness(self.energy, sample.b, sample.closest_approach).abs()
    }

    /// Whether a sample tells more of ψ than rounding.
    fn is_told(&self, sample: &Sample) -> bool {
        sample.angle.is_finite() && sample.derivative.is_finite() && self.noise(sample) < MOST_NOISE
    }

    /// Those at which ψ goes on as it did, or turns for more than noise, and which of both.
    fn without_noise(&self, samples: &[Sample]) -> Vec<Sample> {
        let unsure = |at: usize| self.noise(&samples[at]) * samples[at].angle.abs().min(1.0);
        // The ends of the pieces in which ψ rises (1) or falls (−1), each with the sign of the piece that ends there.
        let (mut ends, mut sign, mut farthest, mut anchor) = (Vec::new(), 0.0_f64, 0, 0);
        for at in 1..samples.len() {
            // From one of those about the farthest that is known best.
            let moved = samples[at].angle - samples[anchor].angle;
            let told = moved.abs() > unsure(at) + unsure(anchor);
            if told && sign * moved <= 0.0 {
                if sign != 0.0 {
                    ends.push((farthest, sign));
                }
                (sign, farthest, anchor) = (moved.signum(), at, at);
                continue;
            }
            if sign * (samples[at].angle - samples[farthest].angle) >= 0.0 {
                farthest = at;
            }
            if told || unsure(at) < unsure(anchor) || sign * moved >= 0.0 {
                anchor = at;
            }
        }
        ends.push((farthest, sign));
        let mut told: Vec<Sample> =
            samples.first().map(|first| Sample { way: ends[0].1, ..*first }).into_iter().collect();
        let mut from = 1;
        for (piece, (end, sign)) in ends.iter().enumerate() {
            for sample in samples.iter().take(end + 1).skip(from) {
                if told.last().is_some_and(|last| sign * (sample.angle - last.angle) > 0.0) {
                    told.push(Sample { way: *sign, ..*sample });
                }
            }
            // The extremum is on either side of the last: which, its neighbors tell.
            if piece + 1 < ends.len()
                && told.len() > 1
                && let Some(last) = told.last_mut()
            {
                last.way = 0.0;
            }
            from = end + 1;
        }
        told
    }
}
