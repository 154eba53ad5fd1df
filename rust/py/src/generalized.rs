//! Lagrangians and Hamiltonians: nodes of expressions in, equations, runs and expressions out.
//!
//! A node is `(operation, arguments, value)`, its arguments numbers of nodes before it; `visviva.generalized` makes them of
//! SymPy's trees and makes trees of them again.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use visviva_core::expressions::function::Function;
use visviva_core::expressions::graph::{Graph, Id, Node, number};
use visviva_core::expressions::program::Output;
use visviva_core::generalized::evaluate;
use visviva_core::generalized::gauss;
use visviva_core::generalized::legendre;
use visviva_core::generalized::linear::{Linear, modes};
use visviva_core::generalized::one_freedom::OneFreedom;
use visviva_core::generalized::run::{Integrator, Request, Section, Solution, solve};
use visviva_core::generalized::structure::{MassMatrix, Structure};
use visviva_core::generalized::variation::variational;
use visviva_core::generalized::{Kind, Model, Source};
use visviva_core::ode::run::Ending;
use visviva_core::parallel::{for_chunks, thread_count};
use visviva_core::registry;
use visviva_core::{Error, Result};

type Array<'py> = PyReadonlyArrayDyn<'py, f64>;
type Column<'py> = Bound<'py, PyArrayDyn<f64>>;
type NodeParts = (String, Vec<u32>, f64);

/// Adds nodes to a graph; their numbers in it.
fn added(graph: &mut Graph, nodes: &[NodeParts]) -> Result<Vec<Id>> {
    let mut ids: Vec<Id> = Vec::with_capacity(nodes.len());
    for (operation, arguments, value) in nodes {
        let of = |index: usize| {
            let argument = arguments.get(index).copied().map(|argument| argument as usize);
            argument
                .and_then(|argument| ids.get(argument).copied())
                .ok_or_else(|| Error::Internal(format!("{operation} lacks its argument {index}")))
        };
        let all = || (0..arguments.len()).map(of).collect::<Result<Vec<Id>>>();
        let id = match operation.as_str() {
            "constant" => graph.constant(*value),
            "variable" => graph.variable(*value as u32),
            "parameter" => graph.parameter(*value as u32),
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
            "power" => {
                let (a, b) = (of(0)?, of(1)?);
                graph.general_power(a, b)
            }
            name => {
                let function =
                    Function::named(name).ok_or_else(|| Error::Internal(format!("no operation {name}")))?;
                let a = of(0)?;
                graph.call(function, a)
            }
        };
        ids.push(id);
    }
    Ok(ids)
}

fn chosen(ids: &[Id], index: u32) -> Result<Id> {
    ids.get(index as usize).copied().ok_or_else(|| Error::Internal(format!("no node {index}")))
}

fn all_chosen(ids: &[Id], indices: &[u32]) -> Result<Vec<Id>> {
    indices.iter().map(|&index| chosen(ids, index)).collect()
}

/// Nodes of a graph as they came in, and the places of the roots among them.
fn shown(graph: &Graph, roots: &[Id]) -> (Vec<NodeParts>, Vec<u32>) {
    let mut places = std::collections::HashMap::new();
    let mut nodes: Vec<NodeParts> = Vec::new();
    let push = |nodes: &mut Vec<NodeParts>, operation: &str, arguments: Vec<u32>, value: f64| {
        nodes.push((operation.to_owned(), arguments, value));
        (nodes.len() - 1) as u32
    };
    for id in graph.reachable(roots) {
        let at = |id: &Id| places.get(id).copied().unwrap_or(0);
        let place = match graph.node(id) {
            Node::Constant(value) => push(&mut nodes, "constant", vec![], number(*value)),
            Node::Variable(index) => push(&mut nodes, "variable", vec![], f64::from(*index)),
            Node::Parameter(index) => push(&mut nodes, "parameter", vec![], f64::from(*index)),
            Node::Time => push(&mut nodes, "time", vec![], 0.0),
            Node::Sum(constant, terms) => {
                let mut arguments = Vec::new();
                if number(*constant) != 0.0 {
                    arguments.push(push(&mut nodes, "constant", vec![], number(*constant)));
                }
                for (coefficient, term) in terms {
                    let term = at(term);
                    if number(*coefficient) == 1.0 {
                        arguments.push(term);
                    } else {
                        let factor = push(&mut nodes, "constant", vec![], number(*coefficient));
                        arguments.push(push(&mut nodes, "product", vec![factor, term], 0.0));
                    }
                }
                push(&mut nodes, "sum", arguments, 0.0)
            }
            Node::Product(a, b) => push(&mut nodes, "product", vec![at(a), at(b)], 0.0),
            Node::Quotient(a, b) => push(&mut nodes, "quotient", vec![at(a), at(b)], 0.0),
            Node::Call(function, a) => push(&mut nodes, function.name(), vec![at(a)], 0.0),
            Node::Power(a, exponent) => {
                let base = at(a);
                let exponent = push(&mut nodes, "constant", vec![], number(*exponent));
                push(&mut nodes, "power", vec![base, exponent], 0.0)
            }
        };
        let _ = places.insert(id, place);
    }
    let roots = roots.iter().map(|id| places.get(id).copied().unwrap_or(0)).collect();
    (nodes, roots)
}

/// A system in generalized coordinates.
#[pyclass(frozen, module = "visviva._core")]
pub(crate) struct GeneralizedModel {
    model: Arc<Model>,
    structure: Structure,
}

/// What a system is made of.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Described {
    kind: String,
    coordinates: usize,
    parameters: usize,
    nodes: Vec<NodeParts>,
    function: u32,
    forces: Vec<u32>,
    dissipation: Option<u32>,
    holonomic: Vec<u32>,
    nonholonomic: Vec<u32>,
}

impl Described {
    fn source(&self) -> Result<Source> {
        let mut graph = Graph::default();
        let ids = added(&mut graph, &self.nodes)?;
        let kind = if self.kind == "hamiltonian" { Kind::Hamiltonian } else { Kind::Lagrangian };
        Ok(Source {
            graph,
            kind,
            coordinates: self.coordinates,
            parameters: self.parameters,
            function: chosen(&ids, self.function)?,
            forces: all_chosen(&ids, &self.forces)?,
            dissipation: self.dissipation.map(|index| chosen(&ids, index)).transpose()?,
            holonomic: all_chosen(&ids, &self.holonomic)?,
            nonholonomic: all_chosen(&ids, &self.nonholonomic)?,
        })
    }
}

impl GeneralizedModel {
    fn of(model: Model) -> Self {
        Self { structure: Structure::of(&model), model: Arc::new(model) }
    }

    /// One that further expressions may join.
    fn copy(&self) -> Model {
        (*self.model).clone()
    }
}

#[pymethods]
impl GeneralizedModel {
    /// Derives the equations of motion.
    #[new]
    fn new(py: Python<'_>, described: Described) -> PyResult<Self> {
        let model = compute(py, 0, None, |_| Model::new(described.source()?))?.whole(py)?;
        Ok(Self::of(model))
    }

    /// What is found without running it.
    fn structure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = &self.structure;
        let result = PyDict::new(py);
        result.set_item("cyclic", &found.cyclic)?;
        result.set_item("autonomous", found.autonomous)?;
        result.set_item("conserves_energy", found.conserves_energy)?;
        let mass = match found.mass {
            MassMatrix::Constant => "constant",
            MassMatrix::Diagonal => "diagonal",
            MassMatrix::Blocks => "blocks",
            MassMatrix::Full => "full",
            MassMatrix::None => "none",
        };
        result.set_item("mass_matrix", mass)?;
        result.set_item("separable", found.separable)?;
        result.set_item("operations", found.operations)?;
        Ok(result)
    }

    /// Expressions by name, as nodes and their places: `accelerations` with a linear system has `mass_matrix` and `right`.
    fn expressions(&self, py: Python<'_>, name: &str) -> PyResult<(Vec<NodeParts>, Vec<u32>)> {
        let model = &*self.model;
        let roots: Vec<Id> = match name {
            "function" => vec![model.source.function],
            "conjugates" => model.conjugates.clone(),
            "slopes" => model.slopes.clone(),
            "energy" => vec![model.energy],
            "mass_matrix" => model.mass.iter().flatten().copied().collect(),
            "rates" => {
                let nodes = model.rates.iter().filter_map(|rate| match rate {
                    Output::Node(id) => Some(*id),
                    Output::Unknown(_) => None,
                });
                nodes.collect()
            }
            _ => return Err(raised(py, Error::Internal(format!("no expressions {name}")))),
        };
        Ok(shown(&model.source.graph, &roots))
    }

    /// The Poisson bracket {f, g} of two of these nodes, as nodes.
    fn poisson(
        &self,
        py: Python<'_>,
        nodes: Vec<NodeParts>,
        roots: (u32, u32),
    ) -> PyResult<(Vec<NodeParts>, Vec<u32>)> {
        let mut source = self.model.source.clone();
        let mut bracket = || {
            let ids = added(&mut source.graph, &nodes)?;
            let (f, g) = (chosen(&ids, roots.0)?, chosen(&ids, roots.1)?);
            Ok(source.poisson(f, g))
        };
        let bracket = bracket().map_err(|error| raised(py, error))?;
        Ok(shown(&source.graph, &[bracket]))
    }

    /// Expressions at states (N, 2n) and times (N).
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        nodes: Vec<NodeParts>,
        roots: Vec<u32>,
        t: Array<'py>,
        states: Array<'py>,
        parameters: Array<'py>,
    ) -> PyResult<Column<'py>> {
        let mut model = self.copy();
        let mut code = || {
            let ids = added(&mut model.source.graph, &nodes)?;
            model.function(&all_chosen(&ids, &roots)?)
        };
        let code = code().map_err(|error| raised(py, error))?;
        rows(py, &Arc::new(code), t, states, parameters)
    }

    /// Conjugates (n), energy and multipliers at states (N, 2n) and times (N).
    fn columns<'py>(
        &self,
        py: Python<'py>,
        t: Array<'py>,
        states: Array<'py>,
        parameters: Array<'py>,
    ) -> PyResult<Column<'py>> {
        let code = self.model.columns.clone();
        rows(py, &code, t, states, parameters)
    }

    /// Rates (of the second order: accelerations) at states (N, 2n) and times (N).
    fn rates<'py>(
        &self,
        py: Python<'py>,
        t: Array<'py>,
        states: Array<'py>,
        parameters: Array<'py>,
    ) -> PyResult<Column<'py>> {
        let code = self.model.code.clone();
        rows(py, &code, t, states, parameters)
    }

    /// The residuals of constraints at a state, of places and of velocities, and the nearest state on them.
    fn projected<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        state: Array<'py>,
        parameters: Array<'py>,
    ) -> PyResult<(Vec<f64>, Vec<f64>, Column<'py>)> {
        let model = self.copy();
        let (mut state, _) = copied("state", &state, [Some(model.numbers())])?;
        let (parameters, _) = copied("parameters", &parameters, [Some(model.source.parameters)])?;
        let (places, velocities) = match &model.projection {
            None => (vec![], vec![]),
            Some(projection) => {
                let mut projector = projection.at_work(&parameters);
                if let Some((one, others)) = projector.dependent(t, &state) {
                    return Err(raised(py, dependent(one, &others)));
                }
                let residuals = projector.residuals(t, &state);
                let mut rest = vec![0.0; state.len()];
                projector.project(t, &mut state, &mut rest, true).map_err(|error| raised(py, error))?;
                residuals
            }
        };
        let length = state.len();
        Ok((places, velocities, moved(py, state, &[length])?))
    }

    /// The equilibria that Newton's method reaches from starts (S, n), `None` where it reaches none.
    fn equilibria(
        &self,
        py: Python<'_>,
        t: f64,
        starts: Array<'_>,
        parameters: Array<'_>,
    ) -> PyResult<Vec<Option<Vec<f64>>>> {
        let mut model = self.copy();
        let n = model.source.coordinates;
        let (starts, _) = copied("position", &starts, [None, Some(n)])?;
        let (parameters, _) = copied("parameters", &parameters, [Some(model.source.parameters)])?;
        compute(py, 0, None, |ticker| {
            let linear = Linear::new(&mut model)?;
            let find = |start: &[f64]| {
                ticker.tick()?;
                Ok(linear.equilibrium(t, start, &parameters))
            };
            starts.chunks(n).map(find).collect::<Result<Vec<_>>>()
        })?
        .whole(py)
    }

    /// M, C, K and F of small motions about a place at rest; eigenvalues, squared frequencies and modes.
    fn linearized<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        position: Array<'py>,
        parameters: Array<'py>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mut model = self.copy();
        let n = model.source.coordinates;
        let (position, _) = copied("position", &position, [Some(n)])?;
        let (parameters, _) = copied("parameters", &parameters, [Some(model.source.parameters)])?;
        let (at, found) = compute(py, 0, None, |_| {
            let at = Linear::new(&mut model)?.matrices(t, &position, &parameters);
            let found = modes(&at, n)?;
            Ok((at, found))
        })?
        .whole(py)?;
        let result = PyDict::new(py);
        result.set_item("mass", moved(py, at.mass, &[n, n])?)?;
        result.set_item("damping", moved(py, at.damping, &[n, n])?)?;
        result.set_item("stiffness", moved(py, at.stiffness, &[n, n])?)?;
        result.set_item("forces", moved(py, at.forces, &[n])?)?;
        result.set_item("eigenvalues", found.eigenvalues)?;
        result.set_item(
            "symmetric",
            match found.symmetric {
                None => None,
                Some((squares, modes)) => Some((moved(py, squares, &[n])?, moved(py, modes, &[n, n])?)),
            },
        )?;
        Ok(result)
    }

    /// Of one coordinate: turning points, period and action of the oscillation; with a turn, (period, action) of a rotation.
    fn oscillation(
        &self,
        py: Python<'_>,
        t: f64,
        state: Array<'_>,
        parameters: Array<'_>,
        turn: Option<f64>,
    ) -> PyResult<(f64, f64, f64, f64)> {
        let mut model = self.copy();
        let (state, _) = copied("state", &state, [Some(model.numbers())])?;
        let (parameters, _) = copied("parameters", &parameters, [Some(model.source.parameters)])?;
        compute(py, 0, None, |_| {
            let mut of = OneFreedom::new(&mut model, &state, &parameters, t)?;
            if let Some(turn) = turn {
                let [period, action] = of.rotation(turn)?;
                return Ok((f64::NAN, f64::NAN, period, action));
            }
            let found = of.oscillation()?;
            Ok((found.turning.0, found.turning.1, found.period, found.action))
        })?
        .whole(py)
    }

    /// Legendre's transform: nodes; the function, then the forces.
    fn legendre(&self, py: Python<'_>) -> PyResult<(Vec<NodeParts>, Vec<u32>)> {
        let source = legendre::transformed(&self.model.source).map_err(|error| raised(py, error))?;
        let roots: Vec<Id> = [source.function].into_iter().chain(source.forces.iter().copied()).collect();
        Ok(shown(&source.graph, &roots))
    }

    /// A Lagrangian's parts of second, first and no degree in the velocities.
    fn by_degree(&self) -> (Vec<NodeParts>, Vec<u32>) {
        let mut source = self.model.source.clone();
        let roots = legendre::by_degree(&mut source);
        shown(&source.graph, &roots)
    }

    /// Routh's function without these coordinates: nodes; the function, then the velocities of those coordinates.
    fn routhian(&self, py: Python<'_>, cyclic: Vec<usize>) -> PyResult<(Vec<NodeParts>, Vec<u32>)> {
        let reduced = legendre::routhian(&self.model.source, &cyclic);
        let (source, velocities) = reduced.map_err(|error| raised(py, error))?;
        let roots: Vec<Id> = [source.function].into_iter().chain(velocities).collect();
        Ok(shown(&source.graph, &roots))
    }

    /// The same system with the flow's derivatives in its state.
    fn variational(&self, py: Python<'_>) -> PyResult<Self> {
        let model = self.copy();
        let model = compute(py, 0, None, |_| variational(&model))?.whole(py)?;
        Ok(Self::of(model))
    }

    /// Runs states (B, 2n) with parameters (B, p) from a time to another.
    #[pyo3(signature = (asked, states, parameters, threads, progress))]
    fn run<'py>(
        &self,
        py: Python<'py>,
        asked: Asked<'py>,
        states: Array<'py>,
        parameters: Array<'py>,
        threads: Option<i64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let model = &*self.model;
        let (states, [members, _]) = copied("states", &states, [None, Some(model.numbers())])?;
        let (parameters, _) =
            copied("parameters", &parameters, [Some(members), Some(model.source.parameters)])?;
        let request = asked.request(py, self)?;
        let threads = thread_count(threads).map_err(|error| raised(py, error))?;
        let (numbers, count) = (model.numbers(), model.source.parameters);
        let worked = compute(py, members as u64, progress.as_ref(), |ticker| {
            for_chunks(threads, members, ticker, |member, ticker| {
                let of = |all: &[f64], width: usize| {
                    all.get(member * width..(member + 1) * width).map(<[f64]>::to_vec)
                };
                let (state, own) =
                    (of(&states, numbers).unwrap_or_default(), of(&parameters, count).unwrap_or_default());
                let outcome = solve(model, &request, (&state, &own), ticker);
                ticker.advance(1);
                outcome
            })
        })?;
        let (solutions, interrupted) = worked.partial(py)?;
        let result = collected(py, &solutions, numbers)?;
        result.set_item("interrupted", interrupted)?;
        Ok(result)
    }
}

/// What is asked of a run.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Asked<'py> {
    method: String,
    span: (f64, f64),
    rtol: f64,
    dt: Option<f64>,
    max_step: Option<f64>,
    max_steps: u64,
    outputs: Option<Array<'py>>,
    /// Nodes, a root among them, and a direction: whose zeros are wanted.
    section: Option<(Vec<NodeParts>, u32, f64)>,
}

impl Asked<'_> {
    fn request(&self, py: Python<'_>, of: &GeneralizedModel) -> PyResult<Request> {
        let integrator =
            match gauss::method(&self.method) {
                Some(method) => Integrator::Gauss(method),
                None => Integrator::Table(registry::method(&self.method).ok_or_else(|| {
                    raised(py, Error::invalid("method", format!("no method {}", self.method)))
                })?),
            };
        let outputs = self.outputs.as_ref().map(|t| PyResult::Ok(copied("t", t, [None])?.0)).transpose()?;
        let section = self.section.as_ref().map(|(nodes, root, direction)| {
            let mut model = of.copy();
            let ids = added(&mut model.source.graph, nodes)?;
            let code = Arc::new(model.function(&[chosen(&ids, *root)?])?);
            Ok(Section { code, direction: *direction })
        });
        let section = section.transpose().map_err(|error| raised(py, error))?;
        Ok(Request {
            section,
            integrator,
            span: self.span,
            rtol: self.rtol,
            dt: self.dt,
            max_step: self.max_step,
            max_steps: self.max_steps,
            outputs,
            held: of.structure.conserves_energy,
        })
    }
}

/// Constraints that do not leave the multipliers determined.
fn dependent(one: usize, others: &[usize]) -> Error {
    let words = match others {
        [] => format!("constraint {one} has no gradient at the start; start elsewhere"),
        [other] => format!("constraints {other} and {one} are dependent at the start; leave one out"),
        _ => {
            let names: Vec<String> = others.iter().map(usize::to_string).collect();
            format!(
                "constraint {one} follows from constraints {} at the start; leave one out",
                names.join(", ")
            )
        }
    };
    Error::invalid("constraints", words)
}

/// The results of a code, row by row.
fn rows<'py>(
    py: Python<'py>,
    code: &Arc<visviva_core::expressions::Code>,
    t: Array<'py>,
    states: Array<'py>,
    parameters: Array<'py>,
) -> PyResult<Column<'py>> {
    let (t, [count]) = copied("t", &t, [None])?;
    let (states, _) = copied("states", &states, [Some(count), Some(code.variables())])?;
    let (parameters, [sets, _]) = copied("parameters", &parameters, [None, Some(code.parameters())])?;
    let own = sets != 1;
    if own && sets != count {
        return Err(raised(py, Error::Internal(format!("{sets} sets of parameters for {count} rows"))));
    }
    let found =
        compute(py, 0, None, |_| Ok(evaluate::rows(code, (&t, &states), &parameters, own)))?.whole(py)?;
    moved(py, found, &[count, code.outputs()])
}

/// Solutions as columns, member after member.
fn collected<'py>(py: Python<'py>, solutions: &[Solution], numbers: usize) -> PyResult<Bound<'py, PyDict>> {
    let result = PyDict::new(py);
    let lengths: Vec<usize> = solutions.iter().map(|solution| solution.t.len()).collect();
    let t: Vec<f64> = solutions.iter().flat_map(|solution| solution.t.iter().copied()).collect();
    let y: Vec<f64> = solutions.iter().flat_map(|solution| solution.y.iter().copied()).collect();
    let rows = t.len();
    let crossings: Vec<usize> = solutions.iter().map(|solution| solution.crossings.t.len()).collect();
    let at: Vec<f64> = solutions.iter().flat_map(|solution| solution.crossings.t.iter().copied()).collect();
    let there: Vec<f64> =
        solutions.iter().flat_map(|solution| solution.crossings.y.iter().copied()).collect();
    let found = at.len();
    result.set_item("crossings", crossings)?;
    result.set_item("crossing_times", moved(py, at, &[found])?)?;
    result.set_item("crossing_states", moved(py, there, &[found, numbers])?)?;
    result.set_item("lengths", lengths)?;
    result.set_item("t", moved(py, t, &[rows])?)?;
    result.set_item("y", moved(py, y, &[rows, numbers])?)?;
    let endings: Vec<&str> = solutions
        .iter()
        .map(|solution| match solution.ending {
            Ending::Finished | Ending::Stopped => "finished",
            Ending::StepTooSmall => "step too small",
            Ending::NotFinite => "not finite",
            Ending::Interrupted => "interrupted",
        })
        .collect();
    result.set_item("endings", endings)?;
    let failures: Vec<Option<&str>> = solutions.iter().map(|solution| solution.failure.as_deref()).collect();
    result.set_item("failures", failures)?;
    result.set_item("reached", solutions.iter().map(|solution| solution.reached).collect::<Vec<_>>())?;
    result.set_item("steps", solutions.iter().map(|solution| solution.steps).collect::<Vec<_>>())?;
    result
        .set_item("evaluations", solutions.iter().map(|solution| solution.evaluations).collect::<Vec<_>>())?;
    result.set_item("longest_step", solutions.iter().map(|solution| solution.h).collect::<Vec<_>>())?;
    Ok(result)
}
