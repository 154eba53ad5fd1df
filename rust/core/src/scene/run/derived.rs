//! Columns that are derived from the recorded states: energy, momenta, the centre of mass.

use super::super::Scene;
use super::super::columns::Columns;
use super::super::integrate::Ending;
use super::super::plan::Plan;
use super::super::request::Request;
use super::Outcome;
use crate::conservation::{self, Body};
use crate::error::Result;
use crate::numerics::double_double::DoubleDouble;
use crate::parallel::{Ticker, for_chunks};

/// A derived column: its name and its numbers, `copies × times × width`.
#[derive(Clone, Debug)]
pub struct Derived {
    /// Its name.
    pub name: String,
    /// Numbers per time.
    pub width: usize,
    /// The numbers; NaN where nothing was recorded.
    pub values: Vec<f64>,
}

/// The derived columns, from the recorded states and what they leave out.
///
/// # Errors
/// Only errors of the library itself.
pub(super) fn derive(
    scene: &Scene,
    request: &Request,
    plan: &Plan,
    columns: &Columns,
    outcomes: &[Outcome],
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Derived>> {
    let names: Vec<&String> =
        request.record.iter().filter(|name| *name != "position" && *name != "velocity").collect();
    let times = request.times.len();
    let widths: Vec<usize> =
        names.iter().map(|name| if conservation::SCALARS.contains(&name.as_str()) { 1 } else { 3 }).collect();
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let threads = plan.threads.0.max(plan.threads.1);
    // What was computed before an interrupt is not lost: an interrupted run is still derived from, and an
    // interrupt that comes now leaves the rest of a column as NaN.
    let interrupted = outcomes.iter().any(|outcome| outcome.ending == Ending::Interrupted);
    let per_copy = for_chunks(threads, scene.copies, ticker, |copy, ticker| {
        let mut values: Vec<Vec<f64>> = widths.iter().map(|width| vec![f64::NAN; width * times]).collect();
        for time in 0..outcomes[copy].rows {
            if ticker.tick().is_err() && !interrupted {
                break;
            }
            let bodies = recorded_bodies(scene, columns, copy, time);
            for (index, name) in names.iter().enumerate() {
                let numbers = conservation::column(name, &scene.forces, &bodies, [0.0; 3])?;
                values[index][time * widths[index]..(time + 1) * widths[index]].copy_from_slice(&numbers);
            }
        }
        Ok(values)
    })?;
    let mut derived: Vec<Derived> = names
        .iter()
        .zip(&widths)
        .map(|(name, &width)| Derived { name: (*name).clone(), width, values: Vec::new() })
        .collect();
    for values in per_copy {
        for (column, values) in derived.iter_mut().zip(values) {
            column.values.extend(values);
        }
    }
    Ok(derived)
}

fn recorded_bodies(scene: &Scene, columns: &Columns, copy: usize, time: usize) -> Vec<Body> {
    let at = |particle: usize| ((copy * columns.times + time) * columns.particles + particle) * 3;
    (0..scene.particles)
        .map(|particle| {
            let exact = |values: &[f64], rest: &[f64]| {
                core::array::from_fn(|c| DoubleDouble::sum(values[at(particle) + c], rest[at(particle) + c]))
            };
            Body {
                mass: scene.masses(copy)[particle],
                position: exact(&columns.position, &columns.position_rest),
                velocity: exact(&columns.velocity, &columns.velocity_rest),
            }
        })
        .collect()
}
