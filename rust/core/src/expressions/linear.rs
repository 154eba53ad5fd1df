//! Symmetric linear systems, of all that lies in a register at once.
//!
//! The one idea: a mass matrix is positive definite, and so needs no search for pivots, nor does one bordered by constraints.
//! That it is so is seen on the way: of a positive definite matrix elimination takes away less than the whole of a diagonal
//! element. Where it takes more (a Lagrangian may have an indefinite form of the velocities) the system is inverted with
//! pivots, lane by lane. N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., sections 10.1 and 11.1.

use super::execute::Scalar;
use crate::numerics::real::{Mask, Real};

/// What elimination may take from a diagonal element, times that: what is lost beyond is beneath two digits.
const GROWTH: f64 = 64.0;

/// What is left of a diagonal element, as a part of it, that is nothing but its rounding.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// As [`ROUNDING`], of a matrix with borders: where masses alone do not tell the motion, constraints may, and what elimination
/// without pivots would lose on the way is not lost by the system. Three digits are more than rates have to spare.
const ROUNDING_WITHIN_BORDERS: f64 = 1.0 / 1024.0;

/// L D Lᵀ of a symmetric matrix, its lower triangle row by row, in place: L below the diagonal, 1/D on it. `row` is room; of
/// `inner` rows the matrix is bordered. Where it needed no pivots.
#[inline(always)]
pub(super) fn factor<S: Scalar>(matrix: &mut [S], row: &mut [S], inner: usize) -> S::Mask {
    let mut sound = S::Mask::splat(true);
    let rounding = if inner < row.len() { ROUNDING_WITHIN_BORDERS } else { ROUNDING };
    for i in 0..row.len() {
        let start = i * (i + 1) / 2;
        for j in 0..i {
            let other = j * (j + 1) / 2;
            let mut x = matrix[start + j];
            for k in 0..j {
                x = row[k].multiply_subtract_from(matrix[other + k], x);
            }
            row[j] = x;
        }
        let diagonal = matrix[start + i];
        let (mut pivot, mut by_masses) = (diagonal, diagonal);
        for j in 0..i {
            let l = row[j] * matrix[j * (j + 1) / 2 + j];
            matrix[start + j] = l;
            pivot = l.multiply_subtract_from(row[j], pivot);
            if j + 1 == inner {
                by_masses = pivot;
            }
        }
        if i >= inner {
            // Of a border what the masses make of it; other borders may take it away, as two of one light coordinate do.
            sound = sound.and((S::splat(rounding) * by_masses.abs()).less(pivot.abs()));
        } else {
            let taken = (diagonal - pivot).abs();
            sound = sound.and(taken.less_equal(S::splat(GROWTH) * diagonal.abs()));
            sound = sound.and((S::splat(rounding) * diagonal.abs()).less(pivot.abs()));
        }
        matrix[start + i] = S::one() / pivot;
    }
    sound
}

/// Solves with what [`factor`] has made.
#[inline(always)]
pub(super) fn solve<S: Scalar>(matrix: &[S], right: &mut [S]) {
    let n = right.len();
    for i in 0..n {
        let mut x = right[i];
        for k in 0..i {
            x = matrix[i * (i + 1) / 2 + k].multiply_subtract_from(right[k], x);
        }
        right[i] = x;
    }
    for i in (0..n).rev() {
        let mut x = right[i] * matrix[i * (i + 1) / 2 + i];
        for k in i + 1..n {
            x = matrix[k * (k + 1) / 2 + i].multiply_subtract_from(right[k], x);
        }
        right[i] = x;
    }
}

/// As [`solve`] where `factored` is 1; where it is 0 the matrix is the inverse.
#[inline(always)]
pub(super) fn solve_either<S: Scalar>(matrix: &[S], right: &mut [S], factored: S) {
    let is_factored = S::zero().less(factored);
    if is_factored.all() {
        return solve(matrix, right);
    }
    let given = right.to_vec();
    solve(matrix, right);
    for (i, x) in right.iter_mut().enumerate() {
        let mut product = S::zero();
        for (j, &given) in given.iter().enumerate() {
            let (row, column) = (i.max(j), i.min(j));
            product = matrix[row * (row + 1) / 2 + column].multiply_add(given, product);
        }
        *x = S::select(is_factored, *x, product);
    }
}

/// Puts the inverse in the place of a symmetric matrix of so many rows, in the lanes that are not `sound`; no numbers if it
/// has none.
#[cold]
pub(super) fn invert<S: Scalar>(matrix: &mut [S], rows: usize, sound: S::Mask) {
    let sound = S::select(sound, S::one(), S::zero());
    for lane in (0..S::LANES).filter(|&lane| sound.lane(lane) == 0.0) {
        let triangle: Vec<f64> = matrix.iter().map(|x| x.lane(lane)).collect();
        for (x, inverse) in matrix.iter_mut().zip(inverse(&triangle, rows)) {
            *x = x.with_lane(lane, inverse);
        }
    }
}

/// Whether a symmetric matrix of so many rows has no inverse but what roundings make of one.
pub fn is_singular(triangle: &[f64], rows: usize) -> bool {
    inverse(triangle, rows).iter().any(|x| !x.is_finite())
}

/// The inverse of a symmetric matrix, no numbers if it has none: Gauss and Jordan's elimination with the largest pivot of each
/// column, of those that are more than the rounding of what they were before.
fn inverse(triangle: &[f64], n: usize) -> Vec<f64> {
    let at =
        |row: usize, column: usize| triangle[row.max(column) * (row.max(column) + 1) / 2 + row.min(column)];
    let unit = |row: usize, column: usize| if row == column { 1.0 } else { 0.0 };
    let mut rows: Vec<Vec<f64>> = (0..n)
        .map(|row| {
            (0..n).map(|column| at(row, column)).chain((0..n).map(|column| unit(row, column))).collect()
        })
        .collect();
    // How large each entry was.
    let mut sizes: Vec<Vec<f64>> =
        rows.iter().map(|row| row[..n].iter().map(|x| x.abs()).collect()).collect();
    for column in 0..n {
        let size = |row: usize| rows[row][column].abs();
        let told = (column..n).filter(|&row| size(row) > ROUNDING * sizes[row][column]);
        let Some(largest) = told.max_by(|&a, &b| size(a).total_cmp(&size(b))) else {
            return vec![f64::NAN; n * (n + 1) / 2];
        };
        rows.swap(column, largest);
        sizes.swap(column, largest);
        let scale = 1.0 / rows[column][column];
        let pivot: Vec<f64> = rows[column].iter().map(|x| x * scale).collect();
        for (row, (values, sizes)) in rows.iter_mut().zip(&mut sizes).enumerate() {
            if row != column {
                let factor = values[column];
                for (x, &p) in values.iter_mut().zip(&pivot) {
                    *x = (-factor).multiply_add(p, *x);
                }
                for (size, x) in sizes.iter_mut().zip(&*values) {
                    *size = size.max(x.abs());
                }
            }
        }
        rows[column] = pivot;
    }
    // Symmetric but for rounding: the mean of both halves.
    let of = |(row, column): (usize, usize)| 0.5 * (rows[row][n + column] + rows[column][n + row]);
    (0..n).flat_map(|row| (0..=row).map(move |column| (row, column))).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::lanes::Lanes;

    /// Without a pivot in the first place; with one that vanishes on the way; definite.
    const MATRICES: [[f64; 6]; 3] =
        [[0.0, 1.0, 0.0, 2.0, 3.0, 1.0], [1e-9, 1.0, 0.0, -2.0, 1.0, 4.0], [4.0, 1.0, 3.0, 0.5, 1.0, 2.0]];

    fn product(triangle: &[f64], x: &[f64]) -> Vec<f64> {
        let at = |i: usize, j: usize| triangle[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
        (0..x.len()).map(|i| (0..x.len()).map(|j| at(i, j) * x[j]).sum()).collect()
    }

    #[test]
    fn pivots_are_searched_for_where_they_are_needed_and_each_lane_has_the_bits_of_one() {
        let x = [1.0, -2.0, 3.0];
        let mut alone = Vec::new();
        for matrix in MATRICES {
            let (mut factored, mut right) = (matrix.to_vec(), product(&matrix, &x));
            let sound = factor(&mut factored, &mut [0.0; 3], 3);
            assert_eq!(sound, matrix[0] == 4.0);
            if !sound {
                factored = matrix.to_vec();
                invert(&mut factored, 3, sound);
            }
            solve_either(&factored, &mut right, f64::from(u8::from(sound)));
            // Some roundings of sums of three terms, times a condition of some tens.
            assert!(right.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-14), "{right:?}");
            alone.push(right);
        }
        let lanes = |values: &dyn Fn(usize) -> f64| Lanes(core::array::from_fn(|lane| values(lane % 3)));
        let matrix: Vec<Lanes> = (0..6).map(|i| lanes(&|which| MATRICES[which][i])).collect();
        let rights: Vec<Vec<f64>> = MATRICES.iter().map(|matrix| product(matrix, &x)).collect();
        let mut right: Vec<Lanes> = (0..3).map(|i| lanes(&|which| rights[which][i])).collect();
        let mut factored = matrix.clone();
        let sound = factor(&mut factored, &mut [Lanes([0.0; 8]); 3], 3);
        for (into, &given) in factored.iter_mut().zip(&matrix) {
            *into = Lanes::select(sound, *into, given);
        }
        invert(&mut factored, 3, sound);
        solve_either(&factored, &mut right, Lanes::select(sound, Lanes::one(), Lanes::zero()));
        for lane in 0..8 {
            for i in 0..3 {
                assert_eq!(right[i].0[lane].to_bits(), alone[lane % 3][i].to_bits());
            }
        }
    }

    #[test]
    fn a_bordered_matrix_needs_no_pivots_and_what_is_singular_has_no_solution() {
        // Of a mass of 1e-3 under a constraint: what is taken from its zero is as it should be.
        let mut bordered = [1e-3, 1.0, 0.0];
        assert!(factor(&mut bordered, &mut [0.0; 2], 1));
        // Nearly singular masses, that a constraint tells apart: without pivots 1e-10 would have six digits left, and so would x.
        let small = 1e-10;
        let nearly = [1.0, 1.0, 1.0 + small, 1.0, -1.0, 0.0];
        assert!(!factor(&mut nearly.clone(), &mut [0.0; 3], 2));
        assert!(factor(&mut nearly[..3].to_vec(), &mut [0.0; 2], 2));
        let (x, mut inverse) = ([0.25, 0.5, -2.0], nearly.to_vec());
        let mut right = product(&nearly, &x);
        invert(&mut inverse, 3, false);
        solve_either(&inverse, &mut right, 0.0);
        assert!(right.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-14), "{right:?}");
        // Two constraints of one light coordinate: their share of 1e-12 of what the masses make of them would be lost.
        let light = [1.0, 0.0, 1e-12, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        assert!(!factor(&mut light.clone(), &mut [0.0; 4], 2));
        let mut singular = [1.0, 2.0, 4.0];
        assert!(!factor(&mut singular, &mut [0.0; 2], 2));
        let mut singular = [1.0, 2.0, 4.0];
        invert(&mut singular, 2, false);
        assert!(singular.iter().any(|x| !x.is_finite()));
    }
}
