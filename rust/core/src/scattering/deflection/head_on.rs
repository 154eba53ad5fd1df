//! Pairs that come head-on or nearly so: through an open center, or round one that attracts, by the limit of b → 0.

use super::pairs::Quadrature;
use super::profile::Center;
use super::turning::{Critical, Way};
use super::{Deflection, Status};
use crate::Result;
use crate::numerics::elementary::{Exponential, ln};
use crate::parallel::Ticker;
use core::f64::consts::{LN_2, PI};
use nalgebra::{Matrix4, Vector4};

/// An impact parameter that stands for zero at an open center, in units of the potential's own length.
const TINY: f64 = 1.0 / (1 << 26) as f64;
/// Of what has less than this part of its energy left on the top of a hill there, it is a part of that: as E − V(0) to 3/2, as
/// impact parameters are that a cone or what is rounder tells from zero.
const BARELY: f64 = 1e-6;
/// The logarithm of 1e-70, the least turning point beside a center that attracts, as a part of where |V| is the energy: nearer
/// to it r² V″ and (b/r₀)³ leave the range of numbers, and what remains is a wrong number.
const NEAREST: f64 = -161.18;
/// And where b is a smaller part of that it is as good as 0, …
const NOTHING: f64 = 1.0 / (1_u64 << 60) as f64;
/// … if |V| there is so many times the energy: where V falls slowly it is not, however small b is.
const FAR_ABOVE: f64 = 4.0 / f64::EPSILON;
/// Newton's steps to where a slow attraction turns, from what is off by a part of E/V at most.
const STEPS: usize = 4;

/// Where the first of what an angle beside a center that attracts has beyond its limit is so small, its derivative, which
/// loses as many digits to rounding, is told by so many powers of b instead, …
const FEW: f64 = 1e-5;
const TERMS: usize = 4;

/// … which differ by that at least, at b where the next power is nothing beside one, …
const ONE_POWER: f64 = 1e-6;
const NEXT: f64 = 1e-14;

/// … if one more angle agrees with them: to some thousand of its roundings.
const SAME: f64 = 1e-12;

impl Quadrature<'_> {
    /// The impact parameter up to which a pair is taken for one that comes head-on, and the one at which that is found.
    #[inline(always)]
    pub(super) fn as_head_on(&self, energy: f64) -> (f64, f64) {
        match self.profile.center() {
            Center::Attractive(power) if power < 2.0 => self.around(energy, power),
            Center::Open(top) if energy > top && energy - top < BARELY * energy => {
                let left = (energy - top) / energy;
                (0.0, TINY * (left * left.sqrt()))
            }
            _ => (0.0, TINY),
        }
    }
    /// The same at a center that attracts as 1/rⁿ, where r₀ goes as b^(2/(2−n)).
    fn around(&self, energy: f64, power: f64) -> (f64, f64) {
        let least = Exponential::exp(0.5 * (2.0 - power) * NEAREST);
        let reach = self.profile.grid().reach(energy, power);
        // At r₀ |V| is the energy times (reach/b)^(2n/(2−n)).
        let far_above = Exponential::exp(-ln(FAR_ABOVE) * 0.5 * (2.0 - power) / power);
        let nothing = reach * least.max(NOTHING.min(far_above));
        (nothing, nothing)
    }

    /// The derivatives of those that nearly meet a center which attracts, from the limit of b → 0 and angles beside it, if
    /// they differ by [powers](powers) of b.
    /// The integral for them is the rest of two that are larger as r₀ is smaller.
    ///
    /// # Errors
    /// As [`deflections`](Self::deflections).
    pub(super) fn beside_head_on(
        &self,
        energy: &[f64],
        b: &[f64],
        found: &mut [Deflection],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let power = match self.profile.center() {
            Center::Attractive(power) if power < 2.0 => power,
            _ => return Ok(()),
        };
        let [powers @ .., next] = powers(power);
        let mut near: Vec<(usize, f64)> = Vec::new();
        let mut critical = Critical::default();
        for (place, (energy, b)) in energy.iter().zip(b).enumerate() {
            let own = self.profile.take_energy(*energy);
            let reach = self.profile.give_length(self.profile.grid().reach(own, power));
            let beside = reach * Exponential::exp(ln(NEXT) / next);
            let few = reach * Exponential::exp(ln(FEW) / powers[0]);
            let mut bounces = || matches!(critical.way(self.profile, own, 0.0), Way::Bounces(_));
            if *b < few.min(beside) && found[place].status == Status::Scattered && bounces() {
                near.push((place, beside));
            }
        }
        if near.is_empty() {
            return Ok(());
        }
        // By halves of the first power.
        let shares: [f64; TERMS + 1] =
            core::array::from_fn(|k| Exponential::exp(-(k as f64) * LN_2 / powers[0]));
        let energies: Vec<f64> = near.iter().flat_map(|(place, _)| [energy[*place]; TERMS + 1]).collect();
        let beside: Vec<f64> = near.iter().flat_map(|(_, b)| shares.map(|share| share * b)).collect();
        let angles = Self { all: false, ..*self }.deflections(&energies, &beside, ticker)?;
        let limit = -PI * power / (2.0 - power);
        let terms = |share: f64| powers.map(|power| Exponential::exp(ln(share) * power));
        let rows: [[f64; TERMS]; TERMS] = core::array::from_fn(|k| terms(shares[k]));
        let solved = Matrix4::from(rows).transpose().lu();
        for ((place, beside), angles) in near.into_iter().zip(angles.chunks_exact(TERMS + 1)) {
            let off: [f64; TERMS + 1] = core::array::from_fn(|k| angles[k].angle - limit);
            let Some(factors) = solved.solve(&Vector4::from_fn(|k, _| off[k])) else { continue };
            let told: f64 =
                terms(shares[TERMS]).iter().zip(&factors).map(|(term, factor)| term * factor).sum();
            if (off[TERMS] - told).abs() <= SAME {
                let share = b[place] / beside;
                // Where b is zero the first term is all that counts, infinite or not.
                let count = if share == 0.0 { 1 } else { TERMS };
                let rest = |power: f64| if power == 0.0 { 1.0 } else { Exponential::exp(ln(share) * power) };
                let slope = |power: f64| power * rest(power - 1.0) / beside;
                let terms = powers.iter().zip(&factors).take(count);
                found[place].derivative = terms.map(|(power, factor)| slope(*power) * factor).sum();
            }
        }
        Ok(())
    }

    /// Up to that impact parameter, found at a tiny one where the center is open: through it, or round a point that attracts.
    pub(super) fn head_on(&self, energy: f64, b: f64, found: &mut Deflection) {
        let mut critical = Critical::default();
        match critical.way(self.profile, energy, 0.0) {
            Way::Through => {
                found.derivative = found.angle / self.as_head_on(energy).1;
                (found.angle, found.complement, found.closest_approach) = (0.0, PI, 0.0);
            }
            Way::Bounces(power) => {
                // Between the limit of b = 0 and what was found as the first of what is left out goes: as b, or as E/V at r₀.
                let limit = -PI * power / (2.0 - power);
                let share = b / self.as_head_on(energy).1;
                let faded = if b > 0.0 { Exponential::exp(ln(share) * left_out_power(power)) } else { 0.0 };
                let off = (found.angle - limit) * faded;
                found.angle = limit + off;
                found.complement = PI - found.angle.abs();
                found.error = found.error.max(off.abs());
                found.closest_approach = if b > 0.0 {
                    // As V goes on inward, which there is many times the energy.
                    let [inner, at] =
                        [found.closest_approach, self.profile.value(found.closest_approach) / energy];
                    turned_further_in(inner, at, power, share)
                } else {
                    0.0
                };
            }
            _ if b > 0.0 || found.is_unknown() => {}
            _ => (found.angle, found.complement) = (PI, 0.0),
        }
        if !self.all {
            found.derivative = f64::NAN;
        }
    }
}

/// As what power of b an angle goes to its limit at a center that attracts as 1/rⁿ.
fn left_out_power(power: f64) -> f64 {
    (2.0 * power / (2.0 - power)).min(1.0)
}

/// And the first of the powers that follow: products of b, of E/V at the turning point r₀, which goes as b^(2/(2−n)), and of
/// r₀ itself, as which V changes its power.
fn powers(power: f64) -> [f64; TERMS + 1] {
    let turning = 2.0 / (2.0 - power);
    let factors = [1.0, power * turning, turning];
    let mut found = [0.0; TERMS + 1];
    for at in 0..=TERMS {
        // The least sum of one more factor that is beyond the last.
        let last = if at == 0 { 0.0 } else { found[at - 1] };
        let sums = [0.0].into_iter().chain(found).flat_map(|power| factors.map(|factor| power + factor));
        found[at] = sums.filter(|sum| *sum > last + ONE_POWER).fold(f64::INFINITY, f64::min);
    }
    found
}

/// Where r²(1 − V/E) is `share`² of what it is at r₁, from V/E at r₁ and its power: by Newton's steps in ln r, of a function
/// that is bent to one side, so that they do not swing.
fn turned_further_in(inner: f64, value: f64, power: f64, share: f64) -> f64 {
    let wanted = 2.0 * ln(share) + ln(1.0 - value);
    // Without the energy that is ln(−V/E).
    let mut way = (wanted - ln(-value)) / (2.0 - power);
    for _ in 0..STEPS {
        let pull = -value * Exponential::exp(-power * way);
        if pull == f64::INFINITY {
            break;
        }
        let off = 2.0f64.mul_add(way, ln(1.0 + pull)) - wanted;
        way -= off / (2.0 - power * (pull / (1.0 + pull)));
    }
    inner * Exponential::exp(way)
}
