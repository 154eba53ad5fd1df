//! A model at work as a [`System`]: what every method of the registry takes.

use super::model::Model;
use super::run::{Integrator, Request};
use crate::error::{Error, Result};
use crate::expressions::Machine;
use crate::expressions::machine::Width;
use crate::expressions::series::{Coefficient, Expansion};
use crate::numerics::element::Element;
use crate::ode::series::Jet;
use crate::ode::system::{Form, Needs, System};
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
    /// The equations as recurrences, and room for a coefficient of what they give.
    series: Option<(Expansion<S>, Vec<S>)>,
}

impl<S: Width + Coefficient> Motion<S> {
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
        }
    }

    /// As what is asked wants it: of the first order, with recurrences of Taylor coefficients.
    pub fn of(model: &Model, request: &Request, parameters: &[S], t0: S) -> Self {
        let motion = Self::new(model, parameters, t0);
        let room = vec![S::zero(); motion.form.evaluated()];
        let series = request.series.as_ref();
        Self {
            flat: matches!(request.integrator, Integrator::Table(Method { scheme: Scheme::Embedded(_), .. })),
            series: series.map(|series| (Expansion::new(series.clone(), parameters), room)),
            ..motion
        }
    }

    /// With other parameters from now on.
    pub fn set_parameters(&mut self, parameters: &[S]) {
        self.machine.set_parameters(parameters);
        if let Some((series, _)) = &mut self.series {
            series.set_parameters(parameters);
        }
    }

    fn evaluate(&mut self, t: S, results: &mut [S]) {
        self.evaluations += 1;
        self.machine.run(self.t0 + t);
        for (index, result) in results.iter_mut().enumerate() {
            *result = self.machine.output(index);
        }
    }
}

impl<S: Width + Coefficient + Element> System<S> for Motion<S> {
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
        let Some((series, rates)) = &mut self.series else {
            return Err(Error::Internal("a motion without its series".to_owned()));
        };
        let per_unit = S::one() / jet.unit;
        let (time, len) = (series.time(), jet.len);
        for n in 0..jet.order {
            for (index, &q) in jet.position(n).iter().enumerate() {
                series.set(index, n, q);
            }
            if let Form::SecondOrder(_) = self.form
                && self.needs.velocity
            {
                for (index, &v) in jet.velocity(n).iter().enumerate() {
                    series.set(len + index, n, v * per_unit);
                }
            }
            match n {
                0 => series.set(time, 0, self.t0 + jet.t),
                1 => series.set(time, 1, jet.unit),
                2 => series.set(time, 2, S::zero()),
                _ => {}
            }
            series.expand(n);
            let unit = match self.form {
                Form::FirstOrder(_) => jet.unit,
                Form::SecondOrder(_) => jet.unit * jet.unit,
            };
            for (index, rate) in rates.iter_mut().enumerate() {
                *rate = series.output(index, n) * unit;
            }
            match self.form {
                Form::FirstOrder(_) => jet.raise_rates(n, rates),
                Form::SecondOrder(_) => jet.raise(n, rates),
            }
        }
        Ok(())
    }
}
