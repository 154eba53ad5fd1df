//! The deflection of an ion that slows down: ψ over energy and impact parameter, as a table that was checked.
//!
//! As an [event table](crate::scattering::event_table) of one energy, in two variables, and of tan(ψ/2): its ratio to that
//! of a Coulomb center with the same slope head-on is a Chebyshev series in both, octave by octave of the energy in
//! halves, intervals of b halved until the series is right between its points. So sine and cosine of ψ/2 take a root and
//! no angle. Cells in which that leads nowhere, since ions turn back and further (orbits), or since ψ is not
//! smooth in the energy (the top of a hill that ions pass over), go without: each angle is found by quadrature, in a
//! hundred times the time. Of V = k/r there is the closed form.

mod build;

use super::octaves::Octaves;
use crate::numerics::angles::{atan2, sin_cos};
use crate::parallel::{Control, Ticker};
use crate::scattering::deflection::Deflector;
use std::sync::Arc;

pub(super) use build::{captures, reach};

/// Coefficients in the energy, of half an octave or less.
const IN_ENERGY: usize = 6;
/// And in the impact parameter, of an interval.
const IN_B: usize = 10;
/// Parts of an octave, as a power of two.
const PARTS: u32 = 1;

/// Of one interval of b: for each degree in b the coefficients in the energy.
type Series = [[f64; IN_ENERGY]; IN_B];

/// What is known of one cell of energies.
#[derive(Clone, Debug)]
struct Cell {
    b_max: f64,
    /// κ·E of the Coulomb center that it is compared with.
    scale: f64,
    /// Where intervals begin, and the end, as parts of b_max.
    starts: Vec<f64>,
    /// None where each angle is found on its own.
    pieces: Vec<Series>,
}

/// ψ over energy and impact parameter.
#[derive(Clone, Debug)]
pub(super) enum Angles {
    /// Of V = k/r: |k|/2.
    Coulomb(f64),
    Table(Table),
}

/// Of any other.
#[derive(Clone, Debug)]
pub(super) struct Table {
    octaves: Octaves,
    cells: Vec<Cell>,
    error: f64,
    deflector: Arc<Deflector>,
}

impl Angles {
    /// Sine and cosine of |ψ|/2; NaN of what is captured.
    #[inline]
    pub(super) fn half(&self, energy: f64, b: f64) -> (f64, f64) {
        match self {
            Self::Coulomb(half) => {
                let kappa = half / energy;
                let root = (kappa * kappa + b * b).sqrt();
                (kappa / root, b / root)
            }
            Self::Table(table) => table.half(energy, b),
        }
    }
    /// The largest error of sin²(ψ/2) of all points that were tried.
    pub(super) fn error(&self) -> f64 {
        match self {
            Self::Coulomb(_) => 0.0,
            Self::Table(table) => table.error,
        }
    }
    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Coulomb(_) => 0,
            Self::Table(table) => {
                let of = |cell: &Cell| cell.pieces.len() * (size_of::<Series>() + size_of::<f64>());
                table.cells.iter().map(of).sum()
            }
        }
    }
}

impl Table {
    #[inline]
    fn half(&self, energy: f64, b: f64) -> (f64, f64) {
        let at = self.octaves.cell(energy);
        let cell = &self.cells[at];
        if cell.pieces.is_empty() {
            let control = Control::new(0);
            let found = self.deflector.deflect(&[energy], &[b], false, 1, &mut Ticker::quiet(&control));
            let angle =
                found.ok().and_then(|found| found.first().map(|found| found.angle)).unwrap_or(f64::NAN);
            let (sine, cosine) = sin_cos(0.5 * angle);
            return (sine.abs(), cosine.abs());
        }
        let (tangent, one) = cell.tangent(self.octaves.place(at, energy), energy, b / cell.b_max);
        let root = (tangent * tangent + one * one).sqrt();
        (tangent.abs() / root, one / root)
    }
}

impl Cell {
    /// tan(ψ/2) as a fraction, lengths both.
    #[inline]
    fn tangent(&self, place: f64, energy: f64, part: f64) -> (f64, f64) {
        let piece = self.starts.partition_point(|start| *start <= part).clamp(1, self.pieces.len()) - 1;
        let (from, to) = (self.starts[piece], self.starts[piece + 1]);
        let x = ((part - from) / (to - from) * 2.0 - 1.0).clamp(-1.0, 1.0);
        self.fraction(sum(&self.pieces[piece], place, x), energy, part)
    }
    /// The same, of the ratio.
    #[inline]
    fn fraction(&self, ratio: f64, energy: f64, part: f64) -> (f64, f64) {
        (ratio * (self.scale / energy), part * self.b_max)
    }
    /// The angle of the ratio.
    fn angle(&self, ratio: f64, energy: f64, part: f64) -> f64 {
        let (tangent, one) = self.fraction(ratio, energy, part);
        2.0 * atan2(tangent, one)
    }
}

/// A series at −1 ≤ y, x ≤ 1, y in the energy.
fn sum(series: &Series, y: f64, x: f64) -> f64 {
    let mut terms = [1.0; IN_ENERGY];
    terms[1] = y;
    for degree in 2..IN_ENERGY {
        terms[degree] = 2.0 * y * terms[degree - 1] - terms[degree - 2];
    }
    let coefficient = |row: &[f64; IN_ENERGY]| -> f64 { row.iter().zip(&terms).map(|(a, t)| a * t).sum() };
    let (mut next, mut after) = (0.0, 0.0);
    for row in series[1..].iter().rev() {
        (next, after) = (2.0 * x * next - after + coefficient(row), next);
    }
    x * next - after + coefficient(&series[0])
}

/// What the deflections are of.
pub(super) struct Source<'a> {
    pub(super) deflector: &'a Arc<Deflector>,
    /// The minimum angle.
    pub(super) minimum: f64,
    pub(super) threads: usize,
}

#[cfg(test)]
mod tests;
