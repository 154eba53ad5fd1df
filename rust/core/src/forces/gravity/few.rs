//! Up to eight massive bodies, one trajectory (`f64`, double-double) or eight of them (`Lanes`).
//!
//! The loops run over pairs; the lanes, if any, over trajectories. Adds each body's terms in the ring
//! order of the module header, as [`ring`](super::ring) does with lanes over bodies.

use super::passive::{Source, attraction};
use crate::error::Result;
use crate::forces::Force;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Shape};
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::real::Real;
use crate::parallel::Ticker;
use crate::tiered;

/// Gravity among `strength.len()` massive bodies and the massless ones after them.
#[derive(Debug)]
pub struct FewBodies<S> {
    shape: Shape,
    /// `G·m` of the massive bodies.
    strength: Vec<S>,
    softening2: f64,
    /// `d·w` of each pair of the current ring distance.
    pull: Vec<S>,
}

impl<S: Element> FewBodies<S> {
    /// From `G·m` of the massive bodies, which come first in the state.
    pub fn new(shape: Shape, strength: Vec<S>, softening: f64) -> Self {
        let pull = vec![S::zero(); 3 * strength.len()];
        Self { shape, strength, softening2: softening * softening, pull }
    }
}

#[inline(always)]
fn kernel<S: Real, const PLANAR: bool, const SOFT: bool>(
    shape: Shape,
    strength: &[S],
    softening2: f64,
    pull: &mut [S],
    q: &[S],
    a: &mut [S],
    first: bool,
) {
    let n = strength.len();
    let rows = shape.rows;
    let components = if PLANAR { 2 } else { 3 };
    let softening2 = S::splat(softening2);
    // The accelerations of the massive bodies are gathered here and then written or added once, so that
    // a force that is not the first of its scene has the same bits.
    let mut sum = [[S::zero(); 3]; super::RING_MAX];
    for distance in 1..=n / 2 {
        let opposite = 2 * distance == n;
        for i in 0..n {
            let j = (i + distance) % n;
            let mut d = [S::zero(); 3];
            for c in 0..components {
                d[c] = q[c * rows + j] - q[c * rows + i];
            }
            let mut r2 = d[0] * d[0];
            if SOFT {
                r2 += softening2;
            }
            r2 += d[1] * d[1];
            if !PLANAR {
                r2 += d[2] * d[2];
            }
            let w = S::one() / (r2 * r2.sqrt());
            for c in 0..components {
                pull[3 * i + c] = d[c] * w;
                sum[i][c] += strength[j] * pull[3 * i + c];
            }
        }
        if !opposite {
            for i in 0..n {
                let j = (i + n - distance) % n;
                for c in 0..components {
                    sum[i][c] -= strength[j] * pull[3 * j + c];
                }
            }
        }
    }
    for i in 0..rows {
        let term = if i < n {
            sum[i]
        } else {
            let at = |c: usize, i: usize| if c < components { q[c * rows + i] } else { S::zero() };
            let sources =
                (0..n).map(|j| Source { position: [at(0, j), at(1, j), at(2, j)], strength: strength[j] });
            attraction::<S, PLANAR, SOFT>([at(0, i), at(1, i), at(2, i)], sources, softening2)
        };
        for c in 0..components {
            let a = &mut a[c * rows + i];
            *a = if first { term[c] } else { *a + term[c] };
        }
    }
}

#[inline(always)]
fn select_kernel<S: Real>(
    shape: Shape,
    strength: &[S],
    softening2: f64,
    pull: &mut [S],
    q: &[S],
    a: &mut [S],
    first: bool,
) {
    match (shape.components == 2, softening2 > 0.0) {
        (false, false) => kernel::<S, false, false>(shape, strength, softening2, pull, q, a, first),
        (false, true) => kernel::<S, false, true>(shape, strength, softening2, pull, q, a, first),
        (true, false) => kernel::<S, true, false>(shape, strength, softening2, pull, q, a, first),
        (true, true) => kernel::<S, true, true>(shape, strength, softening2, pull, q, a, first),
    }
}

#[inline(always)]
fn lanes_kernel<V: Vector8>(
    shape: Shape,
    strength: &[Lanes],
    softening2: f64,
    pull: &mut [Lanes],
    q: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    select_kernel::<V>(
        shape,
        V::view(strength),
        softening2,
        V::view_mut(pull),
        V::view(q),
        V::view_mut(a),
        first,
    );
}

tiered! {
    fn lanes_tier[][](shape: Shape, strength: &[Lanes], softening2: f64, pull: &mut [Lanes], q: &[Lanes], a: &mut [Lanes], first: bool) = lanes_kernel;
}

impl Force<Lanes> for FewBodies<Lanes> {
    fn apply(
        &mut self,
        q: &[Lanes],
        _: &[Lanes],
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        lanes_tier(self.shape, &self.strength, self.softening2, &mut self.pull, q, a, first);
        Ok(())
    }
}

macro_rules! plain_force {
    ($type:ty) => {
        impl Force<$type> for FewBodies<$type> {
            fn apply(
                &mut self,
                q: &[$type],
                _: &[$type],
                a: &mut [$type],
                first: bool,
                _: &mut Ticker<'_>,
            ) -> Result<()> {
                select_kernel(self.shape, &self.strength, self.softening2, &mut self.pull, q, a, first);
                Ok(())
            }
        }
    };
}
plain_force!(f64);
plain_force!(DoubleDouble);
