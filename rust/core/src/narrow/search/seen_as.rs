//! What two looks of an equal step see of what lies between them.
//!
//! The one idea: equal steps are as coarse as they were asked for. What rises, or falls, from one look to the other is no surprise to
//! either of them; what comes and goes between them is.

use super::super::features::{AtEnds, Fades};
use super::super::way::Way;
use super::{Piece, Search, lanes, smaller};

/// Of the greatest velocity no more than this part may change far from the middle of a wall that equal steps see.
const FLANK: f64 = 0.1;
/// On one side of these a function of an argument is at a far end of itself.
const FAR: f64 = 2.0;
/// What falls as a power, and moves by much between two looks, comes to its pole in no more than so many times their distance.
const AHEAD: f64 = 6.0;
/// By what an argument moves within this part of the way to a look, and this part of its mean, it is told whether it turns there.
const BEFORE_A_LOOK: f64 = 1.0 / 64.0;
const MOVES: f64 = 0.1;

/// What two looks of an equal step see of what lies between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SeenAs {
    /// Nothing, as far as they tell.
    Nothing,
    /// A wave.
    Wave,
    /// What rises, or falls, to what either of them sees: a far end of a pulse, which comes and goes, or the way to a pole, which
    /// tells of itself.
    FarEnd,
    /// The same of a wall that a motion leads through: far from its middle, or beside it.
    FarFlank,
    Flank,
}

impl SeenAs {
    /// Whether what is between what two looks see, and gives this impulse, is known to them well enough; the greatest number that is
    /// moved, and what may be unseen as a part of one.
    pub(super) fn knows(self, impulse: f64, (tolerance, most): (f64, f64)) -> bool {
        match self {
            Self::Nothing | Self::Wave => false,
            Self::FarEnd => true,
            // It may be all there is to move one number, but not all of them.
            Self::FarFlank => impulse <= FLANK * most,
            Self::Flank => impulse <= tolerance * most,
        }
    }
}

impl Search {
    /// What the looks about a piece see of what lies between them.
    pub(super) fn seen_as(&mut self, way: &Way, piece: &Piece, equal: bool) -> SeenAs {
        if !equal {
            SeenAs::Nothing
        } else if self.of.fades[piece.argument] == Fades::Nowhere {
            SeenAs::Wave
        } else if !self.goes_on(way, piece) {
            SeenAs::Nothing
        } else if self.is_moved_by_time(way, piece) || self.leads_to_a_pole(way, piece) {
            SeenAs::FarEnd
        } else if self.is_far(way, piece) {
            SeenAs::FarFlank
        } else {
            SeenAs::Flank
        }
    }

    /// Whether what falls as a power does so from a pole on the way, or where that would lead.
    fn leads_to_a_pole(&mut self, way: &Way, piece: &Piece) -> bool {
        matches!(self.of.at_ends[piece.argument], AtEnds::Power(_))
            && self.turning(&way.straight(piece.looks), piece.argument, (-AHEAD, AHEAD), true).is_sharp
    }

    /// Whether it is the time, and no motion, that moves an argument between two looks, at both of which a function of it is at a far
    /// end.
    fn is_moved_by_time(&mut self, way: &Way, piece: &Piece) -> bool {
        let [from, to] = piece.looks;
        way.run_at_rest(from, &lanes(&[from, to]), &mut self.values);
        let u = self.values.output(piece.argument).0;
        let (moved, all) = ((u[1] - u[0]).abs(), (piece.to.u - piece.from.u).abs());
        moved >= 0.5 * all && self.is_far(way, piece)
    }

    /// Whether a function of an argument is at a far end at both looks; of a power nobody knows.
    fn is_far(&mut self, way: &Way, piece: &Piece) -> bool {
        way.run(&lanes(&piece.looks), &mut self.values);
        let u = self.values.output(piece.argument).0;
        matches!(self.of.at_ends[piece.argument], AtEnds::Power(_))
            || u[0].max(u[1]) < -FAR
            || u[0].min(u[1]) > FAR
    }

    /// Whether an argument moves at both looks about as it does between them: at the top of a wall, and of anything else, it turns.
    fn goes_on(&mut self, way: &Way, piece: &Piece) -> bool {
        let ([from, to], part) = (piece.looks, BEFORE_A_LOOK * (piece.looks[1] - piece.looks[0]));
        way.run(&lanes(&[from, from + part, to - part, to]), &mut self.values);
        let u = self.values.output(piece.argument).0;
        let least = smaller((u[1] - u[0]).abs(), (u[3] - u[2]).abs());
        least >= MOVES * BEFORE_A_LOOK * (u[3] - u[0]).abs()
    }
}
