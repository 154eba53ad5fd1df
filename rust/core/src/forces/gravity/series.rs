//! Gravity as a recurrence of Taylor coefficients.
//!
//! The one idea: of each pair the pull is `d s^(-3/2)`, with `d = x_j - x_i` and `s = |d|² + ε²` (see
//! [`pairs`](crate::forces::series::pairs)). Pulls are added in the ring order of the other kernels, whether the lanes are
//! bodies or systems: the same bits alone and in a batch.

use super::RING_MAX;
use crate::forces::context::{Arrangement, Context, System};
use crate::forces::series::Series;
use crate::forces::series::pairs::{Kept, ORDERS, Orders, Pairs, Whole};
use crate::numerics::lanes::Lanes;

mod each;
pub mod few;
mod pair;
pub mod passive;
mod ring;
mod rows;
mod with_massless;
pub use each::EachPair;
pub use ring::RingPairs;
use rows::RowPairs;
use with_massless::WithMassless;

/// The series of Σ strengthⱼ (rⱼ − rᵢ)/(r² + softening²)^{3/2} on every body.
pub fn attraction(
    context: &Context<'_>,
    strength: impl Fn(&System<'_>, usize) -> f64,
    softening: f64,
) -> Box<dyn Series<Lanes>> {
    let softening = context.units.take(softening, [1, 0, 0]);
    let (shape, active) = (context.shape, context.active);
    if context.arrangement == Arrangement::Batched {
        return Box::new(EachPair::new(shape, context.in_rows(active, strength), softening));
    }
    let system = context.first();
    let strength: Vec<f64> = (0..active).map(|slot| strength(&system, slot)).collect();
    if active > RING_MAX {
        Box::new(RowPairs::new(shape, strength, softening))
    } else if active < system.bodies.len() {
        Box::new(WithMassless::new(shape, strength, softening))
    } else {
        Box::new(RingPairs::new(shape, &strength, softening))
    }
}
