//! The random numbers of an event: which draw is for what.
//!
//! All of them are in stream 0 of [`philox`](crate::numerics::philox), one each per event. A number is looked at only by
//! what it is for, so whatever is asked for beside changes none of the others: an event of a beam with a divergence has
//! the impact parameter that it has without. What an event will need one day takes draws 7, 8, … and leaves these as
//! they are, so that counts that were published stay what they are.

use super::beam::UNIT;
use crate::numerics::philox::{Key, draw_of, key};

/// Which part of all projectiles comes nearer: b²/b_max² of a disc.
pub(super) const PLACE: u32 = 0;
/// The component of a spectrum, in the order given.
pub(super) const COMPONENT: u32 = 1;
/// Where in the spread of the energy: of a Gaussian the radius of Box and Muller.
pub(super) const ENERGY: u32 = 2;
/// Their angle; not looked at for a uniform spread.
pub(super) const ENERGY_PHASE: u32 = 3;
/// How far the direction is from the axis.
pub(super) const TILT: u32 = 4;
/// The azimuth of the plane of scattering about the direction, from the plane of direction and axis.
pub(super) const AZIMUTH: u32 = 5;
/// The channel: those asked for in the order given, from 0 up; above them elastic.
pub(super) const CHANNEL: u32 = 6;

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
    /// 53 bits.
    pub(super) fn bits(self, number: u32) -> u64 {
        draw_of(self.key, self.event, number).number()
    }
    /// A number in [0, 1).
    pub(super) fn uniform(self, number: u32) -> f64 {
        self.bits(number) as f64 * UNIT
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::philox::philox;

    /// The contract, number by number: whoever changes one changes published counts.
    #[test]
    fn draws_are_for_what_they_were() {
        let all = [PLACE, COMPONENT, ENERGY, ENERGY_PHASE, TILT, AZIMUTH, CHANNEL];
        assert_eq!(all, [0, 1, 2, 3, 4, 5, 6]);
        let event = 2 * 0x0000_0005_8000_0007 + 1;
        for number in 0..7 {
            let words = philox([0x89ab_cdef, 0x0123_4567], [0x8000_0007, 5, number, 0]);
            let expected = (u64::from(words[3]) << 32 | u64::from(words[2])) >> 11;
            assert_eq!(Draws::new(0x0123_4567_89ab_cdef, event).bits(number), expected);
        }
    }
}
