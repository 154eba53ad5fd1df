//! Methods with a fixed step as trials that are never refused, with shadow steps for states between nodes.
//!
//! The one idea: a [`Stepper`] goes from node to node and can take a step from a node that nobody counts; that is all that a
//! run which looks between its steps asks for.

use crate::error::Result;
use crate::numerics::real::Mask;
use crate::ode::Method;
use crate::ode::looks::{EqualLooks, EqualStep};
use crate::ode::norm::Norm;
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Controlled, Rule, Settled};
use crate::ode::stepper::{Stepper, stepper};
use crate::ode::system::System;
use crate::ode::trial::{Cost, Trial};
use crate::parallel::Ticker;

/// A method with equal steps at work on one trajectory, or on eight that go from node to node together.
pub(super) struct FixedSteps<S: Controlled> {
    stepper: Box<dyn Stepper<S>>,
    h: f64,
    node: u64,
    /// What asks of each step.
    looks: EqualLooks<S>,
    next: State<S>,
    /// The parts of the steps tried last up to which nothing lies between their nodes, if something does.
    pub(super) seen: Option<S>,
}

impl<S: Controlled> FixedSteps<S> {
    pub(super) fn new(
        method: &'static Method,
        h: f64,
        system: &dyn System<S>,
        state: &State<S>,
    ) -> Result<Self> {
        let mut stepper = stepper(method, h, system, state)?;
        stepper.look_back();
        Ok(Self { stepper, h, node: 0, looks: EqualLooks::of(method), next: state.clone(), seen: None })
    }
}

impl<S: Controlled> Trial<S> for FixedSteps<S> {
    fn start(
        &mut self,
        fresh: S::Mask,
        _: &mut dyn System<S>,
        _: &State<S>,
        clock: &mut Clock<S>,
        _: &Norm<S>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        if fresh.any() {
            self.stepper.restart();
            self.node = 0;
        }
        clock.h = S::splat(self.h);
        Ok(())
    }

    fn attempt(
        &mut self,
        running: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        _: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Settled<S>> {
        // Those that run are at the same node, and take the same step.
        let length = S::next_step(clock, running).abs().largest_lane().first_lane();
        let h = length.copysign(self.h);
        self.next.copy_from(state);
        if h == self.h {
            let _one = self.stepper.step(self.node, 1, &mut self.next, system, ticker)?;
            self.stepper.settle(&mut self.next);
        } else {
            self.stepper.between(self.node, h, &mut self.next, system, ticker)?;
        }
        let (times, ends) =
            ((clock.elapsed, S::next_step(clock, running)), [state.all().0, self.next.all().0]);
        let is_last = S::splat(length).less((clock.end - clock.elapsed).abs()).and(running).not().all();
        let is_outermost = [self.node == 0, is_last];
        let step = EqualStep { asked: running, times, ends, is_outermost, is_one: false };
        self.seen = self.looks.ask(step, system, |taken, system| system.seen_until(taken))?;
        // Without an error the next step is the longest, which is this one.
        let outcome = S::settle(clock, running, S::zero(), &Rule::new(1, S::splat(self.h.abs())));
        clock.h = S::splat(self.h);
        Ok(outcome)
    }

    fn next(&self) -> &State<S> {
        &self.next
    }

    fn at(
        &mut self,
        outcome: &Settled<S>,
        system: &mut dyn System<S>,
        state: &State<S>,
        theta: S,
        into: &mut State<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        into.copy_from(state);
        let past = (theta * outcome.h).abs().largest_lane().first_lane().copysign(self.h);
        self.stepper.between(self.node, past, into, system, ticker)
    }

    fn keep(&mut self, accepted: S::Mask, state: &mut State<S>) {
        if accepted.any() {
            state.copy_from(&self.next);
            self.node += 1;
        }
    }

    fn cost(&self) -> Cost {
        Cost::default()
    }
}
