//! From a table of nodes to what runs: derivatives, codes, and the series if there is one.

use super::{Expressions, Gives, VARIABLES};
use crate::error::{Error, Result};
use crate::expressions::Code;
use crate::expressions::assembler::compile;
use crate::expressions::function::Function;
use crate::expressions::graph::{Graph, Id, Node};
use crate::expressions::program::Output;
use crate::expressions::series::Series;
use crate::expressions::table::{self, Parameters, Variables};
use crate::expressions::{definite, narrow};
use crate::narrow::{Equations, Features};
use crate::ode::system::Needs;
use std::sync::{Arc, OnceLock};

/// Reads the components of a force, or a potential energy.
pub(super) fn read(gives: Gives, nodes: &[f64], parameters: &[f64]) -> Result<Expressions> {
    let potential = gives == Gives::Potential;
    let wanted = if potential { 1 } else { 3 };
    let (graph, roots) = table::read(
        nodes,
        wanted,
        Variables { count: VARIABLES, unit: 1.0 },
        Parameters::Kept(parameters.len()),
    )?;
    let made_from = core::iter::once(gives as u64).chain(nodes.iter().map(|x| x.to_bits())).collect();
    Ok(Expressions { made_from, ..expressions(potential, graph, roots, parameters)? })
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
    let force = components(potential, &mut graph, &roots);
    let inputs = (VARIABLES, parameters.len());
    let outputs = |ids: &[Id]| ids.iter().copied().map(Output::Node).collect::<Vec<_>>();
    let compiled = |ids: &[Id]| compile(&graph, inputs, &[], &outputs(ids)).map(Arc::new);
    Ok(Expressions {
        force: compiled(&force)?,
        // A drive that begins more gently than any power that a series has would not be seen.
        series: match Series::leaps(&graph, &force) {
            None if narrow::is_entire_in_time(&graph, &force) => {
                Some(Arc::new(Series::new(&graph, inputs, &[], &outputs(&force))?))
            }
            _ => None,
        },
        potential: if potential { Some(compiled(&roots)?) } else { None },
        parameters: parameters.to_vec(),
        needs,
        may_hide: narrow::may_hide(&graph, &force),
        is_told: narrow::is_entire(&graph, &force) || definite::is_definite(&graph, &force),
        narrow: features(graph, &force, parameters.len())?.map(Arc::new),
        made_from: vec![],
        change: OnceLock::new(),
    })
}

/// The components of the force.
fn components(potential: bool, graph: &mut Graph, roots: &[Id]) -> Vec<Id> {
    if !potential {
        return roots.to_vec();
    }
    let places: Vec<Id> = (0..3).map(|i| graph.variable(i)).collect();
    graph.gradient(roots[0], &places).into_iter().map(|slope| graph.scale(-1.0, slope)).collect()
}

/// How the components of the force change along a direction, whose numbers are variables after the place and the velocity;
/// nothing where that may be no number though the force is one.
pub(super) fn change(gives: Gives, expressions: &Expressions) -> Option<Code> {
    let nodes: Vec<f64> = expressions.made_from.iter().skip(1).map(|&bits| f64::from_bits(bits)).collect();
    let (potential, parameters) = (gives == Gives::Potential, expressions.parameters.len());
    let variables = Variables { count: VARIABLES, unit: 1.0 };
    let wanted = if potential { 1 } else { 3 };
    let (mut graph, roots) = table::read(&nodes, wanted, variables, Parameters::Kept(parameters)).ok()?;
    let force = components(potential, &mut graph, &roots);
    if !differentiable(&graph, &force) {
        return None;
    }
    let own = (0..VARIABLES as u32).map(|of| (graph.variable(of), graph.variable(of + VARIABLES as u32)));
    let direction = own.collect();
    let change: Vec<Output> = graph.tangent(&force, &direction).into_iter().map(Output::Node).collect();
    compile(&graph, (2 * VARIABLES, parameters), &[], &change).ok()
}

/// Whether the slope of expressions is a number wherever they are: that of a root is none where it vanishes, unless something
/// is divided by it.
fn differentiable(graph: &Graph, roots: &[Id]) -> bool {
    let reachable = graph.reachable(roots);
    let mut divisors: Vec<Id> = Vec::new();
    for &id in &reachable {
        let mut factors = match *graph.node(id) {
            Node::Quotient(_, divisor) => vec![divisor],
            Node::Power(divisor, exponent) if f64::from_bits(exponent) < 0.0 => vec![divisor],
            _ => continue,
        };
        while let Some(factor) = factors.pop() {
            match *graph.node(factor) {
                Node::Product(a, b) => factors.extend([a, b]),
                _ => divisors.push(factor),
            }
        }
    }
    reachable.iter().all(|id| match *graph.node(*id) {
        Node::Call(Function::Sqrt, _) => divisors.contains(id),
        Node::Power(_, exponent) => {
            let exponent = f64::from_bits(exponent);
            !(0.0..1.0).contains(&exponent) || divisors.contains(id)
        }
        Node::Angle(..) | Node::Call(Function::Asin | Function::Acos | Function::Acosh, _) => false,
        _ => true,
    })
}

/// What may be too narrow for a step, of the accelerations.
fn features(mut graph: Graph, force: &[Id], parameters: usize) -> Result<Option<Features>> {
    let unit = graph.parameter(parameters as u32);
    let rates: Vec<Output> =
        force.iter().map(|&component| Output::Node(graph.product(&[component, unit]))).collect();
    Features::of(Equations {
        graph: &mut graph,
        numbers: VARIABLES,
        parameters: parameters + 1,
        systems: &[],
        rates: &rates,
    })
}
