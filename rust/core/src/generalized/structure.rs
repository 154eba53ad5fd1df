//! What is found on the graph of a model without running it.

use super::model::{Kind, Model, Source};
use crate::expressions::function::Function;
use crate::expressions::graph::{Dependence, number};
use crate::expressions::{Id, Node};

/// What is known of a mass matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassMatrix {
    /// Of parameters alone.
    Constant,
    /// Nothing beside the diagonal.
    Diagonal,
    /// Blocks that do not know each other.
    Blocks,
    /// None of these.
    Full,
    /// There is none: a Hamiltonian.
    None,
}

/// What is found.
#[derive(Clone, Debug)]
pub struct Structure {
    /// Coordinates that nothing depends on: their momenta are conserved.
    pub cyclic: Vec<usize>,
    /// Whether nothing depends on the time.
    pub autonomous: bool,
    /// Whether Jacobi's integral, or H, is conserved.
    pub conserves_energy: bool,
    /// The mass matrix.
    pub mass: MassMatrix,
    /// Whether accelerations depend on places and time alone: kicks and drifts make a method.
    pub separable: bool,
    /// Whether something has a kink: |x| = √(x²) of what changes with the state, where it passes zero.
    pub kinks: bool,
    /// Whether the kinetic energy is quadratic in velocities: the mass matrix does not have them.
    pub quadratic: bool,
    /// Operations of the right-hand side.
    pub operations: usize,
}

impl Structure {
    /// Of a model.
    pub fn of(model: &Model) -> Self {
        let source = &model.source;
        let graph = &source.graph;
        let n = source.coordinates;
        let mut forces: Vec<Id> = source.forces.clone();
        forces.extend(source.dissipation);
        let constraints: Vec<Id> = source.holonomic.iter().chain(&source.nonholonomic).copied().collect();
        let has_time = |roots: &[Id]| graph.any(roots, |node| matches!(node, Node::Time));
        let mut all = forces.clone();
        all.extend(&constraints);
        all.push(source.function);
        let autonomous = !has_time(&all);
        let forced = forces.iter().any(|&force| !graph.is_zero(force));
        let conserves_energy = !has_time(&[source.function])
            && !forced
            && source.nonholonomic.is_empty()
            && !has_time(&source.holonomic);
        let number =
            |index: usize| move |node: &Node| matches!(node, Node::Variable(i) if *i as usize == index);
        let cyclic = (0..n).filter(|&i| {
            let pushed = source.forces.get(i).is_some_and(|&force| !graph.is_zero(force));
            let damped = source.dissipation.is_some_and(|damping| graph.any(&[damping], number(n + i)));
            let bound =
                graph.any(&source.holonomic, number(i)) || graph.any(&source.nonholonomic, number(n + i));
            graph.is_zero(model.slopes[i]) && !pushed && !damped && !bound
        });
        let needs = model.needs();
        Self {
            cyclic: cyclic.collect(),
            autonomous,
            conserves_energy,
            mass: Self::mass_matrix(model),
            separable: matches!(model.form, crate::ode::system::Form::SecondOrder(_)) && !needs.velocity,
            kinks: !Self::turning(source).is_empty(),
            quadratic: Self::is_quadratic(model),
            operations: model.code.operations(),
        }
    }

    fn is_quadratic(model: &Model) -> bool {
        let n = model.source.coordinates as u32;
        let entries: Vec<Id> = model.mass.iter().flatten().copied().collect();
        !model.source.graph.any(&entries, |node| matches!(node, Node::Variable(index) if *index >= n))
    }

    /// What absolute values are taken of: x of |x| = √(x²), where it changes with the state.
    pub(super) fn turning(source: &Source) -> Vec<Id> {
        let graph = &source.graph;
        let mut all: Vec<Id> = source.forces.clone();
        all.extend(source.dissipation);
        all.extend(source.holonomic.iter().chain(&source.nonholonomic));
        all.push(source.function);
        let turning = |id: Id| {
            let &Node::Call(Function::Sqrt, mut under) = graph.node(id) else { return None };
            // A square that has a factor.
            while let Node::Sum(constant, terms) = graph.node(under)
                && number(*constant) == 0.0
                && let [(_, only)] = **terms
            {
                under = only;
            }
            match *graph.node(under) {
                Node::Product(a, b) if a == b && graph.dependence(a) > Dependence::Parameters => Some(a),
                _ => None,
            }
        };
        graph.reachable(&all).into_iter().filter_map(turning).collect()
    }

    fn mass_matrix(model: &Model) -> MassMatrix {
        let graph = &model.source.graph;
        if model.source.kind == Kind::Hamiltonian {
            return MassMatrix::None;
        }
        let entries = || {
            model
                .mass
                .iter()
                .enumerate()
                .flat_map(|(i, row)| row.iter().enumerate().map(move |(j, &id)| (i, j, id)))
        };
        if entries().all(|(_, _, id)| graph.dependence(id) <= Dependence::Parameters) {
            MassMatrix::Constant
        } else if entries().all(|(i, j, id)| i == j || graph.is_zero(id)) {
            MassMatrix::Diagonal
        } else if model.systems.len() > 1
            || model.rates.len() > model.systems.iter().map(|s| s.right.len()).sum()
        {
            MassMatrix::Blocks
        } else {
            MassMatrix::Full
        }
    }
}
