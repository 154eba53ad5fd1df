//! The acceleration of every particle of a scene at its time: the forces of a plan, evaluated once.

use super::Scene;
use super::frame::Frame;
use super::layout::Layout;
use super::plan::{Groups, Plan};
use super::request::Request;
use super::unit::{self, Prepared};
use crate::error::Result;
use crate::numerics::lanes::Lanes;
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::ode::system::System;
use crate::parallel::Ticker;

/// The acceleration of every particle of a scene of one copy.
///
/// # Errors
/// What [`Scene::validate`] refuses; [`Error::Interrupted`](crate::Error::Interrupted).
pub fn acceleration(scene: &Scene, threads: usize, ticker: &mut Ticker<'_>) -> Result<Vec<[f64; 3]>> {
    let request = Request {
        times: vec![scene.t0],
        method: "rk4".to_owned(),
        time_transformation: None,
        // No step is taken; one that the time would round away is refused.
        dt: Some(scene.t0.abs().max(1.0)),
        rtol: 1e-9,
        rtol_given: true,
        atol: None,
        max_step: None,
        first_step: None,
        max_steps: None,
        record: Vec::new(),
        events: Vec::new(),
        collisions: None,
        threads,
    };
    let mut plan = Plan::new(scene, &request, ticker)?;
    if plan.groups == Groups::All {
        // Whatever the layout of a run would be: this is one state of one unit.
        plan.layout = Layout::Packed;
    }
    // One state needs no origin near it: positions as they are given have digits that those about another may lose.
    let fall = match core::mem::replace(&mut plan.frame, Frame::Given) {
        Frame::Falling(fall) => fall,
        Frame::Given | Frame::AtRest => [0.0; 3],
    };
    let mut result = vec![[0.0; 3]; scene.particles];
    for unit in plan.unit_list() {
        let prepared = Prepared::new(&plan, scene, unit, ticker)?;
        let mut dynamics = unit::dynamics(&plan, &[&prepared], threads);
        let shape = dynamics.shape;
        let mut state = prepared.blank_state(1);
        for lane in 0..plan.layout.units() {
            prepared.write(&mut state, lane);
        }
        let mut a = vec![Lanes::zero(); shape.len()];
        dynamics.acceleration(&Lanes::zero(), state.q(), state.v(), &mut a, ticker)?;
        for slot in prepared.unit.recorded.clone() {
            let (row, lane) = prepared.locate(slot, 0);
            for c in 0..shape.components {
                let value = a[c * shape.rows + row].0[lane];
                result[prepared.unit.bodies[slot]][c] = scale(value, -plan.units.acceleration());
            }
            for c in 0..3 {
                result[prepared.unit.bodies[slot]][c] += fall[c];
            }
        }
    }
    Ok(result)
}
