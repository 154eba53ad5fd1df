//! Closed systems in coordinates relative to the first body of each.
//!
//! The one idea: a multistep method is linear in coordinates and accelerations, so it may be applied to their
//! differences from those of one body, and to the centre of mass, which moves uniformly: nothing but round-off
//! changes, and that body is skipped.

use super::FewBodies;
use crate::numerics::double_double::{two_product, two_sum};
use crate::numerics::element::{self, Element, Shape};
use crate::ode::state::State;

/// Numbers, and what they leave out.
type Pairs<S> = (Vec<S>, Vec<S>);

/// The coordinates of closed systems.
#[derive(Debug)]
pub(super) struct Relative<S> {
    shape: Shape,
    systems: usize,
    /// Relative coordinates: of each body but the first of each system, its components together.
    coordinates: Pairs<S>,
    /// The share of each such body in the mass of its system.
    shares: Pairs<S>,
    /// Where the centre of mass of each system was at node 0, components together.
    center: Pairs<S>,
    /// How it moves.
    drift: Pairs<S>,
    /// The step.
    h: S,
    /// The present node.
    node: u64,
}

impl<S: Element> Relative<S> {
    /// The systems at a state, which is node 0 of steps `h`.
    pub(super) fn new(few: &FewBodies<S>, h: S, state: &State<S>) -> Self {
        let (shape, systems) = (few.shape, few.systems);
        let mut relative = Self {
            shape,
            systems,
            coordinates: (Vec::new(), Vec::new()),
            shares: shares(&few.strength, shape.rows / systems),
            center: (Vec::new(), Vec::new()),
            drift: (Vec::new(), Vec::new()),
            h,
            node: 0,
        };
        let velocity = relative.of_compensated(state.velocity());
        relative.coordinates = relative.of_compensated(state.position());
        relative.center = relative.centers(state.position(), &relative.coordinates);
        relative.drift = relative.centers(state.velocity(), &velocity);
        relative
    }

    /// Writes what vectors of the bodies are relative to that of the first of their system.
    pub(super) fn of(&self, x: &[S], out: &mut [S]) {
        let Shape { rows, components } = self.shape;
        let bodies = rows / self.systems;
        let others = (0..rows).filter(|row| row % bodies != 0);
        for (row, out) in others.zip(out.chunks_exact_mut(components)) {
            for c in 0..components {
                out[c] = x[c * rows + row] - x[c * rows + row / bodies * bodies];
            }
        }
    }

    /// As [`of`](Self::of), with what the differences leave out.
    pub(super) fn of_compensated(&self, (x, x_error): (&[S], &[S])) -> Pairs<S> {
        let Shape { rows, components } = self.shape;
        let bodies = rows / self.systems;
        let zeros = vec![S::zero(); (rows - self.systems) * components];
        let mut out = (zeros.clone(), zeros);
        let others = (0..rows).filter(|row| row % bodies != 0);
        let numbers = others.flat_map(|row| (0..components).map(move |c| (row, c)));
        for (index, (row, c)) in numbers.enumerate() {
            let (own, first) = (c * rows + row, c * rows + row / bodies * bodies);
            let (difference, error) = two_sum(x[own], -x[first]);
            (out.0[index], out.1[index]) = (difference, error + (x_error[own] - x_error[first]));
        }
        out
    }

    /// The mean of a vector over each system, weighted by mass: `x_0 + Σ share·(x_i - x_0)`.
    fn centers(&self, (x, x_error): (&[S], &[S]), relative: &Pairs<S>) -> Pairs<S> {
        let Shape { rows, components } = self.shape;
        let (bodies, len) = (rows / self.systems, self.systems * components);
        let mut means = (Vec::with_capacity(len), Vec::with_capacity(len));
        for (system, c) in (0..self.systems).flat_map(|system| (0..components).map(move |c| (system, c))) {
            let first = c * rows + system * bodies;
            let (mut mean, mut rest) = (x[first], x_error[first]);
            for body in system * (bodies - 1)..(system + 1) * (bodies - 1) {
                let index = body * components + c;
                let (share, part) = (self.shares.0[body], relative.0[index]);
                let (product, error) = two_product(share, part);
                rest += error + (share * relative.1[index] + self.shares.1[body] * part);
                let (sum, error) = two_sum(mean, product);
                (mean, rest) = (sum, rest + error);
            }
            means.0.push(mean);
            means.1.push(rest);
        }
        means
    }

    /// The relative coordinates, and what they leave out.
    pub(super) fn coordinates_mut(&mut self) -> (&mut [S], &mut [S]) {
        (&mut self.coordinates.0, &mut self.coordinates.1)
    }

    /// So many steps have been taken.
    pub(super) fn pass(&mut self, steps: u64) {
        self.node += steps;
    }

    /// Writes coordinates and velocities of all bodies, from relative velocities.
    pub(super) fn write(&self, state: &mut State<S>, velocity: &[S]) {
        let (q, (v, v_error)) = state.halves_mut();
        let from = element::Relative {
            shape: self.shape,
            systems: self.systems,
            q: (&self.coordinates.0, &self.coordinates.1),
            v: velocity,
            shares: (&self.shares.0, &self.shares.1),
            center: (&self.center.0, &self.center.1),
            drift: (&self.drift.0, &self.drift.1),
            h: self.h,
            node: S::splat(self.node as f64),
        };
        S::absolute(q, v, &from);
        v_error.fill(S::zero());
    }
}

/// The share of each body but the first in the mass of its system; nothing if there is no mass.
fn shares<S: Element>(strength: &[S], bodies: usize) -> Pairs<S> {
    let share = |system: &[S], own: S| {
        let mut total = (S::zero(), S::zero());
        for &strength in system {
            let (sum, error) = two_sum(total.0, strength);
            total = (sum, total.1 + error);
        }
        let share = own / total.0;
        let (product, error) = two_product(share, total.0);
        let rest = ((own - product) - error) - share * total.1;
        // Repelling bodies have negative strengths; only without any is there no center to speak of.
        let some = S::zero().less(total.0.abs());
        (S::select(some, share, S::zero()), S::select(some, rest / total.0, S::zero()))
    };
    strength
        .chunks_exact(bodies)
        .flat_map(|system| system[1..].iter().map(move |&own| share(system, own)))
        .unzip()
}
