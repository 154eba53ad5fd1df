//! The conserved quantities of a state: energy, momenta, centre of mass, virial.
//!
//! Sums are exact to about twice double precision (double-double for small systems, compensated beyond),
//! so that a drift that is seen is the integrator's and not the sum's.

use crate::error::Result;
use crate::numerics::double_double::{DoubleDouble, two_sum};
use crate::numerics::real::Real;
use crate::scene::ForceSpec;

/// Up to this many particles pair sums are double-double.
const ALL_DOUBLE_DOUBLE: usize = 64;

/// A particle at a time: values and what they leave out.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Mass.
    pub mass: f64,
    /// Position.
    pub position: [DoubleDouble; 3],
    /// Velocity.
    pub velocity: [DoubleDouble; 3],
}

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

fn dot(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    core::array::from_fn(|c| a[c] - b[c])
}

/// ½ Σ m v².
pub fn kinetic_energy(bodies: &[Body]) -> DoubleDouble {
    let mut sum = DoubleDouble::zero();
    for body in bodies {
        sum += DoubleDouble::from(0.5 * body.mass) * dot(body.velocity, body.velocity);
    }
    sum
}

/// Calls `visit(i, j, 1/√(r² + ε²), r²)` for every pair that attracts.
fn pairs(bodies: &[Body], softening: f64, mut visit: impl FnMut(usize, usize, DoubleDouble, DoubleDouble)) {
    let softening2 = DoubleDouble::product(softening, softening);
    for i in 0..bodies.len() {
        for j in i + 1..bodies.len() {
            if bodies[i].mass * bodies[j].mass > 0.0 {
                let d = minus(bodies[j].position, bodies[i].position);
                let r2 = dot(d, d);
                let inverse = DoubleDouble::one() / (r2 + softening2).sqrt();
                visit(i, j, inverse, r2);
            }
        }
    }
}

/// As [`pairs`], in double precision with compensated sums: Σ mᵢmⱼ/√(r²+ε²) and Σ mᵢmⱼ r²/(r²+ε²)^{3/2}.
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

/// Potential energy and virial Σ r·F of all forces of a scene.
pub fn potential_and_virial(forces: &[ForceSpec], bodies: &[Body]) -> (DoubleDouble, DoubleDouble) {
    let (mut potential, mut virial) = (DoubleDouble::zero(), DoubleDouble::zero());
    for force in forces {
        match force {
            ForceSpec::Gravity { constant, softening } => {
                let (mut depth, mut work) = (DoubleDouble::zero(), DoubleDouble::zero());
                if bodies.len() > ALL_DOUBLE_DOUBLE {
                    (depth, work) = many_pairs(bodies, *softening);
                } else {
                    pairs(bodies, *softening, |i, j, inverse, r2| {
                        let term = DoubleDouble::product(bodies[i].mass, bodies[j].mass) * inverse;
                        depth += term;
                        work += if *softening == 0.0 { term } else { term * (r2 * inverse * inverse) };
                    });
                }
                let constant = DoubleDouble::from(-constant);
                potential += constant * depth;
                virial += constant * work;
            }
            ForceSpec::UniformField { g } => {
                let g = g.map(DoubleDouble::from);
                for body in bodies {
                    let work = DoubleDouble::from(body.mass) * dot(g, body.position);
                    potential -= work;
                    virial += work;
                }
            }
            ForceSpec::CentralField { potential: shape, center } => {
                for body in bodies {
                    let d = minus(body.position, center.map(DoubleDouble::from));
                    let r = dot(d, d).sqrt();
                    potential += shape.precise_value(r);
                    let pull = DoubleDouble::from(shape.evaluate(&[r.to_f64()])[1][0]) / r;
                    virial += pull * dot(d, body.position);
                }
            }
        }
    }
    (potential, virial)
}

/// Σ m v.
pub fn momentum(bodies: &[Body]) -> [DoubleDouble; 3] {
    weighted(bodies, |body| body.velocity)
}

/// Σ m r.
fn weighted(bodies: &[Body], of: impl Fn(&Body) -> [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    let mut sum = [DoubleDouble::zero(); 3];
    for body in bodies {
        let value = of(body);
        for c in 0..3 {
            sum[c] += DoubleDouble::from(body.mass) * value[c];
        }
    }
    sum
}

/// Σ m r / Σ m; of massless bodies alone, their mean.
pub fn center_of_mass(bodies: &[Body]) -> [DoubleDouble; 3] {
    let mut total = DoubleDouble::zero();
    for body in bodies {
        total += DoubleDouble::from(body.mass);
    }
    if total.to_f64() > 0.0 {
        return weighted(bodies, |body| body.position).map(|x| x / total);
    }
    let mut sum = [DoubleDouble::zero(); 3];
    for body in bodies {
        for c in 0..3 {
            sum[c] += body.position[c];
        }
    }
    sum.map(|x| x / DoubleDouble::from(bodies.len() as f64))
}

/// Σ m (r − about) × v.
pub fn angular_momentum(bodies: &[Body], about: [f64; 3]) -> [DoubleDouble; 3] {
    weighted(bodies, |body| {
        let r = minus(body.position, about.map(DoubleDouble::from));
        let v = body.velocity;
        [r[1] * v[2] - r[2] * v[1], r[2] * v[0] - r[0] * v[2], r[0] * v[1] - r[1] * v[0]]
    })
}

/// The numbers of a derived column for one state: one for an energy or the virial, else three.
///
/// # Errors
/// An unknown column.
pub fn column(name: &str, forces: &[ForceSpec], bodies: &[Body], about: [f64; 3]) -> Result<Vec<f64>> {
    let one = |value: DoubleDouble| Ok(vec![value.to_f64()]);
    let three = |value: [DoubleDouble; 3]| Ok(value.map(DoubleDouble::to_f64).to_vec());
    match name {
        "kinetic_energy" => one(kinetic_energy(bodies)),
        "potential_energy" => one(potential_and_virial(forces, bodies).0),
        "energy" => one(kinetic_energy(bodies) + potential_and_virial(forces, bodies).0),
        "virial" => one(potential_and_virial(forces, bodies).1),
        "momentum" => three(momentum(bodies)),
        "angular_momentum" => three(angular_momentum(bodies, about)),
        "center_of_mass" => three(center_of_mass(bodies)),
        _ => Err(crate::words::unknown("columns", name, COLUMNS.into_iter())),
    }
}

/// The columns that [`column`] knows.
pub const COLUMNS: [&str; 7] = [
    "kinetic_energy",
    "potential_energy",
    "energy",
    "virial",
    "momentum",
    "angular_momentum",
    "center_of_mass",
];

/// Those of [`COLUMNS`] that are one number and not a vector.
pub const SCALARS: [&str; 4] = ["kinetic_energy", "potential_energy", "energy", "virial"];
