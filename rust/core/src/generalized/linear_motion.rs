//! Equations of motion that are linear, with constant coefficients: solved once, exact at any time.
//!
//! The one idea: their derivatives hang on parameters alone, so y′ = A y + b, and the state with a 1 after it is a vector
//! that [`MatrixExponential`] moves. A and b are found in double-double, as what forces are at unit vectors: the rounding of a
//! sum of two stiffnesses would be a stiffness to a mode that has little, that of a quotient would turn the phase.

use super::events::{Interval, Watch};
use super::model::{Kind, Model};
use super::run::{Request, Solution};
use crate::error::{Error, Result};
use crate::expressions::graph::Dependence;
use crate::expressions::linear::is_singular;
use crate::expressions::precise::Precise;
use crate::expressions::program::Output;
use crate::expressions::{Graph, Id};
use crate::numerics::double_double::{DoubleDouble, two_sum};
use crate::numerics::matrix_exponential::{MatrixExponential, elapsed};
use crate::numerics::real::Real;
use crate::ode::run::Ending;
use crate::parallel::Ticker;
use rustc_hash::FxHashMap;

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
    fn flow(&self, parameters: &[f64], (t0, end): (f64, f64)) -> Result<MatrixExponential> {
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

    /// The states at the output times of a run, or at its end.
    ///
    /// # Errors
    /// A singular mass matrix.
    pub fn solve(
        &self,
        request: &Request,
        (y0, parameters): (&[f64], &[f64]),
        ticker: &mut Ticker<'_>,
    ) -> Result<Solution> {
        let (t0, end) = request.span;
        let mut flow = self.flow(parameters, request.span)?;
        let mut start = y0.to_vec();
        start.push(1.0);
        let mut solution = Solution::at(t0, y0);
        let mut stop = None;
        if !request.events.is_empty() {
            let mut watch = Watch::new(&request.events, parameters);
            match look(&mut flow, &start, request.span, &mut watch, ticker) {
                Ok(stopped) => stop = stopped,
                Err(Error::Interrupted) => solution.ending = Ending::Interrupted,
                Err(error) => return Err(error),
            }
            solution.found = watch.found;
            if solution.ending == Ending::Interrupted {
                return Ok(solution);
            }
        }
        let only_end = [end];
        let beyond = |t: f64| stop.is_some_and(|stop| if t0 <= end { t > stop } else { t < stop });
        for &t in request.outputs.as_deref().unwrap_or(&only_end) {
            if beyond(t) {
                break;
            }
            if ticker.tick().is_err() {
                return Ok(Solution { ending: Ending::Interrupted, ..solution });
            }
            let (high, low) = elapsed(t, t0);
            let state = if t == t0 {
                start.clone()
            } else if t < t0 {
                flow.apply((-high, -low), &start)
            } else {
                flow.apply((high, low), &start)
            };
            if !state.iter().all(|number| number.is_finite()) {
                let ending = Ending::NotFinite;
                return Ok(Solution { ending, failure: ending.reason(), ..solution });
            }
            solution.t.push(t);
            solution.y.extend(&state[..y0.len()]);
            (solution.reached, solution.last_time) = (t, t);
            solution.last_state.copy_from_slice(&state[..y0.len()]);
        }
        if let Some(stop) = stop {
            (solution.ending, solution.reached) = (Ending::Stopped, stop);
        }
        Ok(solution)
    }
}

/// Units of time from one look for events to the next: two radians of the fastest that turns.
const UNITS: f64 = 4.0;

/// Looks for events on the way; the time of the one that ends the run, if one does.
fn look(
    flow: &mut MatrixExponential,
    start: &[f64],
    (t0, end): (f64, f64),
    watch: &mut Watch<'_>,
    ticker: &mut Ticker<'_>,
) -> Result<Option<f64>> {
    let (h, numbers) = (UNITS * flow.unit_of_time(), start.len() - 1);
    let (span, sign) = ((end - t0).abs(), if end < t0 { -1.0 } else { 1.0 });
    watch.start(t0, &start[..numbers])?;
    let (mut node, mut from) = (0.0, t0);
    loop {
        ticker.tick()?;
        let (elapsed, next) = (node * h, (node + 1.0) * h);
        let last = next >= span;
        let length = if last { span - elapsed } else { h };
        let to = if last { end } else { t0 + sign * next };
        let mut y = flow.apply(two_sum(elapsed, length), start);
        if !y.iter().all(|number| number.is_finite()) {
            return Ok(None);
        }
        y.truncate(numbers);
        let mut part = Part { flow, start, elapsed, length, span: (from, to), end: y, inside: vec![] };
        let stop = watch.look(&mut part)?;
        if stop.is_some() || last {
            return Ok(stop);
        }
        (node, from) = (node + 1.0, to);
    }
}

/// A part of a motion that takes no steps.
struct Part<'a> {
    flow: &'a mut MatrixExponential,
    start: &'a [f64],
    /// Since the start of the run.
    elapsed: f64,
    length: f64,
    span: (f64, f64),
    end: Vec<f64>,
    inside: Vec<f64>,
}

impl Interval for Part<'_> {
    fn span(&self) -> (f64, f64) {
        self.span
    }

    fn end(&self) -> &[f64] {
        &self.end
    }

    fn at(&mut self, theta: f64) -> Result<&[f64]> {
        if theta == 1.0 {
            return Ok(&self.end);
        }
        self.inside = self.flow.apply(two_sum(self.elapsed, theta * self.length), self.start);
        self.inside.truncate(self.end.len());
        Ok(&self.inside)
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
