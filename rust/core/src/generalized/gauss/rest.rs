//! What a motion from rest is measured by, until it has sizes of its own.
//!
//! The one idea: where nothing moves yet, and what will push it is told by the time, as a pulse to come, any force is large beside
//! nothing, and so is its rounding. But forces at the start can be asked for at all times of the run, and the velocity that the
//! strongest of them gives over the run is a size.

use crate::numerics::real::Real;

/// So many times of a run are looked at, in groups of as many as there are lanes.
pub(super) const LOOKS: usize = 64;

/// This part of what the strongest force gives over the run is a size: so little that errors measured by it are nothing beside
/// those of the motion that comes, also of one that turns back every 1e-5 of the run; so much that the rounding of the force,
/// over a step on which it does nothing ([`pace`](super::pace)), is none.
const PART: f64 = 1e-5;

/// What is smaller counts as nothing: a pulse between the looks begins with numbers that have no digits.
const LEAST: f64 = 1e-270;

/// The time of a look, of a run that begins there and takes so long.
pub(super) fn time(look: usize, (begin, span): (f64, f64)) -> f64 {
    begin + span * ((look as f64 + 0.5) / LOOKS as f64)
}

/// The larger of a size that is known and that which a rate gives over the span.
pub(super) fn size(known: f64, rate: f64, span: f64) -> f64 {
    let size = PART * (rate * span).abs();
    let known = Real::max(known, LEAST);
    if size < f64::INFINITY { Real::max(known, size) } else { known }
}
