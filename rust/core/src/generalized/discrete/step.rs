//! A step of the discrete equations of motion: from (q₀, p₀) to (q₁, p₁).
//!
//! The one idea: unknown are the displacements h·w of the control points from q₀, so that h·w is as good as w is. Momenta on
//! the way are compared with p₀, which leaves their small differences; p₁ = p₀ + h Σ b f, since the basis polynomials add to
//! one. Of one trajectory the lanes are the points of the quadrature.

use super::Equations;
use super::newton::{Corrections, Linear, MOST_CORRECTIONS, Verdict};
use super::table::Table;
use crate::error::{Error, Result};
use crate::expressions::Machine;
use crate::numerics::double_double::{two_product, two_sum};
use crate::numerics::lanes::{Lanes, WIDTH};
use std::sync::Arc;

/// What is left of a size a step later: a motion that stops at its turning points is no slow one.
const FADING: f64 = 0.95;
/// No velocity's scale is below this times the largest.
const LEAST_SCALE: f64 = 1e-8;
/// What a place's last digits make of a velocity, over a step, is this much larger than what round-off may be.
const OF_PLACES: f64 = 1e-3;

/// A node of a discrete path, and what is remembered of the way there.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Places, and what they leave out.
    pub(super) q: Vec<f64>,
    pub(super) q_rest: Vec<f64>,
    /// Momenta, and what they leave out.
    pub(super) p: Vec<f64>,
    pub(super) p_rest: Vec<f64>,
    /// Velocities.
    pub(super) v: Vec<f64>,
    /// Accelerations, about.
    a: Vec<f64>,
    /// How large velocities were lately.
    sizes: Vec<f64>,
}

/// What a segment between two places has.
pub(super) struct Segment {
    /// Momenta at its ends, −∂L_d/∂q₀ and ∂L_d/∂q₁, less the impulses of further forces.
    pub(super) before: Vec<f64>,
    pub(super) after: Vec<f64>,
    /// What those are made of.
    pub(super) sizes: Vec<f64>,
    /// The states and times of the quadrature.
    pub(super) states: Vec<Lanes>,
    pub(super) t: Lanes,
}

/// A method at work on one trajectory.
pub(super) struct Solver {
    equations: Arc<Equations>,
    pub(super) table: Table,
    rates: Machine<Lanes>,
    slopes: Machine<Lanes>,
    momenta: Machine<f64>,
    holonomic: Machine<f64>,
    /// The displacements of the control points over the step, point after point; then the multipliers.
    unknowns: Vec<f64>,
    residuals: Vec<f64>,
    /// ∂g/∂q at the beginning of the step.
    gradients: Vec<f64>,
    scales: Vec<f64>,
    linear: Linear,
    legendre: Linear,
    pub(super) evaluations: u64,
}

/// The larger of two sizes; what is no number is.
fn larger(a: f64, b: f64) -> f64 {
    if a <= b || b.is_nan() { b } else { a }
}

/// The sum and what it leaves out, of a number and what that left out, moved by a rate and a time.
fn moved(y: f64, rest: f64, rate: f64, time: f64) -> (f64, f64) {
    let (change, lost) = two_product(rate, time);
    let (sum, error) = two_sum(y, change);
    two_sum(sum, error + (lost + rest))
}

impl Node {
    /// At a state: momenta follow.
    fn new(q: &[f64], q_rest: &[f64], v: &[f64]) -> Self {
        let zeros = vec![0.0; q.len()];
        Self {
            q: q.to_vec(),
            q_rest: q_rest.to_vec(),
            p: zeros.clone(),
            p_rest: zeros.clone(),
            v: v.to_vec(),
            a: zeros.clone(),
            sizes: zeros,
        }
    }
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

    /// Finds the inner points of the segment between two places, of a solver whose ends are given.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub(super) fn segment(&mut self, (from, to): (&[f64], &[f64]), (t, h): (f64, f64)) -> Result<Segment> {
        let (n, s) = (self.equations.coordinates, self.table.degree);
        let zeros = vec![0.0; n];
        let node = Node::new(from, &zeros, &zeros);
        for j in 1..=s {
            for a in 0..n {
                self.unknowns[(j - 1) * n + a] = self.table.control[j] * ((to[a] - from[a]) / h);
            }
        }
        self.displace(&node, t, h)?;
        self.balance(&node, t, h);
        let before: Vec<f64> = self.residuals[..n].iter().map(|rest| -rest).collect();
        let mut after = before.clone();
        let mut sizes = zeros.clone();
        let straight: Vec<f64> = from.iter().zip(to).map(|(from, to)| (to - from) / h).collect();
        self.evaluate_momenta(from, &straight, t);
        for a in 0..n {
            let (force, momentum) = (self.rates.output(a).0, self.rates.output(n + a).0);
            for i in 0..self.table.count {
                let (weight, change) = (self.table.weights[i], h * force[i]);
                after[a] += weight * change;
                sizes[a] += weight * ((self.table.slopes[0][i] * momentum[i]).abs() + change.abs());
            }
            for b in 0..n {
                // A velocity is the difference of two places, over that of two times.
                let inertia = self.momenta.output(n + a * n + b);
                let times = straight[b].abs() * (t.abs() + (t + h).abs());
                sizes[a] += (inertia * ((from[b].abs() + to[b].abs() + times) / h)).abs();
            }
        }
        let mut states = vec![Lanes([0.0; WIDTH]); 2 * n];
        place(&self.table, &self.unknowns, &node, h, &mut states);
        Ok(Segment { before, after, sizes, states, t: times(&self.table, t, h) })
    }

    /// Adds what the multipliers at the beginning do to a momentum.
    fn push(&self, a: usize, into: &mut Node) {
        let (n, s) = (self.equations.coordinates, self.table.degree);
        for k in 0..self.equations.constraints {
            let impulse = self.gradients[k * n + a];
            (into.p[a], into.p_rest[a]) = moved(into.p[a], into.p_rest[a], impulse, self.unknowns[s * n + k]);
        }
    }

    /// Finds the displacements.
    fn displace(&mut self, from: &Node, t: f64, h: f64) -> Result<()> {
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
            self.set_scales(from, h);
            let Some(found) = self.linear.solved(&self.residuals) else { break };
            let mut most = 0.0;
            for (index, (unknown, correction)) in self.unknowns.iter_mut().zip(found).enumerate() {
                *unknown -= correction;
                if index < self.table.degree * self.scales.len() {
                    let size = correction.abs() * self.scales[index % self.scales.len()];
                    most = larger(size, most);
                }
            }
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
    fn balance(&mut self, from: &Node, t: f64, h: f64) {
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
        for a in 0..n {
            let mut size = from.sizes[a];
            for velocity in (0..s).map(|j| self.unknowns[j * n + a]).chain([from.v[a]]) {
                size = if velocity.abs() > size { velocity.abs() } else { size };
            }
            self.scales[a] = size + OF_PLACES * from.q[a].abs() / h.abs();
            most = if size > most { size } else { most };
        }
        for scale in &mut self.scales {
            let size = if *scale > LEAST_SCALE * most { *scale } else { LEAST_SCALE * most };
            *scale = if size > 0.0 { 1.0 / size } else { 0.0 };
        }
    }

    /// Finds the velocities of momenta, beginning with those that are there. With constraints momenta are changed along their
    /// gradients, so that velocities are as the constraints want them.
    fn velocities(&mut self, node: &mut Node, t: f64) -> Result<()> {
        let (n, c) = (self.equations.coordinates, self.equations.constraints);
        let (mut corrections, mut verdict) = (Corrections::new(), Verdict::Anew);
        let (mut multipliers, mut right) = (vec![0.0; c], vec![0.0; n + c]);
        for _ in 0..MOST_CORRECTIONS {
            self.evaluate_momenta(&node.q, &node.v, t);
            if c > 0 {
                self.evaluate_constraints(&node.q, &node.v, t);
            }
            for a in 0..n {
                right[a] = (node.p[a] - self.momenta.output(a)) + node.p_rest[a];
                for k in 0..c {
                    right[a] += self.holonomic.output(2 * c + k * n + a) * multipliers[k];
                }
            }
            for k in 0..c {
                right[n + k] = -self.holonomic.output(c + k);
            }
            if verdict == Verdict::Anew {
                let matrix = self.legendre.clear();
                for a in 0..n {
                    for b in 0..n {
                        matrix[(a, b)] = self.momenta.output(n + a * n + b);
                    }
                    for k in 0..c {
                        let gradient = self.holonomic.output(2 * c + k * n + a);
                        matrix[(a, n + k)] = -gradient;
                        matrix[(n + k, a)] = gradient;
                    }
                }
            }
            let Some(found) = self.legendre.solved(&right) else { break };
            let mut most = 0.0;
            for a in 0..n {
                node.v[a] += found[a];
                let size = found[a].abs() * self.scales[a];
                most = larger(size, most);
            }
            for k in 0..c {
                multipliers[k] += found[n + k];
            }
            verdict = corrections.judge(most);
            if verdict == Verdict::Lost {
                break;
            }
            if verdict == Verdict::Found {
                for a in 0..n {
                    for k in 0..c {
                        let gradient = self.holonomic.output(2 * c + k * n + a);
                        (node.p[a], node.p_rest[a]) =
                            moved(node.p[a], node.p_rest[a], gradient, multipliers[k]);
                    }
                }
                return Ok(());
            }
        }
        let message =
            "the momenta after a step have no velocities that Newton's method finds; take a smaller dt";
        Err(Error::Convergence { message: message.to_owned(), time: t })
    }

    fn evaluate_momenta(&mut self, q: &[f64], v: &[f64], t: f64) {
        let (places, velocities) = self.momenta.state().split_at_mut(q.len());
        places.copy_from_slice(q);
        velocities.copy_from_slice(v);
        self.momenta.run(t);
    }

    fn evaluate_constraints(&mut self, q: &[f64], v: &[f64], t: f64) {
        let (places, velocities) = self.holonomic.state().split_at_mut(q.len());
        places.copy_from_slice(q);
        velocities.copy_from_slice(v);
        self.holonomic.run(t);
    }
}

/// The times of the points of the quadrature.
fn times(table: &Table, t: f64, h: f64) -> Lanes {
    Lanes(table.points.map(|c| t + c * h))
}

/// Writes the states at the points of the quadrature.
fn place(table: &Table, unknowns: &[f64], from: &Node, h: f64, state: &mut [Lanes]) {
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
