//! Constraints by multipliers: [M −Aᵀ; −A 0] [q̈; λ] = [r; Ȧq̇ + ḃ].
//!
//! The one idea: with the multipliers' sign turned round, the matrix is symmetric and λ is the force that acts on the system,
//! Q = Aᵀλ. M is positive definite and A has full rank, so no pivots are looked for.

use super::model::Source;
use crate::error::{Error, Result};
use crate::expressions::program::LinearSystem;
use crate::expressions::{Graph, Id, Node};
use rustc_hash::FxHashMap;

/// Refuses what is no constraint of its kind: it would be kept, and mean something else.
///
/// # Errors
/// A holonomic one with velocities or without coordinates, another one without or not linear in velocities, and too many.
pub(super) fn check(source: &mut Source) -> Result<()> {
    let n = source.coordinates;
    let (q, v) = source.halves();
    let graph = &mut source.graph;
    let moving = |graph: &Graph, roots: &[Id]| {
        graph.any(roots, |node| matches!(node, Node::Variable(index) if *index as usize >= n))
    };
    for (k, &constraint) in source.holonomic.iter().enumerate() {
        if moving(graph, &[constraint]) {
            let message = format!("constraint {k} contains velocities; pass it as nonholonomic=");
            return Err(Error::invalid("constraints", message));
        }
        if graph.gradient(constraint, &q).iter().all(|&slope| graph.is_zero(slope)) {
            return Err(Error::invalid("constraints", format!("constraint {k} contains no coordinate")));
        }
    }
    for (k, &constraint) in source.nonholonomic.iter().enumerate() {
        let row = graph.gradient(constraint, &v);
        let wrong = if row.iter().all(|&entry| graph.is_zero(entry)) {
            "contains no velocity; pass it as constraints="
        } else if moving(graph, &row) {
            "is not linear in the velocities"
        } else {
            continue;
        };
        return Err(Error::invalid("nonholonomic", format!("constraint {k} {wrong}")));
    }
    let constraints = source.holonomic.len() + source.nonholonomic.len();
    if constraints > n {
        let message = format!("{constraints} constraints leave nothing of {n} coordinates; leave some out");
        return Err(Error::invalid("constraints", message));
    }
    Ok(())
}

/// The system of accelerations and multipliers; `motion` is how everything changes at q̈ = 0.
pub(super) fn bordered(
    source: &mut Source,
    mass: &[Vec<Id>],
    mut right: Vec<Id>,
    motion: &FxHashMap<Id, Id>,
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
    LinearSystem { matrix, right, inner: n }
}
