//! Expressions at many states at once.

use crate::expressions::{Code, Machine};
use crate::numerics::lanes::{Lanes, WIDTH};
use std::sync::Arc;

/// The results of a code at states (rows of numbers) and times, row after row; parameters are those of all rows, or rows of
/// their own.
pub fn rows(code: &Arc<Code>, (t, states): (&[f64], &[f64]), parameters: &[f64], own: bool) -> Vec<f64> {
    let (numbers, count, results) = (code.variables(), code.parameters(), code.outputs());
    let mut found = vec![0.0; t.len() * results];
    let gathered = |first: usize, index: usize| {
        Lanes(core::array::from_fn(|lane| {
            let row = if own { (first + lane).min(t.len() - 1) } else { 0 };
            parameters[row * count + index]
        }))
    };
    let mut machine: Option<Machine<Lanes>> = None;
    for first in (0..t.len()).step_by(WIDTH) {
        let row = |lane: usize| (first + lane).min(t.len() - 1);
        if own || machine.is_none() {
            let parameters: Vec<Lanes> = (0..count).map(|index| gathered(first, index)).collect();
            machine = Some(Machine::new(code.clone(), &parameters));
        }
        let Some(machine) = &mut machine else { continue };
        for (index, register) in machine.state().iter_mut().enumerate() {
            *register = Lanes(core::array::from_fn(|lane| states[row(lane) * numbers + index]));
        }
        machine.run(Lanes(core::array::from_fn(|lane| t[row(lane)])));
        for index in 0..results {
            let values = machine.output(index);
            for lane in 0..WIDTH.min(t.len() - first) {
                found[(first + lane) * results + index] = values.0[lane];
            }
        }
    }
    found
}
