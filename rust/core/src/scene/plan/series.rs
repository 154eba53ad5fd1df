//! What a method of Taylor series cannot take, told before anything runs.

use super::coupling::Groups;
use crate::error::{Error, Result};
use crate::forces::ForceTerm;
use crate::forces::term::Coupling;
use crate::ode::{Method, Scheme};
use std::sync::Arc;

/// The series of all pairs of more bodies leave the caches, and other methods are faster.
const MOST_BODIES: usize = 64;

/// Refuses forces without series, and bodies that they do not serve.
///
/// # Errors
/// By name.
pub(super) fn check(
    method: &Method,
    forces: &[Arc<dyn ForceTerm>],
    active: &[usize],
    passive: &[usize],
    groups: &Groups,
) -> Result<()> {
    if !matches!(method.scheme, Scheme::Taylor(_)) {
        return Ok(());
    }
    let refused =
        |why: String| Err(Error::invalid("method", format!("{} {why}; use dop853 or verner98", method.name)));
    if let Some(force) = forces.iter().find(|force| !force.has_series()) {
        let class = force.declaration().class_name;
        return refused(format!("needs the Taylor series of every force, and {class} has none"));
    }
    if *groups != Groups::All {
        return Ok(());
    }
    if active.len() > MOST_BODIES {
        let bodies = active.len();
        return refused(format!(
            "keeps the series of every pair of at most {MOST_BODIES} massive bodies, got {bodies}"
        ));
    }
    let follow =
        forces.iter().all(|force| force.coupling() != Coupling::AllPairs || force.as_newtonian().is_some());
    if !active.is_empty() && !passive.is_empty() && !follow {
        return refused("takes massless bodies only where gravity alone couples them to others".to_owned());
    }
    Ok(())
}
