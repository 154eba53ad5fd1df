//! Gauss's methods as trials of one trajectory: stages begin where the last step leads, and states within a step are those of its
//! continuous [`extension`](super::extension), as good as those at nodes.
//!
//! The one idea: whatever is decided of a step, its [`Pace`] decides, which eight trajectories side by side
//! ([`eight`](super::eight)) have, too.

mod judged;

use super::extension::{self, ExtensionOfOne};
use super::noise::{self, found_beside_noise};
use super::pace::{Pace, Steps, first_step};
use super::rest;
use super::step::{Iterated, Stages, Work, advance, led, told};
use super::{Beyond, Method, Table};
use crate::error::{Error, Result};
use crate::expressions::Machine;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::ode::looks::Looks;
use crate::ode::norm::Norm;
use crate::ode::state::State;
use crate::ode::step_control::{Clock, Controlled, Rule, Settled};
use crate::ode::system::{Form, System};
use crate::ode::trial::{Cost, Trial};
use crate::parallel::Ticker;

/// What ends a run whose states within a step are not found.
pub(super) const NOTHING_WITHIN: &str = "the rates of the states within a step do not converge";

/// What ends a run with equal steps.
pub(super) fn no_convergence(h: f64) -> String {
    format!("the stages of a step of {h:e} do not converge; take a smaller dt")
}

/// A collocation method at work on one trajectory.
pub struct GaussStep {
    method: &'static Method,
    table: &'static Table,
    /// Where a step looks.
    looks: Looks,
    beyond: &'static Beyond,
    form: Form,
    /// Whether accelerations look at velocities.
    velocity: bool,
    machine: Machine<Lanes>,
    stages: Stages,
    /// Rates of the last kept step, and its length.
    before: Vec<Lanes>,
    length: f64,
    length_tried: f64,
    /// Where the stages lead at the end of the step.
    led: Vec<Lanes>,
    /// By how much rates between the stages are not those of the polynomial, where that was looked at.
    missed_between: Vec<f64>,
    /// Rates at the beginning of the first step, if it was chosen here.
    begin: Vec<f64>,
    /// What is read within the step that was tried, and whether that has been found.
    extension: ExtensionOfOne,
    is_extended: bool,
    /// Rates at the first and at the last stage.
    edges: [Vec<f64>; 2],
    next: State<f64>,
    steps: Steps,
    /// Where the system's time stands at the start.
    t0: f64,
    pace: Pace,
    evaluations: u64,
    max_step: f64,
}

impl GaussStep {
    /// At work on states like `state`; `evaluate` gives the rates of the first order, the accelerations of the second.
    pub fn new(
        method: &'static Method,
        (machine, form, velocity): (Machine<Lanes>, Form, bool),
        state: &State<f64>,
        (steps, max_step): (Steps, f64),
        t0: f64,
    ) -> Self {
        let evaluated = form.evaluated();
        Self {
            method,
            table: method.table,
            looks: method.table.looks(),
            beyond: method.beyond(),
            form,
            velocity,
            machine,
            stages: Stages::new(evaluated),
            before: vec![Lanes([0.0; WIDTH]); evaluated],
            led: vec![Lanes([0.0; WIDTH]); evaluated],
            length: 0.0,
            length_tried: 0.0,
            missed_between: vec![0.0; evaluated],
            begin: vec![],
            extension: ExtensionOfOne::new(evaluated),
            is_extended: false,
            edges: [vec![0.0; evaluated], vec![0.0; evaluated]],
            next: state.clone(),
            steps,
            t0,
            pace: Pace::default(),
            evaluations: 0,
            max_step,
        }
    }

    /// Evaluations of all stages so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Stages that begin where the last step leads, or at its end.
    fn guess(&mut self, h: f64) {
        if self.pace.kept == 0 {
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

    /// Iterates the stages, beside noise if that is known or holds them up; whether it is known then.
    fn iterated(&mut self, t: f64, h: f64, state: &State<f64>) -> (Iterated, bool) {
        let noisy = self.pace.noisy;
        if noisy {
            self.look_for_noise((t, false), state);
        } else {
            self.stages.noise.fill(0.0);
        }
        let fading = self.pace.fading(self.length, h);
        let Self { table, form, velocity, machine, stages, .. } = self;
        let (table, form, velocity) = (*table, *form, *velocity);
        let mut work = Work { table, form, velocity, machine, state, stages, t, h, fading };
        let (iterated, known) = found_beside_noise(&mut work, noisy);
        if iterated.converged {
            advance(&work, &mut self.next);
            told(stages, table.stages);
        }
        self.evaluations += u64::from(iterated.evaluations);
        self.pace.noisy = noisy || (known && iterated.converged);
        (iterated, known)
    }

    /// Finds what states within the step are read by.
    fn extend(&mut self, outcome: &Settled<f64>, state: &State<f64>) -> Result<()> {
        let (t, h) = (self.t0 + outcome.from, outcome.h);
        let Self { table, form, velocity, machine, stages, .. } = self;
        let (table, form, velocity) = (*table, *form, *velocity);
        let mut work = Work { table, form, velocity, machine, state, stages, t, h, fading: 1.0 };
        let (converged, evaluations) =
            extension::find(self.method.extension(), &mut work, &mut self.extension);
        self.evaluations += u64::from(evaluations);
        self.is_extended = converged;
        if converged {
            return Ok(());
        }
        Err(Error::Convergence { message: NOTHING_WITHIN.to_owned(), time: t })
    }

    /// Measures the noise of rates, by the rounding of the time as well or not.
    fn look_for_noise(&mut self, t: (f64, bool), state: &State<f64>) {
        noise::of_one(&mut self.machine, t, state.all().0, &mut self.stages.noise);
        self.evaluations += 1;
    }

    /// Looks for what a motion from rest is measured by.
    fn look_ahead(&mut self, y: &[f64], (begin, span): (f64, f64)) {
        for (register, &y) in self.machine.state().iter_mut().zip(y) {
            *register = Lanes([y; WIDTH]);
        }
        for first in (0..rest::LOOKS).step_by(WIDTH) {
            let times = core::array::from_fn(|lane| rest::time(first + lane, (begin, span)));
            self.machine.run(Lanes(times));
            self.evaluations += 1;
            for (i, least) in self.stages.least.iter_mut().enumerate() {
                for rate in self.machine.output(i).0 {
                    *least = rest::size(*least, rate, span);
                }
            }
        }
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
        self.pace = Pace::over(span);
        if let Steps::Equal(h) = self.steps {
            clock.h = h.copysign(span);
        } else if clock.h == 0.0 {
            // One evaluation, of all stages at the start.
            let y = state.all().0;
            for (register, &y) in self.machine.state().iter_mut().zip(y) {
                *register = Lanes([y; WIDTH]);
            }
            self.machine.run(Lanes([self.t0 + clock.elapsed; WIDTH]));
            self.evaluations += 1;
            let rate = |i: usize| self.machine.output(i).0[0];
            self.begin = (0..self.stages.rates.len()).map(rate).collect();
            clock.h = first_step(self.form, (|i: usize| y[i], rate), (span, self.max_step));
            let moves = |y: &f64| *y != 0.0;
            let is_driven = matches!(self.steps, Steps::Chosen { held: false, .. });
            if is_driven && !self.form.measured(y).iter().any(moves) {
                self.look_ahead(y, (self.t0 + clock.elapsed, span));
            }
        }
        Ok(())
    }

    fn attempt(
        &mut self,
        running: bool,
        system: &mut dyn System<f64>,
        state: &State<f64>,
        clock: &mut Clock<f64>,
        _: &Norm<f64>,
        _: &mut Ticker<'_>,
    ) -> Result<Settled<f64>> {
        let h = f64::next_step(clock, running);
        self.is_extended = false;
        let planned = clock.h;
        self.guess(h);
        let t = self.t0 + clock.elapsed;
        let (iterated, known) = self.iterated(t, h, state);
        self.pace.converged = iterated.converged;
        self.pace.delta = if iterated.converged { self.smoothness(h) } else { f64::INFINITY };
        let mut is_known = known;
        if !known && self.pace.may_be_noise(self.steps, || self.most_noise(state, h)) {
            self.look_for_noise((t, false), state);
            self.pace.takes_beside_noise(self.smoothness(h));
            is_known = self.pace.noisy;
        }
        self.pace.resolving = self.steps.resolving(is_known.then_some(iterated.left), |tolerance| {
            (self.beyond.rounding.resolving(self.table, self.form, tolerance), self.form)
        });
        self.pace.felt = if iterated.converged { self.felt(h) } else { f64::INFINITY };
        self.pace.missed = if self.pace.missable(self.steps) { self.missed(t + h, h) } else { 0.0 };
        self.pace.error = if self.pace.may_err(self.steps) { self.error(h, false) } else { 0.0 };
        if self.pace.errs(self.steps) {
            self.look_between((t, h), state);
            self.pace.error = self.error(h, true);
            if self.pace.errs(self.steps) {
                self.look_for_noise((t, true), state);
                self.pace.error = self.error(h, true);
            }
        }
        if !iterated.converged && matches!(self.steps, Steps::Equal(_)) {
            return Err(Error::Convergence { message: no_convergence(h), time: t });
        }
        let astray = self.pace.refuses(self.steps, &self.beyond.ending);
        let seen = if astray { 1.0 } else { self.seen_until(system, state, (clock.elapsed, h))? };
        let (refused, rule) = (astray || seen < 1.0, Rule::new(1, f64::INFINITY));
        if iterated.converged && (!refused || self.pace.kept == 0) {
            self.stages.remember(!refused);
        }
        let outcome = f64::settle(clock, running, if refused { 4.0 } else { 0.0 }, &rule);
        self.length_tried = h;
        clock.h = if seen < 1.0 {
            self.pace.after_unseen(h, seen)
        } else if refused {
            self.pace.instead_of(h, self.steps, self.table)
        } else if outcome.finished {
            // The last step may be short: what it tells of the next one is for nobody.
            planned
        } else {
            self.pace.after(h, (self.steps, self.max_step), self.table)
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
        if !self.is_extended {
            self.extend(outcome, state)?;
        }
        extension::read(
            self.method.extension(),
            &self.extension,
            (self.form, state),
            (theta, outcome.h),
            into,
        );
        Ok(())
    }

    fn keep(&mut self, accepted: bool, state: &mut State<f64>) {
        if accepted {
            core::mem::swap(state, &mut self.next);
            core::mem::swap(&mut self.before, &mut self.stages.rates);
            self.length = self.length_tried;
            self.pace.kept += 1;
        }
    }

    fn cost(&self) -> Cost {
        // What stages take is told by their own count.
        Cost::default()
    }
}
