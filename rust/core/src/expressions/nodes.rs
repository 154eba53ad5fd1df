//! Nodes by their names: how expressions come from outside.

use super::function::Function;
use super::graph::{Graph, Id};
use crate::error::{Error, Result};

/// The operations that are no functions of one argument; numbers name them in tables, and functions come after them.
pub const OPERATIONS: [&str; 9] =
    ["constant", "variable", "parameter", "time", "sum", "product", "quotient", "atan2", "power"];

/// The operation of that number.
pub fn operation(number: usize) -> Option<&'static str> {
    let function =
        || Function::ALL.get(number.checked_sub(OPERATIONS.len())?).map(|function| function.name());
    OPERATIONS.get(number).copied().or_else(function)
}

/// Adds a node whose arguments are the numbers of nodes that were added before.
///
/// # Errors
/// An operation that there is not; an argument that is missing.
pub fn join(graph: &mut Graph, ids: &[Id], operation: &str, arguments: &[u32], value: f64) -> Result<Id> {
    let of = |index: usize| {
        let argument = arguments.get(index).and_then(|&argument| ids.get(argument as usize));
        let missing = || Error::Internal(format!("{operation} lacks its argument {index}"));
        argument.copied().ok_or_else(missing)
    };
    let all = || (0..arguments.len()).map(of).collect::<Result<Vec<Id>>>();
    Ok(match operation {
        "constant" => graph.constant(value),
        "variable" => graph.variable(value as u32),
        "parameter" => graph.parameter(value as u32),
        "time" => graph.time(),
        "sum" => {
            let terms: Vec<(f64, Id)> = all()?.into_iter().map(|id| (1.0, id)).collect();
            graph.sum(0.0, &terms)
        }
        "product" => {
            let factors = all()?;
            graph.product(&factors)
        }
        "quotient" => {
            let (a, b) = (of(0)?, of(1)?);
            graph.divide(a, b)
        }
        "atan2" => {
            let (y, x) = (of(0)?, of(1)?);
            graph.angle(y, x)
        }
        "power" => {
            let (a, b) = (of(0)?, of(1)?);
            graph.general_power(a, b)
        }
        name => {
            let missing = || Error::Internal(format!("no operation {name}"));
            let function = Function::named(name).ok_or_else(missing)?;
            let a = of(0)?;
            graph.call(function, a)
        }
    })
}
