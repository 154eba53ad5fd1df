//! From L(q, q̇, t) to accelerations: M(q, q̇, t) q̈ = ∂L/∂q − d/dt ∂L/∂q̇ at q̈ = 0, + forces.
//!
//! The one idea: momenta are one sweep back through L, and everything else sweeps forward through the momenta: along a
//! velocity it is a column of M, along the motion the rest. H. Goldstein, *Classical Mechanics*, 3rd ed., (1.57), (1.70).

use super::model::{Derived, Source, degenerate};
use super::{christoffel, constraints};
use crate::error::Result;
use crate::expressions::Id;
use crate::expressions::program::{LinearSystem, Output};
use crate::ode::system::Form;
use rustc_hash::FxHashMap;

/// Which coordinates are held by constraints: these may have no mass, which the others then bring.
fn held(source: &mut Source, q: &[Id], v: &[Id]) -> Vec<bool> {
    let Source { graph, holonomic, nonholonomic, .. } = source;
    let mut is_held = vec![false; q.len()];
    let places = holonomic.iter().map(|&of| (of, q));
    for (of, by) in places.chain(nonholonomic.iter().map(|&of| (of, v))) {
        for (is_held, slope) in is_held.iter_mut().zip(graph.gradient(of, by)) {
            *is_held |= !graph.is_zero(slope);
        }
    }
    is_held
}

/// Derives the equations of motion.
///
/// # Errors
/// A coordinate without kinetic energy that no constraint holds.
pub(super) fn derive(mut source: Source) -> Result<Derived> {
    constraints::check(&mut source)?;
    let n = source.coordinates;
    let (q, v) = source.halves();
    let is_held = held(&mut source, &q, &v);
    let graph = &mut source.graph;
    let one = graph.constant(1.0);

    let all: Vec<Id> = q.iter().chain(&v).copied().collect();
    let slopes = graph.gradient(source.function, &all);
    let (slopes, momenta) = (slopes[..n].to_vec(), slopes[n..].to_vec());

    let mut mass = vec![vec![graph.constant(0.0); n]; n];
    for j in 0..n {
        let column = graph.tangent(&momenta[j..], &FxHashMap::from_iter([(v[j], one)]));
        for i in j..n {
            mass[i][j] = column[i - j];
            mass[j][i] = column[i - j];
        }
        if !is_held[j] && mass[j].iter().all(|&entry| graph.is_zero(entry)) {
            return Err(degenerate(j));
        }
    }

    let mut motion: FxHashMap<Id, Id> = q.iter().copied().zip(v.iter().copied()).collect();
    let _ = motion.insert(graph.time(), one);
    let inertia = graph.tangent(&momenta, &motion);
    let mut free: Vec<Id> = (0..n).map(|i| graph.subtract(slopes[i], inertia[i])).collect();
    if let Some(other) = christoffel::free(graph, source.function, &momenta, &mass, (&q, &v))
        && christoffel::length(graph, &other) < christoffel::length(graph, &free)
    {
        free = other;
    }
    let damping = source.dissipation.map(|function| graph.gradient(function, &v));
    let mut right = Vec::with_capacity(n);
    for i in 0..n {
        let mut terms = vec![(1.0, free[i])];
        terms.extend(source.forces.get(i).map(|&force| (1.0, force)));
        terms.extend(damping.as_ref().map(|damping| (-1.0, damping[i])));
        right.push(graph.sum(0.0, &terms));
    }

    let mut energy = vec![(-1.0, source.function)];
    for i in 0..n {
        energy.push((1.0, graph.multiply(v[i], momenta[i])));
    }
    let energy = graph.sum(0.0, &energy);

    let (systems, rates, multipliers) = if source.holonomic.is_empty() && source.nonholonomic.is_empty() {
        let (systems, rates) = solved_in_blocks(&mut source, &mass, &right);
        (systems, rates, vec![])
    } else {
        let system = constraints::bordered(&mut source, &mass, right.clone(), &motion);
        let constraints = system.right.len() - n;
        let multipliers = (n..n + constraints).map(|index| Output::Unknown(index as u32)).collect();
        (vec![system], (0..n).map(|index| Output::Unknown(index as u32)).collect(), multipliers)
    };
    Ok(Derived {
        source,
        form: Form::SecondOrder(n),
        systems,
        rates,
        multipliers,
        conjugates: momenta,
        slopes,
        mass,
        right,
        energy,
    })
}

/// Accelerations by blocks of coordinates that the mass matrix couples; a block of one is a quotient.
fn solved_in_blocks(source: &mut Source, mass: &[Vec<Id>], right: &[Id]) -> (Vec<LinearSystem>, Vec<Output>) {
    let graph = &mut source.graph;
    let n = right.len();
    let mut block: Vec<usize> = (0..n).collect();
    for i in 0..n {
        for j in 0..i {
            if !graph.is_zero(mass[i][j]) && block[i] != block[j] {
                let (from, to) = (block[i], block[j]);
                block.iter_mut().filter(|block| **block == from).for_each(|block| *block = to);
            }
        }
    }
    let (mut systems, mut rates, mut unknowns) = (Vec::new(), vec![Output::Unknown(0); n], 0);
    for first in 0..n {
        let members: Vec<usize> = (0..n).filter(|&i| block[i] == block[first]).collect();
        if members[0] != first {
            continue;
        }
        if let [only] = members[..] {
            rates[only] = Output::Node(graph.divide(right[only], mass[only][only]));
            continue;
        }
        let matrix = members.iter().map(|&i| members.iter().map(|&j| mass[i][j]).collect()).collect();
        let right = members.iter().map(|&i| right[i]).collect();
        systems.push(LinearSystem { matrix, right, inner: members.len() });
        for &member in &members {
            rates[member] = Output::Unknown(unknowns);
            unknowns += 1;
        }
    }
    (systems, rates)
}
