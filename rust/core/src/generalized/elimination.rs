//! Symmetric linear systems solved as expressions, for the few unknowns that a change of variables has: L D Lᵀ without a search
//! for pivots where none of them vanishes as an expression, as those of a positive definite matrix do not. Where one does the
//! matrix is indefinite, as kinetic energies in null coordinates are (v_x v_y), and rows are exchanged for pivots that do not.
//! Runs solve theirs with numbers.

use crate::expressions::{Graph, Id};

/// x of `matrix · x = right`, the matrix symmetric; `None` if it is singular whatever the numbers are.
pub(super) fn solved(graph: &mut Graph, matrix: &[Vec<Id>], right: &[Id]) -> Option<Vec<Id>> {
    without_exchange(graph, matrix, right).or_else(|| with_exchange(graph, matrix, right))
}

/// By L D Lᵀ; `None` if a pivot is zero.
fn without_exchange(graph: &mut Graph, matrix: &[Vec<Id>], right: &[Id]) -> Option<Vec<Id>> {
    let n = right.len();
    let mut lower = matrix.to_vec();
    let mut pivots: Vec<Id> = Vec::with_capacity(n);
    let mut x = right.to_vec();
    for j in 0..n {
        let mut terms = vec![(1.0, matrix[j][j])];
        for k in 0..j {
            let square = graph.multiply(lower[j][k], lower[j][k]);
            terms.push((-1.0, graph.multiply(square, pivots[k])));
        }
        let pivot = graph.sum(0.0, &terms);
        if graph.is_zero(pivot) {
            return None;
        }
        for i in j + 1..n {
            let mut terms = vec![(1.0, matrix[i][j])];
            for k in 0..j {
                let product = graph.multiply(lower[i][k], lower[j][k]);
                terms.push((-1.0, graph.multiply(product, pivots[k])));
            }
            let entry = graph.sum(0.0, &terms);
            lower[i][j] = graph.divide(entry, pivot);
        }
        pivots.push(pivot);
    }
    for i in 0..n {
        let mut terms = vec![(1.0, x[i])];
        for k in 0..i {
            terms.push((-1.0, graph.multiply(lower[i][k], x[k])));
        }
        x[i] = graph.sum(0.0, &terms);
    }
    for i in (0..n).rev() {
        let mut terms = vec![(1.0, graph.divide(x[i], pivots[i]))];
        for k in i + 1..n {
            terms.push((-1.0, graph.multiply(lower[k][i], x[k])));
        }
        x[i] = graph.sum(0.0, &terms);
    }
    Some(x)
}

/// By C. F. Gauss's elimination: in each column the pivot is the largest number or, if there is none, the first that is not
/// zero as an expression.
fn with_exchange(graph: &mut Graph, matrix: &[Vec<Id>], right: &[Id]) -> Option<Vec<Id>> {
    let n = right.len();
    let mut rows: Vec<Vec<Id>> =
        matrix.iter().zip(right).map(|(row, &right)| row.iter().copied().chain([right]).collect()).collect();
    for column in 0..n {
        let size = |graph: &Graph, id: Id| graph.as_constant(id).map_or(f64::MIN_POSITIVE, f64::abs);
        let best = (column..n)
            .filter(|&row| !graph.is_zero(rows[row][column]))
            .rev()
            .max_by(|&a, &b| size(graph, rows[a][column]).total_cmp(&size(graph, rows[b][column])))?;
        rows.swap(column, best);
        let pivot = rows[column].clone();
        for row in rows.iter_mut().skip(column + 1) {
            if graph.is_zero(row[column]) {
                continue;
            }
            let factor = graph.divide(row[column], pivot[column]);
            for k in column + 1..=n {
                let product = graph.multiply(factor, pivot[k]);
                row[k] = graph.sum(0.0, &[(1.0, row[k]), (-1.0, product)]);
            }
        }
    }
    let mut x = vec![graph.constant(0.0); n];
    for i in (0..n).rev() {
        let mut terms = vec![(1.0, rows[i][n])];
        for k in i + 1..n {
            terms.push((-1.0, graph.multiply(rows[i][k], x[k])));
        }
        let rest = graph.sum(0.0, &terms);
        x[i] = graph.divide(rest, rows[i][i]);
    }
    Some(x)
}
