//! Expressions in a table of numbers, as a file has them.
//!
//! First how many expressions there are, and their nodes; then node after node: its operation, its value, how many arguments
//! it has, and those, as numbers of nodes before it. What has the operation [`NAME`] is no node: the letters of a parameter's
//! name, which is asked for elsewhere.

use super::graph::{Graph, Id};
use super::nodes::{join, operation};
use crate::error::{Error, Result};

/// In the place of an operation: a name follows.
const NAME: usize = 1000;

/// What the parameters of expressions become.
#[derive(Clone, Copy, Debug)]
pub enum Parameters<'a> {
    /// Parameters still, so many.
    Kept(usize),
    /// Constants.
    Told(&'a [f64]),
}

/// What the variables of expressions become: so many, each times a unit.
#[derive(Clone, Copy, Debug)]
pub struct Variables {
    /// How many.
    pub count: usize,
    /// The unit.
    pub unit: f64,
}

fn refused(why: &str) -> Error {
    Error::invalid("nodes", format!("these are no expressions as visviva writes them: {why}"))
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

impl Parameters<'_> {
    fn count(self) -> usize {
        match self {
            Self::Kept(count) => count,
            Self::Told(values) => values.len(),
        }
    }
}

/// The graph of so many expressions, of so many variables, and the node of each.
///
/// # Errors
/// `InvalidInput` naming `nodes` for what is no such table.
pub fn read(
    table: &[f64],
    wanted: usize,
    variables: Variables,
    parameters: Parameters<'_>,
) -> Result<(Graph, Vec<Id>)> {
    let mut reader = Reader(table);
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
            "variable" => value >= 0.0 && value < variables.count as f64,
            "parameter" => value >= 0.0 && value < parameters.count() as f64,
            _ => arguments.iter().all(|&argument| (argument as usize) < ids.len()),
        };
        if !fits {
            return Err(refused("a node is of something that is not there"));
        }
        let id = match parameters {
            Parameters::Told(values) if name == "parameter" => Ok(graph.constant(values[value as usize])),
            _ => join(&mut graph, &ids, name, &arguments, value),
        };
        let id = id.map(|id| if name == "variable" { graph.scale(variables.unit, id) } else { id });
        ids.push(id.map_err(|_| refused("an operation lacks an argument"))?);
    }
    let roots = roots.iter().map(|&root| ids.get(root).copied().ok_or_else(|| refused("a node is missing")));
    let roots = roots.collect::<Result<_>>()?;
    Ok((graph, roots))
}
