//! Closed systems in coordinates relative to the first body of each.
//!
//! The one idea: a multistep method is linear in coordinates and accelerations, so it may be applied to their
//! differences from those of one body, and to the centre of mass, which moves uniformly: nothing but round-off
//! changes, and that body is skipped.

use super::FewBodies;
use crate::numerics::double_double::{two_product, two_sum};
use crate::numerics::element::{Element, Pair, PairMut, Pass, Shape, View};
use crate::numerics::real::Real;
use crate::ode::multistep::Past;
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
    /// The systems at zeros.
    pub(super) fn blank(few: &FewBodies<S>, h: S) -> Self {
        let (shape, systems) = (few.shape, few.systems);
        let zeros = |rows: usize| {
            let zeros = vec![S::zero(); rows * shape.components];
            (zeros.clone(), zeros)
        };
        Self {
            shape,
            systems,
            coordinates: zeros(shape.rows - systems),
            shares: shares(&few.strength, shape.rows / systems),
            center: zeros(systems),
            drift: zeros(systems),
            h,
            node: 0,
        }
    }

    /// How many relative coordinates there are.
    pub(super) fn len(&self) -> usize {
        self.coordinates.0.len()
    }

    /// The systems at a state, which is node 0 of steps `h`.
    pub(super) fn new(few: &FewBodies<S>, h: S, state: &State<S>) -> Self {
        let mut relative = Self::blank(few, h);
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

    /// Stands at the node `steps` after node 0, which the past calls `node`, and goes over what is held there: blocks like
    /// coordinates of all bodies, in which the first of each system has the place for what the centre of mass does.
    pub(super) fn memory(
        &mut self,
        steps: u64,
        past: &mut Past<S>,
        node: u64,
        each: &mut dyn FnMut(&mut [S]),
    ) {
        self.node = steps;
        let (shape, systems) = (self.shape, self.systems);
        let mut none = vec![S::zero(); systems * shape.components];
        let mut spread = |others: &mut [S], first: &mut [S]| {
            let mut block = vec![S::zero(); shape.len()];
            exchange(shape, systems, &mut block, others, first);
            each(&mut block);
            exchange(shape, systems, &mut block, others, first);
        };
        spread(&mut self.coordinates.0, &mut self.center.0);
        spread(&mut self.coordinates.1, &mut self.center.1);
        let mut drift = [&mut self.drift.0, &mut self.drift.1].into_iter();
        past.memory(node, &mut |others| match drift.next() {
            Some(drift) => spread(others, drift),
            None => spread(others, &mut none),
        });
    }

    /// Writes coordinates and velocities of all bodies, from relative velocities.
    pub(super) fn write(&self, state: &mut State<S>, velocity: &[S]) {
        let (q, (v, v_compensation)) = state.halves_mut();
        S::pass(Absolute {
            q,
            v,
            relative: Coordinates {
                shape: self.shape,
                systems: self.systems,
                q: (&self.coordinates.0, &self.coordinates.1),
                v: velocity,
                shares: (&self.shares.0, &self.shares.1),
                center: (&self.center.0, &self.center.1),
                drift: (&self.drift.0, &self.drift.1),
            },
            h: &self.h,
            node: self.node,
        });
        v_compensation.fill(S::zero());
    }
}

/// Swaps a block like the coordinates of all bodies with relative ones and with vectors of each system.
fn exchange<S: Element>(shape: Shape, systems: usize, block: &mut [S], others: &mut [S], first: &mut [S]) {
    let Shape { rows, components } = shape;
    let bodies = rows / systems;
    let (mut others, mut first) = (others.iter_mut(), first.iter_mut());
    for (row, c) in (0..rows).flat_map(|row| (0..components).map(move |c| (row, c))) {
        let own = if row % bodies == 0 { first.next() } else { others.next() };
        if let Some(own) = own {
            core::mem::swap(own, &mut block[c * rows + row]);
        }
    }
}

/// A state relative to the first body of each system, with the center of mass of each. Pairs are numbers and what they
/// leave out.
#[derive(Clone, Copy, Debug)]
struct Coordinates<'a, S> {
    /// How the coordinates of all bodies lie, system after system in the rows.
    shape: Shape,
    systems: usize,
    /// Coordinates of each body but the first of each system, one after another, its components together.
    q: Pair<'a, S>,
    /// Velocities, likewise.
    v: &'a [S],
    /// The share of each such body in the mass of its system.
    shares: Pair<'a, S>,
    /// Where the center of each system was at node 0, its components together.
    center: Pair<'a, S>,
    /// How it moves.
    drift: Pair<'a, S>,
}

/// The coordinates, compensated, and the velocities of all bodies, from those relative to the first of each system.
struct Absolute<'a, S> {
    q: PairMut<'a, S>,
    v: &'a mut [S],
    relative: Coordinates<'a, S>,
    h: &'a S,
    /// The present node.
    node: u64,
}

impl<S: Element> Pass<S> for Absolute<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let Coordinates { shape, systems, q, v, shares, center, drift } = self.relative;
        let from = Coordinates::<V> {
            shape,
            systems,
            q: V::pair(q),
            v: V::view(v),
            shares: V::pair(shares),
            center: V::pair(center),
            drift: V::pair(drift),
        };
        let elapsed = product((V::load(*self.h), V::zero()), (V::splat(self.node as f64), V::zero()));
        absolute(V::pair_mut(self.q), V::view_mut(self.v), &from, elapsed);
    }
}

/// `a·b` to twice the digits, both with what they leave out.
#[inline(always)]
fn product<S: Real>(a: (S, S), b: (S, S)) -> (S, S) {
    let product = a.0 * b.0;
    let error = a.0.multiply_add(b.0, -product);
    (product, a.0.multiply_add(b.1, a.1.multiply_add(b.0, error)))
}

#[inline(always)]
fn at<S: Real>(values: (&[S], &[S]), index: usize) -> (S, S) {
    (values.0[index], values.1[index])
}

#[inline(always)]
fn absolute<S: Real>((q, q_error): PairMut<'_, S>, v: &mut [S], from: &Coordinates<'_, S>, elapsed: (S, S)) {
    let components = from.shape.components;
    let bodies = from.shape.rows / from.systems;
    for system in 0..from.systems {
        for c in 0..components {
            let center = system * components + c;
            let row = c * from.shape.rows + system * bodies;
            let drift = at(from.drift, center);
            let (place, place_error) = at(from.center, center);
            let (moved, moved_error) = product(drift, elapsed);
            let (mut place, error) = two_sum(place, moved);
            let mut rest = error + (place_error + moved_error);
            let mut speed = drift.0;
            for body in 0..bodies - 1 {
                let index = system * (bodies - 1) + body;
                let share = at(from.shares, index);
                let (part, part_error) = product(share, at(from.q, index * components + c));
                let (difference, error) = two_sum(place, -part);
                (place, rest) = (difference, rest + (error - part_error));
                speed = share.0.multiply_subtract_from(from.v[index * components + c], speed);
            }
            q[row] = place + rest;
            q_error[row] = rest - (q[row] - place);
            v[row] = speed;
            for body in 0..bodies - 1 {
                let index = (system * (bodies - 1) + body) * components + c;
                let (own, own_error) = at(from.q, index);
                let (sum, error) = two_sum(place, own);
                let rest = error + (rest + own_error);
                let reached = sum + rest;
                (q[row + 1 + body], q_error[row + 1 + body]) = (reached, rest - (reached - sum));
                v[row + 1 + body] = speed + from.v[index];
            }
        }
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
