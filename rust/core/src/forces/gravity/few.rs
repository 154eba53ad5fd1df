//! Up to eight massive bodies, one trajectory (`f64`, double-double) or eight of them (`Lanes`).
//!
//! The loops run over pairs; the lanes, if any, over trajectories. Adds each body's terms in the ring
//! order of the module header, as [`ring`](super::ring) does with lanes over bodies.

use super::pair::squared_distance;
use super::passive::attraction;
use crate::error::Result;
use crate::forces::Force;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Shape};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::parallel::Ticker;
use crate::tiered;

/// Gravity among `strength.len()` massive bodies and the massless ones after them.
#[derive(Debug)]
pub struct FewBodies<S> {
    shape: Shape,
    /// `G·m` of the massive bodies.
    strength: Vec<S>,
    softening2: f64,
}

impl<S: Element> FewBodies<S> {
    /// From `G·m` of the massive bodies, at most [`RING_MAX`](super::RING_MAX), which come first in the state.
    pub fn new(shape: Shape, strength: Vec<S>, softening: f64) -> Self {
        Self { shape, strength, softening2: softening * softening }
    }
}

/// `N` massive bodies; known when compiled, so that everything about them stays in registers.
#[inline(always)]
fn kernel<S: InverseCube, const N: usize, const PLANAR: bool, const SOFT: bool>(
    shape: Shape,
    strength: &[S],
    softening2: f64,
    q: &[S],
    a: &mut [S],
    first: bool,
) {
    let rows = shape.rows;
    let components = if PLANAR { 2 } else { 3 };
    let softening2 = S::splat(softening2);
    let strength = &strength[..N];
    let mut position = [[S::zero(); 3]; N];
    for i in 0..N {
        for c in 0..components {
            position[i][c] = q[c * rows + i];
        }
    }
    let mut sum = [[S::zero(); 3]; N];
    for distance in 1..=N / 2 {
        let opposite = 2 * distance == N;
        let mut pull = [[S::zero(); 3]; N];
        for i in 0..N {
            let j = (i + distance) % N;
            let mut d = [S::zero(); 3];
            for c in 0..components {
                d[c] = position[j][c] - position[i][c];
            }
            let w = squared_distance::<S, PLANAR, SOFT>(d, softening2).inverse_cube();
            for c in 0..components {
                pull[i][c] = d[c] * w;
                sum[i][c] = strength[j].multiply_add(pull[i][c], sum[i][c]);
            }
        }
        if !opposite {
            for i in 0..N {
                let j = (i + N - distance) % N;
                for c in 0..components {
                    sum[i][c] = strength[j].multiply_subtract_from(pull[j][c], sum[i][c]);
                }
            }
        }
    }
    for i in 0..rows {
        let term = if i < N {
            sum[i]
        } else {
            let mut place = [S::zero(); 3];
            for c in 0..components {
                place[c] = q[c * rows + i];
            }
            attraction::<S, PLANAR, SOFT>(place, &position, strength, softening2)
        };
        for c in 0..components {
            let a = &mut a[c * rows + i];
            *a = if first { term[c] } else { *a + term[c] };
        }
    }
}

/// The kernel for so many massive bodies, in the plane or in space, softened or not.
#[inline(always)]
fn select_kernel<S: InverseCube>(
    shape: Shape,
    strength: &[S],
    softening2: f64,
    q: &[S],
    a: &mut [S],
    first: bool,
) {
    macro_rules! select {
        ($($bodies:literal)+) => {
            match (strength.len(), shape.components == 2, softening2 > 0.0) {
                $(
                    ($bodies, false, false) => kernel::<S, $bodies, false, false>(shape, strength, softening2, q, a, first),
                    ($bodies, false, true) => kernel::<S, $bodies, false, true>(shape, strength, softening2, q, a, first),
                    ($bodies, true, false) => kernel::<S, $bodies, true, false>(shape, strength, softening2, q, a, first),
                    ($bodies, true, true) => kernel::<S, $bodies, true, true>(shape, strength, softening2, q, a, first),
                )+
                // More than RING_MAX bodies never come here.
                _ => {}
            }
        };
    }
    select!(1 2 3 4 5 6 7 8);
}

#[inline(always)]
fn lanes_kernel<V: Vector8 + InverseCube>(
    shape: Shape,
    strength: &[Lanes],
    softening2: f64,
    q: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    select_kernel::<V>(shape, V::view(strength), softening2, V::view(q), V::view_mut(a), first);
}

tiered! {
    fn lanes_tier[][](shape: Shape, strength: &[Lanes], softening2: f64, q: &[Lanes], a: &mut [Lanes], first: bool) = lanes_kernel;
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
        lanes_tier(self.shape, &self.strength, self.softening2, q, a, first);
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
                select_kernel(self.shape, &self.strength, self.softening2, q, a, first);
                Ok(())
            }
        }
    };
}
plain_force!(f64);
plain_force!(DoubleDouble);
