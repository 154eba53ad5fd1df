//! A motion as a Taylor series, and what a system has to do to be expanded in one.
//!
//! The one idea: of `q'' = a(t, q, v)` the n-th coefficient of the acceleration follows from those of `q` and `v` up to
//! the n-th, and gives those of order n+1 and n+2; of `y' = f(t, y)` the n-th of the rate gives that of order n+1. A [`Jet`]
//! holds them; time is counted in a unit near the step, a power of two, so that no power of it leaves the range of numbers.

use super::state::State;
use super::system::Form;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Pass, Scaled, View};
use crate::numerics::integrals::{over, raise};

/// Taylor coefficients of a state in powers of the time since its expansion, in units of [`unit`](Self::unit).
#[derive(Clone, Debug)]
pub struct Jet<S> {
    /// How many coefficients of the acceleration there are.
    pub order: usize,
    /// Numbers of a block of coordinates.
    pub len: usize,
    /// Blocks of coordinates, from order 0 to `order + 1`.
    pub q: Vec<S>,
    /// Blocks of velocities (in that unit of time), from order 0 to `order`; of a system of the first order, nothing.
    pub v: Vec<S>,
    /// What the coordinates of order 0 (or all numbers of a system of the first order) leave out, then the velocities.
    pub rests: [Vec<S>; 2],
    /// The time of the expansion.
    pub t: S,
    /// The unit of time, a power of two.
    pub unit: S,
    /// One over the unit of time.
    pub per_unit: S,
    /// 1, and -1 where time runs back.
    pub forward: S,
    /// 1/n.
    pub(crate) inverse: Vec<Scaled<S>>,
}

impl<S: Element> Jet<S> {
    /// Room for series of states with so many coordinates, up to this order.
    pub fn new(len: usize, highest: usize) -> Self {
        let zeros = |blocks: usize| vec![S::zero(); blocks * len];
        let one = DoubleDouble::from(1.0);
        let inverse =
            (0..highest + 3).map(|n| S::unevaluated(one / DoubleDouble::from(n.max(1) as f64))).collect();
        Self {
            order: highest,
            len,
            q: zeros(highest + 2),
            v: zeros(highest + 1),
            rests: [zeros(1), zeros(1)],
            t: S::zero(),
            unit: S::one(),
            per_unit: S::one(),
            forward: S::one(),
            inverse,
        }
    }

    /// The coordinates of an order.
    pub fn position(&self, n: usize) -> &[S] {
        &self.q[n * self.len..][..self.len]
    }

    /// The velocities of an order, in the unit of time.
    pub fn velocity(&self, n: usize) -> &[S] {
        &self.v[n * self.len..][..self.len]
    }

    /// Begins with a state; one of the first order is all coordinates.
    pub fn begin(&mut self, state: &State<S>, t: S, unit: S) {
        let len = self.len;
        (self.t, self.unit) = (t, unit);
        if matches!(state.form(), Form::FirstOrder(_)) {
            let (numbers, rests) = state.all();
            self.q[..len].copy_from_slice(numbers);
            return self.rests[0].copy_from_slice(rests);
        }
        self.q[..len].copy_from_slice(state.q());
        self.rests[0].copy_from_slice(state.q_compensation());
        let (v, rest) = state.velocity();
        let [_, rests] = &mut self.rests;
        self.per_unit = S::pass(Begin {
            v,
            rest,
            unit: &unit,
            into: &mut self.v[..len],
            rests,
            q: &mut self.q[len..2 * len],
        });
    }

    /// Takes up the coefficient `a` of order `n` of the accelerations.
    pub fn raise(&mut self, n: usize, a: &[S]) {
        let len = self.len;
        let [of_v, of_q] = [&self.inverse[n + 1], &self.inverse[n + 2]];
        let (v, q) = (&mut self.v[(n + 1) * len..][..len], &mut self.q[(n + 2) * len..][..len]);
        S::pass(Raise { a, of_v, of_q, v, q });
    }

    /// Takes up the coefficient of order `n` of the rates of a system of the first order.
    pub fn raise_rates(&mut self, n: usize, rates: &[S]) {
        let (unit, inverse) = (&self.unit, &self.inverse[n + 1]);
        S::pass(RaiseRates { rates, unit, inverse, into: &mut self.q[(n + 1) * self.len..][..self.len] });
    }
}

/// The coefficients of a system of the first order that follow from one of the rates.
struct RaiseRates<'a, S> {
    rates: &'a [S],
    unit: &'a S,
    inverse: &'a Scaled<S>,
    into: &'a mut [S],
}

impl<S: Element> Pass<S> for RaiseRates<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let (unit, inverse) = (V::load(*self.unit), V::scaled(self.inverse));
        for (into, rate) in V::view_mut(self.into).iter_mut().zip(V::view(self.rates)) {
            *into = over(*rate * unit, inverse);
        }
    }
}

/// The coefficients of order 0 and 1 that a state gives.
struct Begin<'a, S> {
    v: &'a [S],
    rest: &'a [S],
    unit: &'a S,
    into: &'a mut [S],
    rests: &'a mut [S],
    q: &'a mut [S],
}

impl<S: Element> Pass<S> for Begin<'_, S> {
    /// One over the unit of time.
    type Output = S;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S {
        let (v, rest, unit) = (V::view(self.v), V::view(self.rest), V::load(*self.unit));
        let n = v.len();
        let (into, rests, q) = (V::view_mut(self.into), V::view_mut(self.rests), V::view_mut(self.q));
        let (rest, into, rests, q) = (&rest[..n], &mut into[..n], &mut rests[..n], &mut q[..n]);
        for i in 0..n {
            let speed = v[i] * unit;
            (into[i], q[i], rests[i]) = (speed, speed, rest[i] * unit);
        }
        (V::one() / unit).store()
    }
}

/// The coefficients of velocities and coordinates that follow from one of the accelerations.
struct Raise<'a, S> {
    a: &'a [S],
    of_v: &'a Scaled<S>,
    of_q: &'a Scaled<S>,
    v: &'a mut [S],
    q: &'a mut [S],
}

impl<S: Element> Pass<S> for Raise<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let (of_v, of_q) = (V::scaled(self.of_v), V::scaled(self.of_q));
        raise(V::view(self.a), of_v, of_q, V::view_mut(self.v), V::view_mut(self.q));
    }
}
