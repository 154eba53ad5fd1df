//! Methods with a fixed step as trials that are never refused, with shadow steps for states between nodes.
//!
//! The one idea: a [`Stepper`] goes from node to node and can take a step from a node that nobody counts; that is all that a
//! run which looks between its steps asks for.

use crate::error::Result;
use crate::ode::Method;
use crate::ode::norm::Norm;
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Controlled, Rule, Settled};
use crate::ode::stepper::{Stepper, stepper};
use crate::ode::system::System;
use crate::ode::trial::{Cost, Trial};
use crate::parallel::Ticker;

/// A method with equal steps at work on one trajectory.
pub(super) struct FixedSteps {
    stepper: Box<dyn Stepper<f64>>,
    h: f64,
    node: u64,
    next: State<f64>,
}

impl FixedSteps {
    pub(super) fn new(
        method: &'static Method,
        h: f64,
        system: &dyn System<f64>,
        state: &State<f64>,
    ) -> Result<Self> {
        let mut stepper = stepper(method, h, system, state)?;
        stepper.look_back();
        Ok(Self { stepper, h, node: 0, next: state.clone() })
    }
}

impl Trial<f64> for FixedSteps {
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
        ticker: &mut Ticker<'_>,
    ) -> Result<Settled<f64>> {
        let h = f64::next_step(clock, running);
        self.next.copy_from(state);
        if h == self.h {
            let _one = self.stepper.step(self.node, 1, &mut self.next, system, ticker)?;
            self.stepper.settle(&mut self.next);
        } else {
            self.stepper.between(self.node, h, &mut self.next, system, ticker)?;
        }
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
        system: &mut dyn System<f64>,
        state: &State<f64>,
        theta: f64,
        into: &mut State<f64>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        into.copy_from(state);
        self.stepper.between(self.node, theta * outcome.h, into, system, ticker)
    }

    fn keep(&mut self, accepted: bool, state: &mut State<f64>) {
        if accepted {
            state.copy_from(&self.next);
            self.node += 1;
        }
    }

    fn cost(&self) -> Cost {
        Cost::default()
    }
}
