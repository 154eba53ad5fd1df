//! Potentials made from tables, kept for the next run.
//!
//! The one idea: what a table or an expression tells (its curve, where something happens in it) takes longer than a short run, and
//! a scene that is run again brings the same numbers: the same potential serves again.

use super::parameters::Value;
use super::{Potential, PotentialDeclaration};
use crate::error::Result;
use std::sync::{Arc, Mutex, TryLockError};

/// The most potentials that are kept, and the most numbers in the tables of all.
const MOST: usize = 64;
const NUMBERS: usize = 1 << 20;

/// One that is kept.
#[derive(Debug)]
struct Kept {
    name: &'static str,
    potential: Arc<dyn Potential>,
}

/// Those that are kept, the one asked for last at the end.
static KEPT: Mutex<Vec<Kept>> = Mutex::new(Vec::new());

/// Does something with those kept, unless another thread (or, after a fork, a thread that is no more) has them.
fn with_kept<T>(action: impl FnOnce(&mut Vec<Kept>) -> T) -> Option<T> {
    match KEPT.try_lock() {
        Ok(mut kept) => Some(action(&mut kept)),
        Err(TryLockError::Poisoned(kept)) => Some(action(&mut kept.into_inner())),
        Err(TryLockError::WouldBlock) => None,
    }
}

/// The potential of these values: one that was made before, or a new one.
///
/// # Errors
/// Those of [`Declaration::build`](super::parameters::Declaration::build).
pub fn prepared(declaration: &PotentialDeclaration, values: &[Value]) -> Result<Arc<dyn Potential>> {
    if numbers_in(values) == 0 {
        return declaration.build(values);
    }
    let is_it = |kept: &Kept| {
        let theirs = kept.potential.parameters();
        kept.name == declaration.name && theirs.len() == values.len() && theirs.iter().zip(values).all(same)
    };
    let found = with_kept(|kept| {
        let index = kept.iter().rposition(is_it)?;
        // The one asked for last goes to the end.
        kept[index..].rotate_left(1);
        kept.last().map(|last| last.potential.clone())
    });
    if let Some(potential) = found.flatten() {
        return Ok(potential);
    }
    let potential = declaration.build(values)?;
    if numbers_in(values) > NUMBERS {
        return Ok(potential);
    }
    let new = Kept { name: declaration.name, potential: potential.clone() };
    let _ = with_kept(|kept| {
        kept.push(new);
        let mut room = NUMBERS;
        let fits = |kept: &&Kept| {
            let left = room.checked_sub(numbers_in(kept.potential.parameters()));
            room = left.unwrap_or(0);
            left.is_some()
        };
        let count = kept.iter().rev().take(MOST).take_while(fits).count();
        let _ = kept.drain(..kept.len() - count);
    });
    Ok(potential)
}

/// How many numbers are in tables.
fn numbers_in(values: &[Value]) -> usize {
    values.iter().map(|value| if let Value::Table(table) = value { table.len() } else { 0 }).sum()
}

/// Whether two values have the same bits.
fn same((one, other): (&Value, &Value)) -> bool {
    let same =
        |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits());
    match (one, other) {
        (Value::Number(a), Value::Number(b)) => a.to_bits() == b.to_bits(),
        (Value::Numbers(a), Value::Numbers(b)) => same(a, b),
        (Value::Vector(a), Value::Vector(b)) => same(a, b),
        (Value::Table(a), Value::Table(b)) => same(a, b),
        (Value::Word(a), Value::Word(b)) => a == b,
        _ => false,
    }
}
