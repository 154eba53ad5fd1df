//! A step of the discrete equations of motion: from (q₀, p₀) to (q₁, p₁).
//!
//! The one idea: unknown are the displacements h·w of the control points from q₀, so that h·w is as good as w is. Momenta on
//! the way are compared with p₀, which leaves their small differences; p₁ = p₀ + h Σ b f, since the basis polynomials add to
//! one. Of one trajectory the lanes are the points of the quadrature.

use super::Equations;
use super::newton::Linear;
use super::node::{Node, moved};
use super::table::Table;
use crate::error::Result;
use crate::expressions::Machine;
use crate::numerics::lanes::{Lanes, WIDTH};
use std::sync::Arc;

/// What is left of a size a step later: a motion that stops at its turning points is no slow one.
const FADING: f64 = 0.95;

/// A method at work on one trajectory.
pub(super) struct Solver {
    pub(super) equations: Arc<Equations>,
    pub(super) table: Table,
    pub(super) rates: Machine<Lanes>,
    pub(super) slopes: Machine<Lanes>,
    pub(super) momenta: Machine<f64>,
    pub(super) holonomic: Machine<f64>,
    /// The displacements of the control points over the step, point after point; then the multipliers.
    pub(super) unknowns: Vec<f64>,
    pub(super) residuals: Vec<f64>,
    /// ∂g/∂q at the beginning of the step.
    pub(super) gradients: Vec<f64>,
    pub(super) scales: Vec<f64>,
    pub(super) linear: Linear,
    pub(super) legendre: Linear,
    pub(super) evaluations: u64,
}

impl Solver {
    /// For steps, or, if the ends are given, for segments.
    pub(super) fn new(equations: &Arc<Equations>, parameters: &[f64], ends: bool) -> Self {
        let table = Table::new(equations.method.rule);
        let wide: Vec<Lanes> = parameters.iter().map(|&value| Lanes([value; WIDTH])).collect();
        let (n, c) = (equations.coordinates, equations.constraints);
        let unknowns = table.degree * n + c;
        Self {
            table,
            rates: Machine::new(equations.rates.clone(), &wide),
            slopes: Machine::new(equations.slopes.clone(), &wide),
            momenta: Machine::new(equations.momenta.clone(), parameters),
            holonomic: Machine::new(equations.holonomic.clone(), parameters),
            unknowns: vec![0.0; unknowns],
            residuals: vec![0.0; unknowns],
            gradients: vec![0.0; c * n],
            scales: vec![0.0; n],
            linear: Linear::new(unknowns, if ends { n } else { 0 }),
            legendre: Linear::new(n + c, 0),
            evaluations: 0,
            equations: equations.clone(),
        }
    }

    /// The node of a state.
    pub(super) fn node(&mut self, (q, q_rest): (&[f64], &[f64]), v: &[f64], t: f64) -> Node {
        let mut node = Node::new(q, q_rest, v);
        self.evaluate_momenta(q, v, t);
        for (index, p) in node.p.iter_mut().enumerate() {
            *p = self.momenta.output(index);
        }
        node
    }

    /// A step from a node at a time into another node.
    ///
    /// # Errors
    /// [`Error::Convergence`] where no solution is found.
    pub(super) fn step(&mut self, from: &Node, (t, h): (f64, f64), into: &mut Node) -> Result<()> {
        let (n, s) = (self.equations.coordinates, self.table.degree);
        if self.equations.constraints > 0 {
            self.evaluate_constraints(&from.q, &from.v, t);
            for (index, gradient) in self.gradients.iter_mut().enumerate() {
                *gradient = self.holonomic.output(2 * self.equations.constraints + index);
            }
        }
        for j in 1..=s {
            let c = self.table.control[j];
            for a in 0..n {
                self.unknowns[(j - 1) * n + a] = c * (from.v[a] + 0.5 * c * h * from.a[a]);
            }
        }
        self.unknowns[s * n..].fill(0.0);
        self.displace(from, t, h)?;

        let last = (s - 1) * n;
        for a in 0..n {
            let rate = self.unknowns[last + a];
            (into.q[a], into.q_rest[a]) = moved(from.q[a], from.q_rest[a], rate, h);
            let force =
                (0..self.table.count).map(|i| self.table.weights[i] * self.rates.output(a).0[i]).sum();
            (into.p[a], into.p_rest[a]) = moved(from.p[a], from.p_rest[a], force, h);
            self.push(a, into);
            into.v[a] = (1..=s).map(|j| self.table.last_slopes[j] * self.unknowns[(j - 1) * n + a]).sum();
            let size = FADING * from.sizes[a];
            let now = from.v[a].abs() + rate.abs();
            into.sizes[a] = if now > size { now } else { size };
        }
        self.velocities(into, t + h)?;
        for a in 0..n {
            into.a[a] = (into.v[a] - from.v[a]) / h;
        }
        Ok(())
    }

    /// Adds what the multipliers at the beginning do to a momentum.
    fn push(&self, a: usize, into: &mut Node) {
        let (n, s) = (self.equations.coordinates, self.table.degree);
        for k in 0..self.equations.constraints {
            let impulse = self.gradients[k * n + a];
            (into.p[a], into.p_rest[a]) = moved(into.p[a], into.p_rest[a], impulse, self.unknowns[s * n + k]);
        }
    }
}
