//! How accelerations change along a direction, by forces that do not know it by formulas.
//!
//! The one idea: it is a difference of evaluations next to each other, four of them, so that neither rounding nor the higher
//! derivatives are felt; that two of them tell the same as the other two shows it. So every force has it.

use super::measures::{Measures, Size};
use crate::error::Result;
use crate::forces::Dynamics;
use crate::forces::derivative::Along;
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::real::{Mask, Real};
use crate::ode::system::System;
use crate::parallel::Ticker;
use crate::scene::layout::Layout;
use crate::scene::unit::Prepared;

/// How far apart the states are at which forces are compared, in lengths over which forces change, 2⁻¹²: of forces that fall as
/// 1/r² the fifth derivatives then leave 1e-13 of a derivative, and rounding leaves 1e-12.
const APART: f64 = 1.0 / 4096.0;
/// Slopes over one such length and over two differ by its square; where that is more than this part of them, forces change over
/// shorter ones, and so often at most it is made as much shorter …
const DIFFERENT: f64 = 1e-5;
const SHORTER: u32 = 3;
/// … that they differ by this part, of which the square is left.
const ALIKE: f64 = 1e-6;
/// That length is the size of a unit, shorter where accelerations are larger than is usual for it, as those of a body that falls,
/// but not by more.
const LEAST: f64 = 1e-4;
/// They are apart by this part of the state at least, wherever that has gone: so much of it rounding leaves alone.
const OF_STATE: f64 = 1.0 / 1_073_741_824.0;

/// Forces that are compared with themselves at neighboring states.
pub(super) struct Slopes {
    dynamics: Dynamics<Lanes>,
    measures: Measures,
    /// 1 in the places of bodies, and 0 where there are none.
    bodies: Vec<Lanes>,
    /// How large accelerations are usually; where that is not known, as they are where it begins.
    usual: Lanes,
    begins: bool,
    /// A state, and the accelerations there.
    places: Vec<Lanes>,
    velocities: Vec<Lanes>,
    accelerations: Vec<Lanes>,
    /// The slope over two lengths.
    farther: Vec<Lanes>,
}

impl Slopes {
    /// Of these forces on units in lanes.
    pub(super) fn new(
        dynamics: Dynamics<Lanes>,
        (layout, units): (Layout, &[Prepared]),
        (measures, sizes): (Measures, &[Size]),
    ) -> Self {
        let mut usual = Lanes::zero();
        for (lane, size) in sizes.iter().enumerate().filter(|(_, size)| size.of_motion) {
            let own = Lanes::splat(size.velocity * size.velocity / size.place);
            usual = Lanes::select(layout.mask(lane), own, usual);
        }
        let room = vec![Lanes::zero(); dynamics.shape.len()];
        let mut bodies = room.clone();
        for (lane, unit) in units.iter().enumerate() {
            for slot in 0..unit.unit.bodies.len() {
                unit.lay(slot, &mut bodies, lane, [1.0; 3]);
            }
        }
        Self {
            dynamics,
            measures,
            bodies,
            usual,
            begins: true,
            places: room.clone(),
            velocities: room.clone(),
            accelerations: room.clone(),
            farther: room,
        }
    }

    /// Over what part of the size of a unit forces change, where accelerations are so large.
    fn reach(&mut self, large: Lanes) -> Lanes {
        if core::mem::take(&mut self.begins) {
            self.usual = Lanes::select(Lanes::zero().less(self.usual), self.usual, large);
        }
        let usual = self.usual;
        // Of what falls as 1/r², r. Where nothing acts at the start that tells nothing.
        let reach = (usual / large).sqrt().max(Lanes::splat(LEAST)).min(Lanes::one());
        let known = Lanes::zero().less(usual).and(Lanes::zero().less(large));
        Lanes::select(known, reach, Lanes::one())
    }

    /// Writes into `change` how these accelerations change along a direction; `a` are all that there are.
    ///
    /// # Errors
    /// Those of an evaluation.
    pub(super) fn along(
        &mut self,
        (t, q, v): (&Lanes, &[Lanes], &[Lanes]),
        along: Along<'_, Lanes>,
        a: &[Lanes],
        change: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        for (place, (&x, &there)) in self.places.iter_mut().zip(q.iter().zip(&self.bodies)) {
            *place = x * there;
        }
        let (far, large) =
            (Lanes::splat(OF_STATE) * self.measures.length(&self.places, v), self.measures.size(a));
        let length = self.measures.length(along.q, along.v);
        let (mut step, least) = ((Lanes::splat(APART) * self.reach(large)).max(far) / length, far / length);
        // A slope of forces that change over the size of a unit.
        let usual = large * length;
        // What was tried before, where a shorter length was tried, and where that has told no more: there rounding is seen.
        let (mut before, mut tried, mut settled) = ((step, Lanes::zero()), Bits(0), Bits(0));
        for shorter in 0..=SHORTER + 1 {
            self.slope((t, 1.0), (q, v), along, step, change, ticker)?;
            let mut farther = core::mem::take(&mut self.farther);
            self.slope((t, 2.0), (q, v), along, step, &mut farther, ticker)?;
            let [of_slopes, of_differences] = Lanes::pass(Extrapolated { slopes: change, farther: &farther });
            self.farther = farther;
            let beside = self.measures.root(of_slopes).max(usual);
            let part = self.measures.root(of_differences) / beside;
            let worse = tried.and(before.1.less_equal(part));
            settled = settled.or(worse);
            let different = Lanes::splat(DIFFERENT).less(part).and(least.less(step)).and(settled.not());
            let different = if shorter < SHORTER { different } else { Bits(0) };
            if !worse.or(different).any() {
                break;
            }
            let (last, shortened_from) = (Lanes::select(worse, before.0, step), step);
            (before, tried) = ((shortened_from, part), different);
            let shortened = (step * (Lanes::splat(ALIKE) / part).sqrt()).max(least);
            step = Lanes::select(different, shortened, last);
        }
        Ok(())
    }

    /// The slope of accelerations along a difference, over so many steps to both sides.
    fn slope(
        &mut self,
        (t, steps): (&Lanes, f64),
        (q, v): (&[Lanes], &[Lanes]),
        direction: Along<'_, Lanes>,
        step: Lanes,
        slope: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        slope.fill(Lanes::zero());
        for sign in [1.0, -1.0] {
            let along = step * Lanes::splat(sign * steps);
            let velocities = &mut self.velocities[..v.len()];
            self.places.copy_from_slice(q);
            velocities.copy_from_slice(v);
            Lanes::pass(Accumulate { values: direction.q, weight: &along, to: &mut self.places });
            Lanes::pass(Accumulate { values: direction.v, weight: &along, to: velocities });
            self.dynamics.acceleration(t, &self.places, velocities, &mut self.accelerations, ticker)?;
            let weight = Lanes::splat(sign / (2.0 * steps)) / step;
            Lanes::pass(Accumulate { values: &self.accelerations, weight: &weight, to: slope });
        }
        Ok(())
    }
}

/// Takes out of slopes what they differ by from those over twice the length; the sums of squares of both.
struct Extrapolated<'a, S> {
    slopes: &'a mut [S],
    farther: &'a [S],
}

impl<S: Element> Pass<S> for Extrapolated<'_, S> {
    type Output = [S; 2];
    #[inline(always)]
    fn run<V: View<S>>(self) -> [S; 2] {
        let third = V::splat(1.0 / 3.0);
        let slopes = V::view_mut(self.slopes);
        let farther = &V::view(self.farther)[..slopes.len()];
        let (mut of_slopes, mut of_differences) = (V::zero(), V::zero());
        for i in 0..slopes.len() {
            let (slope, difference) = (slopes[i], slopes[i] - farther[i]);
            slopes[i] = difference.multiply_add(third, slope);
            of_slopes = slope.multiply_add(slope, of_slopes);
            of_differences = difference.multiply_add(difference, of_differences);
        }
        [of_slopes.store(), of_differences.store()]
    }
}

/// `to += weight·values`.
pub(super) struct Accumulate<'a, S> {
    pub(super) values: &'a [S],
    pub(super) weight: &'a S,
    pub(super) to: &'a mut [S],
}

impl<S: Element> Pass<S> for Accumulate<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let weight = *V::view_one(self.weight);
        let to = V::view_mut(self.to);
        let values = &V::view(self.values)[..to.len()];
        for i in 0..to.len() {
            to[i] = weight.multiply_add(values[i], to[i]);
        }
    }
}
