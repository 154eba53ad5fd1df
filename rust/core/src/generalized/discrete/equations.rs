//! What the discrete equations of motion are made of, as code: forces and momenta, their derivatives, and constraints.

use super::Method;
use crate::error::{Error, Result};
use crate::expressions::{Code, Id};
use crate::generalized::model::{Kind, Model};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The codes of a Lagrangian for a method. The forces are f = ∂L/∂q + Q − ∂R/∂q̇, the momenta p = ∂L/∂q̇.
#[derive(Clone, Debug)]
pub struct Equations {
    pub(super) method: &'static Method,
    pub(super) coordinates: usize,
    pub(super) constraints: usize,
    /// f, then p.
    pub(super) rates: Arc<Code>,
    /// The derivatives of f and p with respect to the state that are not zero.
    pub(super) slopes: Arc<Code>,
    /// Of which of those 2n numbers, and with respect to which of the state's 2n, they are.
    pub(super) places: Vec<(usize, usize)>,
    /// p, then ∂p/∂q̇ row by row.
    pub(super) momenta: Arc<Code>,
    /// g, its rates of change, then ∂g/∂q row by row.
    pub(super) holonomic: Arc<Code>,
}

impl Equations {
    /// The method's name.
    pub fn name(&self) -> &'static str {
        self.method.name
    }

    /// Of a Lagrangian without constraints, or with holonomic ones if the method is for those.
    ///
    /// # Errors
    /// Another system; expressions that are too large.
    pub fn new(model: &Model, method: &'static Method) -> Result<Self> {
        let source = &model.source;
        let fits = source.kind == Kind::Lagrangian
            && source.nonholonomic.is_empty()
            && method.constrained != source.holonomic.is_empty();
        if !fits {
            return Err(Error::invalid("method", format!("{} does not take such a system", method.name)));
        }
        let mut model = model.clone();
        let n = model.source.coordinates;
        let (q, v) = model.source.halves();
        let graph = &mut model.source.graph;
        let (one, time) = (graph.constant(1.0), graph.time());
        let damping = model.source.dissipation.map(|function| graph.gradient(function, &v));
        let mut rates = Vec::with_capacity(2 * n);
        for i in 0..n {
            let mut terms = vec![(1.0, model.slopes[i])];
            terms.extend(model.source.forces.get(i).map(|&force| (1.0, force)));
            terms.extend(damping.as_ref().map(|damping| (-1.0, damping[i])));
            rates.push(graph.sum(0.0, &terms));
        }
        rates.extend(&model.conjugates);
        let (mut slopes, mut places): (Vec<Id>, _) = (vec![], vec![]);
        for (column, &number) in q.iter().chain(&v).enumerate() {
            for (row, slope) in
                graph.tangent(&rates, &FxHashMap::from_iter([(number, one)])).into_iter().enumerate()
            {
                if !graph.is_zero(slope) {
                    slopes.push(slope);
                    places.push((row, column));
                }
            }
        }
        let holonomic = model.source.holonomic.clone();
        let mut motion: FxHashMap<Id, Id> = q.iter().copied().zip(v.iter().copied()).collect();
        let _ = motion.insert(time, one);
        let mut constraints = holonomic.clone();
        constraints.extend(graph.tangent(&holonomic, &motion));
        for &constraint in &holonomic {
            constraints.extend(graph.gradient(constraint, &q));
        }
        let momenta: Vec<Id> = model.conjugates.iter().chain(model.mass.iter().flatten()).copied().collect();
        Ok(Self {
            method,
            coordinates: n,
            constraints: holonomic.len(),
            rates: Arc::new(model.function(&rates)?),
            slopes: Arc::new(model.function(&slopes)?),
            places,
            momenta: Arc::new(model.function(&momenta)?),
            holonomic: Arc::new(model.function(&constraints)?),
        })
    }
}
