//! Lagrangians and Hamiltonians: nodes of expressions in, equations, runs and expressions out.
//!
//! `visviva.generalized` makes [`nodes`] of SymPy's trees and makes trees of them again.

mod constraints;
mod events;
mod nodes;
mod runs;
mod small_motions;

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use nodes::{NodeParts, added, all_chosen, chosen, shown};
use numpy::{PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use runs::Asked;
pub(crate) use small_motions::eigenmodes;
use std::sync::{Arc, OnceLock};
use visviva_core::expressions::graph::{Graph, Id};
use visviva_core::expressions::program::Output;
use visviva_core::generalized::discrete::path::segments;
use visviva_core::generalized::discrete::{self, Equations};
use visviva_core::generalized::evaluate;
use visviva_core::generalized::legendre;
use visviva_core::generalized::linear::Linear;
use visviva_core::generalized::linear_motion::LinearMotion;
use visviva_core::generalized::one_freedom::OneFreedom;
use visviva_core::generalized::pendulum_motion::PendulumMotion;
use visviva_core::generalized::structure::{MassMatrix, Structure};
use visviva_core::generalized::variation::variational;
use visviva_core::generalized::{Kind, Model, Source};
use visviva_core::{Error, Result};

type Array<'py> = PyReadonlyArrayDyn<'py, f64>;
type Column<'py> = Bound<'py, PyArrayDyn<f64>>;

/// A system in generalized coordinates.
#[pyclass(frozen, module = "visviva._core")]
pub(crate) struct GeneralizedModel {
    model: Arc<Model>,
    structure: Structure,
    /// The equations, if they are linear.
    linear: Option<Arc<LinearMotion>>,
    /// The equation, if it is that of a pendulum.
    pendulum: Option<Arc<PendulumMotion>>,
    /// What small motions are told by, once somebody has asked.
    small: OnceLock<Linear>,
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
    fn of(model: Model) -> Result<Self> {
        let linear = LinearMotion::of(&model).map(Arc::new);
        let pendulum = PendulumMotion::of(&model).map(Arc::new);
        let structure = Structure::of(&model);
        Ok(Self { structure, linear, pendulum, model: Arc::new(model), small: OnceLock::new() })
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
        compute(py, 0, None, |_| Self::of(Model::new(described.source()?)?))?.whole(py)
    }

    /// What is found without running it.
    fn structure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = &self.structure;
        let result = PyDict::new(py);
        result.set_item("cyclic", &found.cyclic)?;
        result.set_item("autonomous", found.autonomous)?;
        result.set_item("conserves_energy", found.conserves_energy)?;
        result.set_item("holds_steps", found.holds_steps)?;
        let mass = match found.mass {
            MassMatrix::Constant => "constant",
            MassMatrix::Diagonal => "diagonal",
            MassMatrix::Blocks => "blocks",
            MassMatrix::Full => "full",
            MassMatrix::None => "none",
        };
        result.set_item("mass_matrix", mass)?;
        result.set_item("linear", self.linear.is_some())?;
        result.set_item("pendulum", self.pendulum.is_some())?;
        result.set_item("separable", found.separable)?;
        result.set_item("nystrom", found.nystrom)?;
        result.set_item("second_order", found.second_order)?;
        result.set_item("kinks", found.kinks)?;
        result.set_item("quadratic", found.quadratic)?;
        result.set_item("operations", found.operations)?;
        Ok(result)
    }

    /// Expressions by name, as nodes and their places; `curvatures` are the second derivatives of the function of a
    /// Lagrangian with respect to all numbers of the state, row by row.
    fn expressions(&self, py: Python<'_>, name: &str) -> PyResult<(Vec<NodeParts>, Vec<u32>)> {
        if name == "curvatures" {
            let mut source = self.model.source.clone();
            let roots = source.curvatures();
            return Ok(shown(&source.graph, &roots));
        }
        let model = &*self.model;
        let roots: Vec<Id> = match name {
            "function" => vec![model.source.function],
            "conjugates" => model.conjugates.clone(),
            "slopes" => model.slopes.clone(),
            "energy" => vec![model.energy],
            "mass_matrix" => model.mass.iter().flatten().copied().collect(),
            "rates" => model.rates.iter().filter_map(Output::node).collect(),
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

    /// Each of these nodes, and its derivatives with respect to the numbers of the state and the time, as nodes.
    fn derivatives(
        &self,
        py: Python<'_>,
        nodes: Vec<NodeParts>,
        roots: Vec<u32>,
    ) -> PyResult<(Vec<NodeParts>, Vec<u32>)> {
        let mut source = self.model.source.clone();
        let (first, second) = source.halves();
        let mut derive = || {
            let ids = added(&mut source.graph, &nodes)?;
            let time = source.graph.time();
            let of: Vec<Id> = first.iter().chain(&second).copied().chain([time]).collect();
            let mut found = Vec::with_capacity((of.len() + 1) * roots.len());
            for root in all_chosen(&ids, &roots)? {
                found.push(root);
                found.extend(source.graph.gradient(root, &of));
            }
            Ok(found)
        };
        let found = derive().map_err(|error: Error| raised(py, error))?;
        Ok(shown(&source.graph, &found))
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
        constraints::projected(py, &self.model, t, &state, &parameters)
    }

    /// The equilibria that Newton's method reaches from starts (S, n), each with whether its steps tell it, `None` where it
    /// reaches none; with steps that make the forces less, if asked for.
    fn equilibria(
        &self,
        py: Python<'_>,
        t: f64,
        starts: Array<'_>,
        parameters: Array<'_>,
        descending: bool,
    ) -> PyResult<Vec<small_motions::Reached>> {
        small_motions::equilibria(py, (&self.model, &self.small), (t, descending), &starts, &parameters)
    }

    /// F (S, n), and M, C and K (S, n, n) of small motions, at states (S, 2n).
    fn matrices<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        states: Array<'py>,
        parameters: Array<'py>,
    ) -> PyResult<[Column<'py>; 4]> {
        small_motions::matrices(py, (&self.model, &self.small), t, &states, &parameters)
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
        compute(py, 0, None, |_| Self::of(variational(&model)?))?.whole(py)
    }

    /// The segments of a path through places (T, n) at times (T): their actions (T − 1), and the momenta at their
    /// beginnings and ends and the sizes of what those are made of, (T − 1, n).
    fn segments<'py>(
        &self,
        py: Python<'py>,
        method: &str,
        t: Array<'py>,
        places: Array<'py>,
        parameters: Array<'py>,
    ) -> PyResult<(Column<'py>, [Column<'py>; 3])> {
        let model = &*self.model;
        let n = model.source.coordinates;
        let (t, [count]) = copied("t", &t, [None])?;
        let (places, _) = copied("places", &places, [Some(count), Some(n)])?;
        let (parameters, _) = copied("parameters", &parameters, [Some(model.source.parameters)])?;
        let found = compute(py, 0, None, |ticker| {
            let method =
                discrete::method(method).ok_or_else(|| Error::Internal(format!("no method {method}")))?;
            let equations = Arc::new(Equations::new(model, method)?);
            let function = model.function(&[model.source.function])?;
            segments(&equations, function, &parameters, (&t, &places), ticker)
        })?
        .whole(py)?;
        let segments = count.saturating_sub(1);
        let shape = [segments, n];
        let columns = [found.before, found.after, found.sizes].map(|column| moved(py, column, &shape));
        let [before, after, sizes] = columns;
        Ok((moved(py, found.actions, &[segments])?, [before?, after?, sizes?]))
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
        runs::run(py, self, &asked, (&states, &parameters), threads, progress.as_ref())
    }
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
