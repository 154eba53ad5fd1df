//! Rotations as unit quaternions (x, y, z, w), the scalar last, and what else people write them as.
//!
//! The one idea: no angle is ever taken from a cosine. Where a square root or an arctangent is needed, its argument is
//! one that is not small. What is not a rotation is refused; what differs from one by rounding is taken as it is.
//! Sources: Shepperd, J. Guidance 1 (1978) 223 (matrices); Diebel, *Representing Attitude* (2006).

use crate::error::{Error, Result};
use crate::numerics::angles::{atan2_parts, sin_cos};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;
use crate::words::number;

/// (x, y, z, w).
pub type Quaternion = [f64; 4];
/// Rows.
pub type Matrix = [[f64; 3]; 3];

/// No rotation.
pub const IDENTITY: Quaternion = [0.0, 0.0, 0.0, 1.0];
/// How far from a rotation numbers may be that are meant as one.
const TOLERANCE: f64 = 1e-6;
/// |q|² − 1 of what is a unit quaternion but for rounding.
const ROUNDING: f64 = 1e-15;

/// The scalar product.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A quaternion of unit length: as it is if it has that but for rounding, made so within 1e-6.
///
/// # Errors
/// `InvalidInput` for any other length.
#[inline]
pub fn unit(argument: &str, q: Quaternion) -> Result<Quaternion> {
    let square = q.iter().map(|part| part * part).sum::<f64>();
    if (square - 1.0).abs() <= ROUNDING { Ok(q) } else { nearly_unit(argument, q, square) }
}

#[cold]
fn nearly_unit(argument: &str, q: Quaternion, square: f64) -> Result<Quaternion> {
    let length = square.sqrt();
    if (length - 1.0).abs() <= TOLERANCE {
        return Ok(q.map(|part| part / length));
    }
    let message =
        format!("expected a quaternion of length 1 within 1e-6, got one of length {}; ", number(length));
    let advice = if length == 0.0 { "zero is no rotation" } else { "divide it by its length" };
    Err(Error::invalid(argument, message + advice))
}

/// The rotation by `b`, then by `a`.
#[inline]
pub fn product(a: Quaternion, b: Quaternion) -> Quaternion {
    let ([ax, ay, az, aw], [bx, by, bz, bw]) = (a, b);
    [
        (aw * bx + ax * bw) + (ay * bz - az * by),
        (aw * by + ay * bw) + (az * bx - ax * bz),
        (aw * bz + az * bw) + (ax * by - ay * bx),
        (aw * bw - ax * bx) - (ay * by + az * bz),
    ]
}

/// The rotation back.
#[inline]
pub fn conjugate([x, y, z, w]: Quaternion) -> Quaternion {
    [-x, -y, -z, w]
}

/// A vector, rotated.
#[inline]
pub fn rotated([x, y, z, w]: Quaternion, v: [f64; 3]) -> [f64; 3] {
    let twice = cross([x, y, z], v).map(|part| 2.0 * part);
    let across = cross([x, y, z], twice);
    [v[0] + (w * twice[0] + across[0]), v[1] + (w * twice[1] + across[1]), v[2] + (w * twice[2] + across[2])]
}

/// The matrix of a rotation: its columns are the rotated axes.
pub fn matrix([x, y, z, w]: Quaternion) -> Matrix {
    let (xx, yy, zz) = (2.0 * x * x, 2.0 * y * y, 2.0 * z * z);
    let (xy, yz, zx) = (2.0 * x * y, 2.0 * y * z, 2.0 * z * x);
    let (wx, wy, wz) = (2.0 * w * x, 2.0 * w * y, 2.0 * w * z);
    [
        [1.0 - (yy + zz), xy - wz, zx + wy],
        [xy + wz, 1.0 - (zz + xx), yz - wx],
        [zx - wy, yz + wx, 1.0 - (xx + yy)],
    ]
}

/// The rotation of a matrix, with w ≥ 0 where it matters least: the largest part is positive.
///
/// # Errors
/// `InvalidInput` for a matrix that is none of a rotation, by more than 1e-6.
pub fn from_matrix(argument: &str, m: Matrix) -> Result<Quaternion> {
    let off = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| {
        let sum = (0..3).map(|k| m[k][i] * m[k][j]).sum::<f64>();
        (sum - f64::from(u8::from(i == j))).abs()
    });
    // A NaN stays, where the larger of two would drop it.
    let off = off.fold(0.0, |most: f64, each| if each <= most { most } else { each });
    if off.is_nan() || off > TOLERANCE {
        let message = format!(
            "expected a rotation matrix, whose columns are unit vectors at right angles within 1e-6, but they are off \
             by {}",
            number(off)
        );
        return Err(Error::invalid(argument, message));
    }
    if dot(m[0], cross(m[1], m[2])) < 0.0 {
        let message = "expected a rotation matrix, got one of determinant -1: a reflection, or axes that are left-handed";
        return Err(Error::invalid(argument, message));
    }
    let trace = m[0][0] + m[1][1] + m[2][2];
    let largest = [m[0][0], m[1][1], m[2][2], trace];
    let which = (0..4).fold(3, |best, at| if largest[at] > largest[best] { at } else { best });
    let mut q = [0.0; 4];
    if which == 3 {
        q = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1.0 + trace];
    } else {
        let (i, j, k) = (which, (which + 1) % 3, (which + 2) % 3);
        q[i] = 1.0 + (m[i][i] - (m[j][j] + m[k][k]));
        q[j] = m[j][i] + m[i][j];
        q[k] = m[k][i] + m[i][k];
        q[3] = m[k][j] - m[j][k];
    }
    // One step with 4 q qᵀ, all of which the matrix tells: the rounding of each of its entries counts once.
    let [x, y, z, w] = q;
    let (a, b, c) = (m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]);
    let (d, e, f) = (m[1][0] + m[0][1], m[2][1] + m[1][2], m[0][2] + m[2][0]);
    let q = [
        (1.0 + (m[0][0] - (m[1][1] + m[2][2]))) * x + d * y + f * z + a * w,
        d * x + (1.0 + (m[1][1] - (m[2][2] + m[0][0]))) * y + e * z + b * w,
        f * x + e * y + (1.0 + (m[2][2] - (m[0][0] + m[1][1]))) * z + c * w,
        a * x + b * y + c * z + (1.0 + trace) * w,
    ];
    let length = q.iter().map(|part| part * part).sum::<f64>().sqrt();
    Ok(q.map(|part| part / length))
}

/// The length of a vector, whatever its size.
pub fn length(v: [f64; 3]) -> f64 {
    exact_length(v).to_f64()
}

/// As [`length`], in double-double.
fn exact_length(v: [f64; 3]) -> DoubleDouble {
    let largest = v.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
    let size = exponent(largest);
    let [x, y, z] = v.map(|part| scale(part, -size)).map(|part| DoubleDouble::product(part, part));
    let (high, low) = (x + y + z).sqrt().parts();
    DoubleDouble::new(scale(high, size), scale(low, size))
}

/// The rotation about a vector by its length.
pub fn from_rotation_vector(v: [f64; 3]) -> Quaternion {
    let (angle, rest) = exact_length(v).parts();
    let (sine, cosine) = sin_cos(0.5 * angle);
    let half = 0.5 * rest;
    let (sine, cosine) = (sine + half * cosine, cosine - half * sine);
    // Of an angle whose half is lost, the sine is the half all the same.
    let per_angle = if angle < 1e-300 { 0.5 } else { sine / angle };
    [v[0] * per_angle, v[1] * per_angle, v[2] * per_angle, cosine]
}

/// The vector about which to rotate, by its length in [0, π].
pub fn rotation_vector(q: Quaternion) -> [f64; 3] {
    let [x, y, z, w] = if q[3] < 0.0 { q.map(|part| -part) } else { q };
    let sine = exact_length([x, y, z]);
    if sine.high() < 1e-290 {
        return [2.0 * x, 2.0 * y, 2.0 * z];
    }
    let (high, low) = atan2_parts(sine.high(), w);
    // What the sine's low part turns the angle by.
    let angle = DoubleDouble::sum(high, low + sine.low() * w).scale(2.0);
    let per_sine = angle / sine;
    [x, y, z].map(|part| (per_sine * DoubleDouble::from(part)).to_f64())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn unit_quaternion() -> impl Strategy<Value = Quaternion> {
        prop::array::uniform4(-1.0..1.0f64).prop_filter_map("too short", |q| {
            let size = q.iter().map(|part| part * part).sum::<f64>().sqrt();
            (size > 1e-3).then(|| q.map(|part| part / size))
        })
    }

    /// The angle between two rotations, to first order.
    fn apart(a: Quaternion, b: Quaternion) -> f64 {
        let [x, y, z, _] = product(conjugate(a), b);
        2.0 * dot([x, y, z], [x, y, z]).sqrt()
    }

    proptest! {
        #[test]
        fn there_and_back(q in unit_quaternion()) {
            // Each way rounds some products of order one: 4 ε.
            let bound = 4.0 * f64::EPSILON;
            prop_assert!(from_matrix("m", matrix(q)).is_ok_and(|back| apart(q, back) <= bound));
            prop_assert!(apart(q, from_rotation_vector(rotation_vector(q))) <= bound);
            prop_assert!(unit("q", q).is_ok_and(|same| same == q));
        }
        #[test]
        fn a_product_rotates_by_one_after_the_other(
            a in unit_quaternion(), b in unit_quaternion(), v in prop::array::uniform3(-1.0..1.0f64)
        ) {
            let (once, twice) = (rotated(product(a, b), v), rotated(a, rotated(b, v)));
            let by_matrix = matrix(a).map(|row| dot(row, rotated(b, v)));
            for at in 0..3 {
                prop_assert!((once[at] - twice[at]).abs() <= 8.0 * f64::EPSILON);
                prop_assert!((by_matrix[at] - twice[at]).abs() <= 8.0 * f64::EPSILON);
            }
        }
    }

    #[test]
    fn small_and_large_rotation_vectors() {
        for size in [5e-324, 1e-310, 1e-200, 1e-9, 3.0] {
            let back = rotation_vector(from_rotation_vector([0.0, size, 0.0]));
            // Half of a subnormal number is rounded to whole spacings.
            assert!((back[1] - size).abs() <= size * 4.0 * f64::EPSILON + 5e-324, "{size:e}: {back:?}");
        }
        // A half turn about z, eight and a half turns on.
        let q = from_rotation_vector([0.0, 0.0, 17.0 * core::f64::consts::PI]);
        assert!(apart(q, [0.0, 0.0, 1.0, 0.0]) < 17.0 * f64::EPSILON);
    }

    #[test]
    fn what_is_no_rotation_is_refused() {
        for q in [[0.0; 4], [0.0, 0.0, 0.0, 1.1], [f64::NAN, 0.0, 0.0, 1.0], [1e200; 4]] {
            assert!(unit("q", q).is_err());
        }
        assert!(unit("q", [0.0, 0.0, 0.0, 1.0 + 1e-7]).is_ok_and(|q| q == IDENTITY));
        assert!(from_matrix("m", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]).is_err());
        assert!(from_matrix("m", [[1.0, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).is_err());
        assert!(from_matrix("m", [[f64::NAN; 3]; 3]).is_err());
    }
}
