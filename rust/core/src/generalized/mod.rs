//! Generalized coordinates: Lagrangians and Hamiltonians as expressions, their equations of motion, and their runs.
//!
//! The one idea: a [`Model`] is a graph of expressions and the numbers of the nodes that matter. What is found on the graph
//! (a cyclic coordinate, a constant mass matrix) is then skipped in the code that runs; nothing is derived twice, and no
//! matrix is inverted but with numbers.

pub mod abreast;
mod ahead_of_forces;
mod christoffel;
mod constraints;
pub mod dependence;
pub mod discrete;
mod elimination;
pub mod evaluate;
pub mod events;
pub mod exact;
mod fixed;
pub mod gauss;
mod hamiltonian;
mod lagrangian;
pub mod legendre;
pub mod linear;
pub mod linear_motion;
pub mod model;
pub mod motion;
pub mod one_freedom;
pub mod pendulum_motion;
pub mod poles;
pub mod projection;
pub mod run;
mod sizes;
mod sticking;
pub mod structure;
pub mod variation;

pub use model::{Kind, Model, Source};

#[cfg(test)]
mod tests;
