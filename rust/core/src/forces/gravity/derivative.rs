//! How pulls of r⁻² change along a direction: of a pair `d = x_j − x_i`, whose ends move apart by `e`, the pull `d s^(−3/2)`
//! with `s = |d|² + ε²` changes by `s^(−3/2) (e − 3 (d·e)/s d)`.
//!
//! The one idea: terms are added in the order of the bodies that pull, whether the lanes are bodies or systems: the same bits
//! alone and in a batch. Of systems each pair is met once. Of bodies each row meets all that pull, one after another: threads
//! share out rows.

use super::pair::squared_distance;
use crate::error::Result;
use crate::forces::Phase;
use crate::forces::context::{Arrangement, Context, System, packed_place};
use crate::forces::derivative::{Along, Derivative};
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::real::{Mask, Real};
use crate::parallel::{Ticker, for_chunks};
use crate::tiered;

/// Rows that a thread takes at a time.
const ROWS: usize = 8;
/// Rows from which an evaluation ticks, as [`tiles`](super::tiles) do.
const LONG_ROWS: usize = 128;

/// Of Σ strengthⱼ (rⱼ − rᵢ)/(r² + softening²)^{3/2} on every body, from those that come first.
pub fn attraction(
    context: &Context<'_>,
    strength: impl Fn(&System<'_>, usize) -> f64,
    softening: impl Fn(&System<'_>) -> f64,
) -> Box<dyn Derivative<Lanes>> {
    let (shape, active) = (context.shape, context.active);
    let softening = |system: &System<'_>| context.units.take(softening(system), [1, 0, 0]);
    match context.arrangement {
        Arrangement::Batched => Box::new(Abreast {
            shape,
            active,
            strength: context.in_rows(active, strength),
            softening2: context.per_system(|system| softening(system) * softening(system)),
        }),
        Arrangement::Packed => {
            let system = context.first();
            let softening = softening(&system);
            let mut bodies = vec![Bits(0); shape.rows];
            for slot in 0..system.bodies.len() {
                let (row, lane) = packed_place(slot, active);
                bodies[row] = bodies[row].or(Bits(1 << lane));
            }
            Box::new(Packed {
                shape,
                strength: (0..active).map(|slot| strength(&system, slot)).collect(),
                softening2: softening * softening,
                bodies,
                threads: context.threads,
            })
        }
    }
}

/// What the pull between the ends of a pair changes by.
#[inline(always)]
fn change<V: InverseCube, const PLANAR: bool>(d: [V; 3], e: [V; 3], softening2: V) -> [V; 3] {
    let square = squared_distance::<V, PLANAR, true>(d, softening2);
    let [weight] = V::inverse_cubes([square]);
    // One over the root, whose square saves a division.
    let root = square * weight;
    let mut along = d[0] * e[0];
    along = d[1].multiply_add(e[1], along);
    if !PLANAR {
        along = d[2].multiply_add(e[2], along);
    }
    let along = V::splat(3.0) * along * (root * root);
    let mut change = [V::zero(); 3];
    for c in 0..if PLANAR { 2 } else { 3 } {
        change[c] = weight * along.multiply_subtract_from(d[c], e[c]);
    }
    change
}

/// Systems side by side.
struct Abreast {
    shape: Shape,
    active: usize,
    /// `G·m` of the bodies that pull, system after system.
    strength: Vec<Lanes>,
    softening2: Vec<Lanes>,
}

#[inline(always)]
fn abreast<V: Vector8 + InverseCube, const PLANAR: bool>(
    of: &Abreast,
    [q, along]: [&[Lanes]; 2],
    into: &mut [Lanes],
) {
    let (q, along, into) = (V::view(q), V::view(along), V::view_mut(into));
    let (strength, softening2) = (V::view(&of.strength), V::view(&of.softening2));
    let (rows, components) = (of.shape.rows, if PLANAR { 2 } else { 3 });
    let all = rows / softening2.len();
    for system in 0..softening2.len() {
        let (row, own) = (system * all, &strength[system * of.active..][..of.active]);
        for i in 0..of.active {
            for j in i + 1..all {
                let (mut d, mut e) = ([V::zero(); 3], [V::zero(); 3]);
                for c in 0..components {
                    let [from, to] = [c * rows + row + i, c * rows + row + j];
                    (d[c], e[c]) = (q[to] - q[from], along[to] - along[from]);
                }
                let term = change::<V, PLANAR>(d, e, softening2[system]);
                for c in 0..components {
                    let [from, to] = [c * rows + row + i, c * rows + row + j];
                    into[to] = own[i].multiply_subtract_from(term[c], into[to]);
                    if j < of.active {
                        into[from] = own[j].multiply_add(term[c], into[from]);
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn abreast_in_any<V: Vector8 + InverseCube>(of: &Abreast, numbers: [&[Lanes]; 2], into: &mut [Lanes]) {
    if of.shape.components == 2 {
        abreast::<V, true>(of, numbers, into);
    } else {
        abreast::<V, false>(of, numbers, into);
    }
}

/// Bodies of one system side by side.
struct Packed {
    shape: Shape,
    /// `G·m` of the bodies that pull.
    strength: Vec<f64>,
    softening2: f64,
    /// The lanes of each row in which a body is.
    bodies: Vec<Bits>,
    threads: usize,
}

/// Some rows of bodies, component after component into as many.
#[inline(always)]
fn rows<V: Vector8 + InverseCube, const PLANAR: bool>(
    of: &Packed,
    [q, along]: [&[Lanes]; 2],
    first_row: usize,
    into: &mut [Lanes],
) {
    let (rows, components) = (of.shape.rows, if PLANAR { 2 } else { 3 });
    let count = into.len() / components;
    let (numbers, directions) = (q, along);
    let (q, along, into) = (V::view(q), V::view(along), V::view_mut(into));
    let softening2 = V::splat(of.softening2);
    for at in 0..count {
        let row = first_row + at;
        let mut sum = [V::zero(); 3];
        for j in 0..of.strength.len() {
            let (its_row, lane) = (j / WIDTH, j % WIDTH);
            let (mut d, mut e) = ([V::zero(); 3], [V::zero(); 3]);
            for c in 0..components {
                let its = c * rows + its_row;
                d[c] = V::splat(numbers[its].0[lane]) - q[c * rows + row];
                e[c] = V::splat(directions[its].0[lane]) - along[c * rows + row];
            }
            let term = change::<V, PLANAR>(d, e, softening2);
            let others = if its_row == row { Bits(1 << lane).not() } else { Bits(0xff) };
            let (others, strength) = (others.and(of.bodies[row]), V::splat(of.strength[j]));
            for c in 0..components {
                sum[c] = V::select(others, strength.multiply_add(term[c], sum[c]), sum[c]);
            }
        }
        for c in 0..components {
            into[c * count + at] = sum[c];
        }
    }
}

#[inline(always)]
fn rows_in_any<V: Vector8 + InverseCube>(
    of: &Packed,
    numbers: [&[Lanes]; 2],
    first_row: usize,
    into: &mut [Lanes],
) {
    if of.shape.components == 2 {
        rows::<V, true>(of, numbers, first_row, into);
    } else {
        rows::<V, false>(of, numbers, first_row, into);
    }
}

tiered! {
    fn abreast_tier[][](of: &Abreast, numbers: [&[Lanes]; 2], into: &mut [Lanes]) = abreast_in_any;
    fn rows_tier[][](of: &Packed, numbers: [&[Lanes]; 2], first_row: usize, into: &mut [Lanes]) = rows_in_any;
}

impl Derivative<Lanes> for Abreast {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        along: Along<'_, Lanes>,
        change: &mut [Lanes],
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        change.fill(Lanes::zero());
        abreast_tier(self, [phase.q, along.q], change);
        Ok(())
    }
}

impl Packed {
    fn is_long(&self) -> bool {
        self.shape.rows >= LONG_ROWS
    }
}

impl Derivative<Lanes> for Packed {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        along: Along<'_, Lanes>,
        change: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Shape { rows, components } = self.shape;
        let (this, numbers) = (&*self, [phase.q, along.q]);
        let some = |chunk: usize, ticker: &mut Ticker<'_>| {
            if this.is_long() {
                ticker.tick()?;
            }
            let count = ROWS.min(rows - chunk * ROWS);
            let mut sums = vec![Lanes::zero(); count * components];
            rows_tier(this, numbers, chunk * ROWS, &mut sums);
            Ok(sums)
        };
        let threads = if this.is_long() { this.threads } else { 1 };
        for (chunk, sums) in for_chunks(threads, rows.div_ceil(ROWS), ticker, some)?.iter().enumerate() {
            let count = sums.len() / components;
            for (at, &sum) in sums.iter().enumerate() {
                change[at / count * rows + chunk * ROWS + at % count] = sum;
            }
        }
        Ok(())
    }

    fn stops_midway(&self) -> bool {
        self.is_long()
    }
}
