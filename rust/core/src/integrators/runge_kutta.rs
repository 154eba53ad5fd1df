//! The stages of an explicit Runge–Kutta method on `y = (q, v)`, `y' = (v, a)`.

use super::Tableau;
use super::state::State;
use crate::error::Result;
use crate::forces::Dynamics;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Term};
use crate::parallel::Ticker;

/// The terms of a row of coefficients that are not zero.
pub fn terms<S: Element>(row: &[DoubleDouble]) -> Vec<Term<S>> {
    row.iter()
        .enumerate()
        .filter(|(_, weight)| weight.to_f64() != 0.0)
        .map(|(stage, &weight)| Term { stage, weight: S::from_double_double(weight) })
        .collect()
}

/// The weights of a method, their sum as close to 1 as the scalar allows.
///
/// Every weight rounded by itself would leave a sum of, for RK4, `1 - 2^-54`: each step would fall short
/// by that share, and a long run would lag behind in proportion to time. The smallest weight, being the
/// finest, takes up what the rounding of all of them leaves out.
fn weights<S: Element>(row: &[DoubleDouble]) -> Vec<Term<S>> {
    let mut terms = terms(row);
    let rest = row.iter().fold(S::zero(), |rest, &weight| rest + S::one().scaled_by(weight).1);
    let size = |term: &Term<S>| row[term.stage].to_f64().abs();
    if let Some(smallest) = terms.iter_mut().min_by(|a, b| size(a).total_cmp(&size(b))) {
        smallest.weight += rest;
    }
    terms
}

/// The stages of a method and room for their derivatives.
#[derive(Clone, Debug)]
pub struct Stages<S> {
    rows: Vec<Vec<Term<S>>>,
    /// The weights.
    pub weights: Vec<Term<S>>,
    /// Derivatives, stage after stage.
    pub k: Vec<S>,
    /// Where a stage is evaluated.
    point: Vec<S>,
    len: usize,
}

impl<S: Element> Stages<S> {
    /// For a tableau with `extra` further derivatives, and states of `len` numbers (`q` and `v`).
    pub fn new(tableau: &Tableau, extra: usize, len: usize) -> Self {
        Self {
            rows: tableau.a.iter().map(|row| terms(row)).collect(),
            weights: weights(tableau.b),
            k: vec![S::zero(); (tableau.b.len() + extra) * len],
            point: vec![S::zero(); len],
            len,
        }
    }
    /// Numbers per derivative.
    pub fn len(&self) -> usize {
        self.len
    }
    /// Whether a derivative has no numbers.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
    /// The derivative of stage `stage`.
    pub fn derivative(&mut self, stage: usize) -> &mut [S] {
        &mut self.k[stage * self.len..(stage + 1) * self.len]
    }

    /// Writes the derivative at `y` as that of `stage`.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn evaluate(
        &mut self,
        stage: usize,
        y: &[S],
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let (q, v) = y.split_at(self.len / 2);
        let (dq, dv) = self.derivative(stage).split_at_mut(v.len());
        dq.copy_from_slice(v);
        dynamics.acceleration(q, v, dv, ticker)
    }

    /// Writes the derivative of stage `stage`, at the point that the terms lead to.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn evaluate_at(
        &mut self,
        stage: usize,
        state: &State<S>,
        h: S,
        terms: &[Term<S>],
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let mut point = core::mem::take(&mut self.point);
        S::combine(&mut point, state.all(), h, terms, &self.k);
        let outcome = self.evaluate(stage, &point, dynamics, ticker);
        self.point = point;
        outcome
    }

    /// All stages of the tableau from the second on; the first must be there.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn evaluate_rest(
        &mut self,
        state: &State<S>,
        h: S,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let rows = core::mem::take(&mut self.rows);
        let outcome = rows
            .iter()
            .enumerate()
            .skip(1)
            .try_for_each(|(stage, row)| self.evaluate_at(stage, state, h, row, dynamics, ticker));
        self.rows = rows;
        outcome
    }
}

/// A Runge–Kutta method with a fixed step.
#[derive(Clone, Debug)]
pub struct RungeKuttaStep<S> {
    stages: Stages<S>,
    next: State<S>,
    h: S,
}

impl<S: Element> RungeKuttaStep<S> {
    /// The method `tableau` with step `h`, for states like `state`.
    pub fn new(tableau: &Tableau, h: S, state: &State<S>) -> Self {
        Self { stages: Stages::new(tableau, 0, 2 * state.shape.len()), next: state.clone(), h }
    }

    /// Becomes the method with step `h`.
    pub fn set_step(&mut self, h: S) {
        self.h = h;
    }

    /// Advances the state by one step.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn step(
        &mut self,
        state: &mut State<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.stages.evaluate(0, state.all().0, dynamics, ticker)?;
        self.stages.evaluate_rest(state, self.h, dynamics, ticker)?;
        let stages = &self.stages;
        S::combine_compensated(self.next.all_mut(), state.all(), self.h, &stages.weights, &stages.k);
        core::mem::swap(state, &mut self.next);
        Ok(())
    }
}
