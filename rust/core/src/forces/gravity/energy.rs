//! Potential energy and virial of gravity: the sums over pairs.
//!
//! Double-double for small systems, compensated beyond, so that a drift that is seen is the integrator's and not the
//! sum's.

use crate::forces::body::{Body, dot, minus};
use crate::numerics::double_double::{DoubleDouble, two_sum};
use crate::numerics::real::Real;

/// Up to this many particles pair sums are double-double.
const ALL_DOUBLE_DOUBLE: usize = 64;

/// A compensated sum (Kahan–Babuška, two-sum form).
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    sum: f64,
    rest: f64,
}

impl Sum {
    fn add(&mut self, value: f64) {
        let (sum, error) = two_sum(self.sum, value);
        self.sum = sum;
        self.rest += error;
    }
    fn value(self) -> DoubleDouble {
        DoubleDouble::sum(self.sum, self.rest)
    }
}

/// Σ mᵢmⱼ/√(r²+ε²) and Σ mᵢmⱼ r²/(r²+ε²)^{3/2} over all pairs.
pub fn pair_sums(bodies: &[Body], softening: f64) -> (DoubleDouble, DoubleDouble) {
    if bodies.len() > ALL_DOUBLE_DOUBLE {
        return many_pairs(bodies, softening);
    }
    let (mut depth, mut work) = (DoubleDouble::zero(), DoubleDouble::zero());
    let softening2 = DoubleDouble::product(softening, softening);
    for i in 0..bodies.len() {
        for j in i + 1..bodies.len() {
            if bodies[i].mass * bodies[j].mass > 0.0 {
                let d = minus(bodies[j].position, bodies[i].position);
                let r2 = dot(d, d);
                let inverse = DoubleDouble::one() / (r2 + softening2).sqrt();
                let term = DoubleDouble::product(bodies[i].mass, bodies[j].mass) * inverse;
                depth += term;
                work += if softening == 0.0 { term } else { term * (r2 * inverse * inverse) };
            }
        }
    }
    (depth, work)
}

/// As [`pair_sums`], in double precision with compensated sums.
fn many_pairs(bodies: &[Body], softening: f64) -> (DoubleDouble, DoubleDouble) {
    let (mut potential, mut virial) = (Sum::default(), Sum::default());
    let places: Vec<[f64; 3]> = bodies.iter().map(|body| body.position.map(DoubleDouble::to_f64)).collect();
    for i in 0..bodies.len() {
        if bodies[i].mass == 0.0 {
            continue;
        }
        for j in i + 1..bodies.len() {
            let [dx, dy, dz] = core::array::from_fn(|c| places[j][c] - places[i][c]);
            let r2 = dx * dx + dy * dy + dz * dz;
            let soft2 = r2 + softening * softening;
            if soft2 > 0.0 {
                let term = bodies[i].mass * bodies[j].mass / soft2.sqrt();
                potential.add(term);
                virial.add(term * (r2 / soft2));
            }
        }
    }
    (potential.value(), virial.value())
}
