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
fn motion<S: Copy, V: View<S> + Scalar>(
    room: Room<'_, S>,
    equations: &Equations<'_, S>,
    into: Coefficients<'_, S>,
) {
    let Equations { second_order, velocity, t, unit, inverse } = *equations;
    let Series { body, inputs, outputs, variables, inverses, numbers: many, .. } = room.series;
    let (numbers, scratch) = (V::view_mut(room.numbers), V::view_mut(room.scratch));
    let Coefficients { order, len, q, v } = into;
    let (q, v, unit) = (V::view_mut(q), V::view_mut(v), V::load(unit));
    assert!(order <= HIGHEST, "no room for the order {order}");
    let per_unit = V::one() / unit;
    let unit_of_rates = if second_order { unit * unit } else { unit };
    let with_velocity = second_order && velocity;
    let time = inputs[*variables];
    (numbers[time], numbers[time + 1], numbers[time + 2]) = (V::load(t), unit, V::zero());
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
            raised[i] = over(rate * unit_of_rates, once);
        }
        if second_order {
            let (raised, again) = (&v[(n + 1) * len..][..len], &mut q[(n + 2) * len..][..len]);
            for i in 0..len {
                again[i] = over(raised[i], twice);
            }
        }
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
    motion::<Lanes, V>(room, equations, into);
}

#[inline(always)]
#[expect(clippy::extra_unused_type_parameters, reason = "the tier gives its instructions, not its lanes")]
fn one_body<V: Vector8>(room: Room<'_, f64>, equations: &Equations<'_, f64>, into: Coefficients<'_, f64>) {
    motion::<f64, f64>(room, equations, into);
}

tiered! {
    pub(super) fn lanes[][](room: Room<'_, Lanes>, equations: &Equations<'_, Lanes>, into: Coefficients<'_, Lanes>) = lanes_body;
    pub(super) fn one[][](room: Room<'_, f64>, equations: &Equations<'_, f64>, into: Coefficients<'_, f64>) = one_body;
}
