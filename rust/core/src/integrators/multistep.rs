//! The step of Störmer's multistep method: one force evaluation, and a sum over the past.
//!
//! The one idea: what is summed are second differences of the accelerations, and what they give is added up twice,
//! compensated ("significance ordered", Grazier et al., ANZIAM J. 46 (2005) C786). So round-off is that of the
//! forces, as in a one-step method.
//!
//! The first nodes come from a one-step method, each from the one before: so a run of a few steps works, and a node is
//! the same whatever the end of the run. Velocities are no part of the method; [`MultistepStep::complete`] finds them
//! at a node that is read.

use super::Multistep;
use super::runge_kutta::RungeKuttaStep;
use super::state::State;
use crate::error::Result;
use crate::forces::Dynamics;
use crate::numerics::double_double::{DoubleDouble, two_product};
use crate::numerics::element::{Differences, Element};
use crate::parallel::Ticker;

/// A multistep method with its step.
#[derive(Clone, Debug)]
pub struct MultistepStep<S> {
    h: S,
    h2: S,
    /// h² times the weights of the second differences, the oldest first.
    weights: Vec<S>,
    /// The weights of the velocity, the oldest of the older ones first.
    velocity: Vec<S>,
    starter: RungeKuttaStep<S>,
    /// Nodes that the starter still has to make.
    to_start: usize,
    /// The accelerations at the present node and at the one before.
    acceleration: Vec<S>,
    last: Vec<S>,
    /// See [`Differences`].
    first: Vec<S>,
    second: Vec<S>,
    newest: usize,
    /// The last difference of the coordinates, compensated.
    d: Vec<S>,
    d_error: Vec<S>,
    /// Whether the velocities of the state belong to its coordinates.
    complete: bool,
}

impl<S: Element> MultistepStep<S> {
    /// The method `table` with step `h`, for states like `state`.
    pub fn new(table: &Multistep, h: f64, state: &State<S>) -> Self {
        let (len, count) = (state.shape.len(), table.second_differences.len());
        let block = || vec![S::zero(); len];
        let h2 = DoubleDouble::from(h) * DoubleDouble::from(h);
        let (present, older) = table.velocity.split_at(3);
        let velocity = present.iter().chain(older.iter().rev());
        let h = S::splat(h);
        Self {
            h,
            h2: S::from_double_double(h2),
            weights: table.second_differences.iter().rev().map(|&w| S::from_double_double(h2 * w)).collect(),
            velocity: velocity.map(|&weight| S::from_double_double(weight)).collect(),
            starter: RungeKuttaStep::new(table.start, h, state),
            // Second differences of the ages from 1 on, and two nodes more for the first of them.
            to_start: count + 1,
            acceleration: block(),
            last: block(),
            first: block(),
            second: vec![S::zero(); count * len],
            newest: 0,
            d: block(),
            d_error: block(),
            complete: true,
        }
    }

    /// Becomes a step of `h` from a complete state: one of the starter.
    pub fn follow(&mut self, table: &Multistep, h: S) {
        self.to_start = table.second_differences.len() + 1;
        self.starter.set_step(h);
    }

    /// Advances the state by one step; its velocities may stay behind until [`complete`](Self::complete).
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn step(
        &mut self,
        state: &mut State<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        if self.to_start > 0 {
            return self.start(state, dynamics, ticker);
        }
        let past = Differences {
            last: &self.last,
            first: &mut self.first,
            second: &mut self.second,
            newest: self.newest,
        };
        let (q, _) = state.halves_mut();
        S::multistep(q, (&mut self.d, &mut self.d_error), past, &self.acceleration, &self.h2, &self.weights);
        self.pass_on();
        self.complete = false;
        // Here and not before the next step: the velocity at this node needs it.
        dynamics.acceleration(state.q(), state.v(), &mut self.acceleration, ticker)
    }

    /// The present node becomes the one before.
    fn pass_on(&mut self) {
        core::mem::swap(&mut self.acceleration, &mut self.last);
        self.newest = if self.newest + 1 == self.weights.len() { 0 } else { self.newest + 1 };
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
        self.acceleration.copy_from_slice(self.starter.first_acceleration());
        let len = self.acceleration.len();
        for i in 0..len {
            let change = self.acceleration[i] - self.last[i];
            let second_difference = change - self.first[i];
            self.first[i] = change;
            self.second[self.newest * len + i] = second_difference;
        }
        self.pass_on();
        self.to_start -= 1;
        if self.to_start == 0 {
            dynamics.acceleration(state.q(), state.v(), &mut self.acceleration, ticker)?;
            self.start_difference(state);
        }
        Ok(())
    }

    /// The last difference of the coordinates that belongs to the velocities, to twice the digits:
    /// `d = h v - h² Σ`.
    fn start_difference(&mut self, state: &State<S>) {
        let zeros = vec![S::zero(); self.d.len()];
        let mut sum = zeros.clone();
        self.backward(&mut sum, &zeros, &S::one());
        let ((v, v_error), d) = (state.velocity(), (&mut self.d[..], &mut self.d_error[..]));
        for i in 0..v.len() {
            (d.0[i], d.1[i]) = two_product(self.h, v[i]);
            d.1[i] += self.h * v_error[i];
        }
        S::advance(d, &sum, &(-self.h2, S::zero()));
    }

    /// Brings the velocities of the state to its node.
    pub fn complete(&mut self, state: &mut State<S>) {
        if self.complete {
            return;
        }
        let (_, (v, v_error)) = state.halves_mut();
        let (d, h) = (core::mem::take(&mut self.d), self.h);
        self.backward(v, &d, &h);
        v_error.fill(S::zero());
        self.d = d;
        self.complete = true;
    }

    /// `v = d/h + h Σ` over the accelerations up to the present node.
    fn backward(&mut self, v: &mut [S], d: &[S], h: &S) {
        let past = Differences {
            last: &self.last,
            first: &mut self.first,
            second: &mut self.second,
            newest: self.newest,
        };
        S::backward_velocity(v, d, past, &self.acceleration, h, &self.velocity);
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
            step.step(&mut state, &mut dynamics, &mut Ticker::quiet(&control)).unwrap();
        }
        assert_eq!((step.to_start, step.d[0], step.d_error[0]), (0, 0.3, 0.3 * 1e-20));
    }
}
