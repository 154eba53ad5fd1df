//! The time and the action of a way whose panels are known.
//!
//! The one idea: each panel is halved until eight samples of both halves say what eight of the whole said; the kinetic energy
//! at each of them is that of a place where it is known and the integral of the slope from there.

use super::way::{NOISE, Panel};
use super::{OneFreedom, gauss};
use crate::error::{Error, Result};
use crate::numerics::lanes::WIDTH;

/// Eight samples and twice eight that agree to this have an error that is its square.
const AGREEMENT: f64 = 1e-13;
/// What is less than this part of the whole is nothing.
const NOTHING: f64 = 1e-17;
/// As often a panel is halved, and the most panels.
const HALVINGS: u32 = 60;
const MOST: usize = 1 << 18;
/// What remains so often is rounding.
const REMAINS: u32 = 2;
/// Of a kinetic energy that is less than so many last digits of what it is the rest of, nothing is known.
const DIGITS: f64 = 4.0;

/// A panel as it is integrated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Where distances are counted from, the direction, and how far it goes.
    origin: f64,
    direction: f64,
    length: f64,
    /// The kinetic energy at the origin, and what it is the rest of.
    left: (f64, f64),
    /// The origin is a turning point: distances are squares.
    is_squared: bool,
}

/// Part of a piece: from and to in its variable, and the kinetic energy at its beginning with what it is the rest of.
#[derive(Clone, Copy)]
struct Part {
    from: f64,
    to: f64,
    left: (f64, f64),
}

impl Piece {
    /// From a turning point to another place.
    pub(super) fn at_an_end(end: f64, to: f64) -> Self {
        let (direction, length) = ((to - end).signum(), (to - end).abs());
        Self { origin: end, direction, length, left: (0.0, 0.0), is_squared: true }
    }

    /// Between two places with these energies, from that where less is left.
    pub(super) fn inner(panel: &Panel, energies: &[(f64, f64)]) -> Self {
        let (panel, left) = if energies[0].0 <= energies[1].0 {
            (*panel, energies[0])
        } else {
            (panel.reversed(), energies[1])
        };
        let width = panel.to - panel.from;
        Self { origin: panel.from, direction: width.signum(), length: width.abs(), left, is_squared: false }
    }

    /// The distance of `to` from the place of `from`, both in its variable.
    fn gap(&self, from: f64, to: f64) -> f64 {
        self.length * (to - from) * if self.is_squared { to + from } else { 1.0 }
    }

    /// Time and action of a part; no numbers where there is no motion.
    fn part(&self, of: &mut OneFreedom, part: Part) -> [f64; 2] {
        let (nodes, weights) = gauss::quadrature();
        let base = self.origin + self.direction * self.gap(0.0, part.from);
        let places = nodes.map(|x| part.from + x * (part.to - part.from));
        let gaps = places.map(|place| self.direction * self.gap(part.from, place));
        let masses = of.values(gaps.map(|gap| base + gap))[1];
        let mut sums = [0.0; 2];
        for index in 0..WIDTH {
            let [rise, size] = of.rise(base, gaps[index]);
            let left = part.left.0 - rise;
            if left.is_nan() || left <= DIGITS * f64::EPSILON * (part.left.1 + size) {
                return [f64::NAN; 2];
            }
            let stretch = if self.is_squared { 2.0 * places[index] } else { 1.0 };
            let rate = weights[index] * self.length * stretch * (part.to - part.from);
            sums[0] += rate * (0.5 * masses[index] / left).sqrt();
            sums[1] += rate * (2.0 * masses[index] * left).sqrt();
        }
        sums
    }

    /// Both halves of a part.
    fn halves(&self, of: &mut OneFreedom, part: Part) -> [Part; 2] {
        let middle = 0.5 * (part.from + part.to);
        let base = self.origin + self.direction * self.gap(0.0, part.from);
        let [rise, size] = of.rise(base, self.direction * self.gap(part.from, middle));
        let left = (part.left.0 - rise, part.left.1 + size);
        [Part { to: middle, ..part }, Part { from: middle, left, ..part }]
    }
}

/// ∫ dq / q̇ and ∫ p dq.
///
/// # Errors
/// A motion that comes as near to standing still as numbers tell.
pub(super) fn integral(of: &mut OneFreedom, pieces: &[Piece]) -> Result<[f64; 2]> {
    let refused = || {
        Error::invalid(
            "position",
            "the motion comes as near to standing still as numbers tell: it is on a separatrix, where a period is infinite",
        )
    };
    let mut open = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let part = Part { from: 0.0, to: 1.0, left: piece.left };
        open.push((*piece, part, piece.part(of, part), f64::INFINITY, (0, 0)));
    }
    let about: [f64; 2] = core::array::from_fn(|index| {
        open.iter().map(|(_, _, value, ..)| value[index]).filter(|value| value.is_finite()).sum()
    });
    let (mut sums, mut rests, mut count) = ([0.0; 2], [0.0; 2], open.len());
    while let Some((piece, part, value, before, (remains, depth))) = open.pop() {
        let parts = piece.halves(of, part);
        let values = parts.map(|part| piece.part(of, part));
        let both: [f64; 2] = core::array::from_fn(|index| values[0][index] + values[1][index]);
        let mut change = 0.0_f64;
        for index in 0..2 {
            let absolute = (both[index] - value[index]).abs();
            if absolute <= NOTHING * about[index] {
                continue;
            }
            // One that is no number has to be halved, as one that differs does.
            let relative = absolute / both[index];
            change = if relative.is_nan() { f64::INFINITY } else { change.max(relative) };
        }
        // Of what is smooth hardly anything is left when a part is halved; of rounding, all, again and again.
        let remains = if before <= NOISE && change >= 0.25 * before { remains + 1 } else { 0 };
        if change <= AGREEMENT || (change <= NOISE && remains == REMAINS) {
            for index in 0..2 {
                let added = both[index] + rests[index];
                let sum = sums[index] + added;
                rests[index] = added - (sum - sums[index]);
                sums[index] = sum;
            }
            continue;
        }
        count += 1;
        if depth == HALVINGS || count > MOST {
            return Err(refused());
        }
        open.push((piece, parts[0], values[0], change, (remains, depth + 1)));
        open.push((piece, parts[1], values[1], change, (remains, depth + 1)));
    }
    Ok(sums)
}
