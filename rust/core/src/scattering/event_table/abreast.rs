//! Tables for eight impact parameters at once: the same series, looked up and summed side by side.
//!
//! The one idea: what is asked for in lanes needs eleven digits, not the last bit, so roundings may differ from those of
//! [`EventTable::angle`].

use super::{DEGREE, Energies, EventTable, Piece};
use crate::numerics::functions::{self, Functions};
use crate::numerics::rows::{Lookup, Rows};

/// Where a piece begins, the inverse of half its length, and its coefficients.
const ROW: usize = DEGREE + 2;
/// Bins to each piece.
pub const BINS: usize = 16;

/// A table for eight at once.
#[derive(Clone, Debug)]
pub struct TableAbreast {
    scale: f64,
    rows: Rows<ROW>,
}

/// Those of a range of energies, each with what part of its energy the lowest is, and its weight.
#[derive(Clone, Debug)]
pub struct EnergiesAbreast {
    low: f64,
    tables: Vec<(f64, f64, TableAbreast)>,
}

impl TableAbreast {
    /// Of a table.
    pub fn new(table: &EventTable) -> Self {
        let row = |(ends, piece): (&[f64], &Piece)| {
            let mut row = [f64::NAN; ROW];
            (row[0], row[1]) = (ends[0], 2.0 / (ends[1] - ends[0]));
            if let Piece::Series(series) = piece {
                row[2..].copy_from_slice(series);
            }
            row
        };
        let rows = table.starts.windows(2).zip(&table.pieces).map(row).collect();
        let starts = table.starts[..table.pieces.len()].to_vec();
        Self { scale: table.scale, rows: Rows::with_bins(starts, rows, BINS) }
    }

    /// ψ where b are these parts of b_max; no number where it is captured, and there alone.
    #[inline(always)]
    pub fn angle<S: Functions + Lookup>(&self, part: S) -> S {
        let row: [S; ROW] = part.columns(&self.rows);
        let x = ((part - row[0]) * row[1] - S::one()).max(-S::one()).min(S::one());
        let twice = x + x;
        let (mut next, mut after) = (row[ROW - 1], S::zero());
        for degree in (1..DEGREE - 1).rev() {
            let here = twice.multiply_add(next, row[2 + degree] - after);
            (next, after) = (here, next);
        }
        let ratio = x.multiply_add(next, row[2] - after);
        let reference = functions::atan2(S::splat(self.scale), part);
        ratio * (reference + reference)
    }
}

impl EnergiesAbreast {
    /// Of those tables.
    pub fn new(energies: &Energies) -> Self {
        let of = |(node, weight, table): &(f64, f64, EventTable)| (*node, *weight, TableAbreast::new(table));
        Self { low: energies.low, tables: energies.tables.iter().map(of).collect() }
    }

    /// ψ of these energies where b are these parts of b_max; no number at the energy of a table.
    #[inline(always)]
    pub fn angle<S: Functions + Lookup>(&self, energy: S, part: S) -> S {
        let share = S::splat(self.low) / energy;
        let (mut over, mut under) = (S::zero(), S::zero());
        for (node, weight, table) in &self.tables {
            let weight = S::splat(*weight) / (share - S::splat(*node));
            over = weight.multiply_add(table.angle(part), over);
            under += weight;
        }
        over / under
    }
}
