//! Gauss's methods as trials: how long a step may be, when it is held, and states between nodes.
//!
//! The one idea: δ, how far the polynomial of a step leads astray in the next one, goes with the ninth power of the step (of
//! order 16) while the error goes with the seventeenth, so a δ far above the tolerance means a step as good as exact. Where
//! energy is conserved, the step that the first few agree on is held, since equal steps are what keeps energies; it is given
//! up where δ leaves a wide band. States between nodes are those of shadow steps, as good as those at nodes.

use super::step::{Iterated, Stages, Work, advance, iterate, largest, led};
use super::{Method, Table};
use crate::error::{Error, Result};
use crate::expressions::Machine;
use crate::numerics::elementary::{self, Exponential};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::norm::Norm;
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Controlled, Rule, Settled};
use crate::ode::system::{Form, System};
use crate::ode::trial::{Cost, Trial};
use crate::parallel::Ticker;

/// A step is taken again when δ is this many times what it should be.
const BAND: f64 = 30.0;
/// Steps change where they would change by more than from here …
const SHORTER: f64 = 0.85;
/// … to here.
const LONGER: f64 = 1.2;
/// Steps after which one is held, where energy is conserved.
const STEPS_BEFORE_HOLDING: u64 = 10;
/// The first step, as a fraction of the time in which numbers change by as much as they are.
const FIRST: f64 = 0.05;

/// How steps are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// All alike.
    Equal(f64),
    /// So that δ is about this; held after the first ones, or not.
    Chosen {
        /// What δ is to be.
        delta: f64,
        /// Whether a step is held.
        held: bool,
    },
}

/// A collocation method at work on one trajectory.
pub struct GaussStep {
    table: &'static Table,
    form: Form,
    machine: Machine<Lanes>,
    stages: Stages,
    /// Rates of the last kept step, and its length.
    before: Vec<Lanes>,
    length: f64,
    length_tried: f64,
    /// Those of a shadow step.
    shadow: Stages,
    next: State<f64>,
    steps: Steps,
    /// Where the system's time stands at the start.
    t0: f64,
    kept: u64,
    delta: f64,
    holding: bool,
    evaluations: u64,
    max_step: f64,
}

impl GaussStep {
    /// At work on states like `state`; `evaluate` gives the rates of the first order, the accelerations of the second.
    pub fn new(
        method: &'static Method,
        (machine, form): (Machine<Lanes>, Form),
        state: &State<f64>,
        (steps, max_step): (Steps, f64),
        t0: f64,
    ) -> Self {
        let evaluated = form.evaluated();
        Self {
            table: method.table,
            form,
            machine,
            stages: Stages::new(evaluated),
            before: vec![Lanes([0.0; WIDTH]); evaluated],
            length: 0.0,
            length_tried: 0.0,
            shadow: Stages::new(evaluated),
            next: state.clone(),
            steps,
            t0,
            kept: 0,
            delta: 0.0,
            holding: false,
            evaluations: 0,
            max_step,
        }
    }

    /// Evaluations of all stages so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Whether steps were held to the end.
    pub fn holding(&self) -> bool {
        self.holding
    }

    /// Stages that begin where the last step leads, or at its end.
    fn guess(&mut self, h: f64) {
        if self.kept == 0 {
            self.stages.guess.fill(Lanes([0.0; WIDTH]));
        } else if h == self.length {
            led(&self.table.ahead, &self.before, &mut self.stages.guess);
        } else {
            let ratio = h / self.length;
            let rows = self.table.at(&self.table.c.map(|c| 1.0 + c * ratio));
            led(&rows, &self.before, &mut self.stages.guess);
        }
        self.stages.rates.copy_from_slice(&self.stages.guess);
    }

    fn iterated(&mut self, t: f64, h: f64, state: &State<f64>) -> Iterated {
        let (table, form, machine, stages) = (self.table, self.form, &mut self.machine, &mut self.stages);
        let mut work = Work { table, form, machine, state, stages, t, h };
        let iterated = iterate(&mut work);
        if iterated.converged {
            advance(&work, &mut self.next);
        }
        self.evaluations += u64::from(iterated.evaluations);
        iterated
    }

    /// How far the polynomial of the step before leads astray; in the first step, how much its last term adds.
    fn smoothness(&self, h: f64) -> f64 {
        let mut most = 0.0;
        for (i, rates) in self.stages.rates.iter().enumerate() {
            let astray = if self.kept == 0 {
                // The leading term of the polynomial, at the farthest stage of a next step.
                let leading: f64 = (0..self.table.stages).map(|k| self.table.weights.0[k] * rates.0[k]).sum();
                let farthest = 1.0 + self.table.c.0[self.table.stages - 1];
                let product: f64 = (0..self.table.stages - 1).map(|k| farthest - self.table.c.0[k]).product();
                (leading * product).abs()
            } else {
                let guess = &self.stages.guess[i];
                largest(Lanes(core::array::from_fn(|k| {
                    if k < self.table.stages { (rates.0[k] - guess.0[k]).abs() } else { 0.0 }
                })))
            };
            let delta = astray * h.abs() * self.stages.scales[i];
            most = if delta > most { delta } else { most };
        }
        most
    }

    /// What the next step is multiplied with to bring δ to what it should be.
    fn factor(&self, target: f64) -> f64 {
        if self.delta <= 0.0 {
            return f64::INFINITY;
        }
        let order = (self.table.stages + 1) as f64;
        Exponential::exp(elementary::ln(target / self.delta) / order)
    }

    /// The next step after a kept one of length `h`.
    fn choose(&mut self, h: f64) -> f64 {
        let Steps::Chosen { delta: target, held } = self.steps else { return h };
        self.holding &= self.delta <= BAND * target;
        if self.holding {
            return h;
        }
        let factor = self.factor(target);
        let fast = if self.kept < 4 { 4.0 } else { 1.5 };
        let next = if (SHORTER..=LONGER).contains(&factor) {
            h
        } else {
            h * Real::min(Real::max(factor, 0.3), fast)
        };
        self.holding = held && self.kept == STEPS_BEFORE_HOLDING;
        if next.abs() > self.max_step { self.max_step.copysign(next) } else { next }
    }
}

impl Trial<f64> for GaussStep {
    fn start(
        &mut self,
        _: bool,
        _: &mut dyn System<f64>,
        state: &State<f64>,
        clock: &mut Clock<f64>,
        _: &Norm<f64>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        let span = clock.end - clock.elapsed;
        if let Steps::Equal(h) = self.steps {
            clock.h = h.copysign(span);
        } else if clock.h == 0.0 {
            // One evaluation, of all stages at the start.
            let (y, evaluated) = (state.all().0, self.form.evaluated());
            for (register, &y) in self.machine.state().iter_mut().zip(y) {
                *register = Lanes([y; WIDTH]);
            }
            self.machine.run(Lanes([self.t0 + clock.elapsed; WIDTH]));
            self.evaluations += 1;
            let mut least = f64::INFINITY;
            for i in 0..evaluated {
                let rate = self.machine.output(i).0[0].abs();
                let time = match self.form {
                    Form::FirstOrder(_) => y[i].abs() / rate,
                    // Of a motion from rest and of one under way.
                    Form::SecondOrder(_) => {
                        let (rest, way) = ((y[i].abs() / rate).sqrt(), y[evaluated + i].abs() / rate);
                        if rest > way { rest } else { way }
                    }
                };
                if time > 0.0 && time < least {
                    least = time;
                }
            }
            let first = Real::min(Real::min(FIRST * least, span.abs()), self.max_step);
            clock.h = (if first > 0.0 { first } else { Real::min(1e-3, span.abs()) }).copysign(span);
        }
        Ok(())
    }

    fn attempt(
        &mut self,
        running: bool,
        _: &mut dyn System<f64>,
        state: &State<f64>,
        clock: &mut Clock<f64>,
        _: &Norm<f64>,
        _: &mut Ticker<'_>,
    ) -> Result<Settled<f64>> {
        let h = f64::next_step(clock, running);
        let planned = clock.h;
        self.guess(h);
        let t = self.t0 + clock.elapsed;
        let iterated = self.iterated(t, h, state);
        self.delta = if iterated.converged { self.smoothness(h) } else { f64::INFINITY };
        let rule = Rule::new(1, f64::INFINITY);
        let refused = match self.steps {
            Steps::Equal(_) if !iterated.converged => {
                return Err(Error::Convergence {
                    message: format!("the stages of a step of {h:e} do not converge; take a smaller dt"),
                    time: t,
                });
            }
            Steps::Equal(_) => false,
            Steps::Chosen { delta, .. } => !iterated.converged || self.delta > BAND * delta,
        };
        let outcome = f64::settle(clock, running, if refused { 4.0 } else { 0.0 }, &rule);
        self.length_tried = h;
        clock.h = if !refused {
            // The last step may be short: what it tells of the next one is for nobody.
            if outcome.finished { planned } else { self.choose(h) }
        } else {
            self.holding = false;
            match self.steps {
                Steps::Chosen { delta, .. } if iterated.converged => h * Real::max(self.factor(delta), 0.2),
                _ => h * 0.4,
            }
        };
        Ok(outcome)
    }

    fn next(&self) -> &State<f64> {
        &self.next
    }

    fn at(
        &mut self,
        outcome: &Settled<f64>,
        _: &mut dyn System<f64>,
        state: &State<f64>,
        theta: f64,
        into: &mut State<f64>,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        let rows = self.table.at(&self.table.c.map(|c| c * theta));
        led(&rows, &self.stages.rates, &mut self.shadow.rates);
        let (table, form, machine, stages) = (self.table, self.form, &mut self.machine, &mut self.shadow);
        let (t, h) = (self.t0 + outcome.from, outcome.h * theta);
        let mut work = Work { table, form, machine, state, stages, t, h };
        let iterated = iterate(&mut work);
        advance(&work, into);
        self.evaluations += u64::from(iterated.evaluations);
        if iterated.converged {
            return Ok(());
        }
        Err(Error::Convergence { message: "the stages of a shadow step do not converge".to_owned(), time: t })
    }

    fn keep(&mut self, accepted: bool, state: &mut State<f64>) {
        if accepted {
            state.copy_from(&self.next);
            core::mem::swap(&mut self.before, &mut self.stages.rates);
            self.length = self.length_tried;
            self.kept += 1;
        }
    }

    fn cost(&self) -> Cost {
        // What stages take is told by their own count.
        Cost::default()
    }
}
