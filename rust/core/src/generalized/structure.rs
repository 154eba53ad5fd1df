//! What is found on the graph of a model without running it.

use super::model::{Kind, Model, Source};
use crate::expressions::function::Function;
use crate::expressions::graph::{Dependence, number};
use crate::expressions::intervals::{Interval, Intervals};
use crate::expressions::narrow::even_power;
use crate::expressions::program::Output;
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
    /// Whether a step that is chosen once serves all along: a flow that keeps energy and volume comes to nothing new.
    pub holds_steps: bool,
    /// The mass matrix.
    pub mass: MassMatrix,
    /// Whether kicks and drifts make a method: accelerations depend on places and time alone, or H = T(p) + V(q, t).
    pub separable: bool,
    /// And whether drifts are as long as T quadratic in p makes them, on which Nyström's methods rely.
    pub nystrom: bool,
    /// Whether velocities are what moves coordinates, and half of a state.
    pub second_order: bool,
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
            && Self::rolls_without_work(source)
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
        let second_order = matches!(model.form, crate::ode::system::Form::SecondOrder(_));
        let separable = if second_order { !model.needs().velocity } else { Self::separates(model) };
        Self {
            cyclic: cyclic.collect(),
            autonomous,
            conserves_energy,
            holds_steps: conserves_energy && source.nonholonomic.is_empty(),
            mass: Self::mass_matrix(model),
            separable,
            nystrom: separable && (second_order || Self::drifts_are_linear(model)),
            second_order,
            kinks: !Self::turning(source).is_empty(),
            quadratic: Self::is_quadratic(model),
            operations: model.code.operations(),
        }
    }

    /// Whether velocities ∂H/∂p look at momenta alone, and the rates of these at places and time.
    fn separates(model: &Model) -> bool {
        let n = model.source.coordinates as u32;
        if model.source.kind != Kind::Hamiltonian {
            return false;
        }
        let looks = |roots: &[Id], at: &dyn Fn(&Node) -> bool| model.source.graph.any(roots, |node| at(node));
        let (_, kicks) = model.rates.split_at(n as usize);
        let kicks: Vec<Id> = kicks.iter().filter_map(Output::node).collect();
        let is_place =
            |node: &Node| matches!(node, Node::Time) || matches!(node, Node::Variable(i) if *i < n);
        let is_momentum = |node: &Node| matches!(node, Node::Variable(i) if *i >= n);
        !looks(&model.conjugates, &is_place) && !looks(&kicks, &is_momentum)
    }

    fn drifts_are_linear(model: &Model) -> bool {
        let mut source = model.source.clone();
        let (_, momenta) = source.halves();
        let slopes: Vec<Id> =
            model.conjugates.iter().flat_map(|&velocity| source.graph.gradient(velocity, &momenta)).collect();
        slopes.iter().all(|&slope| source.graph.dependence(slope) <= Dependence::Parameters)
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
            let (under, exponent) = match graph.node(id) {
                Node::Call(Function::Sqrt, under) => (*under, 0.5),
                Node::Power(under, exponent) => (*under, number(*exponent)),
                _ => return None,
            };
            let (base, power) = even_power(graph, under);
            // Of x², x⁴ and so on there is a root that has no kink, and of none without one.
            let bent = power > 1.0 && power * exponent > 0.0 && (power * exponent) % 2.0 != 0.0;
            let turns = || {
                // Whatever the parameters and the time are.
                let (anything, unknown) = (Interval::at(f64::NAN), vec![f64::NAN; source.parameters]);
                let state = vec![anything; 2 * source.coordinates];
                let bounds = Intervals::new(graph.clone(), vec![base]).over(anything, &state, &unknown);
                bounds.values.iter().any(|values| values.low < 0.0)
            };
            (bent && graph.dependence(base) > Dependence::Parameters && turns()).then_some(base)
        };
        graph.reachable(&all).into_iter().filter_map(turning).collect()
    }

    /// Whether no velocity at all is allowed by every nonholonomic constraint, so that none drives: what holds a motion to
    /// such does no work, whether or not it depends on the time. J. I. Neimark & N. A. Fufaev, *Dynamics of Nonholonomic
    /// Systems* (AMS, 1972), ch. III.
    fn rolls_without_work(source: &Source) -> bool {
        let (mut graph, n) = (source.graph.clone(), source.coordinates as u32);
        let zero = graph.constant(0.0);
        let still = (n..2 * n).map(|velocity| (graph.variable(velocity), zero)).collect();
        graph.substitute(&source.nonholonomic, &still).into_iter().all(|driven| graph.is_zero(driven))
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
