//! Cells of energy: each octave in equal parts, found from the bits of a number without a logarithm.

/// Cells from one energy to another: 2^parts to each octave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Octaves {
    first: u64,
    cells: usize,
    shift: u32,
}

impl Octaves {
    /// Cells that hold all from `lowest` to `highest`, positive and finite both.
    pub(super) fn new(lowest: f64, highest: f64, parts: u32) -> Self {
        let shift = 52 - parts;
        let first = lowest.to_bits() >> shift;
        Self { first, cells: ((highest.to_bits() >> shift) - first) as usize + 1, shift }
    }
    pub(super) fn cells(self) -> usize {
        self.cells
    }
    /// The cell of an energy, the nearest one of what is beyond.
    #[inline]
    pub(super) fn cell(self, energy: f64) -> usize {
        ((energy.to_bits() >> self.shift).saturating_sub(self.first) as usize).min(self.cells - 1)
    }
    /// Where a cell begins and ends.
    #[inline]
    pub(super) fn bounds(self, cell: usize) -> (f64, f64) {
        let edge = |cell: u64| f64::from_bits((self.first + cell) << self.shift);
        (edge(cell as u64), edge(cell as u64 + 1))
    }
    /// Where in its cell an energy is, from −1 to 1.
    #[inline]
    pub(super) fn place(self, cell: usize, energy: f64) -> f64 {
        let (from, to) = self.bounds(cell);
        ((energy - from) / (to - from) * 2.0 - 1.0).clamp(-1.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_hold_what_they_say() {
        for parts in [1, 4] {
            let octaves = Octaves::new(7.3, 9e6, parts);
            assert!(octaves.bounds(0).0 <= 7.3 && octaves.bounds(octaves.cells() - 1).1 > 9e6);
            for energy in [7.3, 8.0, 100.0, 4_194_304.0, 9e6] {
                let (from, to) = octaves.bounds(octaves.cell(energy));
                assert!(from <= energy && energy < to, "{energy}");
                assert!(to / from < 1.6);
            }
            assert_eq!((octaves.cell(1.0), octaves.cell(1e9)), (0, octaves.cells() - 1));
        }
    }
}
