//! The functions of a model that may be too narrow for a step, and the code that tells of them.
//!
//! The one idea: they are found when the model is made, so that a model without any never asks.

use crate::error::Result;
use crate::expressions::assembler::compile;
use crate::expressions::function::Function;
use crate::expressions::graph::{Dependence, Graph};
use crate::expressions::narrow::{self, Kind, is_smooth};
use crate::expressions::program::{LinearSystem, Output, roots};
use crate::expressions::{Code, Id, Node};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// What the ends of a step tell of an argument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum AtEnds {
    /// Where functions of it fade, if it stays within their hull.
    Fades(Fades),
    /// That nothing happens as long as it grows or shrinks by no large factor: of what goes with this power of its inverse.
    Power(f64),
    /// That nothing happens as long as it stays on one side of zero: of absolute values of it. It may be smooth itself.
    Side { is_smooth: bool },
}

impl AtEnds {
    /// The most that an argument is to move between two places where a method looks, which is so much of others.
    pub(super) fn reach(self, reach: f64) -> f64 {
        match self {
            Self::Power(_) => reach.min(REACH_OF_POWERS),
            Self::Fades(_) | Self::Side { .. } => reach,
        }
    }
}

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

/// The most that the logarithm of what falls as a power may move between two places where a method looks: what of it is felt there
/// falls less fast than an exponential function, and what it is where it is greatest may be anything beside it.
pub(super) const REACH_OF_POWERS: f64 = 3.0;

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

/// Equations of motion, as expressions.
#[derive(Debug)]
pub struct Equations<'a> {
    /// The graph that has them.
    pub graph: &'a mut Graph,
    /// Numbers of a state.
    pub numbers: usize,
    /// Parameters.
    pub parameters: usize,
    /// The systems of linear equations that the rates hang on.
    pub systems: &'a [LinearSystem],
    /// The rates of all numbers of a state, or of the last of them.
    pub rates: &'a [Output],
}

/// The functions of equations that may be too narrow for a step.
#[derive(Debug)]
pub struct Features {
    /// Where functions of each argument fade.
    pub(super) fades: Vec<Fades>,
    /// What the ends of a step tell of each.
    pub(super) at_ends: Vec<AtEnds>,
    /// Whether rates are sums of products with functions of each argument, of those that fade on either side of it, and what the
    /// ends of a step tell of it is all.
    pub(super) plain: Vec<bool>,
    /// Whether all arguments move as steadily as the time.
    pub(super) steady: bool,
    /// How what may be narrow depends on its argument, and which that is.
    pub(super) kinds: Vec<Kind>,
    pub(super) owners: Vec<usize>,
    /// The arguments, and how fast they move, of a state and its rates; of what falls as a power, that of which.
    pub(super) ends: Arc<Code>,
    /// The arguments and the functions, of a state; of what falls as a power, its logarithm.
    pub(super) values: Arc<Code>,
    /// The right-hand side of a state and the values of all functions but absolute values, which follow from theirs.
    pub(super) rates: Arc<Code>,
    /// The same, of all functions, where there are absolute values.
    pub(super) sided: Option<Arc<Code>>,
}

impl Features {
    /// Whether an absolute value is that of an argument.
    pub(super) fn has_absolute(&self, argument: usize) -> bool {
        self.kinds_of(argument).any(|kind| kind == Kind::Absolute)
    }

    /// Whether anything else hangs on it.
    pub(super) fn has_others(&self, argument: usize) -> bool {
        self.kinds_of(argument).any(|kind| kind != Kind::Absolute)
    }

    fn kinds_of(&self, argument: usize) -> impl Iterator<Item = Kind> {
        let own = self.kinds.iter().zip(&self.owners).filter(move |(_, owner)| **owner == argument);
        own.map(|(&kind, _)| kind)
    }

    /// Of equations, if they have any.
    ///
    /// # Errors
    /// Expressions that are too large.
    pub fn of(mut of: Equations<'_>) -> Result<Option<Self>> {
        let roots = roots(of.systems, of.rates);
        let mut found = narrow::narrow(of.graph, &roots);
        // Where a velocity turns, as under dry friction, it is as small as anything: step controls know such corners.
        let velocities = of.numbers as u32 / 2;
        let turns = |argument: Id| {
            of.graph.any(&[argument], |node| matches!(node, Node::Variable(index) if *index >= velocities))
        };
        found.retain(|one| one.kind != Kind::Absolute || !turns(one.argument));
        if found.is_empty() {
            return Ok(None);
        }
        let mut arguments: Vec<Id> = found.iter().map(|one| one.argument).collect();
        arguments.sort_unstable();
        arguments.dedup();
        let owner = |one: &narrow::Narrow| arguments.binary_search(&one.argument).unwrap_or_default();
        let owners: Vec<usize> = found.iter().map(owner).collect();
        let kinds: Vec<Kind> = found.iter().map(|one| one.kind).collect();
        let of_argument = |index: usize| {
            let own = kinds.iter().zip(&owners).filter(move |(_, owner)| **owner == index);
            own.map(|(&kind, _)| kind)
        };
        let has = |index: usize, is: &dyn Fn(Function) -> bool| {
            of_argument(index).any(|kind| matches!(kind, Kind::Call(function) if is(function)))
        };
        let is_exp = |function| function == Function::Exp;
        let is_tanh = |function| matches!(function, Function::Tanh | Function::SechSquared);
        let turns = |function| matches!(function, Function::Sin | Function::Cos);
        let power = |index: usize| {
            let powers = of_argument(index).filter_map(|kind| match kind {
                Kind::Divided(power) => Some(power),
                Kind::Call(_) | Kind::Absolute => None,
            });
            let (count, most) =
                powers.fold((0, 0.0), |(n, most): (u32, f64), power| (n + 1, most.max(power)));
            // Several of one argument may be factors of each other; beside functions of it they tell no more than those.
            let power = if count > 1 { 2.0 * most } else { most };
            (count > 0 && !has(index, &|_| true)).then_some(power)
        };
        let fade = |index| match (has(index, &turns), has(index, &is_exp), power(index)) {
            (true, ..) => Fades::Nowhere,
            (_, true, _) | (.., Some(_)) => Fades::Below,
            _ => Fades::Beyond,
        };
        let fades: Vec<Fades> = (0..arguments.len()).map(fade).collect();
        let smooth = is_smooth(of.graph, &arguments);
        let is_absolute = |index: usize| of_argument(index).all(|kind| kind == Kind::Absolute);
        let at_ends = |index: usize| match power(index) {
            Some(power) => AtEnds::Power(power),
            None if is_absolute(index) => AtEnds::Side { is_smooth: smooth[index] },
            None if smooth[index] => AtEnds::Fades(fades[index]),
            None => AtEnds::Fades(Fades::Nowhere),
        };
        let at_ends: Vec<AtEnds> = (0..arguments.len()).map(at_ends).collect();
        let bent = bent(&of, &roots);
        let plainly = |kind| matches!(kind, Kind::Call(function) if is_exp(function) || is_tanh(function));
        let is_plain = |index: usize| {
            let mut own = found.iter().zip(&owners).filter(|(_, owner)| **owner == index);
            smooth[index] && own.all(|(one, _)| plainly(one.kind) && bent.binary_search(&one.node).is_err())
        };
        let plain: Vec<bool> = (0..arguments.len()).map(is_plain).collect();
        // tanh goes as the exponential function of twice its argument.
        let factor = |index| if has(index, &is_tanh) { 2.0 } else { 1.0 };
        let graph = &mut *of.graph;
        let scaled = |(index, argument): (usize, &Id)| graph.scale(factor(index), *argument);
        let arguments: Vec<Id> = arguments.iter().enumerate().map(scaled).collect();
        let followed = |(index, &argument): (usize, &Id)| match power(index) {
            Some(power) => {
                let square = graph.product(&[argument, argument]);
                let logarithm = graph.call(Function::Ln, square);
                graph.scale(-0.5 * power, logarithm)
            }
            None => argument,
        };
        let followed: Vec<Id> = arguments.iter().enumerate().map(followed).collect();
        let (numbers, parameters) = (of.numbers, of.parameters);
        let mut motion: FxHashMap<Id, Id> = FxHashMap::default();
        for index in 0..numbers as u32 {
            let rate = graph.variable(numbers as u32 + index);
            let _ = motion.insert(graph.variable(index), rate);
        }
        let _ = motion.insert(graph.time(), graph.constant(1.0));
        let moving = graph.tangent(&arguments, &motion);
        let steady = moving.iter().all(|&rate| graph.dependence(rate) <= Dependence::Parameters)
            && kinds.iter().all(|kind| matches!(kind, Kind::Call(_)));
        let nodes = |ids: &[Id]| ids.iter().copied().map(Output::Node).collect::<Vec<_>>();
        let of_ends = nodes(&[&arguments[..], &moving].concat());
        let nodes_found: Vec<Id> = found.iter().map(|one| one.node).collect();
        let of_values = nodes(&[&followed[..], &nodes_found].concat());
        let ends = compile(graph, (2 * numbers, parameters), &[], &of_ends)?;
        let values = compile(graph, (numbers, parameters), &[], &of_values)?;
        let others: Vec<Id> =
            found.iter().filter(|one| one.kind != Kind::Absolute).map(|one| one.node).collect();
        let rates = with_values(&mut of, &roots, &others)?;
        let sided = if others.len() < nodes_found.len() {
            Some(Arc::new(with_values(&mut of, &roots, &nodes_found)?))
        } else {
            None
        };
        let [ends, values, rates] = [ends, values, rates].map(Arc::new);
        Ok(Some(Self { fades, at_ends, plain, steady, kinds, owners, ends, values, rates, sided }))
    }
}

/// The right-hand side with the values of these calls as further numbers of the state.
fn with_values(equations: &mut Equations<'_>, roots: &[Id], calls: &[Id]) -> Result<Code> {
    let numbers = equations.numbers;
    let graph = &mut *equations.graph;
    let mut replaced: FxHashMap<Id, Id> = FxHashMap::default();
    for (index, &call) in calls.iter().enumerate() {
        let _ = replaced.insert(call, graph.variable((numbers + index) as u32));
    }
    let made: FxHashMap<Id, Id> = roots.iter().copied().zip(graph.substitute(roots, &replaced)).collect();
    let of = |id: &Id| made.get(id).copied().unwrap_or(*id);
    let systems: Vec<LinearSystem> = equations
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
    let rates: Vec<Output> = equations.rates.iter().map(rate).collect();
    compile(equations.graph, (numbers + calls.len(), equations.parameters), &systems, &rates)
}

/// What rates are anything but sums of products with: below functions, powers and divisors, and in matrices.
fn bent(equations: &Equations<'_>, roots: &[Id]) -> Vec<Id> {
    let graph = &*equations.graph;
    let mut below: Vec<Id> =
        equations.systems.iter().flat_map(|system| system.matrix.iter().flatten().copied()).collect();
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
