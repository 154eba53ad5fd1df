//! The series of one body, free or held at a point, that forces pull alike everywhere and torques along its own axes turn: tops,
//! gyroscopes, bodies with thrusters.
//!
//! The one idea: the rates of the quaternion and of the angular momentum along the body's axes, and the rotation matrix, have 24
//! products of two numbers between them: three registers full of sums ([`kernel`]). A body alone has its numbers side by side in
//! a register, eight bodies have a register for each number; what is done is the same, and so are the bits.

mod kernel;
mod side;

use super::{Expand, InLanes, follow};
use crate::error::Result;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::ode::system::System;
use crate::parallel::Ticker;
use crate::rigid::motion::acting::Loads;
use crate::rigid::motion::bodies::{Arrangement, LaneBody};
use kernel::{Motion, abreast, alone, constants};

/// Numbers of a state's half: the center, then the quaternion or the momentum.
const HALF: usize = 7;
/// Where the quaternion, or the momentum, begins in it.
const TURNING: usize = 3;

/// One body in each lane, or in the first alone.
pub(super) struct OneBody {
    body: LaneBody,
    /// What turns it, along its axes.
    torque: [Lanes; 3],
    alone: bool,
    /// The acceleration by forces, once it is known.
    pull: Option<[Lanes; 3]>,
    constants: Vec<Lanes>,
    /// The products' factors, order after order.
    factors: Vec<Lanes>,
    /// The numbers of each order: the quaternion and the momentum along the axes; the momentum in space and the arm.
    numbers: Vec<Lanes>,
}

impl OneBody {
    /// If the bodies are of that kind.
    pub(super) fn new(arrangement: &Arrangement, loads: &Loads, of: InLanes) -> Option<Self> {
        let [body] = &arrangement.bodies[..] else { return None };
        let torque = loads.along_own_axes().filter(|_| of.alike && arrangement.rows == 1)?;
        Some(Self {
            body: body.clone(),
            torque,
            alone: of.alone,
            pull: None,
            constants: Vec::new(),
            factors: Vec::new(),
            numbers: Vec::new(),
        })
    }

    /// The acceleration by forces, which is the same everywhere and at all times.
    fn pull(
        &mut self,
        jet: &Jet<Lanes>,
        points: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<[Lanes; 3]> {
        if let Some(pull) = self.pull {
            return Ok(pull);
        }
        let mut pull = [Lanes::zero(); 3];
        let moving = &jet.q[HALF + 1..][..TURNING];
        points.acceleration(&jet.t, &jet.q[..TURNING], moving, &mut pull, ticker)?;
        // The weight turns what is held.
        let weight = pull.map(|part| if self.body.pivoted { self.body.mass * part } else { Lanes::zero() });
        self.constants = constants(&self.body, weight, self.torque, self.alone);
        self.pull = Some(pull);
        Ok(pull)
    }
}

/// Writes a coefficient, of the first lane or of all.
fn put(into: &mut Lanes, numbers: &[Lanes], number: usize, alone: bool) {
    if alone {
        into.0[0] = numbers[0].0[number];
    } else {
        *into = numbers[number];
    }
}

impl Expand for OneBody {
    fn expand(
        &mut self,
        jet: &mut Jet<Lanes>,
        points: &mut dyn System<Lanes>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let pull = self.pull(jet, points, ticker)?;
        let Self { alone: only, constants, factors, numbers, .. } = self;
        let (order, half) = (jet.order, jet.len / 2);
        let mut start = [Lanes::zero(); 2 * HALF];
        for (from, into) in [&jet.q, &jet.rests[0]].into_iter().zip(start.chunks_exact_mut(HALF)) {
            into[..4].copy_from_slice(&from[TURNING..][..4]);
            into[4..].copy_from_slice(&from[half + TURNING..][..3]);
        }
        let unit = if *only { Lanes::splat(jet.unit.0[0]) } else { jet.unit };
        let inverse = &jet.inverse[..];
        let motion = Motion { constants, start: &start, order, unit: &unit, inverse, factors, numbers };
        if *only {
            alone(motion)
        } else {
            abreast(motion)
        }

        let each = if *only { 1 } else { WIDTH };
        let moving = !self.body.pivoted;
        for n in 1..=order {
            let [before, now] = [n - 1, n].map(|n| &numbers[2 * n * each..][..2 * each]);
            let into = &mut jet.q[n * jet.len..][..jet.len];
            for c in 0..4 {
                put(&mut into[TURNING + c], &now[..each], c, *only);
            }
            for c in 0..3 {
                put(&mut into[half + TURNING + c], &before[each..], c, *only);
                if !moving {
                    put(&mut into[c], &now[each..], 4 + c, *only);
                }
            }
        }
        if !moving {
            let follow = if *only { follow::<f64> } else { follow::<Lanes> };
            (0..3).for_each(|c| follow(jet, c));
        } else {
            for c in 0..3 {
                let faster = pull[c] * jet.unit;
                jet.q[jet.len + c] = jet.q[half + c] * jet.unit;
                jet.q[jet.len + half + c] = faster;
                jet.q[2 * jet.len + c] = Lanes::splat(0.5) * faster * jet.unit;
            }
        }
        Ok(())
    }

    fn smooth_until(&self, _: &Jet<Lanes>, _: &Lanes, _: &dyn System<Lanes>) -> Option<Lanes> {
        None
    }
}
