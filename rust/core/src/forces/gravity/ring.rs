//! Up to eight massive bodies of one trajectory, the lanes over the bodies.
//!
//! The one idea: with the bodies on a ring of `n` lanes, turning it by `k` lines up every pair at ring
//! distance `k`, so `n/2` vector square roots and divisions serve all `n(n-1)/2` pairs and the third law
//! gives the other half. Same bits as [`few`](super::few).

use super::pair::squared_distance;
use super::passive::packed_attraction;
use crate::error::Result;
use crate::forces::{Force, Phase};
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH, as_numbers};
use crate::parallel::Ticker;
use crate::tiered;

/// What one turn of the ring needs.
#[derive(Debug)]
struct Turn {
    forward: [i64; WIDTH],
    backward: [i64; WIDTH],
    /// `G·m` of the body ahead, zero in the lanes without a body.
    strength_ahead: Lanes,
    /// `G·m` of the body behind; `None` when ahead and behind are the same body.
    strength_behind: Option<Lanes>,
}

/// Gravity among the first `n ≤ 8` bodies (row 0) and on the massless ones (rows from 1).
#[derive(Debug)]
pub struct Ring {
    shape: Shape,
    turns: Vec<Turn>,
    strength: Vec<f64>,
    /// `ε²`, and 1 in the lanes without a body, which keeps their distance to themselves from being 0.
    softening2_first_row: Lanes,
    softening2: f64,
}

impl Ring {
    /// From `G·m` of the massive bodies, at most [`RING_MAX`](super::RING_MAX) of them.
    pub fn new(shape: Shape, strength: Vec<f64>, softening: f64) -> Self {
        let n = strength.len();
        let body = |lane: usize, distance: usize| if lane < n { (lane + distance) % n } else { lane };
        let weight = |lane: usize, distance: usize| {
            if lane < n { strength[(lane + distance) % n] } else { 0.0 }
        };
        let turns = (1..=n / 2)
            .map(|k| Turn {
                forward: core::array::from_fn(|lane| body(lane, k) as i64),
                backward: core::array::from_fn(|lane| body(lane, n - k) as i64),
                strength_ahead: Lanes(core::array::from_fn(|lane| weight(lane, k))),
                strength_behind: (2 * k != n)
                    .then(|| Lanes(core::array::from_fn(|lane| weight(lane, n - k)))),
            })
            .collect();
        let softening2 = softening * softening;
        let softening2_first_row =
            Lanes(core::array::from_fn(|lane| if lane < n { softening2 } else { 1.0 }));
        Self { shape, turns, strength, softening2_first_row, softening2 }
    }
}

#[inline(always)]
fn kernel<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize>(
    ring: &Ring,
    q: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    let rows = ring.shape.rows;
    let softening2 = V::load(ring.softening2_first_row);
    let components = if PLANAR { 2 } else { 3 };
    let mut place = [V::zero(); 3];
    for c in 0..components {
        place[c] = V::load(q[c * rows]);
    }
    let turns = &ring.turns[..TURNS];
    let mut d = [[V::zero(); 3]; TURNS];
    let mut r2 = [V::zero(); TURNS];
    for (k, turn) in turns.iter().enumerate() {
        for c in 0..components {
            d[k][c] = place[c].permute(&turn.forward) - place[c];
        }
        r2[k] = squared_distance::<V, PLANAR, true>(d[k], softening2);
    }
    let w = V::inverse_cubes(r2);
    let mut sum = [V::zero(); 3];
    for (k, turn) in turns.iter().enumerate() {
        let ahead = V::load(turn.strength_ahead);
        for c in 0..components {
            d[k][c] = d[k][c] * w[k];
            sum[c] = ahead.multiply_add(d[k][c], sum[c]);
        }
        if let Some(behind) = turn.strength_behind {
            let behind = V::load(behind);
            for c in 0..components {
                sum[c] = behind.multiply_subtract_from(d[k][c].permute(&turn.backward), sum[c]);
            }
        }
    }
    for c in 0..components {
        let a = &mut a[c * rows];
        *a = if first { sum[c] } else { V::load(*a) + sum[c] }.store();
    }
    if rows > 1 {
        if ring.softening2 > 0.0 {
            passive_rows::<V, PLANAR, true>(ring, q, a, first);
        } else {
            passive_rows::<V, PLANAR, false>(ring, q, a, first);
        }
    }
}

#[inline(always)]
fn passive_rows<V: Vector8 + InverseCube, const PLANAR: bool, const SOFT: bool>(
    ring: &Ring,
    q: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    let rows = ring.shape.rows;
    let numbers = as_numbers(q);
    let components = if PLANAR { 2 } else { 3 };
    for row in 1..rows {
        let mut position = [V::zero(); 3];
        for c in 0..components {
            position[c] = V::load(q[c * rows + row]);
        }
        let softening2 = V::splat(ring.softening2);
        let term =
            packed_attraction::<V, PLANAR, SOFT>(position, numbers, rows * WIDTH, &ring.strength, softening2);
        for c in 0..components {
            let a = &mut a[c * rows + row];
            *a = if first { term[c] } else { V::load(*a) + term[c] }.store();
        }
    }
}

#[inline(always)]
fn apply<V: Vector8 + InverseCube>(ring: &Ring, q: &[Lanes], a: &mut [Lanes], first: bool) {
    let planar = ring.shape.components == 2;
    macro_rules! select {
        ($($turns:literal)+) => {
            match (ring.turns.len(), planar) {
                $(
                    ($turns, false) => kernel::<V, false, $turns>(ring, q, a, first),
                    ($turns, true) => kernel::<V, true, $turns>(ring, q, a, first),
                )+
                // More than RING_MAX bodies never come here.
                _ => {}
            }
        };
    }
    select!(0 1 2 3 4);
}

tiered! {
    fn apply_tier[][](ring: &Ring, q: &[Lanes], a: &mut [Lanes], first: bool) = apply;
}

impl Force<Lanes> for Ring {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        apply_tier(self, phase.q, a, first);
        Ok(())
    }
}
