//! Many massive bodies: third-law tiles of eight, in shards that threads share out.
//!
//! The one idea: each unordered pair costs one square root and one division, the bound of the kernel.
//! A group of bodies `i` is held together and streamed past blocks of eight bodies `j > i`;
//! the pull on `i` gathers in eight partial sums (one per lane), the pull on `j` goes back to memory.
//!
//! Canonical order: the triangle of tiles is cut into shards by the number of bodies alone. In a shard,
//! body `j` receives its terms in ascending `i`; body `i` then the horizontal sum of its lanes. The
//! shards' results are added in ascending order. Threads and SIMD tiers do not enter.

use super::passive::packed_attraction;
use crate::error::Result;
use crate::forces::Force;
use crate::numerics::element::Shape;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::real::Real;
use crate::parallel::{Ticker, for_chunks};
use crate::tiered;
use std::sync::Mutex;

/// Bodies per shard, and the most shards: enough for balance on many threads, few enough that adding
/// them up stays below one percent.
const BODIES_PER_SHARD: usize = 128;
const SHARDS_MAX: usize = 32;
/// Massless rows per unit of work.
const PASSIVE_ROWS: usize = 64;
/// Rows from which an evaluation ticks: below, its 10^6 pairs take a few milliseconds on any machine, and a
/// step need not be able to go back.
const LONG_ROWS: usize = 128;

/// A run of block rows and the accelerations it contributes.
#[derive(Debug)]
struct Shard {
    start: usize,
    end: usize,
    /// Component after component, `active_rows - start` blocks each: only `j ≥ start` can be reached.
    acceleration: Vec<Lanes>,
}

/// Gravity among many massive bodies (rows below `active_rows`) and on the massless ones after them.
#[derive(Debug)]
pub struct Tiles {
    shape: Shape,
    active_rows: usize,
    strength: Vec<Lanes>,
    bodies: usize,
    softening2: f64,
    shards: Vec<Mutex<Shard>>,
    threads: usize,
}

impl Tiles {
    /// From `G·m` of the massive bodies in blocks of eight (zero in the lanes without a body).
    pub fn new(shape: Shape, strength: Vec<Lanes>, bodies: usize, softening: f64, threads: usize) -> Self {
        let active_rows = strength.len();
        let count = (bodies / BODIES_PER_SHARD).clamp(1, SHARDS_MAX);
        let total = active_rows * (active_rows + 1) / 2;
        let mut shards = Vec::with_capacity(count);
        let (mut start, mut tiles) = (0, 0);
        for shard in 1..=count {
            let mut end = start;
            while end < active_rows && (tiles < total * shard / count || shard == count) {
                tiles += active_rows - end;
                end += 1;
            }
            let len = shape.components * (active_rows - start);
            shards.push(Mutex::new(Shard { start, end, acceleration: vec![Lanes::zero(); len] }));
            start = end;
        }
        Self { shape, active_rows, strength, bodies, softening2: softening * softening, shards, threads }
    }
}

/// Bodies `part·GROUP …` of row `row` against the blocks from `row` on. The size of the group changes no bit.
#[inline(always)]
fn group<V: Vector8, const GROUP: usize, const PLANAR: bool, const SOFT: bool>(
    tiles: &Tiles,
    q: &[Lanes],
    shard_start: usize,
    acceleration: &mut [Lanes],
    row: usize,
    part: usize,
) {
    let rows = tiles.shape.rows;
    let blocks = tiles.active_rows;
    let local = blocks - shard_start;
    let (x, y) = (&V::view(q)[..blocks], &V::view(q)[rows..rows + blocks]);
    let z = if PLANAR { x } else { &V::view(q)[2 * rows..2 * rows + blocks] };
    let strength = &V::view(&tiles.strength)[..blocks];
    let softening2 = V::splat(tiles.softening2);
    let numbers = as_numbers(q);
    let strengths = as_numbers(&tiles.strength);
    let first = row * WIDTH + part * GROUP;
    let body: [usize; GROUP] = core::array::from_fn(|i| first + i);
    let bx = body.map(|i| numbers[i]);
    let by = body.map(|i| numbers[rows * WIDTH + i]);
    let bz = body.map(|i| if PLANAR { 0.0 } else { numbers[2 * rows * WIDTH + i] });
    let bm = body.map(|i| strengths[i]);
    let mut sum = [[V::zero(); 3]; GROUP];

    let (a_x, rest) = V::view_mut(acceleration).split_at_mut(local);
    let (a_y, a_z) = rest.split_at_mut(local);
    let a_z = if PLANAR { &mut [][..] } else { &mut a_z[..local] };

    for block in row..blocks {
        let diagonal = block == row;
        let target = block - shard_start;
        let (xj, yj, zj, mj) = (x[block], y[block], z[block], strength[block]);
        let (mut ajx, mut ajy) = (a_x[target], a_y[target]);
        let mut ajz = if PLANAR { V::zero() } else { a_z[target] };
        for i in 0..GROUP {
            let dx = xj - V::splat(bx[i]);
            let dy = yj - V::splat(by[i]);
            let mut r2 = dx * dx;
            if SOFT {
                r2 += softening2;
            }
            r2 += dy * dy;
            let dz = if PLANAR { V::zero() } else { zj - V::splat(bz[i]) };
            if !PLANAR {
                r2 += dz * dz;
            }
            let mut w = V::one() / (r2 * r2.sqrt());
            if diagonal {
                // Lanes up to and including the body itself have had, or have no, pair with it.
                let later = Bits((0xfe_u32 << (part * GROUP + i)) as u8);
                w = V::select(later, w, V::zero());
            }
            let wi = mj * w;
            let wj = V::splat(bm[i]) * w;
            sum[i][0] += wi * dx;
            sum[i][1] += wi * dy;
            ajx -= wj * dx;
            ajy -= wj * dy;
            if !PLANAR {
                sum[i][2] += wi * dz;
                ajz -= wj * dz;
            }
        }
        a_x[target] = ajx;
        a_y[target] = ajy;
        if !PLANAR {
            a_z[target] = ajz;
        }
    }
    let numbers = as_numbers_mut(acceleration);
    for i in 0..GROUP {
        let at = (row - shard_start) * WIDTH + part * GROUP + i;
        for c in 0..tiles.shape.components {
            numbers[c * local * WIDTH + at] += sum[i][c].horizontal_sum();
        }
    }
}

/// One block row of a shard, `GROUP` bodies at a time.
#[inline(always)]
fn groups<V: Vector8, const GROUP: usize>(
    tiles: &Tiles,
    q: &[Lanes],
    start: usize,
    acceleration: &mut [Lanes],
    row: usize,
) {
    for part in 0..WIDTH / GROUP {
        match (tiles.shape.components == 2, tiles.softening2 > 0.0) {
            (false, false) => group::<V, GROUP, false, false>(tiles, q, start, acceleration, row, part),
            (false, true) => group::<V, GROUP, false, true>(tiles, q, start, acceleration, row, part),
            (true, false) => group::<V, GROUP, true, false>(tiles, q, start, acceleration, row, part),
            (true, true) => group::<V, GROUP, true, true>(tiles, q, start, acceleration, row, part),
        }
    }
}

/// One block row of a shard: four bodies at a time fit the registers of AVX-512; where they fit nowhere,
/// eight at a time save the most traffic with memory (measured: 0.49 ns against 0.51, 0.69 against 0.73).
#[inline(always)]
fn block_row<V: Vector8>(
    tiles: &Tiles,
    q: &[Lanes],
    shard_start: usize,
    acceleration: &mut [Lanes],
    row: usize,
) {
    if V::ONE_REGISTER {
        groups::<V, 4>(tiles, q, shard_start, acceleration, row);
    } else {
        groups::<V, 8>(tiles, q, shard_start, acceleration, row);
    }
}

/// The massless rows `start..end`, into their accelerations.
#[inline(always)]
fn passive_rows<V: Vector8>(tiles: &Tiles, q: &[Lanes], start: usize, end: usize, out: &mut [Lanes]) {
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
            out[c * (end - start) + row - start] = term[c].store();
        }
    }
}

/// Adds `from` to `into`.
#[inline(always)]
fn add<V: Vector8>(into: &mut [Lanes], from: &[Lanes]) {
    for (into, from) in V::view_mut(into).iter_mut().zip(V::view(from)) {
        *into += *from;
    }
}

tiered! {
    fn block_row_tier[][](tiles: &Tiles, q: &[Lanes], shard_start: usize, acceleration: &mut [Lanes], row: usize) = block_row;
    fn passive_rows_tier[][](tiles: &Tiles, q: &[Lanes], start: usize, end: usize, out: &mut [Lanes]) = passive_rows;
    fn add_tier[][](into: &mut [Lanes], from: &[Lanes]) = add;
}

impl Force<Lanes> for Tiles {
    fn apply(
        &mut self,
        q: &[Lanes],
        _: &[Lanes],
        a: &mut [Lanes],
        first: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let this = &*self;
        let Shape { rows, components } = this.shape;
        let passive = this.active_rows..rows;
        let passive_chunks = passive.len().div_ceil(PASSIVE_ROWS);
        let passive_run = |chunk: usize| {
            let start = passive.start + chunk * PASSIVE_ROWS;
            start..(start + PASSIVE_ROWS).min(rows)
        };
        let chunks = this.shards.len() + passive_chunks;
        let stops = this.stops_midway();
        let tick = |ticker: &mut Ticker<'_>| if stops { ticker.tick() } else { Ok(()) };
        let passive_terms = for_chunks(this.threads, chunks, ticker, |chunk, ticker| {
            let Some(shard) = this.shards.get(chunk) else {
                let run = passive_run(chunk - this.shards.len());
                let mut out = vec![Lanes::zero(); components * run.len()];
                passive_rows_tier(this, q, run.start, run.end, &mut out);
                tick(ticker)?;
                return Ok(Some(out));
            };
            // Each shard is locked once per evaluation, by the one thread that works on it.
            let mut shard = shard.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            let Shard { start, end, ref mut acceleration } = *shard;
            acceleration.fill(Lanes::zero());
            for row in start..end {
                block_row_tier(this, q, start, acceleration, row);
                tick(ticker)?;
            }
            Ok(None)
        })?;
        if first {
            a.fill(Lanes::zero());
        }
        for shard in &mut self.shards {
            let shard = shard.get_mut().unwrap_or_else(std::sync::PoisonError::into_inner);
            let local = self.active_rows - shard.start;
            for c in 0..components {
                let into = &mut a[c * rows + shard.start..c * rows + self.active_rows];
                add_tier(into, &shard.acceleration[c * local..(c + 1) * local]);
            }
        }
        for (chunk, out) in passive_terms[self.shards.len()..].iter().enumerate() {
            let run = passive_run(chunk);
            for c in 0..components {
                let out = out.as_deref().unwrap_or_default();
                add_tier(
                    &mut a[c * rows + run.start..c * rows + run.end],
                    &out[c * run.len()..(c + 1) * run.len()],
                );
            }
        }
        Ok(())
    }

    fn stops_midway(&self) -> bool {
        self.shape.rows >= LONG_ROWS
    }
}
