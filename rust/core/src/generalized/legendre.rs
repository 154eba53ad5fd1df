//! Changes of description: Legendre's transformation both ways, Routh's of cyclic coordinates, and L by degrees of q̇.
//!
//! The one idea: where a function is quadratic in velocities (or momenta) its derivative is linear in them, so it is inverted
//! by a linear system, as expressions. A. M. Legendre's transform of the transform is the function again: one routine does both.

use super::elimination::solved;
use super::model::{Kind, Source};
use crate::error::{Error, Result};
use crate::expressions::{Graph, Id};
use rustc_hash::FxHashMap;

/// Which of the numbers of a state an expression has.
fn has_any(graph: &Graph, root: Id, numbers: &[Id]) -> bool {
    graph.reachable(&[root]).iter().any(|id| numbers.contains(id))
}

/// Velocities (or momenta) some of which follow from their conjugates: `a x + b = conjugates`, of x = `numbers`.
fn inverted(graph: &mut Graph, function: Id, numbers: &[Id], conjugates: &[Id]) -> Result<Vec<Id>> {
    let one = graph.constant(1.0);
    let zero = graph.constant(0.0);
    let derivatives = graph.gradient(function, numbers);
    let still: FxHashMap<Id, Id> = numbers.iter().map(|&id| (id, zero)).collect();
    let at_rest = graph.substitute(&derivatives, &still);
    let mut matrix = vec![vec![zero; numbers.len()]; numbers.len()];
    for (j, &number) in numbers.iter().enumerate() {
        let column = graph.tangent(&derivatives, &FxHashMap::from_iter([(number, one)]));
        for (i, &entry) in column.iter().enumerate() {
            if has_any(graph, entry, numbers) {
                return Err(Error::invalid(
                    "L",
                    "expected a function that is quadratic in the velocities (or momenta) that are to be replaced; \
                     this one is not, and has no transform as an expression",
                ));
            }
            matrix[i][j] = entry;
        }
    }
    if matrix.iter().any(|row| row.iter().all(|&entry| graph.is_zero(entry))) {
        return Err(Error::invalid("L", "degenerate: a velocity (or momentum) has no square in it"));
    }
    let right: Vec<Id> =
        conjugates.iter().zip(&at_rest).map(|(&conjugate, &rest)| graph.subtract(conjugate, rest)).collect();
    solved(graph, &matrix, &right).ok_or_else(|| {
        Error::invalid(
            "L",
            "degenerate: its momenta (or velocities) do not determine the velocities (or momenta)",
        )
    })
}

/// The Hamiltonian of a Lagrangian, or the Lagrangian of a Hamiltonian, of the same numbers: the second half of the state
/// becomes the other one.
///
/// # Errors
/// A function that is not quadratic in the second half; forces by dissipation or constraints, which have no transform.
pub fn transformed(source: &Source) -> Result<Source> {
    let mut source = source.clone();
    if source.dissipation.is_some() || !source.holonomic.is_empty() || !source.nonholonomic.is_empty() {
        return Err(Error::invalid("L", "systems with dissipation or constraints have no Hamiltonian"));
    }
    let (_, second) = source.halves();
    let graph = &mut source.graph;
    // The conjugates are where the second half was: the same nodes with another meaning.
    let inverse = inverted(graph, source.function, &second, &second)?;
    let replaced: FxHashMap<Id, Id> = second.iter().copied().zip(inverse.iter().copied()).collect();
    let roots: Vec<Id> = [source.function].into_iter().chain(source.forces.iter().copied()).collect();
    let moved = graph.substitute(&roots, &replaced);
    let mut terms = vec![(-1.0, moved[0])];
    for (&conjugate, &value) in second.iter().zip(&inverse) {
        terms.push((1.0, graph.multiply(conjugate, value)));
    }
    source.function = graph.sum(0.0, &terms);
    source.forces = moved[1..].to_vec();
    source.kind = match source.kind {
        Kind::Lagrangian => Kind::Hamiltonian,
        Kind::Hamiltonian => Kind::Lagrangian,
    };
    Ok(source)
}

/// A Lagrangian's parts of second, first and no degree in the velocities.
pub fn by_degree(source: &mut Source) -> [Id; 3] {
    let (_, v) = source.halves();
    let graph = &mut source.graph;
    let zero = graph.constant(0.0);
    let still: FxHashMap<Id, Id> = v.iter().map(|&id| (id, zero)).collect();
    let momenta = graph.gradient(source.function, &v);
    let mut roots = vec![source.function];
    roots.extend(&momenta);
    let at_rest = graph.substitute(&roots, &still);
    let linear: Vec<(f64, Id)> =
        v.iter().zip(&at_rest[1..]).map(|(&v, &p)| (1.0, graph.multiply(v, p))).collect();
    let linear = graph.sum(0.0, &linear);
    let rest = graph.sum(0.0, &[(1.0, source.function), (-1.0, linear), (-1.0, at_rest[0])]);
    [rest, linear, at_rest[0]]
}

/// Routh's function of the coordinates that stay: a Lagrangian whose further parameters are the momenta of the `cyclic` ones;
/// the velocities of those, of the reduced system's state, come along.
///
/// # Errors
/// Coordinates that are not cyclic; a Lagrangian that is not quadratic in their velocities.
pub fn routhian(source: &Source, cyclic: &[usize]) -> Result<(Source, Vec<Id>)> {
    let mut source = source.clone();
    let n = source.coordinates;
    let (q, v) = source.halves();
    let first_parameter = source.parameters as u32;
    let graph = &mut source.graph;
    if let Some(&bad) = cyclic.iter().find(|&&i| i >= n || has_any(graph, source.function, &[q[i]])) {
        return Err(Error::invalid(
            "momenta",
            format!("coordinate {bad} is not cyclic: the Lagrangian has it"),
        ));
    }
    let replaced: Vec<Id> = cyclic.iter().map(|&i| v[i]).collect();
    let momenta: Vec<Id> = (0..cyclic.len() as u32).map(|k| graph.parameter(first_parameter + k)).collect();
    let velocities = inverted(graph, source.function, &replaced, &momenta)?;
    let kept: Vec<usize> = (0..n).filter(|i| !cyclic.contains(i)).collect();
    let m = kept.len() as u32;
    // Velocities of cyclic coordinates by their momenta, then new numbers for what is kept.
    let out: FxHashMap<Id, Id> = replaced.iter().copied().zip(velocities.iter().copied()).collect();
    let mut roots = graph.substitute(&[source.function], &out);
    roots.extend(&velocities);
    let mut renamed = FxHashMap::default();
    for (k, &i) in kept.iter().enumerate() {
        let (place, velocity) = (graph.variable(k as u32), graph.variable(m + k as u32));
        let _ = renamed.insert(q[i], place);
        let _ = renamed.insert(v[i], velocity);
    }
    let roots = graph.substitute(&roots, &renamed);
    let mut terms = vec![(1.0, roots[0])];
    for (&momentum, &velocity) in momenta.iter().zip(&roots[1..]) {
        terms.push((-1.0, graph.multiply(momentum, velocity)));
    }
    source.function = graph.sum(0.0, &terms);
    source.coordinates = kept.len();
    source.parameters += cyclic.len();
    source.forces = vec![];
    Ok((source, roots[1..].to_vec()))
}
