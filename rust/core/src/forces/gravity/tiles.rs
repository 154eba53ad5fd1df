//! Many massive bodies: third-law tiles of eight, in shards that threads share out.
//!
//! The one idea: each unordered pair is weighed once.
//! A group of bodies `i` is held together and streamed past blocks of eight bodies `j > i`;
//! the pull on `i` gathers in eight partial sums (one per lane), the pull on `j` goes back to memory.
//!
//! Canonical order: the triangle of tiles is cut into shards by the number of bodies alone. In a shard,
//! body `j` receives its terms in ascending `i`; body `i` then the horizontal sum of its lanes. The
//! shards' results are added in ascending order. Threads and SIMD tiers do not enter.

use super::pair::squared_distance;
use super::passive::packed_attraction;
use crate::error::Result;
use crate::forces::{Force, Phase};
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, Register, Vector8, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::real::Real;
use crate::parallel::{Ticker, for_chunks};
use crate::tiered;
use std::sync::{Mutex, PoisonError};

/// Bodies per shard, and the most shards: enough for balance on many threads, few enough that adding
/// them up stays below one percent.
const BODIES_PER_SHARD: usize = 128;
const SHARDS_MAX: usize = 32;
/// Massless rows per unit of work.
const PASSIVE_ROWS: usize = 64;
/// Rows from which an evaluation ticks: below, its 10^6 pairs take a few milliseconds on any machine, and a
/// step need not be able to go back.
const LONG_ROWS: usize = 128;

/// Rows that one thread works on, and the accelerations that come of them, with the sign changed (which saves an
/// operation for each pair).
#[derive(Debug)]
struct Shard {
    start: usize,
    end: usize,
    /// Component after component, from row `start` to the last that can be reached: the last of the massive bodies
    /// if the rows are theirs, else the last of these rows.
    pull: Vec<Lanes>,
}

impl Shard {
    /// The rows `start..end`, which act on those up to `reach`.
    fn new(shape: Shape, start: usize, end: usize, reach: usize) -> Mutex<Self> {
        Mutex::new(Self { start, end, pull: vec![Lanes::zero(); shape.components * (reach - start)] })
    }
}

/// Gravity among many massive bodies (rows below `active_rows`) and on the massless ones after them.
#[derive(Debug)]
pub struct Tiles {
    shape: Shape,
    active_rows: usize,
    strength: Vec<Lanes>,
    bodies: usize,
    softening2: f64,
    /// Those of the massive bodies, then those of the massless ones.
    shards: Vec<Mutex<Shard>>,
    threads: usize,
}

impl Tiles {
    /// From `G·m` of the massive bodies in blocks of eight (zero in the lanes without a body).
    pub fn new(shape: Shape, strength: Vec<Lanes>, bodies: usize, softening: f64, threads: usize) -> Self {
        let active_rows = strength.len();
        let count = (bodies / BODIES_PER_SHARD).clamp(1, SHARDS_MAX);
        let total = active_rows * (active_rows + 1) / 2;
        let mut shards = Vec::new();
        let (mut start, mut tiles) = (0, 0);
        for shard in 1..=count {
            let mut end = start;
            while end < active_rows && (tiles < total * shard / count || shard == count) {
                tiles += active_rows - end;
                end += 1;
            }
            shards.push(Shard::new(shape, start, end, active_rows));
            start = end;
        }
        for start in (active_rows..shape.rows).step_by(PASSIVE_ROWS) {
            let end = (start + PASSIVE_ROWS).min(shape.rows);
            shards.push(Shard::new(shape, start, end, end));
        }
        Self { shape, active_rows, strength, bodies, softening2: softening * softening, shards, threads }
    }
}

/// Bodies of one block row, held together, and the partial sums of the pull on each.
struct Group<R, const GROUP: usize> {
    place: [[f64; 3]; GROUP],
    strength: [f64; GROUP],
    /// For each body and each register of a block.
    sum: [[[R; 3]; MOST_REGISTERS]; GROUP],
}

/// The most registers that eight lanes fill on any tier.
const MOST_REGISTERS: usize = 2;

/// A register of a block of eight bodies, and what these are accelerated by, with the sign changed.
struct Streamed<R> {
    place: [R; 3],
    strength: R,
    pull: [R; 3],
}

/// The pairs of a group with register `part` of a block. On the diagonal, lane `l` of the block has a pair with
/// body `i` if `l > first + i`.
#[inline(always)]
fn tile<
    R: Register + InverseCube,
    const GROUP: usize,
    const PLANAR: bool,
    const SOFT: bool,
    const DIAGONAL: bool,
>(
    group: &mut Group<R, GROUP>,
    streamed: &mut Streamed<R>,
    part: usize,
    softening2: R,
    first: usize,
) {
    let components = if PLANAR { 2 } else { 3 };
    let mut d = [[R::zero(); 3]; GROUP];
    let mut r2 = [R::zero(); GROUP];
    for i in 0..GROUP {
        for c in 0..components {
            d[i][c] = streamed.place[c] - R::splat(group.place[i][c]);
        }
        r2[i] = squared_distance::<R, PLANAR, SOFT>(d[i], softening2);
    }
    let mut w = R::inverse_cubes(r2);
    for i in 0..GROUP {
        if DIAGONAL {
            let later = (0xfe_u32 << (first + i)) as u8 >> (part * WIDTH / R::COUNT);
            w[i] = R::select(Bits(later), w[i], R::zero());
        }
        let on_group = streamed.strength * w[i];
        let on_streamed = R::splat(group.strength[i]) * w[i];
        let sum = &mut group.sum[i][part];
        for c in 0..components {
            sum[c] = on_group.multiply_add(d[i][c], sum[c]);
            streamed.pull[c] = on_streamed.multiply_add(d[i][c], streamed.pull[c]);
        }
    }
}

/// Bodies `first…` of row `row`, a group of them, against the blocks from `row` on. The size of the group
/// changes no bit.
#[inline(always)]
fn group<R: Register + InverseCube, const GROUP: usize, const PLANAR: bool, const SOFT: bool>(
    tiles: &Tiles,
    q: &[Lanes],
    shard_start: usize,
    pull: &mut [Lanes],
    row: usize,
    first: usize,
) {
    let rows = tiles.shape.rows;
    let blocks = tiles.active_rows;
    let local = blocks - shard_start;
    let (q_x, q_y) = (R::view(&q[..blocks]), R::view(&q[rows..rows + blocks]));
    let q_z = if PLANAR { q_x } else { R::view(&q[2 * rows..2 * rows + blocks]) };
    let strength = R::view(&tiles.strength[..blocks]);
    let softening2 = R::splat(tiles.softening2);
    let numbers = as_numbers(q);
    let strengths = as_numbers(&tiles.strength);
    let body = row * WIDTH + first;
    let coordinate = |c: usize, i: usize| {
        if PLANAR && c == 2 { 0.0 } else { numbers[c * rows * WIDTH + body + i] }
    };
    let mut held = Group {
        place: core::array::from_fn(|i| core::array::from_fn(|c| coordinate(c, i))),
        strength: core::array::from_fn(|i| strengths[body + i]),
        sum: [[[R::zero(); 3]; MOST_REGISTERS]; GROUP],
    };

    let (p_x, rest) = pull.split_at_mut(local);
    let (p_y, p_z) = rest.split_at_mut(local);
    let (p_x, p_y) = (R::view_mut(p_x), R::view_mut(p_y));
    let p_z = if PLANAR { &mut [][..] } else { R::view_mut(&mut p_z[..local]) };

    // A macro and not a closure: a closure would be compiled without the tier's instructions.
    macro_rules! meet {
        ($block:expr, $diagonal:literal) => {
            for part in 0..R::COUNT {
                let from = $block * R::COUNT + part;
                let to = from - shard_start * R::COUNT;
                let mut streamed = Streamed {
                    place: [q_x[from], q_y[from], q_z[from]],
                    strength: strength[from],
                    pull: [p_x[to], p_y[to], if PLANAR { R::zero() } else { p_z[to] }],
                };
                tile::<R, GROUP, PLANAR, SOFT, $diagonal>(&mut held, &mut streamed, part, softening2, first);
                [p_x[to], p_y[to]] = [streamed.pull[0], streamed.pull[1]];
                if !PLANAR {
                    p_z[to] = streamed.pull[2];
                }
            }
        };
    }
    meet!(row, true);
    for block in row + 1..blocks {
        meet!(block, false);
    }
    for i in 0..GROUP {
        let at = (row - shard_start) * WIDTH + first + i;
        for c in 0..tiles.shape.components {
            let mut sum = [Lanes::zero()];
            for part in 0..R::COUNT {
                R::view_mut(&mut sum)[part] = held.sum[i][part][c];
            }
            as_numbers_mut(pull)[c * local * WIDTH + at] -= sum[0].horizontal_sum();
        }
    }
}

/// One block row of a shard: four bodies at a time, as many as the registers of AVX-512 hold.
#[inline(always)]
fn block_row<V: Vector8>(tiles: &Tiles, q: &[Lanes], shard_start: usize, pull: &mut [Lanes], row: usize)
where
    V::Register: InverseCube,
{
    const GROUP: usize = 4;
    for first in (0..WIDTH).step_by(GROUP) {
        let planar = tiles.shape.components == 2;
        match (planar, tiles.softening2 > 0.0) {
            (false, false) => {
                group::<V::Register, GROUP, false, false>(tiles, q, shard_start, pull, row, first);
            }
            (false, true) => {
                group::<V::Register, GROUP, false, true>(tiles, q, shard_start, pull, row, first);
            }
            (true, false) => {
                group::<V::Register, GROUP, true, false>(tiles, q, shard_start, pull, row, first);
            }
            (true, true) => {
                group::<V::Register, GROUP, true, true>(tiles, q, shard_start, pull, row, first);
            }
        }
    }
}

/// The massless rows `start..end`.
#[inline(always)]
fn passive_rows<V: Vector8 + InverseCube>(
    tiles: &Tiles,
    q: &[Lanes],
    start: usize,
    end: usize,
    pull: &mut [Lanes],
) {
    let rows = tiles.shape.rows;
    let planar = tiles.shape.components == 2;
    let numbers = as_numbers(q);
    let strengths = as_numbers(&tiles.strength);
    let strengths = &strengths[..tiles.bodies];
    let softening2 = V::splat(tiles.softening2);
    let stride = rows * WIDTH;
    for row in start..end {
        let mut position = [V::zero(); 3];
        for c in 0..tiles.shape.components {
            position[c] = V::load(q[c * rows + row]);
        }
        let term = match (planar, tiles.softening2 > 0.0) {
            (false, false) => {
                packed_attraction::<V, false, false>(position, numbers, stride, strengths, softening2)
            }
            (false, true) => {
                packed_attraction::<V, false, true>(position, numbers, stride, strengths, softening2)
            }
            (true, false) => {
                packed_attraction::<V, true, false>(position, numbers, stride, strengths, softening2)
            }
            (true, true) => {
                packed_attraction::<V, true, true>(position, numbers, stride, strengths, softening2)
            }
        };
        for c in 0..tiles.shape.components {
            pull[c * (end - start) + row - start] = (-term[c]).store();
        }
    }
}

/// Takes `from` away from `into`.
#[inline(always)]
fn subtract<V: Vector8>(into: &mut [Lanes], from: &[Lanes]) {
    for (into, from) in V::view_mut(into).iter_mut().zip(V::view(from)) {
        *into -= *from;
    }
}

tiered! {
    fn block_row_tier[][](tiles: &Tiles, q: &[Lanes], shard_start: usize, pull: &mut [Lanes], row: usize) = block_row;
    fn passive_rows_tier[][](tiles: &Tiles, q: &[Lanes], start: usize, end: usize, pull: &mut [Lanes]) = passive_rows;
    fn subtract_tier[][](into: &mut [Lanes], from: &[Lanes]) = subtract;
}

impl Force<Lanes> for Tiles {
    fn apply(
        &mut self,
        phase: &Phase<'_, Lanes>,
        a: &mut [Lanes],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let (this, q) = (&*self, phase.q);
        let Shape { rows, components } = this.shape;
        let stops = this.stops_midway();
        let tick = |ticker: &mut Ticker<'_>| if stops { ticker.tick() } else { Ok(()) };
        let _: Vec<()> = for_chunks(this.threads, this.shards.len(), ticker, |index, ticker| {
            // Each shard is locked once per evaluation, by the one thread that works on it.
            let mut shard = this.shards[index].lock().unwrap_or_else(PoisonError::into_inner);
            let Shard { start, end, ref mut pull } = *shard;
            if start >= this.active_rows {
                passive_rows_tier(this, q, start, end, pull);
                return tick(ticker);
            }
            pull.fill(Lanes::zero());
            for row in start..end {
                block_row_tier(this, q, start, pull, row);
                tick(ticker)?;
            }
            Ok(())
        })?;
        if first {
            a.fill(Lanes::zero());
        }
        for shard in &mut self.shards {
            let Shard { start, pull, .. } = shard.get_mut().unwrap_or_else(PoisonError::into_inner);
            let reached = pull.len() / components;
            for c in 0..components {
                let into = &mut a[c * rows + *start..][..reached];
                subtract_tier(into, &pull[c * reached..][..reached]);
            }
        }
        Ok(())
    }

    fn stops_midway(&self) -> bool {
        self.shape.rows >= LONG_ROWS
    }
}
