//! What a step does not see of a formula of a torque: pulses and walls that are narrower than it.
//!
//! The one idea: as of a formula on points, each body is a trajectory by itself, of what the formula looks at; how its
//! orientation and its spin go, the other loads among their causes, is the way on which it is followed.

use super::Loads;
use super::expressed::{Expressed, Way, loaded, splat};
use crate::error::Result;
use crate::narrow::{Narrow, Stepped};
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::real::Real;
use crate::ode::system::{Form, Taken};
use crate::rigid::motion::bodies::{Arrangement, LaneBody};
use crate::rigid::motion::formula::{SPIN, VARIABLES};
use crate::rigid::motion::vectors::{cross, product, turned_back};
use crate::tiered;

/// What may be unseen of a formula, as a part of an angular velocity.
const TOLERANCE: f64 = 1e-10;
/// The most that an argument may move between two places where a method looks.
const REACH: f64 = 8.0;

/// A formula under watch, where steps can be shorter.
pub(in crate::rigid::motion) struct Unseen {
    way: Way,
    narrow: Narrow<Lanes>,
}

impl Loads {
    /// The formulas in which something may be unseen.
    pub(in crate::rigid::motion) fn watched(&self, bodies: &[LaneBody]) -> Vec<Unseen> {
        self.formulas.iter().filter_map(|formula| Unseen::new(formula, &bodies[formula.way.body])).collect()
    }
}

impl Unseen {
    fn new(expressed: &Expressed, of: &LaneBody) -> Option<Self> {
        let Expressed { way, torque, narrow, parameters, .. } = expressed;
        let stepped = Stepped { t0: way.t0, tolerance: Some(TOLERANCE), reach: REACH };
        let [a, b, c] = of.inverse;
        // About the axis that is turned most easily.
        let acceleration = a.max(b).max(c) * Lanes::splat(torque * way.spin / way.time);
        let values: Vec<Lanes> = parameters.iter().copied().chain([acceleration]).collect();
        let narrow = Narrow::new(narrow.as_ref()?, Form::FirstOrder(VARIABLES), stepped, &values);
        Some(Self { way: way.clone(), narrow })
    }

    /// As [`System::seen_until`](crate::ode::system::System::seen_until), of the state of all bodies.
    pub(in crate::rigid::motion) fn seen_until(
        &mut self,
        step: &Taken<'_, Lanes>,
        arrangement: &Arrangement,
    ) -> Result<Option<Lanes>> {
        let mut numbers = [[[Lanes::zero(); VARIABLES]; 2]; 2];
        for end in 0..2 {
            let rates = step.rates.map(|rates| rates[end]);
            at_an_end(&self.way, arrangement, (step.ends[end], rates), &mut numbers[end]);
        }
        let [[first, of_first], [last, of_last]] = &numbers;
        let time = Lanes::splat(self.way.time);
        self.narrow.seen_until(&Taken {
            from: step.from * time,
            h: step.h * time,
            ends: [first, last],
            rates: step.rates.is_some().then_some([of_first, of_last]),
            visited: None,
            ..*step
        })
    }
}

tiered! {
    fn at_an_end[][](way: &Way, arrangement: &Arrangement, of: (&[Lanes], Option<&[Lanes]>), into: &mut [[Lanes; VARIABLES]; 2]) = at_an_end_body;
}

/// What the formula looks at, and how fast that changes in its units.
#[inline(always)]
fn at_an_end_body<V: Vector8>(
    way: &Way,
    arrangement: &Arrangement,
    (state, rates): (&[Lanes], Option<&[Lanes]>),
    into: &mut [[Lanes; VARIABLES]; 2],
) {
    let (at, half, body) = (arrangement.at(way.body), arrangement.half(), &arrangement.bodies[way.body]);
    let state = V::view(state);
    let q = [state[at], state[at + 1], state[at + 2], state[at + 3]];
    let momentum = [state[half + at], state[half + at + 1], state[half + at + 2]];
    let (_, numbers) = way.seen(body, q, momentum);
    for index in 0..VARIABLES {
        into[0][index] = numbers[index].store();
    }
    let Some(rates) = rates else { return };
    let (rates, axes) = (V::view(rates), loaded(&way.axes));
    let turning = [rates[at], rates[at + 1], rates[at + 2], rates[at + 3]];
    let turning = product(splat(way.back), product(turning, axes));
    let torque = turned_back(q, [rates[half + at], rates[half + at + 1], rates[half + at + 2]]);
    let own = turned_back(q, momentum);
    let mut spin = own;
    for c in 0..3 {
        spin[c] = V::load(body.inverse[c]) * own[c];
    }
    let free = cross(spin, own);
    let mut faster = spin;
    for c in 0..3 {
        faster[c] = V::load(body.inverse[c]) * (torque[c] - free[c]) * V::splat(way.spin);
    }
    let faster = turned_back(axes, faster);
    let per_time = V::splat(1.0 / way.time);
    for c in 0..SPIN {
        into[1][c] = (turning[c] * per_time).store();
    }
    for c in 0..3 {
        into[1][SPIN + c] = (faster[c] * per_time).store();
    }
}
