//! Symmetric linear systems solved as expressions, for the few unknowns that a change of variables has: L D Lᵀ without a search
//! for pivots where none of them vanishes as an expression, as those of a positive definite matrix do not. Where one does the
//! matrix is indefinite, as kinetic energies in null coordinates are (v_x v_y), and rows are exchanged for pivots that do not.
//! Up to three unknowns whose pivots may vanish somewhere have cofactors, which are divided by the determinant alone.
//! Runs solve theirs with numbers.

use crate::expressions::function::Function;
use crate::expressions::graph::{Dependence, number};
use crate::expressions::linear::is_singular;
use crate::expressions::{Graph, Id, Node};

/// Unknowns of which cofactors are no longer than an elimination.
const LARGEST_BY_COFACTORS: usize = 3;

/// x of `matrix · x = right`, the matrix symmetric; `None` if it is singular whatever the numbers are, or of numbers that are but
/// for their rounding.
pub(super) fn solved(graph: &mut Graph, matrix: &[Vec<Id>], right: &[Id]) -> Option<Vec<Id>> {
    let triangle = matrix.iter().enumerate().flat_map(|(i, row)| row[..=i].iter().copied());
    let numbers: Option<Vec<f64>> = triangle.map(|entry| graph.as_constant(entry)).collect();
    if numbers.is_some_and(|numbers| is_singular(&numbers, right.len())) {
        return None;
    }
    if (2..=LARGEST_BY_COFACTORS).contains(&right.len()) && !keeps_pivots(graph, matrix) {
        return by_cofactors(graph, matrix, right);
    }
    without_exchange(graph, matrix, right).or_else(|| with_exchange(graph, matrix, right))
}

/// Whether no pivot but the last one vanishes at some states only, as far as the diagonal tells: that of a positive definite matrix
/// has no zeros, and one with nothing beside it vanishes with the determinant alone.
fn keeps_pivots(graph: &Graph, matrix: &[Vec<Id>]) -> bool {
    let n = matrix.len();
    let alone = |j: usize| (0..n).all(|i| i == j || graph.is_zero(matrix[i][j]));
    let coupled: Vec<usize> = (0..n).filter(|&j| !alone(j)).collect();
    coupled.iter().rev().skip(1).all(|&j| is_positive(graph, matrix[j][j]))
}

/// Whether an expression has no zeros, told by what it is made of: parameters, and sums of them and squares.
fn is_positive(graph: &Graph, id: Id) -> bool {
    if graph.dependence(id) <= Dependence::Parameters {
        return !graph.is_zero(id);
    }
    match graph.node(id) {
        Node::Sum(constant, terms) => {
            let constant = number(*constant);
            let signs = terms.iter().all(|&(factor, term)| number(factor) > 0.0 && is_no_less(graph, term));
            let some = constant > 0.0 || terms.iter().any(|&(_, term)| is_positive(graph, term));
            constant >= 0.0 && signs && some
        }
        Node::Product(a, b) | Node::Quotient(a, b) => is_positive(graph, *a) && is_positive(graph, *b),
        Node::Call(Function::Exp | Function::Cosh, _) => true,
        _ => false,
    }
}

/// Whether it is nowhere negative: as [`is_positive`], or with zeros.
fn is_no_less(graph: &Graph, id: Id) -> bool {
    match graph.node(id) {
        Node::Product(a, b) => a == b || (is_no_less(graph, *a) && is_no_less(graph, *b)),
        _ => is_positive(graph, id),
    }
}

/// By G. Cramer's rule, of few unknowns: nothing but the determinant is divided by, so nothing is lost where an entry vanishes.
fn by_cofactors(graph: &mut Graph, matrix: &[Vec<Id>], right: &[Id]) -> Option<Vec<Id>> {
    let n = right.len();
    let cofactors: Vec<Vec<Id>> =
        (0..n).map(|i| (0..n).map(|j| cofactor(graph, matrix, (i, j))).collect()).collect();
    let terms: Vec<(f64, Id)> =
        (0..n).map(|j| (1.0, graph.multiply(matrix[0][j], cofactors[0][j]))).collect();
    let determinant = graph.sum(0.0, &terms);
    if graph.is_zero(determinant) {
        return None;
    }
    let mut x = Vec::with_capacity(n);
    for i in 0..n {
        let terms: Vec<(f64, Id)> =
            (0..n).map(|j| (1.0, graph.multiply(cofactors[j][i], right[j]))).collect();
        let sum = graph.sum(0.0, &terms);
        x.push(graph.divide(sum, determinant));
    }
    Some(x)
}

/// The determinant without a row and a column, with its sign; of two or three rows.
fn cofactor(graph: &mut Graph, matrix: &[Vec<Id>], (row, column): (usize, usize)) -> Id {
    let n = matrix.len();
    let sign = if (row + column) & 1 == 0 { 1.0 } else { -1.0 };
    let rows: Vec<usize> = (0..n).filter(|&i| i != row).collect();
    let columns: Vec<usize> = (0..n).filter(|&j| j != column).collect();
    if let ([a, b], [c, d]) = (&rows[..], &columns[..]) {
        let (plus, minus) =
            (graph.multiply(matrix[*a][*c], matrix[*b][*d]), graph.multiply(matrix[*a][*d], matrix[*b][*c]));
        return graph.sum(0.0, &[(sign, plus), (-sign, minus)]);
    }
    match (rows.first(), columns.first()) {
        (Some(&i), Some(&j)) => graph.scale(sign, matrix[i][j]),
        _ => graph.constant(sign),
    }
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
