//! How long pairs stay apart.
//!
//! The one idea: a force along the line between two bodies may turn about where they meet, and a series goes on there as if
//! nothing were. A step is held to where the distance is sure to vanish nowhere: what lessens `s`, or `d` along the line on
//! which the pair was, up to the end of the step must leave a part of it. Those that come head on so come nearer by that part
//! in each step, until they are so near that it makes no difference, and then pass to as far on the other side.

use super::pairs::Kept;
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::real::{Mask, Real};
use crate::ode::series::Jet;

/// What may be lost at most.
const SHARE: f64 = 0.875;
/// Of a step that is too long so much is tried next, and so often: none is left after.
const SHORTER: f64 = 0.75;
const TRIES: usize = 2560;
/// What is passed in so small a part of the time is near: shorter steps time would not feel.
const BRIEFEST: f64 = 64.0 * f64::EPSILON;

/// The longest of steps up to one over which pairs stay apart.
pub(in crate::forces) struct Apart<'a, S> {
    pub(in crate::forces) kept: &'a Kept<S>,
    /// Of each register of pairs, the distance that makes no difference; infinite if meeting makes none.
    pub(in crate::forces) near: &'a [S],
    pub(in crate::forces) jet: &'a Jet<S>,
    pub(in crate::forces) h: &'a S,
}

impl<S: Element> Pass<S> for Apart<'_, S> {
    type Output = S;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S {
        match self.kept.components() {
            2 => self.run_in::<V, 2>(),
            _ => self.run_in::<V, 3>(),
        }
    }
}

impl<S: Element> Apart<'_, S> {
    #[inline(always)]
    fn run_in<V: View<S>, const C: usize>(self) -> S {
        let Self { kept, near, jet, h } = self;
        let (unit, forward) = (V::load(jet.unit), V::load(jet.forward));
        let mut step = V::load(*h) / unit;
        let least = V::splat(BRIEFEST) * V::load(jet.t).abs() / unit;
        for (register, &near) in V::view(near).iter().enumerate() {
            let (d, s) = kept.distances::<V, C>(register);
            let (d, s) = (&d[..jet.order], &s[..jet.order]);
            let (limit, near) = (s[0] * V::splat(SHARE), near * s[0].sqrt());
            let near = (along(&d[0], &d[1]).abs() * least).max(near);
            let beyond = V::select(near.less(s[0]), V::zero(), s[0] + s[0]);
            let beyond = V::select(V::splat(f64::MAX).less(near), near, beyond);
            for _ in 0..TRIES {
                let mut lost = V::zero();
                let mut order = s.len();
                for &coefficient in s[1..].iter().rev() {
                    order -= 1;
                    let change = if order % 2 == 1 { forward * coefficient } else { coefficient };
                    lost = (lost - change.min(V::zero())) * step;
                }
                let too_long = limit.less(lost);
                if !too_long.any() {
                    break;
                }
                let (mut lost, mut gone) = (V::zero(), V::zero());
                let mut order = d.len();
                for coefficients in d[1..].iter().rev() {
                    order -= 1;
                    let along = along(&d[0], coefficients);
                    let change = if order % 2 == 1 { forward * along } else { along };
                    lost = (lost - change.min(V::zero())) * step;
                    gone = (gone + along.abs()) * step;
                }
                let too_long = too_long.and(limit.less(lost)).and(beyond.less(gone));
                if !too_long.any() {
                    break;
                }
                step = V::select(too_long, step * V::splat(SHORTER), step);
            }
        }
        (step * unit).store()
    }
}

/// `d·other`.
#[inline(always)]
fn along<V: Real, const C: usize>(d: &[V; C], other: &[V; C]) -> V {
    let mut along = d[0] * other[0];
    for c in 1..C {
        along = d[c].multiply_add(other[c], along);
    }
    along
}
