//! The state that an integrator advances: coordinates and velocities, each with its compensation.

use crate::numerics::element::{Element, Shape};

/// `q + q_error` and `v + v_error` carry the state with about twice the digits of the scalar.
#[derive(Clone, Debug)]
pub struct State<S> {
    /// Coordinates and velocities in one block, `[q | v]`.
    y: Vec<S>,
    /// Their compensations.
    error: Vec<S>,
    /// How each half lies.
    pub shape: Shape,
}

impl<S: Element> State<S> {
    /// From coordinates and velocities of the same shape.
    pub fn new(shape: Shape, q: &[S], v: &[S]) -> Self {
        let y: Vec<S> = q.iter().chain(v).copied().collect();
        Self { error: vec![S::zero(); y.len()], y, shape }
    }
    /// Coordinates.
    pub fn q(&self) -> &[S] {
        &self.y[..self.shape.len()]
    }
    /// Velocities.
    pub fn v(&self) -> &[S] {
        &self.y[self.shape.len()..]
    }
    /// What the coordinates leave out.
    pub fn q_error(&self) -> &[S] {
        &self.error[..self.shape.len()]
    }
    /// What the velocities leave out.
    pub fn v_error(&self) -> &[S] {
        &self.error[self.shape.len()..]
    }
    /// Coordinates and what they leave out.
    pub fn position(&self) -> (&[S], &[S]) {
        (self.q(), self.q_error())
    }
    /// Velocities and what they leave out.
    pub fn velocity(&self) -> (&[S], &[S]) {
        (self.v(), self.v_error())
    }
    /// Coordinates and velocities, and their compensations.
    pub fn all(&self) -> (&[S], &[S]) {
        (&self.y, &self.error)
    }
    /// As [`all`](Self::all), to be changed.
    pub fn all_mut(&mut self) -> (&mut [S], &mut [S]) {
        (&mut self.y, &mut self.error)
    }
    /// `((q, q_error), (v, v_error))`, to be changed.
    #[inline]
    #[allow(clippy::type_complexity, reason = "two pairs of slices, named in the line above")]
    pub fn halves_mut(&mut self) -> ((&mut [S], &mut [S]), (&mut [S], &mut [S])) {
        let n = self.shape.len();
        let (q, v) = self.y.split_at_mut(n);
        let (q_error, v_error) = self.error.split_at_mut(n);
        ((q, q_error), (v, v_error))
    }
    /// Becomes all zeros.
    pub fn clear(&mut self) {
        self.y.fill(S::zero());
        self.error.fill(S::zero());
    }
    /// Takes over another state of the same shape.
    pub fn copy_from(&mut self, other: &Self) {
        self.y.copy_from_slice(&other.y);
        self.error.copy_from_slice(&other.error);
    }
}
