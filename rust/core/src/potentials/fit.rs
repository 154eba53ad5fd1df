//! A function of the distance, known by its values alone, as polynomials in pieces that are checked where they were not made.
//!
//! The one idea: a polynomial through Chebyshev–Lobatto points of a piece, joined to its neighbors with continuous first
//! and second derivatives by a quintic that is as small as they differ; then compared with the function between those
//! points, and cut in two where it is too far. What cannot be met is refused with what was reached.
//! Source: L. N. Trefethen, *Approximation Theory and Approximation Practice* (2013), chapters 3 to 8.

use super::hermite::quintic;
use super::piecewise_polynomial::TERMS;
use crate::error::{Error, Result};
use crate::numerics::angles::cos;
use crate::numerics::elementary::{Exponential, ln};
use crate::words::number;
use core::f64::consts::PI;
use core::ops::Range;

/// Pieces at most.
const PIECES: usize = 4096;
/// Points of a piece in which it is checked, for each in which it is made.
const CHECKS: usize = 2;
/// Pieces that are narrower than this share of their distance hold an edge …
const NARROW: f64 = 1e-9;
/// … and one at r = 0 if it is narrower than this share of the range.
const NARROW_AT_ZERO: f64 = 1e-15;
/// Values below this have not their digits.
const SMALL: f64 = f64::MIN_POSITIVE / f64::EPSILON;
/// A change of V over its distance that is taken for more than so many of the largest values of a piece is a jump.
const JUMP: f64 = 100.0;
/// The least part of the largest value of a piece that its errors are measured by.
const FLOOR: f64 = 0.01;
/// As that, of the octave that the piece is in: a smooth cutoff comes to zero, where nothing is met relative to itself.
const FLOOR_OF_OCTAVE: f64 = 1e-16;
/// How many more distances there are at which pieces are looked at, to each e-fold, and from which part of the range on.
const LOOKS: f64 = 4096.0;
const LOOKED_FROM: f64 = 1.0 / (1 << 20) as f64;
/// There they may be off by so many tolerances: it is looked for what hides, not for rounding.
const LOOSER: f64 = 10.0;
/// Tolerances that can be met where second derivatives are made to agree, and are of use.
const TOLERANCES: core::ops::RangeInclusive<f64> = 1e-12..=1e-4;

/// The pieces, and the largest error that was found.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Where they begin, and the end of the last.
    pub breaks: Vec<f64>,
    /// Their coefficients, one piece after another.
    pub coefficients: Vec<f64>,
    /// |p − V|/(|V| + |r p′|), r the end of the piece, the largest of all checks; |r p′| is taken as no more than a
    /// hundred times the largest |V| of the piece, so that a jump is none, and no less than a hundredth of it, as that is
    /// rounded; and all is no less than 1e-16 of the largest |V| within the octave.
    pub error: f64,
}

/// How messages name what a function is of, and what its errors are relative to.
#[derive(Clone, Copy, Debug)]
pub struct Quantities {
    /// The argument.
    pub argument: &'static str,
    /// The size of the function.
    pub size: &'static str,
}

/// Of a potential.
pub const POTENTIAL: Quantities = Quantities { argument: "r", size: "|V| + |r dV/dr|" };

/// The values of a function at distances.
pub type Sample<'a> = dyn FnMut(&[f64]) -> Result<Vec<f64>> + 'a;

/// One piece: its ends, the polynomial by itself, and values to compare it with.
struct Piece {
    ends: [f64; 2],
    own: [f64; TERMS],
    /// Values at its ends.
    values: [f64; 2],
    checks: Vec<f64>,
    /// The largest value of the octave that it is part of.
    octave: f64,
}

impl Piece {
    /// Its largest value.
    fn largest(&self) -> f64 {
        self.checks.iter().chain(&self.values).fold(0.0, |most, v| most.max(v.abs()))
    }
}

/// A function from its values between two distances, to a tolerance relative to |V| + |r dV/dr|.
///
/// # Errors
/// By name: a range or a tolerance that is none, values that are not finite, a function that is not smooth enough, what
/// the function raises.
pub fn fit(sample: &mut Sample<'_>, range: [f64; 2], tolerance: f64, quantities: Quantities) -> Result<Fit> {
    let Quantities { argument, size } = quantities;
    let [low, high] = range;
    if !(low >= 0.0 && low.is_finite()) {
        let message = format!("expected a finite number of at least 0, got {}", number(low));
        return Err(Error::invalid(&format!("{argument}_min"), message));
    }
    if !(high > low && (high - low) > NARROW * high && high.is_finite()) {
        let (low, high) = (number(low), number(high));
        let message = format!("expected a finite number beyond {argument}_min = {low}, got {high}");
        return Err(Error::invalid(&format!("{argument}_max"), message));
    }
    if !TOLERANCES.contains(&tolerance) {
        let message = format!("expected a relative tolerance from 1e-12 to 1e-4, got {}", number(tolerance));
        return Err(Error::invalid("tolerance", message));
    }
    let mut pieces = made(sample, &[range], argument)?;
    for piece in &mut pieces {
        piece.octave = piece.largest();
    }
    let mut between: Option<Between> = None;
    loop {
        let joined = joined(&pieces);
        let errors: Vec<f64> = pieces.iter().zip(&joined).map(|(piece, p)| error(piece, p)).collect();
        let worst = errors.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap_or((0, &0.0));
        // What is no number is worse than any; over more than an octave the checks do not look at the near end.
        let wide = |at: &usize| errors[*at].is_nan() || errors[*at] > tolerance || is_long(pieces[*at].ends);
        let mut split: Vec<usize> = (0..pieces.len()).filter(wide).collect();
        if split.is_empty() {
            let between = match &between {
                Some(between) => between,
                None => between.insert(Between::of(sample, range, argument)?),
            };
            split = between.missed(&pieces, &joined, tolerance);
            for &at in &split {
                pieces[at].octave = pieces[at].octave.max(between.largest(&pieces[at]));
            }
        }
        if split.is_empty() {
            let breaks = pieces.iter().map(|piece| piece.ends[0]).chain([high]).collect();
            return Ok(Fit { breaks, coefficients: joined.concat(), error: *worst.1 });
        }
        let narrow = |piece: &Piece| match piece.ends {
            [0.0, end] => end <= NARROW_AT_ZERO * high,
            [start, end] => end - start <= NARROW * end,
        };
        if pieces.len() + split.len() > PIECES || split.iter().any(|&at| narrow(&pieces[at])) {
            let place = pieces[worst.0].ends;
            return Err(Error::invalid(
                "function",
                format!(
                    "expected a smooth one: with {} pieces it is met to {} of {size} at worst, from {argument} = {} to {}, \
                     and not to tolerance = {}; raise that, or begin or end before an edge of the function",
                    pieces.len(),
                    number(*worst.1),
                    number(place[0]),
                    number(place[1]),
                    number(tolerance)
                ),
            ));
        }
        let halves: Vec<[f64; 2]> = split.iter().flat_map(|&at| halved(pieces[at].ends)).collect();
        let mut new = made(sample, &halves, argument)?;
        for (piece, &from) in new.chunks_mut(2).zip(&split) {
            let octave = pieces[from].octave;
            let long = is_long(pieces[from].ends);
            for half in piece {
                half.octave = if long { half.largest() } else { octave };
            }
        }
        let mut new = new.into_iter();
        let mut split = split.into_iter().peekable();
        let mut all = Vec::with_capacity(pieces.len() + halves.len());
        for (at, piece) in pieces.into_iter().enumerate() {
            if split.next_if_eq(&at).is_some() {
                all.extend(new.by_ref().take(2));
            } else {
                all.push(piece);
            }
        }
        pieces = all;
    }
}

/// Values at many distances, in case something narrow hides from the checks of long pieces.
struct Between {
    r: Vec<f64>,
    values: Vec<f64>,
}

impl Between {
    fn of(sample: &mut Sample<'_>, [low, high]: [f64; 2], argument: &str) -> Result<Self> {
        let first = low.max(high * LOOKED_FROM);
        let count = (ln(high / first) * LOOKS).ceil().max(1.0);
        let place = |k: u32| first * Exponential::exp(ln(high / first) * (f64::from(k) + 0.5) / count);
        let r: Vec<f64> = (0..count as u32).map(place).filter(|r| *r > low && *r < high).collect();
        let values = finite(sample, &r, argument)?;
        Ok(Self { r, values })
    }
    /// The pieces that are off there, by more than where they are checked.
    fn missed(&self, pieces: &[Piece], joined: &[[f64; TERMS]], tolerance: f64) -> Vec<usize> {
        let of = |at: &usize| {
            let (piece, p, largest) = (&pieces[*at], &joined[*at], pieces[*at].largest());
            let off =
                |k: usize| difference(piece, p, largest, [self.r[k], self.values[k]]) > LOOSER * tolerance;
            self.inside(piece).any(off)
        };
        (0..pieces.len()).filter(of).collect()
    }
    /// The largest |V| within an octave of a piece.
    fn largest(&self, piece: &Piece) -> f64 {
        let [from, to] = [0.5 * piece.ends[0], 2.0 * piece.ends[1]];
        let inside = self.r.partition_point(|r| *r < from)..self.r.partition_point(|r| *r < to);
        inside.fold(0.0, |most, k| most.max(self.values[k].abs()))
    }
    fn inside(&self, piece: &Piece) -> Range<usize> {
        let [from, to] = piece.ends.map(|end| self.r.partition_point(|r| *r < end));
        from..to
    }
}

/// Whether it reaches over more than an octave.
fn is_long([low, high]: [f64; 2]) -> bool {
    low > 0.0 && high > 2.0 * low
}

/// In two: by ratio where it reaches over more than an octave, as powers ask for.
fn halved([low, high]: [f64; 2]) -> [[f64; 2]; 2] {
    let middle = if is_long([low, high]) { low.sqrt() * high.sqrt() } else { low + 0.5 * (high - low) };
    [[low, middle], [middle, high]]
}

fn place([low, high]: [f64; 2], t: f64) -> f64 {
    (low + 0.5 * (1.0 + t) * (high - low)).clamp(low, high)
}

/// Where the polynomial is made, from 1 to −1.
fn node(at: usize) -> f64 {
    cos(PI * at as f64 / (TERMS - 1) as f64)
}

/// Where it is checked: between those, and nearer to the ends than any.
fn check(at: usize) -> f64 {
    cos(PI * (at as f64 + 0.5) / (CHECKS * TERMS) as f64)
}

/// Pieces from one question to the function.
fn made(sample: &mut Sample<'_>, ranges: &[[f64; 2]], argument: &str) -> Result<Vec<Piece>> {
    let mut r = Vec::with_capacity(ranges.len() * (1 + CHECKS) * TERMS);
    for &range in ranges {
        r.push(range[1]);
        r.extend((1..TERMS - 1).map(|at| place(range, node(at))));
        r.push(range[0]);
        r.extend((0..CHECKS * TERMS).map(|at| place(range, check(at))));
    }
    let values = finite(sample, &r, argument)?;
    let of = |(values, &ends): (&[f64], &[f64; 2])| {
        let (nodes, checks) = values.split_at(TERMS);
        Piece {
            ends,
            own: through(nodes),
            values: [nodes[TERMS - 1], nodes[0]],
            checks: checks.to_vec(),
            octave: 0.0,
        }
    };
    Ok(values.chunks((1 + CHECKS) * TERMS).zip(ranges).map(of).collect())
}

/// The values of a function, if they are numbers.
fn finite(sample: &mut Sample<'_>, r: &[f64], argument: &str) -> Result<Vec<f64>> {
    let values = sample(r)?;
    if values.len() != r.len() {
        return Err(Error::Internal("a function gave another number of values".to_owned()));
    }
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(values),
        Some(at) => {
            let (v, r) = (number(values[at]), number(r[at]));
            Err(Error::invalid("function", format!("expected finite values, got {v} at {argument} = {r}")))
        }
    }
}

/// The coefficients of tᵏ of the polynomial through values at the nodes.
fn through(values: &[f64]) -> [f64; TERMS] {
    let last = TERMS - 1;
    let end = |at: usize| if at == 0 || at == last { 0.5 } else { 1.0 };
    let mut powers = [0.0; TERMS];
    // Chebyshev's polynomials, the one before and this one.
    let (mut before, mut this) = ([0.0; TERMS], [0.0; TERMS]);
    this[0] = 1.0;
    for k in 0..TERMS {
        let sum: f64 = values.iter().enumerate().map(|(j, v)| end(j) * v * node(j * k % (2 * last))).sum();
        let coefficient = sum * end(k) * 2.0 / last as f64;
        for (power, part) in powers.iter_mut().zip(this) {
            *power += coefficient * part;
        }
        let mut next = before.map(|x| -x);
        for at in 0..last {
            next[at + 1] += if k == 0 { this[at] } else { 2.0 * this[at] };
        }
        (before, this) = (this, next);
    }
    powers
}

/// Value and two derivatives at t.
fn derivatives(p: &[f64; TERMS], t: f64) -> [f64; 3] {
    let (mut value, mut slope, mut half) = (0.0, 0.0, 0.0);
    for c in p.iter().rev() {
        half = half * t + slope;
        slope = slope * t + value;
        value = value * t + c;
    }
    [value, slope, 2.0 * half]
}

/// The polynomials, with continuous first and second derivatives where they meet: the means of both sides.
fn joined(pieces: &[Piece]) -> Vec<[f64; TERMS]> {
    let per = |piece: &Piece| 2.0 / (piece.ends[1] - piece.ends[0]);
    // Derivatives with respect to r at both ends of each.
    let at_end = |piece: &Piece, t: f64| {
        let ([_, slope, bend], per) = (derivatives(&piece.own, t), per(piece));
        [slope * per, bend * per * per]
    };
    let ends: Vec<[[f64; 2]; 2]> =
        pieces.iter().map(|piece| [at_end(piece, -1.0), at_end(piece, 1.0)]).collect();
    let mean = |left: usize| -> [f64; 2] {
        core::array::from_fn(|k| 0.5 * (ends[left][1][k] + ends[left + 1][0][k]))
    };
    let joined = |(at, piece): (usize, &Piece)| {
        let before = if at > 0 { mean(at - 1) } else { ends[at][0] };
        let after = if at + 1 < pieces.len() { mean(at) } else { ends[at][1] };
        let per = per(piece);
        let lack = |t: f64, value: f64, [slope, bend]: [f64; 2]| {
            let own = derivatives(&piece.own, t);
            (value - own[0], [slope / per - own[1], bend / per / per - own[2]])
        };
        let (low, from) = lack(-1.0, piece.values[0], before);
        let (high, to) = lack(1.0, piece.values[1], after);
        centered(piece.own, quintic(2.0, [low, high], from, to))
    };
    pieces.iter().enumerate().map(joined).collect()
}

/// The sum of a polynomial of t, from −1 to 1, and of one whose variable is (1 + t)/2.
pub(crate) fn centered(own: [f64; TERMS], of_unit_interval: [f64; 6]) -> [f64; TERMS] {
    let mut p = own;
    // The powers of (1 + t)/2, multiplied out.
    let mut power = [0.0; TERMS];
    power[0] = 1.0;
    for c in of_unit_interval {
        for (p, part) in p.iter_mut().zip(power) {
            *p += c * part;
        }
        let mut next = power.map(|x| 0.5 * x);
        for k in 0..TERMS - 1 {
            next[k + 1] += 0.5 * power[k];
        }
        power = next;
    }
    p
}

/// The largest relative difference in a piece.
fn error(piece: &Piece, p: &[f64; TERMS]) -> f64 {
    let (mut worst, largest) = (0.0_f64, piece.largest());
    for (at, value) in piece.checks.iter().enumerate() {
        let error = difference(piece, p, largest, [place(piece.ends, check(at)), *value]);
        worst = if error <= worst { worst } else { error };
    }
    worst
}

/// How far a piece, whose largest value that is, is from a value at a distance, relative to |V| + r |dV/dr| as
/// [`Fit::error`] takes it.
fn difference(piece: &Piece, p: &[f64; TERMS], largest: f64, [r, value]: [f64; 2]) -> f64 {
    let per = 2.0 / (piece.ends[1] - piece.ends[0]);
    let least = (FLOOR_OF_OCTAVE * piece.octave).max(SMALL);
    // As it will be evaluated.
    let t = (r - 0.5 * (piece.ends[0] + piece.ends[1])) * per;
    let [found, slope, _] = derivatives(p, t);
    let change = (piece.ends[1] * slope * per).abs();
    let size = (value.abs() + change.min(JUMP * largest).max(FLOOR * largest)).max(least);
    (found - value).abs() / size
}

#[cfg(test)]
mod tests;
