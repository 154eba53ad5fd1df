//! What a step in another time does beside its kicks and drifts: how long they are, and what W comes to.
//!
//! They are a few operations on one number in each lane, and together most of a step of few bodies.

use super::updates::add_compensated;
use crate::numerics::double_double::{DoubleDouble, two_sum};
use crate::numerics::element::{Element, PairMut, Pass, Scaled, View};
use crate::numerics::real::Mask;

/// The shares of a step that kicks and drifts have: found again only for another step.
#[derive(Clone, Debug)]
pub(in crate::ode) struct Shares<S> {
    /// Of which step; of none at first.
    of: Option<S>,
    /// Those of a kick and of the drift after it.
    pub(in crate::ode) pairs: Vec<(Scaled<S>, Scaled<S>)>,
}

impl<S: Element> Shares<S> {
    /// Room for so many pairs.
    pub(in crate::ode) fn new(pairs: usize) -> Self {
        let nothing = (S::zero(), S::zero());
        Self { of: None, pairs: vec![(nothing, nothing); pairs] }
    }

    /// Of a step, by the coefficients of a table.
    pub(in crate::ode) fn find(&mut self, step: &S, table: &[(DoubleDouble, DoubleDouble)]) {
        let known = self.of.is_some();
        let of = self.of.get_or_insert(*step);
        S::pass(Find { step, table, known, of, pairs: &mut self.pairs });
    }
}

struct Find<'a, S> {
    step: &'a S,
    table: &'a [(DoubleDouble, DoubleDouble)],
    /// Whether the shares are those of the step `of`.
    known: bool,
    of: &'a mut S,
    pairs: &'a mut [(Scaled<S>, Scaled<S>)],
}

impl<S: Element> Pass<S> for Find<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let (step, of) = (V::load(*self.step), V::load(*self.of));
        if self.known && step.less_equal(of).and(of.less_equal(step)).all() {
            return;
        }
        for (pair, &(kick, drift)) in self.pairs.iter_mut().zip(self.table) {
            let (kick, drift) = (step.scaled_by(kick), step.scaled_by(drift));
            *pair = ((kick.0.store(), kick.1.store()), (drift.0.store(), drift.1.store()));
        }
        *self.of = step.store();
    }
}

/// A share of a step over a sum of three, the last two of which belong together: as long as that part lasts.
#[derive(Debug)]
pub(in crate::ode) struct Lasting<'a, S> {
    pub(in crate::ode) share: &'a Scaled<S>,
    pub(in crate::ode) over: [&'a S; 3],
}

impl<S: Element> Lasting<'_, S> {
    #[inline(always)]
    fn found<V: View<S>>(&self) -> V {
        let (share, over) = (V::scaled(self.share), self.over);
        (share.0 + share.1) / (V::load(*over[0]) + (V::load(*over[1]) + V::load(*over[2])))
    }
}

impl<S: Element> Pass<S> for Lasting<'_, S> {
    type Output = S;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S {
        self.found::<V>().store()
    }
}

/// A drift that lasts so long: `q += t v`, and the time that has been taken grows by t.
#[derive(Debug)]
pub(in crate::ode) struct Drift<'a, S> {
    pub(in crate::ode) lasting: Lasting<'a, S>,
    pub(in crate::ode) q: PairMut<'a, S>,
    pub(in crate::ode) v: &'a [S],
    pub(in crate::ode) taken: &'a mut (S, S),
}

impl<S: Element> Pass<S> for Drift<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let (step, v) = (self.lasting.found::<V>(), V::view(self.v));
        let (q, e) = V::pair_mut(self.q);
        let (q, e) = (&mut q[..v.len()], &mut e[..v.len()]);
        for i in 0..v.len() {
            // As a step with nothing left out.
            let increment = step.multiply_add(v[i], V::zero() * v[i]);
            (q[i], e[i]) = add_compensated(q[i], e[i], increment);
        }
        let taken = V::scaled(self.taken);
        let (time, rest) = two_sum(taken.0, taken.1 + step);
        *self.taken = (time.store(), rest.store());
    }
}

/// What W comes to in a kick so long, by its rates before and after: velocities change linearly in it, so that their mean is
/// exact.
#[derive(Debug)]
pub(in crate::ode) struct Carry<'a, S> {
    pub(in crate::ode) step: &'a S,
    pub(in crate::ode) rates: [&'a S; 2],
    pub(in crate::ode) weight: &'a mut (S, S),
}

impl<S: Element> Pass<S> for Carry<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let [before, after] = [V::load(*self.rates[0]), V::load(*self.rates[1])];
        let change = V::load(*self.step) * V::splat(0.5) * (before + after);
        let (weight, rest) = V::scaled(self.weight);
        let (weight, rest) = two_sum(weight, rest + change);
        *self.weight = (weight.store(), rest.store());
    }
}
