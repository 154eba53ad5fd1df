//! Histograms of a function of one draw, without evaluating the function.
//!
//! The one idea: a tally of a Monte Carlo event, of one quantity or of two together, is a function of the event's 53-bit
//! draw whose quantities rise or fall in monotone stretches. So the edges of the bins are carried back to the draws once, by
//! bisection on the computed function itself, and an event costs a table look-up and an integer
//! comparison.

mod search;

use crate::numerics::philox::{DRAW_BITS, Draw};
use crate::parallel::Ticker;
use crate::words::number;
use crate::{Error, Result};
use search::steps_between;
pub use search::{Seen, Stepping};

/// The most bins of one histogram.
pub const MOST_BINS: usize = 1 << 16;

/// Edges, strictly increasing and finite; bin i holds `edges[i] ≤ x < edges[i+1]`, the last also its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Edges(Vec<f64>);

impl Edges {
    /// Checked edges.
    ///
    /// # Errors
    /// `InvalidInput` naming `argument`.
    pub fn new(argument: &str, edges: Vec<f64>) -> Result<Self> {
        if !(2..=MOST_BINS + 1).contains(&edges.len()) {
            return Err(Error::invalid(
                argument,
                format!("expected 2 to {} edges, got {}", MOST_BINS + 1, edges.len()),
            ));
        }
        if let Some(index) = edges.iter().position(|edge| !edge.is_finite()) {
            return Err(Error::invalid(
                argument,
                format!("expected finite edges, but edge {index} is {}", number(edges[index])),
            ));
        }
        if let Some(index) = edges.windows(2).position(|pair| pair[0] >= pair[1]) {
            return Err(Error::invalid(
                argument,
                format!(
                    "expected strictly increasing edges, but edge {index} is {} and edge {} is {}",
                    number(edges[index]),
                    index + 1,
                    number(edges[index + 1])
                ),
            ));
        }
        Ok(Self(edges))
    }
    /// `bins` equal bins from `low` to `high`.
    ///
    /// # Errors
    /// `InvalidInput` naming `bins`.
    pub fn uniform(bins: usize, low: f64, high: f64) -> Result<Self> {
        if !(1..=MOST_BINS).contains(&bins) {
            return Err(Error::invalid("bins", format!("expected 1 to {MOST_BINS} bins, got {bins}")));
        }
        let width = high - low;
        let mut edges: Vec<f64> = (0..bins).map(|i| low + width * (i as f64 / bins as f64)).collect();
        edges.push(high);
        Self::new("bins", edges)
    }
    /// The numbers.
    pub fn values(&self) -> &[f64] {
        &self.0
    }
    /// How many bins.
    pub fn bins(&self) -> usize {
        self.0.len() - 1
    }
    /// How far two values are from the edge between their slots, if those are neighbors.
    pub(super) fn sides(&self, slots: [usize; 2], values: [f64; 2]) -> Option<[f64; 2]> {
        let [low, high] = slots;
        let edge = self.0.get(low.min(high)).filter(|_| low.abs_diff(high) == 1)?;
        let sides = values.map(|value| value - edge);
        let apart = sides.iter().all(|side| side.is_finite()) && (sides[0] < 0.0) != (sides[1] < 0.0);
        apart.then_some(sides)
    }
    /// By what part of the edge between two neighboring slots a value is off it.
    pub(super) fn apart(&self, slots: [usize; 2], value: f64) -> f64 {
        let edge = self.0.get(slots[0].min(slots[1])).copied().unwrap_or(f64::NAN);
        if value == edge { 0.0 } else { ((value - edge) / edge).abs() }
    }
    /// The slot of x: 0 below, 1 + bin, or `bins + 1` above.
    pub(super) fn slot(&self, x: f64) -> usize {
        if x == self.0[self.bins()] { self.bins() } else { self.0.partition_point(|edge| *edge <= x) }
    }
}

/// How many draws there are: the first number that is none.
const DRAWS: u64 = 1 << DRAW_BITS;

/// Which of many intervals a draw falls into.
#[derive(Clone, Debug)]
pub struct Lookup {
    /// Interval p holds the draws from `starts[p]` to below `starts[p + 1]`; closed by a number above all.
    starts: Vec<u64>,
    /// The interval of the first draw of each of 2^k equal cells.
    cells: Vec<u32>,
    shift: u32,
}

impl Lookup {
    /// The fewest cells, and the most.
    const CELLS: [usize; 2] = [1 << 8, 1 << 18];
    /// The most intervals to a cell, in the mean: draws are compared with half of those of a cell.
    const MOST_IN_A_CELL: usize = 4;

    /// Of intervals that begin at increasing draws, the first at 0; so many cells for each, about. Intervals that crowd, as
    /// beside an orbit, share cells into which few draws fall: of those that hold a start there are so many times as many.
    pub fn new(mut starts: Vec<u64>, cells_each: usize) -> Self {
        let [fewest, most] = Self::CELLS;
        let shift_of = |cells: usize| DRAW_BITS - cells.trailing_zeros();
        let holding = |cells: usize| {
            let shift = shift_of(cells);
            1 + starts.windows(2).filter(|pair| pair[0] >> shift != pair[1] >> shift).count()
        };
        let mut cells = (cells_each * starts.len()).next_power_of_two().clamp(fewest, most);
        while cells > fewest
            && starts.len() <= Self::MOST_IN_A_CELL * (cells / 2)
            && cells_each * holding(cells / 2) <= cells / 2
        {
            cells /= 2;
        }
        let shift = shift_of(cells);
        let cells = (0..cells as u64)
            .map(|cell| (starts.partition_point(|start| *start <= cell << shift) - 1) as u32)
            .collect();
        starts.push(u64::MAX);
        Self { starts, cells, shift }
    }
    /// How many intervals.
    pub fn intervals(&self) -> usize {
        self.starts.len() - 1
    }
    /// The interval of a draw, below [`intervals`](Self::intervals).
    #[inline(always)]
    fn find(&self, draw: Draw) -> usize {
        let draw = draw.number();
        // SAFETY: a `Draw` has 53 bits, so its cell is below 2^(53 - shift), the number of cells; a cell holds an
        // interval; the last start, u64::MAX, exceeds every draw, so the search ends at an interval.
        unsafe {
            let mut piece = *self.cells.get_unchecked((draw >> self.shift) as usize) as usize;
            while draw >= *self.starts.get_unchecked(piece + 1) {
                piece += 1;
            }
            piece
        }
    }
    /// Those of several.
    pub fn find_all(&self, draws: &[Draw], found: &mut [u32]) {
        for (draw, found) in draws.iter().zip(found) {
            *found = self.find(*draw) as u32;
        }
    }
}

/// A step function of the draw: which slot of the histogram each draw falls into.
#[derive(Clone, Debug)]
pub struct Steps {
    lookup: Lookup,
    slots: Vec<usize>,
    /// How many counters each piece has.
    banks: usize,
}

impl Steps {
    /// Counters per piece of one that is alone, used in turn: neighbouring events of one piece do not wait for each other.
    const BANKS: usize = 4;
    /// Cells per piece of one that is alone, whose table stays in the nearest cache: draws are uniform, and a comparison
    /// fails once in 60 events or so.
    const CELLS_ALONE: usize = 32;
    /// And of many that are looked at by turns: a comparison that fails costs less than a table that is far away.
    const CELLS_TOGETHER: usize = 4;

    /// For a slot of each draw that rises or falls between the `turning` ones, which increase; to be looked at alone, or by
    /// turns with others.
    ///
    /// # Errors
    /// `Interrupted`: each of many edges takes some ten evaluations.
    pub fn new(
        turning: &[u64],
        function: &impl Stepping,
        alone: bool,
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let mut starts = vec![0];
        let ends = turning.iter().copied().chain([DRAWS]);
        for (from, to) in [0].into_iter().chain(turning.iter().copied()).zip(ends) {
            if from < to {
                starts.push(from);
                steps_between([from, to - 1], function, &mut starts, ticker)?;
            }
        }
        starts.sort_unstable();
        starts.dedup();
        let slots: Vec<usize> = starts.iter().map(|start| function.seen(*start).slot).collect();
        // What begins a stretch, but no other slot, is no step.
        let mut before = None;
        let (starts, slots): (Vec<u64>, Vec<usize>) =
            starts.into_iter().zip(slots).filter(|(_, slot)| before.replace(*slot) != Some(*slot)).unzip();
        let (cells, banks) = if alone { (Self::CELLS_ALONE, Self::BANKS) } else { (Self::CELLS_TOGETHER, 1) };
        Ok(Self { lookup: Lookup::new(starts, cells), slots, banks })
    }
    /// How many pieces.
    pub fn pieces(&self) -> usize {
        self.slots.len()
    }
    /// Room to count in.
    pub fn counters(&self) -> Vec<u64> {
        vec![0; self.pieces() * self.banks]
    }
    /// Counts draws in counters from [`Steps::counters`], of one that is alone.
    ///
    /// # Panics
    /// For the counters of another histogram: a defect of the caller.
    #[inline]
    pub fn count(&self, draws: &[Draw], counters: &mut [u64]) {
        assert!(counters.len() == self.pieces() * Self::BANKS, "counters of another histogram");
        let mut one = |draw: Draw, bank: usize| {
            let piece = self.lookup.find(draw);
            // SAFETY: a draw is found in an interval, and there are so many times as many counters as intervals.
            unsafe { *counters.get_unchecked_mut(piece * Self::BANKS + bank) += 1 };
        };
        let (fours, rest) = draws.as_chunks::<{ Self::BANKS }>();
        for four in fours {
            for bank in 0..Self::BANKS {
                one(four[bank], bank);
            }
        }
        for draw in rest {
            one(*draw, 0);
        }
    }
    /// Counts draws, each by the step function of its component, which have one counter for each piece.
    ///
    /// # Panics
    /// For counters of others, or a component that there is not: a defect of the caller.
    pub fn count_mixed(steps: &[Self], components: &[u32], draws: &[Draw], counters: &mut [Vec<u64>]) {
        for (draw, component) in draws.iter().zip(components) {
            let (steps, counters) = (&steps[*component as usize], &mut counters[*component as usize]);
            counters[steps.lookup.find(*draw)] += 1;
        }
    }
    /// The part of all draws that falls into each slot, so many times, is added to the slots of the histogram.
    pub fn collect_parts(&self, times: f64, slots: &mut [f64]) {
        let ends = self.lookup.starts.iter().skip(1).map(|end| *end.min(&DRAWS));
        for ((slot, start), end) in self.slots.iter().zip(&self.lookup.starts).zip(ends) {
            slots[*slot] += times * ((end - start) as f64 / DRAWS as f64);
        }
    }
    /// Adds counters to the slots of the histogram.
    pub fn collect(&self, counters: &[u64], slots: &mut [u64]) {
        for (slot, banks) in self.slots.iter().zip(counters.chunks_exact(self.banks)) {
            slots[*slot] += banks.iter().sum::<u64>();
        }
    }
}

#[cfg(test)]
mod tests;
