//! The states that a step of a collocation method goes through.

use super::Table;
use crate::ode::system::{Form, Visited};

impl Table {
    /// The ends and the stages of a step of length `h` with these rates of a number at a stage, of one trajectory.
    pub(super) fn visited(
        &self,
        form: Form,
        [start, end]: [Vec<f64>; 2],
        h: f64,
        rates: impl Fn(usize, usize) -> f64,
    ) -> Visited {
        let evaluated = form.evaluated();
        let sum = |matrix: &[crate::numerics::lanes::Lanes], i: usize, stage: usize| -> f64 {
            (0..self.stages).map(|j| matrix[j].0[stage] * rates(i, j)).sum()
        };
        let at = |stage: usize| {
            let passed = self.c.0[stage] * h;
            let numbers = (0..start.len()).map(|index| match form {
                Form::SecondOrder(_) if index < evaluated => {
                    start[index] + (passed * start[evaluated + index] + h * h * sum(&self.a2, index, stage))
                }
                Form::SecondOrder(_) => start[index] + h * sum(&self.a, index - evaluated, stage),
                Form::FirstOrder(_) => start[index] + h * sum(&self.a, index, stage),
            });
            (self.c.0[stage], numbers.collect())
        };
        let stages: Visited = (0..self.stages).map(at).collect();
        core::iter::once((0.0, start)).chain(stages).chain(core::iter::once((1.0, end))).collect()
    }
}
