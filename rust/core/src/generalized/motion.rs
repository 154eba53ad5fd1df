//! A model at work as a [`System`]: what every method of the registry takes.

use super::ahead_of_forces::{LONGEST_FREE, LongestStep};
use super::model::Model;
use super::run::{Integrator, Request};
use crate::error::{Error, Result};
use crate::expressions::Machine;
use crate::expressions::machine::Width;
use crate::expressions::series::{Coefficient, Coefficients, Equations, Expansion};
use crate::narrow::{Narrow, REACH, Stepped};
use crate::ode::series::Jet;
use crate::ode::step_control::Controlled;
use crate::ode::system::{Form, Needs, System, Taken};
use crate::ode::{Method, Scheme};
use crate::parallel::Ticker;

/// The equations of motion of one trajectory, or of eight.
#[derive(Debug)]
pub struct Motion<S> {
    machine: Machine<S>,
    form: Form,
    needs: Needs,
    /// The system's time at the start of the run.
    t0: S,
    evaluations: u64,
    /// Whether equations of the second order are shown as those of the first, velocities being rates.
    flat: bool,
    /// The equations as recurrences of Taylor coefficients.
    series: Option<Expansion<S>>,
    /// The longest step on which nothing is felt.
    longest_free: S,
    /// What may lie between the nodes of a step.
    narrow: Option<Box<Narrow<S>>>,
}

impl<S: Width + Coefficient + Controlled> Motion<S> {
    /// With these parameters, of a run that starts then.
    pub fn new(model: &Model, parameters: &[S], t0: S) -> Self {
        Self {
            machine: Machine::new(model.code.clone(), parameters),
            form: model.form,
            needs: model.needs(),
            t0,
            evaluations: 0,
            flat: false,
            series: None,
            longest_free: S::splat(f64::INFINITY),
            narrow: None,
        }
    }

    /// As what is asked wants it: of the first order, with recurrences of Taylor coefficients.
    pub fn of(model: &Model, request: &Request, parameters: &[S], t0: S) -> Self {
        let motion = Self::new(model, parameters, t0);
        let series = request.series.as_ref();
        let (start, end) = request.span;
        let tolerance = request.dt.is_none().then_some(request.rtol);
        let stepped = Stepped { t0: start, tolerance, reach: REACH };
        Self {
            longest_free: S::splat(LONGEST_FREE * (end - start).abs()),
            flat: matches!(request.integrator, Integrator::Table(Method { scheme: Scheme::Embedded(_), .. })),
            series: series.map(|series| Expansion::new(series.clone(), parameters)),
            narrow: model
                .narrow
                .as_ref()
                .map(|of| Box::new(Narrow::new(of, model.form, stepped, parameters))),
            ..motion
        }
    }

    /// With other parameters from now on.
    pub fn set_parameters(&mut self, parameters: &[S]) {
        self.machine.set_parameters(parameters);
        if let Some(series) = &mut self.series {
            series.set_parameters(parameters);
        }
        if let Some(narrow) = &mut self.narrow {
            narrow.set_parameters(parameters);
        }
    }

    /// Of a series expansions are counted, and not what is looked at besides.
    fn evaluate(&mut self, t: S, results: &mut [S]) {
        self.evaluations += u64::from(self.series.is_none());
        self.machine.run(self.t0 + t);
        for (index, result) in results.iter_mut().enumerate() {
            *result = self.machine.output(index);
        }
    }
}

impl<S: Width + Coefficient + Controlled> System<S> for Motion<S> {
    fn form(&self) -> Form {
        if self.flat { Form::FirstOrder(self.form.len()) } else { self.form }
    }

    fn needs(&self) -> Needs {
        self.needs
    }

    fn evaluations(&self) -> u64 {
        self.evaluations
    }

    fn rate(&mut self, t: &S, y: &[S], rate: &mut [S], _: &mut Ticker<'_>) -> Result<()> {
        self.machine.state().copy_from_slice(y);
        match self.form {
            Form::FirstOrder(_) => self.evaluate(*t, rate),
            Form::SecondOrder(n) => {
                let (first, second) = rate.split_at_mut(n);
                first.copy_from_slice(&y[n..]);
                self.evaluate(*t, second);
            }
        }
        Ok(())
    }

    fn acceleration(&mut self, t: &S, q: &[S], v: &[S], a: &mut [S], _: &mut Ticker<'_>) -> Result<()> {
        let state = self.machine.state();
        let (first, second) = state.split_at_mut(q.len());
        first.copy_from_slice(q);
        // Whoever needs no velocities may have been given none.
        if self.needs.velocity {
            second.copy_from_slice(v);
        }
        self.evaluate(*t, a);
        Ok(())
    }

    fn expand(&mut self, jet: &mut Jet<S>, _: &mut Ticker<'_>) -> Result<()> {
        self.evaluations += 1;
        let Some(series) = &mut self.series else {
            return Err(Error::Internal("a motion without its series".to_owned()));
        };
        let second_order = matches!(self.form, Form::SecondOrder(_));
        let Jet { order, len, ref mut q, ref mut v, t, unit, ref inverse, .. } = *jet;
        let (velocity, t) = (self.needs.velocity, self.t0 + t);
        let equations = Equations { second_order, velocity, t, unit, inverse, seen: None };
        series.motion(&equations, Coefficients { order, len, q, v });
        Ok(())
    }

    fn seen_until(&mut self, step: &Taken<'_, S>) -> Result<Option<S>> {
        self.narrow.as_mut().map_or(Ok(None), |narrow| narrow.seen_until(step))
    }

    fn smooth_until(&self, jet: &Jet<S>, h: &S) -> Option<S> {
        let h = S::pass(LongestStep { form: self.form, jet, h, longest_free: &self.longest_free });
        let sharp = self.series.as_ref().filter(|series| series.may_turn_sharply());
        Some(sharp.map_or(h, |series| series.smooth_until(jet.order, h / jet.unit) * jet.unit))
    }
}
