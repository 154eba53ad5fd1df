//! A potential over lanes: the loops that are compiled for each potential and each SIMD tier.
//!
//! They know places and distances and nothing of forces, which call them by way of [`Potential`](super::Potential):
//! one indirect call for rows of bodies, everything hot inside it.

use super::Formula;
use crate::numerics::element::Shape;
use crate::numerics::elementary::Exponential;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::tiered;

/// Bodies around a fixed point.
#[derive(Debug)]
pub struct Around {
    /// How their coordinates lie.
    pub shape: Shape,
    /// The point.
    pub center: [f64; 3],
    /// 1/m of each row's bodies.
    pub inverse_mass: Vec<Lanes>,
}

#[inline(always)]
fn around<V: Vector8 + Exponential, P: Formula>(
    potential: &P,
    field: &Around,
    q: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    let Shape { rows, components } = field.shape;
    let (q, a) = (V::view(q), V::view_mut(a));
    let inverse_mass = V::view(&field.inverse_mass);
    for row in 0..rows {
        let mut d = [V::zero(); 3];
        let mut r2 = V::zero();
        for c in 0..components {
            d[c] = q[c * rows + row] - V::splat(field.center[c]);
            r2 += d[c] * d[c];
        }
        let r = r2.sqrt();
        let pull = potential.force(r) / r * inverse_mass[row];
        for c in 0..components {
            let a = &mut a[c * rows + row];
            let term = pull * d[c];
            *a = if first { term } else { *a + term };
        }
    }
}

tiered! {
    pub(super) fn around_tier[P: Formula][P](potential: &P, field: &Around, q: &[Lanes], a: &mut [Lanes], first: bool) = around;
}
