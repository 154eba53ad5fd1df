//! States put back on their constraints: the nearest ones, in the metric of the masses.
//!
//! The one idea: the correction solves the system that accelerations do, with the residual in the place of the forces. Places
//! first, by Newton's method; then velocities, of which constraints are linear.

use super::constraints::border;
use super::dependence::{Dependence, dependence};
use super::model::Model;
use crate::error::{Error, Result};
use crate::expressions::assembler::compile;
use crate::expressions::program::{LinearSystem, Output};
use crate::expressions::{Code, Graph, Id, Machine};
use crate::ode::norm::Norm;
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Settled};
use crate::ode::system::System;
use crate::ode::trial::{Cost, Trial};
use crate::parallel::Ticker;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Newton's steps after a step of a run: from errors of 1e-9 two would do.
const AFTER_A_STEP: u32 = 4;
/// Newton's steps at the start, from anywhere.
const AT_THE_START: u32 = 60;
/// The part of the largest speed so far that velocities may be put right by after a step of a tolerance, at least, and of a step
/// whose length is given: more than a step errs.
const LEAST_SHARE: f64 = 1e-6;
const SHARE_OF_GIVEN_STEPS: f64 = 0.3;
/// Errors of a step of a tolerance are below so many of it, also of methods that let it go 30 times astray.
const TOLERANCES: f64 = 1000.0;
/// What ends a run where constraints lose their hold.
const SINGULAR: &str = "the constraints depend on each other here (a singular configuration, as the change point of a \
    mechanism): they no longer tell which way the motion goes on. End the run before it, or take coordinates in which the \
    motion there is regular";

/// The codes of corrections and residuals.
#[derive(Clone, Debug)]
pub struct Projection {
    coordinates: usize,
    holonomic: usize,
    constraints: usize,
    /// Corrections of places; residuals of the holonomic constraints.
    places: Arc<Code>,
    /// Corrections of velocities; residuals of the rates of all.
    velocities: Arc<Code>,
    /// What velocities are multiplied with in the rates, constraint after constraint.
    rows: Arc<Code>,
    /// The mass matrix, row by row.
    mass: Arc<Code>,
}

impl Projection {
    /// Of a model with constraints; without any there is none.
    ///
    /// # Errors
    /// Expressions that are too large.
    pub fn new(model: &mut Model) -> Result<Option<Self>> {
        let n = model.source.coordinates;
        let (q, v) = model.source.halves();
        let source = &mut model.source;
        let (holonomic, nonholonomic) = (source.holonomic.clone(), source.nonholonomic.clone());
        let constraints = holonomic.len() + nonholonomic.len();
        if constraints == 0 {
            return Ok(None);
        }
        let graph = &mut source.graph;
        let mut rows: Vec<Vec<Id>> = holonomic.iter().map(|&g| graph.gradient(g, &q)).collect();
        let (one, time) = (graph.constant(1.0), graph.time());
        let mut motion: FxHashMap<Id, Id> = q.iter().copied().zip(v.iter().copied()).collect();
        let _ = motion.insert(time, one);
        let mut rates = graph.tangent(&holonomic, &motion);
        rates.extend(&nonholonomic);
        let zero = graph.constant(0.0);
        let inputs = (2 * n, source.parameters);
        let code = |graph: &mut Graph, rows: &[Vec<Id>], residuals: &[Id]| {
            let mut right = vec![zero; n];
            right.extend(residuals);
            let system: LinearSystem = border(graph, &model.mass, rows, right);
            let mut outputs: Vec<Output> = (0..n).map(|index| Output::Unknown(index as u32)).collect();
            outputs.extend(residuals.iter().copied().map(Output::Node));
            compile(graph, inputs, &[system], &outputs).map(Arc::new)
        };
        let places = code(graph, &rows, &holonomic)?;
        rows.extend(nonholonomic.iter().map(|&constraint| graph.gradient(constraint, &v)));
        let velocities = code(graph, &rows, &rates)?;
        let entries: Vec<Output> = rows.iter().flatten().copied().map(Output::Node).collect();
        let rows = Arc::new(compile(graph, inputs, &[], &entries)?);
        let entries: Vec<Output> = model.mass.iter().flatten().copied().map(Output::Node).collect();
        let mass = Arc::new(compile(graph, inputs, &[], &entries)?);
        let holonomic = holonomic.len();
        Ok(Some(Self { coordinates: n, holonomic, constraints, places, velocities, rows, mass }))
    }

    /// Ready to work, with these parameters.
    pub fn at_work(&self, parameters: &[f64]) -> Projector {
        Projector {
            of: self.clone(),
            places: Machine::new(self.places.clone(), parameters),
            velocities: Machine::new(self.velocities.clone(), parameters),
            rows: Machine::new(self.rows.clone(), parameters),
            mass: Machine::new(self.mass.clone(), parameters),
            share: SHARE_OF_GIVEN_STEPS,
            largest: 0.0,
            now: 0.0,
        }
    }
}

/// A projection with its registers.
#[derive(Clone, Debug)]
pub struct Projector {
    of: Projection,
    places: Machine<f64>,
    velocities: Machine<f64>,
    rows: Machine<f64>,
    mass: Machine<f64>,
    /// The part of the speed that a step may be put right by.
    share: f64,
    /// The largest square of the speed so far, measured by the masses, and that of the state that was projected last.
    largest: f64,
    now: f64,
}

impl Projector {
    /// Of a run whose steps are chosen for a tolerance.
    pub fn for_tolerance(mut self, rtol: f64) -> Self {
        let own = TOLERANCES * rtol;
        let most = if own < SHARE_OF_GIVEN_STEPS { own } else { SHARE_OF_GIVEN_STEPS };
        self.share = if most > LEAST_SHARE { most } else { LEAST_SHARE };
        self
    }

    /// Whether these changes of the velocities are more than a step errs by, in the metric of the masses: where constraints are
    /// about to lose their rank, the nearest velocities on them are any, and energy is lost.
    fn loses_hold(&mut self, t: f64, y: &[f64], changes: &[f64]) -> bool {
        let n = self.of.coordinates;
        self.mass.state().copy_from_slice(y);
        self.mass.run(t);
        let square = |x: &[f64]| {
            let row = |i: usize| (0..n).map(|j| self.mass.output(i * n + j) * x[j]).sum::<f64>();
            (0..n).map(|i| x[i] * row(i)).sum::<f64>().abs()
        };
        let (now, changed) = (square(&y[n..]), square(changes));
        self.now = now;
        let most = if now > self.largest { now } else { self.largest };
        changed > self.share * self.share * most
    }

    /// The state that was projected last is one of the run: readings between nodes are not.
    fn remember(&mut self) {
        self.largest = if self.now > self.largest { self.now } else { self.largest };
    }

    /// Which constraint follows from others at a state, and whether it agrees with them; `None` where all are independent.
    pub fn dependence(&mut self, t: f64, y: &[f64]) -> Option<Dependence> {
        let mut rows = vec![0.0; self.of.coordinates * self.of.constraints];
        self.rows.evaluate(t, y, &mut rows);
        let (places, rates) = self.residuals(t, y);
        dependence(&rows, y, &places, &rates)
    }

    /// The residuals at a state: of the holonomic constraints, and of the rates of all.
    pub fn residuals(&mut self, t: f64, y: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let n = self.of.coordinates;
        let of = |machine: &mut Machine<f64>, count: usize| {
            machine.state().copy_from_slice(y);
            machine.run(t);
            (0..count).map(|index| machine.output(n + index)).collect()
        };
        (of(&mut self.places, self.of.holonomic), of(&mut self.velocities, self.of.constraints))
    }

    /// Puts a state on the constraints.
    ///
    /// # Errors
    /// [`Error::Convergence`] where the constraints depend on each other, are about to, or cannot be met.
    pub fn project(&mut self, t: f64, y: &mut [f64], rest: &mut [f64], start: bool) -> Result<()> {
        let n = self.of.coordinates;
        let most = if start { AT_THE_START } else { AFTER_A_STEP };
        let before = y[n..].to_vec();
        // Without constraints of places the masses alone would be asked, which may be singular where with all constraints the motion
        // is not.
        let of_places = if self.of.holonomic == 0 { 0 } else { most };
        for (machine, from, repeated) in
            [(&mut self.places, 0, of_places), (&mut self.velocities, n, if start { 3 } else { 1 })]
        {
            let mut last = f64::INFINITY;
            for _ in 0..repeated {
                machine.state().copy_from_slice(y);
                machine.run(t);
                let mut largest = 0.0;
                for i in 0..n {
                    let correction = machine.output(i);
                    if !correction.is_finite() {
                        let message =
                            "the constraints depend on each other here, or cannot be met".to_owned();
                        return Err(Error::Convergence { message, time: t });
                    }
                    let size = correction.abs();
                    largest = if size > largest { size } else { largest };
                    let change = rest[from + i] + correction;
                    let sum = y[from + i] + change;
                    rest[from + i] = change - (sum - y[from + i]);
                    y[from + i] = sum;
                }
                if largest == 0.0 || largest >= 0.5 * last {
                    break;
                }
                last = largest;
            }
        }
        if !start {
            let changes: Vec<f64> = y[n..].iter().zip(before).map(|(y, before)| y - before).collect();
            if self.loses_hold(t, y, &changes) {
                return Err(Error::Convergence { message: SINGULAR.to_owned(), time: t });
            }
        }
        Ok(())
    }
}

/// Trials whose steps end on the constraints.
pub(super) struct Projected<T> {
    pub(super) inner: T,
    projector: Projector,
    next: State<f64>,
    t0: f64,
}

impl<T: Trial<f64>> Projected<T> {
    pub(super) fn new(inner: T, projector: Projector, state: &State<f64>, t0: f64) -> Self {
        Self { inner, projector, next: state.clone(), t0 }
    }
}

impl<T: Trial<f64>> Trial<f64> for Projected<T> {
    fn start(
        &mut self,
        fresh: bool,
        system: &mut dyn System<f64>,
        state: &State<f64>,
        clock: &mut Clock<f64>,
        norm: &Norm<f64>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.inner.start(fresh, system, state, clock, norm, ticker)
    }

    fn attempt(
        &mut self,
        running: bool,
        system: &mut dyn System<f64>,
        state: &State<f64>,
        clock: &mut Clock<f64>,
        norm: &Norm<f64>,
        ticker: &mut Ticker<'_>,
    ) -> Result<Settled<f64>> {
        let outcome = self.inner.attempt(running, system, state, clock, norm, ticker)?;
        if outcome.accepted {
            self.next.copy_from(self.inner.next());
            let (y, rest) = self.next.all_mut();
            self.projector.project(self.t0 + clock.elapsed, y, rest, false)?;
            self.projector.remember();
        }
        Ok(outcome)
    }

    fn next(&self) -> &State<f64> {
        &self.next
    }

    fn dense(
        &mut self,
        outcome: &Settled<f64>,
        system: &mut dyn System<f64>,
        state: &State<f64>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.inner.dense(outcome, system, state, ticker)
    }

    fn at(
        &mut self,
        outcome: &Settled<f64>,
        system: &mut dyn System<f64>,
        state: &State<f64>,
        theta: f64,
        into: &mut State<f64>,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.inner.at(outcome, system, state, theta, into, ticker)?;
        let (y, rest) = into.all_mut();
        self.projector.project(self.t0 + outcome.from + theta * outcome.h, y, rest, false)
    }

    fn keep(&mut self, accepted: bool, state: &mut State<f64>) {
        self.inner.keep(accepted, state);
        if accepted {
            state.copy_from(&self.next);
        }
    }

    fn cost(&self) -> Cost {
        self.inner.cost()
    }
}
