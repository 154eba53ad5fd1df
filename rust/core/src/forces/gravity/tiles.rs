//! Many massive bodies: third-law tiles of eight, in shards that threads share out.
//!
//! The one idea: each unordered pair is weighed once.
//! The eight bodies `i` of a row are held together and the blocks of eight bodies `j > i` streamed past them;
//! the pull on `i` gathers in eight partial sums (one per lane), the pull on `j` goes back to memory.
//!
//! Canonical order: the triangle of tiles is cut into shards by the number of bodies alone. In a shard,
//! body `j` receives its terms in ascending `i`; body `i` then the horizontal sum of its lanes. The
//! shards' results are added in ascending order. Threads and SIMD tiers do not enter. Up to sixteen massive bodies that have
//! massless ones beside them are summed as they are [without](super::two_rows).

use super::pair::squared_distance;
use super::passive::packed_attraction;
use super::two_rows::TwoRows;
use crate::error::Result;
use crate::forces::{Force, Phase};
use crate::numerics::binary::Binary;
use crate::numerics::element::Shape;
use crate::numerics::inverse_cube::{InverseCube, inverse_cubes_from, inverse_roots};
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::real::Real;
use crate::parallel::{Ticker, for_chunks};
use crate::tiered;
use std::sync::{Mutex, PoisonError, RwLock};

/// Bodies per shard, and the most shards: enough for balance on many threads, few enough that adding
/// them up stays below one percent.
const BODIES_PER_SHARD: usize = 128;
const SHARDS_MAX: usize = 32;
/// Massless rows per unit of work.
const PASSIVE_ROWS: usize = 64;
/// Rows from which an evaluation ticks: below, its 10^6 pairs take a few milliseconds on any machine, and a
/// step need not be able to go back.
const LONG_ROWS: usize = 128;

/// Pieces in which threads add up what the shards leave.
const PIECES: usize = 8;

/// Rows that one thread works on, and the accelerations that come of them.
#[derive(Debug)]
struct Shard {
    start: usize,
    end: usize,
    /// Where the rows end that they act on: behind the massive bodies if the rows are theirs, else where they end.
    reach: usize,
    /// With the sign changed, which saves an operation for each pair; component after component, the rows from
    /// `start` to `reach`.
    pull: RwLock<Vec<Lanes>>,
}

impl Shard {
    fn new(shape: Shape, start: usize, end: usize, reach: usize) -> Self {
        Self { start, end, reach, pull: RwLock::new(vec![Lanes::zero(); shape.components * (reach - start)]) }
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
    shards: Vec<Shard>,
    threads: usize,
    /// The massive bodies, if they are so few that they are summed otherwise.
    two_rows: Option<TwoRows>,
}

impl Tiles {
    /// From `G·m` of the massive bodies.
    pub fn new(shape: Shape, numbers: &[f64], softening: f64, threads: usize) -> Self {
        let (bodies, active_rows) = (numbers.len(), numbers.len().div_ceil(WIDTH));
        // Zero in the lanes without a body.
        let mut strength = vec![Lanes::zero(); active_rows];
        as_numbers_mut(&mut strength)[..bodies].copy_from_slice(numbers);
        let two_rows = TwoRows::new(numbers, softening, shape.components);
        let count = (bodies / BODIES_PER_SHARD).clamp(1, SHARDS_MAX);
        let bound = |shard: usize| active_rows * shard / count;
        // Of equal rows, not of equal work, which falls from the first to the last: so threads end at about one time.
        let mut shards: Vec<Shard> =
            (0..count).map(|shard| Shard::new(shape, bound(shard), bound(shard + 1), active_rows)).collect();
        for start in (active_rows..shape.rows).step_by(PASSIVE_ROWS) {
            let end = (start + PASSIVE_ROWS).min(shape.rows);
            shards.push(Shard::new(shape, start, end, end));
        }
        Self {
            shape,
            active_rows,
            strength,
            bodies,
            softening2: softening * softening,
            shards,
            threads,
            two_rows,
        }
    }
}

/// A body of the row that is held, and the partial sums of the pull on it.
#[derive(Clone, Copy)]
struct Held<V> {
    place: [f64; 3],
    strength: f64,
    sum: [V; 3],
}

/// Eight bodies that are streamed past, and what they are accelerated by, with the sign changed.
struct Streamed<V> {
    place: [V; 3],
    strength: V,
    pull: [V; 3],
}

/// Bodies that meet a block together: as many as keep both multipliers busy while each waits for its own results.
/// Changes no bit.
const GROUP: usize = 4;

/// The pairs of a group with a block. If the block is their own, `first` is the place of the group in it, and a
/// body has pairs with later ones only.
#[inline(always)]
fn tile<V: Vector8 + Binary, const PLANAR: bool, const SOFT: bool>(
    held: &mut [Held<V>; GROUP],
    streamed: &mut Streamed<V>,
    softening2: V,
    own: bool,
    first: usize,
) {
    let components = if PLANAR { 2 } else { 3 };
    let mut d = [[V::zero(); 3]; GROUP];
    let mut r2 = [V::zero(); GROUP];
    for i in 0..GROUP {
        for c in 0..components {
            d[i][c] = streamed.place[c] - V::splat(held[i].place[c]);
        }
        r2[i] = squared_distance::<V, PLANAR, SOFT>(d[i], softening2);
    }
    let mut root = inverse_roots(r2);
    // A branch here, rather than two compiled forms, keeps the compiler from mixing what comes before with what comes
    // after, one body at a time; the shorter chains of half the work overlap: 15 % on AVX2, whose registers are few.
    if own {
        for i in 0..GROUP {
            let later = Bits((0xfe_u32 << (first + i)) as u8);
            r2[i] = V::select(later, r2[i], V::zero());
            root[i] = V::select(later, root[i], V::zero());
        }
    }
    let w = inverse_cubes_from(r2, root);
    for i in 0..GROUP {
        let on_held = streamed.strength * w[i];
        let on_streamed = V::splat(held[i].strength) * w[i];
        for c in 0..components {
            held[i].sum[c] = on_held.multiply_add(d[i][c], held[i].sum[c]);
            streamed.pull[c] = on_streamed.multiply_add(d[i][c], streamed.pull[c]);
        }
    }
}

/// Row `row` of a shard against the blocks from `row` on.
#[inline(always)]
fn meet_blocks<V: Vector8 + Binary, const PLANAR: bool, const SOFT: bool>(
    tiles: &Tiles,
    q: &[Lanes],
    shard_start: usize,
    pull: &mut [Lanes],
    row: usize,
) {
    let components = if PLANAR { 2 } else { 3 };
    let rows = tiles.shape.rows;
    let blocks = tiles.active_rows;
    let local = blocks - shard_start;
    let numbers = as_numbers(q);
    let strengths = as_numbers(&tiles.strength);
    // In whole groups: lanes without a body have no strength.
    let bodies = (tiles.bodies - row * WIDTH).min(WIDTH).next_multiple_of(GROUP);
    let mut held = [Held { place: [0.0; 3], strength: 0.0, sum: [V::zero(); 3] }; WIDTH];
    let held = &mut held[..bodies];
    for i in 0..bodies {
        let body = row * WIDTH + i;
        for c in 0..components {
            held[i].place[c] = numbers[c * rows * WIDTH + body];
        }
        held[i].strength = strengths[body];
    }

    let (q_x, q_y) = (V::view(&q[..blocks]), V::view(&q[rows..rows + blocks]));
    let q_z = if PLANAR { q_x } else { V::view(&q[2 * rows..2 * rows + blocks]) };
    let strength = V::view(&tiles.strength[..blocks]);
    let softening2 = V::splat(tiles.softening2);
    let (p_x, rest) = pull.split_at_mut(local);
    let (p_y, p_z) = rest.split_at_mut(local);
    let (p_x, p_y) = (V::view_mut(p_x), V::view_mut(p_y));
    let p_z = if PLANAR { &mut [][..] } else { V::view_mut(&mut p_z[..local]) };
    for block in row..blocks {
        let to = block - shard_start;
        let mut streamed = Streamed {
            place: [q_x[block], q_y[block], q_z[block]],
            strength: strength[block],
            pull: [p_x[to], p_y[to], if PLANAR { V::zero() } else { p_z[to] }],
        };
        for (group, held) in held.as_chunks_mut().0.iter_mut().enumerate() {
            tile::<V, PLANAR, SOFT>(held, &mut streamed, softening2, block == row, group * GROUP);
        }
        [p_x[to], p_y[to]] = [streamed.pull[0], streamed.pull[1]];
        if !PLANAR {
            p_z[to] = streamed.pull[2];
        }
    }
    for i in 0..bodies {
        let at = (row - shard_start) * WIDTH + i;
        for c in 0..components {
            as_numbers_mut(pull)[c * local * WIDTH + at] -= held[i].sum[c].store().horizontal_sum();
        }
    }
}

/// One block row of a shard, in the plane or in space, softened or not.
#[inline(always)]
fn block_row<V: Vector8 + Binary>(
    tiles: &Tiles,
    q: &[Lanes],
    shard_start: usize,
    pull: &mut [Lanes],
    row: usize,
) {
    match (tiles.shape.components == 2, tiles.softening2 > 0.0) {
        (false, false) => meet_blocks::<V, false, false>(tiles, q, shard_start, pull, row),
        (false, true) => meet_blocks::<V, false, true>(tiles, q, shard_start, pull, row),
        (true, false) => meet_blocks::<V, true, false>(tiles, q, shard_start, pull, row),
        (true, true) => meet_blocks::<V, true, true>(tiles, q, shard_start, pull, row),
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

impl Tiles {
    /// Adds up what the shards leave in a piece of the accelerations that begins at its element `from`.
    fn add_up(&self, from: usize, piece: &mut [Lanes], first: bool) {
        if first {
            piece.fill(Lanes::zero());
        }
        let (rows, to) = (self.shape.rows, from + piece.len());
        for shard in &self.shards {
            let pull = shard.pull.read().unwrap_or_else(PoisonError::into_inner);
            let reached = shard.reach - shard.start;
            for component in 0..self.shape.components {
                let start = component * rows + shard.start;
                let (low, high) = (from.max(start), to.min(start + reached));
                if low < high {
                    let pull = &pull[component * reached..][low - start..high - start];
                    subtract_tier(&mut piece[low - from..high - from], pull);
                }
            }
        }
    }
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
        let stops = this.stops_midway();
        let tick = |ticker: &mut Ticker<'_>| if stops { ticker.tick() } else { Ok(()) };
        let _: Vec<()> = for_chunks(this.threads, this.shards.len(), ticker, |index, ticker| {
            let Shard { start, end, ref pull, .. } = this.shards[index];
            // Locked once per evaluation, by the one thread that works on it.
            let mut pull = pull.write().unwrap_or_else(PoisonError::into_inner);
            if start >= this.active_rows {
                passive_rows_tier(this, q, start, end, &mut pull);
                return tick(ticker);
            }
            if let Some(rows) = &this.two_rows {
                for (row, sum) in rows.sums(q, this.shape.rows).into_iter().enumerate() {
                    for c in 0..this.shape.components {
                        pull[2 * c + row] = -sum[c];
                    }
                }
                return tick(ticker);
            }
            pull.fill(Lanes::zero());
            for row in start..end {
                block_row_tier(this, q, start, &mut pull, row);
                tick(ticker)?;
            }
            Ok(())
        })?;
        let threads = this.threads.min(this.shards.len());
        if threads == 1 {
            this.add_up(0, a, first);
            return Ok(());
        }
        let size = a.len().div_ceil(PIECES);
        let mut rest = a.chunks_mut(size);
        let pieces: [Mutex<&mut [Lanes]>; PIECES] =
            core::array::from_fn(|_| Mutex::new(rest.next().unwrap_or_default()));
        let _: Vec<()> = for_chunks(threads, PIECES, ticker, |index, _| {
            let mut piece = pieces[index].lock().unwrap_or_else(PoisonError::into_inner);
            this.add_up(index * size, &mut piece, first);
            Ok(())
        })?;
        Ok(())
    }

    fn stops_midway(&self) -> bool {
        self.shape.rows >= LONG_ROWS
    }
}
