//! How the points of a rigid body move: by one velocity and one angular velocity, as a screw does.
//!
//! The one idea: v(r) = v₀ + ω × (r − r₀). Differences and products are kept in double-double, so that a base point far
//! away, or near the axis, costs no digits.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. § 4.9 (Chasles); Ball, *A Treatise on the Theory of
//! Screws* (1900).

use super::quaternion::length;
use crate::error::{Error, Result};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;

/// The motion of a body at one time, as a screw.
#[derive(Clone, Copy, Debug)]
pub struct Screw {
    /// The point of the axis that is nearest to the base point.
    pub point: [f64; 3],
    /// A unit vector along the axis: of the angular velocity, or of the velocity where there is none.
    pub direction: [f64; 3],
    /// |ω|.
    pub rate: f64,
    /// The velocity along the axis, of every point.
    pub speed: f64,
    /// How far it goes in one radian; infinite where it does not turn.
    pub pitch: f64,
}

fn of(value: f64) -> DoubleDouble {
    DoubleDouble::from(value)
}

/// The vector product.
fn cross(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    core::array::from_fn(|at| {
        let (i, j) = ((at + 1) % 3, (at + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

fn in_range<const K: usize>(argument: &str, values: [f64; K]) -> Result<[f64; K]> {
    if values.iter().all(|value| value.is_finite()) {
        return Ok(values);
    }
    let message = "expected numbers whose products stay within the range of float64; choose other units";
    Err(Error::invalid(argument, message))
}

/// The velocity of a point of a body of which another point has that velocity.
///
/// # Errors
/// `InvalidInput` where the result, or a product on the way, is out of range.
pub fn at(point: [f64; 3], velocity: [f64; 3], spin: [f64; 3], about: [f64; 3]) -> Result<[f64; 3]> {
    let offset = core::array::from_fn(|axis| DoubleDouble::sum(point[axis], -about[axis]));
    let turned = cross(spin.map(of), offset);
    in_range("point", core::array::from_fn(|axis| (turned[axis] + of(velocity[axis])).to_f64()))
}

/// The screw that a body moves as, of which a point has that velocity.
///
/// # Errors
/// `InvalidInput` for a body at rest, or where the axis is out of range.
pub fn screw(velocity: [f64; 3], spin: [f64; 3], about: [f64; 3]) -> Result<Screw> {
    let (rate, speed) = (length(spin), length(velocity));
    if rate == 0.0 {
        if speed == 0.0 {
            let message = "expected a body that moves: one at rest has no axis";
            return Err(Error::invalid("angular_velocity", message));
        }
        let direction = unit(velocity);
        let [speed] = in_range("velocity", [speed])?;
        return Ok(Screw { point: about, direction, rate, speed, pitch: f64::INFINITY });
    }
    // Of order one, so that squares are in range; what is taken out comes back at the end.
    let (by, per) = (exponent(rate), exponent(speed));
    let (w, v) = (spin.map(|part| of(scale(part, -by))), velocity.map(|part| of(scale(part, -per))));
    let square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    let along = w[0] * v[0] + w[1] * v[1] + w[2] * v[2];
    let back = |value: DoubleDouble| scale(value.to_f64(), per - by);
    let across = cross(w, v);
    let point = core::array::from_fn(|axis| about[axis] + back(across[axis] / square));
    let speed = scale((along / square.sqrt()).to_f64(), per);
    let pitch = back(along / square);
    let [rate, speed, pitch] = in_range("angular_velocity", [rate, speed, pitch])?;
    Ok(Screw { point: in_range("angular_velocity", point)?, direction: unit(spin), rate, speed, pitch })
}

/// Along a vector that is not zero.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let by =
        v.iter().fold(i32::MIN, |most, part| if *part == 0.0 { most } else { most.max(exponent(*part)) });
    let v = v.map(|part| scale(part, -by));
    let size = length(v);
    v.map(|part| part / size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = [f64; 3]> {
        prop::array::uniform3(-2.0..2.0f64)
    }

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|at| a[at] * b[at]).sum()
    }

    fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        core::array::from_fn(|at| a[at] - b[at])
    }

    proptest! {
        #[test]
        fn distances_stay_and_the_base_point_does_not_matter(
            a in vector(), b in vector(), v in vector(), w in vector(), base in vector()
        ) {
            let [at_a, at_b] = [a, b].map(|point| at(point, v, w, base).unwrap_or([f64::NAN; 3]));
            prop_assert!(dot(less(a, b), less(at_a, at_b)).abs() <= 1e-14);
            let again = at(b, at_a, w, a).unwrap_or([f64::NAN; 3]);
            prop_assert!(less(again, at_b).iter().all(|part| part.abs() <= 2e-15), "{again:?} {at_b:?}");
        }
        #[test]
        fn points_of_the_axis_go_along_it(v in vector(), w in vector(), base in vector()) {
            prop_assume!(length(w) > 0.1);
            let Ok(screw) = screw(v, w, base) else { return Err(TestCaseError::fail("no screw")) };
            let there = at(screw.point, v, w, base).unwrap_or([f64::NAN; 3]);
            for axis in 0..3 {
                prop_assert!((there[axis] - screw.speed * screw.direction[axis]).abs() <= 4e-15 * (1.0 + length(v)));
            }
            // The foot of the perpendicular, and the invariant ω·v.
            prop_assert!(dot(less(screw.point, base), w).abs() <= 2e-15 * (1.0 + length(v)));
            prop_assert!((screw.pitch * screw.rate - screw.speed).abs() <= 1e-15 * (1.0 + length(v)));
        }
    }
}
