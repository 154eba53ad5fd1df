//! Equations of motion that are linear, with constant coefficients: solved once, exact at any time.
//!
//! The one idea: their derivatives hang on parameters alone, so y′ = A y + b, and the state with a 1 after it is a vector
//! that [`MatrixExponential`] moves. A and b are found in double-double, as what forces are at unit vectors: the rounding of a
//! sum of two stiffnesses would be a stiffness to a mode that has little, that of a quotient would turn the phase.

use super::exact::{ExactMotion, Flow};
use super::model::{Kind, Model};
use crate::error::{Error, Result};
use crate::expressions::graph::Dependence;
use crate::expressions::linear::is_singular;
use crate::expressions::precise::Precise;
use crate::expressions::program::Output;
use crate::expressions::{Graph, Id};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::matrix_exponential::MatrixExponential;
use crate::numerics::real::Real;
use rustc_hash::FxHashMap;

/// Units of time from one look for events to the next: two radians of the fastest that turns.
const UNITS: f64 = 4.0;

/// Linear equations of 2·coordinates numbers.
#[derive(Clone, Debug)]
pub struct LinearMotion {
    /// Coordinates.
    n: usize,
    /// Right-hand sides: n of equations of the second order, whose other rates are the velocities.
    rows: usize,
    /// Whether masses divide them.
    masses: bool,
    /// The right-hand sides.
    right: Precise,
    /// The mass matrix, if there is one.
    mass: Precise,
}

impl LinearMotion {
    /// That of a model, if its equations are linear with constant coefficients.
    pub fn of(model: &Model) -> Option<Self> {
        let constrained = !model.source.holonomic.is_empty() || !model.source.nonholonomic.is_empty();
        // The state of variational equations has more than these numbers.
        let alone = model.numbers() == 2 * model.source.coordinates;
        if constrained || !alone || model.needs().time {
            return None;
        }
        let masses = model.source.kind == Kind::Lagrangian;
        let rates = model.rates.iter().map(Output::node);
        let right = if masses { model.right.clone() } else { rates.collect::<Option<Vec<Id>>>()? };
        let mut graph = model.source.graph.clone();
        let varies =
            |graph: &Graph, ids: &[Id]| ids.iter().any(|&id| graph.dependence(id) > Dependence::Parameters);
        let mass: Vec<Id> = model.mass.iter().flatten().copied().collect();
        if varies(&graph, &mass) {
            return None;
        }
        let one = graph.constant(1.0);
        for index in 0..model.numbers() as u32 {
            let number = graph.variable(index);
            let column = graph.tangent(&right, &FxHashMap::from_iter([(number, one)]));
            if varies(&graph, &column) {
                return None;
            }
        }
        let (n, rows) = (model.source.coordinates, right.len());
        let right = Precise::new(&graph, &right);
        Some(Self { n, rows, masses, right, mass: Precise::new(&graph, &mass) })
    }

    /// The flow with these parameters of the state and a 1 after it, forwards or backwards in time.
    fn matrix_exponential(&self, parameters: &[f64], (t0, end): (f64, f64)) -> Result<MatrixExponential> {
        let (n, rows, numbers) = (self.n, self.rows, 2 * self.n);
        let mut state = vec![DoubleDouble::zero(); numbers];
        let constants = self.right.at(t0, &state, parameters);
        let mass = self.mass.at(t0, &state, parameters);
        let mut right = vec![Vec::with_capacity(numbers + 1); rows];
        for index in 0..numbers {
            state[index] = DoubleDouble::one();
            let forces = self.right.at(t0, &state, parameters);
            for ((row, force), constant) in right.iter_mut().zip(forces).zip(&constants) {
                row.push(force - *constant);
            }
            state[index] = DoubleDouble::zero();
        }
        right.iter_mut().zip(constants).for_each(|(row, constant)| row.push(constant));
        let mut matrix = vec![DoubleDouble::zero(); (numbers + 1) * (numbers + 1)];
        if self.masses {
            let mut mass: Vec<Vec<DoubleDouble>> = mass.chunks_exact(n).map(<[_]>::to_vec).collect();
            divide(&mut mass, &mut right)?;
        }
        let start = numbers - rows;
        for i in 0..start {
            matrix[i * (numbers + 1) + n + i] = DoubleDouble::one();
        }
        for (i, row) in right.iter().enumerate() {
            matrix[(start + i) * (numbers + 1)..][..=numbers].copy_from_slice(row);
        }
        if end < t0 {
            matrix.iter_mut().for_each(|entry| *entry = -*entry);
        }
        Ok(MatrixExponential::new(matrix, numbers + 1, (end - t0).abs()))
    }
}

impl ExactMotion for LinearMotion {
    fn flow(&self, (y0, parameters): (&[f64], &[f64]), span: (f64, f64)) -> Result<Box<dyn Flow>> {
        let mut start = y0.to_vec();
        start.push(1.0);
        Ok(Box::new(LinearFlow {
            flow: self.matrix_exponential(parameters, span)?,
            start,
            backwards: span.1 < span.0,
        }))
    }
}

/// The flow of linear equations from a start, with the 1 after it.
struct LinearFlow {
    flow: MatrixExponential,
    start: Vec<f64>,
    /// Whether time is turned around.
    backwards: bool,
}

impl Flow for LinearFlow {
    fn look(&self) -> f64 {
        UNITS * self.flow.unit_of_time()
    }

    fn after(&mut self, (high, low): (f64, f64)) -> Vec<f64> {
        let elapsed = if self.backwards { (-high, -low) } else { (high, low) };
        let mut state = self.flow.apply(elapsed, &self.start);
        let _ = state.pop();
        state
    }
}

/// Solves `matrix · x = right` for several right-hand sides, in their place.
fn divide(matrix: &mut [Vec<DoubleDouble>], right: &mut [Vec<DoubleDouble>]) -> Result<()> {
    let n = matrix.len();
    let size = |x: DoubleDouble| x.to_f64().abs();
    let triangle = matrix.iter().enumerate().flat_map(|(i, row)| row[..=i].iter());
    if is_singular(&triangle.map(|x| x.to_f64()).collect::<Vec<f64>>(), n) {
        return Err(Error::invalid("parameters", "the mass matrix is singular for these"));
    }
    for column in 0..n {
        let best = (column..n).fold(column, |best, row| {
            if size(matrix[row][column]) > size(matrix[best][column]) { row } else { best }
        });
        matrix.swap(column, best);
        right.swap(column, best);
        let (pivots, below) = matrix.split_at_mut(column + 1);
        let (solved, others) = right.split_at_mut(column + 1);
        for (row, sides) in below.iter_mut().zip(others) {
            let factor = row[column] / pivots[column][column];
            for (entry, &pivot) in row.iter_mut().zip(&pivots[column]) {
                *entry -= factor * pivot;
            }
            for (side, &pivot) in sides.iter_mut().zip(&solved[column]) {
                *side -= factor * pivot;
            }
        }
    }
    for column in (0..n).rev() {
        let (above, solved) = right.split_at_mut(column);
        let pivot = matrix[column][column];
        solved[0].iter_mut().for_each(|side| *side = *side / pivot);
        for (row, sides) in matrix.iter().zip(above) {
            for (side, &value) in sides.iter_mut().zip(&solved[0]) {
                *side -= row[column] * value;
            }
        }
    }
    Ok(())
}
