//! A potential over lanes: the loops that are compiled for each potential and each SIMD tier.
//!
//! They know places and distances and nothing of forces, which call them by way of [`Potential`](super::Potential):
//! one indirect call for rows of bodies, everything hot inside it.

use super::{Analytic, Formula, Numbers};
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers, as_numbers_mut};
use crate::tiered;

#[inline(always)]
fn value_rows<V: Vector8 + Analytic, P: Formula>(potential: &P, r: &[Lanes], value: &mut [Lanes]) {
    let own = &splat::<V, P>(potential);
    for (value, r) in V::view_mut(value).iter_mut().zip(V::view(r)) {
        *value = potential.value(own, *r);
    }
}

#[inline(always)]
fn force_rows<V: Vector8 + Analytic, P: Formula>(potential: &P, r: &[Lanes], force: &mut [Lanes]) {
    let own = &splat::<V, P>(potential);
    for (force, r) in V::view_mut(force).iter_mut().zip(V::view(r)) {
        *force = potential.force(own, *r);
    }
}

#[inline(always)]
fn all_rows<V: Vector8 + Analytic, P: Formula>(
    potential: &P,
    r: &[Lanes],
    value: &mut [Lanes],
    force: &mut [Lanes],
    curvature: &mut [Lanes],
) {
    let own = &splat::<V, P>(potential);
    let (r, value, force, curvature) =
        (V::view(r), V::view_mut(value), V::view_mut(force), V::view_mut(curvature));
    for row in 0..r.len() {
        let all = potential.all(own, r[row]);
        value[row] = all[0];
        force[row] = all[1];
        if let Some(curvature) = curvature.get_mut(row) {
            *curvature = all[2];
        }
    }
}

/// As [`all_rows`] without V, of the numbers of the potential of each lane.
#[inline(always)]
fn force_and_curvature<V: Vector8 + Analytic, P: Formula>(
    potential: &P,
    numbers: &Numbers<Lanes>,
    r: &[Lanes],
    into: [&mut [Lanes]; 2],
) {
    let own = &load::<V>(numbers);
    let [force, curvature] = into;
    let (r, force, curvature) = (V::view(r), V::view_mut(force), V::view_mut(curvature));
    for row in 0..r.len() {
        [_, force[row], curvature[row]] = potential.all(own, r[row]);
    }
}

/// The potential's own numbers in every lane.
#[inline(always)]
fn splat<V: Vector8, P: Formula>(potential: &P) -> Numbers<V> {
    let mut own = [V::zero(); 5];
    for (own, number) in own.iter_mut().zip(potential.numbers()) {
        *own = V::splat(number);
    }
    own
}

tiered! {
    pub(super) fn value_rows_tier[P: Formula][P](potential: &P, r: &[Lanes], value: &mut [Lanes]) = value_rows;
    pub(super) fn force_rows_tier[P: Formula][P](potential: &P, r: &[Lanes], force: &mut [Lanes]) = force_rows;
    pub(super) fn all_rows_tier[P: Formula][P](potential: &P, r: &[Lanes], value: &mut [Lanes], force: &mut [Lanes], curvature: &mut [Lanes]) = all_rows;
    pub(super) fn force_and_curvature_tier[P: Formula][P](potential: &P, numbers: &Numbers<Lanes>, r: &[Lanes], into: [&mut [Lanes]; 2]) = force_and_curvature;
}

/// Bodies around a fixed point.
#[derive(Debug)]
pub struct Around {
    /// How their coordinates lie.
    pub shape: Shape,
    /// The point and the numbers of the potential, of each block of rows.
    pub center: Vec<[Lanes; 3]>,
    /// See there.
    pub numbers: Vec<Numbers<Lanes>>,
    /// 1/m of each row's bodies.
    pub inverse_mass: Vec<Lanes>,
}

#[inline(always)]
fn around<V: Vector8 + Analytic, P: Formula>(
    potential: &P,
    field: &Around,
    q: &[Lanes],
    a: &mut [Lanes],
    first: bool,
) {
    let Shape { rows, components } = field.shape;
    let (q, a) = (V::view(q), V::view_mut(a));
    let inverse_mass = V::view(&field.inverse_mass);
    let bodies = rows / field.numbers.len();
    for block in 0..field.numbers.len() {
        let own = &load::<V>(&field.numbers[block]);
        for row in block * bodies..(block + 1) * bodies {
            let mut d = [V::zero(); 3];
            let mut r2 = V::zero();
            for c in 0..components {
                d[c] = q[c * rows + row] - V::load(field.center[block][c]);
                r2 += d[c] * d[c];
            }
            let pull = if P::SINGULAR {
                let r = r2.sqrt();
                potential.force(own, r) / r
            } else {
                potential.over_distance(own, r2)
            };
            // Lanes without a body are far out, where a table has no force.
            let nobody = inverse_mass[row].less_equal(V::zero());
            let pull = V::select(nobody, V::zero(), pull * inverse_mass[row]);
            for c in 0..components {
                let a = &mut a[c * rows + row];
                let term = pull * d[c];
                *a = if first { term } else { *a + term };
            }
        }
    }
}

/// The numbers of a block.
#[inline(always)]
fn load<V: Vector8>(numbers: &Numbers<Lanes>) -> Numbers<V> {
    let mut loaded = [V::zero(); 5];
    for place in 0..loaded.len() {
        loaded[place] = V::load(numbers[place]);
    }
    loaded
}

tiered! {
    pub(super) fn around_tier[P: Formula][P](potential: &P, field: &Around, q: &[Lanes], a: &mut [Lanes], first: bool) = around;
}

/// Bodies of one system in rows, eight to a row, or a system to each lane.
#[derive(Debug)]
pub struct Pairs {
    /// How their coordinates lie.
    pub shape: Shape,
    /// Systems one after another in the rows, if lanes are systems.
    pub blocks: usize,
    /// Bodies of a system.
    pub bodies: usize,
    /// The numbers of the potential, of each block of rows.
    pub numbers: Vec<Numbers<Lanes>>,
}

/// Bodies of a row that meet a block of eight together, so that one's operations fill another's waits.
const GROUP: usize = 4;

/// How much of `d` is the force along it, for distances squared.
#[inline(always)]
fn pull<V: Vector8 + Analytic, P: Formula>(potential: &P, own: &Numbers<V>, d: [V; 3]) -> V {
    let r2 = d[2].multiply_add(d[2], d[1].multiply_add(d[1], d[0] * d[0]));
    potential.over_distance(own, r2)
}

#[inline(always)]
fn between_systems<V: Vector8 + Analytic, P: Formula>(
    potential: &P,
    pairs: &Pairs,
    q: &[Lanes],
    force: &mut [Lanes],
) {
    let Shape { rows, components } = pairs.shape;
    let (q, force) = (V::view(q), V::view_mut(force));
    for block in 0..pairs.blocks {
        let start = block * pairs.bodies;
        let own = &load::<V>(&pairs.numbers[block]);
        for i in start..start + pairs.bodies {
            for j in i + 1..start + pairs.bodies {
                let mut d = [V::zero(); 3];
                for c in 0..components {
                    d[c] = q[c * rows + j] - q[c * rows + i];
                }
                let w = pull(potential, own, d);
                for c in 0..components {
                    let (from, to) = (c * rows + i, c * rows + j);
                    force[from] = w.multiply_subtract_from(d[c], force[from]);
                    force[to] = w.multiply_add(d[c], force[to]);
                }
            }
        }
    }
}

#[inline(always)]
fn between_few<V: Vector8 + Analytic, P: Formula>(
    potential: &P,
    pairs: &Pairs,
    q: &[Lanes],
    force: &mut [Lanes],
) {
    let Shape { rows, components } = pairs.shape;
    let numbers = as_numbers(q);
    let own = &load::<V>(&pairs.numbers[0]);
    for j in 0..pairs.bodies {
        let others = Bits(((1_u32 << pairs.bodies) - 1) as u8 & !(1 << j));
        let mut d = [V::zero(); 3];
        for c in 0..components {
            d[c] = V::splat(numbers[c * rows * WIDTH + j]) - V::load(q[c * rows]);
        }
        let w = pull(potential, own, d);
        for c in 0..components {
            let before = V::load(force[c * rows]);
            force[c * rows] = V::select(others, w.multiply_subtract_from(d[c], before), before).store();
        }
    }
}

/// The bodies of a row against the blocks of eight from it on; `force` begins at the row `from`.
#[inline(always)]
fn between_rows<V: Vector8 + Analytic, P: Formula>(
    potential: &P,
    pairs: &Pairs,
    q: &[Lanes],
    force: &mut [Lanes],
    place: (usize, usize),
) {
    let ((row, from), Shape { rows, components }) = (place, pairs.shape);
    let numbers = as_numbers(q);
    let own = &load::<V>(&pairs.numbers[0]);
    let local = rows - from;
    let last = Bits(0xff_u8 >> ((WIDTH - pairs.bodies % WIDTH) % WIDTH));
    for group in 0..WIDTH / GROUP {
        let first = group * GROUP;
        let mut held = [[V::zero(); 3]; GROUP];
        let mut sum = [[V::zero(); 3]; GROUP];
        for i in 0..GROUP {
            for c in 0..components {
                held[i][c] = V::splat(numbers[(c * rows + row) * WIDTH + first + i]);
            }
        }
        for block in row..rows {
            let mut d = [[V::zero(); 3]; GROUP];
            let mut w = [V::zero(); GROUP];
            for i in 0..GROUP {
                for c in 0..components {
                    d[i][c] = V::load(q[c * rows + block]) - held[i][c];
                }
                w[i] = pull(potential, own, d[i]);
            }
            if block == row || block + 1 == rows {
                // Not with itself or one before, nor with lanes that have no body, whatever the potential is there.
                for i in 0..GROUP {
                    let body = row * WIDTH + first + i;
                    let mut with = if block + 1 == rows { last } else { Bits(0xff) };
                    if block == row {
                        with = Bits(with.0 & (0xfe_u32 << (first + i)) as u8);
                    }
                    if body >= pairs.bodies {
                        with = Bits(0);
                    }
                    w[i] = V::select(with, w[i], V::zero());
                    for c in 0..components {
                        d[i][c] = V::select(with, d[i][c], V::zero());
                    }
                }
            }
            for c in 0..components {
                let mut on = V::load(force[c * local + block - from]);
                for i in 0..GROUP {
                    sum[i][c] = w[i].multiply_add(d[i][c], sum[i][c]);
                    on = w[i].multiply_add(d[i][c], on);
                }
                force[c * local + block - from] = on.store();
            }
        }
        for i in 0..GROUP {
            for c in 0..components {
                let at = (c * local + row - from) * WIDTH + first + i;
                as_numbers_mut(force)[at] -= sum[i][c].store().horizontal_sum();
            }
        }
    }
}

tiered! {
    pub(super) fn between_systems_tier[P: Formula][P](potential: &P, pairs: &Pairs, q: &[Lanes], force: &mut [Lanes]) = between_systems;
    pub(super) fn between_few_tier[P: Formula][P](potential: &P, pairs: &Pairs, q: &[Lanes], force: &mut [Lanes]) = between_few;
    pub(super) fn between_rows_tier[P: Formula][P](potential: &P, pairs: &Pairs, q: &[Lanes], force: &mut [Lanes], place: (usize, usize)) = between_rows;
}
