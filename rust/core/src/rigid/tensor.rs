//! Inertia tensors: of particles, about another point, in other axes, and their principal axes.
//!
//! The one idea: second moments ∫ r rᵀ dm about the center of mass are summed, not tensors about a distant origin, so
//! that nothing large is subtracted; the tensor is their trace less themselves.
//! Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. ch. 5; Jacobi's rotations as in Golub & Van Loan,
//! *Matrix Computations* 4th ed. § 8.5.

use super::moments::check;
use super::quaternion::{Matrix, Quaternion, cross, matrix};
use crate::error::{Error, Result};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::power_of_two::{exponent, scale};
use crate::words::number;

/// What rounding may make of the symmetry and the signs of a tensor, relative to its largest entry.
const ROUNDING: f64 = 1e-12;
/// Jacobi's rotations square what is left in each sweep.
const SWEEPS: usize = 12;

/// Mass, center of mass and the inertia tensor about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// All of it.
    pub mass: f64,
    /// The center of mass.
    pub center: [f64; 3],
    /// About the center, along the axes of the coordinates.
    pub tensor: Matrix,
}

fn of(value: f64) -> DoubleDouble {
    DoubleDouble::from(value)
}

/// The tensor of second moments: their trace less themselves.
pub fn from_second_moments(second: Matrix) -> Matrix {
    let [x, y, z] = [second[0][0], second[1][1], second[2][2]];
    let (xy, yz, zx) = (-second[0][1], -second[1][2], -second[2][0]);
    [[y + z, xy, zx], [xy, z + x, yz], [zx, yz, x + y]]
}

/// Σ m r rᵀ, in double-double.
fn second_moments(parts: impl Iterator<Item = (f64, [DoubleDouble; 3])>) -> [[DoubleDouble; 3]; 3] {
    let mut sum = [[of(0.0); 3]; 3];
    for (mass, r) in parts {
        for i in 0..3 {
            for j in i..3 {
                sum[i][j] += r[i] * r[j] * of(mass);
            }
        }
    }
    for i in 0..3 {
        for j in 0..i {
            sum[i][j] = sum[j][i];
        }
    }
    sum
}

/// The inertia tensor of particles about the origin.
pub fn of_particles(masses: &[f64], positions: &[[f64; 3]]) -> Matrix {
    let sum = second_moments(masses.iter().copied().zip(positions.iter().map(|r| r.map(of))));
    from_second_moments(sum.map(|row| row.map(DoubleDouble::to_f64)))
}

/// What a displacement of the mass adds: m (a² − a aᵀ).
fn displaced(mass: f64, offset: [f64; 3]) -> Matrix {
    from_second_moments(
        second_moments(core::iter::once((mass, offset.map(of)))).map(|row| row.map(DoubleDouble::to_f64)),
    )
}

/// The tensor about a point which the center of mass is off by `offset`, from that about the center.
pub fn about(tensor: Matrix, mass: f64, offset: [f64; 3]) -> Matrix {
    let more = displaced(mass, offset);
    core::array::from_fn(|i| core::array::from_fn(|j| tensor[i][j] + more[i][j]))
}

/// R I Rᵀ.
pub fn rotated(tensor: Matrix, turn: Quaternion) -> Matrix {
    let r = matrix(turn);
    let half: Matrix = core::array::from_fn(|i| {
        core::array::from_fn(|j| (0..3).map(|k| r[i][k] * tensor[k][j]).sum::<f64>())
    });
    let mut whole = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in i..3 {
            whole[i][j] = (0..3).map(|k| half[i][k] * r[j][k]).sum::<f64>();
            whole[j][i] = whole[i][j];
        }
    }
    whole
}

impl MassProperties {
    /// Of several bodies together.
    ///
    /// # Errors
    /// `InvalidInput` where there is no mass.
    pub fn together(parts: &[Self]) -> Result<Self> {
        let mass = parts.iter().fold(of(0.0), |sum, part| sum + of(part.mass));
        if !(mass.high() > 0.0 && mass.high().is_finite()) {
            let message = format!("expected some mass, got {} in all", number(mass.to_f64()));
            return Err(Error::invalid("mass", message));
        }
        // Rounded, it would be off by what is large beside bodies that are far from the origin.
        let center: [DoubleDouble; 3] = core::array::from_fn(|at| {
            let sum = parts
                .iter()
                .fold(of(0.0), |sum, part| sum + DoubleDouble::product(part.mass, part.center[at]));
            sum / mass
        });
        let offsets = parts.iter().map(|part| {
            let offset = core::array::from_fn(|at| of(part.center[at]) - center[at]);
            (part.mass, offset)
        });
        let more = from_second_moments(second_moments(offsets).map(|row| row.map(DoubleDouble::to_f64)));
        let tensor = core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                let own = parts.iter().fold(of(0.0), |sum, part| sum + of(part.tensor[i][j]));
                (own + of(more[i][j])).to_f64()
            })
        });
        Ok(Self { mass: mass.to_f64(), center: center.map(DoubleDouble::to_f64), tensor })
    }
}

/// The principal moments, ascending, and the axes they belong to, right-handed, as columns.
///
/// Of the first two axes the largest component is positive. Where moments agree the axes are those that Jacobi's
/// rotations leave, which turn no more than they must.
///
/// # Errors
/// `InvalidInput` for a tensor that is not symmetric, or whose moments are those of no body.
pub fn principal(tensor: Matrix) -> Result<([f64; 3], Matrix)> {
    let refused = |message: String| Error::invalid("tensor", message);
    let most = tensor.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    if tensor.iter().flatten().any(|entry| !entry.is_finite()) {
        return Err(refused("expected finite numbers".to_owned()));
    }
    let size = exponent(most);
    let near = tensor.map(|row| row.map(|entry| scale(entry, -size)));
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        if (near[i][j] - near[j][i]).abs() > ROUNDING * scale(most, -size) {
            let (one, other) = (number(tensor[i][j]), number(tensor[j][i]));
            return Err(refused(format!(
                "expected a symmetric tensor, but tensor[{i}, {j}] = {one} and tensor[{j}, {i}] = {other}"
            )));
        }
    }
    let (found, vectors) = jacobi(near);
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| found[*a].total_cmp(&found[*b]));
    let mut moments = order.map(|at| found[at]);
    if moments[0] < 0.0 && moments[0] >= -ROUNDING * scale(most, -size) {
        moments[0] = 0.0;
    }
    let moments = moments.map(|moment| scale(moment, size));
    if most > 0.0 {
        check("moments", moments).map_err(|error| match error {
            Error::InvalidInput { message, .. } => refused(message + " (in order of size)"),
            other => other,
        })?;
    }
    let column = |at: usize| {
        let v = vectors.map(|row| row[order[at]]);
        let largest = (0..3).fold(0, |best, i| if v[i].abs() > v[best].abs() { i } else { best });
        if v[largest] < 0.0 { v.map(|part| -part) } else { v }
    };
    let (first, second) = (column(0), column(1));
    let third = cross(first, second);
    Ok((moments, core::array::from_fn(|i| [first[i], second[i], third[i]].map(|part| part + 0.0))))
}

/// The eigenvalues of a symmetric matrix of size one, and its eigenvectors as columns.
fn jacobi(mut a: Matrix) -> ([f64; 3], Matrix) {
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = 0.5 * (a[p][q] + a[q][p]);
            // Beside what its rounding is to the diagonal it is nothing.
            if off.abs() <= 1e-40 || off.abs() <= 1e-18 * a[p][p].abs().min(a[q][q].abs()) {
                (a[p][q], a[q][p]) = (0.0, 0.0);
                continue;
            }
            let tau = (a[q][q] - a[p][p]) / (2.0 * off);
            let t = 1.0_f64.copysign(tau) / (tau.abs() + (1.0 + tau * tau).sqrt());
            let t = if tau.is_infinite() { 0.0 } else { t };
            let c = 1.0 / (1.0 + t * t).sqrt();
            let s = t * c;
            let r = 3 - p - q;
            a[p][p] -= t * off;
            a[q][q] += t * off;
            (a[p][q], a[q][p]) = (0.0, 0.0);
            let (rp, rq) = (a[r][p], a[r][q]);
            a[r][p] = c * rp - s * rq;
            a[r][q] = s * rp + c * rq;
            (a[p][r], a[q][r]) = (a[r][p], a[r][q]);
            for row in &mut v {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
        }
    }
    ([a[0][0], a[1][1], a[2][2]], v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::quaternion::{dot, unit};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn axes_make_the_tensor_again(
            parts in prop::array::uniform3(0.0..1.0f64), q in prop::array::uniform4(-1.0..1.0f64), size in -300..300i32
        ) {
            let long = q.iter().map(|part| part * part).sum::<f64>().sqrt();
            prop_assume!(long > 1e-2);
            let turn = unit("q", q.map(|part| part / long))?;
            let diagonal = from_second_moments([[parts[0], 0.0, 0.0], [0.0, parts[1], 0.0], [0.0, 0.0, parts[2]]]);
            let tensor = rotated(diagonal, turn).map(|row| row.map(|entry| scale(entry, size)));
            let (moments, axes) = principal(tensor)?;
            prop_assert!(moments[0] <= moments[1] && moments[1] <= moments[2]);
            let columns: Matrix = core::array::from_fn(|j| axes.map(|row| row[j]));
            prop_assert!((dot(columns[0], cross(columns[1], columns[2])) - 1.0).abs() < 1e-14);
            for i in 0..3 {
                for j in 0..3 {
                    let again = (0..3).map(|k| scale(moments[k], -size) * axes[i][k] * axes[j][k]).sum::<f64>();
                    prop_assert!((again - scale(tensor[i][j], -size)).abs() <= 4e-15);
                }
            }
        }
    }

    #[test]
    fn degenerate_tensors_keep_their_axes() -> Result<()> {
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(principal(identity)?, ([1.0; 3], identity));
        assert_eq!(principal([[0.0; 3]; 3])?, ([0.0; 3], identity));
        let rod = principal([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.0]])?;
        assert_eq!(rod.0, [0.0, 2.0, 2.0]);
        assert_eq!(rod.1.map(|row| row[0]), [0.0, 0.0, 1.0]);
        // A rod along (1, 1, 1): 3 − 1 1ᵀ.
        let slanted = principal([[2.0, -1.0, -1.0], [-1.0, 2.0, -1.0], [-1.0, -1.0, 2.0]])?;
        assert!(slanted.0[0] >= 0.0 && slanted.0[0] < 1e-15);
        assert!((slanted.0[1] - 3.0).abs() < 4e-15 && (slanted.0[2] - 3.0).abs() < 4e-15);
        for bad in [
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0]],
            [[1.0, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[f64::NAN; 3]; 3],
        ] {
            assert!(principal(bad).is_err());
        }
        Ok(())
    }
}
