//! The equations of the points of a segment: where momenta and forces balance, found by Newton's method.

use super::newton::{Corrections, MOST_CORRECTIONS, Verdict, larger};
use super::node::{Node, moved};
use super::step::Solver;
use super::table::Table;
use crate::error::{Error, Result};
use crate::numerics::lanes::{Lanes, WIDTH};

/// No velocity's scale is below this times the largest.
const LEAST_SCALE: f64 = 1e-8;
/// What a place's last digits make of a velocity, over a step, is this much larger than what round-off may be.
const OF_PLACES: f64 = 5e-2;

impl Solver {
    /// Finds the displacements.
    pub(super) fn displace(&mut self, from: &Node, t: f64, h: f64) -> Result<()> {
        let (mut corrections, mut verdict) = (Corrections::new(), Verdict::Anew);
        if self.linear.len() == 0 {
            verdict = Verdict::Found;
        }
        for _ in 0..MOST_CORRECTIONS {
            self.evaluate_rates(from, t, h);
            if verdict == Verdict::Found {
                return Ok(());
            }
            self.balance(from, t, h);
            if verdict == Verdict::Anew {
                self.derive(from, t, h);
            }
            if !self.linear.solve(&self.residuals) {
                break;
            }
            for (unknown, correction) in self.unknowns.iter_mut().zip(self.linear.found()) {
                *unknown -= correction;
            }
            self.set_scales(from, h);
            let n = self.scales.len();
            let of_points = self.linear.found().iter().take(self.table.degree * n).enumerate();
            let most = of_points.map(|(index, x)| x.abs() * self.scales[index % n]).fold(0.0, larger);
            verdict = corrections.judge(most);
            if verdict == Verdict::Lost {
                break;
            }
        }
        let message = format!(
            "the discrete Euler–Lagrange equations of a step of {h:e} are not solved by Newton's method; take a smaller dt"
        );
        Err(Error::Convergence { message, time: t })
    }

    /// Forces and momenta at the points of the quadrature.
    fn evaluate_rates(&mut self, from: &Node, t: f64, h: f64) {
        place(&self.table, &self.unknowns, from, h, self.rates.state());
        self.rates.run(times(&self.table, t, h));
        self.evaluations += 1;
    }

    /// What is left of the equations: a row for every control point but the last, then the constraints at the end.
    pub(super) fn balance(&mut self, from: &Node, t: f64, h: f64) {
        let (n, s) = (self.equations.coordinates, self.table.degree);
        let table = &self.table;
        for a in 0..n {
            let (force, momentum) = (self.rates.output(a).0, self.rates.output(n + a).0);
            for j in 0..s {
                // Weighted slopes of p₀ add to what is known, and what coefficients have lost of it is added again: a defect
                // would pull at every step to the same side.
                let mut sum = table.defects[j] * from.p[a] + if j == 0 { from.p_rest[a] } else { 0.0 };
                for i in 0..table.count {
                    let change = momentum[i] - from.p[a];
                    let lost = if j == 0 { table.first_rest[i] * change } else { 0.0 };
                    let moved = h * table.values[j][i] * force[i] + (table.slopes[j][i] * change + lost);
                    sum += table.weights[i] * moved;
                }
                self.residuals[j * n + a] = sum;
            }
        }
        let c = self.equations.constraints;
        if c == 0 {
            return;
        }
        let mut end = vec![0.0; n];
        for a in 0..n {
            for k in 0..c {
                self.residuals[a] += self.gradients[k * n + a] * self.unknowns[s * n + k];
            }
            end[a] = moved(from.q[a], from.q_rest[a], self.unknowns[(s - 1) * n + a], h).0;
        }
        self.evaluate_constraints(&end, &from.v, t + h);
        for k in 0..c {
            self.residuals[s * n + k] = self.holonomic.output(k) / h;
        }
    }

    /// The derivatives of those rows with respect to the unknowns; constraints are those that were evaluated last.
    fn derive(&mut self, from: &Node, t: f64, h: f64) {
        let (n, s, c) = (self.equations.coordinates, self.table.degree, self.equations.constraints);
        place(&self.table, &self.unknowns, from, h, self.slopes.state());
        self.slopes.run(times(&self.table, t, h));
        self.evaluations += 1;
        let table = &self.table;
        let matrix = self.linear.clear();
        for (index, &(of, by)) in self.equations.places.iter().enumerate() {
            let slope = self.slopes.output(index).0;
            for j in 0..s {
                for k in 1..=s {
                    let mut sum = 0.0;
                    for i in 0..table.count {
                        let row = if of < n { h * table.values[j][i] } else { table.slopes[j][i] };
                        let column = if by < n { h * table.values[k][i] } else { table.slopes[k][i] };
                        sum += table.weights[i] * row * column * slope[i];
                    }
                    matrix[(j * n + of % n, (k - 1) * n + by % n)] += sum;
                }
            }
        }
        for k in 0..c {
            for a in 0..n {
                matrix[(a, s * n + k)] = self.gradients[k * n + a];
                matrix[(s * n + k, (s - 1) * n + a)] = self.holonomic.output(2 * c + k * n + a);
            }
        }
    }

    /// What corrections are measured by.
    fn set_scales(&mut self, from: &Node, h: f64) {
        let (n, s) = (self.equations.coordinates, self.table.degree);
        let mut most = 0.0;
        // Constraints are told to the last digits of all places that they have.
        let all = from.q.iter().fold(0.0, |most, q| larger(most, q.abs()));
        for a in 0..n {
            let mut size = from.sizes[a];
            for velocity in (0..s).map(|j| self.unknowns[j * n + a]).chain([from.v[a]]) {
                size = if velocity.abs() > size { velocity.abs() } else { size };
            }
            let place = if self.equations.constraints > 0 { all } else { from.q[a].abs() };
            self.scales[a] = size + OF_PLACES * place / h.abs();
            most = if size > most { size } else { most };
        }
        for scale in &mut self.scales {
            let size = if *scale > LEAST_SCALE * most { *scale } else { LEAST_SCALE * most };
            *scale = if size > 0.0 { 1.0 / size } else { 0.0 };
        }
    }
}

/// The times of the points of the quadrature.
pub(super) fn times(table: &Table, t: f64, h: f64) -> Lanes {
    Lanes(table.points.map(|c| t + c * h))
}

/// Writes the states at the points of the quadrature.
pub(super) fn place(table: &Table, unknowns: &[f64], from: &Node, h: f64, state: &mut [Lanes]) {
    let n = from.q.len();
    for a in 0..n {
        for lane in 0..WIDTH {
            let (mut displacement, mut velocity) = (0.0, 0.0);
            for j in 1..=table.degree {
                let unknown = unknowns[(j - 1) * n + a];
                displacement += table.values[j][lane] * unknown;
                velocity += table.slopes[j][lane] * unknown;
            }
            state[a].0[lane] = from.q[a] + (h * displacement + from.q_rest[a]);
            state[n + a].0[lane] = velocity;
        }
    }
}
