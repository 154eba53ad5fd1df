//! Pairs that come head-on or nearly so: through an open center, or round one that attracts, by the limit of b → 0.

use super::pairs::Quadrature;
use super::profile::Center;
use super::turning::{Critical, Way};
use super::{Deflection, Status};
use crate::Result;
use crate::numerics::elementary::{Exponential, ln};
use crate::parallel::Ticker;
use core::f64::consts::PI;

/// An impact parameter that stands for zero at an open center, in units of the potential's own length.
const TINY: f64 = 1.0 / (1 << 26) as f64;
/// The logarithm of 1e-70, the least turning point beside a center that attracts, as a part of where |V| is the energy: nearer
/// to it r² V″ and (b/r₀)³ leave the range of numbers, and what remains is a wrong number.
const NEAREST: f64 = -161.18;
/// And where b is a smaller part of that it is as good as 0, …
const NOTHING: f64 = 1.0 / (1_u64 << 60) as f64;
/// … if |V| there is so many times the energy: where V falls slowly it is not, however small b is.
const FAR_ABOVE: f64 = 4.0 / f64::EPSILON;
/// Newton's steps to where a slow attraction turns, from what is off by a part of E/V at most.
const STEPS: usize = 4;

/// Up to that part of the distance where |V| is the energy an angle beside a center that attracts is a parabola: its cube
/// there is a part of 1e-10, and what its derivative loses to rounding, which goes as 1/b², is no more yet.
const PARABOLIC: f64 = 1e-5;

/// How well three angles agree that are a parabola's: some thousand of their roundings, and 1e-7 of what the last is from
/// the limit.
const SAME: f64 = 1e-12;

impl Quadrature<'_> {
    /// The impact parameter up to which a pair is taken for one that comes head-on, and the one at which that is found.
    #[inline(always)]
    pub(super) fn as_head_on(&self, energy: f64) -> (f64, f64) {
        match self.profile.center() {
            Center::Attractive(power) if power < 2.0 => self.around(energy, power),
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

    /// The derivatives of those that nearly meet a center which attracts, from the limit of b → 0 and two angles beside it,
    /// if ψ is a parabola there.
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
        let mut near: Vec<(usize, f64)> = Vec::new();
        let mut critical = Critical::default();
        for (place, (energy, b)) in energy.iter().zip(b).enumerate() {
            let own = self.profile.take_energy(*energy);
            let beside = self.profile.give_length(PARABOLIC * self.profile.grid().reach(own, power));
            let mut bounces = || matches!(critical.way(self.profile, own, 0.0), Way::Bounces(_));
            if *b < beside && found[place].status == Status::Scattered && bounces() {
                near.push((place, beside));
            }
        }
        if near.is_empty() {
            return Ok(());
        }
        let energies: Vec<f64> = near.iter().flat_map(|(place, _)| [energy[*place]; 3]).collect();
        let beside: Vec<f64> = near.iter().flat_map(|(_, b)| [*b, 0.5 * b, 0.25 * b]).collect();
        let angles = Self { all: false, ..*self }.deflections(&energies, &beside, ticker)?;
        let limit = -PI * power / (2.0 - power);
        for ((place, beside), three) in near.into_iter().zip(angles.chunks_exact(3)) {
            let secant = |k: usize, b: f64| (three[k].angle - limit) / b;
            let [outer, inner] = [secant(0, beside), secant(1, 0.5 * beside)];
            let (slope, bend) = (2.0 * inner - outer, (outer - inner) / (0.5 * beside));
            // A third angle tells whether it is a parabola, and no broken power of b.
            let near = 0.25 * beside;
            let found_there = three[2].angle - limit;
            if (found_there - near * (slope + bend * near)).abs() <= SAME {
                found[place].derivative = slope + 2.0 * bend * b[place];
            }
        }
        Ok(())
    }

    /// Up to that impact parameter, found at a tiny one where the center is open: through it, or round a point that attracts.
    pub(super) fn head_on(&self, energy: f64, b: f64, found: &mut Deflection) {
        let mut critical = Critical::default();
        match critical.way(self.profile, energy, 0.0) {
            Way::Through => {
                found.derivative = found.angle / TINY;
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
