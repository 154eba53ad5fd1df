//! The random numbers of an ion: which draw is for what.

use crate::numerics::philox::{DRAW_BITS, Draw, Key, key, philox};

/// Counter word 3 of all of a foil's draws.
pub(super) const STREAM: u32 = 1;
/// Draws of the forced collision: where on the way it is, its b², its azimuth, its element.
pub(super) const FORCED: u32 = 0;
/// The first draw of the first step; each takes four: how far, b², azimuth, element.
const STEPS: u32 = 4;
/// As many steps as there are draws for.
pub(super) const MOST_STEPS: u32 = (1 << 30) - 2;

/// Of one event.
#[derive(Clone, Copy)]
pub(super) struct Draws {
    key: Key,
    event: u64,
}

impl Draws {
    pub(super) fn new(seed: u64, event: u64) -> Self {
        Self { key: key(seed), event }
    }
    /// A number in [0, 1).
    pub(super) fn uniform(self, number: u32) -> f64 {
        let block = self.event >> 1;
        let [a, b, c, d] = philox(self.key, [block as u32, (block >> 32) as u32, number, STREAM]);
        let (low, high) = if self.event & 1 == 0 { (a, b) } else { (c, d) };
        let bits = Draw::of(u64::from(high) << 32 | u64::from(low));
        bits.number() as f64 / (1_u64 << DRAW_BITS) as f64
    }
    /// The first draw of a step.
    pub(super) fn of_step(step: u32) -> u32 {
        STEPS + 4 * step
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::philox::draw_of;

    /// The contract, word by word: an odd event beyond 2^33, draw 5 (the b² of the first step), stream 1.
    #[test]
    fn draws_are_of_stream_1() {
        let event = 2 * 0x0000_0005_8000_0007 + 1;
        let words = philox([0x89ab_cdef, 0x0123_4567], [0x8000_0007, 5, Draws::of_step(0) + 1, 1]);
        let number = (u64::from(words[3]) << 32 | u64::from(words[2])) >> 11;
        let found = Draws::new(0x0123_4567_89ab_cdef, event).uniform(5);
        assert_eq!(found, number as f64 / 9_007_199_254_740_992.0);
        // And not the ones of the events of `monte_carlo`.
        assert_ne!(
            found,
            draw_of(key(0x0123_4567_89ab_cdef), event, 5).number() as f64 / 9_007_199_254_740_992.0
        );
    }
}
