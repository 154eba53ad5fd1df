//! Expressions in a table of numbers, as a file has them.
//!
//! First how many expressions there are, and their nodes; then node after node: its operation, its value, how many arguments
//! it has, and those, as numbers of nodes before it. What has the operation [`NAME`] is no node: the letters of a parameter's
//! name, which is asked for elsewhere.

use super::{Expressions, VARIABLES};
use crate::error::{Error, Result};
use crate::expressions::assembler::compile;
use crate::expressions::graph::{Graph, Id, Node};
use crate::expressions::nodes::{join, operation};
use crate::expressions::program::Output;
use crate::expressions::series::Series;
use crate::ode::system::Needs;
use std::sync::Arc;

/// In the place of an operation: a name follows.
const NAME: usize = 1000;

fn refused(why: &str) -> Error {
    Error::invalid("nodes", format!("these are no expressions as visviva.ExpressionForce writes them: {why}"))
}

/// Numbers that are read one after another.
struct Reader<'a>(&'a [f64]);

impl Reader<'_> {
    fn number(&mut self) -> Result<f64> {
        let (&first, rest) = self.0.split_first().ok_or_else(|| refused("the table ends too early"))?;
        self.0 = rest;
        Ok(first)
    }

    fn count(&mut self) -> Result<usize> {
        let number = self.number()?;
        let whole = (0.0..1e6).contains(&number) && number.fract() == 0.0;
        if whole { Ok(number as usize) } else { Err(refused("a count or a place is no whole number")) }
    }

    fn counts(&mut self, count: usize) -> Result<Vec<usize>> {
        (0..count).map(|_| self.count()).collect()
    }
}

/// Reads the components of a force, or a potential energy.
pub(super) fn read(potential: bool, table: &[f64], parameters: &[f64]) -> Result<Expressions> {
    let mut reader = Reader(table);
    let wanted = if potential { 1 } else { 3 };
    let count = reader.count()?;
    if count != wanted {
        return Err(refused(&format!("expected {wanted} of them, got {count}")));
    }
    let roots = reader.counts(count)?;
    let mut graph = Graph::default();
    let mut ids: Vec<Id> = Vec::new();
    while !reader.0.is_empty() {
        let number = reader.count()?;
        if number == NAME {
            let (_, letters) = (reader.number()?, reader.count()?);
            let _ = reader.counts(letters)?;
            continue;
        }
        let name = operation(number).ok_or_else(|| refused("there is no such operation"))?;
        let value = reader.number()?;
        let arguments = reader.count()?;
        let arguments: Vec<u32> = reader.counts(arguments)?.into_iter().map(|index| index as u32).collect();
        let fits = match name {
            "variable" => value >= 0.0 && value < VARIABLES as f64,
            "parameter" => value >= 0.0 && value < parameters.len() as f64,
            _ => arguments.iter().all(|&argument| (argument as usize) < ids.len()),
        };
        if !fits {
            return Err(refused("a node is of something that is not there"));
        }
        let id = join(&mut graph, &ids, name, &arguments, value)
            .map_err(|_| refused("an operation lacks an argument"))?;
        ids.push(id);
    }
    let roots = roots.iter().map(|&root| ids.get(root).copied().ok_or_else(|| refused("a node is missing")));
    let made_from = core::iter::once(u64::from(potential)).chain(table.iter().map(|x| x.to_bits())).collect();
    Ok(Expressions { made_from, ..expressions(potential, graph, roots.collect::<Result<_>>()?, parameters)? })
}

/// Derives and compiles.
fn expressions(potential: bool, mut graph: Graph, roots: Vec<Id>, parameters: &[f64]) -> Result<Expressions> {
    let velocity = |node: &Node| matches!(node, Node::Variable(index) if *index >= 3);
    let needs = Needs {
        time: graph.any(&roots, |node| matches!(node, Node::Time)),
        velocity: graph.any(&roots, velocity),
        rotation: false,
    };
    if potential && needs.velocity {
        return Err(Error::invalid(
            "potential",
            "expected a function of places and time, got one of velocities; pass the force instead",
        ));
    }
    let force = if potential {
        let places: Vec<Id> = (0..3).map(|i| graph.variable(i)).collect();
        graph.gradient(roots[0], &places).into_iter().map(|slope| graph.scale(-1.0, slope)).collect()
    } else {
        roots.clone()
    };
    let inputs = (VARIABLES, parameters.len());
    let outputs = |ids: &[Id]| ids.iter().copied().map(Output::Node).collect::<Vec<_>>();
    let compiled = |ids: &[Id]| compile(&graph, inputs, &[], &outputs(ids)).map(Arc::new);
    Ok(Expressions {
        force: compiled(&force)?,
        // A drive that begins more gently than any power that a series has would not be seen.
        series: match Series::leaps(&graph, &force) {
            None if !needs.time => Some(Arc::new(Series::new(&graph, inputs, &[], &outputs(&force))?)),
            _ => None,
        },
        potential: if potential { Some(compiled(&roots)?) } else { None },
        parameters: parameters.to_vec(),
        needs,
        made_from: vec![],
    })
}
