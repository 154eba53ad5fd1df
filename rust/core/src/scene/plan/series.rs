//! What a method of Taylor series cannot take, told before anything runs, and which method `auto` takes.

use super::coupling::Groups;
use super::guides;
use crate::error::{Error, Result};
use crate::forces::ForceTerm;
use crate::forces::gravity::RING_MAX;
use crate::ode::{Method, Scheme};
use crate::registry;
use std::sync::Arc;

/// The series of all pairs of more bodies leave the caches, and other methods are faster.
const MOST_BODIES: usize = 64;

/// So many bodies may be joined, if there are few links: as many as bodies, or no more than eight. Where eight links in lanes
/// have ends all over the place, gathering them takes longer than what series save, and so do many links of several systems.
const MOST_JOINED: usize = 64;
const FEW_LINKS: usize = 8;

/// With more links of eight systems side by side series leave the nearest cache.
const MOST_LINKS: usize = 7;

/// The method that `auto` prefers to the one that serves all. It is that of series where few bodies or charges attract each other
/// and nothing else acts but fields: there it takes about the time of DOP853 and is off by a tenth to a ten thousandth of its
/// errors. Measured on fourteen scenes of 3 to 8 bodies, massless ones and ensembles among them, with tolerances of 1e-6 to 1e-12:
/// 0.6 to 1.6 times the time; of more bodies up to five times, and with flattening or relativity beside the pulls about twice.
///
/// Under forces that are linear in the place and the velocity of each body it takes a fifth to a third of the time of Verner's
/// method, and is off by a hundredth.
///
/// Series see all of formulas that are polynomials and waves, too. There they are off by a thousandth, in a fifth (a Penning
/// trap) to one and a half times the time (soft polynomials of a hundred products).
///
/// So they do of formulas with roots, quotients and logarithms of what vanishes nowhere, or only at a pole
/// ([`is_definite`](crate::expressions::definite::is_definite)): 0.7 of the time (soft spheres, disks a tenth as thick as they are
/// wide) to the same (disks a thousandth as thick), off by a hundredth to a thousandth.
///
/// Springs that have a length are stiff as a rule, and their series take a third to two thirds of the time of Verner's method
/// at one tolerance: measured on pairs, rings and chains of up to 64, with and without fields beside. Copies of pairs and of
/// small chains take 0.7 to 1 of it, of longer ones up to 1.5.
///
/// Beside other formulas, of which nothing is known beforehand, it is DOP853: its steps are shorter, and its error estimate
/// feels less of the rounding of places far from the origin. Of a hundred bodies that met small walls, written as expressions,
/// it lost 48, and Verner's method 70.
pub(super) fn first_choice(
    forces: &[Arc<dyn ForceTerm>],
    active: &[usize],
    passive: &[usize],
    (groups, touching): (&Groups, bool),
) -> Option<&'static Method> {
    let formula = forces.iter().any(|force| force.is_formula());
    let series = registry::methods_for(false).find(|method| matches!(method.scheme, Scheme::Taylor(_)));
    let told = if formula {
        forces.iter().all(|force| !force.is_formula() || force.is_told())
    } else {
        pull_in_fields(forces, active)
            || (!touching && (turns_linearly(forces) || is_held(forces, active, passive, groups)))
    };
    let few = |&(bodies, links): &(usize, usize)| bodies <= MOST_JOINED && links <= bodies.max(FEW_LINKS);
    let most = match groups {
        Groups::Listed(_) => groups.sizes(forces).iter().all(few),
        _ => active.len() <= RING_MAX,
    };
    let serves = |method: &&'static Method| {
        told && most
            // Where bodies may touch, massless ones are on the steps of all: of many of them, series take longer.
            && (passive.is_empty() || !touching)
            && check(method, forces, active, passive, groups).is_ok()
    };
    series.filter(serves).or_else(|| if formula { registry::method("dop853") } else { None })
}

/// Whether one force is the pull of all on each other, and others are fields.
fn pull_in_fields(forces: &[Arc<dyn ForceTerm>], active: &[usize]) -> bool {
    let pulls = |force: &Arc<dyn ForceTerm>| match active {
        [first, second, ..] => {
            force.as_newtonian().is_some() || force.as_coulomb([*first, *second]).is_some()
        }
        _ => force.as_newtonian().is_some(),
    };
    let is_field = |force: &Arc<dyn ForceTerm>| {
        let body = active.first().copied().unwrap_or(0);
        force.as_uniform().is_some()
            || force.as_electric(body).is_some()
            || force.as_magnetic().is_some()
            || force.as_rotating().is_some()
    };
    let (pull, fields): (Vec<_>, Vec<_>) = forces.iter().partition(|force| pulls(force));
    pull.len() == 1 && fields.into_iter().all(is_field)
}

/// Whether forces are linear in the place and the velocity of each body, and some of them turns it back. What only falls or
/// slows down would be gone through in one step, in which events and contacts pass unseen.
fn turns_linearly(forces: &[Arc<dyn ForceTerm>]) -> bool {
    forces.iter().all(|force| force.as_linear().is_some()) && forces.iter().any(turns_back)
}

fn turns_back(force: &Arc<dyn ForceTerm>) -> bool {
    force.as_harmonic().is_some() || force.as_magnetic().is_some() || force.as_rotating().is_some()
}

/// Whether some force holds bodies to others, and each of them is, or is turned back. Where all pull each other besides, series
/// take a fifth longer than Verner's method.
fn is_held(forces: &[Arc<dyn ForceTerm>], active: &[usize], passive: &[usize], groups: &Groups) -> bool {
    let held = |body: &usize| forces.iter().any(|force| force.holds(*body));
    *groups != Groups::All
        && active.iter().any(held)
        && (forces.iter().any(turns_back) || active.iter().chain(passive).all(held))
}

/// Whether links of one system lie side by side rather than systems.
pub(super) fn links_abreast(groups: &Groups, forces: &[Arc<dyn ForceTerm>]) -> bool {
    groups.sizes(forces).iter().any(|&(_, links)| links > MOST_LINKS)
}

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
        let of_time = if force.needs().time { " with the time in it" } else { "" };
        return refused(format!("needs the Taylor series of every force, and {class}{of_time} has none"));
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
    if active.is_empty() || passive.is_empty() {
        return Ok(());
    }
    if let Some(force) = forces.iter().find(|force| !guides(force)) {
        return refused(format!(
            "takes no massless bodies beside {}, by which they do not follow the massive ones",
            force.declaration().class_name
        ));
    }
    Ok(())
}
