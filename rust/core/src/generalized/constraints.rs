//! Constraints by multipliers: [M −Aᵀ; −A 0] [q̈; λ] = [r; Ȧq̇ + ḃ].
//!
//! The one idea: with the multipliers' sign turned round, the matrix is symmetric and λ is the force that acts on the system,
//! Q = Aᵀλ. M is positive definite and A has full rank, so no pivots are looked for.

use super::model::Source;
use crate::expressions::program::LinearSystem;
use crate::expressions::{Graph, Id};
use std::collections::HashMap;

/// The system of accelerations and multipliers; `motion` is how everything changes at q̈ = 0.
pub(super) fn bordered(
    source: &mut Source,
    mass: &[Vec<Id>],
    mut right: Vec<Id>,
    motion: &HashMap<Id, Id>,
) -> LinearSystem {
    let (q, v) = source.halves();
    let graph = &mut source.graph;
    // Of velocities, every constraint is a(q, t)·q̇ + b(q, t) = 0.
    let mut rates = graph.tangent(&source.holonomic, motion);
    let mut rows: Vec<Vec<Id>> =
        source.holonomic.iter().map(|&constraint| graph.gradient(constraint, &q)).collect();
    rates.extend(&source.nonholonomic);
    rows.extend(source.nonholonomic.iter().map(|&constraint| graph.gradient(constraint, &v)));
    right.extend(graph.tangent(&rates, motion));
    border(graph, mass, &rows, right)
}

/// [M −Aᵀ; −A 0] with that right side.
pub(super) fn border(graph: &mut Graph, mass: &[Vec<Id>], rows: &[Vec<Id>], right: Vec<Id>) -> LinearSystem {
    let (n, all) = (mass.len(), right.len());
    let zero = graph.constant(0.0);
    let mut matrix = vec![vec![zero; all]; all];
    for (i, row) in mass.iter().enumerate() {
        matrix[i][..n].copy_from_slice(row);
    }
    for (k, row) in rows.iter().enumerate() {
        for (i, &entry) in row.iter().enumerate() {
            let negative = graph.scale(-1.0, entry);
            matrix[n + k][i] = negative;
            matrix[i][n + k] = negative;
        }
    }
    LinearSystem { matrix, right }
}
