//! Up to eight massive bodies of one trajectory, the lanes over the bodies.
//!
//! The one idea: with the bodies on a ring of `n` lanes, turning it by `k` lines up every pair at ring
//! distance `k`, so `n/2` vector square roots and divisions serve all `n(n-1)/2` pairs and the third law
//! gives the other half. Same bits as [`few`](super::few).

use super::pair::{components, squared_distance};
use super::passive::packed_attraction;
use crate::error::Result;
use crate::forces::{Adds, Force, Phase};
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
    /// Of `G·m`.
    strength: Weight,
}

/// A number of the bodies that a turn brings together.
#[derive(Debug)]
pub(in crate::forces) struct Weight {
    /// Of the body ahead, zero in the lanes without a body.
    ahead: Lanes,
    /// Of the body behind; not looked at when ahead and behind are the same body.
    behind: Lanes,
}

impl Weight {
    /// Of so many turns, from the numbers of the bodies.
    pub(in crate::forces) fn of_turns(numbers: &[f64]) -> Vec<Self> {
        let n = numbers.len();
        let weight = |distance: usize| {
            Lanes(core::array::from_fn(|lane| if lane < n { numbers[(lane + distance) % n] } else { 0.0 }))
        };
        (1..=n / 2).map(|k| Self { ahead: weight(k), behind: weight(n - k) }).collect()
    }
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
    /// Of the bodies of one row, from their `G·m`.
    pub(super) fn of_row(strength: &[f64], softening: f64) -> Self {
        Self::new(Shape { rows: 1, components: 3 }, strength.to_vec(), softening)
    }

    /// From `G·m` of the massive bodies, at most [`RING_MAX`](super::RING_MAX) of them.
    pub fn new(shape: Shape, strength: Vec<f64>, softening: f64) -> Self {
        let n = strength.len();
        let body = |lane: usize, distance: usize| if lane < n { (lane + distance) % n } else { lane };
        let turns = (1..=n / 2)
            .zip(Weight::of_turns(&strength))
            .map(|(k, strength)| Turn {
                forward: core::array::from_fn(|lane| body(lane, k) as i64),
                backward: core::array::from_fn(|lane| body(lane, n - k) as i64),
                strength,
            })
            .collect();
        let softening2 = softening * softening;
        let softening2_first_row =
            Lanes(core::array::from_fn(|lane| if lane < n { softening2 } else { 1.0 }));
        Self { shape, turns, strength, softening2_first_row, softening2 }
    }

    /// How many bodies are on it.
    pub(super) fn bodies(&self) -> usize {
        self.strength.len()
    }

    /// Whether they stay in a plane, and there is a kernel for that.
    #[inline(always)]
    pub(super) fn planar<V: Vector8>(&self) -> bool {
        !V::APART && self.shape.components == 2
    }

    /// How many components their places have.
    pub(super) fn components(&self) -> usize {
        self.shape.components
    }
}

/// What is found between the bodies of a ring, turn by turn.
#[derive(Debug)]
pub(in crate::forces) struct Turns<V, const TURNS: usize> {
    /// r⁻³ of each body and the one ahead.
    pub weight: [V; TURNS],
    /// `(x_j - x_i)·r⁻³` of the body ahead.
    ahead: [[V; 3]; TURNS],
    /// What that is for the body behind, against its direction; not in half a turn.
    behind: [[V; 3]; TURNS],
}

impl<V: Vector8, const TURNS: usize> Turns<V, TURNS> {
    /// Σ (x_j - x_i)·r⁻³, weighted, in the ring's order.
    #[inline(always)]
    pub(in crate::forces) fn sum<const PLANAR: bool, const EVEN: bool>(&self, weights: &[Weight]) -> [V; 3] {
        let mut sum = [V::zero(); 3];
        for (k, weight) in weights[..TURNS].iter().enumerate() {
            self.add_turn::<PLANAR>(&mut sum, k, weight, EVEN && k + 1 == TURNS);
        }
        sum
    }

    /// Gravity on each body.
    #[inline(always)]
    pub(super) fn gravity<const PLANAR: bool, const EVEN: bool>(&self, ring: &Ring) -> [V; 3] {
        let mut sum = [V::zero(); 3];
        for (k, turn) in ring.turns[..TURNS].iter().enumerate() {
            self.add_turn::<PLANAR>(&mut sum, k, &turn.strength, EVEN && k + 1 == TURNS);
        }
        sum
    }

    /// Adds the pulls of a turn, ahead and, unless it is `half` a turn, behind.
    #[inline(always)]
    fn add_turn<const PLANAR: bool>(&self, sum: &mut [V; 3], k: usize, weight: &Weight, half: bool) {
        let components = if PLANAR { 2 } else { 3 };
        let ahead = V::load(weight.ahead);
        for c in 0..components {
            sum[c] = ahead.multiply_add(self.ahead[k][c], sum[c]);
        }
        if !half {
            let behind = V::load(weight.behind);
            for c in 0..components {
                sum[c] = behind.multiply_subtract_from(self.behind[k][c], sum[c]);
            }
        }
    }
}

/// What is between bodies at these places.
#[inline(always)]
pub(super) fn turns<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
    ring: &Ring,
    place: [V; 3],
) -> Turns<V, TURNS> {
    let softening2 = V::load(ring.softening2_first_row);
    let components = if PLANAR { 2 } else { 3 };
    let turns = &ring.turns[..TURNS];
    let mut ahead = [[V::zero(); 3]; TURNS];
    let mut r2 = [V::zero(); TURNS];
    for (k, turn) in turns.iter().enumerate() {
        for c in 0..components {
            ahead[k][c] = place[c].permute(&turn.forward) - place[c];
        }
        r2[k] = squared_distance::<V, PLANAR, true>(ahead[k], softening2);
    }
    let weight = V::inverse_cubes(r2);
    let mut behind = [[V::zero(); 3]; TURNS];
    for (k, turn) in turns.iter().enumerate() {
        for c in 0..components {
            ahead[k][c] = ahead[k][c] * weight[k];
            if !(EVEN && k + 1 == TURNS) {
                behind[k][c] = ahead[k][c].permute(&turn.backward);
            }
        }
    }
    Turns { weight, ahead, behind }
}

#[inline(always)]
fn kernel<V: Vector8 + InverseCube, const PLANAR: bool, const TURNS: usize, const EVEN: bool>(
    ring: &Ring,
    q: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    let rows = ring.shape.rows;
    // Not copied: a copy is made with narrower instructions than it is read with.
    let (places, sums) = (V::view(q), V::view_mut(&mut *a));
    let components = components::<V, PLANAR>(ring.shape.components);
    let mut place = [V::zero(); 3];
    for c in 0..components {
        place[c] = places[c * rows];
    }
    let mut sum = turns::<V, PLANAR, TURNS, EVEN>(ring, place).gravity::<PLANAR, EVEN>(ring);
    if !first {
        for c in 0..components {
            sum[c] = sums[c * rows] + sum[c];
        }
    }
    for c in 0..components {
        sums[c * rows] = sum[c];
    }
    if rows > 1 {
        match (components == 2, ring.softening2 > 0.0) {
            (false, false) => passive_rows::<V, false, false>(ring, q, a, first),
            (false, true) => passive_rows::<V, false, true>(ring, q, a, first),
            (true, false) => passive_rows::<V, true, false>(ring, q, a, first),
            (true, true) => passive_rows::<V, true, true>(ring, q, a, first),
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
    macro_rules! select {
        ($planar:literal: $($bodies:literal)+) => {
            match ring.strength.len() {
                $($bodies => kernel::<V, $planar, { $bodies / 2 }, { $bodies % 2 == 0 }>(ring, q, a, first),)+
                // More than RING_MAX bodies never come here.
                _ => {}
            }
        };
    }
    if ring.planar::<V>() {
        select!(true: 0 1 2 3 4 5 6 7 8);
    } else {
        select!(false: 0 1 2 3 4 5 6 7 8);
    }
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
    fn adds(&self) -> Adds {
        Adds::OnceAtLast
    }
}
