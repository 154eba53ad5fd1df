//! A motion as a Taylor series, and what a system has to do to be expanded in one.
//!
//! The one idea: of `q'' = a(t, q, v)` the n-th coefficient of the acceleration follows from those of `q` and `v` up to
//! the n-th, and gives those of order n+1 and n+2; of `y' = f(t, y)` the n-th of the rate gives that of order n+1. A [`Jet`]
//! holds them; time is counted in a unit near the step, a power of two, so that no power of it leaves the range of numbers.

use super::state::State;
use super::system::Form;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Pair, Pass, Scaled, View};
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

    /// Begins with a state, from which time runs to `end`; one of the first order is all coordinates.
    pub fn begin(&mut self, state: &State<S>, [t, end]: [&S; 2], unit: &S) {
        let len = self.len;
        let second_order = matches!(state.form(), Form::SecondOrder(_));
        let (places, velocities) = if second_order {
            (state.position(), state.velocity())
        } else {
            (state.all(), (&[][..], &[][..]))
        };
        let (order_0, order_1) = self.q.split_at_mut(len);
        let [rests, rests_of_v] = &mut self.rests;
        S::pass(Begin {
            from: [places, velocities],
            times: [t, end, unit],
            q: [order_0, &mut order_1[..velocities.0.len()]],
            v: &mut self.v[..velocities.0.len()],
            rests: [rests, rests_of_v],
            of_time: [&mut self.t, &mut self.unit, &mut self.per_unit, &mut self.forward],
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
    /// Coordinates, and velocities if they are their rates.
    from: [Pair<'a, S>; 2],
    /// The time, its end and its unit.
    times: [&'a S; 3],
    q: [&'a mut [S]; 2],
    v: &'a mut [S],
    rests: [&'a mut [S]; 2],
    /// The time, its unit, one over that, and its sign.
    of_time: [&'a mut S; 4],
}

impl<S: Element> Pass<S> for Begin<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let Self { from: [places, velocities], times: [t, end, unit], .. } = self;
        let ((y, rest), unit) = (V::pair(places), V::load(*unit));
        let [q, next] = self.q;
        let [rests, rests_of_v] = self.rests;
        let (q, rests) = (&mut V::view_mut(q)[..y.len()], &mut V::view_mut(rests)[..y.len()]);
        let rest = &rest[..y.len()];
        for i in 0..y.len() {
            (q[i], rests[i]) = (y[i], rest[i]);
        }
        let (v, rest) = V::pair(velocities);
        let (into, next) = (&mut V::view_mut(self.v)[..v.len()], &mut V::view_mut(next)[..v.len()]);
        let (rest, rests) = (&rest[..v.len()], &mut V::view_mut(rests_of_v)[..v.len()]);
        for i in 0..v.len() {
            let speed = v[i] * unit;
            (into[i], next[i], rests[i]) = (speed, speed, rest[i] * unit);
        }
        let (t, one) = (V::load(*t), V::one());
        let forward = V::select(V::load(*end).less(t), -one, one);
        let [of_t, of_unit, of_per_unit, of_forward] = self.of_time;
        (*of_t, *of_unit) = (t.store(), unit.store());
        (*of_per_unit, *of_forward) = ((one / unit).store(), forward.store());
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
