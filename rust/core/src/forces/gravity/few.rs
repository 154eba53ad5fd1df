//! Up to eight massive bodies, eight trajectories side by side (`Lanes`); of tests also one (`f64`, double-double).
//!
//! The loops run over pairs; the lanes, if any, over trajectories. Adds each body's terms in the ring
//! order of the module header, as [`ring`](super::ring) does with lanes over bodies. A state may hold several
//! systems, one after another in its rows: each pair waits long for its weight, and another system's pairs
//! can be weighed meanwhile.

use super::RING_MAX;
use super::pair::squared_distance;
use super::passive::attraction;
use crate::error::Result;
use crate::forces::{Adds, Force, Phase};
#[cfg(test)]
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Shape};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8};
use crate::numerics::real::{Mask, Real};
use crate::parallel::Ticker;
use crate::tiered;

/// Gravity among the massive bodies of each system and on the massless ones after them.
#[derive(Clone, Debug)]
pub struct FewBodies<S> {
    pub(super) shape: Shape,
    pub(super) systems: usize,
    /// `G·m` of the massive bodies, system after system.
    pub(super) strength: Vec<S>,
    /// The softening length of each system, squared, and whether any is more than nothing.
    pub(super) softening2: Vec<S>,
    pub(super) soft: bool,
}

impl<S: Element> FewBodies<S> {
    /// From `G·m` of the massive bodies of each of the systems, at most [`RING_MAX`](super::RING_MAX), which come
    /// first in its rows, and the softening length of each.
    pub fn new(shape: Shape, strength: Vec<S>, softening: Vec<S>) -> Self {
        let soft = softening.iter().any(|softening| S::zero().less(*softening).any());
        let softening2: Vec<S> = softening.into_iter().map(|softening| softening * softening).collect();
        Self { shape, systems: softening2.len(), strength, softening2, soft }
    }
    /// How their coordinates lie.
    pub fn shape(&self) -> Shape {
        self.shape
    }
    /// Bodies of each system.
    pub(super) fn bodies(&self) -> usize {
        self.shape.rows / self.systems
    }
}

/// `(x_j - x_i)·r⁻³` of the pairs `j = i + distance` in each system of `N` bodies: of all bodies of the systems if
/// `P` is their number, of the first half of each if it is half of that.
#[inline(always)]
fn pulls<S: InverseCube, const N: usize, const P: usize, const PLANAR: bool, const SOFT: bool>(
    position: &[[S; 3]],
    distance: usize,
    softening2: &[S],
) -> [[S; 3]; P] {
    let components = if PLANAR { 2 } else { 3 };
    let pairs = P * N / position.len();
    let mut pull = [[S::zero(); 3]; P];
    let mut r2 = [S::zero(); P];
    for p in 0..P {
        let (system, i) = (p / pairs * N, p % pairs);
        let j = (i + distance) % N;
        for c in 0..components {
            pull[p][c] = position[system + j][c] - position[system + i][c];
        }
        r2[p] = squared_distance::<S, PLANAR, SOFT>(pull[p], softening2[p / pairs]);
    }
    let w = S::inverse_cubes(r2);
    for p in 0..P {
        for c in 0..components {
            pull[p][c] = pull[p][c] * w[p];
        }
    }
    pull
}

/// The accelerations of the bodies at `position`, of all systems: `N` bodies each, `ALL` together, half of them `HALF`.
#[inline(always)]
pub(super) fn sums<
    S: InverseCube,
    const N: usize,
    const ALL: usize,
    const HALF: usize,
    const PLANAR: bool,
    const SOFT: bool,
>(
    position: &[[S; 3]; ALL],
    strength: &[S],
    softening2: &[S],
) -> [[S; 3]; ALL] {
    let components = if PLANAR { 2 } else { 3 };
    let (strength, softening2) = (&strength[..ALL], &softening2[..ALL / N]);
    let mut sum = [[S::zero(); 3]; ALL];
    for distance in 1..=(N - 1) / 2 {
        let pull = pulls::<S, N, ALL, PLANAR, SOFT>(position, distance, softening2);
        for i in 0..ALL {
            let (own, place) = (i / N * N, i % N);
            let (ahead, behind) = (own + (place + distance) % N, own + (place + N - distance) % N);
            for c in 0..components {
                sum[i][c] = strength[ahead].multiply_add(pull[i][c], sum[i][c]);
                sum[i][c] = strength[behind].multiply_subtract_from(pull[behind][c], sum[i][c]);
            }
        }
    }
    if N.is_multiple_of(2) {
        // Ahead and behind are the same body.
        let pull = pulls::<S, N, HALF, PLANAR, SOFT>(position, N / 2, softening2);
        for p in 0..HALF {
            let i = p / (N / 2) * N + p % (N / 2);
            let opposite = i + N / 2;
            for c in 0..components {
                sum[i][c] = strength[opposite].multiply_add(pull[p][c], sum[i][c]);
                sum[opposite][c] = strength[i].multiply_subtract_from(pull[p][c], sum[opposite][c]);
            }
        }
    }
    sum
}

/// What is the same for all systems of a state.
struct Systems<'a, S> {
    shape: Shape,
    count: usize,
    strength: &'a [S],
    softening2: &'a [S],
    soft: bool,
    q: &'a [S],
}

/// `N` massive bodies; known when compiled, so that everything about them stays in registers. `HALF` is `N/2`. Two
/// systems of up to three go together where registers are `MANY`, their pairs waiting side by side; `TWICE` is `2·N`.
#[inline(always)]
fn kernel<
    S: InverseCube,
    const N: usize,
    const HALF: usize,
    const TWICE: usize,
    const MANY: bool,
    const PLANAR: bool,
    const SOFT: bool,
>(
    systems: &Systems<'_, S>,
    a: &mut [S],
    first: bool,
) {
    let mut system = 0;
    while MANY && N <= 3 && system + 2 <= systems.count {
        some_systems::<S, N, TWICE, N, PLANAR, SOFT>(systems, system, a, first);
        system += 2;
    }
    for system in system..systems.count {
        some_systems::<S, N, N, HALF, PLANAR, SOFT>(systems, system, a, first);
    }
}

/// As [`kernel`], for the next systems: as many as have `ALL` massive bodies together, half of them `HALF`.
#[inline(always)]
fn some_systems<
    S: InverseCube,
    const N: usize,
    const ALL: usize,
    const HALF: usize,
    const PLANAR: bool,
    const SOFT: bool,
>(
    systems: &Systems<'_, S>,
    system: usize,
    a: &mut [S],
    first: bool,
) {
    let (rows, bodies) = (systems.shape.rows, systems.shape.rows / systems.count);
    let q = systems.q;
    let strength = &systems.strength[system * N..][..ALL];
    let softening2 = &systems.softening2[system..][..ALL / N];
    let components = if PLANAR { 2 } else { 3 };
    // Where the body of that number is: the first of each system are massive.
    macro_rules! row {
        ($number:expr) => {
            (system + $number / N) * bodies + $number % N
        };
    }
    let mut position = [[S::zero(); 3]; ALL];
    for i in 0..ALL {
        for c in 0..components {
            position[i][c] = q[c * rows + row!(i)];
        }
    }
    let sum = sums::<S, N, ALL, HALF, PLANAR, SOFT>(&position, strength, softening2);
    for i in 0..ALL {
        add::<S>(a, row!(i), rows, components, sum[i], first);
    }
    for own in (0..ALL).step_by(N) {
        for massless in N..bodies {
            let row = row!(own) + massless;
            let mut place = [S::zero(); 3];
            for c in 0..components {
                place[c] = q[c * rows + row];
            }
            let (places, strength) = (&position[own..own + N], &strength[own..own + N]);
            let term = attraction::<S, PLANAR, SOFT>(place, places, strength, softening2[own / N]);
            add::<S>(a, row, rows, components, term, first);
        }
    }
}

/// As [`select_kernel`], for any number of bodies, the same sums in the same order: where [operations are
/// calls](Vector8::APART).
fn any_systems<S: InverseCube>(systems: &Systems<'_, S>, a: &mut [S], first: bool) {
    let (rows, components) = (systems.shape.rows, systems.shape.components);
    let (bodies, massive) = (rows / systems.count, systems.strength.len() / systems.count);
    let none = [[S::zero(); 3]; RING_MAX];
    for (system, strength) in systems.strength.chunks_exact(massive.max(1)).enumerate() {
        let softening2 = systems.softening2[system];
        let place = |body: usize| {
            let mut place = [S::zero(); 3];
            for c in 0..components {
                place[c] = systems.q[c * rows + system * bodies + body];
            }
            place
        };
        let (mut position, mut sum, mut pull) = (none, none, none);
        for i in 0..massive {
            position[i] = place(i);
        }
        for distance in 1..=massive / 2 {
            for i in 0..massive {
                let ahead = position[(i + distance) % massive];
                for c in 0..3 {
                    pull[i][c] = ahead[c] - position[i][c];
                }
                let weight = squared_distance::<S, false, true>(pull[i], softening2).inverse_cube();
                pull[i] = pull[i].map(|pull| pull * weight);
            }
            for i in 0..massive {
                let (ahead, behind) = ((i + distance) % massive, (i + massive - distance) % massive);
                for c in 0..3 {
                    sum[i][c] = strength[ahead].multiply_add(pull[i][c], sum[i][c]);
                    if ahead != behind {
                        sum[i][c] = strength[behind].multiply_subtract_from(pull[behind][c], sum[i][c]);
                    }
                }
            }
        }
        for body in 0..bodies {
            let term = match sum[..massive].get(body) {
                Some(&sum) => sum,
                None => attraction::<S, false, true>(place(body), &position[..massive], strength, softening2),
            };
            add(a, system * bodies + body, rows, components, term, first);
        }
    }
}

/// Writes an acceleration, or adds it.
#[inline(always)]
fn add<S: Real>(a: &mut [S], row: usize, rows: usize, components: usize, term: [S; 3], first: bool) {
    for c in 0..components {
        let a = &mut a[c * rows + row];
        *a = if first { term[c] } else { *a + term[c] };
    }
}

/// The kernel for so many massive bodies, in the plane or in space, softened or not.
#[inline(always)]
fn select_kernel<S: InverseCube, const MANY: bool>(systems: &Systems<'_, S>, a: &mut [S], first: bool) {
    macro_rules! select {
        ($($bodies:literal)+) => {
            match (systems.strength.len() / systems.count, systems.shape.components == 2, systems.soft) {
                $(
                    ($bodies, false, false) => select!($bodies, false, false),
                    ($bodies, false, true) => select!($bodies, false, true),
                    ($bodies, true, false) => select!($bodies, true, false),
                    ($bodies, true, true) => select!($bodies, true, true),
                )+
                // More than RING_MAX bodies have a kernel of their own (`many`).
                _ => {}
            }
        };
        ($bodies:literal, $planar:literal, $soft:literal) => {
            kernel::<S, $bodies, { $bodies / 2 }, { 2 * $bodies }, MANY, $planar, $soft>(
                systems, a, first,
            )
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
    let systems = Systems {
        shape: bodies.shape,
        count: bodies.systems,
        strength: V::view(&bodies.strength),
        softening2: V::view(&bodies.softening2),
        soft: bodies.soft,
        q: V::view(q),
    };
    if V::APART {
        any_systems(&systems, V::view_mut(a), first);
    } else if V::REGISTERS >= 32 {
        select_kernel::<V, true>(&systems, V::view_mut(a), first);
    } else {
        select_kernel::<V, false>(&systems, V::view_mut(a), first);
    }
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
    fn adds(&self) -> Adds {
        Adds::OnceAtLast
    }
}

/// One trajectory, to which tests compare lanes, and numbers of twice the digits, by which they measure errors. A build does
/// without: written out for each number of bodies, these are a good part of all code.
#[cfg(test)]
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
                let systems = Systems {
                    shape: self.shape,
                    count: self.systems,
                    strength: &self.strength,
                    softening2: &self.softening2,
                    soft: self.soft,
                    q: phase.q,
                };
                select_kernel::<$type, false>(&systems, a, first);
                Ok(())
            }
        }
    };
}
#[cfg(test)]
plain_force!(f64);
#[cfg(test)]
plain_force!(DoubleDouble);
