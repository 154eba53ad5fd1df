//! A fixed centre: the force −dV/dr along the line to it, on every particle.

use super::{Force, Phase};
use crate::error::Result;
use crate::numerics::element::Shape;
use crate::numerics::elementary::Exponential;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::parallel::Ticker;
use crate::potentials::Formula;
use crate::tiered;

/// The force of a potential fixed at a point.
#[derive(Debug)]
pub struct CentralField<P> {
    potential: P,
    shape: Shape,
    center: [f64; 3],
    /// 1/m of each row's particles.
    inverse_mass: Vec<Lanes>,
}

impl<P: Formula> CentralField<P> {
    /// From the potential, the place of the centre, and 1/m of the particles of each row.
    pub fn new(potential: P, shape: Shape, center: [f64; 3], inverse_mass: Vec<Lanes>) -> Self {
        Self { potential, shape, center, inverse_mass }
    }
}

#[inline(always)]
fn kernel<V: Vector8 + Exponential, P: Formula>(
    field: &CentralField<P>,
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
        let pull = field.potential.force(r) / r * inverse_mass[row];
        for c in 0..components {
            let a = &mut a[c * rows + row];
            let term = pull * d[c];
            *a = if first { term } else { *a + term };
        }
    }
}

tiered! {
    fn kernel_tier[P: Formula][P](field: &CentralField<P>, q: &[Lanes], a: &mut [Lanes], first: bool) = kernel;
}

impl<P: Formula> Force<Lanes> for CentralField<P> {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        kernel_tier(self, phase.q, a, first);
        Ok(())
    }
}
