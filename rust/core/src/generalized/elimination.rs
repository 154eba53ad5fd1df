//! Symmetric linear systems solved as expressions: L D Lᵀ without a search for pivots, for the few unknowns that a change of
//! variables has. Runs solve theirs with numbers.

use crate::expressions::{Graph, Id};

/// x of `matrix · x = right`, the matrix symmetric.
pub(super) fn solved(graph: &mut Graph, matrix: &[Vec<Id>], right: &[Id]) -> Vec<Id> {
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
    x
}
