//! Parts of the time: all of it, or one step of those whom the units in the lanes follow.

use super::followers::Span;
use super::{Forces, Run};
use crate::error::Result;
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::real::{Mask, Real};
use crate::parallel::Ticker;

/// A part of the elapsed time, lane by lane, through which units are taken.
pub(super) struct Part {
    /// Where it begins, and where it ends.
    pub(super) from: Lanes,
    pub(super) to: Lanes,
    /// How long it is.
    pub(super) length: Lanes,
    /// Whether it is the last.
    pub(super) last: Bits,
    /// The lanes that have come to its end, though it is not the last.
    pub(super) arrived: Bits,
    /// Units that have not begun.
    pub(super) fresh: Bits,
    /// What distances are measured from at the start of the run.
    pub(super) reference: [Lanes; 4],
}

impl Run<'_> {
    /// Takes the units through a step of those that they follow.
    ///
    /// # Errors
    /// When the caller asks to stop.
    pub(super) fn through(&mut self, span: &Span, ticker: &mut Ticker<'_>) -> Result<()> {
        let (lanes, part) = (span.lanes, &mut self.part);
        part.from = Lanes::select(lanes, span.from, part.from);
        part.to = Lanes::select(lanes, span.to, part.to);
        part.length = Lanes::select(lanes, span.path.h, part.length);
        part.last = part.last.and(lanes.not()).or(span.last.and(lanes));
        part.arrived = part.arrived.and(lanes.not());
        self.clock.recount(lanes, part.length);
        for block in self.norm.blocks.iter_mut().filter(|block| !block.velocity) {
            for c in 0..block.reference.len() {
                block.reference[c] = part.reference[c] + block.drift[c] * part.from;
            }
        }
        let mut fresh = part.fresh.and(lanes);
        part.fresh = part.fresh.and(lanes.not());
        if let Forces::Along(guided) = &mut self.forces {
            guided.follow(&span.path, self.part.from);
        }
        loop {
            let running = self.running().and(lanes).and(self.part.arrived.not());
            if !running.any() {
                return Ok(());
            }
            if let Forces::Along(guided) = &mut self.forces {
                guided.running = running;
            }
            self.advance(core::mem::replace(&mut fresh, Bits(0)), running, ticker)?;
        }
    }

    /// The elapsed time of the unit in a lane: at the end of a part the time that those have whom it follows.
    pub(super) fn elapsed(&self, lane: usize) -> f64 {
        let Part { from, to, length, .. } = &self.part;
        let elapsed = self.clock.elapsed.0[lane];
        if elapsed == length.0[lane] { to.0[lane] } else { from.0[lane] + elapsed }
    }
}
