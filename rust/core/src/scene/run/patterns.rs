//! Batches whose copies differ in which bodies are massless: each such pattern is a run of its own.

use super::super::Scene;
use super::super::columns::Columns;
use super::super::request::Request;
use super::{Derived, Output, Reached, run};
use crate::error::Result;
use crate::parallel::Ticker;
use std::collections::BTreeMap;

/// Copies with different sets of massless bodies are run apart, so that each has the bits it has alone.
///
/// # Errors
/// As [`run`].
pub(super) fn run_by_pattern(
    scene: &Scene,
    request: &Request,
    ticker: &mut Ticker<'_>,
) -> Result<Option<Output>> {
    let pattern = |copy: usize| scene.masses(copy).iter().map(|&mass| mass > 0.0);
    if (1..scene.copies).all(|copy| pattern(copy).eq(pattern(0))) {
        return Ok(None);
    }
    let mut groups: BTreeMap<Vec<bool>, Vec<usize>> = BTreeMap::new();
    for copy in 0..scene.copies {
        groups.entry(pattern(copy).collect()).or_default().push(copy);
    }
    let times = request.times.len();
    let mut whole: Option<Output> = None;
    for members in groups.values() {
        let pick = |values: &[[f64; 3]]| {
            let of = |&copy: &usize| values[copy * scene.particles..(copy + 1) * scene.particles].to_vec();
            members.iter().flat_map(of).collect()
        };
        let part = Scene {
            copies: members.len(),
            mass: members.iter().flat_map(|&copy| scene.masses(copy).to_vec()).collect(),
            position: pick(&scene.position),
            velocity: pick(&scene.velocity),
            ..scene.clone()
        };
        let part = run(&part, request, ticker)?;
        let whole = whole.get_or_insert_with(|| Output {
            plan: part.plan.clone(),
            columns: Columns {
                position: vec![f64::NAN; part.columns.position.len() / members.len() * scene.copies],
                velocity: vec![f64::NAN; part.columns.velocity.len() / members.len() * scene.copies],
                times,
                particles: scene.particles,
                ..Columns::default()
            },
            derived: part
                .derived
                .iter()
                .map(|column| Derived {
                    values: vec![f64::NAN; column.values.len() / members.len() * scene.copies],
                    ..column.clone()
                })
                .collect(),
            outcomes: vec![part.outcomes[0].clone(); scene.copies],
            reached: Reached { position: scene.position.clone(), velocity: scene.velocity.clone() },
        });
        for (index, &copy) in members.iter().enumerate() {
            let places = (copy, index, members.len());
            scatter(&mut whole.columns.position, &part.columns.position, places);
            scatter(&mut whole.columns.velocity, &part.columns.velocity, places);
            for (into, from) in whole.derived.iter_mut().zip(&part.derived) {
                scatter(&mut into.values, &from.values, places);
            }
            scatter(&mut whole.reached.position, &part.reached.position, places);
            scatter(&mut whole.reached.velocity, &part.reached.velocity, places);
            whole.outcomes[copy] = part.outcomes[index].clone();
        }
    }
    Ok(whole)
}

/// Copies what belongs to one copy: its place in the whole, its place among the `members` of the part, their number.
fn scatter<T: Copy>(into: &mut [T], from: &[T], (copy, index, members): (usize, usize, usize)) {
    let size = from.len() / members;
    into[copy * size..][..size].copy_from_slice(&from[index * size..][..size]);
}
