//! A uniform field: the same acceleration everywhere.

use super::{Force, Phase};
use crate::error::Result;
use crate::numerics::element::{Element, Shape};
use crate::parallel::Ticker;

/// The acceleration `g` on every particle.
#[derive(Debug)]
pub struct UniformField<S> {
    shape: Shape,
    g: [S; 3],
}

impl<S: Element> UniformField<S> {
    /// From the acceleration.
    pub fn new(shape: Shape, g: [f64; 3]) -> Self {
        Self { shape, g: g.map(S::splat) }
    }
}

impl<S: Element> Force<S> for UniformField<S> {
    fn apply(&mut self, _: &Phase<'_, S>, a: &mut [S], first: bool, _: &mut Ticker<'_>) -> Result<()> {
        for (component, a) in a.chunks_exact_mut(self.shape.rows.max(1)).enumerate() {
            for a in a {
                *a = if first { self.g[component] } else { *a + self.g[component] };
            }
        }
        Ok(())
    }
}
