//! How units lie in the lanes of a state.
//!
//! Packed, the lanes are the bodies of one unit; batched, they are eight units. The same integrators run
//! both: all that differs is how many units a state holds, and whether the lanes share a step.

use crate::numerics::lanes::{Bits, WIDTH};

/// How units lie in lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Lanes are bodies of one unit.
    Packed,
    /// Lanes are units.
    Batched,
}

impl Layout {
    /// Units that one state holds, each in a lane of its own from the first.
    pub fn units(self) -> usize {
        match self {
            Self::Packed => 1,
            Self::Batched => WIDTH,
        }
    }

    /// Units that go together at a fixed step. Batched, twice as many as there are lanes: a step is a chain of
    /// operations that wait for each other, and the processor has room for a second one.
    pub fn in_lockstep(self) -> usize {
        match self {
            Self::Packed => 1,
            Self::Batched => 2 * WIDTH,
        }
    }

    /// The lanes that move with the unit in `lane`: all of them if packed.
    pub fn mask(self, lane: usize) -> Bits {
        match self {
            Self::Packed => Bits(0xff),
            Self::Batched => Bits(1 << lane),
        }
    }
}
