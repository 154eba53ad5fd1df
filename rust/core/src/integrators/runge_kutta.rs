//! The stages of an explicit Runge–Kutta method on the equations of motion `q'' = a(q, v)`.

use super::Tableau;
use super::nystrom::Row;
use super::state::State;
use crate::error::Result;
use crate::forces::Dynamics;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Weighted};
use crate::parallel::Ticker;

/// The stages of a method and room for their accelerations.
#[derive(Clone, Debug)]
pub struct Stages<S> {
    rows: Vec<Row<S>>,
    end: Row<S>,
    /// Accelerations, stage after stage.
    pub a: Vec<S>,
    /// Where a stage is evaluated.
    position: Vec<S>,
    velocity: Vec<S>,
}

impl<S: Element> Stages<S> {
    /// For a tableau with `extra` further stages, and `len` coordinates.
    pub fn new(tableau: &Tableau, extra: usize, len: usize) -> Self {
        let a: Vec<Vec<DoubleDouble>> = tableau.a.iter().map(|row| row.to_vec()).collect();
        Self {
            rows: a.iter().zip(tableau.c).map(|(row, &c)| Row::new(row, c, &a)).collect(),
            end: Row::end(tableau.b, &a),
            a: vec![S::zero(); (tableau.b.len() + extra) * len],
            position: vec![S::zero(); len],
            velocity: vec![S::zero(); len],
        }
    }
    /// Numbers per acceleration.
    pub fn len(&self) -> usize {
        self.position.len()
    }
    /// Whether an acceleration has no numbers.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
    /// The acceleration of stage `stage`.
    pub fn acceleration(&self, stage: usize) -> &[S] {
        &self.a[stage * self.len()..][..self.len()]
    }

    /// Writes the acceleration at a state as that of `stage`.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn evaluate(
        &mut self,
        stage: usize,
        state: &State<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let len = self.len();
        dynamics.acceleration(state.q(), state.v(), &mut self.a[stage * len..][..len], ticker)
    }

    /// Writes the acceleration of stage `stage`, at the point that the row leads to.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn evaluate_at(
        &mut self,
        stage: usize,
        state: &State<S>,
        h: &S,
        row: &Row<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let len = self.len();
        let stages = |terms| Weighted { h, terms, a: &self.a };
        let slope = (state.v(), &row.fraction);
        S::combine(&mut self.position, state.position(), slope, stages(&row.position));
        let velocity = if dynamics.needs_velocity() {
            S::combine_velocity(&mut self.velocity, state.velocity(), stages(&row.velocity));
            &self.velocity
        } else {
            state.v()
        };
        dynamics.acceleration(&self.position, velocity, &mut self.a[stage * len..][..len], ticker)
    }

    /// All stages of the tableau from the second on; the first must be there.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn evaluate_rest(
        &mut self,
        state: &State<S>,
        h: &S,
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

    /// Writes the end of the step, all stages of the tableau being there.
    pub fn finish(&self, state: &State<S>, h: &S, next: &mut State<S>) {
        self.state_at(&self.end, state, h, next);
    }

    /// Writes the state that the row leads to, compensated.
    pub fn state_at(&self, row: &Row<S>, state: &State<S>, h: &S, into: &mut State<S>) {
        let (q, v) = into.halves_mut();
        let stages = |terms| Weighted { h, terms, a: &self.a };
        let slope = (state.v(), &row.fraction);
        S::combine_compensated(q, state.position(), slope, stages(&row.position));
        S::combine_velocity_compensated(v, state.velocity(), stages(&row.velocity));
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
        Self { stages: Stages::new(tableau, 0, state.shape.len()), next: state.clone(), h }
    }

    /// The acceleration at the state before the last step.
    pub fn first_acceleration(&self) -> &[S] {
        self.stages.acceleration(0)
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
        self.step_by(self.h, state, dynamics, ticker)
    }

    /// Advances the state by a step `h`.
    ///
    /// # Errors
    /// As [`Dynamics::acceleration`].
    pub fn step_by(
        &mut self,
        h: S,
        state: &mut State<S>,
        dynamics: &mut Dynamics<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.stages.evaluate(0, state, dynamics, ticker)?;
        self.stages.evaluate_rest(state, &h, dynamics, ticker)?;
        self.stages.finish(state, &h, &mut self.next);
        core::mem::swap(state, &mut self.next);
        Ok(())
    }
}
