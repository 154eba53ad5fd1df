//! Discrete motions as trials that are never refused: equal steps, and shadow steps for states between nodes.

use super::Equations;
use super::node::Node;
use super::step::Solver;
use crate::error::Result;
use crate::ode::norm::Norm;
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Controlled, Rule, Settled};
use crate::ode::system::{System, Taken};
use crate::ode::trial::{Cost, Trial};
use crate::parallel::Ticker;
use std::sync::Arc;

/// A method at work on one trajectory.
pub(in crate::generalized) struct DiscreteStep {
    solver: Solver,
    /// The lengths of the parts of a step, in units of it.
    parts: Vec<f64>,
    h: f64,
    t0: f64,
    now: Node,
    after: Node,
    /// The end of a part, and of a shadow step.
    between: Node,
    shadow: Node,
    next: State<f64>,
}

impl DiscreteStep {
    /// Steps of `h` from a state at the system's time `t0`.
    pub(in crate::generalized) fn new(
        equations: &Arc<Equations>,
        parameters: &[f64],
        state: &State<f64>,
        (t0, h): (f64, f64),
    ) -> Self {
        let mut solver = Solver::new(equations, parameters, false);
        let now = solver.node(state.position(), state.v(), t0);
        let parts = equations.method.parts();
        let copies = [(); 3].map(|()| now.clone());
        let [after, between, shadow] = copies;
        Self { solver, parts, h, t0, now, after, between, shadow, next: state.clone() }
    }

    /// Evaluations at all points of the quadrature so far.
    pub(in crate::generalized) fn evaluations(&self) -> u64 {
        self.solver.evaluations
    }

    /// All parts of a step from the present node, to `after`, or of a shadow step to `shadow`.
    fn step(&mut self, t: f64, h: f64, shadow: bool) -> Result<()> {
        let into = if shadow { &mut self.shadow } else { &mut self.after };
        let mut passed = 0.0;
        for (index, part) in self.parts.iter().enumerate() {
            if index > 0 {
                core::mem::swap(into, &mut self.between);
            }
            let from = if index == 0 { &self.now } else { &self.between };
            self.solver.step(from, (t + passed * h, part * h), into)?;
            passed += part;
        }
        Ok(())
    }
}

/// A node as a state.
fn write(node: &Node, into: &mut State<f64>) {
    let ((q, q_rest), (v, v_rest)) = into.halves_mut();
    q.copy_from_slice(&node.q);
    q_rest.copy_from_slice(&node.q_rest);
    v.copy_from_slice(&node.v);
    v_rest.fill(0.0);
}

impl Trial<f64> for DiscreteStep {
    fn start(
        &mut self,
        _: bool,
        _: &mut dyn System<f64>,
        _: &State<f64>,
        clock: &mut Clock<f64>,
        _: &Norm<f64>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        clock.h = self.h;
        Ok(())
    }

    fn attempt(
        &mut self,
        running: bool,
        system: &mut dyn System<f64>,
        state: &State<f64>,
        clock: &mut Clock<f64>,
        _: &Norm<f64>,
        _: &mut Ticker<'_>,
    ) -> Result<Settled<f64>> {
        let h = f64::next_step(clock, running);
        self.step(self.t0 + clock.elapsed, h, false)?;
        write(&self.after, &mut self.next);
        let ends = [state.all().0, self.next.all().0];
        let _all = system.seen_until(&Taken::from_end_to_end(true, (clock.elapsed, h), ends))?;
        // Without an error the next step is the longest, which is this one.
        let outcome = f64::settle(clock, running, 0.0, &Rule::new(1, self.h.abs()));
        clock.h = self.h;
        Ok(outcome)
    }

    fn next(&self) -> &State<f64> {
        &self.next
    }

    fn at(
        &mut self,
        outcome: &Settled<f64>,
        _: &mut dyn System<f64>,
        _: &State<f64>,
        theta: f64,
        into: &mut State<f64>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        self.step(self.t0 + outcome.from, outcome.h * theta, true)?;
        write(&self.shadow, into);
        Ok(())
    }

    fn keep(&mut self, accepted: bool, state: &mut State<f64>) {
        if accepted {
            state.copy_from(&self.next);
            core::mem::swap(&mut self.now, &mut self.after);
        }
    }

    fn cost(&self) -> Cost {
        // What steps take is told by their own count.
        Cost::default()
    }
}
