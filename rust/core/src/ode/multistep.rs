//! The step of Störmer's multistep method: one force evaluation, and a sum over the past.
//!
//! The one idea: what is summed are second differences of the accelerations, and what they give is added up twice,
//! compensated ("significance ordered", Grazier et al., ANZIAM J. 46 (2005) C786). So round-off is that of the
//! forces, as in a one-step method.
//!
//! The first nodes come from a one-step method, each from the one before: so a run of a few steps works, and a node is
//! the same whatever the end of the run. Velocities are no part of the method; [`Stepper::settle`] finds them at a node
//! that is read.

mod past;

pub use past::Past;

use super::Multistep;
use super::runge_kutta::RungeKuttaStep;
use super::state::State;
use super::stepper::{Nodes, Stepper, per_call};
use super::system::System;
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Scaled};
use crate::parallel::Ticker;

/// A step, and the weights of the method times it.
#[derive(Debug)]
pub struct Weights<S> {
    /// The step.
    pub h: S,
    /// Its reciprocal.
    pub h_inverse: Scaled<S>,
    /// Its square.
    pub h2: S,
    /// h² times the weights of the second differences, the oldest first.
    pub second_differences: Vec<S>,
    /// The weights of the velocity, the oldest of the older ones first.
    pub velocity: Vec<S>,
}

impl<S: Element> Weights<S> {
    fn new(table: &Multistep, h: f64) -> Self {
        let (present, older) = table.velocity.split_at(3);
        let velocity = present.iter().chain(older.iter().rev());
        let h2 = DoubleDouble::from(h) * DoubleDouble::from(h);
        let weighted = |&weight: &DoubleDouble| S::from_double_double(h2 * weight);
        Self {
            h: S::splat(h),
            h_inverse: S::unevaluated(DoubleDouble::from(1.0) / DoubleDouble::from(h)),
            h2: S::from_double_double(h2),
            second_differences: table.second_differences.iter().rev().map(weighted).collect(),
            velocity: velocity.map(|&weight| S::from_double_double(weight)).collect(),
        }
    }
}

/// A multistep method with its step.
#[derive(Debug)]
pub struct MultistepStep<S> {
    weights: Weights<S>,
    nodes: Nodes,
    starter: RungeKuttaStep<S>,
    /// Nodes that the starter has to make, and those that are still to come.
    nodes_to_start: usize,
    to_start: usize,
    past: Past<S>,
    /// Whether the velocities of the state belong to the present node.
    settled: bool,
}

impl<S: Element> MultistepStep<S> {
    /// The method `table` with step `h`, for a system of the second order and states like `state`.
    pub fn new(table: &Multistep, h: f64, system: &dyn System<S>, state: &State<S>) -> Self {
        let count = table.second_differences.len();
        Self {
            weights: Weights::new(table, h),
            nodes: Nodes::new(h, system),
            starter: RungeKuttaStep::new(table.start, h, system, state),
            // Second differences of the ages from 1 on, and two nodes more for the first of them.
            nodes_to_start: count + 1,
            to_start: count + 1,
            past: Past::new(system.form().evaluated(), count),
            settled: true,
        }
    }

    /// Whether nodes are still made by the method that starts it.
    pub fn starting(&self) -> bool {
        self.to_start > 0
    }

    /// The step and the weights.
    pub fn weights(&self) -> &Weights<S> {
        &self.weights
    }

    /// Steps since nodes are made by the method itself, at a node.
    pub fn steps_since_start(&self, node: u64) -> Option<u64> {
        node.checked_sub(self.nodes_to_start as u64)
    }

    /// What is held of the present node and those before it.
    pub fn past(&self) -> &Past<S> {
        &self.past
    }

    /// One of the first steps.
    #[cold]
    fn start(
        &mut self,
        node: u64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let _: u64 = self.starter.step(node, 1, state, system, ticker)?;
        self.past.take_in(self.starter.first_derivative());
        self.to_start -= 1;
        if self.to_start > 0 {
            return Ok(());
        }
        let t = self.nodes.time(node + 1);
        system.acceleration(&t, state.q(), state.v(), &mut self.past.acceleration, ticker)?;
        self.past.start(state.velocity(), &self.weights);
        Ok(())
    }
}

impl<S: Element> Stepper<S> for MultistepStep<S> {
    fn restart(&mut self) {
        self.to_start = self.nodes_to_start;
        self.past.restart();
        self.settled = true;
    }

    fn step(
        &mut self,
        node: u64,
        at_most: u64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<u64> {
        if self.starting() {
            self.start(node, state, system, ticker)?;
            return Ok(1);
        }
        self.settled = false;
        let steps = per_call(state.q().len(), at_most);
        for step in 0..steps {
            let (q, _) = state.halves_mut();
            S::pass(self.past.nodes(q, &self.weights));
            self.past.pass(1);
            // Here and not before the next step: the velocity at this node needs it.
            let t = self.nodes.time(node + step + 1);
            system.acceleration(&t, state.q(), state.v(), &mut self.past.acceleration, ticker)?;
        }
        Ok(steps)
    }

    fn settle(&mut self, state: &mut State<S>) {
        if !self.settled {
            let (_, (v, v_compensation)) = state.halves_mut();
            self.past.velocity(v, &self.weights);
            v_compensation.fill(S::zero());
            self.settled = true;
        }
    }

    fn memory(&mut self, node: u64, each: &mut dyn FnMut(&mut [S])) {
        self.to_start =
            self.nodes_to_start - self.nodes_to_start.min(usize::try_from(node).unwrap_or(usize::MAX));
        self.past.memory(node, each);
        self.settled = true;
    }

    fn between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.starter.between(node, past, state, system, ticker)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ode::methods::stormer13;
    use crate::ode::system::{Form, Needs};
    use crate::ode::{Method, Scheme};
    use crate::parallel::Control;

    /// One body that nothing acts on.
    struct Free;
    impl System<f64> for Free {
        fn form(&self) -> Form {
            Form::SecondOrder(1)
        }
        fn needs(&self) -> Needs {
            Needs::default()
        }
        fn evaluations(&self) -> u64 {
            0
        }
        fn acceleration(
            &mut self,
            _: &f64,
            _: &[f64],
            _: &[f64],
            a: &mut [f64],
            _: &mut Ticker<'_>,
        ) -> Result<()> {
            a.fill(0.0);
            Ok(())
        }
    }

    #[test]
    fn the_first_difference_has_all_digits_of_the_velocity() {
        let Method { scheme: Scheme::Multistep(table), .. } = &stormer13::METHOD else {
            panic!("another scheme")
        };
        let mut state = State::new(&[0.0], &[1.0]);
        state.halves_mut().1.1[0] = 1e-20;
        let control = Control::default();
        let mut step = MultistepStep::new(table, 0.3, &Free, &state);
        for node in 0..12 {
            assert!(step.starting());
            let _ = step.step(node, 1, &mut state, &mut Free, &mut Ticker::quiet(&control)).unwrap();
        }
        assert_eq!((step.starting(), step.past.d[0], step.past.d_error[0]), (false, 0.3, 0.3 * 1e-20));
    }
}
