//! Embedded Runge–Kutta methods at work: stages, error estimates, and the continuous extension.
//!
//! The error of a step is estimated from its own stages; a first-same-as-last pair weighs the derivative at the end of the
//! step too, which is the first stage of the next. Error estimates: Hairer, Nørsett & Wanner, *Solving ODE I*, II.10.
//!
//! Time is counted from the start of the run, so that a large `t0` costs no digits.

use super::Embedded;
use super::looks::Looks;
use super::norm::{Change, Norm};
use super::nystrom::{Row, nystrom_weights, pair_terms};
use super::passes::errors::{HUGE, PairTerm};
use super::passes::extension::Coordinate;
use super::passes::stages::{Positions, Term, Weighted};
use super::runge_kutta::Stages;
use super::state::State;
use super::step_control::{Clock, Controlled, Rule, Settled, root};
use super::system::{Form, System};
use super::trial::{Cost, Trial};
use crate::error::Result;
use crate::numerics::element::Element;
use crate::numerics::real::Mask;
use crate::parallel::Ticker;
use core::cell::OnceCell;

mod attempt;
mod between;
use attempt::{Attempt, Back};
use between::{Between, Weights};

/// How many times its tolerance a step may be off at its end by half of what is there.
const MISSED: f64 = 1e3;

/// An embedded method at work on one state (of one or of eight trajectories).
pub struct EmbeddedStep<S: Element> {
    method: &'static Embedded,
    stages: Stages<S>,
    /// The weights of the two error estimates.
    errors: Weights<PairTerm<S>>,
    /// Whether an estimate weighs the derivative at the end of the step.
    end_in_estimate: bool,
    /// The continuous extension, once somebody asks for it.
    between: OnceCell<Between<S>>,
    /// Room for its weights at one fraction of the step.
    weights: Row<S>,
    rule: Rule<S>,
    next: State<S>,
    /// Where its stages look.
    looks: Looks,
    /// The part of the step tried last up to which nothing lies between those, if something does.
    seen: Option<S>,
}

impl<S: Controlled> EmbeddedStep<S> {
    /// For a system and states like `state`, with steps of at most `max_step`.
    pub fn new(method: &'static Embedded, system: &dyn System<S>, state: &State<S>, max_step: S) -> Self {
        Self::with_rule(method, system, state, Rule::new(method.error_exponent, max_step))
    }

    /// As [`new`](Self::new), with a rule for the choice of steps.
    pub fn with_rule(
        method: &'static Embedded,
        system: &dyn System<S>,
        state: &State<S>,
        rule: Rule<S>,
    ) -> Self {
        let tableau = &method.tableau;
        let errors = [method.error, method.second_error.unwrap_or_default()];
        let of_rates = pair_terms(errors);
        Self {
            method,
            errors: match system.form() {
                Form::FirstOrder(_) => [Vec::new(), of_rates],
                Form::SecondOrder(_) => {
                    let [of_q, of_q2] = errors.map(|row| nystrom_weights(row, &method.rows()));
                    [pair_terms([&of_q, &of_q2]), of_rates]
                }
            },
            stages: Stages::new(tableau, 1 + method.dense_a.len(), system),
            end_in_estimate: errors.iter().any(|row| row.len() > tableau.b.len()),
            between: OnceCell::new(),
            weights: Row { fraction: S::zero(), position: Vec::new(), velocity: Vec::new() },
            rule,
            next: state.clone(),
            looks: method.looks(),
            seen: None,
        }
    }

    /// Evaluations in a lane of the step tried last that its refusal hides.
    pub(crate) fn hidden(&self, lane: usize) -> u64 {
        u64::from(!self.end_in_estimate && self.seen.as_ref().is_some_and(|seen| seen.lane(lane) < 1.0))
    }

    /// The stage that holds the derivative at the end of the step.
    fn end_stage(&self) -> usize {
        self.method.tableau.b.len()
    }

    fn between(&self) -> &Between<S> {
        self.between.get_or_init(|| Between::new(self.method, self.stages.form()))
    }

    fn change<'a>(&'a self, terms: &'a [PairTerm<S>], factor: S) -> Change<'a, S> {
        Change { k: &self.stages.k, stride: self.stages.len(), terms, factor }
    }

    /// The squared scaled error of the step.
    fn error_size(&self, state: &State<S>, elapsed: &S, h: S, norm: &Norm<S>) -> S {
        let [of_q, of_v] = &self.errors;
        let changes = match self.stages.form() {
            Form::FirstOrder(_) => [self.change(of_v, h), self.change(of_v, h)],
            Form::SecondOrder(_) => [self.change(of_q, h * h), self.change(of_v, h)],
        };
        self.combined(norm.sizes(state, &self.next, elapsed, &changes))
    }

    /// Where the derivative at the end, which no estimate weighs, is another than that of the last stage, which is at the end
    /// too: a stiff force that begins within the step has thrown the stages back to where it is not.
    fn misses_its_end(&self, state: &State<S>, elapsed: &S, h: S, norm: &Norm<S>) -> S::Mask {
        let (end, one, zero) = (self.end_stage(), S::one(), S::zero());
        let terms =
            [PairTerm { stage: end, weights: [one; 2] }, PairTerm { stage: end - 1, weights: [-one, zero] }];
        let changes = [self.change(&terms, h * h), self.change(&terms, h)];
        let [difference, whole] = norm.sizes(state, &self.next, elapsed, &changes);
        let matters = S::splat(MISSED * MISSED).less(difference);
        matters.and((S::splat(0.25) * whole).less(difference))
    }

    /// `(E² / sqrt(E² + 0.01 E3²))²` of two estimates, with `E²` and `E3²` at hand; the first if there is one only.
    #[inline(always)]
    fn combined(&self, [main, other]: [S; 2]) -> S {
        if self.method.second_error.is_none() {
            return main;
        }
        let denominator = main + S::splat(0.01) * other;
        let size2 = main * (main / denominator);
        S::select(main.less_equal(S::zero()), S::zero(), size2)
    }

    /// The first step of equations of no known geometry (Hairer, Nørsett & Wanner, II.4): a hundredth of the time in which
    /// the numbers change by their own sizes, then what the curvature on the way allows. Sizes below 1e-5 of a tolerance
    /// tell nothing; then, and without any slope, the step is one millionth, whatever the unit of time.
    fn first_step(
        &mut self,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &Clock<S>,
        norm: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<S> {
        let end_stage = self.end_stage();
        let term = |stage, weight| PairTerm { stage, weights: [weight, S::zero()] };
        let (slope, bend) = ([term(0, S::one())], [term(end_stage, S::one()), term(0, -S::one())]);
        let size2 = |change: Change<'_, S>| norm.sizes(state, state, &clock.elapsed, &[change, change])[0];
        let rate = self.change(&slope, S::one());
        let numbers2 = size2(Change { k: state.all().0, ..rate });
        let rates2 = size2(rate);

        let span = (clock.end - clock.elapsed).abs();
        let millionth = S::splat(1e-6);
        let telling = |size2: S| S::splat(1e-10).less_equal(size2);
        let by_size = S::splat(0.01) * (numbers2 / rates2).sqrt();
        let trial = S::select(telling(numbers2).and(telling(rates2)), by_size, millionth).min(span);
        let direction = S::select(clock.end.less(clock.elapsed), -S::one(), S::one());
        let euler =
            Row { fraction: S::one(), position: vec![], velocity: vec![Term { stage: 0, weight: S::one() }] };
        let step = (&clock.elapsed, &(trial * direction));
        self.stages.evaluate_at(end_stage, step, state, &euler, system, ticker)?;
        let size2 = |change: Change<'_, S>| norm.sizes(state, state, &clock.elapsed, &[change, change])[0];
        let curvature2 = size2(self.change(&bend, S::one() / trial));

        let nothing = S::splat(1e-30);
        let straight = rates2.less_equal(nothing).and(curvature2.less_equal(nothing));
        let by_order = root(S::splat(1e-4) / rates2.max(curvature2), &self.rule);
        let by_order = S::select(straight, millionth.max(trial * S::splat(1e-3)), by_order);
        let h = by_order.min(S::splat(100.0) * trial).min(span).min(self.rule.max_step);
        Ok(h * direction)
    }
}

impl<S: Controlled> Trial<S> for EmbeddedStep<S> {
    /// Hairer, Nørsett & Wanner, II.4, with scaled sizes of the largest vector.
    fn start(
        &mut self,
        fresh: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        norm: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let end_stage = self.end_stage();
        self.stages.evaluate(end_stage, &clock.elapsed, state, system, ticker)?;
        self.stages.begin_with_end(fresh, end_stage);
        let chosen = S::zero().less(clock.h.abs());
        if chosen.or(fresh.not()).all() {
            return Ok(());
        }
        let fresh = fresh.and(chosen.not());
        if norm.mean.is_some() {
            let h = self.first_step(system, state, clock, norm, ticker)?;
            clock.h = S::select(fresh, h, clock.h);
            return Ok(());
        }

        let second_order = matches!(self.stages.form(), Form::SecondOrder(_));
        let alone = |stage, weight| PairTerm { stage, weights: [weight, S::zero()] };
        let first = [alone(0, S::one())];
        // With a slope of zero any step will do; the span is then the step.
        let rate = self.change(&first, S::one());
        let slope = if second_order { Change { k: state.v(), ..rate } } else { rate };
        let slope2 = norm.sizes(state, state, &clock.elapsed, &[slope, rate])[0];
        let span = (clock.end - clock.elapsed).abs();
        let longest = span.min(self.rule.max_step);
        let still = slope2.less_equal(S::zero());
        // The time in which the state changes by its own size; a hundredth of it for the trial step.
        let time = S::select(still, longest, S::one() / (norm.rtol * slope2.sqrt()));
        // Where any error is allowed that time is without measure, and its square would be infinite.
        let time = time.min(longest * S::splat(1e100));
        let trial = (S::splat(0.01) * time).min(longest);
        let direction = S::select(clock.end.less(clock.elapsed), -S::one(), S::one());
        let euler =
            Row { fraction: S::one(), position: vec![], velocity: vec![Term { stage: 0, weight: S::one() }] };
        let step = (&clock.elapsed, &(trial * direction));
        self.stages.evaluate_at(end_stage, step, state, &euler, system, ticker)?;
        let difference = [alone(end_stage, S::one()), alone(0, -S::one())];
        // The slope of the coordinates changes by `trial·a`, every other slope by the difference of the derivatives.
        let bend = self.change(&difference, time / trial);
        let of_q = if second_order { self.change(&first, time) } else { bend };
        let curvature2 = norm.sizes(state, state, &clock.elapsed, &[of_q, bend])[0];
        // Both sizes in units of that time, so that the choice does not depend on the unit of time. Where they are beyond
        // measure the first step is still above zero: trials make it what it must be.
        let largest = (slope2 * time * time).max(curvature2 * time * time).min(S::splat(HUGE));
        let by_order = time * root(S::splat(1e-4) / largest, &self.rule);
        let by_order = S::select(largest.less_equal(S::zero()), longest, by_order);
        let h = by_order.min(time).min(longest);
        clock.h = S::select(fresh, h * direction, clock.h);
        Ok(())
    }

    fn attempt(
        &mut self,
        running: S::Mask,
        system: &mut dyn System<S>,
        state: &State<S>,
        clock: &mut Clock<S>,
        norm: &Norm<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Settled<S>> {
        if let Some(mean) = &norm.mean {
            return S::pass(Attempt { method: self, running, system, state, clock, mean, ticker });
        }
        let longest = match self.stages.form() {
            Form::SecondOrder(_) => {
                system.longest_step((state.q(), state.v()), &self.stages.k[..self.stages.len()])
            }
            Form::FirstOrder(_) => None,
        };
        if let Some(longest) = longest {
            clock.shorten(longest);
        }
        let (from, h) = (clock.elapsed, S::next_step(clock, running));
        let end_stage = self.end_stage();
        self.seen = None;
        self.stages.step((&from, &h), (state, &mut self.next), system, ticker)?;
        system.settle(&mut self.next);
        if self.end_in_estimate {
            self.stages.evaluate(end_stage, &(from + h), &self.next, system, ticker)?;
        }
        let size2 = self.error_size(state, &from, h, norm);
        let before = *clock;
        let outcome = S::settle(clock, running, size2, &self.rule);
        if outcome.accepted.any() && !self.end_in_estimate {
            self.stages.evaluate(end_stage, &clock.elapsed, &self.next, system, ticker)?;
            if longest.is_some() {
                let missed = self.misses_its_end(state, &from, h, norm).and(outcome.accepted);
                if missed.any() {
                    *clock = before;
                    let size2 = S::select(missed, S::splat(HUGE), size2);
                    return Ok(S::settle(clock, running, size2, &self.rule));
                }
            }
        }
        if !outcome.accepted.any() {
            return Ok(outcome);
        }
        let back = Back { running, state, clock, before, step: (from, h), size2 };
        self.seen_or_taken_back(outcome, back, system)
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
        let first = self.end_stage() + 1;
        let step = (&outcome.from, &outcome.h);
        let Self { method, stages, between, .. } = self;
        let between = between.get_or_init(|| Between::new(method, stages.form()));
        let mut rows = between.rows.iter().enumerate();
        rows.try_for_each(|(index, row)| stages.evaluate_at(first + index, step, state, row, system, ticker))
    }

    fn at(
        &mut self,
        outcome: &Settled<S>,
        system: &mut dyn System<S>,
        state: &State<S>,
        theta: S,
        into: &mut State<S>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { method, stages, between, weights, .. } = self;
        between.get_or_init(|| Between::new(method, stages.form())).weigh(theta, weights);
        stages.state_at(weights, state, &outcome.h, into);
        system.settle(into);
        Ok(())
    }

    fn extension(&self, state: &State<S>, h: S, into: &mut Vec<S>) {
        let len = self.stages.len();
        if matches!(self.stages.form(), Form::SecondOrder(_)) {
            let zeros = vec![S::zero(); len];
            for (index, terms) in self.between().of_terms.iter().enumerate() {
                let from = into.len();
                into.resize(from + len, S::zero());
                let fraction = if index == 0 { S::one() } else { S::zero() };
                S::pass(Positions {
                    out: &mut into[from..],
                    q: (&zeros, &zeros),
                    slope: (state.v(), &fraction),
                    stages: Weighted { h: &h, terms, k: &self.stages.k },
                });
            }
            return;
        }
        let [_, of_v] = &self.between().weights;
        for term in 0..self.terms() {
            for number in 0..len.min(state.all().0.len()) {
                let mut sum = S::zero();
                for (stage, weights) in of_v.iter().enumerate() {
                    sum = weights[term].multiply_add(self.stages.k[stage * len + number], sum);
                }
                into.push(h * sum);
            }
        }
    }

    fn polynomial(&self, coordinate: usize, h: S, into: &mut Vec<[S; 2]>) {
        let from = into.len();
        if matches!(self.stages.form(), Form::FirstOrder(_)) {
            self.polynomial_of_rates([coordinate, self.next.q().len() + coordinate], h, into);
            return;
        }
        into.resize(from + self.terms(), [S::zero(); 2]);
        let (basis, k, stride) = (&self.between().weights, &self.stages.k[..], self.stages.len());
        S::pass(Coordinate { coordinate, basis, k, stride, into: &mut into[from..] });
    }

    fn terms(&self) -> usize {
        self.method.terms()
    }

    fn keep(&mut self, accepted: S::Mask, state: &mut State<S>) {
        if accepted.all() {
            core::mem::swap(state, &mut self.next);
        } else {
            state.take_over(&self.next, accepted);
        }
        self.stages.begin_with_end(accepted, self.end_stage());
    }

    fn cost(&self) -> Cost {
        let stages = self.end_stage() as u64;
        let end = u64::from(self.end_in_estimate);
        Cost {
            start: 2,
            tried: stages - 1 + end,
            kept: 1 - end,
            dense: self.method.dense_a.len() as u64,
            read: 0,
        }
    }
}
