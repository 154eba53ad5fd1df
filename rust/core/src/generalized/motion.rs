//! A model at work as a [`System`]: what every method of the registry takes.

use super::model::Model;
use crate::error::Result;
use crate::expressions::Machine;
use crate::expressions::machine::Width;
use crate::numerics::element::Element;
use crate::ode::system::{Form, Needs, System};
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
}

impl<S: Width> Motion<S> {
    /// With these parameters, of a run that starts then.
    pub fn new(model: &Model, parameters: &[S], t0: S) -> Self {
        Self {
            machine: Machine::new(model.code.clone(), parameters),
            form: model.form,
            needs: model.needs(),
            t0,
            evaluations: 0,
            flat: false,
        }
    }

    /// As equations of the first order, whose errors are measured number by number.
    #[must_use]
    pub fn flat(self) -> Self {
        Self { flat: true, ..self }
    }

    fn evaluate(&mut self, t: S, results: &mut [S]) {
        self.evaluations += 1;
        self.machine.run(self.t0 + t);
        for (index, result) in results.iter_mut().enumerate() {
            *result = self.machine.output(index);
        }
    }
}

impl<S: Width + Element> System<S> for Motion<S> {
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
}
