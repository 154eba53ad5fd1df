//! A motion and a small difference of it as one system: `q'' = a(q, v)`, `δ'' = (∂a/∂q) δ + (∂a/∂v) δ'`.
//!
//! The one idea: the derivative of all forces in one direction is a difference of evaluations next to each other, four of
//! them, so that neither rounding nor the higher derivatives are felt; that two of them tell the same as the other two shows
//! it. So every force has it, and the equations of the difference are linear: its length matters to nobody.

use crate::error::Result;
use crate::forces::{Dynamics, ForceTerm};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::real::{Mask, Real};
use crate::ode::system::{Form, Needs, System, Taken};
use crate::parallel::Ticker;
use crate::scene::layout::Layout;
use crate::scene::plan::Plan;
use crate::scene::unit::{Prepared, dynamics};
use std::sync::Arc;

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
/// but not by more, and longer where they are smaller if nothing acts but what falls as 1/r².
const LEAST: f64 = 1e-4;
const MOST: f64 = 1e4;
/// They are apart by this part of the state at least, wherever that has gone: so much of it rounding leaves alone.
const OF_STATE: f64 = 1.0 / 1_073_741_824.0;

/// The size of places and velocities of a unit, by which differences of them are measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub(super) place: f64,
    pub(super) velocity: f64,
    /// Whether they are those of the whole motion, and not of its start.
    pub(super) of_motion: bool,
}

/// Units beside small differences of them. States hold coordinates of the motion, then as many of the difference; velocities
/// likewise.
pub(super) struct Variation {
    dynamics: Dynamics<Lanes>,
    /// One over the size of a distance and of a velocity.
    measures: [Lanes; 2],
    /// Whether the lanes are bodies of one unit.
    together: bool,
    /// 1 in the places of bodies, and 0 where there are none.
    bodies: Vec<Lanes>,
    /// How large accelerations are usually; where that is not known, as they are where it begins.
    usual: Lanes,
    begins: bool,
    /// By what factor forces may change more slowly than there.
    slowest: f64,
    /// What the time was when it began to be counted.
    pub begun: f64,
    /// A state, and the accelerations there.
    places: Vec<Lanes>,
    velocities: Vec<Lanes>,
    accelerations: Vec<Lanes>,
    /// The slope over two lengths.
    farther: Vec<Lanes>,
}

impl Variation {
    /// Of units in the lanes.
    pub(super) fn new(plan: &Plan, units: &[Prepared], sizes: &[Size], threads: usize) -> Self {
        let views: Vec<&Prepared> = units.iter().collect();
        let (dynamics, layout) = (dynamics(plan, &views, threads), plan.layout);
        let falls =
            |force: &Arc<dyn ForceTerm>| force.as_newtonian().is_some_and(|(_, softening)| softening == 0.0);
        let mut measures = [Lanes::one(); 2];
        let mut usual = Lanes::zero();
        for (lane, size) in sizes.iter().enumerate() {
            let lanes = layout.mask(lane);
            for (measure, size) in measures.iter_mut().zip([size.place, size.velocity]) {
                *measure = Lanes::select(lanes, Lanes::splat(1.0 / size), *measure);
            }
            if size.of_motion {
                let own = Lanes::splat(size.velocity * size.velocity / size.place);
                usual = Lanes::select(lanes, own, usual);
            }
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
            together: layout == Layout::Packed,
            bodies,
            usual,
            begins: true,
            slowest: if plan.forces.iter().all(falls) { MOST } else { 1.0 },
            begun: 0.0,
            places: room.clone(),
            velocities: room.clone(),
            accelerations: room.clone(),
            farther: room,
        }
    }

    /// The sizes of a place and of a velocity.
    pub(super) fn sizes(&self) -> [Lanes; 2] {
        self.measures.map(|measure| Lanes::one() / measure)
    }

    /// Numbers of a place, and of its difference.
    pub(super) const fn half(&self) -> usize {
        self.dynamics.shape.len()
    }

    /// The lengths of differences, of places and, where they are known, velocities.
    pub(super) fn length(&self, places: &[Lanes], velocities: &[Lanes]) -> Lanes {
        let [of_places, of_velocities] = self.measures;
        self.root(
            Lanes::pass(Square { of: places, measure: &of_places })
                + Lanes::pass(Square { of: velocities, measure: &of_velocities }),
        )
    }

    /// The root of a sum of squares over a unit.
    fn root(&self, squares: Lanes) -> Lanes {
        if self.together { Lanes::splat(squares.0.iter().sum::<f64>().sqrt()) } else { squares.sqrt() }
    }

    /// Over what part of the size of a unit forces change, where accelerations are these.
    fn reach(&mut self, a: &[Lanes]) -> Lanes {
        let large = self.root(Lanes::pass(Square { of: a, measure: &Lanes::one() }));
        if core::mem::take(&mut self.begins) {
            self.usual = Lanes::select(Lanes::zero().less(self.usual), self.usual, large);
        }
        let usual = self.usual;
        // Of what falls as 1/r², r. Where nothing acts at the start that tells nothing.
        let reach = (usual / large).sqrt().max(Lanes::splat(LEAST)).min(Lanes::splat(self.slowest));
        let known = Lanes::zero().less(usual).and(Lanes::zero().less(large));
        Lanes::select(known, reach, Lanes::one())
    }

    /// The slope of accelerations along a difference, over so many steps to both sides.
    fn slope(
        &mut self,
        (t, steps): (&Lanes, f64),
        (q, apart): (&[Lanes], &[Lanes]),
        (v, parting): (&[Lanes], &[Lanes]),
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
            Lanes::pass(Accumulate { values: apart, weight: &along, to: &mut self.places });
            Lanes::pass(Accumulate { values: parting, weight: &along, to: velocities });
            self.dynamics.acceleration(t, &self.places, velocities, &mut self.accelerations, ticker)?;
            let weight = Lanes::splat(sign / (2.0 * steps)) / step;
            Lanes::pass(Accumulate { values: &self.accelerations, weight: &weight, to: slope });
        }
        Ok(())
    }
}

impl System<Lanes> for Variation {
    fn form(&self) -> Form {
        Form::SecondOrder(2 * self.half())
    }

    fn needs(&self) -> Needs {
        let Needs { time, velocity, rotation } = self.dynamics.needs();
        Needs { time, velocity: velocity || rotation, rotation: false }
    }

    fn evaluations(&self) -> u64 {
        self.dynamics.evaluations()
    }

    fn stops_midway(&self) -> bool {
        self.dynamics.stops_midway()
    }

    fn acceleration(
        &mut self,
        t: &Lanes,
        q: &[Lanes],
        v: &[Lanes],
        a: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let half = self.half();
        let t = *t + Lanes::splat(self.begun);
        let (q, apart) = q.split_at(half);
        // Where nobody looks at velocities they may not be there.
        let (v, parting) = v.split_at(half.min(v.len()));
        let (a, change) = a.split_at_mut(half);
        self.dynamics.acceleration(&t, q, v, a, ticker)?;
        for (place, (&x, &there)) in self.places.iter_mut().zip(q.iter().zip(&self.bodies)) {
            *place = x * there;
        }
        let far = Lanes::splat(OF_STATE) * self.length(&self.places, v);
        let length = self.length(apart, parting);
        let (mut step, least) = ((Lanes::splat(APART) * self.reach(a)).max(far) / length, far / length);
        // A slope of forces that change over the size of a unit.
        let usual = self.root(Lanes::pass(Square { of: a, measure: &Lanes::one() })) * length;
        // What was tried before, where a shorter length was tried, and where that has told no more: there rounding is seen.
        let (mut before, mut tried, mut settled) = ((step, Lanes::zero()), Bits(0), Bits(0));
        for shorter in 0..=SHORTER + 1 {
            self.slope((&t, 1.0), (q, apart), (v, parting), step, change, ticker)?;
            let mut farther = core::mem::take(&mut self.farther);
            self.slope((&t, 2.0), (q, apart), (v, parting), step, &mut farther, ticker)?;
            let [of_slopes, of_differences] = Lanes::pass(Extrapolated { slopes: change, farther: &farther });
            self.farther = farther;
            let beside = self.root(of_slopes).max(usual);
            let part = self.root(of_differences) / beside;
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

    fn seen_until(&mut self, step: &Taken<'_, Lanes>) -> Result<Option<Lanes>> {
        let from = step.from + Lanes::splat(self.begun);
        Taken { from, ..*step }.ask_first_of_halves(self.half(), &mut self.dynamics)
    }

    fn longest_step(&self, (q, v): (&[Lanes], &[Lanes]), a: &[Lanes]) -> Option<Lanes> {
        let half = self.half();
        self.dynamics.longest_step((&q[..half], &v[..half]), &a[..half])
    }
}

/// The sum of squares of numbers, each times the measure.
struct Square<'a, S> {
    of: &'a [S],
    measure: &'a S,
}

impl<S: Element> Pass<S> for Square<'_, S> {
    type Output = S;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S {
        let measure = *V::view_one(self.measure);
        let mut sum = V::zero();
        for &number in V::view(self.of) {
            let number = number * measure;
            sum = number.multiply_add(number, sum);
        }
        sum.store()
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
struct Accumulate<'a, S> {
    values: &'a [S],
    weight: &'a S,
    to: &'a mut [S],
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
