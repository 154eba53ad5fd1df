//! The stages of an explicit Runge–Kutta method, and its steps of fixed length.
//!
//! Of a system of the second order only accelerations are stages ([`nystrom`](super::nystrom)); of one of the first
//! order the rates are, and the rows of the tableau weigh them as they stand.

use super::Tableau;
use super::nystrom::Row;
use super::passes::rates::{FEW, RateErrors, RateStep, fresh};
use super::passes::stages::{CompensatedPositions, CompensatedRates, Point, Rates, Weighted};
use super::passes::updates::replace;
use super::state::State;
use super::stepper::{Nodes, Stepper, per_call};
use super::system::{Form, Needs, System};
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::Element;
use crate::numerics::real::Mask;
use crate::parallel::Ticker;

/// The stages of a method and room for their derivatives: accelerations, or rates of a system of the first order.
#[derive(Clone, Debug)]
pub struct Stages<S> {
    form: Form,
    needs: Needs,
    rows: Vec<Row<S>>,
    end: Row<S>,
    /// Derivatives, stage after stage.
    pub k: Vec<S>,
    /// Where a stage is evaluated: coordinates, or all numbers of a system of the first order.
    position: Vec<S>,
    velocity: Vec<S>,
}

impl<S: Element> Stages<S> {
    /// For a tableau with `extra` further stages, and a system.
    pub fn new(tableau: &Tableau, extra: usize, system: &dyn System<S>) -> Self {
        let form = system.form();
        let len = form.evaluated();
        let of_coordinates = coupling(form, tableau.a);
        let stages = tableau.a.iter().zip(tableau.c);
        Self {
            form,
            needs: system.needs(),
            rows: stages.map(|(row, &c)| Row::new(row, c, of_coordinates)).collect(),
            end: Row::end(tableau.b, of_coordinates),
            k: vec![S::zero(); (tableau.b.len() + extra) * len],
            position: vec![S::zero(); len],
            velocity: vec![S::zero(); len],
        }
    }
    /// The form of the system.
    pub fn form(&self) -> Form {
        self.form
    }
    /// Numbers per derivative.
    #[inline]
    pub fn len(&self) -> usize {
        self.position.len()
    }
    /// Whether a derivative has no numbers.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
    /// The derivative of stage `stage`.
    pub fn derivative(&self, stage: usize) -> &[S] {
        &self.k[stage * self.len()..][..self.len()]
    }

    /// Writes the derivative at a state as that of `stage`.
    ///
    /// # Errors
    /// Those of an evaluation.
    #[inline]
    pub fn evaluate(
        &mut self,
        stage: usize,
        t: &S,
        state: &State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let len = self.len();
        let k = &mut self.k[stage * len..][..len];
        match self.form {
            Form::FirstOrder(_) => system.rate(t, state.all().0, k, ticker),
            Form::SecondOrder(_) => system.acceleration(t, state.q(), state.v(), k, ticker),
        }
    }

    /// Writes the derivative of stage `stage`, at the point that the row leads to in a step `h` from `t`.
    ///
    /// # Errors
    /// Those of an evaluation.
    pub fn evaluate_at(
        &mut self,
        stage: usize,
        (t, h): (&S, &S),
        state: &State<S>,
        row: &Row<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let len = self.len();
        let later;
        let t = if self.needs.time {
            later = *t + *h * row.fraction;
            &later
        } else {
            t
        };
        if matches!(self.form, Form::FirstOrder(_)) {
            let stages = Weighted { h, terms: &row.velocity, k: &self.k };
            S::pass(Rates { out: &mut self.position, y: state.all(), stages });
            return system.rate(t, &self.position, &mut self.k[stage * len..][..len], ticker);
        }
        let seen = self.needs.velocities();
        let (position, velocity) = (&mut self.position[..], seen.then_some(&mut self.velocity[..]));
        S::pass(Point { position, velocity, state, h, row, k: &self.k });
        let velocity = if seen { &self.velocity } else { state.v() };
        system.acceleration(t, &self.position, velocity, &mut self.k[stage * len..][..len], ticker)
    }

    /// All stages of the tableau from the second on, and the end of the step; the first must be there.
    ///
    /// # Errors
    /// Those of an evaluation.
    #[inline]
    pub fn step(
        &mut self,
        (t, h): (&S, &S),
        (state, next): (&State<S>, &mut State<S>),
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        if matches!(self.form, Form::FirstOrder(_)) {
            return S::pass(self.rate_pass((t, h), (state, next), None, system, ticker)).map(drop);
        }
        let rows = core::mem::take(&mut self.rows);
        let outcome = rows
            .iter()
            .enumerate()
            .skip(1)
            .try_for_each(|(stage, row)| self.evaluate_at(stage, (t, h), state, row, system, ticker));
        self.rows = rows;
        outcome?;
        self.state_at(&self.end, state, h, next);
        Ok(())
    }

    /// [`step`](Self::step) of a system of the first order, which gives the squared scaled errors if it is said how.
    #[inline(always)]
    pub fn rate_pass<'a, 'b>(
        &'a mut self,
        (t, h): (&S, &'a S),
        (state, next): (&'a State<S>, &'a mut State<S>),
        errors: Option<RateErrors<'a, S>>,
        system: &'a mut dyn System<S>,
        ticker: &'a mut Ticker<'b>,
    ) -> RateStep<'a, 'b, S> {
        RateStep {
            rows: (&self.rows, &self.end),
            time: (*t, self.needs.time),
            h,
            y: state.all(),
            k: &mut self.k,
            position: &mut self.position,
            next: next.all_mut(),
            errors,
            system,
            ticker,
        }
    }

    /// Takes the derivative at the end of the step for that at its start.
    pub fn begin_with_end(&mut self, lanes: S::Mask, end_stage: usize) {
        let len = self.len();
        let (before, after) = self.k.split_at_mut(end_stage * len);
        let (first, end) = (&mut before[..len], &after[..len]);
        if lanes.all() && size_of::<S>() == size_of::<f64>() && len <= FEW {
            // The next step waits for them, and they were just written.
            for i in 0..len {
                first[i] = fresh(&end[i]);
            }
        } else {
            replace(first, end, lanes);
        }
    }

    /// Writes the state that the row leads to, compensated.
    pub fn state_at(&self, row: &Row<S>, state: &State<S>, h: &S, into: &mut State<S>) {
        let stages = |terms| Weighted { h, terms, k: &self.k };
        if matches!(self.form, Form::FirstOrder(_)) {
            S::pass(CompensatedRates { out: into.all_mut(), y: state.all(), stages: stages(&row.velocity) });
            return;
        }
        let (q, v) = into.halves_mut();
        let slope = (state.v(), &row.fraction);
        S::pass(CompensatedPositions { out: q, q: state.position(), slope, stages: stages(&row.position) });
        S::pass(CompensatedRates { out: v, y: state.velocity(), stages: stages(&row.velocity) });
    }
}

/// The rows that Nyström weights are made of: a system of the first order has none, and no time is spent on them.
pub(super) fn coupling<'a>(form: Form, a: &'a [&'a [DoubleDouble]]) -> &'a [&'a [DoubleDouble]] {
    match form {
        Form::FirstOrder(_) => &[],
        Form::SecondOrder(_) => a,
    }
}

/// A Runge–Kutta method with a fixed step.
#[derive(Clone, Debug)]
pub struct RungeKuttaStep<S> {
    stages: Stages<S>,
    next: State<S>,
    h: S,
    nodes: Nodes,
}

impl<S: Element> RungeKuttaStep<S> {
    /// The method `tableau` with step `h`, for a system and states like `state`.
    pub fn new(tableau: &Tableau, h: f64, system: &dyn System<S>, state: &State<S>) -> Self {
        let stages = Stages::new(tableau, 0, system);
        Self { stages, next: state.clone(), h: S::splat(h), nodes: Nodes::new(h, system) }
    }

    /// The derivative at the state before the last step.
    pub fn first_derivative(&self) -> &[S] {
        self.stages.derivative(0)
    }

    /// Advances the state at `node` by a step `h`, or by its own.
    fn advance(
        &mut self,
        (node, h): (u64, Option<&S>),
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { stages, next, h: own, nodes } = self;
        let (t, h) = (nodes.time(node), h.unwrap_or(own));
        stages.evaluate(0, &t, state, system, ticker)?;
        stages.step((&t, h), (state, next), system, ticker)?;
        core::mem::swap(state, next);
        Ok(())
    }
}

impl<S: Element> Stepper<S> for RungeKuttaStep<S> {
    fn restart(&mut self) {}

    fn step(
        &mut self,
        node: u64,
        at_most: u64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<u64> {
        let steps = per_call(self.stages.len(), at_most);
        for step in 0..steps {
            self.advance((node + step, None), state, system, ticker)?;
        }
        Ok(steps)
    }

    fn between(
        &mut self,
        node: u64,
        past: f64,
        state: &mut State<S>,
        system: &mut dyn System<S>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.advance((node, Some(&S::splat(past))), state, system, ticker)
    }
}
