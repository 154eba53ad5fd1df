//! Philox 4x32-10: random numbers as a function of their index.
//!
//! The one idea: a cipher of ten rounds turns a counter into four random words, so number n needs no
//! number before it, and any partition of the indices over threads or machines gives the same numbers.
//!
//! What the words mean is a promise to everybody who publishes a seed:
//! - the key is the seed, low word first;
//! - counter words 0 and 1 are event/2, low word first: a block serves an even event (output words 0 and 1) and
//!   the odd one after it (output words 2 and 3), 64 bits each, low word first, of which the upper 53 count;
//! - counter word 2 is the number of the draw within its event, from 0;
//! - counter word 3 is the stream: 0 is the events' own, 1 that of ions in a foil; any other use of random numbers under
//!   the same seed takes another, so that it can never meet the draws of an event.
//!
//! A new need takes a new draw or a new stream and changes no number of those in use.
//! Source: Salmon, Moraes, Dror & Shaw, *Parallel random numbers: as easy as 1, 2, 3*, SC'11 (2011).

use super::lanes::{Vector8, WIDTH, Words};

/// The key: a seed's low and high word.
pub type Key = [u32; 2];

const ROUNDS: u32 = 10;
const MULTIPLIERS: [u32; 2] = [0xd251_1f53, 0xcd9e_8d57];
/// The golden ratio and √3 - 1, as fractions of 2^32: what the key grows by in each round.
const WEYL: [u32; 2] = [0x9e37_79b9, 0xbb67_ae85];

/// The key of a 64-bit seed.
#[inline]
pub const fn key(seed: u64) -> Key {
    [seed as u32, (seed >> 32) as u32]
}

/// The key of round `round`.
#[inline(always)]
const fn round_key(key: Key, round: u32) -> Key {
    [key[0].wrapping_add(WEYL[0].wrapping_mul(round)), key[1].wrapping_add(WEYL[1].wrapping_mul(round))]
}

/// The four random words of one counter.
#[inline]
pub const fn philox(key: Key, counter: [u32; 4]) -> [u32; 4] {
    let mut x = counter;
    let mut round = 0;
    while round < ROUNDS {
        let [k0, k1] = round_key(key, round);
        let p0 = MULTIPLIERS[0] as u64 * x[0] as u64;
        let p1 = MULTIPLIERS[1] as u64 * x[2] as u64;
        x = [(p1 >> 32) as u32 ^ x[1] ^ k0, p1 as u32, (p0 >> 32) as u32 ^ x[3] ^ k1, p0 as u32];
        round += 1;
    }
    x
}

/// How many bits a draw has: the significand of an `f64`.
pub const DRAW_BITS: u32 = 53;

/// How many of 64 random bits are left out.
const DROPPED: u32 = 64 - DRAW_BITS;

/// 53 random bits; there is no other way to make one, so whoever is given one may rely on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct Draw(u64);

impl Draw {
    /// The upper 53 of 64 random bits.
    #[inline(always)]
    pub const fn of(bits: u64) -> Self {
        Self(bits >> DROPPED)
    }
    /// As a number below 2^53.
    #[inline(always)]
    pub const fn number(self) -> u64 {
        self.0
    }
}

/// Counter word 3 of the draws made here.
const STREAM: u32 = 0;

/// Draw 0 of event `event` in stream 0: 53 random bits that depend on seed and event alone.
#[inline]
pub const fn draw(key: Key, event: u64) -> Draw {
    draw_of(key, event, 0)
}

/// Any draw of an event in stream 0.
#[inline]
pub const fn draw_of(key: Key, event: u64, number: u32) -> Draw {
    let block = event >> 1;
    let [a, b, c, d] = philox(key, [block as u32, (block >> 32) as u32, number, STREAM]);
    let (low, high) = if event & 1 == 0 { (a, b) } else { (c, d) };
    Draw::of((high as u64) << 32 | low as u64)
}

/// Events whose draws one step of [`fill_draws`] makes.
pub const DRAWS: usize = 2 * WIDTH;

crate::tiered! {
    /// The draws `number` of the events from `2 * block` on, as [`draw_of`] gives them.
    pub fn fill_draws[][](key: Key, block: u64, number: u32, draws: &mut [[Draw; DRAWS]]) = draws_body;
}

/// Eight blocks at a time, each 32-bit word in the low half of a lane. What lies above in those that were products is
/// never used: a product takes the low halves only.
#[inline(always)]
fn draws_body<V: Vector8>(key: Key, mut block: u64, number: u32, draws: &mut [[Draw; DRAWS]]) {
    let mut keys = [[0_u64; 2]; ROUNDS as usize];
    for (round, key_of_round) in keys.iter_mut().enumerate() {
        let [k0, k1] = round_key(key, round as u32);
        *key_of_round = [u64::from(k0), u64::from(k1)];
    }
    for sixteen in draws {
        let mut x0 = V::Words::load(core::array::from_fn(|lane| block.wrapping_add(lane as u64)));
        let mut x1 = x0.shifted_down::<32>();
        let mut x2 = V::Words::splat(u64::from(number));
        let mut x3 = V::Words::splat(u64::from(STREAM));
        for [k0, k1] in keys {
            let (k0, k1) = (V::Words::splat(k0), V::Words::splat(k1));
            let (p0, p1) = (x0.product(MULTIPLIERS[0]), x2.product(MULTIPLIERS[1]));
            (x0, x1) = (p1.shifted_down::<32>() ^ x1 ^ k0, p1);
            (x2, x3) = (p0.shifted_down::<32>() ^ x3 ^ k1, p0);
        }
        let mut bits = [0; DRAWS];
        let (even, odd) = (x0.below(x1), x2.below(x3));
        even.shifted_down::<DROPPED>().interleave(odd.shifted_down::<DROPPED>(), &mut bits);
        *sixteen = bits.map(Draw);
        block = block.wrapping_add(WIDTH as u64);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The known answers that Random123 publishes for philox4x32-10.
    #[test]
    fn known_answers() {
        assert_eq!(philox([0; 2], [0; 4]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(
            philox([u32::MAX; 2], [u32::MAX; 4]),
            [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]
        );
        assert_eq!(
            philox([0xa409_3822, 0x299f_31d0], [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344]),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }

    #[test]
    fn the_first_draws_are_the_known_answer_of_zero() {
        assert_eq!(draw(key(0), 0).number(), 0xe169_c58d_6627_e8d5 >> 11);
        assert_eq!(draw(key(0), 1).number(), 0x9b00_dbd8_bc57_ac4c >> 11);
    }

    /// The contract of the module's header, word by word: an event beyond 2^33, so that both words of event/2
    /// count; draw 1 of the same event, and what stream 1 would be, which it does not use.
    #[test]
    fn an_event_uses_draws_of_stream_0() {
        let seed = 0x0123_4567_89ab_cdef;
        let event = 2 * 0x0000_0005_8000_0007 + 1;
        let block = |draw, stream| philox([0x89ab_cdef, 0x0123_4567], [0x8000_0007, 5, draw, stream]);
        let odd = |words: [u32; 4]| (u64::from(words[3]) << 32 | u64::from(words[2])) >> 11;
        let even = |words: [u32; 4]| (u64::from(words[1]) << 32 | u64::from(words[0])) >> 11;
        assert_eq!(draw(key(seed), event).number(), odd(block(0, 0)));
        assert_eq!(draw(key(seed), event - 1).number(), even(block(0, 0)));
        assert_eq!(draw_of(key(seed), event, 1).number(), odd(block(1, 0)));
        let others = [block(0, 0), block(1, 0), block(0, 1)].map(odd);
        assert_eq!(others, KNOWN_DRAWS);
    }
    /// From an independent implementation (tests/scattering/test_monte_carlo.py, `philox`).
    const KNOWN_DRAWS: [u64; 3] = [2_487_954_976_423_361, 1_121_664_613_824_061, 2_762_984_376_852_373];

    proptest! {
        #[test]
        fn lanes_give_the_draws_of_the_scalar_cipher(
            seed: u64,
            block in prop_oneof![0..100_u64, (u64::from(u32::MAX) - 20)..(1_u64 << 33), 0..(1_u64 << 62)],
            number in 0..5_u32,
        ) {
            let mut draws = [[Draw::default(); DRAWS]; 3];
            fill_draws(key(seed), block, number, &mut draws);
            let expected: Vec<Draw> = (0..48).map(|event| draw_of(key(seed), 2 * block + event, number)).collect();
            prop_assert_eq!(draws.as_flattened(), expected);
        }
    }
}
