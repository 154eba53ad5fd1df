//! Expressions: a graph of operations, its derivatives, and programs that evaluate it for eight states at once.
//!
//! The one idea: equal expressions are one node, from the moment they are made. So derivatives share what they have in common
//! with what they are derivatives of, nothing is searched for afterwards, and making a program is a walk over the nodes.
//! Nothing here knows mechanics: a program is a function of a state, the time and parameters.

pub mod assembler;
pub mod code;
pub mod curve;
pub mod definite;
mod derivative;
pub mod execute;
pub mod function;
pub mod graph;
mod identity;
pub mod intervals;
pub mod linear;
pub mod machine;
pub mod narrow;
pub mod nodes;
pub mod precise;
pub mod program;
pub mod series;
pub mod shape;
pub mod table;
mod verify;
mod walk;

pub use code::Code;
pub use graph::{Graph, Id, Node};
pub use machine::Machine;
pub use series::Series;

#[cfg(test)]
mod tests;
