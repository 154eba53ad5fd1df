//! What a step does not see of an expression: walls and pulses that are narrower than it.
//!
//! The one idea: each body is a trajectory by itself, whose equations are the expression and nothing else; what is unseen in
//! them is what [`Narrow`] finds. The other forces are in the way that the body goes.

use super::kernel::{Way, parameters, turned};
use super::{ExpressionForce, VARIABLES};
use crate::error::Result;
use crate::forces::context::{Arrangement, Context};
use crate::narrow::{Narrow, Stepped};
use crate::numerics::lanes::{Bits, Lanes, Vector8};
use crate::numerics::real::{Mask, Real};
use crate::ode::step_control::Controlled;
use crate::ode::system::{Form, Taken, Visited};
use crate::tiered;

/// What may be unseen of an expression, as a part of a velocity.
const TOLERANCE: f64 = 1e-10;
/// The most that an argument may move between two places where a method looks: what is less than e⁻⁸ there, is no more than some
/// thousand tolerances where it is greatest, or is felt.
const REACH: f64 = 8.0;
/// Components of a place.
const PLACE: usize = VARIABLES / 2;

/// An expression under watch.
pub(super) struct Unseen {
    way: Way,
    /// One for each row.
    rows: Vec<Narrow<Lanes>>,
    arrangement: Arrangement,
}

impl Unseen {
    /// Of an expression in which something may be unseen.
    pub(super) fn new(term: &ExpressionForce, context: &Context<'_>) -> Option<Self> {
        let features = term.expressions.narrow.as_ref()?;
        let way = Way::new(term, context);
        let tolerance = (!context.equal_steps).then_some(TOLERANCE);
        let stepped = Stepped { t0: way.t0, tolerance, reach: REACH };
        let parameters = parameters(term, context);
        let of_block = way.shape.rows / parameters.len();
        let row = |(row, force): (usize, &Lanes)| {
            // What the expression gives is no acceleration in its own units yet.
            let acceleration = *force * Lanes::splat(way.velocity / way.time);
            let values: Vec<Lanes> =
                parameters[row / of_block].iter().copied().chain([acceleration]).collect();
            Narrow::new(features, Form::SecondOrder(PLACE), stepped, &values)
        };
        let rows = way.force.iter().enumerate().map(row).collect();
        Some(Self { way, rows, arrangement: context.arrangement })
    }

    /// As [`System::seen_until`](crate::ode::system::System::seen_until).
    ///
    /// # Errors
    /// As that.
    pub(super) fn seen_until(&mut self, step: &Taken<'_, Lanes>) -> Result<Option<Lanes>> {
        let Self { way, rows, arrangement } = self;
        let time = Lanes::splat(way.time);
        let mut until: Option<Lanes> = None;
        for (row, narrow) in rows.iter_mut().enumerate() {
            let asked = step.asked.and(Lanes::zero().less(way.force[row]));
            if !asked.any() {
                continue;
            }
            let mut body = OfBody::default();
            take_body(way, row, (step.ends, step.rates), &mut body);
            let OfBody { ends: [before, after], rates: [first, last] } = &body;
            let visited = |lane: usize| way.visited(step, row, lane);
            let own = Taken {
                asked,
                from: step.from * time,
                h: step.h * time,
                ends: [before, after],
                rates: step.rates.is_some().then_some([first, last]),
                looks: step.looks,
                series: step.series,
                visited: step.visited.is_some().then_some(&visited),
            };
            if let Some(seen) = narrow.seen_until(&own)? {
                until = Some(until.map_or(seen, |until| until.min(seen)));
            }
        }
        Ok(until.map(|until| match arrangement {
            // Bodies of one system are on one step.
            Arrangement::Packed => -(-until).largest_lane(),
            Arrangement::Batched => until,
        }))
    }

    /// As [`System::calm`](crate::ode::system::System::calm).
    pub(super) fn calm(&mut self, step: &Taken<'_, Lanes>, times: f64) -> Bits {
        let Self { way, rows, arrangement } = self;
        let h = step.h * Lanes::splat(way.time);
        let mut calm = Bits(0xff);
        for (narrow, force) in rows.iter_mut().zip(&way.force) {
            let asked = step.asked.and(Lanes::zero().less(*force));
            if asked.any() {
                calm = calm.and(narrow.calm(&Taken { asked, h, ..*step }, times).or(asked.not()));
            }
        }
        match arrangement {
            Arrangement::Packed => Bits::splat(calm.all()),
            Arrangement::Batched => calm,
        }
    }
}

/// A body at the ends of a step: its place and its velocity, as the expression has them, and its acceleration.
#[derive(Default)]
struct OfBody {
    ends: [[Lanes; VARIABLES]; 2],
    rates: [[Lanes; PLACE]; 2],
}

#[inline(always)]
fn take_body_body<V: Vector8>(
    way: &Way,
    row: usize,
    (ends, rates): ([&[Lanes]; 2], Option<[&[Lanes]; 2]>),
    body: &mut OfBody,
) {
    for (state, into) in ends.into_iter().zip(&mut body.ends) {
        state_of::<V>(way, row, state, into);
    }
    let Some(rates) = rates else { return };
    let unit = V::splat(way.velocity / way.time);
    for (rates, into) in rates.into_iter().zip(&mut body.rates) {
        let mut acceleration = [V::zero(); PLACE];
        for c in 0..way.shape.components {
            acceleration[c] = V::load(rates[c * way.shape.rows + row]) * unit;
        }
        let acceleration = turned(&way.axes, acceleration, false);
        for c in 0..PLACE {
            into[c] = acceleration[c].store();
        }
    }
}

#[inline(always)]
fn state_of<V: Vector8>(way: &Way, row: usize, state: &[Lanes], into: &mut [Lanes; VARIABLES]) {
    let (rows, components) = (way.shape.rows, way.shape.components);
    let (mut place, mut velocity) = ([V::zero(); PLACE], [V::zero(); PLACE]);
    for c in 0..components {
        let x = V::load(state[c * rows + row]);
        place[c] = V::splat(way.place).multiply_add(x, V::splat(-way.origin[c]));
        velocity[c] = V::splat(way.velocity) * V::load(state[(components + c) * rows + row]);
    }
    let (place, velocity) = (turned(&way.axes, place, false), turned(&way.axes, velocity, false));
    for c in 0..PLACE {
        (into[c], into[PLACE + c]) = (place[c].store(), velocity[c].store());
    }
}

tiered! {
    fn take_body[][](way: &Way, row: usize, step: ([&[Lanes]; 2], Option<[&[Lanes]; 2]>), body: &mut OfBody) = take_body_body;
}

impl Way {
    /// Where a body came by in a step, if that is known.
    fn visited(&self, step: &Taken<'_, Lanes>, row: usize, lane: usize) -> Visited {
        let whole = step.visited.map(|visited| visited(lane)).unwrap_or_default();
        let of_body = |(place, state): (f64, Vec<f64>)| {
            let state: Vec<Lanes> = state.into_iter().map(Lanes::splat).collect();
            let mut body = OfBody::default();
            take_body(self, row, ([&state, &state], None), &mut body);
            (place, body.ends[0].iter().map(|number| number.0[lane]).collect())
        };
        whole.into_iter().map(of_body).collect()
    }
}
