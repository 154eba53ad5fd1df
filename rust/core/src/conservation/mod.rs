//! The conserved quantities of a state: energy, momenta, centre of mass, virial.
//!
//! Sums are exact to about twice double precision (double-double for small systems, compensated beyond),
//! so that a drift that is seen is the integrator's and not the sum's.

pub use crate::forces::Body;

use crate::error::Result;
use crate::forces::ForceTerm;
use crate::forces::body::{dot, exact, minus};
use crate::forces::term::potential_and_virial;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use std::sync::Arc;

/// ½ Σ m v².
pub fn kinetic_energy(bodies: &[Body]) -> DoubleDouble {
    let mut sum = DoubleDouble::zero();
    for body in bodies {
        sum += DoubleDouble::from(0.5 * body.mass) * dot(body.velocity, body.velocity);
    }
    sum
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
        let r = minus(body.position, exact(about));
        let v = body.velocity;
        [r[1] * v[2] - r[2] * v[1], r[2] * v[0] - r[0] * v[2], r[0] * v[1] - r[1] * v[0]]
    })
}

/// The numbers of a derived column for one state: one for an energy or the virial, else three.
///
/// # Errors
/// An unknown column.
pub fn column(
    name: &str,
    forces: &[Arc<dyn ForceTerm>],
    bodies: &[Body],
    about: [f64; 3],
) -> Result<Vec<f64>> {
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
