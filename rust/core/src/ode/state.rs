//! The state that an integrator advances: numbers, each with its compensation.

use super::passes::updates::replace;
use super::system::Form;
use crate::numerics::element::{Element, PairMut};

/// `y + compensation` carries the state with about twice the digits of the scalar.
#[derive(Clone, Debug)]
pub struct State<S> {
    y: Vec<S>,
    compensation: Vec<S>,
    /// How many of the first numbers are coordinates, which velocities or momenta follow; 0 if nothing tells them apart.
    coordinates: usize,
    /// Whether those are the derivatives of the coordinates.
    second_order: bool,
}

impl<S: Element> State<S> {
    /// Of a system of the second order, from coordinates and velocities.
    pub fn new(q: &[S], v: &[S]) -> Self {
        Self {
            coordinates: q.len(),
            second_order: true,
            ..Self::first_order(q.iter().chain(v).copied().collect())
        }
    }
    /// Of a system of the first order.
    pub fn first_order(y: Vec<S>) -> Self {
        Self { compensation: vec![S::zero(); y.len()], y, coordinates: 0, second_order: false }
    }
    /// The same numbers as those of a system of the first order, some of whose coordinates have other derivatives than what
    /// follows them.
    #[must_use]
    pub fn into_first_order(self) -> Self {
        Self { second_order: false, ..self }
    }
    /// The form of the equations that it is a state of.
    #[inline]
    pub fn form(&self) -> Form {
        if self.second_order { Form::SecondOrder(self.coordinates) } else { Form::FirstOrder(self.y.len()) }
    }
    /// Coordinates.
    #[inline]
    pub fn q(&self) -> &[S] {
        &self.y[..self.coordinates]
    }
    /// Velocities.
    #[inline]
    pub fn v(&self) -> &[S] {
        &self.y[self.coordinates..]
    }
    /// What the coordinates leave out.
    #[inline]
    pub fn q_compensation(&self) -> &[S] {
        &self.compensation[..self.coordinates]
    }
    /// What the velocities leave out.
    #[inline]
    pub fn v_compensation(&self) -> &[S] {
        &self.compensation[self.coordinates..]
    }
    /// Coordinates and what they leave out.
    #[inline]
    pub fn position(&self) -> (&[S], &[S]) {
        (self.q(), self.q_compensation())
    }
    /// Velocities and what they leave out.
    #[inline]
    pub fn velocity(&self) -> (&[S], &[S]) {
        (self.v(), self.v_compensation())
    }
    /// All numbers and their compensations.
    #[inline]
    pub fn all(&self) -> (&[S], &[S]) {
        (&self.y, &self.compensation)
    }
    /// As [`all`](Self::all), to be changed.
    #[inline]
    pub fn all_mut(&mut self) -> PairMut<'_, S> {
        (&mut self.y, &mut self.compensation)
    }
    /// Coordinates and velocities, each with their compensations, to be changed.
    #[inline]
    pub fn halves_mut(&mut self) -> (PairMut<'_, S>, PairMut<'_, S>) {
        let (q, v) = self.y.split_at_mut(self.coordinates);
        let (q_compensation, v_compensation) = self.compensation.split_at_mut(self.coordinates);
        ((q, q_compensation), (v, v_compensation))
    }
    /// Becomes all zeros.
    pub fn clear(&mut self) {
        self.y.fill(S::zero());
        self.compensation.fill(S::zero());
    }
    /// Takes over another state of the same form.
    pub fn copy_from(&mut self, other: &Self) {
        self.y.copy_from_slice(&other.y);
        self.compensation.copy_from_slice(&other.compensation);
    }
    /// Takes over another state of the same form in the lanes of the mask.
    pub fn take_over(&mut self, other: &Self, lanes: S::Mask) {
        replace(&mut self.y, &other.y, lanes);
        replace(&mut self.compensation, &other.compensation, lanes);
    }
}
