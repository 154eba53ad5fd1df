//! Runs that choose their own steps, each lane its own.
//!
//! The one idea: a step is computed for all lanes and kept where it is accepted, so eight trajectories
//! with eight step sequences share every instruction, and one trajectory packed over the lanes is the same
//! code with all lanes alike. Outputs are read off the continuous extension and never steer; only the
//! last step is clamped to the end. Error estimates: Hairer, Nørsett & Wanner, *Solving ODE I*, II.10.
//!
//! Time is counted from the start of the run, so that a large `t0` costs no digits.

use super::Embedded;
use super::nystrom::{Row, pair_terms, twice};
use super::runge_kutta::Stages;
use super::state::State;
use super::step_control::{Clock, Controlled, Outcome, Rule, root};
use crate::error::Result;
use crate::forces::Dynamics;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, PairTerm, Term};
use crate::numerics::real::{Mask, Real};
use crate::parallel::Ticker;

/// What the error of a step is measured against.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance<S> {
    /// Relative to the distance from the reference.
    pub rtol: S,
    /// Absolute, of the coordinates.
    pub atol_q: S,
    /// Absolute, of the velocities.
    pub atol_v: S,
}

/// The point that distances are measured from: it moves uniformly (a centre of mass) or not at all.
#[derive(Clone, Debug)]
pub struct Reference<S> {
    /// Where it starts.
    pub position: [S; 3],
    /// Its velocity.
    pub velocity: [S; 3],
}

/// The largest of the lanes, in every lane; each lane its own if they are separate trajectories.
pub trait Reduce<S> {
    /// Reduces.
    fn largest(&self, value: S) -> S;
}

/// Weights of the accelerations in the coordinates and in the velocities.
type Weights<T> = [Vec<T>; 2];

/// An embedded method at work on one state (of one or of eight trajectories).
pub struct Adaptive<S: Element> {
    stages: Stages<S>,
    /// The weights of the two error estimates.
    errors: Weights<PairTerm<S>>,
    two_estimates: bool,
    /// The stages that only the continuous extension uses.
    dense_rows: Vec<Row<S>>,
    /// For every stage, its weights in the continuous extension in the nested basis of [`Embedded::dense`].
    dense: Weights<Vec<S>>,
    /// Room for those weights at one fraction of the step.
    between: Row<S>,
    rule: Rule,
    next: State<S>,
    tolerance: Tolerance<S>,
    reference: Reference<S>,
}

/// A weighted sum of derivatives to be measured, and what it is multiplied with: of the coordinates or of the velocities.
struct Change<'a, S> {
    k: &'a [S],
    terms: &'a [PairTerm<S>],
    factor: S,
}

impl<S: Controlled> Adaptive<S> {
    /// For states like `state`.
    pub fn new(
        method: &Embedded,
        state: &State<S>,
        tolerance: Tolerance<S>,
        reference: Reference<S>,
        max_step: f64,
    ) -> Self {
        let tableau = &method.tableau;
        // The derivative at the end is a stage of its own, whose row are the weights.
        let rows = tableau.a.iter().chain([&tableau.b]).chain(method.dense_a);
        let a: Vec<Vec<DoubleDouble>> = rows.map(|row| row.to_vec()).collect();
        let errors = [method.error, method.second_error.unwrap_or_default()];
        let [of_q, of_q2] = errors.map(|row| twice(row, &a));
        let dense_rows = method.dense_a.iter().zip(method.dense_c);
        let every_stage = || (0..a.len()).map(|stage| Term { stage, weight: S::zero() }).collect();
        Self {
            stages: Stages::new(tableau, 1 + method.dense_a.len(), state.shape.len()),
            errors: [pair_terms([&of_q, &of_q2]), pair_terms(errors)],
            two_estimates: method.second_error.is_some(),
            dense_rows: dense_rows.map(|(row, &c)| Row::new(row, c, &a)).collect(),
            dense: dense(method, &a),
            between: Row { fraction: S::zero(), position: every_stage(), velocity: every_stage() },
            rule: Rule { error_exponent: method.error_exponent, max_step },
            next: state.clone(),
            tolerance,
            reference,
        }
    }

    /// The stage that holds the acceleration at the end of the step.
    fn end_stage(&self) -> usize {
        self.dense[0].len() - self.dense_rows.len() - 1
    }

    /// The larger squared scaled size of the changes of `[q, v]`, for each of the two sets of weights.
    fn scaled_sizes(
        &self,
        state: &State<S>,
        elapsed: S,
        [of_q, of_v]: [Change<'_, S>; 2],
        reduce: &impl Reduce<S>,
    ) -> [S; 2] {
        let Reference { position, velocity } = self.reference;
        let place: [S; 3] = core::array::from_fn(|c| position[c] + velocity[c] * elapsed);
        let sizes = |y: &[S], reference: &[S; 3], atol: &S, change: &Change<'_, S>| {
            let tolerance = (atol, &self.tolerance.rtol);
            S::largest_errors(state.shape, y, reference, tolerance, &change.factor, change.terms, change.k)
        };
        let of_q = sizes(state.q(), &place, &self.tolerance.atol_q, &of_q);
        let of_v = sizes(state.v(), &velocity, &self.tolerance.atol_v, &of_v);
        [reduce.largest(of_q[0].max(of_v[0])), reduce.largest(of_q[1].max(of_v[1]))]
    }

    /// Changes what errors are measured against, when lanes take up other trajectories.
    pub fn set_measure(&mut self, tolerance: Tolerance<S>, reference: Reference<S>) {
        self.tolerance = tolerance;
        self.reference = reference;
    }

    /// Starts the lanes of `fresh`: evaluates their first acceleration and chooses their first step
    /// (Hairer, Nørsett & Wanner, II.4, with scaled sizes of the largest particle).
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn start(
        &mut self,
        fresh: S::Mask,
        state: &State<S>,
        clock: &mut Clock<S>,
        dynamics: &mut Dynamics<S>,
        reduce: &impl Reduce<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let end_stage = self.end_stage();
        self.stages.evaluate(end_stage, state, dynamics, ticker)?;
        self.begin_with_end(fresh);

        let alone = |stage, weight| PairTerm { stage, weights: [weight, S::zero()] };
        let first = [alone(0, S::one())];
        // With a slope of zero any step will do; the span is then the step.
        let slope = |k| Change { k, terms: &first, factor: S::one() };
        let slopes = [slope(state.v()), slope(self.stages.acceleration(0))];
        let slope2 = self.scaled_sizes(state, clock.elapsed, slopes, reduce)[0];
        let span = (clock.end - clock.elapsed).abs();
        let longest = span.min(S::splat(self.rule.max_step));
        let still = slope2.less_equal(S::zero());
        // The time in which the state changes by its own size; a hundredth of it for the trial step.
        let time = S::select(still, longest, S::one() / (self.tolerance.rtol * slope2.sqrt()));
        let trial = (S::splat(0.01) * time).min(longest);
        let direction = S::select(clock.end.less(clock.elapsed), -S::one(), S::one());
        let euler =
            Row { fraction: S::one(), position: vec![], velocity: vec![Term { stage: 0, weight: S::one() }] };
        self.stages.evaluate_at(end_stage, state, &(trial * direction), &euler, dynamics, ticker)?;
        let difference = [alone(end_stage, S::one()), alone(0, -S::one())];
        // The slope of the coordinates changes by `trial·a`, that of the velocities by the difference of `a`.
        let a = &self.stages.a[..];
        let curvatures = [
            Change { k: a, terms: &first, factor: time },
            Change { k: a, terms: &difference, factor: time / trial },
        ];
        let curvature2 = self.scaled_sizes(state, clock.elapsed, curvatures, reduce)[0];
        // Both sizes in units of that time, so that the choice does not depend on the unit of time.
        let largest = (slope2 * time * time).max(curvature2 * time * time);
        let by_order = time * root(S::splat(1e-4) / largest, self.rule);
        let by_order = S::select(largest.less_equal(S::zero()), longest, by_order);
        let h = by_order.min(time).min(longest);
        clock.h = S::select(fresh, h * direction, clock.h);
        Ok(())
    }

    /// Tries one step in every lane.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn step(
        &mut self,
        running: S::Mask,
        state: &State<S>,
        clock: &mut Clock<S>,
        dynamics: &mut Dynamics<S>,
        reduce: &impl Reduce<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Outcome<S>> {
        let h = S::next_step(clock, running);
        self.stages.evaluate_rest(state, &h, dynamics, ticker)?;
        self.stages.finish(state, &h, &mut self.next);
        let size2 = self.error_size(state, clock.elapsed, h, reduce);
        let outcome = S::settle(clock, running, size2, self.rule);
        if outcome.accepted.any() {
            self.stages.evaluate(self.end_stage(), &self.next, dynamics, ticker)?;
        }
        Ok(outcome)
    }

    /// The squared scaled error of the step.
    fn error_size(&self, state: &State<S>, elapsed: S, h: S, reduce: &impl Reduce<S>) -> S {
        let change = |half: usize, factor| Change { k: &self.stages.a, terms: &self.errors[half], factor };
        let [main, other] = self.scaled_sizes(state, elapsed, [change(0, h * h), change(1, h)], reduce);
        if !self.two_estimates {
            return main;
        }
        // (E² / sqrt(E² + 0.01 E3²))², with E² and E3² at hand.
        let denominator = main + S::splat(0.01) * other;
        let size2 = main * (main / denominator);
        S::select(main.less_equal(S::zero()), S::zero(), size2)
    }

    /// Between `step` and [`commit`](Self::commit): readies the stages of the continuous extension.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn prepare_dense(
        &mut self,
        state: &State<S>,
        h: S,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let first = self.end_stage() + 1;
        let mut rows = self.dense_rows.iter().enumerate();
        rows.try_for_each(|(index, row)| {
            self.stages.evaluate_at(first + index, state, &h, row, dynamics, ticker)
        })
    }

    /// The state at the fraction `theta` of the step, lane by lane; needs [`prepare_dense`](Self::prepare_dense).
    pub fn interpolate(&mut self, state: &State<S>, h: S, theta: S, into: &mut State<S>) {
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

    /// Force evaluations of the continuous extension beyond the step's own.
    pub fn dense_stages(&self) -> u64 {
        self.dense_rows.len() as u64
    }

    /// The state at the end of the step tried last.
    pub fn next(&self) -> &State<S> {
        &self.next
    }

    /// Moves the accepted lanes to the end of their step.
    pub fn commit(&mut self, accepted: S::Mask, state: &mut State<S>) {
        let (y, error) = state.all_mut();
        let (next, next_error) = self.next.all();
        S::replace(y, next, accepted);
        S::replace(error, next_error, accepted);
        self.begin_with_end(accepted);
    }

    /// Takes the acceleration at the end for that at the start.
    fn begin_with_end(&mut self, lanes: S::Mask) {
        let (len, end_stage) = (self.stages.len(), self.end_stage());
        let (before, after) = self.stages.a.split_at_mut(end_stage * len);
        S::replace(&mut before[..len], &after[..len], lanes);
    }
}

/// The weights of the continuous extension, in the coordinates and in the velocities; `a` are the rows of all stages.
fn dense<S: Element>(method: &Embedded, a: &[Vec<DoubleDouble>]) -> Weights<Vec<S>> {
    let powers = method.dense.iter().map(|row| row.len()).max().unwrap_or(0);
    let zero = DoubleDouble::zero();
    let power = |index| -> Vec<DoubleDouble> {
        method.dense.iter().map(|row| row.get(index).copied().unwrap_or(zero)).collect()
    };
    let of_v: Vec<Vec<DoubleDouble>> = (0..powers).map(power).collect();
    let of_q: Vec<Vec<DoubleDouble>> = of_v.iter().map(|row| twice(row, a)).collect();
    [of_q, of_v].map(|rows| {
        let of_stage = |stage| rows.iter().map(|row| S::from_double_double(row[stage])).collect();
        (0..a.len()).map(of_stage).collect()
    })
}
