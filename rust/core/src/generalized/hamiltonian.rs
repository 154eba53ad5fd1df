//! From H(q, p, t) to Hamilton's equations: one sweep back through H.

use super::model::{Derived, Source};
use crate::error::{Error, Result};
use crate::expressions::Id;
use crate::expressions::program::Output;
use crate::ode::system::Form;

/// Derives the equations of motion. Where q̇ = p they are those of q̈ = −∂H/∂q, of the second order.
///
/// # Errors
/// Constraints.
pub(super) fn derive(mut source: Source) -> Result<Derived> {
    if !source.holonomic.is_empty() || !source.nonholonomic.is_empty() {
        return Err(Error::invalid("constraints", "a Hamiltonian takes none; pass a Lagrangian"));
    }
    let n = source.coordinates;
    let (q, p) = source.halves();
    let graph = &mut source.graph;
    let all: Vec<Id> = q.iter().chain(&p).copied().collect();
    let gradient = graph.gradient(source.function, &all);
    let slopes: Vec<Id> = gradient[..n].iter().map(|&slope| graph.scale(-1.0, slope)).collect();
    let conjugates = gradient[n..].to_vec();
    let mut forces = slopes.clone();
    for (force, &more) in forces.iter_mut().zip(&source.forces) {
        *force = graph.add(*force, more);
    }
    let second_order = conjugates == p;
    let rates = if second_order { forces } else { conjugates.iter().copied().chain(forces).collect() };
    let energy = source.function;
    Ok(Derived {
        form: if second_order { Form::SecondOrder(n) } else { Form::FirstOrder(2 * n) },
        source,
        systems: vec![],
        rates: rates.into_iter().map(Output::Node).collect(),
        multipliers: vec![],
        conjugates,
        slopes,
        mass: vec![],
        right: vec![],
        energy,
    })
}
