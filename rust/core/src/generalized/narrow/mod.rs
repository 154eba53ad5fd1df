//! What is too narrow for a step to see: smooth walls, bumps and pulses that lie between the places where a method looks.
//!
//! The one idea: what is algebraic tells of itself from afar, and a step control sees it; exp and what is written with it (tanh,
//! 1/cosh) may be nothing at two neighboring places and all that matters in between. But their arguments are seen everywhere: an
//! argument that moves by more than a little between two places is followed on the way ([`search`]), and where the function at
//! what it goes through changes the rates by what matters, the step is taken again, and ends before that.
//!
//! Of most steps the arguments at the ends and how fast they move there tell that nothing is to be followed.

mod ends;
mod search;
mod way;

use super::model::{Model, Source};
use super::run::Request;
use crate::error::{Error, Result};
use crate::expressions::assembler::compile;
use crate::expressions::function::Function;
use crate::expressions::graph::Dependence;
use crate::expressions::machine::Width;
use crate::expressions::program::{LinearSystem, Output};
use crate::expressions::{Code, Id, Node};
use crate::numerics::real::Mask;
use crate::ode::step_control::Controlled;
use crate::ode::system::{Form, Taken};
use ends::Ends;
use search::Search;
use std::collections::HashMap;
use std::sync::Arc;
use way::Way;

/// What ends a run with equal steps.
pub(super) const UNSEEN: &str = "a step went over a wall, a bump, a pulse or an oscillation that is narrower than the step, and felt nothing of it; \
    take a shorter dt, or leave dt out with a method that chooses its steps";

/// The most that an argument may move between two places where a method looks: a bump that is e⁻³ there is felt.
const REACH: f64 = 3.0;
/// The same of equal steps, which are as coarse as they were asked for.
const REACH_OF_EQUAL: f64 = 6.0;
/// The same of a series, which knows e²⁰ times what it begins with by its last coefficients.
const REACH_OF_SERIES: f64 = 20.0;
/// What may be unseen in equal steps, as a part of a number.
const UNSEEN_BY_EQUAL: f64 = 1e-3;
/// The least part of the reach by which arguments at the ends show that nothing is to be followed.
const SHARE: f64 = 0.5;

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
const BELOW: f64 = -746.0;
/// Where tanh of half the argument differs from ±1 by less than e⁻⁸⁰.
const BEYOND: f64 = 80.0;

impl Fades {
    /// Whether nothing changes where an argument stays within these.
    fn holds(self, least: f64, most: f64) -> bool {
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
    fades: Vec<Fades>,
    /// Whether all arguments move as steadily as the time.
    steady: bool,
    /// The argument of each function.
    owners: Vec<usize>,
    /// The arguments, and how fast they move, of a state and its rates.
    ends: Arc<Code>,
    /// The arguments and the functions, of a state.
    values: Arc<Code>,
    /// The right-hand side of a state and the functions' values.
    rates: Arc<Code>,
}

impl Features {
    /// Of a model, if it has any.
    ///
    /// # Errors
    /// Expressions that are too large.
    pub(super) fn of(model: &mut Model) -> Result<Option<Self>> {
        let roots = model.roots();
        let calls = calls(&model.source, &roots);
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
        let turns = |function| matches!(function, Function::Sin | Function::Cos);
        let fade = |index| match (of(index, &turns), of(index, &is_exp)) {
            (true, _) => Fades::Nowhere,
            (_, true) => Fades::Below,
            _ => Fades::Beyond,
        };
        let fades: Vec<Fades> = (0..arguments.len()).map(fade).collect();
        // tanh goes as the exponential function of twice its argument.
        let is_tanh = |function| matches!(function, Function::Tanh | Function::SechSquared);
        let factor = |index| if of(index, &is_tanh) { 2.0 } else { 1.0 };
        let graph = &mut model.source.graph;
        let scaled = |(index, argument): (usize, &Id)| graph.scale(factor(index), *argument);
        let arguments: Vec<Id> = arguments.iter().enumerate().map(scaled).collect();
        let (numbers, parameters) = (model.numbers, model.source.parameters);
        let mut motion: HashMap<Id, Id> = HashMap::new();
        for index in 0..numbers as u32 {
            let rate = graph.variable(numbers as u32 + index);
            let _ = motion.insert(graph.variable(index), rate);
        }
        let _ = motion.insert(graph.time(), graph.constant(1.0));
        let moving = graph.tangent(&arguments, &motion);
        let steady = moving.iter().all(|&rate| graph.dependence(rate) <= Dependence::Parameters);
        let nodes = |ids: &[Id]| ids.iter().copied().map(Output::Node).collect::<Vec<_>>();
        let of_ends = nodes(&[&arguments[..], &moving].concat());
        let functions: Vec<Id> = calls.iter().map(|&(_, call, _)| call).collect();
        let of_values = nodes(&[&arguments[..], &functions].concat());
        let ends = compile(graph, (2 * numbers, parameters), &[], &of_ends)?;
        let values = compile(graph, (numbers, parameters), &[], &of_values)?;
        let rates = with_values(model, &roots, &functions)?;
        let [ends, values, rates] = [ends, values, rates].map(Arc::new);
        Ok(Some(Self { fades, steady, owners, ends, values, rates }))
    }
}

/// The calls of functions like exp among these expressions, with their arguments, where those change on the way; and those of
/// sin and cos where the time alone changes them, as drives do: they may be faster than a step, and too weak for its errors.
fn calls(source: &Source, roots: &[Id]) -> Vec<(Function, Id, Id)> {
    let graph = &source.graph;
    let may_be_narrow = |id: Id| {
        let Node::Call(function, argument) = *graph.node(id) else { return None };
        let changes = graph.dependence(argument);
        let may = match function {
            Function::Exp | Function::Tanh | Function::SechSquared | Function::Sinh | Function::Cosh => {
                changes > Dependence::Parameters
            }
            Function::Sin | Function::Cos => changes == Dependence::Time,
            _ => false,
        };
        may.then_some((function, id, argument))
    };
    graph.reachable(roots).into_iter().filter_map(may_be_narrow).collect()
}

/// The right-hand side with the values of these calls as further numbers of the state.
fn with_values(model: &mut Model, roots: &[Id], calls: &[Id]) -> Result<Code> {
    let numbers = model.numbers;
    let graph = &mut model.source.graph;
    let mut replaced: HashMap<Id, Id> = HashMap::new();
    for (index, &call) in calls.iter().enumerate() {
        let _ = replaced.insert(call, graph.variable((numbers + index) as u32));
    }
    let made: HashMap<Id, Id> = roots.iter().copied().zip(graph.substitute(roots, &replaced)).collect();
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

/// Features under watch, of one trajectory or of eight.
#[derive(Debug)]
pub(super) struct Narrow<S> {
    of: Arc<Features>,
    form: Form,
    ends: Ends<S>,
    parameters: Vec<S>,
    /// The time at the start of the run.
    t0: f64,
    /// What may be unseen, as a part of a number.
    tolerance: f64,
    /// Whether steps are equal, and cannot be shorter.
    equal: bool,
    search: Option<Search>,
    /// The longest part of a step between two places where the method looks, and how fast arguments move in it at most, if all
    /// of them do so steadily.
    gap: Option<f64>,
    fastest: S,
}

impl<S: Width + Controlled> Narrow<S> {
    /// Of a run with these parameters.
    pub(super) fn new(of: &Arc<Features>, form: Form, request: &Request, parameters: &[S]) -> Self {
        let equal = request.dt.is_some();
        let mut narrow = Self {
            of: of.clone(),
            form,
            ends: Ends::new(form, &of.ends, parameters),
            parameters: parameters.to_vec(),
            t0: request.span.0,
            tolerance: if equal { UNSEEN_BY_EQUAL } else { request.rtol },
            equal,
            search: None,
            gap: None,
            fastest: S::zero(),
        };
        narrow.set_parameters(parameters);
        narrow
    }

    /// With other parameters from now on.
    pub(super) fn set_parameters(&mut self, parameters: &[S]) {
        self.parameters.copy_from_slice(parameters);
        self.ends.set_parameters(parameters);
        if self.of.steady {
            self.fastest = self.ends.fastest();
        }
    }

    /// How far an argument may move between two places where a step looks.
    fn reach(&self, step: &Taken<'_, S>) -> f64 {
        match (self.equal, step.series) {
            (true, _) => REACH_OF_EQUAL,
            (_, true) => REACH_OF_SERIES,
            _ => REACH,
        }
    }

    /// [`System::seen_until`](crate::ode::system::System::seen_until).
    ///
    /// # Errors
    /// [`Error::Convergence`] of one trajectory with equal steps.
    pub(super) fn seen_until(&mut self, step: &Taken<'_, S>) -> Result<Option<S>> {
        if !self.of.steady {
            return self.followed(step);
        }
        let gap = *self.gap.get_or_insert_with(|| longest_gap(step));
        let moves_little = (self.fastest * step.h.abs()).less_equal(S::splat(self.reach(step) / gap));
        let asked = step.asked.and(moves_little.not());
        if asked.any() { self.followed(&Taken { asked, ..*step }) } else { Ok(None) }
    }

    /// The same, of arguments that may move by much.
    fn followed(&mut self, step: &Taken<'_, S>) -> Result<Option<S>> {
        let little = SHARE * self.reach(step);
        let Some(told) = self.ends.tell(step, self.t0, little, &self.of.fades) else { return Ok(None) };
        let (told, mut seen) = (S::select(step.asked, told, S::one()), S::one());
        for lane in (0..S::LANES).filter(|&lane| told.lane(lane) == 0.0) {
            let way = Way::of(self.form, step, lane, self.t0);
            let parameters: Vec<f64> = self.parameters.iter().map(|value| value.lane(lane)).collect();
            let (of, reach) = (&self.of, self.reach(step));
            let search = self.search.get_or_insert_with(|| Search::new(of));
            let part = search.seen_until(&parameters, way, reach, self.tolerance);
            seen = seen.with_lane(lane, part);
        }
        if !seen.less(S::one()).any() {
            return Ok(None);
        }
        if self.equal && S::LANES == 1 {
            return Err(Error::Convergence { message: UNSEEN.to_owned(), time: self.t0 + step.from.lane(0) });
        }
        Ok(Some(seen))
    }
}

/// The longest part of a step between two places where the method looks.
fn longest_gap<S: Controlled>(step: &Taken<'_, S>) -> f64 {
    if step.series {
        return 1.0;
    }
    let mut nodes: Vec<f64> = step.nodes.iter().copied().chain([0.0, 1.0]).collect();
    nodes.sort_by(f64::total_cmp);
    nodes.windows(2).map(|two| two[1] - two[0]).fold(0.0, f64::max)
}
