//! What a multistep method holds of its past: differences of accelerations, and the last difference of the coordinates.
//!
//! The one idea: its loops go over numbers, each by itself. So the numbers may be coordinates of the state or any others
//! that depend on them linearly.

use super::super::passes::multistep::{BackwardVelocity, Differences, Nodes};
use super::super::passes::updates::Advance;
use super::Weights;
use crate::numerics::double_double::two_product;
use crate::numerics::element::{Element, PairMut, Scaled};

/// What the method holds of the present node and those before it, of any coordinates.
#[derive(Debug)]
pub struct Past<S> {
    /// The accelerations at the present node and at the one before.
    pub acceleration: Vec<S>,
    last: Vec<S>,
    /// See [`Differences`].
    first: Vec<S>,
    second: Vec<S>,
    newest: usize,
    /// The last difference of the coordinates, compensated.
    pub d: Vec<S>,
    /// What that leaves out.
    pub d_error: Vec<S>,
}

impl<S: Element> Past<S> {
    /// Of `len` coordinates and `count` second differences.
    pub fn new(len: usize, count: usize) -> Self {
        let block = || vec![S::zero(); len];
        Self {
            acceleration: block(),
            last: block(),
            first: block(),
            second: vec![S::zero(); count * len],
            newest: 0,
            d: block(),
            d_error: block(),
        }
    }

    /// Begins anew.
    pub fn restart(&mut self) {
        self.memory(0, &mut |block| block.fill(S::zero()));
    }

    /// Stands at `node` and goes over what is held there, block by block.
    pub fn memory(&mut self, node: u64, each: &mut dyn FnMut(&mut [S])) {
        let len = self.last.len().max(1);
        self.newest = 0;
        self.pass(node);
        for block in [&mut self.d, &mut self.d_error, &mut self.acceleration, &mut self.last, &mut self.first]
        {
            each(block);
        }
        self.second.chunks_exact_mut(len).for_each(each);
    }

    /// The same nodes in other coordinates, `len` of them, which `of` writes; `d` is still to be found.
    pub fn map(&self, len: usize, of: impl Fn(&[S], &mut [S])) -> Self {
        let mut past = Self::new(len, self.second.len() / self.last.len());
        of(&self.acceleration, &mut past.acceleration);
        of(&self.last, &mut past.last);
        of(&self.first, &mut past.first);
        let blocks = self.second.chunks_exact(self.last.len());
        blocks.zip(past.second.chunks_exact_mut(len)).for_each(|(block, out)| of(block, out));
        Self { newest: self.newest, ..past }
    }

    /// For a step of coordinates `q`.
    pub fn nodes<'a>(
        &'a mut self,
        q: PairMut<'a, S>,
        Weights { h2, second_differences, .. }: &'a Weights<S>,
    ) -> Nodes<'a, S> {
        let Self { acceleration, last, first, second, newest, d, d_error } = self;
        let past = Differences { last, first, second, newest: *newest };
        Nodes { q, d: (d, d_error), past, a: acceleration, h2, weights: second_differences }
    }

    /// Takes in the accelerations at a further node, which is then the one before.
    pub fn take_in(&mut self, acceleration: &[S]) {
        let len = acceleration.len();
        for i in 0..len {
            let change = acceleration[i] - self.last[i];
            self.second[self.newest * len + i] = change - self.first[i];
            self.first[i] = change;
        }
        self.last.copy_from_slice(acceleration);
        self.pass(1);
    }

    /// So many nodes have joined the ring.
    pub fn pass(&mut self, nodes: u64) {
        let count = (self.second.len() / self.last.len().max(1)).max(1) as u64;
        self.newest = ((self.newest as u64 + nodes) % count) as usize;
    }

    /// `v = d/h + h Σ weight·(differences of the accelerations up to the present node)`.
    pub fn velocity(&mut self, v: &mut [S], weights: &Weights<S>) {
        self.backward(v, (&weights.h, &weights.h_inverse), &weights.velocity);
    }

    fn backward(&mut self, v: &mut [S], h: (&S, &Scaled<S>), weights: &[S]) {
        let Self { acceleration, last, first, second, newest, d, .. } = self;
        let past = Differences { last, first, second, newest: *newest };
        S::pass(BackwardVelocity { v, d, past, a: acceleration, h, weights });
    }

    /// Finds the last difference of the coordinates that belongs to the velocities, to twice the digits:
    /// `d = h v - h² Σ`.
    pub fn start(&mut self, (v, v_compensation): (&[S], &[S]), weights: &Weights<S>) {
        let mut sum = vec![S::zero(); v.len()];
        self.d.fill(S::zero());
        self.backward(&mut sum, (&S::one(), &(S::one(), S::zero())), &weights.velocity);
        for i in 0..v.len() {
            (self.d[i], self.d_error[i]) = two_product(weights.h, v[i]);
            self.d_error[i] += weights.h * v_compensation[i];
        }
        let step = (-weights.h2, S::zero());
        S::pass(Advance { y: (&mut self.d, &mut self.d_error), k: &sum, step: &step });
    }
}
