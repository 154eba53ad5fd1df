//! Runs that choose their own steps, each lane its own.
//!
//! The one idea: a step is computed for all lanes and kept where it is accepted, so eight trajectories
//! with eight step sequences share every instruction, and one trajectory packed over the lanes is the same
//! code with all lanes alike. Outputs are read off the continuous extension and never steer; only the
//! last step is clamped to the end. Step control: Hairer, Nørsett & Wanner, *Solving ODE I*, II.4, II.10.
//!
//! Time is counted from the start of the run, so that a large `t0` costs no digits.

use super::Embedded;
use super::runge_kutta::{Stages, terms};
use super::state::State;
use crate::error::Result;
use crate::forces::Dynamics;
use crate::numerics::double_double::two_sum;
use crate::numerics::element::{Element, Shape, Term};
use crate::numerics::real::{Mask, Real};
use crate::parallel::Ticker;

/// Growth limits of the step, and its safety factor (the values of DOP853).
const SHRINK: f64 = 1.0 / 3.0;
const GROW: f64 = 6.0;
const SAFETY: f64 = 0.9;
/// A step below this many units in the last place of the elapsed time is no step.
const SMALLEST_STEP: f64 = 4.0 * f64::EPSILON;

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

/// Everything that is one number per lane.
#[derive(Clone, Copy, Debug)]
pub struct Clock<S> {
    /// Elapsed time, and what it leaves out.
    pub elapsed: S,
    error: S,
    /// The next step, signed.
    pub h: S,
    /// The end, as elapsed time.
    pub end: S,
}

/// The largest of the lanes, in every lane; each lane its own if they are separate trajectories.
pub trait Reduce<S> {
    /// Reduces.
    fn largest(&self, value: S) -> S;
}

/// An embedded method at work on one state (of one or of eight trajectories).
pub struct Adaptive<S: Element> {
    stages: Stages<S>,
    error: Vec<Term<S>>,
    second_error: Option<Vec<Term<S>>>,
    dense_rows: Vec<Vec<Term<S>>>,
    dense: &'static [&'static [crate::numerics::double_double::DoubleDouble]],
    /// Room for the weights of the continuous extension at one fraction of the step.
    dense_weights: Vec<Term<S>>,
    error_exponent: u32,
    next: State<S>,
    /// What distances are measured from, at the present time: three components of `q`, three of `v`.
    reference_now: [S; 6],
    tolerance: Tolerance<S>,
    reference: Reference<S>,
    max_step: S,
    /// Lanes whose last step was rejected.
    rejected: S::Mask,
}

/// What a step did, lane by lane.
pub struct Outcome<S: Element> {
    /// The state moved.
    pub accepted: S::Mask,
    /// The end is reached.
    pub finished: S::Mask,
    /// The step fell to zero.
    pub stuck: S::Mask,
    /// Elapsed time before the step, and its length.
    pub from: S,
    /// Its length.
    pub h: S,
}

impl<S: Element> Adaptive<S> {
    /// For states like `state`.
    pub fn new(
        method: &Embedded,
        state: &State<S>,
        tolerance: Tolerance<S>,
        reference: Reference<S>,
        max_step: f64,
    ) -> Self {
        let own = method.tableau.b.len();
        Self {
            stages: Stages::new(&method.tableau, 1 + method.dense_a.len(), 2 * state.shape.len()),
            error: terms(method.error),
            second_error: method.second_error.map(terms),
            dense_rows: method.dense_a.iter().map(|row| terms(row)).collect(),
            dense: method.dense,
            dense_weights: (0..method.dense.len()).map(|stage| Term { stage, weight: S::zero() }).collect(),
            error_exponent: method.error_exponent,
            next: state.clone(),
            reference_now: [S::zero(); 6],
            tolerance,
            reference,
            max_step: S::splat(max_step),
            rejected: S::Mask::splat(false),
        }
        .checked(own)
    }

    fn checked(self, own: usize) -> Self {
        debug_assert_eq!(self.dense.len(), own + 1 + self.dense_rows.len());
        self
    }

    /// The stage that holds the derivative at the end of the step.
    fn end_stage(&self) -> usize {
        self.dense.len() - self.dense_rows.len() - 1
    }

    fn locate_reference(&mut self, elapsed: S) {
        for c in 0..3 {
            self.reference_now[c] = self.reference.position[c] + self.reference.velocity[c] * elapsed;
            self.reference_now[3 + c] = self.reference.velocity[c];
        }
    }

    /// The larger squared scaled size of the two halves of `h Σ weight·k`, for two sets of weights.
    fn scaled_sizes(&self, y: &[S], h: S, terms: [&[Term<S>]; 2], reduce: &impl Reduce<S>) -> [S; 2] {
        let shape: Shape = self.next.shape;
        let n = shape.len();
        let (k, stride) = (&self.stages.k, self.stages.len());
        let sizes = |half: usize, atol: S| {
            S::largest_errors(
                shape,
                &y[half * n..],
                &self.reference_now[3 * half..],
                (atol, self.tolerance.rtol),
                h,
                terms,
                &k[half * n..],
                stride,
            )
        };
        let [of_q, of_v] = [sizes(0, self.tolerance.atol_q), sizes(1, self.tolerance.atol_v)];
        [reduce.largest(of_q[0].max(of_v[0])), reduce.largest(of_q[1].max(of_v[1]))]
    }

    /// Changes what errors are measured against, when lanes take up other trajectories.
    pub fn set_measure(&mut self, tolerance: Tolerance<S>, reference: Reference<S>) {
        self.tolerance = tolerance;
        self.reference = reference;
    }

    /// Starts the lanes of `fresh`: evaluates their first derivative and chooses their first step
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
        self.stages.evaluate(end_stage, state.all().0, dynamics, ticker)?;
        let len = self.stages.len();
        let (before, after) = self.stages.k.split_at_mut(end_stage * len);
        S::replace(&mut before[..len], &after[..len], fresh);
        self.rejected = self.rejected.and(fresh.not());
        self.locate_reference(clock.elapsed);

        let first = [Term { stage: 0, weight: S::one() }];
        let y = state.all().0;
        // With a zero derivative any step will do; the span is then the step.
        let slope2 = self.scaled_sizes(y, S::one(), [&first, &[]], reduce)[0];
        let span = (clock.end - clock.elapsed).abs();
        let longest = span.min(self.max_step);
        let still = slope2.less_equal(S::zero());
        // The time in which the state changes by its own size; a hundredth of it for the trial step.
        let time = S::select(still, longest, S::one() / (self.tolerance.rtol * slope2.sqrt()));
        let trial = (S::splat(0.01) * time).min(longest);
        let direction = S::select(clock.end.less(clock.elapsed), -S::one(), S::one());
        self.stages.evaluate_at(end_stage, state, trial * direction, &first, dynamics, ticker)?;
        let change = [Term { stage: end_stage, weight: S::one() }, Term { stage: 0, weight: -S::one() }];
        let curvature2 = self.scaled_sizes(y, time / trial, [&change, &[]], reduce)[0];
        // Both sizes in units of that time, so that the choice does not depend on the unit of time.
        let largest = (slope2 * time * time).max(curvature2 * time * time);
        let by_order = time * self.root(S::splat(1e-4) / largest);
        let by_order = S::select(largest.less_equal(S::zero()), longest, by_order);
        let h = by_order.min(time).min(longest);
        clock.h = S::select(fresh, h * direction, clock.h);
        Ok(())
    }

    /// `square^(1 / (2·error_exponent))`, the exponent being a power of two.
    fn root(&self, square: S) -> S {
        square.repeated_sqrt((2 * self.error_exponent).ilog2())
    }

    /// Tries one step in every lane.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn step(
        &mut self,
        running: S::Mask,
        state: &mut State<S>,
        clock: &mut Clock<S>,
        dynamics: &mut Dynamics<S>,
        reduce: &impl Reduce<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Outcome<S>> {
        let remaining = (clock.end - clock.elapsed) - clock.error;
        // A last step a little longer than planned beats a last step of nothing.
        let last = remaining.abs().less_equal(clock.h.abs() * S::splat(1.0 + 1e-9));
        let h = S::select(running, S::select(last, remaining, clock.h), S::zero());
        self.stages.evaluate_rest(state, h, dynamics, ticker)?;
        let stages = &self.stages;
        S::combine_compensated(self.next.all_mut(), state.all(), h, &stages.weights, &stages.k);
        self.locate_reference(clock.elapsed);
        let size2 = self.error_size(state, h, reduce);
        let accepted = size2.less_equal(S::one()).and(running);

        let factor = S::splat(SAFETY) / self.root(size2);
        let factor = factor.max(S::splat(SHRINK)).min(S::splat(GROW));
        let factor = S::select(size2.less_equal(S::zero()), S::splat(GROW), factor);
        let factor = S::select(self.rejected.or(accepted.not()), factor.min(S::one()), factor);
        let from = clock.elapsed;
        let proposed = h * factor;
        let proposed =
            S::select(self.max_step.less(proposed.abs()), clamp(proposed, self.max_step), proposed);
        clock.h = S::select(running, proposed, clock.h);
        self.rejected = S::Mask::and(accepted.not(), running);

        let (elapsed, error) = two_sum(clock.elapsed, clock.error + h);
        clock.elapsed = S::select(accepted, S::select(last, clock.end, elapsed), clock.elapsed);
        clock.error = S::select(accepted, S::select(last, S::zero(), error), clock.error);
        let finished = accepted.and(last);
        let smallest = (S::splat(SMALLEST_STEP) * clock.elapsed.abs()).max(S::splat(f64::MIN_POSITIVE));
        let stuck = clock.h.abs().less_equal(smallest).and(running).and(finished.not());
        if accepted.any() {
            let end_stage = self.end_stage();
            self.stages.evaluate(end_stage, self.next.all().0, dynamics, ticker)?;
        }
        Ok(Outcome { accepted, finished, stuck, from, h })
    }

    /// The squared scaled error of the step.
    fn error_size(&self, state: &State<S>, h: S, reduce: &impl Reduce<S>) -> S {
        let y = state.all().0;
        let Some(second) = &self.second_error else {
            return self.scaled_sizes(y, h, [&self.error, &[]], reduce)[0];
        };
        let [main, second] = self.scaled_sizes(y, h, [&self.error, second], reduce);
        // (E² / sqrt(E² + 0.01 E3²))², with E² and E3² at hand.
        let denominator = main + S::splat(0.01) * second;
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
        let rows = core::mem::take(&mut self.dense_rows);
        let first = self.dense.len() - rows.len();
        let outcome = rows.iter().enumerate().try_for_each(|(index, row)| {
            self.stages.evaluate_at(first + index, state, h, row, dynamics, ticker)
        });
        self.dense_rows = rows;
        outcome
    }

    /// The state at the fraction `theta` of the step, lane by lane; needs [`prepare_dense`](Self::prepare_dense).
    pub fn interpolate(&mut self, state: &State<S>, h: S, theta: S, into: &mut State<S>) {
        let rest = S::one() - theta;
        for (term, row) in self.dense_weights.iter_mut().zip(self.dense) {
            term.weight = S::zero();
            for (index, &coefficient) in row.iter().enumerate().rev() {
                let factor = if index % 2 == 0 { theta } else { rest };
                term.weight = factor * (S::from_double_double(coefficient) + term.weight);
            }
        }
        S::combine_compensated(into.all_mut(), state.all(), h, &self.dense_weights, &self.stages.k);
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
        let (len, end_stage) = (self.stages.len(), self.end_stage());
        let (before, after) = self.stages.k.split_at_mut(end_stage * len);
        S::replace(&mut before[..len], &after[..len], accepted);
    }
}

/// `value` with the magnitude `limit`.
fn clamp<S: Real>(value: S, limit: S) -> S {
    S::select(value.less(S::zero()), -limit, limit)
}

impl<S: Real> Clock<S> {
    /// At the start of a run that ends at `end`.
    pub fn new(end: S) -> Self {
        Self { elapsed: S::zero(), error: S::zero(), h: S::zero(), end }
    }
    /// As `fresh` in the lanes of the mask.
    pub fn restart(&mut self, lanes: S::Mask, end: S) {
        let fresh = Self::new(end);
        self.elapsed = S::select(lanes, fresh.elapsed, self.elapsed);
        self.error = S::select(lanes, fresh.error, self.error);
        self.h = S::select(lanes, fresh.h, self.h);
        self.end = S::select(lanes, fresh.end, self.end);
    }
}
