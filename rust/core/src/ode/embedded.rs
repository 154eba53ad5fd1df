//! Embedded Runge–Kutta methods at work: stages, error estimates, and the continuous extension.
//!
//! The error of a step is estimated from its own stages; a first-same-as-last pair weighs the derivative at the end of the
//! step too, which is the first stage of the next. Error estimates: Hairer, Nørsett & Wanner, *Solving ODE I*, II.10.
//!
//! Time is counted from the start of the run, so that a large `t0` costs no digits.

use super::Embedded;
use super::norm::{Change, Norm};
use super::nystrom::{Row, nystrom_weights, pair_terms};
use super::passes::errors::{HUGE, PairTerm};
use super::passes::stages::{Positions, Term, Weighted};
use super::passes::updates::Replace;
use super::runge_kutta::{Stages, coupling};
use super::state::State;
use super::step_control::{Clock, Controlled, Outcome, Rule, root};
use super::system::{Form, System};
use super::trial::{Cost, Trial};
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::Element;
use crate::numerics::real::{Mask, Real};
use crate::parallel::Ticker;

/// Weights of the derivatives in the coordinates and in the velocities; of a system of the first order, the first are none.
type Weights<T> = [Vec<T>; 2];

/// An embedded method at work on one state (of one or of eight trajectories).
pub struct EmbeddedStep<S: Element> {
    stages: Stages<S>,
    /// The weights of the two error estimates.
    errors: Weights<PairTerm<S>>,
    two_estimates: bool,
    /// Whether an estimate weighs the derivative at the end of the step.
    end_in_estimate: bool,
    /// The stages that only the continuous extension uses.
    dense_rows: Vec<Row<S>>,
    /// For every stage, its weights in the continuous extension in the nested basis of [`Embedded::dense`].
    dense: Weights<Vec<S>>,
    /// The weights of every stage in the coordinates, term after term of that basis.
    of_terms: Vec<Vec<Term<S>>>,
    /// Room for those weights at one fraction of the step.
    between: Row<S>,
    rule: Rule<S>,
    next: State<S>,
}

impl<S: Controlled> EmbeddedStep<S> {
    /// For a system and states like `state`, with steps of at most `max_step`.
    pub fn new(method: &Embedded, system: &dyn System<S>, state: &State<S>, max_step: S) -> Self {
        Self::with_rule(method, system, state, Rule::new(method.error_exponent, max_step))
    }

    /// As [`new`](Self::new), with a rule for the choice of steps.
    pub fn with_rule(method: &Embedded, system: &dyn System<S>, state: &State<S>, rule: Rule<S>) -> Self {
        let tableau = &method.tableau;
        // The derivative at the end is a stage of its own, whose row are the weights.
        let rows = tableau.a.iter().chain([&tableau.b]).chain(method.dense_a);
        let a: Vec<Vec<DoubleDouble>> = rows.map(|row| row.to_vec()).collect();
        let errors = [method.error, method.second_error.unwrap_or_default()];
        let of_coordinates = coupling(system.form(), &a);
        let [of_q, of_q2] = errors.map(|row| nystrom_weights(row, of_coordinates));
        let dense_rows = method.dense_a.iter().zip(method.dense_c);
        let every_stage = || (0..a.len()).map(|stage| Term { stage, weight: S::zero() }).collect();
        let stages = Stages::new(tableau, 1 + method.dense_a.len(), system);
        let of_rates = pair_terms(errors);
        let dense = dense(method, a.len(), of_coordinates);
        let of_term = |term: usize| {
            dense[0].iter().enumerate().map(move |(stage, row)| Term { stage, weight: row[term] })
        };
        let of_terms =
            (0..dense[0].first().map_or(0, Vec::len)).map(|term| of_term(term).collect()).collect();
        Self {
            errors: match stages.form() {
                Form::FirstOrder(_) => [of_rates, Vec::new()],
                Form::SecondOrder(_) => [pair_terms([&of_q, &of_q2]), of_rates],
            },
            stages,
            two_estimates: method.second_error.is_some(),
            end_in_estimate: errors.iter().any(|row| row.len() > tableau.b.len()),
            dense_rows: dense_rows.map(|(row, &c)| Row::new(row, c, of_coordinates)).collect(),
            of_terms,
            dense,
            between: Row { fraction: S::zero(), position: every_stage(), velocity: every_stage() },
            rule,
            next: state.clone(),
        }
    }

    /// The stage that holds the derivative at the end of the step.
    fn end_stage(&self) -> usize {
        self.dense[0].len() - self.dense_rows.len() - 1
    }

    fn change<'a>(&'a self, terms: &'a [PairTerm<S>], factor: S) -> Change<'a, S> {
        Change { k: &self.stages.k, stride: self.stages.len(), terms, factor }
    }

    /// The squared scaled error of the step.
    fn error_size(&self, state: &State<S>, elapsed: &S, h: S, norm: &Norm<S>) -> S {
        let [first, second] = &self.errors;
        let changes = match self.stages.form() {
            Form::FirstOrder(_) => [self.change(first, h), self.change(second, h)],
            Form::SecondOrder(_) => [self.change(first, h * h), self.change(second, h)],
        };
        let [main, other] = norm.sizes(state, &self.next, elapsed, &changes);
        if !self.two_estimates {
            return main;
        }
        // (E² / sqrt(E² + 0.01 E3²))², with E² and E3² at hand.
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

    /// Takes the derivative at the end for that at the start.
    fn begin_with_end(&mut self, lanes: S::Mask) {
        let (len, end_stage) = (self.stages.len(), self.end_stage());
        let (before, after) = self.stages.k.split_at_mut(end_stage * len);
        S::pass(Replace { into: &mut before[..len], from: &after[..len], mask: lanes });
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
        self.begin_with_end(fresh);
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
    ) -> Result<Outcome<S>> {
        let (from, h) = (clock.elapsed, S::next_step(clock, running));
        self.stages.evaluate_rest((&from, &h), state, system, ticker)?;
        self.stages.finish(state, &h, &mut self.next);
        let end_stage = self.end_stage();
        if self.end_in_estimate {
            self.stages.evaluate(end_stage, &(from + h), &self.next, system, ticker)?;
        }
        let size2 = self.error_size(state, &from, h, norm);
        let outcome = S::settle(clock, running, size2, &self.rule);
        if outcome.accepted.any() && !self.end_in_estimate {
            self.stages.evaluate(end_stage, &clock.elapsed, &self.next, system, ticker)?;
        }
        Ok(outcome)
    }

    fn next(&self) -> &State<S> {
        &self.next
    }

    fn dense(
        &mut self,
        outcome: &Outcome<S>,
        system: &mut dyn System<S>,
        state: &State<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let first = self.end_stage() + 1;
        let step = (&outcome.from, &outcome.h);
        let mut rows = self.dense_rows.iter().enumerate();
        rows.try_for_each(|(index, row)| {
            self.stages.evaluate_at(first + index, step, state, row, system, ticker)
        })
    }

    fn at(&mut self, state: &State<S>, h: S, theta: S, into: &mut State<S>) {
        let rest = S::one() - theta;
        self.between.fraction = theta;
        let weights = [&mut self.between.position, &mut self.between.velocity];
        for (terms, coefficients) in weights.into_iter().zip(&self.dense) {
            for (term, row) in terms.iter_mut().zip(coefficients) {
                term.weight = S::zero();
                for (index, &coefficient) in row.iter().enumerate().rev() {
                    let factor = if index % 2 == 0 { theta } else { rest };
                    term.weight = factor * (coefficient + term.weight);
                }
            }
        }
        self.stages.state_at(&self.between, state, &h, into);
    }

    fn extension(&self, state: &State<S>, h: S, into: &mut Vec<S>) {
        let len = self.stages.len();
        if matches!(self.stages.form(), Form::SecondOrder(_)) {
            let zeros = vec![S::zero(); len];
            for (index, terms) in self.of_terms.iter().enumerate() {
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
        for term in 0..self.terms() {
            for number in 0..len.min(state.all().0.len()) {
                let mut sum = S::zero();
                for (stage, weights) in self.dense[1].iter().enumerate() {
                    sum = weights[term].multiply_add(self.stages.k[stage * len + number], sum);
                }
                into.push(h * sum);
            }
        }
    }

    fn polynomial(&self, coordinate: usize, into: &mut Vec<[S; 2]>) {
        let len = self.stages.len();
        for term in 0..self.terms() {
            let mut sums = [S::zero(); 2];
            for (sum, weights) in sums.iter_mut().zip(&self.dense) {
                for (stage, weights) in weights.iter().enumerate() {
                    *sum += weights[term] * self.stages.k[stage * len + coordinate];
                }
            }
            into.push(sums);
        }
    }

    fn terms(&self) -> usize {
        self.dense[1].first().map_or(0, Vec::len)
    }

    fn keep(&mut self, accepted: S::Mask, state: &mut State<S>) {
        let (y, compensation) = state.all_mut();
        let (next, next_compensation) = self.next.all();
        S::pass(Replace { into: y, from: next, mask: accepted });
        S::pass(Replace { into: compensation, from: next_compensation, mask: accepted });
        self.begin_with_end(accepted);
    }

    fn cost(&self) -> Cost {
        let stages = self.end_stage() as u64;
        let end = u64::from(self.end_in_estimate);
        Cost { start: 2, tried: stages - 1 + end, kept: 1 - end, dense: self.dense_rows.len() as u64 }
    }
}

/// The weights of the continuous extension, in the coordinates and in the velocities; `a` are the rows of all stages, if
/// there are coordinates.
fn dense<S: Element>(method: &Embedded, stages: usize, a: &[Vec<DoubleDouble>]) -> Weights<Vec<S>> {
    let powers = method.dense.iter().map(|row| row.len()).max().unwrap_or(0);
    let zero = DoubleDouble::zero();
    let power = |index| -> Vec<DoubleDouble> {
        method.dense.iter().map(|row| row.get(index).copied().unwrap_or(zero)).collect()
    };
    let of_v: Vec<Vec<DoubleDouble>> = (0..powers).map(power).collect();
    let of_q: Vec<Vec<DoubleDouble>> = of_v.iter().map(|row| nystrom_weights(row, a)).collect();
    [of_q, of_v].map(|rows| {
        let of_stage = |stage| rows.iter().map(|row| S::from_double_double(row[stage])).collect();
        (0..stages).map(of_stage).collect()
    })
}
