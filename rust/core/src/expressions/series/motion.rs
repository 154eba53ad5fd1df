//! A motion from its equations: coefficients of rates and those of the state that follow from them, order by order.
//!
//! The one idea: between two orders there are a few numbers to be moved, so the way through all orders is one kernel.

use super::super::execute::Scalar;
use super::{Coefficient, Expansion, Series, recurrence};
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
    let Series { body, inputs, outputs, variables, inverses, .. } = room.series;
    let (numbers, scratch) = (V::view_mut(room.numbers), V::view_mut(room.scratch));
    let Coefficients { order, len, q, v } = into;
    let (q, v, unit) = (V::view_mut(q), V::view_mut(v), V::load(unit));
    let per_unit = V::one() / unit;
    let unit_of_rates = if second_order { unit * unit } else { unit };
    for n in 0..order {
        for index in 0..len {
            numbers[inputs[index] + n] = q[n * len + index];
            if second_order && velocity {
                numbers[inputs[len + index] + n] = v[n * len + index] * per_unit;
            }
        }
        if n <= 2 {
            numbers[inputs[*variables] + n] = match n {
                0 => V::load(t),
                1 => unit,
                _ => V::zero(),
            };
        }
        recurrence::expand(body, (n, inverses[n]), numbers, scratch);
        let (of_rates, further) = (scaled::<S, V>(&inverse[n + 1]), scaled::<S, V>(&inverse[n + 2]));
        for (index, &place) in outputs[..len].iter().enumerate() {
            // Constants have no further coefficient.
            let constant = n > 0 && place < inputs[0];
            let rate = if constant { V::zero() } else { numbers[place + n] };
            let raised = over(rate * unit_of_rates, of_rates);
            if second_order {
                v[(n + 1) * len + index] = raised;
                q[(n + 2) * len + index] = over(raised, further);
            } else {
                q[(n + 1) * len + index] = raised;
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
