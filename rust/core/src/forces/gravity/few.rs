//! Up to eight massive bodies, one trajectory (`f64`, double-double) or eight of them (`Lanes`).
//!
//! The loops run over pairs; the lanes, if any, over trajectories. Adds each body's terms in the ring
//! order of the module header, as [`ring`](super::ring) does with lanes over bodies. A state may hold several
//! systems, one after another in its rows: each pair waits long for its weight, and another system's pairs
//! can be weighed meanwhile.

use super::pair::squared_distance;
use super::passive::attraction;
use crate::error::Result;
use crate::forces::{Force, Phase};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Shape};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::parallel::Ticker;
use crate::tiered;

/// Gravity among the massive bodies of each system and on the massless ones after them.
#[derive(Debug)]
pub struct FewBodies<S> {
    shape: Shape,
    systems: usize,
    /// `G·m` of the massive bodies, system after system.
    strength: Vec<S>,
    softening2: f64,
}

impl<S: Element> FewBodies<S> {
    /// From `G·m` of the massive bodies of each of the systems, at most [`RING_MAX`](super::RING_MAX), which come
    /// first in its rows.
    pub fn new(shape: Shape, systems: usize, strength: Vec<S>, softening: f64) -> Self {
        Self { shape, systems, strength, softening2: softening * softening }
    }
}

/// `(x_j - x_i)·r⁻³` of the pairs `j = i + distance` of the first `M` bodies.
#[inline(always)]
fn pulls<S: InverseCube, const M: usize, const PLANAR: bool, const SOFT: bool>(
    position: &[[S; 3]],
    distance: usize,
    softening2: S,
) -> [[S; 3]; M] {
    let components = if PLANAR { 2 } else { 3 };
    let mut pull = [[S::zero(); 3]; M];
    let mut r2 = [S::zero(); M];
    for i in 0..M {
        let j = (i + distance) % position.len();
        for c in 0..components {
            pull[i][c] = position[j][c] - position[i][c];
        }
        r2[i] = squared_distance::<S, PLANAR, SOFT>(pull[i], softening2);
    }
    let w = S::inverse_cubes(r2);
    for i in 0..M {
        for c in 0..components {
            pull[i][c] = pull[i][c] * w[i];
        }
    }
    pull
}

/// `N` massive bodies; known when compiled, so that everything about them stays in registers. `HALF` is `N/2`.
#[inline(always)]
fn kernel<S: InverseCube, const N: usize, const HALF: usize, const PLANAR: bool, const SOFT: bool>(
    shape: Shape,
    systems: usize,
    strength: &[S],
    softening2: f64,
    q: &[S],
    a: &mut [S],
    first: bool,
) {
    let softening2 = S::splat(softening2);
    for system in 0..systems {
        let strength = &strength[system * N..][..N];
        one_system::<S, N, HALF, PLANAR, SOFT>(shape, system, systems, strength, softening2, q, a, first);
    }
}

/// As [`kernel`], one of the systems.
#[inline(always)]
fn one_system<S: InverseCube, const N: usize, const HALF: usize, const PLANAR: bool, const SOFT: bool>(
    shape: Shape,
    system: usize,
    systems: usize,
    strength: &[S],
    softening2: S,
    q: &[S],
    a: &mut [S],
    first: bool,
) {
    let (rows, bodies) = (shape.rows, shape.rows / systems);
    let start = system * bodies;
    let components = if PLANAR { 2 } else { 3 };
    let mut position = [[S::zero(); 3]; N];
    for i in 0..N {
        for c in 0..components {
            position[i][c] = q[c * rows + start + i];
        }
    }
    let mut sum = [[S::zero(); 3]; N];
    for distance in 1..=(N - 1) / 2 {
        let pull = pulls::<S, N, PLANAR, SOFT>(&position, distance, softening2);
        for i in 0..N {
            let (ahead, behind) = ((i + distance) % N, (i + N - distance) % N);
            for c in 0..components {
                sum[i][c] = strength[ahead].multiply_add(pull[i][c], sum[i][c]);
                sum[i][c] = strength[behind].multiply_subtract_from(pull[behind][c], sum[i][c]);
            }
        }
    }
    if N.is_multiple_of(2) {
        // Ahead and behind are the same body.
        let pull = pulls::<S, HALF, PLANAR, SOFT>(&position, HALF, softening2);
        for i in 0..HALF {
            let opposite = i + HALF;
            for c in 0..components {
                sum[i][c] = strength[opposite].multiply_add(pull[i][c], sum[i][c]);
                sum[opposite][c] = strength[i].multiply_subtract_from(pull[i][c], sum[opposite][c]);
            }
        }
    }
    for i in 0..bodies {
        let term = if i < N {
            sum[i]
        } else {
            let mut place = [S::zero(); 3];
            for c in 0..components {
                place[c] = q[c * rows + start + i];
            }
            attraction::<S, PLANAR, SOFT>(place, &position, strength, softening2)
        };
        for c in 0..components {
            let a = &mut a[c * rows + start + i];
            *a = if first { term[c] } else { *a + term[c] };
        }
    }
}

/// The kernel for so many massive bodies, in the plane or in space, softened or not.
#[inline(always)]
fn select_kernel<S: InverseCube>(
    shape: Shape,
    systems: usize,
    strength: &[S],
    softening2: f64,
    q: &[S],
    a: &mut [S],
    first: bool,
) {
    macro_rules! select {
        ($($bodies:literal)+) => {
            match (strength.len() / systems, shape.components == 2, softening2 > 0.0) {
                $(
                    ($bodies, false, false) => select!($bodies, false, false),
                    ($bodies, false, true) => select!($bodies, false, true),
                    ($bodies, true, false) => select!($bodies, true, false),
                    ($bodies, true, true) => select!($bodies, true, true),
                )+
                // More than RING_MAX bodies never come here.
                _ => {}
            }
        };
        ($bodies:literal, $planar:literal, $soft:literal) => {
            kernel::<S, $bodies, { $bodies / 2 }, $planar, $soft>(shape, systems, strength, softening2, q, a, first)
        };
    }
    select!(1 2 3 4 5 6 7 8);
}

#[inline(always)]
fn lanes_kernel<V: Vector8 + InverseCube>(
    bodies: &FewBodies<Lanes>,
    q: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    let strength = V::view(&bodies.strength);
    let (q, a) = (V::view(q), V::view_mut(a));
    select_kernel::<V>(bodies.shape, bodies.systems, strength, bodies.softening2, q, a, first);
}

tiered! {
    fn lanes_tier[][](bodies: &FewBodies<Lanes>, q: &[Lanes], a: &mut [Lanes], first: bool) = lanes_kernel;
}

impl Force<Lanes> for FewBodies<Lanes> {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        lanes_tier(self, phase.q, a, first);
        Ok(())
    }
}

macro_rules! plain_force {
    ($type:ty) => {
        impl Force<$type> for FewBodies<$type> {
            fn apply(
                &mut self,
                phase: &Phase<'_, $type>,
                a: &mut [$type],
                first: bool,
                _: &mut Ticker<'_>,
            ) -> Result<()> {
                let (shape, strength) = (self.shape, &self.strength);
                select_kernel(shape, self.systems, strength, self.softening2, phase.q, a, first);
                Ok(())
            }
        }
    };
}
plain_force!(f64);
plain_force!(DoubleDouble);
