//! The functions of a model that may be too narrow for a step, and the code that tells of them.
//!
//! The one idea: they are found when the model is made, so that a model without any never asks.

use crate::error::Result;
use crate::expressions::assembler::compile;
use crate::expressions::function::Function;
use crate::expressions::graph::Dependence;
use crate::expressions::narrow::calls;
use crate::expressions::program::{LinearSystem, Output};
use crate::expressions::{Code, Id, Node};
use crate::generalized::model::Model;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Where a function of an argument is as good as constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fades {
    /// Below [`BELOW`]: exp.
    Below,
    /// Beyond [`BEYOND`] on either side.
    Beyond,
    /// Nowhere: sin and cos.
    Nowhere,
}

/// Where exp is 0.
pub(super) const BELOW: f64 = -746.0;
/// Where tanh of half the argument differs from ±1 by less than e⁻⁸⁰.
pub(super) const BEYOND: f64 = 80.0;

impl Fades {
    /// Whether nothing changes where an argument stays within these.
    pub(super) fn holds(self, least: f64, most: f64) -> bool {
        match self {
            Self::Below => most < BELOW,
            Self::Beyond => most < -BEYOND || least > BEYOND,
            Self::Nowhere => false,
        }
    }
}

/// The functions of a model that may be too narrow for a step.
#[derive(Debug)]
pub struct Features {
    /// Where functions of each argument fade.
    pub(super) fades: Vec<Fades>,
    /// Whether rates are sums of products with functions of each argument, and with those that fade on either side of it.
    pub(super) plain: Vec<bool>,
    /// Whether all arguments move as steadily as the time.
    pub(super) steady: bool,
    /// The functions, and the argument of each.
    pub(super) functions: Vec<Function>,
    pub(super) owners: Vec<usize>,
    /// The arguments, and how fast they move, of a state and its rates.
    pub(super) ends: Arc<Code>,
    /// The arguments and the functions, of a state.
    pub(super) values: Arc<Code>,
    /// The right-hand side of a state and the functions' values.
    pub(super) rates: Arc<Code>,
}

impl Features {
    /// Of a model, if it has any.
    ///
    /// # Errors
    /// Expressions that are too large.
    pub(in crate::generalized) fn of(model: &mut Model) -> Result<Option<Self>> {
        let roots = model.roots();
        let calls = calls(&model.source.graph, &roots);
        if calls.is_empty() {
            return Ok(None);
        }
        let mut arguments: Vec<Id> = calls.iter().map(|&(.., argument)| argument).collect();
        arguments.sort_unstable();
        arguments.dedup();
        let owner = |argument: &Id| arguments.binary_search(argument).unwrap_or_default();
        let owners: Vec<usize> = calls.iter().map(|(.., argument)| owner(argument)).collect();
        let of = |index: usize, is: &dyn Fn(Function) -> bool| {
            calls.iter().zip(&owners).any(|((function, ..), owner)| *owner == index && is(*function))
        };
        let is_exp = |function| function == Function::Exp;
        let is_tanh = |function| matches!(function, Function::Tanh | Function::SechSquared);
        let turns = |function| matches!(function, Function::Sin | Function::Cos);
        let fade = |index| match (of(index, &turns), of(index, &is_exp)) {
            (true, _) => Fades::Nowhere,
            (_, true) => Fades::Below,
            _ => Fades::Beyond,
        };
        let fades: Vec<Fades> = (0..arguments.len()).map(fade).collect();
        let bent = bent(model, &roots);
        let plainly = |function| is_exp(function) || is_tanh(function);
        let is_plain = |index: usize| {
            let mut own = calls.iter().zip(&owners).filter(|(_, owner)| **owner == index);
            own.all(|((function, call, _), _)| plainly(*function) && bent.binary_search(call).is_err())
        };
        let plain: Vec<bool> = (0..arguments.len()).map(is_plain).collect();
        // tanh goes as the exponential function of twice its argument.
        let factor = |index| if of(index, &is_tanh) { 2.0 } else { 1.0 };
        let graph = &mut model.source.graph;
        let scaled = |(index, argument): (usize, &Id)| graph.scale(factor(index), *argument);
        let arguments: Vec<Id> = arguments.iter().enumerate().map(scaled).collect();
        let (numbers, parameters) = (model.numbers, model.source.parameters);
        let mut motion: FxHashMap<Id, Id> = FxHashMap::default();
        for index in 0..numbers as u32 {
            let rate = graph.variable(numbers as u32 + index);
            let _ = motion.insert(graph.variable(index), rate);
        }
        let _ = motion.insert(graph.time(), graph.constant(1.0));
        let moving = graph.tangent(&arguments, &motion);
        let steady = moving.iter().all(|&rate| graph.dependence(rate) <= Dependence::Parameters);
        let nodes = |ids: &[Id]| ids.iter().copied().map(Output::Node).collect::<Vec<_>>();
        let of_ends = nodes(&[&arguments[..], &moving].concat());
        let calls: (Vec<Function>, Vec<Id>) =
            calls.iter().map(|&(function, call, _)| (function, call)).unzip();
        let of_values = nodes(&[&arguments[..], &calls.1].concat());
        let ends = compile(graph, (2 * numbers, parameters), &[], &of_ends)?;
        let values = compile(graph, (numbers, parameters), &[], &of_values)?;
        let rates = with_values(model, &roots, &calls.1)?;
        let [ends, values, rates] = [ends, values, rates].map(Arc::new);
        let functions = calls.0;
        Ok(Some(Self { fades, plain, steady, functions, owners, ends, values, rates }))
    }
}

/// The right-hand side with the values of these calls as further numbers of the state.
fn with_values(model: &mut Model, roots: &[Id], calls: &[Id]) -> Result<Code> {
    let numbers = model.numbers;
    let graph = &mut model.source.graph;
    let mut replaced: FxHashMap<Id, Id> = FxHashMap::default();
    for (index, &call) in calls.iter().enumerate() {
        let _ = replaced.insert(call, graph.variable((numbers + index) as u32));
    }
    let made: FxHashMap<Id, Id> = roots.iter().copied().zip(graph.substitute(roots, &replaced)).collect();
    let of = |id: &Id| made.get(id).copied().unwrap_or(*id);
    let systems: Vec<LinearSystem> = model
        .systems
        .iter()
        .map(|system| LinearSystem {
            matrix: system.matrix.iter().map(|row| row.iter().map(of).collect()).collect(),
            right: system.right.iter().map(of).collect(),
            inner: system.inner,
        })
        .collect();
    let rate = |rate: &Output| match rate {
        Output::Node(id) => Output::Node(of(id)),
        Output::Unknown(index) => Output::Unknown(*index),
    };
    let rates: Vec<Output> = model.rates.iter().map(rate).collect();
    compile(&model.source.graph, (numbers + calls.len(), model.source.parameters), &systems, &rates)
}

/// What rates are anything but sums of products with: below functions, powers and divisors, and in matrices.
fn bent(model: &Model, roots: &[Id]) -> Vec<Id> {
    let graph = &model.source.graph;
    let mut below: Vec<Id> =
        model.systems.iter().flat_map(|system| system.matrix.iter().flatten().copied()).collect();
    for id in graph.reachable(roots) {
        match *graph.node(id) {
            Node::Quotient(_, divisor) => below.push(divisor),
            Node::Call(_, argument) | Node::Power(argument, _) => below.push(argument),
            Node::Angle(y, x) => below.extend([y, x]),
            _ => {}
        }
    }
    graph.reachable(&below)
}
