//! Where a potential changes within a small part of a distance: shells, wells and edges that no grid of distances and no
//! equal steps would meet.
//!
//! The one idea: where bounds of the formula tell that nothing narrow hides between two distances, a series through
//! Chebyshev points tells V there; so octaves are cut until both are so. Cells that had to be narrower than an eighth of an
//! octave are those of a feature, and their ends are places at which sums and searches begin anew. Polynomials in pieces
//! say themselves where they are cut, and a well far out is as narrow as another length says.
//! Source: L. N. Trefethen, *Approximation Theory and Approximation Practice* (2013), chapters 3 and 8.

use super::Potential;
use crate::expressions::intervals::{Interval, Intervals};
use crate::numerics::angles::cos;
use crate::numerics::elementary::ln;
use crate::numerics::lanes::{Lanes, WIDTH, as_numbers, as_numbers_mut};
use crate::numerics::power_of_two::{exponent, scale};
use core::f64::consts::PI;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Points of a cell, two rows of them.
const NODES: usize = 2 * WIDTH;
/// How many of the last coefficients must be small, and against the largest value how small.
const TAIL: usize = 3;
const SMOOTH: f64 = 1e-11;
/// Against that, how near a series comes to what it was not made of.
const AGREES: f64 = 1e-10;
/// Cells narrower than this part of their distance hold an edge.
const EDGE: f64 = 1.0 / (1_u64 << 40) as f64;
/// What falls by less from a cell to its halves is rounding.
const FALLS: f64 = 0.25;
/// Numbers below this have not their digits.
const SMALL: f64 = f64::MIN_POSITIVE / f64::EPSILON;
/// Cells that are looked at, of all octaves together.
const CELLS: usize = 1 << 14;
/// Octaves to either side of the unit of length.
const OCTAVES: i32 = 64;
/// A cell is cut so often before it is one of a feature.
const COARSE: u32 = 3;
/// Parts of each piece of polynomials.
const PARTS: i32 = 8;
/// Pieces narrower than this part of their distance are narrow; against others that are so many times as wide they are
/// those of a feature; and as many marks as this are enough.
const APART: f64 = 1.0 / 32.0;
const CROWDED: f64 = 1.0 / 8.0;
const MARKS: usize = 512;
/// Of a well whose width is told by another length: so many widths to either side, so many places to each, …
const WIDTHS: i32 = 32;
const PER_WIDTH: i32 = 8;
/// … if it is narrower than this part of its distance.
const NARROW: f64 = 1.0 / 16.0;

/// What samples of a formula may not show.
#[derive(Clone, Debug)]
pub struct Hidden {
    intervals: Intervals,
    per_length: f64,
    energy: f64,
}

impl Hidden {
    /// Of a function of r times `per_length`, in a unit of energy.
    pub(super) fn new(intervals: Intervals, per_length: f64, energy: f64) -> Self {
        Self { intervals, per_length, energy }
    }
    /// Whether nothing narrow hides between two distances, and the largest |V| there, or more.
    fn between(&mut self, from: f64, to: f64) -> (bool, f64) {
        let r = Interval::between(from * self.per_length, to * self.per_length);
        let bounds = self.intervals.over(Interval::at(0.0), &[r], &[]);
        let size = |value: &Interval| value.low.abs().max(value.high.abs()) * self.energy.abs();
        (bounds.is_plain, bounds.values.iter().map(size).fold(0.0, f64::max))
    }
}

/// What was found.
#[derive(Clone, Debug, Default)]
pub struct Features {
    /// Distances to look at, ascending.
    pub places: Vec<f64>,
    /// Those between which V is smooth where it is narrow, ascending.
    pub marks: Vec<f64>,
    /// Where it was not resolved: from, to, and the largest |V| between them, or more.
    pub unresolved: Vec<[f64; 3]>,
}

impl Features {
    /// Of a potential in units of its own length.
    pub fn of(potential: &dyn Potential) -> Self {
        let mut found = Self::default();
        let lengths = potential.lengths();
        if potential.domain().is_some() {
            let breaks = potential.breaks();
            for pair in breaks.windows(2) {
                let part = |k: i32| pair[0] + (pair[1] - pair[0]) * f64::from(k) / f64::from(PARTS);
                found.places.extend((0..PARTS).map(part));
            }
            found.marks = crowded(&breaks);
        } else if let Some(hidden) = potential.hidden() {
            let mut search = Search { potential, hidden, cells: 0, found };
            for k in 0..OCTAVES {
                search.octave(scale(1.0, k));
                search.octave(scale(1.0, -1 - k));
            }
            found = search.found;
        } else {
            for &length in &lengths {
                for &width in lengths.iter().filter(|width| **width < NARROW * length) {
                    let at = |k: i32| length + width * f64::from(k) / f64::from(PER_WIDTH);
                    found.places.extend((-WIDTHS * PER_WIDTH..=WIDTHS * PER_WIDTH).map(at));
                    found.marks.extend((-WIDTHS..=WIDTHS).map(|k| at(k * PER_WIDTH)));
                }
            }
        }
        for distances in [&mut found.places, &mut found.marks] {
            distances.retain(|r| *r > 0.0 && r.is_finite());
            distances.sort_by(f64::total_cmp);
            distances.dedup();
        }
        found
    }
}

/// Of the ends of pieces those of pieces that are narrow against others nearby, as adaptive ones are about a feature; and
/// some of those that are all narrow.
fn crowded(breaks: &[f64]) -> Vec<f64> {
    let mut widest: BTreeMap<i32, f64> = BTreeMap::new();
    for pair in breaks.windows(2) {
        let most = widest.entry(exponent(pair[1])).or_default();
        *most = most.max(pair[1] - pair[0]);
    }
    let mut marks: Vec<f64> = Vec::new();
    let mut last = 0.0;
    for pair in breaks.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let octave = exponent(to);
        let nearby =
            widest.range(octave - 1..=octave + 1).fold(0.0, |most: f64, (_, width)| most.max(*width));
        let narrow = to - from < APART * to;
        if narrow && (to - from < CROWDED * nearby || from > (1.0 + APART) * last) {
            marks.extend([from, to]);
            last = to;
        }
    }
    let stride = marks.len().div_ceil(MARKS).max(1);
    marks.into_iter().step_by(stride).collect()
}

/// A cell, and what is known of it.
#[derive(Clone, Copy, Debug)]
struct Cell {
    from: f64,
    to: f64,
    depth: u32,
    /// The last coefficients of the cell it is a half of, if nothing hid there.
    tail: Option<f64>,
}

struct Search<'a> {
    potential: &'a dyn Potential,
    hidden: Hidden,
    cells: usize,
    found: Features,
}

impl Search<'_> {
    /// Looks at the octave that begins there.
    fn octave(&mut self, first: f64) {
        let mut pending = vec![Cell { from: first, to: 2.0 * first, depth: 0, tail: None }];
        while let Some(cell) = pending.pop() {
            let (plain, largest) = self.hidden.between(cell.from, cell.to);
            let values = self.values(&cell);
            let smooth = told(&values);
            if (plain && smooth.is_ok()) || largest < SMALL || values.iter().all(|v| !v.is_finite()) {
                continue;
            }
            if cell.depth < COARSE {
                pending.extend(halves(&cell, None));
            } else {
                self.eighth(cell, smooth.ok());
            }
        }
    }
    /// Cuts an eighth of an octave, of which all may be known by a series if nothing hides in it.
    fn eighth(&mut self, whole: Cell, coarse: Option<Series>) {
        let mut narrow = false;
        let mut marks = Vec::new();
        let mut pending = vec![whole];
        while let Some(cell) = pending.pop() {
            self.cells += 1;
            let (plain, largest) = self.hidden.between(cell.from, cell.to);
            let values = self.values(&cell);
            if largest < SMALL || values.iter().all(|v| !v.is_finite()) {
                marks.extend([cell.from, cell.to]);
                continue;
            }
            let tail = told(&values).err().unwrap_or(0.0);
            let rounding = plain && cell.tail.is_some_and(|before| tail >= FALLS * before);
            let edge = cell.to - cell.from <= EDGE * cell.from;
            if (plain && tail == 0.0) || rounding || edge {
                marks.extend([cell.from, cell.to]);
                self.found.places.extend(nodes(&cell));
                // What is rounding from the first is no feature.
                narrow |= match coarse {
                    None => cell.depth > COARSE + u32::from(rounding),
                    Some(coarse) => edge || !(rounding || coarse.agrees(&whole, &cell, &values)),
                };
            } else if self.cells > CELLS {
                self.found.unresolved.push([cell.from, cell.to, largest]);
            } else {
                pending.extend(halves(&cell, plain.then_some(tail)));
            }
        }
        if narrow {
            self.found.marks.extend(marks);
        }
    }
    fn values(&self, cell: &Cell) -> [f64; NODES] {
        let mut rows = [Lanes([0.0; WIDTH]); NODES / WIDTH];
        as_numbers_mut(&mut rows).copy_from_slice(&nodes(cell));
        let mut values = rows;
        self.potential.value_rows(&rows, &mut values);
        core::array::from_fn(|k| as_numbers(&values)[k])
    }
}

/// The inner one last, to be looked at next.
fn halves(cell: &Cell, tail: Option<f64>) -> [Cell; 2] {
    let (middle, depth) = (0.5 * (cell.from + cell.to), cell.depth + 1);
    [Cell { from: middle, depth, tail, ..*cell }, Cell { to: middle, depth, tail, ..*cell }]
}

/// cos(π m/32) of m from 0 to 63: with m = 2k + 1 Chebyshev's points, with m = (2k + 1) d their polynomials of degree d.
fn cosines() -> &'static [f64; 4 * NODES] {
    static COSINES: OnceLock<[f64; 4 * NODES]> = OnceLock::new();
    COSINES.get_or_init(|| core::array::from_fn(|m| cos(PI * m as f64 / (2 * NODES) as f64)))
}

fn nodes(cell: &Cell) -> [f64; NODES] {
    let half = 0.5 * (cell.to - cell.from);
    core::array::from_fn(|k| cell.from + (1.0 - cosines()[2 * k + 1]) * half)
}

/// The values of a cell, or their logarithms, of which a series tells the rest.
#[derive(Clone, Copy, Debug)]
struct Series {
    values: [f64; NODES],
    logarithms: bool,
}

/// Logarithms of the sizes of values of one sign; NaN where they have another.
fn logarithms(values: &[f64; NODES]) -> [f64; NODES] {
    let sign = values[0].signum();
    values.map(|v| if v * sign > SMALL && v.is_finite() { ln(v * sign) } else { f64::NAN })
}

fn largest(values: &[f64; NODES]) -> f64 {
    values.iter().fold(0.0, |most: f64, v| most.max(v.abs()))
}

/// The series through values if it ends small, or that of their logarithms; else how large it ends.
fn told(values: &[f64; NODES]) -> Result<Series, f64> {
    let ends = |values: &[f64; NODES]| {
        let of = |degree: usize| {
            let term = |(k, v): (usize, &f64)| v * cosines()[(2 * k + 1) * degree % (4 * NODES)];
            (values.iter().enumerate().map(term).sum::<f64>() * 2.0 / NODES as f64).abs()
        };
        (NODES - TAIL..NODES).map(of).fold(0.0, |most: f64, size| if size <= most { most } else { size })
    };
    let tail = ends(values);
    if tail <= SMOOTH * largest(values) {
        return Ok(Series { values: *values, logarithms: false });
    }
    let logarithms = logarithms(values);
    if ends(&logarithms) <= SMOOTH * largest(&logarithms).max(1.0) {
        return Ok(Series { values: logarithms, logarithms: true });
    }
    Err(tail)
}

impl Series {
    /// Whether it has the values of a part of its cell.
    fn agrees(&self, whole: &Cell, part: &Cell, values: &[f64; NODES]) -> bool {
        let (points, places) = (nodes(whole), nodes(part));
        let values = if self.logarithms { logarithms(values) } else { *values };
        let size = largest(&self.values).max(if self.logarithms { 1.0 } else { largest(&values) });
        let between = |r: f64| {
            let (mut over, mut under) = (0.0, 0.0);
            for (k, (point, v)) in points.iter().zip(&self.values).enumerate() {
                if r == *point {
                    return *v;
                }
                // Those of Chebyshev's points are sines, of changing signs.
                let sine = cosines()[(2 * k + 1).abs_diff(NODES)];
                let weight = (if k % 2 == 0 { sine } else { -sine }) / (r - point);
                over += weight * v;
                under += weight;
            }
            over / under
        };
        places.iter().zip(&values).all(|(r, value)| (between(*r) - value).abs() <= AGREES * size)
    }
}

#[cfg(test)]
mod tests;
