//! What the disc leaves out: the largest deflection of impact parameters beyond it.

use crate::Result;
use crate::numerics::lanes::WIDTH;
use crate::parallel::Ticker;
use crate::scattering::deflection::{Deflection, Deflector, Status};
use core::f64::consts::PI;

/// Impact parameters beyond the disc that are tried, out to a thousand of its radii.
const BEYOND: i32 = 240;
/// A part of the largest angle that no other is meant to follow.
const NOTHING: f64 = 1e-6;

/// The largest |ψ| of impact parameters beyond the disc, at most π: a little more where it is not at the disc's edge, as
/// it lies between points that were tried.
pub(super) fn largest_beyond(
    deflector: &Deflector,
    energy: f64,
    b_max: f64,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<f64> {
    // Steps of 1.0002 at first, of 1.06 at the end.
    let part = |i: i32| 1.0 + (f64::from(i) / f64::from(BEYOND)).powi(3) * 999.0;
    let size = |found: &Deflection| if found.status == Status::Captured { PI } else { found.angle.abs() };
    let (mut edge, mut largest) = (None, 0.0_f64);
    let bends: Vec<f64> = deflector.bends(energy).into_iter().filter(|b| *b > b_max).collect();
    if !bends.is_empty() {
        let found = deflector.deflect(&vec![energy; bends.len()], &bends, false, threads, ticker)?;
        largest = found.iter().map(size).fold(0.0, f64::max);
    }
    for first in (0..=BEYOND).step_by(WIDTH) {
        let b: Vec<f64> =
            (first..first + WIDTH as i32).map(|i| b_max * part(i)).filter(|b| b.is_finite()).collect();
        let found = deflector.deflect(&vec![energy; b.len()], &b, false, threads, ticker)?;
        let here = found.iter().map(size).fold(0.0, f64::max);
        largest = largest.max(here);
        edge = edge.or(found.first().map(size));
        // So far out that nothing turns any more: of short range it has no other zone beyond.
        if here <= NOTHING * largest {
            break;
        }
    }
    let edge = edge.unwrap_or(PI);
    Ok(if largest <= edge { edge.min(PI) } else { (1.05 * largest).min(PI) })
}
