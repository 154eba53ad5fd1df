//! The potential energy and the virial of gravity: the pairs of one state, summed to about thirty digits.
//!
//! Pairs go eight at a time: eight bodies beside one of those that follow, and among themselves turned as on a ring, by
//! one lane to four. A pair whose numbers would leave the range (closer than 2^-450 of the extent, say) is summed by
//! itself, in units of its own.

use crate::error::Result;
use crate::forces::bodies::{Exponents, Of, PreciseBodies, joined, stored};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::fused_double::FusedDouble;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::power_of_two::{exponent, power_of_two, scale};
use crate::numerics::real::{Mask, Real};
use crate::numerics::scaled::Scaled;
use crate::parallel::{Ticker, for_chunks};
use crate::tiered;
use core::ops::Range;

/// Pairs summed between two looks at the clock, about; and the share of one thread at a time.
const PAIRS_PER_BLOCK: usize = 1 << 17;
/// Squares of distances, and products of masses, below 2^-this lose digits.
const RANGE: i32 = 800;

/// Sums over pairs.
#[derive(Clone, Copy, Debug)]
struct Sums {
    /// Σ mᵢmⱼ/√(r² + ε²) and Σ mᵢmⱼ r²/(r² + ε²)^{3/2} of the pairs in range.
    lanes: [FusedDouble<Lanes>; 2],
    /// The same of the others.
    apart: Option<[Scaled; 2]>,
}

/// Potential energy and virial Σ r·F of gravity with that constant and softening.
///
/// The same on any number of threads.
///
/// # Errors
/// [`Error::Interrupted`](crate::Error::Interrupted).
pub fn potential_and_virial(
    bodies: &PreciseBodies,
    constant: f64,
    softening: f64,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<(Scaled, Scaled)> {
    let (massive, units) = (bodies.massive(), bodies.units);
    let softening = scale(softening, -units.length);
    let [mut potential, mut virial] = [Scaled::ZERO; 2];
    let mut add = |sums: Sums| {
        potential = potential.plus(Scaled::new(joined(sums.lanes[0]), 0));
        if softening != 0.0 {
            virial = virial.plus(Scaled::new(joined(sums.lanes[1]), 0));
        }
        if let Some(apart) = sums.apart {
            (potential, virial) = (potential.plus(apart[0]), virial.plus(apart[1]));
        }
    };
    let pairs = massive * massive.saturating_sub(1) / 2;
    if pairs <= PAIRS_PER_BLOCK {
        add(sums_of(bodies, 0..massive, softening));
    } else {
        let blocks = blocks(massive);
        let sums = for_chunks(threads, blocks.len(), ticker, |block, ticker| {
            ticker.tick()?;
            Ok(sums_of(bodies, blocks[block].clone(), softening))
        })?;
        sums.into_iter().for_each(&mut add);
    }
    let near = units == Exponents::default() && (constant == 0.0 || exponent(constant).abs() < RANGE / 2);
    if near && potential.exponent() == 0 && virial.exponent() == 0 {
        let constant = Scaled::from(-constant);
        let product = |sum: Scaled| Scaled::new(sum.value() * constant.value(), 0);
        let potential = product(potential);
        return Ok((potential, if softening == 0.0 { potential } else { product(virial) }));
    }
    // The range of what was summed is that of numbers; its units are not.
    let unit = Scaled::new(DoubleDouble::from(-1.0), 2 * units.mass - units.length).times(constant);
    let potential = potential.by(unit);
    Ok((potential, if softening == 0.0 { potential } else { virial.by(unit) }))
}

/// Bodies of about as many pairs, whole rows of eight.
fn blocks(massive: usize) -> Vec<Range<usize>> {
    let mut blocks = Vec::new();
    let (mut first, mut pairs) = (0, 0);
    for row in (0..massive).step_by(WIDTH) {
        let end = (row + WIDTH).min(massive);
        pairs += WIDTH * (massive - row);
        if pairs >= PAIRS_PER_BLOCK || end == massive {
            blocks.push(first..end);
            (first, pairs) = (end, 0);
        }
    }
    blocks
}

fn sums_of(bodies: &PreciseBodies, rows: Range<usize>, softening: f64) -> Sums {
    if softening == 0.0 {
        row_sums::<false>(bodies, rows, softening)
    } else {
        row_sums::<true>(bodies, rows, softening)
    }
}

tiered! {
    fn row_sums[const SOFT: bool][SOFT](bodies: &PreciseBodies, rows: Range<usize>, softening: f64) -> Sums = rows_of_pairs;
}

/// Lane `i` of a row beside lane `i + k`, for each turn `k`.
const TURNS: [[i64; WIDTH]; WIDTH / 2] =
    [[1, 2, 3, 4, 5, 6, 7, 0], [2, 3, 4, 5, 6, 7, 0, 1], [3, 4, 5, 6, 7, 0, 1, 2], [4, 5, 6, 7, 0, 1, 2, 3]];

/// Masses and places of eight bodies.
#[derive(Clone, Copy)]
struct Eight<V> {
    mass: V,
    place: [FusedDouble<V>; 3],
}

impl<V: Vector8> Eight<V> {
    /// Those from one on.
    #[inline(always)]
    fn row(bodies: &PreciseBodies, first: usize) -> Self {
        let mut place = [FusedDouble::zero(); 3];
        for c in 0..3 {
            place[c] = bodies.coordinates_from(Of::Position, c, first);
        }
        Self { mass: bodies.masses_from(first), place }
    }

    /// One in all lanes.
    #[inline(always)]
    fn one(bodies: &PreciseBodies, body: usize) -> Self {
        let mut place = [FusedDouble::zero(); 3];
        for c in 0..3 {
            place[c] = bodies.coordinate(Of::Position, c, body);
        }
        Self { mass: V::splat(bodies.mass()[body]), place }
    }

    #[inline(always)]
    fn turned(self, turn: &[i64; WIDTH]) -> Self {
        let mut place = self.place;
        for c in 0..3 {
            place[c] = FusedDouble { high: place[c].high.permute(turn), low: place[c].low.permute(turn) };
        }
        Self { mass: self.mass.permute(turn), place }
    }
}

/// Running sums.
struct Running<V> {
    depth: FusedDouble<V>,
    work: FusedDouble<V>,
    /// Whether there are pairs out of range, and their sums, if those are what is wanted.
    odd: Bits,
    apart: [Scaled; 2],
}

impl<V: Vector8 + InverseCube> Running<V> {
    /// Adds the pairs of the lanes that are wanted; the bodies are those from `first` on, beside those that `second` says:
    /// one, and how far after it.
    #[inline(always)]
    fn add<const SOFT: bool, const APART: bool>(
        &mut self,
        bodies: &PreciseBodies,
        (from, to): (&Eight<V>, &Eight<V>),
        (wanted, first, second): (Bits, usize, (usize, &[i64; WIDTH])),
        softening: f64,
    ) {
        let zero = V::zero();
        let product = FusedDouble::product(from.mass, to.mass);
        let mut d = [FusedDouble::<V>::zero(); 3];
        for c in 0..3 {
            d[c] = to.place[c].minus(from.place[c]);
        }
        let r2 = FusedDouble::sum_of_squares(d);
        let soft = FusedDouble::product(V::splat(softening), V::splat(softening));
        let soft2 = if SOFT { r2.plus(soft) } else { r2 };
        // Without their signs, as charges have them.
        let heavy = wanted.and(zero.less(from.mass.abs())).and(zero.less(to.mass.abs()));
        let (least, most) = (V::splat(power_of_two(-RANGE)), V::splat(power_of_two(RANGE)));
        let fine = least.less(soft2.high).and(soft2.high.less(most)).and(least.less(product.high.abs()));
        let inverse = soft2.inverse_root();
        let term = product.times(inverse);
        // Also what is not a number, of two massless bodies in one place or after the last, is taken out.
        let good = heavy.and(fine);
        self.depth.gather(only(good, term));
        if SOFT {
            self.work.gather(only(good, term.times(r2.times(inverse.squared()))));
        }
        let odd = heavy.and(fine.not());
        self.odd = self.odd.or(odd);
        if APART {
            for lane in (0..WIDTH).filter(|&lane| odd.lane(lane)) {
                let pair = (first + lane, second.0 + second.1[lane] as usize);
                pair_apart(bodies, pair, softening, &mut self.apart);
            }
        }
    }
}

#[inline(always)]
fn rows_of_pairs<V: Vector8 + InverseCube, const SOFT: bool>(
    bodies: &PreciseBodies,
    rows: Range<usize>,
    softening: f64,
) -> Sums {
    let sums = all_pairs::<V, SOFT, false>(bodies, rows.clone(), softening);
    let apart = sums.odd.any().then(|| pairs_apart::<SOFT>(bodies, rows, softening));
    Sums { lanes: [stored(sums.depth), stored(sums.work)], apart }
}

/// The pairs out of range, once more: a call on the way would take all that is in registers from the others.
#[cold]
#[inline(never)]
fn pairs_apart<const SOFT: bool>(bodies: &PreciseBodies, rows: Range<usize>, softening: f64) -> [Scaled; 2] {
    all_pairs::<Lanes, SOFT, true>(bodies, rows, softening).apart
}

#[inline(always)]
fn all_pairs<V: Vector8 + InverseCube, const SOFT: bool, const APART: bool>(
    bodies: &PreciseBodies,
    rows: Range<usize>,
    softening: f64,
) -> Running<V> {
    let massive = bodies.massive();
    let zero = FusedDouble::<V>::zero();
    let mut sums = Running { depth: zero, work: zero, odd: Bits(0), apart: [Scaled::ZERO; 2] };
    for first in rows.step_by(WIDTH) {
        let row = Eight::<V>::row(bodies, first);
        let lanes = (massive - first).min(WIDTH);
        for (index, turn) in TURNS.iter().enumerate().take(lanes.saturating_sub(1)) {
            // Half a turn meets each pair twice.
            let wanted = Bits(if index + 1 == TURNS.len() { 0x0f } else { 0xff });
            let pairs = (wanted, first, (first, turn));
            sums.add::<SOFT, APART>(bodies, (&row, &row.turned(turn)), pairs, softening);
        }
        for body in first + WIDTH..massive {
            if bodies.mass()[body] != 0.0 {
                let one = Eight::one(bodies, body);
                let pairs = (Bits(0xff), first, (body, &[0; WIDTH]));
                sums.add::<SOFT, APART>(bodies, (&row, &one), pairs, softening);
            }
        }
    }
    sums
}

#[inline(always)]
fn only<V: Vector8>(mask: Bits, value: FusedDouble<V>) -> FusedDouble<V> {
    let zero = V::zero();
    FusedDouble { high: V::select(mask, value.high, zero), low: V::select(mask, value.low, zero) }
}

/// A pair in units of its own.
#[cold]
#[inline(never)]
fn pair_apart(bodies: &PreciseBodies, (i, j): (usize, usize), softening: f64, sums: &mut [Scaled; 2]) {
    let (from, to) = (bodies.vector(Of::Position, i), bodies.vector(Of::Position, j));
    let d: [DoubleDouble; 3] = core::array::from_fn(|c| to[c] - from[c]);
    let largest = d.iter().fold(0.0_f64, |largest, x| largest.max(x.to_f64().abs()));
    let masses = Scaled::from(bodies.mass()[i]).times(bodies.mass()[j]);
    let near = |x: DoubleDouble, unit: i32| {
        let (high, low) = x.parts();
        DoubleDouble::new(scale(high, -unit), scale(low, -unit))
    };
    // The square of the distance in its own unit, of all that is under the root in the larger one.
    let own = exponent(largest);
    let unit = if largest == 0.0 {
        exponent(softening)
    } else if softening == 0.0 {
        own
    } else {
        own.max(exponent(softening))
    };
    let [x, y, z] = d.map(|x| near(x, own));
    let r2 = x * x + y * y + z * z;
    let soft = near(DoubleDouble::from(softening), unit);
    let shift = power_of_two((2 * (own - unit)).max(-1000));
    let inverse = DoubleDouble::one() / (r2.scale(shift) + soft * soft).sqrt();
    if largest == 0.0 && softening == 0.0 {
        let infinite = Scaled::from(f64::INFINITY);
        *sums = [sums[0].plus(infinite), sums[1].plus(infinite)];
        return;
    }
    let term = masses.by(Scaled::new(inverse, -unit));
    let share = Scaled::new(r2 * inverse * inverse, 2 * (own - unit));
    *sums = [sums[0].plus(term), sums[1].plus(term.by(share))];
}
