//! Velocities of momenta: Legendre's transformation at a node, on the constraints if there are any.

use super::newton::{Corrections, MOST_CORRECTIONS, Verdict, larger};
use super::node::{Node, moved};
use super::step::Solver;
use crate::error::{Error, Result};

impl Solver {
    /// Finds the velocities of momenta, beginning with those that are there. With constraints momenta are changed along their
    /// gradients, so that velocities are as the constraints want them.
    pub(super) fn velocities(&mut self, node: &mut Node, t: f64) -> Result<()> {
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
            if !self.legendre.solve(&right) {
                break;
            }
            let found = self.legendre.found();
            let mut most = 0.0;
            for a in 0..n {
                node.v[a] += found[a];
                most = larger(most, found[a].abs() * self.scales[a]);
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

    pub(super) fn evaluate_momenta(&mut self, q: &[f64], v: &[f64], t: f64) {
        let (places, velocities) = self.momenta.state().split_at_mut(q.len());
        places.copy_from_slice(q);
        velocities.copy_from_slice(v);
        self.momenta.run(t);
    }

    pub(super) fn evaluate_constraints(&mut self, q: &[f64], v: &[f64], t: f64) {
        let (places, velocities) = self.holonomic.state().split_at_mut(q.len());
        places.copy_from_slice(q);
        velocities.copy_from_slice(v);
        self.holonomic.run(t);
    }
}
