//! What a step does not see of an expression: walls and pulses that are narrower than it.
//!
//! The one idea: each body is a trajectory by itself, whose equations are the expression and nothing else; what is unseen in
//! them is what [`Narrow`] finds. The other forces are in the way that the body goes.

use super::kernel::{Way, parameters, turned};
use super::{ExpressionForce, VARIABLES};
use crate::error::Result;
use crate::forces::context::{Arrangement, Context};
use crate::narrow::{Narrow, Stepped};
use crate::numerics::lanes::Lanes;
use crate::numerics::real::{Mask, Real};
use crate::ode::step_control::Controlled;
use crate::ode::system::{Form, Taken, Visited};

/// What may be unseen of an expression, as a part of a velocity.
const TOLERANCE: f64 = 1e-10;
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
        let stepped = Stepped { t0: way.t0, tolerance: Some(TOLERANCE) };
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
    /// None.
    pub(super) fn seen_until(&mut self, step: &Taken<'_, Lanes>) -> Result<Option<Lanes>> {
        let Self { way, rows, arrangement } = self;
        let time = Lanes::splat(way.time);
        let mut until: Option<Lanes> = None;
        for (row, narrow) in rows.iter_mut().enumerate() {
            let asked = step.asked.and(Lanes::zero().less(way.force[row]));
            if !asked.any() {
                continue;
            }
            let [before, after] = step.ends.map(|state| way.of_body(state, row));
            let rates = step.rates.map(|rates| rates.map(|rates| way.acceleration_of(rates, row)));
            let visited = |lane: usize| way.visited(step, row, lane);
            let own = Taken {
                asked,
                from: step.from * time,
                h: step.h * time,
                ends: [&before, &after],
                rates: rates.as_ref().map(|[before, after]| [&before[..], &after[..]]),
                nodes: step.nodes,
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
}

impl Way {
    /// The place and the velocity of the body in a row, as the expression has them.
    fn of_body(&self, state: &[Lanes], row: usize) -> [Lanes; VARIABLES] {
        let (rows, components) = (self.shape.rows, self.shape.components);
        let (mut place, mut velocity) = ([Lanes::zero(); PLACE], [Lanes::zero(); PLACE]);
        for c in 0..components {
            let of_place = Lanes::splat(self.place);
            place[c] = of_place.multiply_add(state[c * rows + row], Lanes::splat(-self.origin[c]));
            velocity[c] = Lanes::splat(self.velocity) * state[(components + c) * rows + row];
        }
        let [place, velocity] = [place, velocity].map(|x| turned(&self.axes, x, false));
        core::array::from_fn(|index| if index < PLACE { place[index] } else { velocity[index - PLACE] })
    }

    /// Its acceleration.
    fn acceleration_of(&self, rates: &[Lanes], row: usize) -> [Lanes; PLACE] {
        let mut found = [Lanes::zero(); PLACE];
        let unit = Lanes::splat(self.velocity / self.time);
        for (c, found) in found.iter_mut().enumerate().take(self.shape.components) {
            *found = rates[c * self.shape.rows + row] * unit;
        }
        turned(&self.axes, found, false)
    }

    /// Where it came by in a step, if that is known.
    fn visited(&self, step: &Taken<'_, Lanes>, row: usize, lane: usize) -> Visited {
        let whole = step.visited.map(|visited| visited(lane)).unwrap_or_default();
        let of_body = |(place, state): (f64, Vec<f64>)| {
            let state: Vec<Lanes> = state.into_iter().map(Lanes::splat).collect();
            (place, self.of_body(&state, row).iter().map(|number| number.0[lane]).collect())
        };
        whole.into_iter().map(of_body).collect()
    }
}
