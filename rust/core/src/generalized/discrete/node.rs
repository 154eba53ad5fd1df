//! Nodes of a discrete path: places and momenta with what they leave out.

use crate::numerics::double_double::{two_product, two_sum};

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
    pub(super) a: Vec<f64>,
    /// How large velocities were lately.
    pub(super) sizes: Vec<f64>,
}

impl Node {
    /// At a state: momenta follow.
    pub(super) fn new(q: &[f64], q_rest: &[f64], v: &[f64]) -> Self {
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

/// The sum and what it leaves out, of a number and what that left out, moved by a rate and a time.
pub(super) fn moved(y: f64, rest: f64, rate: f64, time: f64) -> (f64, f64) {
    let (change, lost) = two_product(rate, time);
    let (sum, error) = two_sum(y, change);
    two_sum(sum, error + (lost + rest))
}
