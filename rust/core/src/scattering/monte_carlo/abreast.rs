//! Events of several draws eight side by side: their slots, but for those of the few that come too near an edge.
//!
//! The one idea: a slot hangs on a number that is almost never near an edge of a bin, so eleven digits of it will do, and
//! those are found in lanes. Whatever is nearer is left to the one way in which each event is found alone, so that counts
//! are its counts, to the last, on any machine.

use super::Quantity;
use super::beam::{Beam, UNIT};
use super::draws::{AZIMUTH, ENERGY, ENERGY_PHASE, PLACE, TILT};
use super::mixture::{Mixture, Tally};
use super::profile::{Spread, WITHIN};
use crate::numerics::functions::{self, Functions};
use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH};
use crate::numerics::philox::{DRAWS, Draw, Key, fill_draws};
use crate::numerics::real::Mask;
use crate::numerics::rows::{Lookup, Rows};
use crate::numerics::simd::{Tier, tier};
use crate::scattering::event_table::{BINS, EnergiesAbreast, TableAbreast};
use crate::scattering::histogram::Edges;
use crate::scattering::kinematics::{Circle, Collision};
use crate::tiered;
use core::f64::consts::{PI, TAU};
use core::ops::Range;

/// Blocks of draws of a batch: those of all numbers stay in the first-level cache.
const BLOCKS: usize = 8;
/// Events of a batch.
const BATCH: usize = BLOCKS * DRAWS;
/// By how much of their size, or of one, numbers may differ from those of an event alone.
const NEAR: f64 = 1e-11;

/// What a projectile meets, for eight.
#[derive(Clone, Debug)]
pub(super) enum Meeting {
    /// cot(ψ/2) by the energy and b/b_max of V = k/r.
    Coulomb(f64),
    /// Any other center, at one energy.
    Table(TableAbreast),
    /// And at several.
    Tables(EnergiesAbreast),
}

impl Meeting {
    /// Whether no number tells what is captured.
    const fn tells_captured(&self) -> bool {
        matches!(self, Self::Table(_))
    }
}

/// Edges of bins, to be looked up: the slot behind each, and the ends of that.
type Bins = Rows<3>;

/// A beam whose events are found eight at a time.
pub(super) struct Abreast<'a> {
    beam: &'a Beam,
    meeting: Meeting,
    collision: Collision,
    circle: Circle,
    /// Of each tally and each of its axes.
    tallies: Vec<(&'a Tally, Vec<(Quantity, Bins)>)>,
}

/// Eight events.
struct Eight<S> {
    energy: S,
    /// b/b_max.
    part: S,
    /// |ψ|, folded.
    angle: S,
    /// sin and cos of half of it, up to a common factor.
    half: [S; 2],
    /// Sine and cosine of the tilt and of the azimuth, if there is a divergence.
    direction: Option<[S; 4]>,
}

/// The draws of a batch, as parts of one.
type Draws = [[Draw; DRAWS]; BLOCKS];

fn bins(edges: &Edges) -> Bins {
    let edges = edges.values();
    let row = |at: usize| [(at + 1) as f64, edges[at], edges.get(at + 1).copied().unwrap_or(f64::INFINITY)];
    Rows::with_bins(edges.to_vec(), (0..edges.len()).map(row).collect(), BINS)
}

/// The slot of a number that may be off by so much of one and of itself, if that is told.
#[inline(always)]
fn slot(bins: &Bins, value: f64, off: f64) -> Option<usize> {
    let [slot, low, high] = *bins.at(value);
    // What is nothing is so to the bit.
    let off = if value == 0.0 { 0.0 } else { off };
    if value - off >= low && value + off < high && high < f64::INFINITY {
        return Some(slot as usize);
    }
    if value - off > low && high == f64::INFINITY {
        return Some(slot as usize);
    }
    (value + off < bins.starts()[0]).then_some(0)
}

impl<'a> Abreast<'a> {
    /// Of a mixture, if it is one beam, elastic and not direct, and the machine has the instructions for it.
    pub(super) fn of(mixture: &'a Mixture, tallies: &'a [Tally]) -> Option<Self> {
        let mut beams = mixture.beams();
        let beam = beams.next().filter(|_| beams.next().is_none() && tier() != Tier::Portable)?;
        let collision = beam.elastic()?;
        let axes = |tally: &'a Tally| {
            (tally, tally.axes().iter().map(|(quantity, edges)| (*quantity, bins(edges))).collect())
        };
        Some(Self {
            beam,
            meeting: beam.meeting()?,
            collision,
            circle: collision.circle(),
            tallies: tallies.iter().map(axes).collect(),
        })
    }

    /// Counts events, and gives those that are to be found alone to `alone`.
    pub(super) fn count(
        &self,
        key: Key,
        events: Range<u64>,
        counters: &mut [Vec<Vec<u64>>],
        alone: impl Fn(u64, &mut [Vec<Vec<u64>>]),
    ) {
        let mut event = events.start;
        let slots = vec![[0; WIDTH]; self.tallies.len()];
        let mut found = Found { counters, slots, unknown: Vec::with_capacity(BATCH) };
        while event < events.end {
            // A block serves two events: an odd beginning leaves out its first.
            let skipped = event & 1;
            let count = (events.end - event).min(BATCH as u64 - skipped);
            batch(self, key, event >> 1, (skipped as usize, (skipped + count) as usize), &mut found);
            for place in found.unknown.drain(..) {
                alone(event - skipped + u64::from(place), found.counters);
            }
            event += count;
        }
    }

    /// Eight events from a place of a batch on.
    #[inline(always)]
    fn eight<S: Vector8 + Functions + Lookup>(
        &self,
        share: Lanes,
        draws: &[Draws; 4],
        at: usize,
    ) -> Eight<S> {
        let part = S::load(share).sqrt();
        let middle = S::splat(self.beam.energy());
        let profile = &self.beam.profile;
        let energy = match profile.energy_spread {
            None => middle,
            Some(Spread::Gaussian(sigma)) => {
                let (_, cosine) = functions::sin_cos(S::splat(TAU) * uniform::<S>(&draws[1], at));
                S::splat(sigma).multiply_add(radius(uniform::<S>(&draws[0], at)) * cosine, middle)
            }
            Some(Spread::Uniform(half_width)) => {
                let uniform = uniform::<S>(&draws[0], at);
                S::splat(half_width).multiply_add(uniform + uniform - S::one(), middle)
            }
        };
        let (angle, half) = match &self.meeting {
            Meeting::Coulomb(reach) => {
                let cotangent = S::splat(*reach) * energy * part;
                let angle = functions::atan2(S::one(), cotangent);
                (angle + angle, [S::one(), cotangent])
            }
            Meeting::Table(table) => bent(table.angle(part)),
            Meeting::Tables(tables) => {
                bent(tables.angle(energy * S::splat(self.collision.relative_share()), part))
            }
        };
        let direction = match profile.divergence {
            None => None,
            Some(spread) => {
                let draw = uniform::<S>(&draws[2], at);
                let (sine, cosine) = match spread {
                    Spread::Gaussian(sigma) => functions::sin_cos(S::splat(sigma) * radius(draw)),
                    // As of a half angle whose sine is that of the cone's by the root of the draw.
                    Spread::Uniform(half_angle) => {
                        let most = crate::numerics::angles::sin(0.5 * half_angle);
                        let square = S::splat(most * most) * draw;
                        let across = (square * (S::one() - square)).sqrt();
                        (across + across, S::one() - square - square)
                    }
                };
                let (aside, ahead) = functions::sin_cos(S::splat(TAU) * uniform::<S>(&draws[3], at));
                Some([sine, cosine, aside, ahead])
            }
        };
        Eight { energy, part, angle, half, direction }
    }

    /// The slots of eight events of each tally, and of which all of them are known.
    #[inline(always)]
    fn slots<S: Vector8 + Functions>(
        &self,
        eight: &Eight<S>,
        captured: Bits,
        stratum: &[usize; WIDTH],
        slots: &mut [[usize; WIDTH]],
    ) -> [bool; WIDTH] {
        let mut known = [true; WIDTH];
        for index in 0..self.tallies.len() {
            let (tally, axes) = &self.tallies[index];
            let mut found = [0; WIDTH];
            let mut none = [false; WIDTH];
            for axis in 0..axes.len() {
                let (quantity, bins) = &axes[axis];
                let (value, off) = self.value(*quantity, eight);
                let (value, off) = (value.store().0, off.store().0);
                for lane in 0..WIDTH {
                    if *quantity != Quantity::ImpactParameter && captured.lane(lane) {
                        none[lane] = true;
                        known[lane] &= self.meeting.tells_captured();
                        continue;
                    }
                    match slot(bins, value[lane], off[lane]) {
                        Some(slot) => found[lane] = found[lane] * (bins.starts().len() + 1) + slot,
                        None => known[lane] = false,
                    }
                }
            }
            for lane in 0..WIDTH {
                let within = if none[lane] { tally.slots() - 1 } else { found[lane] };
                slots[index][lane] = stratum[lane] * tally.slots() + within;
            }
        }
        known
    }

    /// A quantity of eight events, and by how much it may be off.
    #[inline(always)]
    fn value<S: Vector8 + Functions>(&self, quantity: Quantity, eight: &Eight<S>) -> (S, S) {
        let [sine, cosine] = eight.half;
        let (square, complement) = (sine * sine, cosine * cosine);
        let near = S::splat(NEAR);
        let of_energy = |part: S| (eight.energy * part, near * eight.energy);
        match quantity {
            Quantity::ImpactParameter => (S::splat(self.beam.b_max) * eight.part, S::zero()),
            Quantity::CmAngle => (eight.angle, near),
            Quantity::LabAngle => {
                let Circle { slow, fast, own, .. } = self.circle;
                let (along, across) = if slow == 0.0 {
                    (cosine, sine)
                } else {
                    let along = S::splat(fast).multiply_add(complement, S::splat(slow) * square);
                    (along, S::splat(2.0 * own) * (sine * cosine))
                };
                (turned(across, along, eight.direction, false), near)
            }
            Quantity::RecoilAngle => (turned(cosine, sine, eight.direction, true), near),
            Quantity::Energy => {
                let kept = S::splat(self.collision.kept_head_on()).multiply_add(square, complement);
                of_energy(kept / (square + complement))
            }
            Quantity::RecoilEnergy => {
                let most = S::splat(self.collision.greatest_transfer());
                of_energy(most * (square / (square + complement)))
            }
        }
    }
}

/// The radius of a Gaussian of two dimensions.
#[inline(always)]
fn radius<S: Functions>(draw: S) -> S {
    (S::splat(-2.0) * functions::ln(S::splat(-WITHIN).multiply_add(draw, S::one()))).sqrt()
}

/// Eight draws from a place on.
#[inline(always)]
fn uniform<S: Vector8>(draws: &Draws, at: usize) -> S {
    let draws = draws.as_flattened();
    let mut lanes = Lanes([0.0; WIDTH]);
    for lane in 0..WIDTH {
        lanes.0[lane] = draws[at + lane].number() as f64 * UNIT;
    }
    S::load(lanes)
}

/// |ψ| in [0, π], and sine and cosine of half of it.
#[inline(always)]
fn bent<S: Vector8 + Functions>(angle: S) -> (S, [S; 2]) {
    let size = angle.abs();
    let (sine, cosine) = functions::sin_cos(S::splat(0.5) * size);
    let (sine, cosine) = (sine.abs(), cosine.abs());
    let folded = if size.less_equal(S::splat(PI)).all() {
        size
    } else {
        let folded = functions::atan2(sine, cosine);
        S::select(size.less_equal(S::splat(PI)), size, folded + folded)
    };
    (folded, [sine, cosine])
}

/// The angle from the axis of what goes off across and along a direction.
#[inline(always)]
fn turned<S: Functions>(across: S, along: S, direction: Option<[S; 4]>, recoil: bool) -> S {
    let Some([sine, cosine, aside, ahead]) = direction else { return functions::atan2(across, along) };
    let size = across.multiply_add(across, along * along).sqrt();
    let (across, along) = (across / size, along / size);
    let ahead = across * if recoil { -ahead } else { ahead };
    let x = ahead.multiply_add(cosine, along * sine);
    let y = across * aside;
    functions::atan2(x.multiply_add(x, y * y).sqrt(), along * cosine - ahead * sine)
}

tiered! {
    fn batch[][](abreast: &Abreast<'_>, key: Key, block: u64, used: (usize, usize), found: &mut Found<'_>) = batch_body;
}

/// What comes of a batch.
struct Found<'c> {
    counters: &'c mut [Vec<Vec<u64>>],
    /// The slots of eight events, of each tally.
    slots: Vec<[usize; WIDTH]>,
    /// The places of those that are to be found alone.
    unknown: Vec<u16>,
}

#[inline(always)]
fn batch_body<S: Vector8 + Functions + Lookup>(
    abreast: &Abreast<'_>,
    key: Key,
    block: u64,
    (first, end): (usize, usize),
    found: &mut Found<'_>,
) {
    let profile = &abreast.beam.profile;
    let mut places: Draws = Default::default();
    let mut draws: [Draws; 4] = Default::default();
    fill_draws(key, block, PLACE, &mut places);
    let wanted = [
        (ENERGY, profile.energy_spread.is_some()),
        (ENERGY_PHASE, matches!(profile.energy_spread, Some(Spread::Gaussian(_)))),
        (TILT, profile.divergence.is_some()),
        (AZIMUTH, profile.divergence.is_some()),
    ];
    for index in 0..wanted.len() {
        if wanted[index].1 {
            fill_draws(key, block, wanted[index].0, &mut draws[index]);
        }
    }
    let places = places.as_flattened();
    for at in (first / WIDTH * WIDTH..end).step_by(WIDTH) {
        let (mut share, mut stratum) = (Lanes([0.0; WIDTH]), [0; WIDTH]);
        for lane in 0..WIDTH {
            let place = places[at + lane].number();
            share.0[lane] = abreast.beam.share(place);
            stratum[lane] = abreast.beam.stratum(place);
        }
        let eight: Eight<S> = abreast.eight(share, &draws, at);
        let captured = eight.angle.less_equal(eight.angle).not();
        let known = abreast.slots(&eight, captured, &stratum, &mut found.slots);
        for lane in first.saturating_sub(at)..WIDTH.min(end - at) {
            if !known[lane] {
                found.unknown.push((at + lane) as u16);
                continue;
            }
            for tally in 0..found.slots.len() {
                found.counters[tally][0][found.slots[tally][lane]] += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests;
