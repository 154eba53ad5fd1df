//! Nine to sixteen massive bodies of one trajectory, in two rows of lanes: the Sun and its planets.
//!
//! The one idea: each row is a [`ring`](super::ring) of its own, and each body of the second row meets the eight of the
//! first at once, so that every pair is weighed once: nine bodies take five weights of eight, where
//! [`tiles`](super::tiles) take twenty.
//!
//! Canonical order: a body of the first row has its row in the ring's order, then the second row from its first on; one of
//! the second has its row in the ring's order, and to that is added what the eight of the first are together, neighbors
//! first ([`Vector8::sum_in_every_lane`]).

use super::pair::{components, squared_distance};
use super::ring::{Ring, turns};
use crate::error::Result;
use crate::forces::{Adds, Force, Phase};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers};
use crate::parallel::Ticker;
use crate::tiered;

/// The most massive bodies that two rows have.
pub(super) const TWO_ROWS_MAX: usize = 2 * WIDTH;

/// Gravity among the bodies of two rows.
#[derive(Debug)]
pub struct TwoRows {
    first: Ring,
    second: Ring,
    /// `G·m` of the first row.
    strength: Lanes,
    /// `G·m` of the second row.
    second_strength: Vec<f64>,
    softening2: f64,
    components: usize,
}

impl TwoRows {
    /// From `G·m` of the bodies, and how many components their places have; `None` of eight or fewer, and of more than
    /// sixteen.
    pub fn new(strength: &[f64], softening: f64, components: usize) -> Option<Self> {
        let (&first, second) = strength.split_first_chunk::<WIDTH>()?;
        (1..=TWO_ROWS_MAX - WIDTH).contains(&second.len()).then(|| Self {
            first: Ring::of_row(&first, softening),
            second: Ring::of_row(second, softening),
            strength: Lanes(first),
            second_strength: second.to_vec(),
            softening2: softening * softening,
            components,
        })
    }

    /// Whether they stay in a plane, and there is a kernel for that.
    #[inline(always)]
    fn planar<V: Vector8>(&self) -> bool {
        !V::APART && self.components == 2
    }

    /// The accelerations of both rows of `q`, whose components are `stride` apart.
    pub(super) fn sums(&self, q: &[Lanes], stride: usize) -> [[Lanes; 3]; 2] {
        sums_tier(self, q, stride)
    }
}

/// A row of places.
#[inline(always)]
fn row<V: Vector8>(q: &[Lanes], stride: usize, row: usize, components: usize) -> [V; 3] {
    let mut place = [V::zero(); 3];
    for c in 0..components {
        place[c] = V::load(q[c * stride + row]);
    }
    place
}

#[inline(always)]
fn both<V: Vector8 + InverseCube, const PLANAR: bool>(
    rows: &TwoRows,
    q: &[Lanes],
    stride: usize,
) -> [[V; 3]; 2] {
    let components = components::<V, PLANAR>(rows.components);
    let place = row::<V>(q, stride, 0, components);
    let mut sum = turns::<V, PLANAR, 4, true>(&rows.first, place).gravity::<PLANAR, true>(&rows.first);
    let (strength, softening2) = (V::load(rows.strength), V::splat(rows.softening2));
    let numbers = as_numbers(q);
    let mut across = [V::zero(); 3];
    for (body, &own) in rows.second_strength.iter().enumerate() {
        let mut pull = [V::zero(); 3];
        for c in 0..components {
            pull[c] = place[c] - V::splat(numbers[(c * stride + 1) * WIDTH + body]);
        }
        let weight = squared_distance::<V, PLANAR, true>(pull, softening2).inverse_cube();
        let (own, here) = (V::splat(own), Bits(1 << body));
        for c in 0..components {
            pull[c] = pull[c] * weight;
            sum[c] = own.multiply_subtract_from(pull[c], sum[c]);
            across[c] = V::select(here, (strength * pull[c]).sum_in_every_lane(), across[c]);
        }
    }
    let mut second = second_row::<V, PLANAR>(&rows.second, row::<V>(q, stride, 1, components));
    for c in 0..components {
        second[c] += across[c];
    }
    [sum, second]
}

/// What the bodies of the second row are to each other.
#[inline(always)]
fn second_row<V: Vector8 + InverseCube, const PLANAR: bool>(ring: &Ring, place: [V; 3]) -> [V; 3] {
    macro_rules! select {
        ($($bodies:literal)+) => {
            match ring.bodies() {
                $($bodies => {
                    turns::<V, PLANAR, { $bodies / 2 }, { $bodies % 2 == 0 }>(ring, place)
                        .gravity::<PLANAR, { $bodies % 2 == 0 }>(ring)
                })+
                // One is alone.
                _ => [V::zero(); 3],
            }
        };
    }
    select!(2 3 4 5 6 7 8)
}

#[inline(always)]
fn sums<V: Vector8 + InverseCube>(rows: &TwoRows, q: &[Lanes], stride: usize) -> [[Lanes; 3]; 2] {
    let [first, second] =
        if rows.planar::<V>() { both::<V, true>(rows, q, stride) } else { both::<V, false>(rows, q, stride) };
    let mut sums = [[Lanes([0.0; WIDTH]); 3]; 2];
    for c in 0..3 {
        sums[0][c] = first[c].store();
        sums[1][c] = second[c].store();
    }
    sums
}

#[inline(always)]
fn apply<V: Vector8 + InverseCube>(rows: &TwoRows, q: &[Lanes], a: &mut [Lanes], first: bool) {
    if rows.planar::<V>() {
        write::<V, true>(rows, q, a, first);
    } else {
        write::<V, false>(rows, q, a, first);
    }
}

#[inline(always)]
fn write<V: Vector8 + InverseCube, const PLANAR: bool>(
    rows: &TwoRows,
    q: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    let sums = both::<V, PLANAR>(rows, q, 2);
    let components = components::<V, PLANAR>(rows.components);
    let a = &mut V::view_mut(a)[..2 * components];
    for c in 0..components {
        for (row, sum) in sums.iter().enumerate() {
            let a = &mut a[2 * c + row];
            *a = if first { sum[c] } else { *a + sum[c] };
        }
    }
}

tiered! {
    fn sums_tier[][](rows: &TwoRows, q: &[Lanes], stride: usize) -> [[Lanes; 3]; 2] = sums;
    fn apply_tier[][](rows: &TwoRows, q: &[Lanes], a: &mut [Lanes], first: bool) = apply;
}

impl Force<Lanes> for TwoRows {
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
