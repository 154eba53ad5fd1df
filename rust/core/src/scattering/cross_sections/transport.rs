//! Integrals over impact parameters: transport cross sections Q^(l)(E).
//!
//! The one idea: every integrand is smooth in the logarithm of the distance to an edge, since near orbiting ψ is linear
//! in it, and in the logarithm of b far out. So intervals go by those, and are halved, all at once, where two rules differ.
//! Beyond the last of them ψ is a power of b, of which the integral is known.

use super::super::deflection::{Deflector, Edge, Status};
use super::super::kronrod::{self, POINTS};
use crate::numerics::angles::sin;
use crate::numerics::double_double::two_sum;
use crate::numerics::elementary::{Exponential, ln};
use crate::parallel::Ticker;
use crate::words::number;
use crate::{Error, Result};
use core::f64::consts::PI;

/// Rounds of halving, and intervals at most: what is not told by then is left as it is.
const ROUNDS: usize = 40;
const MOST_INTERVALS: usize = 6000;
/// The tolerance of a cross section, relative.
const TOLERANCE: f64 = 1e-10;
/// How near to an edge and how far out intervals go, as exponents of e.
const NEAREST: f64 = 26.0;
const FARTHEST: f64 = 40.0;
/// From another length that matters they go at least so far.
const HALF_WAY: f64 = 20.0;
/// Intervals are no longer than this at first.
pub(super) const LONGEST: f64 = 2.0;

/// How a variable of an interval makes an impact parameter.
#[derive(Clone, Copy, Debug)]
enum Way {
    /// b itself.
    Straight,
    /// b = scale · e^t.
    Far(f64),
    /// b = edge + side · e^t.
    Near(f64, f64),
    /// b = edge − t.
    Beside(f64),
}

impl Way {
    /// b, what it is rounded by, and db/dt.
    fn at(self, t: f64) -> Place {
        match self {
            Self::Straight => Place { b: t, rest: 0.0, weight: 1.0 },
            Self::Far(scale) => {
                let b = scale * Exponential::exp(t);
                Place { b, rest: 0.0, weight: b }
            }
            Self::Near(edge, side) => {
                let off = Exponential::exp(t);
                let (b, rest) = two_sum(edge, side * off);
                Place { b, rest, weight: off }
            }
            Self::Beside(edge) => {
                let (b, rest) = two_sum(edge, -t);
                Place { b, rest, weight: 1.0 }
            }
        }
    }
    /// Which t makes an impact parameter, if one does.
    fn place(self, b: f64) -> f64 {
        match self {
            Self::Straight => b,
            Self::Far(scale) => ln(b / scale),
            Self::Near(edge, side) if side * (b - edge) > 0.0 => ln(side * (b - edge)),
            Self::Near(..) => f64::NAN,
            Self::Beside(edge) => edge - b,
        }
    }
}

/// An impact parameter of an integral.
#[derive(Clone, Copy, Debug)]
struct Place {
    b: f64,
    rest: f64,
    weight: f64,
}

/// The integral over an interval, how far it may be off, and by how much the angles in it make it so.
#[derive(Clone, Copy, Debug)]
struct Part {
    value: f64,
    off: f64,
    noise: f64,
}

#[derive(Clone, Copy, Debug)]
struct Interval {
    way: Way,
    ends: [f64; 2],
}

/// Q^(l)(E) = 2π ∫ (1 − cos^l ψ) b db.
///
/// # Errors
/// `InvalidInput` naming `potential` if the integral has no end, or if some are captured, whose angle is none;
/// `Interrupted`.
pub fn transport(
    deflector: &Deflector,
    energy: f64,
    l: u32,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<f64> {
    transport_to(TOLERANCE, deflector, energy, l, threads, ticker)
}

/// The same to a tolerance.
///
/// # Errors
/// As [`transport`].
pub(super) fn transport_to(
    tolerance: f64,
    deflector: &Deflector,
    energy: f64,
    l: u32,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<f64> {
    if deflector.falls_as_inverse_distance() {
        return Err(Error::invalid(
            "potential",
            "expected one that falls faster than 1/r: of others transport cross sections are infinite; screen it, \
             or cut the impact parameters and integrate deflect() up to there",
        ));
    }
    let near = deflector.near(energy);
    let deflector = near.as_ref().unwrap_or(deflector);
    let edges = deflector.edges(energy);
    if let Some(edge) = edges.iter().find(|edge| edge.captures) {
        return Err(Error::invalid(
            "potential",
            format!(
                "expected one that captures nothing: up to impact parameter {} there is no angle; take \
                 capture_cross_section, or give the potential a core that repels",
                number(edge.impact_parameter)
            ),
        ));
    }
    let mut pending = intervals(deflector, energy, &edges);
    let (mut sum, mut error) = (0.0, 0.0);
    let mut done: Vec<Part> = Vec::new();
    let mut untold = None;
    for round in 0..ROUNDS {
        let (found, first_untold) = evaluate(deflector, energy, l, &pending, threads, ticker)?;
        untold = untold.or(first_untold);
        let whole: f64 = done.iter().chain(&found).map(|part| part.value.abs()).sum();
        let last = round + 1 == ROUNDS || done.len() + pending.len() > MOST_INTERVALS;
        let mut next = Vec::new();
        for (interval, part) in pending.iter().zip(found) {
            let [from, to] = interval.ends;
            let middle = 0.5 * (from + to);
            if part.off <= tolerance * whole * 1e-3
                || part.off <= tolerance * part.value.abs() * 1e-2
                || part.off <= part.noise
                || last
                || middle <= from
                || middle >= to
            {
                done.push(part);
            } else {
                next.push(Interval { ends: [from, middle], ..*interval });
                next.push(Interval { ends: [middle, to], ..*interval });
            }
        }
        pending = next;
        if pending.is_empty() {
            break;
        }
    }
    done.push(beyond(deflector, energy, l, ticker)?);
    for part in done {
        sum += part.value;
        error += part.off + part.noise;
    }
    if error > 1e-6 * sum {
        // What could not be told says why itself.
        let places: Vec<f64> = untold.into_iter().collect();
        let _ = deflector.deflect(&vec![energy; places.len()], &places, false, 1, ticker)?;
        let message = format!(
            "expected one at which a transport cross section can be known to 1e-6, got {}, where it is to {}",
            number(energy),
            number(error / sum)
        );
        return Err(Error::invalid("energy", message));
    }
    Ok(2.0 * PI * sum)
}

/// How far a power of V may be rounded.
const ROUNDED_POWER: f64 = 16.0 * f64::EPSILON;

/// What is left beyond the farthest interval, where V = k/rⁿ and ψ goes as 1/bⁿ: nothing of most potentials, all but a little
/// where n is near one.
fn beyond(deflector: &Deflector, energy: f64, l: u32, ticker: &mut Ticker<'_>) -> Result<Part> {
    let nothing = Part { value: 0.0, off: 0.0, noise: 0.0 };
    if deflector.range() < f64::INFINITY {
        return Ok(nothing);
    }
    let ends = outermost(deflector, energy, &deflector.edges(energy));
    let b = Way::Far(deflector.length(energy)).at(ends[1]).b;
    let over = deflector.power_at(b) - 1.0;
    let found = deflector.deflect(&[energy], &[b], false, 1, ticker)?;
    let Some(found) = found.first().filter(|found| over > 0.0 && found.angle != 0.0) else {
        return Ok(nothing);
    };
    let value = less_than_one(found.angle, l) * b * b / (2.0 * over);
    let noise = value * (ROUNDED_POWER / over + 2.0 * found.error / found.angle.abs());
    Ok(Part { value, off: 0.0, noise })
}

/// The ends of the part of the line that has none, as logarithms of the length.
fn outermost(deflector: &Deflector, energy: f64, edges: &[Edge]) -> [f64; 2] {
    let length = deflector.length(energy);
    let last = edges.iter().map(|edge| edge.impact_parameter).fold(0.0, f64::max);
    let from = ln((last + length) / length);
    let [_, settled] = deflector.lengths(energy);
    [from, from.max(ln(settled / length) - HALF_WAY) + FARTHEST]
}

/// Intervals between edges, towards them and far out.
fn intervals(deflector: &Deflector, energy: f64, edges: &[Edge]) -> Vec<Interval> {
    let (range, length) = (deflector.range(), deflector.length(energy));
    let mut ends: Vec<f64> =
        [0.0].into_iter().chain(edges.iter().map(|edge| edge.impact_parameter)).collect();
    ends.retain(|b| *b < range);
    ends.push(range);
    let bends = deflector.bends(energy);
    let mut all = Vec::new();
    let mut add = |way: Way, from: f64, to: f64| {
        let inside = bends.iter().map(|b| way.place(*b)).filter(|t| *t > from && *t < to);
        let mut cuts: Vec<f64> = [from, to].into_iter().chain(inside).collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        let longest =
            if matches!(way, Way::Straight | Way::Beside(_)) { 0.25 * (to - from) } else { LONGEST };
        for pair in cuts.windows(2) {
            let length = pair[1] - pair[0];
            let parts = (length / longest).ceil().max(1.0);
            for part in 0..parts as usize {
                let at = |k: usize| length.mul_add(k as f64 / parts, pair[0]);
                all.push(Interval { way, ends: [at(part), at(part + 1)] });
            }
        }
    };
    // A rim of V may be beside another, nearer than an orbit is looked at.
    let rim = |b: f64| edges.iter().any(|edge| edge.impact_parameter == b && edge.orbit.is_none());
    let nearest = |b: f64, most: f64| if rim(b) { most - NEAREST } else { (ln(b) - NEAREST).min(most - 1.0) };
    for pair in ends.windows(2) {
        let [low, high] = [pair[0], pair[1]];
        let middle = if high < f64::INFINITY { 0.5 * (low + high) } else { low + length };
        if low > 0.0 {
            let most = ln(middle - low);
            add(Way::Near(low, 1.0), nearest(low, most), most);
        } else if high == f64::INFINITY {
            let [reach, _] = deflector.lengths(energy);
            add(Way::Far(length), (ln(reach / length) + HALF_WAY).min(0.0) - FARTHEST, 0.0);
        } else {
            add(Way::Straight, 0.0, middle);
        }
        if high < f64::INFINITY {
            let most = ln(high - middle);
            let nearest = nearest(high, most);
            add(Way::Near(high, -1.0), nearest, most);
            if high == range || rim(high) {
                // On the last of a weak well angles are larger than anywhere, however thin it is: less than b is rounded by
                // is left out or counted twice there.
                add(Way::Beside(high), 0.0, Exponential::exp(nearest));
            }
        } else {
            let [from, to] = outermost(deflector, energy, edges);
            add(Way::Far(length), from, to);
        }
    }
    all
}

/// 1 − cos^l ψ is no more.
const ANY_ANGLE: f64 = 2.0;

/// Each interval by both rules, and the first impact parameter whose angle cannot be told.
fn evaluate(
    deflector: &Deflector,
    energy: f64,
    l: u32,
    intervals: &[Interval],
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<(Vec<Part>, Option<f64>)> {
    let mut places = Vec::with_capacity(POINTS * intervals.len());
    for interval in intervals {
        for k in 0..POINTS {
            places.push(interval.way.at(kronrod::place(interval.ends, k)));
        }
    }
    let b: Vec<f64> = places.iter().map(|place| place.b).collect();
    let found = deflector.deflect_what_can_be_told((&vec![energy; b.len()], &b), false, threads, ticker)?;
    let (mut values, mut noise) = (Vec::with_capacity(places.len()), Vec::with_capacity(places.len()));
    let mut untold = None;
    for (Place { b, rest, weight }, deflection) in places.iter().zip(&found) {
        let captured = deflection.status == Status::Captured;
        if deflection.error == f64::INFINITY {
            // Any angle: on the flat top of a barrier it matters to nothing.
            values.push(0.0);
            noise.push(ANY_ANGLE * b * weight);
            untold = untold.or(Some(*b));
            continue;
        }
        // Near the rim of a well that falls as a root of what is left: by less than b is rounded it is not the same.
        let missing = if deflection.derivative.is_finite() { deflection.derivative * rest } else { 0.0 };
        let turned = if captured { 0.0 } else { less_than_one(deflection.angle + missing, l) };
        let steepest = f64::from(l) * (deflection.angle.abs() + deflection.error).min(1.0);
        values.push(turned * b * weight);
        noise.push(if captured { 0.0 } else { steepest * deflection.error * b * weight });
    }
    let rules = |((interval, values), noise): ((&Interval, &[f64]), &[f64])| {
        let [value, off] = both_rules(interval.ends, values);
        Part { value, off, noise: both_rules(interval.ends, noise)[0] }
    };
    let parts = intervals.iter().zip(values.chunks(POINTS)).zip(noise.chunks(POINTS)).map(rules).collect();
    Ok((parts, untold))
}

/// The integral and how far it may be off.
pub(super) fn both_rules(ends: [f64; 2], values: &[f64]) -> [f64; 2] {
    let found = kronrod::estimate(ends, |k| values[k]);
    [found.integral, found.error]
}

/// 1 − cos^l ψ, without a difference where ψ is small: with s = 1 − cos ψ it is s (1 + cos ψ + … + cos^(l−1) ψ).
fn less_than_one(angle: f64, l: u32) -> f64 {
    let half = sin(0.5 * angle);
    let less = 2.0 * half * half;
    let cosine = 1.0 - less;
    let powers = (1..l).fold(1.0, |sum, _| sum * cosine + 1.0);
    less * powers
}
