//! The step of Störmer's multistep method: one force evaluation, and a sum over the past.
//!
//! The one idea: what is summed are second differences of the accelerations, and what they give is added up twice,
//! compensated ("significance ordered", Grazier et al., ANZIAM J. 46 (2005) C786). So round-off is that of the
//! forces, as in a one-step method.
//!
//! The first nodes come from a one-step method, each from the one before: so a run of a few steps works, and a node is
//! the same whatever the end of the run. Velocities are no part of the method; [`MultistepStep::complete`] finds them
//! at a node that is read. Where the force can, it takes the steps itself, in [`relative`] coordinates.

mod past;
mod relative;

use super::Multistep;
use super::runge_kutta::RungeKuttaStep;
use super::state::State;
use crate::error::Result;
use crate::forces::Dynamics;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Scaled};
use crate::parallel::Ticker;
use past::Past;
use relative::Relative;

/// A multistep method with its step.
#[derive(Debug)]
pub struct MultistepStep<S> {
    h: S,
    h_inverse: Scaled<S>,
    h2: S,
    /// h² times the weights of the second differences, the oldest first.
    weights: Vec<S>,
    /// The weights of the velocity, the oldest of the older ones first.
    velocity: Vec<S>,
    starter: RungeKuttaStep<S>,
    /// Nodes that the starter has to make, and those that are still to come.
    nodes_to_start: usize,
    to_start: usize,
    past: Past<S>,
    /// Other coordinates than those of the state, once it has started, and their past.
    relative: Option<(Relative<S>, Past<S>)>,
    /// Room for velocities in them.
    relative_velocity: Vec<S>,
    /// Whether the state belongs to the present node.
    complete: bool,
}

impl<S: Element> MultistepStep<S> {
    /// The method `table` with step `h`, for states like `state`.
    pub fn new(table: &Multistep, h: f64, state: &State<S>) -> Self {
        let count = table.second_differences.len();
        let h2 = DoubleDouble::from(h) * DoubleDouble::from(h);
        let (present, older) = table.velocity.split_at(3);
        let velocity = present.iter().chain(older.iter().rev());
        let h_inverse = DoubleDouble::from(1.0) / DoubleDouble::from(h);
        let h = S::splat(h);
        Self {
            h,
            h_inverse: S::one().scaled_by(h_inverse),
            h2: S::from_double_double(h2),
            weights: table.second_differences.iter().rev().map(|&w| S::from_double_double(h2 * w)).collect(),
            velocity: velocity.map(|&weight| S::from_double_double(weight)).collect(),
            starter: RungeKuttaStep::new(table.start, h, state),
            // Second differences of the ages from 1 on, and two nodes more for the first of them.
            nodes_to_start: count + 1,
            to_start: count + 1,
            past: Past::new(state.shape.len(), count),
            relative: None,
            relative_velocity: Vec::new(),
            complete: true,
        }
    }

    /// The one-step method that starts it, and that takes steps to times between nodes.
    pub fn starter_mut(&mut self) -> &mut RungeKuttaStep<S> {
        &mut self.starter
    }

    /// Begins anew, at another state.
    pub fn restart(&mut self) {
        self.to_start = self.nodes_to_start;
        self.past.restart();
        self.relative = None;
        self.complete = true;
    }

    /// Advances the state by one step or, where that saves time, by more, up to `at_most`; returns how many. The
    /// state may stay behind until [`complete`](Self::complete).
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn step(
        &mut self,
        state: &mut State<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
        at_most: u64,
    ) -> Result<u64> {
        if self.to_start > 0 {
            self.start(state, dynamics, ticker)?;
            return Ok(1);
        }
        self.complete = false;
        if let Some((relative, past)) = &mut self.relative {
            let nodes = past.nodes(relative.coordinates_mut(), &self.h2, &self.weights);
            dynamics.multistep(nodes, at_most);
            relative.pass(at_most);
            past.pass(at_most);
            return Ok(at_most);
        }
        let (q, _) = state.halves_mut();
        S::multistep(self.past.nodes(q, &self.h2, &self.weights));
        self.past.pass(1);
        // Here and not before the next step: the velocity at this node needs it.
        dynamics.acceleration(state.q(), state.v(), &mut self.past.acceleration, ticker)?;
        Ok(1)
    }

    /// One of the first steps.
    #[cold]
    fn start(
        &mut self,
        state: &mut State<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.starter.step(state, dynamics, ticker)?;
        self.past.take_in(self.starter.first_acceleration());
        self.to_start -= 1;
        if self.to_start > 0 {
            return Ok(());
        }
        dynamics.acceleration(state.q(), state.v(), &mut self.past.acceleration, ticker)?;
        if let Some(closed) = dynamics.closed_systems() {
            let relative = Relative::new(&closed, self.h, state);
            let (v, v_error) = relative.of_compensated(state.velocity());
            let mut past = self.past.map(v.len(), |a, out| relative.of(a, out));
            past.start((&v, &v_error), self.h, self.h2, &self.velocity);
            self.relative = Some((relative, past));
        } else {
            self.past.start(state.velocity(), self.h, self.h2, &self.velocity);
        }
        Ok(())
    }

    /// Brings the state to the present node.
    pub fn complete(&mut self, state: &mut State<S>) {
        if self.complete {
            return;
        }
        match &mut self.relative {
            Some((relative, past)) => {
                let mut v = core::mem::take(&mut self.relative_velocity);
                v.resize(past.d.len(), S::zero());
                past.velocity(&mut v, (&self.h, &self.h_inverse), &self.velocity);
                relative.write(state, &v);
                self.relative_velocity = v;
            }
            None => {
                let (_, (v, v_error)) = state.halves_mut();
                self.past.velocity(v, (&self.h, &self.h_inverse), &self.velocity);
                v_error.fill(S::zero());
            }
        }
        self.complete = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::stormer13;
    use crate::integrators::{Method, Scheme};
    use crate::numerics::element::Shape;
    use crate::parallel::Control;

    #[test]
    fn the_first_difference_has_all_digits_of_the_velocity() {
        let shape = Shape { rows: 1, components: 1 };
        let Method { scheme: Scheme::Multistep(table), .. } = &stormer13::METHOD else {
            panic!("another scheme")
        };
        let mut state = State::new(shape, &[0.0], &[1.0]);
        state.halves_mut().1.1[0] = 1e-20;
        let (mut dynamics, control) = (Dynamics::new(shape, vec![]), Control::default());
        let mut step = MultistepStep::new(table, 0.3, &state);
        for _ in 0..12 {
            assert!(step.to_start > 0);
            let _ = step.step(&mut state, &mut dynamics, &mut Ticker::quiet(&control), 1).unwrap();
        }
        assert_eq!((step.to_start, step.past.d[0], step.past.d_error[0]), (0, 0.3, 0.3 * 1e-20));
    }
}
