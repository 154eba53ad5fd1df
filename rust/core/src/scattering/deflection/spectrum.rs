//! How far a sum over equal steps is off, by the spectrum of what is summed.
//!
//! The one idea: with F(ξ) = ∫ f cos(ξw) dw the trapezoidal rule of step h errs by 2F(2π/h) + 2F(4π/h) + …, and sums with
//! cosines over the same nodes are F up to ξ = π/h. F falls as e^(−aξ), a the distance of the nearest singularity, and
//! swings: two sums of different steps agree by accident where it passes zero. So it is looked at where it is largest of
//! several frequencies above and several below; where it has fallen from those to these at least as fast as e^(−aξ), it is
//! taken to go on so, with an a that is well below what the potential's singularities allow. Where V repels everywhere, G
//! has no zeros near the real axis; others are not taken to fall on by much.
//! Source of the error: L. N. Trefethen, J. A. C. Weideman, SIAM Rev. 56 (2014) 385.

use super::nodes::{ABOVE, FREQUENCIES, Level, cosines};
use crate::numerics::elementary::Exponential;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::tiered;
use core::f64::consts::PI;

/// How fast F is taken to fall on, at most: where V repels, and else. π/2 is what r = 0 allows.
const RATES: [f64; 2] = [1.0, 0.0];
/// For what is between the frequencies that are looked at.
const SAFETY: f64 = 4.0;

/// Of eight pairs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spectrum {
    /// The largest F of the frequencies above, and of those below.
    above: Lanes,
    below: Lanes,
    /// The largest that those above make further up, if F goes on to fall.
    onward: Lanes,
    /// How much F must have fallen to be taken to.
    fallen: f64,
}

impl Default for Spectrum {
    fn default() -> Self {
        let empty = Lanes([0.0; WIDTH]);
        Self { above: empty, below: empty, onward: empty, fallen: 1.0 }
    }
}

impl Spectrum {
    /// How far the sums may be off.
    #[inline(always)]
    pub(super) fn error<V: Vector8>(&self) -> V {
        let (above, below) = (V::load(self.above), V::load(self.below));
        let fallen = (above * V::splat(self.fallen)).less_equal(below);
        V::splat(SAFETY) * V::select(fallen, V::load(self.onward), above)
    }
}

/// What F does that falls at a rate, with steps of one length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fall {
    /// From each of the frequencies above to the first that the steps do not see, 2π/h.
    onward: [f64; ABOVE],
    /// The inverse of what it does from the last of those below to the last of those above.
    fallen: f64,
}

impl Fall {
    /// Where V repels everywhere, and elsewhere.
    pub(super) fn both(step: f64) -> [Self; 2] {
        RATES.map(|rate| {
            let after = |sixteenths: usize| Exponential::exp(-rate * PI / step * sixteenths as f64 / 16.0);
            let apart = FREQUENCIES[ABOVE - 1] - FREQUENCIES[FREQUENCIES.len() - 1];
            Self {
                onward: core::array::from_fn(|at| after(32 - FREQUENCIES[at])),
                fallen: 1.0 / after(apart),
            }
        })
    }
}

/// Of nodes of several levels, of which there are `counts`, in their order: the finest is `level`.
#[inline(always)]
fn look<V: Vector8>(
    integrand: &[Lanes],
    counts: &[usize],
    half_start: &Lanes,
    series: &[Lanes; 3],
    level: &Level,
    fall: &Fall,
    found: &mut Spectrum,
) {
    const M: usize = FREQUENCIES.len();
    let mut sums = [V::load(*half_start); M];
    let integrand = V::view(integrand);
    let cosines = cosines();
    let mut from = 0;
    for (at, count) in counts.iter().enumerate() {
        let halved = counts.len() - 1 - at;
        for (k, value) in integrand[from..from + count].iter().enumerate() {
            let multiple = if at == 0 { k + 1 } else { 2 * k + 1 };
            let row = &cosines[(multiple << halved) % cosines.len()];
            for m in 0..M {
                sums[m] = value.multiply_add(V::splat(row[m]), sums[m]);
            }
        }
        from += count;
    }
    let step = V::splat(level.step);
    let (mut above, mut below, mut onward) = (V::zero(), V::zero(), V::zero());
    for m in 0..M {
        // The series is summed over all nodes, not only those that count.
        let mut size = sums[m] * step;
        for i in 0..3 {
            size = V::load(series[i]).multiply_subtract_from(V::splat(level.powers[m][i]), size);
        }
        let size = size.abs();
        if m < ABOVE {
            above = above.max(size);
            onward = onward.max(size * V::splat(fall.onward[m]));
        } else {
            below = below.max(size);
        }
    }
    found.above = above.store();
    found.below = below.store();
    found.onward = onward.store();
    found.fallen = fall.fallen;
}

tiered! {
    pub(super) fn spectrum[][](integrand: &[Lanes], counts: &[usize], half_start: &Lanes, series: &[Lanes; 3], level: &Level, fall: &Fall, found: &mut Spectrum) = look;
}
