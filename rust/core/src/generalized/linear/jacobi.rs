//! Eigenvalues of a symmetric matrix, small ones beside large ones.
//!
//! The one idea: a rotation of two coordinates changes nothing but what these two have, and what is left between them is
//! compared with the roots of their own diagonals. So no entry is rounded to the digits of the largest, and of a positive
//! matrix each eigenvalue has the digits that the entries tell: J. Demmel & K. Veselić, SIAM J. Matrix Anal. Appl. 13 (1992)
//! 1204.

use nalgebra::DMatrix;

/// Rotations of all pairs; some seven are usual, with the last of them nothing is left.
const SWEEPS: usize = 60;

/// Eigenvalues and, in columns, eigenvectors of a symmetric matrix; nothing where the rotations come to no end.
pub(super) fn eigen(mut matrix: DMatrix<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    let n = matrix.nrows();
    let mut vectors = DMatrix::identity(n, n);
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for i in 0..n {
            for j in i + 1..n {
                let (a, b, c) = (matrix[(i, i)], matrix[(i, j)], matrix[(j, j)]);
                if b.abs() <= f64::EPSILON * (a.abs().sqrt() * c.abs().sqrt()) || b == 0.0 {
                    continue;
                }
                rotated = true;
                // The smaller angle, of which the tangent is a root of t² + 2 ((c - a)/2b) t - 1.
                let half = (c - a) / (2.0 * b);
                let tangent = half.signum() / (half.abs() + half.hypot(1.0));
                let cosine = 1.0 / tangent.hypot(1.0);
                let sine = cosine * tangent;
                for k in 0..n {
                    if k != i && k != j {
                        let (x, y) = (matrix[(k, i)], matrix[(k, j)]);
                        let turned = (cosine * x - sine * y, sine * x + cosine * y);
                        (matrix[(k, i)], matrix[(i, k)]) = (turned.0, turned.0);
                        (matrix[(k, j)], matrix[(j, k)]) = (turned.1, turned.1);
                    }
                    let (x, y) = (vectors[(k, i)], vectors[(k, j)]);
                    (vectors[(k, i)], vectors[(k, j)]) = (cosine * x - sine * y, sine * x + cosine * y);
                }
                matrix[(i, i)] = a - tangent * b;
                matrix[(j, j)] = c + tangent * b;
                matrix[(i, j)] = 0.0;
                matrix[(j, i)] = 0.0;
            }
        }
        if !rotated {
            let values = matrix.diagonal().iter().copied().collect();
            return Some((values, vectors));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_ones_have_all_their_digits() {
        // Of [[1, -s/2], [-s/2, s²]]: s² 3/4 to the second order in s.
        for s in [1e-3, 1e-6, 1e-10] {
            let found = eigen(DMatrix::from_row_slice(2, 2, &[1.0, -0.5 * s, -0.5 * s, s * s]));
            let mut values = found.map(|(values, _)| values).unwrap_or_default();
            values.sort_by(f64::total_cmp);
            let exact = 0.75 * s * s / (1.0 + s * s / 4.0);
            assert!(
                (values[0] / exact - 1.0).abs() <= 1e-5_f64.min(s * s) + 4.0 * f64::EPSILON,
                "{values:?}"
            );
        }
    }

    #[test]
    fn vectors_are_orthonormal_and_make_the_matrix() {
        let n = 12;
        let entry = |i: usize, j: usize| ((i * j + i + j) as f64).sin() + if i == j { 3.0 } else { 0.0 };
        let matrix = DMatrix::from_fn(n, n, entry);
        let found = eigen(matrix.clone());
        assert!(found.is_some());
        let Some((values, vectors)) = found else { return };
        let again = &vectors * DMatrix::from_diagonal(&values.into()) * vectors.transpose();
        assert!((again - &matrix).amax() <= 1e-14 * n as f64);
        let one = vectors.transpose() * &vectors;
        assert!((one - DMatrix::identity(n, n)).amax() <= 1e-15 * n as f64);
    }

    #[test]
    fn equal_ones_and_none_at_all() {
        let zeros = eigen(DMatrix::zeros(3, 3)).map(|(values, _)| values);
        assert_eq!(zeros, Some(vec![0.0; 3]));
        // A ring of three: 0, 3, 3.
        let ring = eigen(DMatrix::from_fn(3, 3, |i, j| if i == j { 2.0 } else { -1.0 }));
        let mut values = ring.map(|(values, _)| values).unwrap_or_default();
        values.sort_by(f64::total_cmp);
        assert!(
            values[0].abs() <= 1e-15 && (values[1] - 3.0).abs() <= 4e-15 && (values[2] - 3.0).abs() <= 4e-15
        );
    }
}
