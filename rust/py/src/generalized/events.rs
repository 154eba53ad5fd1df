//! Events as Python describes them: expressions of the state, its energy, and functions of Python.

use super::GeneralizedModel;
use super::nodes::{NodeParts, added, chosen};
use crate::arrays::moved;
use crate::scene::events::{Raised, number};
use pyo3::prelude::*;
use std::sync::Arc;
use visviva_core::Result;
use visviva_core::generalized::events::{Event, Function};

/// An event: nodes and a root among them; none of the energy, which passes a value, and of a function of Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Sought {
    nodes: Vec<NodeParts>,
    root: Option<u32>,
    energy: Option<f64>,
    function: Option<Py<PyAny>>,
    direction: f64,
    last: Option<u64>,
}

impl Sought {
    /// Whether it calls Python.
    pub(super) fn calls(&self) -> bool {
        self.function.is_some()
    }

    /// As the core takes it.
    pub(super) fn event(&self, py: Python<'_>, of: &GeneralizedModel, raised: &Raised) -> Result<Event> {
        let (direction, last) = (self.direction, self.last);
        let conserved = self.energy.filter(|_| of.structure.conserves_energy);
        if let Some(function) = &self.function {
            return Ok(Event {
                function: called(function.clone_ref(py), raised.clone()),
                direction,
                last,
                conserved,
            });
        }
        let mut model = of.copy();
        let ids = added(&mut model.source.graph, &self.nodes)?;
        let expression = match (self.root, self.energy) {
            (Some(root), _) => chosen(&ids, root)?,
            (None, value) => {
                let energy = model.energy;
                model.source.graph.sum(-value.unwrap_or_default(), &[(1.0, energy)])
            }
        };
        Ok(Event { function: Function::of(&mut model, expression)?, direction, last, conserved })
    }
}

/// A function `f(t, position, velocity)`; of a Hamiltonian its last argument is the momentum.
fn called(function: Py<PyAny>, raised: Raised) -> Function {
    Function::Called(Arc::new(move |t: f64, y: &[f64]| {
        raised.called(|py| {
            let (first, second) = y.split_at(y.len() / 2);
            let first = moved(py, first.to_vec(), &[first.len()])?;
            let second = moved(py, second.to_vec(), &[second.len()])?;
            number(function.call1(py, (t, first, second))?.bind(py))
        })
    }))
}
