//! Columns that no unit could derive at the record: from the kept states, when all of them are there.

use super::super::Scene;
use super::super::columns::{Columns, Derived};
use super::turning::Turning;
use crate::conservation::columns::Snapshot;
use crate::error::Result;
use crate::forces::bodies::PreciseBodies;
use crate::parallel::{Ticker, for_chunks};

/// Numbers of a state that one thread takes at a time, about: a state of many particles is a chunk by itself.
const NUMBERS_PER_CHUNK: usize = 1 << 14;

/// Derives the columns of the rows that each copy has.
///
/// What was computed before an interrupt is not lost: an interrupted run is still derived from; an interrupt that comes
/// now leaves the rest as NaN.
///
/// # Errors
/// Only errors of the library itself.
pub(super) fn derive(
    scene: &Scene,
    columns: &mut Columns,
    rows: &[usize],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<()> {
    let times = columns.times;
    let together = NUMBERS_PER_CHUNK.div_ceil(scene.particles.max(1));
    let chunks: Vec<(usize, usize)> = (0..scene.copies)
        .flat_map(|copy| (0..rows[copy]).step_by(together).map(move |time| (copy, time)))
        .collect();
    let widths: Vec<&'static _> = columns.derived.iter().map(|derived| derived.column).collect();
    let parts = for_chunks(threads, chunks.len(), ticker, |chunk, ticker| {
        let (copy, first) = chunks[chunk];
        let mut bodies = PreciseBodies::default();
        let mut values: Vec<f64> = Vec::new();
        for time in first..rows[copy].min(first + together) {
            if ticker.tick().is_err() {
                break;
            }
            read(scene, columns, copy, time, &mut bodies);
            let turning = Turning::read(scene, columns, copy, time);
            let mut state = Snapshot::new(scene.forces_of(copy), &bodies, [0.0; 3], 1, ticker);
            let mut row = Vec::new();
            for column in &widths {
                let Ok(mut numbers) = state.value(column) else { return Ok(values) };
                if let Some(turning) = &turning {
                    let share = turning.scenery(scene, copy).share(column.name);
                    for c in 0..column.width {
                        numbers[c] += share[c];
                    }
                }
                row.extend_from_slice(&numbers[..column.width]);
            }
            values.extend(row);
        }
        Ok(values)
    })?;
    for Derived { values, .. } in &mut columns.derived {
        values.fill(f64::NAN);
    }
    let numbers: usize = widths.iter().map(|column| column.width).sum();
    for ((copy, first), part) in chunks.into_iter().zip(parts) {
        for (time, row) in (first..).zip(part.chunks_exact(numbers)) {
            let mut row = row;
            for Derived { column, values } in &mut columns.derived {
                let (own, rest) = row.split_at(column.width);
                values[(copy * times + time) * column.width..][..column.width].copy_from_slice(own);
                row = rest;
            }
        }
    }
    Ok(())
}

fn read(scene: &Scene, columns: &Columns, copy: usize, time: usize, bodies: &mut PreciseBodies) {
    bodies.clear(scene.particles);
    for (particle, &mass) in scene.masses(copy).iter().enumerate() {
        let at = ((copy * columns.times + time) * columns.particles + particle) * 3;
        let point = |values: &[f64]| [values[at], values[at + 1], values[at + 2]];
        let position = [point(&columns.position), point(&columns.position_rest)];
        bodies.set(particle, mass, position, [point(&columns.velocity), point(&columns.velocity_rest)]);
    }
    bodies.settle();
}
