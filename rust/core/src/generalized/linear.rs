//! Near a state: equilibria, and the linear equations of small motions about them.
//!
//! The one idea: at rest nothing is left of the equations but F(q) = 0, whose zeros Newton's method finds; where K is singular,
//! as where a system may be moved as a whole, its least step is taken. The derivatives there, M, C and K of
//! M ξ̈ + C ξ̇ + K ξ = 0, say all about small motions. Derivatives are sweeps on the graph.

mod jacobi;

use super::model::{Kind, Model};
use crate::error::{Error, Result};
use crate::expressions::{Code, Graph, Id, Machine, Node};
use nalgebra::{DMatrix, DVector};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Newton's steps to an equilibrium.
const MOST_STEPS: u32 = 100;
/// Corrections below this, relative to the place, are round-off.
const FOUND: f64 = 1e-13;
/// Below this part of the places on the way, corrections may be round-off: they are, if they do not shrink to less than that.
const NOISE: f64 = 1e-9;
const SHRINKS: f64 = 0.9;
/// Factors of corrections that differ by less than this part are one.
const STEADY: f64 = 1e-2;
/// Forces that no step does away with are round-off below this part of the stiffest one times the place.
const UNBALANCED: f64 = 1e-10;
/// Singular values of K, its rows and columns measured by masses, below this part of the largest are zero.
const SINGULAR: f64 = 1e-10;
/// Rotations of a matrix on the way to its eigenvalues: some tens for each are usual.
const ROTATIONS: usize = 100_000;
/// A step is halved so often at most, until the force is less by at least this part of what it would be by the whole step.
const HALVINGS: i32 = 40;
const GAIN: f64 = 1e-4;

/// Codes of forces at rest and of the matrices of small motions.
#[derive(Clone, Debug)]
pub struct Linear {
    n: usize,
    /// F (n), ∂F/∂q (n × n), ∂F/∂v (n × n), M (n × n).
    code: Arc<Code>,
}

/// The matrices of M ξ̈ + C ξ̇ + K ξ = 0, row by row.
#[derive(Clone, Debug)]
pub struct Matrices {
    /// M.
    pub mass: Vec<f64>,
    /// C, with damping and gyroscopic terms.
    pub damping: Vec<f64>,
    /// K.
    pub stiffness: Vec<f64>,
    /// F at the place: zero at an equilibrium.
    pub forces: Vec<f64>,
}

impl Linear {
    /// Of a Lagrangian without constraints.
    ///
    /// # Errors
    /// Another system, or one whose small motions depend on the time; expressions that are too large.
    pub fn new(model: &mut Model) -> Result<Self> {
        if model.source.kind != Kind::Lagrangian || !model.multipliers.is_empty() {
            return Err(Error::invalid(
                "L",
                "small motions are those of a Lagrangian without constraints; transform or eliminate first",
            ));
        }
        let n = model.source.coordinates;
        let (q, v) = model.source.halves();
        let graph = &mut model.source.graph;
        let one = graph.constant(1.0);
        let mut outputs: Vec<Id> = model.right.clone();
        for numbers in [&q, &v] {
            let mut columns = Vec::new();
            for &number in numbers {
                columns.push(graph.tangent(&model.right, &FxHashMap::from_iter([(number, one)])));
            }
            for i in 0..n {
                outputs.extend(columns.iter().map(|column| column[i]));
            }
        }
        outputs.extend(model.mass.iter().flatten());
        Self::refuse_time(&mut model.source.graph, &outputs, &v)?;
        Ok(Self { n, code: Arc::new(model.function(&outputs)?) })
    }

    /// Matrices of one moment say nothing of others. A time that leaves the equations, as that of a pivot that is
    /// accelerated evenly, does no harm.
    fn refuse_time(graph: &mut Graph, outputs: &[Id], velocities: &[Id]) -> Result<()> {
        let zero = graph.constant(0.0);
        let rest = velocities.iter().map(|&v| (v, zero)).collect();
        let at_rest = graph.substitute(outputs, &rest);
        if graph.any(&at_rest, |node| matches!(node, Node::Time)) {
            return Err(Error::invalid(
                "L",
                "equilibria and small motions are those of equations that do not depend on the time, and these do; \
                 run the system, or take flow_jacobian() over a period of what drives it: a motion is stable where no \
                 eigenvalue is larger than 1 (Floquet)",
            ));
        }
        Ok(())
    }

    /// The matrices at a place, at rest.
    pub fn matrices(&self, t: f64, q: &[f64], parameters: &[f64]) -> Matrices {
        let mut state = q.to_vec();
        state.resize(2 * self.n, 0.0);
        self.matrices_at(t, &state, parameters)
    }

    /// The matrices at a state.
    pub fn matrices_at(&self, t: f64, state: &[f64], parameters: &[f64]) -> Matrices {
        let n = self.n;
        let mut machine = Machine::new(self.code.clone(), parameters);
        let mut found = vec![0.0; self.code.outputs()];
        machine.evaluate(t, state, &mut found);
        let block = |index: usize, sign: f64| -> Vec<f64> {
            found[n + index * n * n..n + (index + 1) * n * n].iter().map(|x| sign * x).collect()
        };
        Matrices {
            forces: found[..n].to_vec(),
            stiffness: block(0, -1.0),
            damping: block(1, -1.0),
            mass: block(2, 1.0),
        }
    }

    /// The equilibrium that Newton's method reaches from a place, and whether it is told by its steps: where forces are but
    /// round-off around a zero of higher order, steps are too, and of the places on the way that of the least force is given.
    /// `Descending`, each step is halved until the force is less: slower, and no step leads over a singularity.
    pub fn equilibrium(
        &self,
        t: f64,
        start: &[f64],
        parameters: &[f64],
        steps: Steps,
    ) -> Option<(Vec<f64>, bool)> {
        let mut calmest = (f64::INFINITY, vec![]);
        let found = self.by_newton((t, parameters), start, steps, &mut calmest);
        let nearly = || (!calmest.1.is_empty()).then_some((calmest.1, false));
        found.map(|place| (place, true)).or_else(nearly)
    }

    /// By Newton's steps; the place of the least force on the way is kept.
    fn by_newton(
        &self,
        (t, parameters): (f64, &[f64]),
        start: &[f64],
        steps: Steps,
        calmest: &mut (f64, Vec<f64>),
    ) -> Option<Vec<f64>> {
        let n = self.n;
        let mut q = start.to_vec();
        // Sizes are those of the places on the way, times the roots of masses: systems may be of any size.
        let (mut last, mut shrunk, mut visited) = (f64::INFINITY, f64::NAN, 0.0_f64);
        for step in 1..=MOST_STEPS {
            let at = self.matrices(t, &q, parameters);
            // Nothing is left to be stepped to, whether or not forces have slopes here, as 3 x |x| has.
            if at.forces.iter().all(|&force| force == 0.0) && at.stiffness.iter().any(|x| !x.is_finite()) {
                return Some(q);
            }
            let units = units(&at.mass, n);
            let force = (0..n).map(|i| (at.forces[i] * units[i]).abs()).fold(0.0, f64::max);
            if force < calmest.0 {
                *calmest = (force, q.clone());
            }
            let Step { correction, remains, stiffest } = newton_step(&at, &units)?;
            let most = (0..n).map(|i| correction[i].abs() / units[i]).fold(0.0_f64, f64::max);
            // To a zero of higher order all corrections shrink by one factor: what is left is a geometric series.
            let shrinks = most / last;
            let steady = (shrinks - shrunk).abs() <= STEADY * shrinks && shrinks < 1.0 - STEADY;
            let whole = match steps {
                Steps::Descending => self.descent((t, parameters), &q, &correction, (&units, force))?,
                Steps::Whole if steady => 1.0 / (1.0 - shrinks),
                Steps::Whole => 1.0,
            };
            shrunk = if steady { f64::NAN } else { shrinks };
            let (mut moved, mut close) = (false, true);
            for i in 0..n {
                if !correction[i].is_finite() {
                    return None;
                }
                let next = q[i] + whole * correction[i];
                moved |= next != q[i];
                close &= correction[i].abs() <= FOUND * next.abs();
                visited = visited.max(q[i].abs() / units[i]).max(next.abs() / units[i]);
                q[i] = next;
            }
            // Next to zero a place has no digits of its own: it is found when steps are round-off, and no longer shrink.
            let ended = most <= NOISE * visited && most >= SHRINKS * last;
            let exhausted = step == MOST_STEPS && most <= FOUND * visited;
            if !moved || close || ended || exhausted {
                return (remains <= UNBALANCED * stiffest * visited).then_some(q);
            }
            last = most;
        }
        None
    }

    /// What part of a step makes the force less.
    fn descent(
        &self,
        (t, parameters): (f64, &[f64]),
        q: &[f64],
        correction: &[f64],
        (units, force): (&[f64], f64),
    ) -> Option<f64> {
        (0..HALVINGS).map(|halved| 0.5_f64.powi(halved)).find(|part| {
            let next: Vec<f64> = q.iter().zip(correction).map(|(q, step)| q + part * step).collect();
            let at = self.matrices(t, &next, parameters);
            // Too small a gain is none, but for round-off.
            at.forces.iter().zip(units).all(|(x, unit)| (x * unit).abs() <= (1.0 - GAIN * part) * force)
        })
    }
}

/// How far Newton's steps are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Steps {
    /// As they are.
    Whole,
    /// Halved until the force is less.
    Descending,
}

/// Newton's step to an equilibrium.
struct Step {
    correction: Vec<f64>,
    /// The force that it does not do away with, and the largest stiffness, in units of masses.
    remains: f64,
    stiffest: f64,
}

/// Units of coordinates in which their masses are alike: angles beside lengths.
fn units(mass: &[f64], n: usize) -> Vec<f64> {
    let unit = |i: usize| {
        let root = mass[i * n + i].abs().sqrt();
        if root.is_normal() { 1.0 / root } else { 1.0 }
    };
    (0..n).map(unit).collect()
}

/// K⁻¹F; where K is singular the least step that does away with what it can of F.
fn newton_step(at: &Matrices, units: &[f64]) -> Option<Step> {
    let n = units.len();
    let scaled = DMatrix::from_fn(n, n, |i, j| at.stiffness[i * n + j] * units[i] * units[j]);
    let forces = DVector::from_fn(n, |i, _| at.forces[i] * units[i]);
    if scaled.iter().chain(forces.iter()).any(|x| !x.is_finite()) {
        return None;
    }
    let given = |step: &DVector<f64>| step.iter().zip(units).map(|(x, unit)| x * unit).collect();
    let factors = scaled.clone().lu();
    let pivots = factors.u().diagonal().abs();
    let stiffest = scaled.amax();
    if pivots.min() > SINGULAR * pivots.max()
        && let Some(step) = factors.solve(&forces)
    {
        return Some(Step { correction: given(&step), remains: 0.0, stiffest });
    }
    let svd = scaled.try_svd(true, true, f64::EPSILON, ROTATIONS)?;
    let least = SINGULAR * svd.singular_values.max();
    let (left, right) = (svd.u.as_ref()?, svd.v_t.as_ref()?);
    let along = left.tr_mul(&forces);
    let (mut step, mut remains) = (DVector::zeros(n), 0.0_f64);
    for (k, &value) in svd.singular_values.iter().enumerate() {
        if value > least {
            step += right.row(k).transpose() * (along[k] / value);
        } else {
            remains = remains.max(along[k].abs());
        }
    }
    Some(Step { correction: given(&step), remains, stiffest })
}

/// Squared frequencies, ascending, with modes, row by row, which are orthonormal in M.
pub type Modes = (Vec<f64>, Vec<f64>);

/// Those of small motions, where these matrices are a symmetric pair M, K with M positive definite and no C.
///
/// # Errors
/// A singular mass matrix; matrices that are not numbers.
pub fn modes(matrices: &Matrices, n: usize) -> Result<Option<Modes>> {
    finite(matrices, n)?;
    let [mass, damping, stiffness] = [&matrices.mass, &matrices.damping, &matrices.stiffness]
        .map(|rows| DMatrix::from_row_slice(n, n, rows));
    // In units in which its diagonal is one: determinants of small masses vanish in others.
    let units = units(&matrices.mass, n);
    let alike = DMatrix::from_fn(n, n, |i, j| mass[(i, j)] * units[i] * units[j]);
    if alike.try_inverse().is_none() {
        return Err(Error::invalid("position", "the mass matrix is singular there"));
    }
    let scale = stiffness.amax();
    let is_symmetric = (&stiffness - stiffness.transpose()).amax() <= 1e-12 * scale;
    let symmetric = (damping.amax() == 0.0 && is_symmetric)
        .then(|| mass.clone().cholesky())
        .flatten()
        .and_then(|cholesky| {
            // L⁻¹ K L⁻ᵀ has the squares, and L⁻ᵀ its vectors as modes.
            let lower = cholesky.l();
            let half = lower.solve_lower_triangular(&stiffness).unwrap_or_else(|| stiffness.clone());
            let whole = lower.solve_lower_triangular(&half.transpose()).unwrap_or(half);
            let whole = (&whole + whole.transpose()) * 0.5;
            let (values, across) = jacobi::eigen(whole)?;
            let vectors = lower.transpose().solve_upper_triangular(&across).unwrap_or(across);
            let mut order: Vec<usize> = (0..n).collect();
            order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
            let squares = order.iter().map(|&k| values[k]).collect();
            let rows =
                order.iter().flat_map(|&k| vectors.column(k).iter().copied().collect::<Vec<f64>>()).collect();
            Some((squares, rows))
        });
    Ok(symmetric)
}

/// Whether all entries are numbers.
fn finite(matrices: &Matrices, n: usize) -> Result<()> {
    let named =
        [("stiffness", &matrices.stiffness), ("damping", &matrices.damping), ("mass", &matrices.mass)];
    for (name, entries) in named {
        if let Some(index) = entries.iter().position(|x| !x.is_finite()) {
            return Err(Error::invalid(
                "at",
                format!(
                    "expected forces that have derivatives at this place, but the {name} matrix has none in row {} and \
                     column {}: there is a kink there, as that of |x| or of dry friction at rest, or a pole; round it off, \
                     as by sqrt(x² + width²), or look at another place",
                    index / n,
                    index % n
                ),
            ));
        }
    }
    Ok(())
}
