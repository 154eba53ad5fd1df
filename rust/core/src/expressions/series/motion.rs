//! A motion from its equations: coefficients of rates and those of the state that follow from them, order by order.
//!
//! The one idea: between two orders there are a few numbers to be moved, so the way through all orders is one kernel.

use super::super::execute::Scalar;
use super::expansion::{self, HIGHEST};
use super::numbers::Numbers;
use super::{Coefficient, Expansion, Series};
use crate::numerics::element::{Scaled, View};
use crate::numerics::integrals::over;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::tiered;

/// What a motion is made from.
#[derive(Clone, Copy, Debug)]
pub struct Equations<'a, S> {
    /// Whether the rates are accelerations.
    pub second_order: bool,
    /// Whether they look at velocities.
    pub velocity: bool,
    /// The time of the expansion, as the expressions count it.
    pub t: S,
    /// The unit of time of the coefficients.
    pub unit: S,
    /// 1/n.
    pub inverse: &'a [Scaled<S>],
    /// If the motion is counted otherwise than the expressions see it, or moved by more than them.
    pub seen: Option<Seen<'a, S>>,
}

/// How expressions see the motion of a body, and what else moves it.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a, S> {
    /// What the unit of time is multiplied with.
    pub time: &'a S,
    /// What velocities are multiplied with.
    pub velocity: &'a S,
    /// What accelerations are multiplied with: above zero, or zero where there is no body.
    pub rate: &'a S,
    /// What else moves it, if anything does.
    pub beside: Option<&'a Beside<S>>,
}

/// Accelerations of a body that are linear in its place and velocity, in the unit of time of the coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Beside<S> {
    /// At the beginning.
    pub first: [S; 3],
    /// Of each of its coordinates, component after component.
    pub of_places: [[S; 3]; 3],
    /// Of each of its velocities.
    pub of_velocities: [[S; 3]; 3],
}

/// Coefficients of a motion, order after order: those of order 0 are there (and of the second order the velocities'), the
/// others are found.
#[derive(Debug)]
pub struct Coefficients<'a, S> {
    /// How many coefficients of the rates there are to be.
    pub order: usize,
    /// Numbers of an order.
    pub len: usize,
    /// Of the coordinates, or of all numbers of a system of the first order.
    pub q: &'a mut [S],
    /// Of the velocities of a system of the second order, in the unit of time.
    pub v: &'a mut [S],
}

/// What a motion is expanded in.
pub struct Room<'a, S> {
    series: &'a Series,
    numbers: &'a mut [S],
    scratch: &'a mut [S],
}

impl<S: Coefficient> Expansion<S> {
    /// Expands a motion.
    pub fn motion(&mut self, equations: &Equations<'_, S>, into: Coefficients<'_, S>) {
        let Self { of, numbers, scratch } = self;
        S::motion(Room { series: of, numbers, scratch }, equations, into);
    }
}

#[inline(always)]
fn motion<S: Copy, V: View<S> + Scalar, const SEEN: bool>(
    room: Room<'_, S>,
    equations: &Equations<'_, S>,
    into: Coefficients<'_, S>,
) {
    let Equations { second_order, velocity, t, unit, inverse, seen } = *equations;
    let Series { body, inputs, outputs, variables, inverses, numbers: many, .. } = room.series;
    let (numbers, scratch) = (V::view_mut(room.numbers), V::view_mut(room.scratch));
    let Coefficients { order, len, q, v } = into;
    let (q, v, unit) = (V::view_mut(q), V::view_mut(v), V::load(unit));
    assert!(order <= HIGHEST, "no room for the order {order}");
    let (mut time_unit, mut per_unit) = (unit, V::one() / unit);
    let mut unit_of_rates = if second_order { unit * unit } else { unit };
    let mut beside = None;
    if let (true, Some(seen)) = (SEEN, seen) {
        time_unit = time_unit * V::load(*seen.time);
        per_unit = per_unit * V::load(*seen.velocity);
        unit_of_rates = unit_of_rates * V::load(*seen.rate);
        beside = seen.beside;
    }
    let acts = V::zero().less(unit_of_rates);
    let with_velocity = second_order && velocity;
    let time = inputs[*variables];
    (numbers[time], numbers[time + 1], numbers[time + 2]) = (V::load(t), time_unit, V::zero());
    // Indices in slices of one length need no further look, and no more to begin with.
    let (of_q, of_rates) = (&inputs[..len], &outputs[..len]);
    let of_v = if with_velocity { &inputs[len..][..len] } else { of_q };
    for n in 0..order {
        let now = &q[n * len..][..len];
        {
            let mut numbers = Numbers::new(numbers, *many);
            for i in 0..len {
                numbers.series_mut(of_q[i])[n] = now[i];
            }
            if with_velocity {
                let now = &v[n * len..][..len];
                for i in 0..len {
                    numbers.series_mut(of_v[i])[n] = now[i] * per_unit;
                }
            }
        }
        if n == 0 {
            expansion::values(body, numbers, scratch);
        } else {
            expansion::expand_further(body, (n, inverses[n]), &mut Numbers::new(numbers, *many), scratch);
        }
        let (once, twice) = (scaled::<S, V>(&inverse[n + 1]), scaled::<S, V>(&inverse[n + 2]));
        let numbers = Numbers::new(numbers, *many);
        let mut more = [V::zero(); 3];
        if let (true, Some(beside)) = (SEEN, beside) {
            more = beside.at::<V>(n, &q[n * len..], &v[n * len..]);
        }
        let first = if second_order { &mut *v } else { &mut *q };
        let raised = &mut first[(n + 1) * len..][..len];
        for i in 0..len {
            // Constants have no further coefficient.
            let place = of_rates[i];
            let rate = if place >= inputs[0] {
                numbers.series(place)[n]
            } else if n == 0 {
                numbers.value(place)
            } else {
                V::zero()
            };
            let mut rate = rate * unit_of_rates;
            if SEEN {
                // Where there is no body the expressions may be anything.
                rate = V::select(acts, rate, V::zero()) + more[i % 3];
            }
            raised[i] = over(rate, once);
        }
        if second_order {
            let (raised, again) = (&v[(n + 1) * len..][..len], &mut q[(n + 2) * len..][..len]);
            for i in 0..len {
                again[i] = over(raised[i], twice);
            }
        }
    }
}

impl<S: Copy> Beside<S> {
    /// The coefficients of an order.
    #[inline(always)]
    fn at<V: View<S>>(&self, n: usize, places: &[V], velocities: &[V]) -> [V; 3] {
        let mut sums = [V::zero(); 3];
        for i in 0..3 {
            if n == 0 {
                sums[i] = V::load(self.first[i]);
                continue;
            }
            for j in 0..3 {
                sums[i] = V::load(self.of_places[i][j]).multiply_add(places[j], sums[i]);
                sums[i] = V::load(self.of_velocities[i][j]).multiply_add(velocities[j], sums[i]);
            }
        }
        sums
    }
}

#[inline(always)]
fn scaled<S: Copy, V: View<S>>(&(high, low): &Scaled<S>) -> Scaled<V> {
    (V::load(high), V::load(low))
}

#[inline(always)]
fn lanes_body<V: Vector8 + Scalar + View<Lanes>>(
    room: Room<'_, Lanes>,
    equations: &Equations<'_, Lanes>,
    into: Coefficients<'_, Lanes>,
) {
    if equations.seen.is_some() {
        motion::<Lanes, V, true>(room, equations, into);
    } else {
        motion::<Lanes, V, false>(room, equations, into);
    }
}

#[inline(always)]
#[expect(clippy::extra_unused_type_parameters, reason = "the tier gives its instructions, not its lanes")]
fn one_body<V: Vector8>(room: Room<'_, f64>, equations: &Equations<'_, f64>, into: Coefficients<'_, f64>) {
    if equations.seen.is_some() {
        motion::<f64, f64, true>(room, equations, into);
    } else {
        motion::<f64, f64, false>(room, equations, into);
    }
}

tiered! {
    pub(super) fn lanes[][](room: Room<'_, Lanes>, equations: &Equations<'_, Lanes>, into: Coefficients<'_, Lanes>) = lanes_body;
    pub(super) fn one[][](room: Room<'_, f64>, equations: &Equations<'_, f64>, into: Coefficients<'_, f64>) = one_body;
}
