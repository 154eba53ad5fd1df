//! Building the table.

use super::{Angles, Cell, IN_B, IN_ENERGY, Octaves, PARTS, Series, Source, Table, sum};
use crate::numerics::angles::{atan2, cos, sin, sin_cos};
use crate::numerics::philox::{draw, key};
use crate::parallel::{Ticker, for_chunks};
use crate::potentials::Potential;
use crate::scattering::cross_sections::Structure;
use crate::scattering::deflection::{Deflection, Deflector, Edge, Status};
use crate::words::number;
use crate::{Error, Result};
use core::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// The largest error of sin²(ψ/2) that a table may have.
const MOST_ERROR: f64 = 4e-6;
/// What series are refined to, as a part of the largest angle nearby: the first suffices but where they are worse between the
/// places at which they are tried.
const AIMS: [f64; 3] = [1e-6, 1e-7, 1e-8];
/// Below this part of the minimum angle none is meant.
const SMALLEST: f64 = 1e-4;
/// Intervals are halved so often at most.
const DEEPEST: u32 = 22;
/// More pieces than this in one cell are no smooth function.
const MOST_PIECES: usize = 200;
/// Places, of energy and of b, at which a series is tried.
const TRIED: [[f64; 2]; 10] = [
    [-0.97, -0.93],
    [-0.7, 0.52],
    [-0.35, -0.98],
    [-0.3, 0.13],
    [0.05, 0.97],
    [0.1, -0.41],
    [0.4, -0.71],
    [0.6, 0.77],
    [0.85, -0.13],
    [0.98, 0.31],
];
/// Points of each cell at which the whole is tried.
const CERTIFYING: u64 = 64;
/// Radii to an octave that are tried for a reach, and how many octaves.
const PER_OCTAVE: i32 = 4;
const OCTAVES: i32 = 40;
/// So near to an edge of ψ it is looked at, as a part of b.
const BESIDE: f64 = 1e-9;
/// Of the quadrature.
const TOLERANCE: f64 = 1e-12;

/// The largest impact parameters, up to `cap`, that still turn by an angle: one for each energy; 0 where none does.
pub(in crate::scattering::foil) fn reach(
    source: &Source<'_>,
    energies: &[f64],
    angle: f64,
    cap: f64,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<f64>> {
    let radius = |step: i32| {
        let rest = f64::from(step.rem_euclid(PER_OCTAVE)) / f64::from(PER_OCTAVE);
        cap * 0.5_f64.powi(step.div_euclid(PER_OCTAVE)) * (1.0 - 0.5 * rest)
    };
    let mut bounds: Vec<Option<(f64, f64)>> = vec![None; energies.len()];
    for step in 0..=PER_OCTAVE * OCTAVES {
        let open: Vec<usize> = (0..energies.len()).filter(|at| bounds[*at].is_none()).collect();
        if open.is_empty() {
            break;
        }
        let found = source
            .deflections(&open.iter().map(|at| (energies[*at], radius(step))).collect::<Vec<_>>(), ticker)?;
        for (at, found) in open.into_iter().zip(&found) {
            if turns(found, angle) {
                bounds[at] = Some((radius(step), if step == 0 { cap } else { radius(step - 1) }));
            }
        }
    }
    if !source.deflector.repels() {
        for (energy, bounds) in energies.iter().zip(&mut bounds) {
            let Some(hump) = outermost_hump(source, *energy, (angle, cap), ticker)? else { continue };
            if bounds.is_none_or(|(from, _)| hump > from) {
                let outside = (0..=PER_OCTAVE * OCTAVES).map(radius).take_while(|b| *b > hump).last();
                *bounds = Some((hump, outside.unwrap_or(cap)));
            }
        }
    }
    // A little further out than need be: a few percent of a radius is no matter, a turn less than asked for would be.
    for _ in 0..6 {
        let pairs: Vec<(f64, f64)> = energies
            .iter()
            .zip(&bounds)
            .map(|(energy, bounds)| (*energy, bounds.map_or(cap, |(from, to)| 0.5 * (from + to))))
            .collect();
        let found = source.deflections(&pairs, ticker)?;
        for ((bounds, (_, middle)), found) in bounds.iter_mut().zip(pairs).zip(&found) {
            if let Some((from, to)) = bounds {
                if turns(found, angle) { *from = middle } else { *to = middle }
            }
        }
    }
    Ok(bounds.into_iter().map(|bounds| bounds.map_or(0.0, |(_, to)| to)).collect())
}

/// The outermost impact parameter up to `cap` at which |ψ| is largest, at a rainbow, beside an orbit or at the end of V, and as
/// large as an angle: between two radii nobody would see it.
fn outermost_hump(
    source: &Source<'_>,
    energy: f64,
    (angle, cap): (f64, f64),
    ticker: &mut Ticker<'_>,
) -> Result<Option<f64>> {
    let structure = Structure::new(source.deflector, energy, ticker)?;
    let beside = |edge: &Edge| [1.0 - BESIDE, 1.0 + BESIDE].map(|part| part * edge.impact_parameter);
    let rainbows = structure.rainbows().iter().map(|rainbow| rainbow.impact_parameter);
    let places = rainbows.chain(structure.edges().iter().flat_map(beside)).filter(|b| *b <= cap);
    let pairs: Vec<(f64, f64)> = places.map(|b| (energy, b)).collect();
    let found = source.deflections(&pairs, ticker)?;
    let turning = pairs.iter().zip(&found).filter(|(_, found)| turns(found, angle)).map(|((_, b), _)| *b);
    Ok(turning.max_by(f64::total_cmp))
}

/// Whether it turns by an angle.
fn turns(found: &Deflection, angle: f64) -> bool {
    found.status == Status::Captured || found.angle.abs() >= angle
}

impl<'a> Source<'a> {
    /// The deflections of pairs of an energy and an impact parameter.
    fn deflections(&self, pairs: &[(f64, f64)], ticker: &mut Ticker<'_>) -> Result<Vec<Deflection>> {
        let (energy, b): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
        self.deflector.deflect(&energy, &b, false, self.threads, ticker)
    }
    /// Of a potential.
    pub(in crate::scattering::foil) fn deflector(potential: &Arc<dyn Potential>) -> Result<Arc<Deflector>> {
        Deflector::for_table(potential, TOLERANCE).map(Arc::new)
    }
}

impl Angles {
    /// Between two energies of relative motion, as far out as `radius` says of what lies between two energies.
    ///
    /// # Errors
    /// `InvalidInput` naming `potential` for one that captures; `Interrupted`.
    pub(in crate::scattering::foil) fn build(
        potential: &Arc<dyn Potential>,
        source: &Source<'_>,
        (lowest, highest): (f64, f64),
        radius: &(dyn Fn(f64, f64) -> f64 + Sync),
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        if let Some(k) = potential.inverse_distance_strength() {
            return Ok(Self::Coulomb(0.5 * k.abs()));
        }
        let octaves = Octaves::new(lowest, highest, PARTS);
        let built = for_chunks(source.threads, octaves.cells(), ticker, |cell, ticker| {
            let (from, to) = octaves.bounds(cell);
            let source = Source { threads: 1, ..*source };
            let b_max = radius(from, to);
            for aim in AIMS {
                let made = Cell::build(&source, (from, to), (b_max, aim), ticker)?;
                let error = made.certified(&source, (from, to), cell as u64, ticker)?;
                if error <= MOST_ERROR {
                    return Ok((made, error));
                }
            }
            Ok((Cell::without_series(b_max, from), 0.0))
        })?;
        let error = built.iter().fold(0.0_f64, |worst, (_, error)| worst.max(*error));
        let cells = built.into_iter().map(|(cell, _)| cell).collect();
        Ok(Self::Table(Table { octaves, cells, error, deflector: Arc::clone(source.deflector) }))
    }
}

/// What is refused.
pub(in crate::scattering::foil) fn captures(energy: f64) -> Error {
    let message = format!(
        "expected one that captures nothing, since ions that fall into an atom have no way on, but at {} eV of relative \
         motion it does",
        number(energy)
    );
    Error::invalid("potential", message)
}

fn node(k: usize, of: usize) -> f64 {
    cos(PI * (k as f64 + 0.5) / of as f64)
}

impl Cell {
    /// Of which each angle is found on its own.
    fn without_series(b_max: f64, scale: f64) -> Self {
        Self { b_max, scale, starts: Vec::new(), pieces: Vec::new() }
    }

    fn build(
        source: &Source<'_>,
        bounds: (f64, f64),
        (b_max, aim): (f64, f64),
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let middle = 0.5 * (bounds.0 + bounds.1);
        // Near an orbit they turn without end, which no series would follow: many pieces would be tried for nothing.
        let mut orbits = false;
        for energy in [bounds.0, middle, bounds.1] {
            for edge in source.deflector.edges(energy).iter().filter(|edge| edge.impact_parameter < b_max) {
                if edge.captures {
                    return Err(captures(energy));
                }
                orbits |= edge.orbit.is_some();
            }
        }
        if orbits {
            return Ok(Self::without_series(b_max, middle));
        }
        let mut cell = Self::without_series(b_max, matched(source, middle, b_max, ticker)? * middle);
        let mut done: Vec<(f64, f64, Series)> = Vec::new();
        let mut pending: Vec<(f64, f64, u32)> =
            (0..4).map(|i| (f64::from(i) / 4.0, f64::from(i + 1) / 4.0, 2)).collect();
        while let Some((from, to, depth)) = pending.pop() {
            ticker.tick()?;
            if done.len() + pending.len() > MOST_PIECES {
                return Ok(cell);
            }
            let Some((series, right)) = cell.piece(source, bounds, (from, to, aim), ticker)? else {
                return Ok(cell);
            };
            if right || depth >= DEEPEST {
                done.push((from, to, series));
            } else {
                let half = 0.5 * (from + to);
                pending.push((from, half, depth + 1));
                pending.push((half, to, depth + 1));
            }
        }
        done.sort_by(|a, b| a.0.total_cmp(&b.0));
        cell.starts = done.iter().map(|piece| piece.0).chain([1.0]).collect();
        cell.pieces = done.into_iter().map(|piece| piece.2).collect();
        Ok(cell)
    }

    /// The series of an interval, and whether it is right between its points; nothing if something turns back and further.
    fn piece(
        &self,
        source: &Source<'_>,
        bounds: (f64, f64),
        (from, to, aim): (f64, f64, f64),
        ticker: &mut Ticker<'_>,
    ) -> Result<Option<(Series, bool)>> {
        let place = |y: f64, x: f64| {
            (bounds.0 + 0.5 * (1.0 + y) * (bounds.1 - bounds.0), from + 0.5 * (1.0 + x) * (to - from))
        };
        let nodes = (0..IN_B).flat_map(|i| (0..IN_ENERGY).map(move |j| (node(j, IN_ENERGY), node(i, IN_B))));
        let places: Vec<(f64, f64)> =
            nodes.chain(TRIED.map(|[y, x]| (y, x))).map(|(y, x)| place(y, x)).collect();
        let pairs: Vec<(f64, f64)> =
            places.iter().map(|(energy, part)| (*energy, part * self.b_max)).collect();
        let found = source.deflections(&pairs, ticker)?;
        if found.iter().any(|found| found.status == Status::Captured) {
            return Err(captures(bounds.0));
        }
        // Halves of angles beyond a right one have tangents of another branch.
        if found.iter().any(|found| found.angle.abs() >= PI) {
            return Ok(None);
        }
        let ratio = |at: usize| {
            let (energy, part) = places[at];
            // Where it turns back, its half is nearly a right angle: of that, the digits are in what is missing.
            let (sine, cosine) = sin_cos(0.5 * found[at].complement);
            let tangent = if found[at].angle.abs() > FRAC_PI_2 {
                (cosine / sine).copysign(found[at].angle)
            } else {
                let (sine, cosine) = sin_cos(0.5 * found[at].angle);
                sine / cosine
            };
            tangent * part * self.b_max / (self.scale / energy)
        };
        let mut series = [[0.0; IN_ENERGY]; IN_B];
        for (i, row) in series.iter_mut().enumerate() {
            for (j, coefficient) in row.iter_mut().enumerate() {
                let mut total = 0.0;
                for k in 0..IN_B {
                    let along: f64 =
                        (0..IN_ENERGY).map(|l| ratio(k * IN_ENERGY + l) * turn(j, l, IN_ENERGY)).sum();
                    total += along * turn(i, k, IN_B);
                }
                let norm = |degree: usize, of: usize| if degree == 0 { 1.0 } else { 2.0 } / of as f64;
                *coefficient = total * norm(i, IN_B) * norm(j, IN_ENERGY);
            }
        }
        let largest = found.iter().fold(0.0_f64, |largest, found| largest.max(found.angle.abs()));
        let right = TRIED.iter().enumerate().all(|(tried, [y, x])| {
            let at = IN_B * IN_ENERGY + tried;
            let off = self.angle(sum(&series, *y, *x), places[at].0, places[at].1) - found[at].angle;
            off.abs() <= aim * largest + SMALLEST * source.minimum + 4.0 * found[at].error
        });
        Ok(Some((series, right)))
    }

    /// The largest error of sin²(ψ/2) at random places of the cell.
    fn certified(
        &self,
        source: &Source<'_>,
        (from, to): (f64, f64),
        which: u64,
        ticker: &mut Ticker<'_>,
    ) -> Result<f64> {
        if self.pieces.is_empty() {
            return Ok(0.0);
        }
        let random = |i: u64| {
            draw(key(0x666f_696c), 2 * CERTIFYING * which + i).number() as f64 / (1_u64 << 53) as f64
        };
        let places: Vec<(f64, f64)> =
            (0..CERTIFYING).map(|i| (from + random(2 * i) * (to - from), random(2 * i + 1).sqrt())).collect();
        let pairs: Vec<(f64, f64)> =
            places.iter().map(|(energy, part)| (*energy, part * self.b_max)).collect();
        let found = source.deflections(&pairs, ticker)?;
        let square = |angle: f64| sin(0.5 * angle).powi(2);
        let worst = places.iter().zip(&found).map(|((energy, part), found)| {
            let place = (energy - from) / (to - from) * 2.0 - 1.0;
            let (tangent, one) = self.tangent(place, *energy, *part);
            (square(2.0 * atan2(tangent, one)) - square(found.angle)).abs()
        });
        let worst = worst.fold(0.0_f64, f64::max);
        Ok(worst)
    }
}

/// The polynomial of a degree at a node.
fn turn(degree: usize, k: usize, of: usize) -> f64 {
    cos(PI * degree as f64 * (k as f64 + 0.5) / of as f64)
}

/// κ of the Coulomb center with the same slope head-on; where nothing comes back, what turns by a right angle.
fn matched(source: &Source<'_>, energy: f64, b_max: f64, ticker: &mut Ticker<'_>) -> Result<f64> {
    let radii: Vec<f64> = (0..60).map(|i| b_max * 0.5_f64.powi(i)).collect();
    let found = source.deflections(&radii.iter().map(|b| (energy, *b)).collect::<Vec<_>>(), ticker)?;
    let steep = |(b, found): (&f64, &Deflection)| (found.angle.abs() > FRAC_PI_2).then_some(*b);
    let first = radii.iter().zip(&found).find_map(steep);
    let slope = radii.iter().zip(&found).find_map(|(b, found)| {
        let half = 0.5 * found.complement;
        (half.abs() < 1e-3 && half > 0.0).then(|| b / half)
    });
    Ok(slope.or(first).unwrap_or(b_max))
}
