//! Building a table: intervals that are halved until the series through their Chebyshev points is right between them.

use super::{DEGREE, EventTable, Piece, clenshaw, reference};
use crate::numerics::angles::{cos, sin};
use crate::numerics::philox::{draw, key};
use crate::parallel::{Ticker, for_chunks};
use crate::scattering::deflection::{Deflection, Deflector, Status};
use crate::words::number;
use crate::{Error, Result};
use core::f64::consts::{FRAC_PI_2, PI};

/// The largest error of sin²(ψ/2) that a table may have.
pub const MOST_ERROR: f64 = 4e-6;
/// Of the quadrature that tables are made of and checked against.
pub const TOLERANCE: f64 = 1e-12;
/// What series are refined to, as a part of the largest angle nearby: the first that fits.
const AIMS: [f64; 3] = [1e-9, 1e-8, 1e-7];
/// Below this no angle of its own is meant: head-on sin²(ψ/2) and far out 2κ/b have this at most from it.
const SMALLEST: f64 = 1e-13;
/// The last coefficients, in what a series is refined to.
const TAIL: f64 = 30.0;
/// Intervals are halved so often at most.
const DEEPEST: u32 = 26;
/// Bends at which the first intervals end, at most, and how far they are apart.
const MOST_BENDS: usize = 96;
const LEAST: f64 = 1.0 / (1_u64 << 24) as f64;
/// Pairs that a thread takes.
const PART: usize = 32;
/// Points between the nodes at which a series is tried, none of them where its error vanishes by symmetry.
const TRIED: [f64; 6] = [-0.973, -0.671, -0.289, 0.183, 0.537, 0.911];
/// Points, by area of the disc, at which the whole is tried.
const CERTIFYING: u64 = 512;
/// Pieces that fit in 64 KB.
const MOST_PIECES: usize = 580;

/// What a table is made of.
pub(super) struct Built {
    pub(super) b_max: f64,
    pub(super) scale: f64,
    pub(super) starts: Vec<f64>,
    pub(super) pieces: Vec<Piece>,
    pub(super) error: f64,
    pub(super) unresolved: f64,
}

/// An interval of b / b_max.
#[derive(Clone, Copy)]
struct Interval {
    from: f64,
    to: f64,
    depth: u32,
}

/// What evaluates many impact parameters of one energy.
struct Source<'a, 'b> {
    deflector: &'a Deflector,
    energy: f64,
    b_max: f64,
    threads: usize,
    ticker: &'a mut Ticker<'b>,
}

impl Source<'_, '_> {
    fn at(&mut self, parts: &[f64]) -> Result<Vec<Deflection>> {
        let b: Vec<f64> = parts.iter().map(|part| part * self.b_max).collect();
        // In parts of a few lanes: near a barrier each takes its time.
        let parts = for_chunks(self.threads, b.len().div_ceil(PART), self.ticker, |part, ticker| {
            let b = &b[part * PART..b.len().min((part + 1) * PART)];
            // With derivatives: the more there is that must agree, the less a sum is taken for finished too soon.
            self.deflector.deflect(&vec![self.energy; b.len()], b, true, 1, ticker)
        })?;
        Ok(parts.into_iter().flatten().collect())
    }
}

impl EventTable {
    /// Of relative motion with an energy, over a disc of impact parameters.
    ///
    /// # Errors
    /// `InvalidInput` naming `potential` for one that the table cannot hold within [`MOST_ERROR`], and what
    /// [`Deflector::deflect`] refuses; `Interrupted`.
    pub fn build(
        deflector: &Deflector,
        energy: f64,
        b_max: f64,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let source = &mut Source { deflector, energy, b_max, threads, ticker };
        let scale = matched(source)?;
        for aim in AIMS {
            if let Some(table) = Self::refined(source, scale, aim)? {
                let (error, part) = certified(&table, source)?;
                if error <= MOST_ERROR {
                    return Ok(Self { error, ..table });
                }
                let (error, b) = (number(error), number(part * b_max));
                let off = format!("its table is off by {error} in sin²(ψ/2) at b = {b}");
                return Err(refused(energy, &off));
            }
        }
        Err(refused(energy, "its deflections do not fit into 64 KB"))
    }

    /// Refined to a part of the angles; nothing if that takes too many pieces.
    fn refined(source: &mut Source<'_, '_>, scale: f64, aim: f64) -> Result<Option<Self>> {
        let b_max = source.b_max;
        let mut done: Vec<(Interval, Piece)> = Vec::new();
        let mut unresolved = 0.0;
        let mut pending = first(source.deflector, source.energy, b_max);
        while !pending.is_empty() {
            if done.len() + pending.len() > MOST_PIECES {
                return Ok(None);
            }
            let mut halves = Vec::new();
            let points: Vec<f64> = pending.iter().flat_map(points).collect();
            let found = source.at(&points)?;
            for (interval, (points, found)) in
                pending.iter().zip(points.chunks(POINTS).zip(found.chunks(POINTS)))
            {
                let deepest = interval.depth >= DEEPEST;
                match piece(scale, aim, points, found) {
                    Some((piece, true)) => done.push((*interval, piece)),
                    other if deepest => {
                        unresolved += interval.to * interval.to - interval.from * interval.from;
                        done.push((
                            *interval,
                            other.map_or_else(|| at_middle(scale, points, found), |o| o.0),
                        ));
                    }
                    _ => {
                        let (middle, depth) = (0.5 * (interval.from + interval.to), interval.depth + 1);
                        halves.push(Interval { to: middle, depth, ..*interval });
                        halves.push(Interval { from: middle, depth, ..*interval });
                    }
                }
            }
            pending = halves;
        }
        done.sort_by(|a, b| a.0.from.total_cmp(&b.0.from));
        let starts = done.iter().map(|(interval, _)| interval.from).chain([1.0]).collect();
        let pieces = done.iter().map(|(_, piece)| *piece).collect();
        Ok(Some(Self::from(Built { b_max, scale, starts, pieces, error: 0.0, unresolved })))
    }
}

fn refused(energy: f64, why: &str) -> Error {
    let energy = number(energy);
    Error::invalid(
        "potential",
        format!("expected one with a smooth deflection function, but at energy {energy} {why}"),
    )
}

/// κ / b_max of the Coulomb center with the same slope head-on; where nothing comes back, what turns by a right angle.
fn matched(source: &mut Source<'_, '_>) -> Result<f64> {
    let parts: Vec<f64> = (0..40).map(|i| 0.5_f64.powi(i)).collect();
    let found = source.at(&parts)?;
    let steep = |(part, found): (&f64, &Deflection)| {
        (found.status != Status::Captured && found.angle.abs() > FRAC_PI_2).then_some(*part)
    };
    let first = parts.iter().zip(&found).find_map(steep);
    let slope = parts.iter().zip(&found).rev().find_map(|(part, found)| {
        let half = 0.5 * found.complement;
        (found.status != Status::Captured && half.abs() < 1e-3 && half > 0.0 && *part < 1e-3)
            .then(|| part / half)
    });
    Ok(slope.or(first).unwrap_or(1.0).clamp(1e-9, 1e9))
}

/// The intervals to begin with: eighths of the disc, cut where the deflection function may bend sharply, and then also
/// where it breaks, as bends crowd there.
fn first(deflector: &Deflector, energy: f64, b_max: f64) -> Vec<Interval> {
    let bends = deflector.bends(energy);
    let edges = if bends.is_empty() { Vec::new() } else { deflector.edges(energy) };
    let stride = bends.len().div_ceil(MOST_BENDS).max(1);
    let breaks = edges.iter().map(|edge| edge.impact_parameter / b_max).filter(|part| *part < 1.0);
    let mut ends: Vec<f64> = (0..=8).map(|i| f64::from(i) / 8.0).chain(breaks).collect();
    let kept = ends.clone();
    // A bend beside one of those would hide it in the last of an interval.
    let apart = |part: &f64| kept.iter().all(|end| (part - end).abs() >= LEAST);
    ends.extend(bends.iter().step_by(stride).map(|b| b / b_max).filter(apart));
    ends.retain(|part| *part <= 1.0);
    ends.sort_by(f64::total_cmp);
    ends.dedup_by(|b, a| *b == *a || (*b - *a < LEAST && !kept.contains(b)));
    // As if halved so often.
    let depth =
        |width: f64| (3..DEEPEST).find(|depth| width >= 0.5_f64.powi(*depth as i32)).unwrap_or(DEEPEST);
    ends.windows(2)
        .map(|pair| Interval { from: pair[0], to: pair[1], depth: depth(pair[1] - pair[0]) })
        .collect()
}

/// Points of an interval: where its series is made, and where it is tried.
const POINTS: usize = DEGREE + TRIED.len();

fn points(interval: &Interval) -> Vec<f64> {
    let node = |k: usize| cos(PI * (k as f64 + 0.5) / DEGREE as f64);
    let place = |x: f64| interval.from + 0.5 * (1.0 + x) * (interval.to - interval.from);
    (0..DEGREE).map(node).chain(TRIED).map(place).collect()
}

/// The piece through what was found, and whether it is right between.
fn piece(scale: f64, aim: f64, points: &[f64], found: &[Deflection]) -> Option<(Piece, bool)> {
    let captured = found.iter().filter(|found| found.status == Status::Captured).count();
    if captured == found.len() {
        return Some((Piece::Captured, true));
    }
    if captured > 0 {
        return None;
    }
    let ratio = |at: usize| found[at].angle / reference(scale, points[at]);
    let mut series = [0.0; DEGREE];
    for (degree, coefficient) in series.iter_mut().enumerate() {
        let sum: f64 =
            (0..DEGREE).map(|k| ratio(k) * cos(PI * degree as f64 * (k as f64 + 0.5) / DEGREE as f64)).sum();
        *coefficient = sum * if degree == 0 { 1.0 } else { 2.0 } / DEGREE as f64;
    }
    let largest = found.iter().fold(0.0, |largest: f64, found| largest.max(found.angle.abs()));
    let right = TRIED.iter().enumerate().all(|(tried, x)| {
        let at = DEGREE + tried;
        let off = clenshaw(&series, *x) * reference(scale, points[at]) - found[at].angle;
        off.abs() <= aim * largest + SMALLEST + 4.0 * found[at].error
    });
    // A feature narrower than the points are apart may miss all that are tried, but no series of it ends small.
    let tail = series[DEGREE - 3..].iter().fold(0.0, |largest: f64, term| largest.max(term.abs()));
    let ends = tail * reference(scale, points[DEGREE - 1]) <= TAIL * aim * largest + SMALLEST;
    Some((Piece::Series(series), right && ends))
}

/// Of an interval in which capture begins, or that is too small to matter: what its middle has.
fn at_middle(scale: f64, points: &[f64], found: &[Deflection]) -> Piece {
    let middle = DEGREE + 2;
    if found[middle].status == Status::Captured {
        return Piece::Captured;
    }
    let mut series = [0.0; DEGREE];
    series[0] = found[middle].angle / reference(scale, points[middle]);
    Piece::Series(series)
}

/// The largest error of sin²(ψ/2), and where it is: at random points and beside the ends of all pieces that are large enough to matter.
fn certified(table: &EventTable, source: &mut Source<'_, '_>) -> Result<(f64, f64)> {
    let random = |i: u64| (draw(key(0x7461_626c), i).number() as f64 / (1_u64 << 53) as f64).sqrt();
    // What was halved to the last is shorter than that, whether or not the first intervals were dyadic.
    let smallest = 0.5_f64.powi(DEEPEST as i32 - 1);
    let near = |pair: &[f64]| (pair[1] - pair[0] > smallest).then(|| pair[0] + 0.02 * (pair[1] - pair[0]));
    let parts: Vec<f64> =
        (0..CERTIFYING).map(random).chain(table.starts.windows(2).filter_map(near)).collect();
    let found = source.at(&parts)?;
    let square = |angle: f64| sin(0.5 * angle).powi(2);
    let off = |(part, found): (&f64, &Deflection)| match table.angle(*part) {
        Some(angle) if found.status != Status::Captured => (square(angle) - square(found.angle)).abs(),
        None if found.status == Status::Captured => 0.0,
        _ => 1.0,
    };
    let worst = parts.iter().zip(&found).map(|pair| (off(pair), *pair.0));
    Ok(worst.fold((0.0, 0.0), |worst, here| if here.0 > worst.0 { here } else { worst }))
}
