//! More massive bodies than [`few`](super::few) has kernels for, eight systems of them in the lanes: beside rigid bodies that
//! torques turn, whose systems are batched whatever their number.
//!
//! The one idea: pairs in order of index, each once; massless bodies after them.

use super::FewBodies;
use crate::error::Result;
use crate::forces::{Force, Phase};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::parallel::Ticker;
use crate::tiered;

/// Gravity among any number of massive bodies of each system and on the massless ones after them.
#[derive(Clone, Debug)]
pub(in crate::forces) struct ManyBodies(pub(super) FewBodies<Lanes>);

#[inline(always)]
fn lanes_kernel<V: Vector8 + InverseCube>(
    bodies: &FewBodies<Lanes>,
    q: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    let (q, a, strength) = (V::view(q), V::view_mut(a), V::view(&bodies.strength));
    let softening2 = V::view(&bodies.softening2);
    let (rows, components) = (bodies.shape.rows, bodies.shape.components);
    let (all, active) = (bodies.bodies(), strength.len() / bodies.systems);
    if first {
        a.fill(V::zero());
    }
    for system in 0..bodies.systems {
        let (row, own) = (system * all, &strength[system * active..][..active]);
        for i in 0..active {
            for j in i + 1..all {
                let mut apart = [V::zero(); 3];
                let mut square = softening2[system];
                for c in 0..components {
                    apart[c] = q[c * rows + row + j] - q[c * rows + row + i];
                    square = apart[c].multiply_add(apart[c], square);
                }
                let [weight] = V::inverse_cubes([square]);
                for c in 0..components {
                    let pull = apart[c] * weight;
                    let at = c * rows + row;
                    a[at + j] = own[i].multiply_subtract_from(pull, a[at + j]);
                    if j < active {
                        a[at + i] = own[j].multiply_add(pull, a[at + i]);
                    }
                }
            }
        }
    }
}

tiered! {
    fn lanes_tier[][](bodies: &FewBodies<Lanes>, q: &[Lanes], a: &mut [Lanes], first: bool) = lanes_kernel;
}

impl Force<Lanes> for ManyBodies {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        lanes_tier(&self.0, phase.q, a, first);
        Ok(())
    }
}
