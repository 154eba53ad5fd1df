//! A torque as a formula: expressions of the time, an orientation and an angular velocity.
//!
//! The one idea: what a user writes is in axes of space and units of its own; a scene that is turned or rescaled changes the
//! few numbers that lead from its bodies to those.

use crate::error::{Error, Result};
use crate::expressions::assembler::compile;
use crate::expressions::program::Output;
use crate::expressions::table::{self, Parameters, Variables};
use crate::expressions::{Code, Graph, Id, Node};
use crate::narrow::{Equations, Features};
use crate::rigid::quaternion::{Quaternion, unit};
use crate::words::number;
use std::sync::Arc;

/// Numbers that the expressions are of: a quaternion, then an angular velocity.
pub(super) const VARIABLES: usize = 7;
/// The first of the angular velocity.
pub(super) const SPIN: usize = 4;

/// Expressions of a torque, as they run.
#[derive(Debug)]
pub struct Formula {
    pub(super) code: Arc<Code>,
    pub(super) looks_at_velocity: bool,
    /// What may be too narrow for a step, of angular accelerations: a further parameter is what they are of the components.
    pub(super) narrow: Option<Arc<Features>>,
    /// From the axes of space that the expressions know to those of the scene.
    pub(super) axes: Quaternion,
    /// The unit of time in the expressions, and that of torque, in those of the scene.
    pub(super) time: f64,
    pub(super) torque: f64,
}

impl Formula {
    /// Reads three components of so many parameters, from nodes as Python writes them, with axes and the units of length, mass
    /// and time that are their own.
    ///
    /// # Errors
    /// By name, for what are no such nodes, for what is no rotation, and for units whose torques are no numbers.
    pub fn read(
        nodes: &[f64],
        parameters: usize,
        axes: Quaternion,
        [length, mass, time]: [f64; 3],
    ) -> Result<Self> {
        let variables = Variables { count: VARIABLES, unit: 1.0 };
        let (graph, roots) =
            table::read(nodes, 3, variables, Parameters::Kept(parameters)).map_err(renamed)?;
        let outputs: Vec<Output> = roots.iter().copied().map(Output::Node).collect();
        let speed = length / time;
        let torque = mass * speed * speed;
        if !(torque.is_normal() && torque > 0.0 && time.is_normal() && (1.0 / time).is_normal()) {
            return Err(Error::invalid(
                "length",
                format!(
                    "expected units in which what an ExpressionTorque gives is a number, but a torque of 1 becomes {}; \
                     choose them nearer to the scene",
                    number(torque)
                ),
            ));
        }
        let of_spin = |node: &Node| matches!(node, Node::Variable(index) if *index as usize >= SPIN);
        Ok(Self {
            looks_at_velocity: graph.any(&roots, of_spin),
            code: Arc::new(compile(&graph, (VARIABLES, parameters), &[], &outputs).map_err(renamed)?),
            narrow: features(graph, &roots, parameters)?.map(Arc::new),
            axes: unit("axes", axes)?,
            time,
            torque,
        })
    }
}

/// What may be too narrow for a step, of the angular accelerations.
fn features(mut graph: Graph, roots: &[Id], parameters: usize) -> Result<Option<Features>> {
    let unit = graph.parameter(parameters as u32);
    let rates: Vec<Output> = roots.iter().map(|&root| Output::Node(graph.product(&[root, unit]))).collect();
    Features::of(Equations {
        graph: &mut graph,
        numbers: VARIABLES,
        parameters: parameters + 1,
        systems: &[],
        rates: &rates,
    })
}

/// As users call what is wrong.
fn renamed(error: Error) -> Error {
    match error {
        Error::InvalidInput { message, .. } => Error::invalid("function", message),
        other => other,
    }
}
