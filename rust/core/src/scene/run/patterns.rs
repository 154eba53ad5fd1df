//! Batches whose copies differ in which bodies are massless: each such pattern is a run of its own.

use super::super::Scene;
use super::super::columns::Columns;
use super::super::request::Request;
use super::{Derived, Output, run};
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
        });
        for (index, &copy) in members.iter().enumerate() {
            let scatter = |into: &mut Vec<f64>, from: &Vec<f64>| {
                let size = from.len() / members.len();
                into[copy * size..(copy + 1) * size].copy_from_slice(&from[index * size..(index + 1) * size]);
            };
            scatter(&mut whole.columns.position, &part.columns.position);
            scatter(&mut whole.columns.velocity, &part.columns.velocity);
            for (into, from) in whole.derived.iter_mut().zip(&part.derived) {
                scatter(&mut into.values, &from.values);
            }
            whole.outcomes[copy] = part.outcomes[index].clone();
        }
    }
    Ok(whole)
}
