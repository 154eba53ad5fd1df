//! The flow's derivatives: equations of the motion and of what small differences at the start become.
//!
//! The one idea: Φ̇ = (∂f/∂y) Φ beside ẏ = f, as one system of the first order, whose right-hand side is made on the graph
//! like any other; so it runs by every method, and Φ is as good as y.

use super::elimination::solved;
use super::model::{Kind, Model};
use crate::error::{Error, Result};
use crate::expressions::assembler::compile;
use crate::expressions::program::Output;
use crate::expressions::{Graph, Id};
use crate::ode::system::Form;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Systems of so many coordinates have the flow's derivatives whatever their rates are made of: Φ has the square of twice as many
/// numbers.
const SMALL: usize = 16;
/// Those of larger ones may be made of so many operations, for each number of the state those of all rates.
const MOST_OPERATIONS: usize = 400_000;

/// The rates of all numbers of a state as expressions.
pub(super) fn rates_as_nodes(model: &mut Model) -> Vec<Id> {
    let (_, v) = model.source.halves();
    let graph = &mut model.source.graph;
    let mut unknowns = Vec::new();
    for system in &model.systems {
        let found = solved(graph, &system.matrix, &system.right);
        // A system that is singular whatever the numbers has no rates, and is refused as such at the start.
        let none = graph.constant(f64::NAN);
        unknowns.extend(found.unwrap_or_else(|| vec![none; system.right.len()]));
    }
    let evaluated = model.rates.iter().map(|rate| match *rate {
        Output::Node(id) => id,
        Output::Unknown(index) => unknowns[index as usize],
    });
    match (model.form, model.source.kind) {
        (Form::FirstOrder(_), _) => evaluated.collect(),
        (Form::SecondOrder(_), Kind::Hamiltonian | Kind::Lagrangian) => {
            v.iter().copied().chain(evaluated).collect()
        }
    }
}

/// A model whose state is (y, Φ), Φ row by row. Of constraints it has what keeps rates on them, and no projection.
///
/// # Errors
/// More coordinates than there is room for.
pub fn variational(model: &Model) -> Result<Model> {
    let mut model = model.clone();
    let n = model.numbers();
    let mut rates = rates_as_nodes(&mut model);
    let operations = n * model.source.graph.reachable(&rates).len();
    if model.source.coordinates > SMALL && operations > MOST_OPERATIONS {
        return Err(Error::invalid(
            "system",
            format!(
                "its variational equations would be made of some {operations} operations, where up to {MOST_OPERATIONS} \
                 are taken of more than {SMALL} coordinates; compare runs from neighboring starts, as an ensemble"
            ),
        ));
    }
    let graph: &mut Graph = &mut model.source.graph;
    let state: Vec<Id> = (0..n as u32).map(|i| graph.variable(i)).collect();
    let entries: Vec<Id> = (0..(n * n) as u32).map(|k| graph.variable(n as u32 + k)).collect();
    let mut columns = Vec::with_capacity(n);
    for j in 0..n {
        let direction: FxHashMap<Id, Id> = (0..n).map(|i| (state[i], entries[i * n + j])).collect();
        columns.push(graph.tangent(&rates, &direction));
    }
    for i in 0..n {
        rates.extend(columns.iter().map(|column| column[i]));
    }
    model.rates = rates.into_iter().map(Output::Node).collect();
    model.systems = vec![];
    (model.multipliers, model.source.holonomic, model.source.nonholonomic) = Default::default();
    model.projection = None;
    model.numbers = n + n * n;
    model.form = Form::FirstOrder(model.numbers);
    let inputs = (model.numbers, model.source.parameters);
    model.code = Arc::new(compile(&model.source.graph, inputs, &[], &model.rates)?);
    model.set_watched()?;
    Ok(model)
}
