//! Runge–Kutta methods with a fixed step as trials that are never refused, for runs that look between their steps.
//!
//! The one idea: the polynomial through the ends of a step, their derivatives and the state in its middle, which a half step
//! of the method itself leads to, is of order 4, or of the method's own if that is less. All steps are equal but the last.

use super::Tableau;
use super::norm::Norm;
use super::runge_kutta::Stages;
use super::state::State;
use super::step_control::{Clock, Controlled, Rule, Settled};
use super::system::System;
use super::trial::{Cost, Trial};
use crate::error::Result;
use crate::parallel::Ticker;

/// Terms of the polynomial.
const TERMS: usize = 4;

/// A tableau at work with equal steps on a system of the first order.
#[derive(Debug)]
pub struct EqualSteps<S> {
    stages: Stages<S>,
    /// Those of the half step.
    half: Stages<S>,
    h: S,
    rule: Rule<S>,
    next: State<S>,
    middle: State<S>,
    polynomial: Vec<S>,
}

impl<S: Controlled> EqualSteps<S> {
    /// Steps of `h`, all but the last.
    pub fn new(tableau: &Tableau, h: S, system: &dyn System<S>, state: &State<S>) -> Self {
        Self {
            stages: Stages::new(tableau, 1, system),
            half: Stages::new(tableau, 0, system),
            h,
            // Without an error every next step is the longest.
            rule: Rule::new(1, h.abs()),
            next: state.clone(),
            middle: state.clone(),
            polynomial: vec![],
        }
    }

    /// The stage that holds the derivative at the end of a step.
    fn end_stage(&self) -> usize {
        self.stages.k.len() / self.stages.len().max(1) - 1
    }
}

impl<S: Controlled> Trial<S> for EqualSteps<S> {
    fn start(
        &mut self,
        fresh: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        _: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        clock.h = S::select(fresh, self.h, clock.h);
        self.stages.evaluate(0, &clock.elapsed, state, system, ticker)
    }

    fn attempt(
        &mut self,
        running: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        _: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Settled<S>> {
        let (from, h) = (clock.elapsed, S::next_step(clock, running));
        self.stages.step((&from, &h), (state, &mut self.next), system, ticker)?;
        let outcome = S::settle(clock, running, S::zero(), &self.rule);
        self.stages.evaluate(self.end_stage(), &clock.elapsed, &self.next, system, ticker)?;
        Ok(outcome)
    }

    fn next(&self) -> &State<S> {
        &self.next
    }

    fn dense(
        &mut self,
        outcome: &Settled<S>,
        system: &mut dyn System<S>,
        state: &State<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let len = self.stages.len();
        let h = outcome.h * S::splat(0.5);
        self.half.k[..len].copy_from_slice(&self.stages.k[..len]);
        self.half.step((&outcome.from, &h), (state, &mut self.middle), system, ticker)?;
        let mut polynomial = core::mem::take(&mut self.polynomial);
        polynomial.clear();
        self.extension(state, outcome.h, &mut polynomial);
        self.polynomial = polynomial;
        Ok(())
    }

    fn at(
        &mut self,
        _: &Settled<S>,
        _: &mut dyn System<S>,
        state: &State<S>,
        theta: S,
        into: &mut State<S>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        let len = self.stages.len();
        let (y, compensation) = into.all_mut();
        let (start, start_compensation) = state.all();
        for i in 0..len {
            let terms = (0..TERMS).map(|term| self.polynomial[term * len + i]);
            y[i] = start[i] + (start_compensation[i] + nested(terms.rev(), theta));
            compensation[i] = S::zero();
        }
        Ok(())
    }

    fn extension(&self, state: &State<S>, h: S, into: &mut Vec<S>) {
        let len = self.stages.len();
        let [(start, start_rest), (middle, middle_rest), (end, end_rest)] =
            [state, &self.middle, &self.next].map(State::all);
        let end_stage = self.end_stage();
        let (first, last) = (self.stages.derivative(0), self.stages.derivative(end_stage));
        let from = into.len();
        into.resize(from + TERMS * len, S::zero());
        for i in 0..len {
            let whole = (end[i] - start[i]) + (end_rest[i] - start_rest[i]);
            let half = (middle[i] - start[i]) + (middle_rest[i] - start_rest[i]);
            let rise = h * first[i] - whole;
            let bend = S::splat(2.0) * whole - h * first[i] - h * last[i];
            // half = (whole + (rise + (bend + skew/2)/2)/2)/2
            let twice = S::splat(2.0);
            let skew = twice * (twice * (twice * (twice * half - whole) - rise) - bend);
            for (term, value) in [whole, rise, bend, skew].into_iter().enumerate() {
                into[from + term * len + i] = value;
            }
        }
    }

    fn terms(&self) -> usize {
        TERMS
    }

    fn keep(&mut self, accepted: S::Mask, state: &mut State<S>) {
        state.take_over(&self.next, accepted);
        self.stages.begin_with_end(accepted, self.end_stage());
    }

    fn cost(&self) -> Cost {
        let stages = self.end_stage() as u64;
        Cost { start: 1, tried: stages, kept: 0, dense: stages - 1, read: 0 }
    }
}

/// `θ(f0 + (1-θ)(f1 + θ(f2 + (1-θ)(f3 + …))))`; the terms come from the last to the first.
#[inline(always)]
pub(super) fn nested<S: Controlled>(terms: impl ExactSizeIterator<Item = S>, theta: S) -> S {
    let rest = S::one() - theta;
    let last = terms.len();
    terms.enumerate().fold(S::zero(), |inner, (index, term)| {
        let factor = if (last - 1 - index).is_multiple_of(2) { theta } else { rest };
        factor * (term + inner)
    })
}
