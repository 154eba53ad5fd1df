//! A mechanical system in generalized coordinates: where it comes from and what was made of it.

use super::poles::Divisors;
use super::projection::Projection;
use super::{hamiltonian, lagrangian, sticking};
use crate::error::{Error, Result};
use crate::expressions::assembler::compile;
use crate::expressions::program::{LinearSystem, Output, roots};
use crate::expressions::{Code, Graph, Id, Series};
use crate::narrow::{Equations, Features};
use crate::ode::system::{Form, Needs};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Of which kind the function is that says all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// L(q, q̇, t); the state is (q, q̇).
    Lagrangian,
    /// H(q, p, t); the state is (q, p).
    Hamiltonian,
}

/// What a system is made of: expressions of `2·coordinates` numbers of a state, the time, and parameters.
#[derive(Clone, Debug)]
pub struct Source {
    /// All expressions.
    pub graph: Graph,
    /// The kind of function.
    pub kind: Kind,
    /// Degrees of freedom before constraints.
    pub coordinates: usize,
    /// Parameters.
    pub parameters: usize,
    /// The function.
    pub function: Id,
    /// Generalized forces that no potential gives, one for each coordinate, or none.
    pub forces: Vec<Id>,
    /// Rayleigh's dissipation function R(q̇): the forces −∂R/∂q̇.
    pub dissipation: Option<Id>,
    /// Holonomic constraints g(q, t) = 0.
    pub holonomic: Vec<Id>,
    /// Nonholonomic ones, a(q, t)·q̇ + b(q, t) = 0.
    pub nonholonomic: Vec<Id>,
}

/// A system and what was found about it.
#[derive(Clone, Debug)]
pub struct Model {
    /// What it is made of; its graph has everything else, too.
    pub source: Source,
    /// The form of its equations.
    pub form: Form,
    /// The systems of linear equations that the rates hang on.
    pub systems: Vec<LinearSystem>,
    /// The right-hand side: rates of the first order, accelerations of the second.
    pub rates: Vec<Output>,
    /// The multipliers λ of the constraints: the constraint forces are Σ λ ∂g/∂q (of a Lagrangian).
    pub multipliers: Vec<Output>,
    /// ∂L/∂q̇ of a Lagrangian, ∂H/∂p of a Hamiltonian: what the state does not have.
    pub conjugates: Vec<Id>,
    /// ∂L/∂q, or −∂H/∂q.
    pub slopes: Vec<Id>,
    /// ∂²L/∂q̇∂q̇; empty of a Hamiltonian.
    pub mass: Vec<Vec<Id>>,
    /// What M q̈ is equal to; empty of a Hamiltonian.
    pub right: Vec<Id>,
    /// Numbers of a state.
    pub numbers: usize,
    /// Jacobi's integral Σ q̇ ∂L/∂q̇ − L, or H.
    pub energy: Id,
    /// The equations as code.
    pub code: Arc<Code>,
    /// Conjugates, energy and multipliers as code.
    pub columns: Arc<Code>,
    /// What keeps states on the constraints.
    pub projection: Option<Projection>,
    /// Velocities that dry friction may hold, with their rates, as code.
    pub switches: Vec<Arc<Code>>,
    /// What it divides by, if that may change its sign.
    pub divisors: Option<Divisors>,
    /// What may be too narrow for a step, if it has functions like that.
    pub narrow: Option<Arc<Features>>,
    needs: Needs,
}

impl Model {
    /// Derives the equations.
    ///
    /// # Errors
    /// A function without kinetic energy in a coordinate; constraints on a Hamiltonian; expressions that are too large.
    pub fn new(source: Source) -> Result<Self> {
        let derived = match source.kind {
            Kind::Lagrangian => lagrangian::derive(source)?,
            Kind::Hamiltonian => hamiltonian::derive(source)?,
        };
        let Derived { source, form, systems, rates, multipliers, conjugates, slopes, mass, right, energy } =
            derived;
        let inputs = (2 * source.coordinates, source.parameters);
        let code = Arc::new(compile(&source.graph, inputs, &systems, &rates)?);
        let mut outputs: Vec<Output> = conjugates.iter().copied().chain([energy]).map(Output::Node).collect();
        outputs.extend(&multipliers);
        let of_columns: &[LinearSystem] = if multipliers.is_empty() { &[] } else { &systems };
        let columns = Arc::new(compile(&source.graph, inputs, of_columns, &outputs)?);
        let mut model = Self {
            source,
            form,
            systems,
            rates,
            multipliers,
            conjugates,
            slopes,
            mass,
            right,
            numbers: inputs.0,
            energy,
            code,
            columns,
            projection: None,
            switches: vec![],
            divisors: None,
            narrow: None,
            needs: Needs::default(),
        };
        model.needs = model.what_is_looked_at();
        model.projection = Projection::new(&mut model)?;
        model.set_watched()?;
        Ok(model)
    }

    /// Finds what is watched on the way, by code that reads a whole state and its rates.
    ///
    /// # Errors
    /// Expressions that are too large.
    pub(super) fn set_watched(&mut self) -> Result<()> {
        self.switches = sticking::switches(self)?;
        self.divisors = Divisors::of(self)?;
        self.narrow = Features::of(Equations {
            graph: &mut self.source.graph,
            numbers: self.numbers,
            parameters: self.source.parameters,
            systems: &self.systems,
            rates: &self.rates,
        })?
        .map(Arc::new);
        Ok(())
    }

    /// Numbers of a state.
    pub fn numbers(&self) -> usize {
        self.numbers
    }

    /// Other expressions of the same state as code.
    ///
    /// # Errors
    /// Expressions that are too large.
    pub fn function(&self, expressions: &[Id]) -> Result<Code> {
        let outputs: Vec<Output> = expressions.iter().copied().map(Output::Node).collect();
        compile(&self.source.graph, (self.numbers(), self.source.parameters), &[], &outputs)
    }

    /// An expression of a state as code: its value; how fast it changes at equal rates of the second half; and where it looks at
    /// velocities of which accelerations are the rates, its slopes along them and those rates.
    ///
    /// # Errors
    /// Expressions that are too large.
    pub fn along(&mut self, expression: Id) -> Result<Code> {
        let (first, second) = self.source.halves();
        let graph = &mut self.source.graph;
        let (time, one) = (graph.time(), graph.constant(1.0));
        let mut motion: FxHashMap<Id, Id> = FxHashMap::from_iter([(time, one)]);
        let (mut slopes, mut rates) = (vec![], vec![]);
        match self.form {
            Form::FirstOrder(_) => {
                for (&number, rate) in first.iter().chain(&second).zip(&self.rates) {
                    let _ = rate.node().and_then(|rate| motion.insert(number, rate));
                }
            }
            Form::SecondOrder(_) => {
                motion.extend(first.iter().copied().zip(second.iter().copied()));
                let along = graph.gradient(expression, &second);
                for (slope, &rate) in along.into_iter().zip(&self.rates) {
                    if !graph.is_zero(slope) {
                        slopes.push(Output::Node(slope));
                        rates.push(rate);
                    }
                }
            }
        }
        let moved = graph.tangent(&[expression], &motion);
        let mut outputs: Vec<Output> = core::iter::once(expression).chain(moved).map(Output::Node).collect();
        outputs.extend(slopes);
        let systems: &[LinearSystem] = if rates.is_empty() { &[] } else { &self.systems };
        outputs.extend(rates);
        compile(&self.source.graph, (self.numbers, self.source.parameters), systems, &outputs)
    }

    /// Its equations as recurrences of Taylor coefficients.
    ///
    /// # Errors
    /// Functions in it that [leap](Series::leaps).
    pub fn series(&self) -> Result<Arc<Series>> {
        let roots = roots(&self.systems, &self.rates);
        if let Some(function) = Series::leaps(&self.source.graph, &roots) {
            return Err(Error::invalid(
                "method",
                format!(
                    "taylor takes equations that are smooth wherever they go; {function} in these leaps by 2π at negative x, \
                     which no series tells; gauss16 and dop853 take them"
                ),
            ));
        }
        let inputs = (self.numbers, self.source.parameters);
        Series::new(&self.source.graph, inputs, &self.systems, &self.rates).map(Arc::new)
    }

    /// What its equations look at.
    pub fn needs(&self) -> Needs {
        self.needs
    }

    fn what_is_looked_at(&self) -> Needs {
        use crate::expressions::Node;
        let graph = &self.source.graph;
        let n = self.source.coordinates as u32;
        let roots = roots(&self.systems, &self.rates);
        Needs {
            time: graph.any(&roots, |node| matches!(node, Node::Time)),
            velocity: graph.any(&roots, |node| matches!(node, Node::Variable(index) if *index >= n)),
            rotation: false,
        }
    }
}

/// What the derivation of either kind gives.
pub(super) struct Derived {
    pub(super) source: Source,
    pub(super) form: Form,
    pub(super) systems: Vec<LinearSystem>,
    pub(super) rates: Vec<Output>,
    pub(super) multipliers: Vec<Output>,
    pub(super) conjugates: Vec<Id>,
    pub(super) slopes: Vec<Id>,
    pub(super) mass: Vec<Vec<Id>>,
    pub(super) right: Vec<Id>,
    pub(super) energy: Id,
}

impl Source {
    /// The nodes of the first half of a state, and of the second.
    pub fn halves(&mut self) -> (Vec<Id>, Vec<Id>) {
        let n = self.coordinates as u32;
        let first = (0..n).map(|i| self.graph.variable(i)).collect();
        (first, (n..2 * n).map(|i| self.graph.variable(i)).collect())
    }
}

impl Source {
    /// The second derivatives of the function with respect to all numbers of a state, row by row.
    pub fn curvatures(&mut self) -> Vec<Id> {
        let (first, second) = self.halves();
        let all: Vec<Id> = first.into_iter().chain(second).collect();
        let slopes = self.graph.gradient(self.function, &all);
        slopes.into_iter().flat_map(|slope| self.graph.gradient(slope, &all)).collect()
    }

    /// The Poisson bracket Σ ∂f/∂q ∂g/∂p − ∂f/∂p ∂g/∂q of two functions of (q, p).
    pub fn poisson(&mut self, f: Id, g: Id) -> Id {
        let (q, p) = self.halves();
        let all: Vec<Id> = q.iter().chain(&p).copied().collect();
        let graph = &mut self.graph;
        let (f, g) = (graph.gradient(f, &all), graph.gradient(g, &all));
        let mut terms = Vec::new();
        for i in 0..q.len() {
            terms.push((1.0, graph.multiply(f[i], g[q.len() + i])));
            terms.push((-1.0, graph.multiply(f[q.len() + i], g[i])));
        }
        graph.sum(0.0, &terms)
    }
}

/// A degenerate function.
pub(super) fn degenerate(coordinate: usize) -> Error {
    Error::invalid(
        "L",
        format!(
            "degenerate: the second derivative of L with respect to the velocity of coordinate {coordinate} vanishes \
             identically, so it has no acceleration; make it a multiplier (constraints=), hold it by a constraint, or drop it"
        ),
    )
}
